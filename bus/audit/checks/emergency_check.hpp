/// EMCY: format, COB-ID, error register, inhibit time and open errors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class EmergencyCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(AuditState& audit) const;

 private:
  struct Node {
    std::optional<std::int64_t> last_us;
    std::optional<std::uint8_t> error_register;  ///< in the last EMCY
    std::optional<Moment> open;                  ///< the last error, until it is reset
    std::string open_code;                       ///< with its text
  };

  void check_emcy(const SeenMessage& seen, AuditState& audit);
  void check_register_read(const SeenMessage& seen, AuditState& audit) const;

  std::array<Node, AuditState::node_ids> nodes_;
};

}  // namespace edsc::audit

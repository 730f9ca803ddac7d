/// LSS (CiA 305): responses fit requests, and configuration needs the configuration state.
#pragma once

#include <cstdint>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class LssCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);

 private:
  /// Whether a slave is in the configuration state.
  enum class Slaves : std::uint8_t { unknown, waiting, configure };

  void request(const SeenMessage& seen, AuditState& audit);
  void response(const SeenMessage& seen, AuditState& audit);

  std::optional<std::uint8_t> last_request_;
  std::uint8_t asked_node_id_ = 0;
  Slaves slaves_ = Slaves::unknown;
};

}  // namespace edsc::audit

/// LSS (CiA 305): responses fit requests, the parts of an LSS address are complete, and configuration needs the
/// configuration state.
#pragma once

#include <cstdint>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class LssCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  /// Whether a slave is in the configuration state.
  enum class Slaves : std::uint8_t { unknown, waiting, configure };

  void request(const SeenMessage& seen, AuditState& audit);
  void response(const SeenMessage& seen, AuditState& audit);
  void check_silence(const Moment& now, AuditState& audit);

  std::optional<std::uint8_t> last_request_;
  bool answered_ = false;                        ///< the last request, which only one slave may answer
  std::optional<std::int64_t> asked_us_;         ///< the last request, if the slave must respond
  std::optional<std::int64_t> silent_until_us_;  ///< the end of the two switch delays of activate bit timing
  std::uint8_t asked_node_id_ = 0;
  Slaves slaves_ = Slaves::unknown;
};

}  // namespace edsc::audit

/// Incidents: gaps of the recording, lost nodes, and SDO clients that give up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class IncidentCheck {
 public:
  /// Before the other checks.
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  struct Sender {
    std::optional<std::int64_t> last_us;       ///< of any of its frames
    std::optional<std::int64_t> heartbeat_us;  ///< of its last heartbeat
    std::int64_t distance_us = 0;              ///< of its last two heartbeats; 0: not known
  };

  /// 1017h, or without any EDS the distance of the heartbeats; 0: not known.
  [[nodiscard]] std::int64_t period_of(std::uint8_t node_id, const AuditState& audit) const;
  void check_gap(const Moment& now, AuditState& audit);
  void check_node(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void check_client(const SeenMessage& seen, AuditState& audit);

  std::array<Sender, AuditState::node_ids> senders_;
  std::optional<std::int64_t> last_us_;                        ///< of any frame
  std::int64_t gap_from_us_ = 0, gap_until_us_ = 0;            ///< the last gap
  std::array<std::int64_t, AuditState::node_ids> asked_us_{};  ///< last request to the default SDO
};

}  // namespace edsc::audit

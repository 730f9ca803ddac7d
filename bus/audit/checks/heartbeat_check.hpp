/// Heartbeats of producers against 1017h, and what consumers do without them (1016h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class HeartbeatCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  /// The state or the settings of a node change: until then the old ones are in force.
  void end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  struct Producer {
    std::optional<std::int64_t> last_us;  ///< the last heartbeat or boot-up message
    std::uint8_t state = 0;               ///< in it; 0: boot-up
    bool reported = false;                ///< the silence since then is a finding already
  };

  void check_late(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void check_early(const SeenMessage& seen, AuditState& audit);
  void check_consumers(std::uint8_t producer, const Moment& now, AuditState& audit);

  std::array<Producer, AuditState::node_ids> producers_;
};

}  // namespace edsc::audit

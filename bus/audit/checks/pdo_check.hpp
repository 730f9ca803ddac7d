/// PDOs against their parameters: state, length, event timer, inhibit time, transmission type and synchronous window.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class PdoCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  /// The state or the settings of a node change: until then the old ones are in force.
  void end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  /// A TPDO since the state and the settings of its node changed.
  struct Tpdo {
    std::optional<std::int64_t> last_us;        ///< the last one
    std::optional<std::int64_t> last_event_us;  ///< the last one that is not a response to a remote frame
    std::uint32_t last_sync = 0;                ///< the number of SYNCs before the last one at its cycle
    bool sent = false;
    std::uint32_t requests = 0;  ///< remote frames without a response
  };
  struct Node {
    std::vector<Tpdo> tpdos;  ///< by number - 1
    std::uint32_t syncs = 0;  ///< since the state and the settings changed
    std::optional<std::int64_t> sync_us;
  };

  void count_sync(const SeenMessage& seen, AuditState& audit);
  void check_frame(const SeenMessage& seen, AuditState& audit);
  void check_tpdo(const SeenMessage& seen, AuditState& audit);
  void request(const SeenMessage& seen, AuditState& audit);

  std::array<Node, AuditState::node_ids> nodes_;
};

}  // namespace edsc::audit

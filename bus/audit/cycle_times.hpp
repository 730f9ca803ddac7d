/// Cycle times and jitter of PDOs, SYNC and heartbeats, as a log has them, beside the parameters that state them.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "audit/audit_state.hpp"
#include "audit/spread.hpp"

namespace edsc::audit {

enum class CycleKind : std::uint8_t { sync, heartbeat, tpdo, rpdo };

/// Frames that follow each other, with one nominal time. If the parameter changes, others begin.
struct CycleKey {
  std::uint8_t node_id = 0;  ///< of an RPDO its receiver; 0: SYNC
  CycleKind kind{};
  std::uint32_t place = 0;                ///< number of the PDO; COB-ID of SYNC
  std::optional<std::int64_t> period_us;  ///< empty: no parameter states it, or its value is 0
  friend auto operator<=>(const CycleKey&, const CycleKey&) = default;
};

struct Cycle {
  std::uint32_t cob_id = 0;  ///< of the last frame; bit 29: extended
  std::uint16_t index = 0;   ///< object that states the period; 0: none
  std::uint8_t sub_index = 0;
  std::uint8_t producer = 0;  ///< of SYNC: the node whose 1005h and 1006h state it; 0: not known
  std::uint64_t frames = 0;
  Spread distance;    ///< between two frames, without a change of the NMT state or of a parameter in between
  Spread after_sync;  ///< of a synchronous TPDO: from the last SYNC
  std::optional<std::int64_t> last_us;
};

class CycleTimes {
 public:
  using Map = std::map<CycleKey, Cycle>;
  /// Maximum number of cycles, so that the memory does not grow with the log. Further ones are ignored.
  static constexpr std::size_t max_cycles = 4096;

  void see(const SeenMessage& seen, const AuditState& audit);

  [[nodiscard]] const Map& cycles() const { return cycles_; }

 private:
  Cycle* count(const CycleKey& key, const SeenMessage& seen, std::int64_t unchanged_since);
  void see_sync(const SeenMessage& seen, const AuditState& audit);
  void see_heartbeat(const SeenMessage& seen, const AuditState& audit);
  void see_tpdo(const SeenMessage& seen, const AuditState& audit);

  Map cycles_;
  std::array<std::optional<std::int64_t>, AuditState::node_ids> sync_us_;  ///< the last SYNC for each node
};

}  // namespace edsc::audit

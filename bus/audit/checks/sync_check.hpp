/// SYNC against the parameters of its producer: period 1006h and counter 1019h.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class SyncCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  /// The state or the settings of a node change: until then the old ones are in force.
  void end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  struct Sync {
    std::optional<std::int64_t> last_us;
    std::optional<std::uint8_t> counter;
    std::uint8_t producer = 0;  ///< node-ID; 0: not known
  };

  void check_period(std::uint32_t id, const Sync& sync, const Moment& now, AuditState& audit);
  void check_counter(std::uint32_t id, const Sync& sync, const SeenMessage& seen, AuditState& audit);

  std::map<std::uint32_t, Sync> syncs_;  ///< by COB-ID
};

/// Whether a COB-ID in an object is this one and in use.
[[nodiscard]] constexpr bool is_cob_id(std::uint32_t value, std::uint32_t cob_id) {
  constexpr std::uint32_t meaning = 0xBFFF'FFFF;  // without the bit that names the producer of SYNC
  return (value & meaning) == cob_id;
}

}  // namespace edsc::audit

/// The cycle of SYNC: the synchronous PDOs of a network against the time that they have.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/timing/timing.hpp"

namespace edsc {

struct SyncTiming {
  Nanoseconds period{};    ///< 1006h of the producer
  Nanoseconds window{};    ///< 1007h of the producer; zero if the PDOs have the whole period
  std::size_t pdos = 0;    ///< synchronous PDOs
  Nanoseconds last_end{};  ///< longest of their response times; without meaning unless `is_bounded`
  bool is_bounded = true;  ///< whether each PDO has a worst-case response time
};

/// The cycle of the first node that produces SYNC; nothing without a period or a bit rate.
[[nodiscard]] std::optional<SyncTiming> sync_timing(const std::vector<CobIdUse>& uses, const NetworkTiming& timing);

/// A rule of thumb of manuals of drives for the period of SYNC: at 1 Mbit/s a full bus carries 9 PDOs in a millisecond;
/// the synchronous PDOs use 40 % of it, and everything else needs 2 ms. At a lower bit rate all takes longer in
/// proportion. `bit_rate`: kbit/s, not 0.
[[nodiscard]] Nanoseconds rule_of_thumb_period(std::size_t pdos, unsigned bit_rate);

}  // namespace edsc

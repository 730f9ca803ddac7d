/// Bit timing of a CAN controller (ISO 11898-1): register values from clock and bit rate.
#pragma once

#include <cstdint>
#include <optional>

namespace canopen {

/// Limits of a controller, in time quanta.
struct BitTimingRange {
  std::uint16_t prescaler;          ///< 1 to this value
  std::uint16_t before_sample;      ///< time segment 1, including the propagation segment: 1 to this value
  std::uint16_t after_sample;       ///< time segment 2: 1 to this value
  std::uint16_t resynchronization;  ///< jump width: 1 to this value
};

/// Bit timing. A bit is one quantum, `before_sample` and `after_sample` long.
struct BitTiming {
  std::uint16_t prescaler = 0;
  std::uint16_t before_sample = 0;
  std::uint16_t after_sample = 0;
  std::uint16_t resynchronization = 0;

  friend constexpr bool operator==(const BitTiming&, const BitTiming&) = default;
};

/// Returns the timing with the sample point closest to 87.5 %, which CiA 301 specifies for all bit rates; if there are
/// several, the one with the most quanta. Clock in Hz, rate in bit/s. Empty: the rate cannot be derived from the clock.
[[nodiscard]] constexpr std::optional<BitTiming> bit_timing(std::uint32_t clock, std::uint32_t bit_rate,
                                                            const BitTimingRange& range) {
  constexpr std::uint32_t fewest = 8;
  std::optional<BitTiming> best;
  std::uint32_t least = 1000;  // distance from the sample point in thousandths of a bit
  if (bit_rate == 0 || clock % bit_rate != 0) return std::nullopt;
  for (std::uint32_t prescaler = 1; prescaler <= range.prescaler; ++prescaler) {
    if (clock / bit_rate % prescaler != 0) continue;
    const std::uint32_t quanta = clock / bit_rate / prescaler;
    if (quanta < fewest) break;
    std::uint32_t after = (quanta + 4) / 8;
    if (after > range.after_sample) after = range.after_sample;
    const std::uint32_t before = quanta - 1 - after;
    if (before > range.before_sample) continue;
    const std::uint32_t sample = 1000 * (1 + before) / quanta;
    const std::uint32_t distance = sample > 875 ? sample - 875 : 875 - sample;
    if (distance >= least) continue;
    least = distance;
    const std::uint32_t jump = after < range.resynchronization ? after : range.resynchronization;
    best = BitTiming{static_cast<std::uint16_t>(prescaler), static_cast<std::uint16_t>(before),
                     static_cast<std::uint16_t>(after), static_cast<std::uint16_t>(jump)};
  }
  return best;
}

}  // namespace canopen

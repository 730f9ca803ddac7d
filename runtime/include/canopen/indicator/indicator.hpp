/// RUN and ERR indicators (CiA 303-3): their patterns, and when a pattern is lit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

enum class IndicatorPattern : std::uint8_t {
  off,
  flickering,
  blinking,
  single_flash,
  double_flash,
  triple_flash,
  quadruple_flash,
  on,
};

/// Times of a pattern: `flashes` flashes, each lit and then dark for `flash`, the last one dark for `pause`;
/// then repeated.
struct IndicatorTiming {
  std::uint8_t flashes;
  std::uint16_t flash;  ///< ms
  std::uint16_t pause;  ///< ms; 0: always lit
};

/// One row per pattern, in their order. All periods divide `indicator_cycle`.
using IndicatorTimings = std::array<IndicatorTiming, 8>;

inline constexpr Duration indicator_cycle = std::chrono::seconds{24};

/// CiA 303-3: flickering at 10 Hz, blinking at 2.5 Hz, flashes of 200 ms and one second between their groups.
inline constexpr IndicatorTimings cia_303_3_timings{{
    {0, 0, 200},     // off
    {1, 50, 50},     // flickering
    {1, 200, 200},   // blinking
    {1, 200, 1000},  // single flash
    {2, 200, 1000},  // double flash
    {3, 200, 1000},  // triple flash
    {4, 200, 1000},  // quadruple flash
    {1, 200, 0},     // on
}};

[[nodiscard]] constexpr const IndicatorTiming& timing_of(const IndicatorTimings& timings, IndicatorPattern pattern) {
  return timings[static_cast<std::size_t>(pattern)];
}

/// Returns the period of a pattern.
[[nodiscard]] constexpr Duration period_of(const IndicatorTiming& timing) {
  const Duration dark_between =
      timing.flashes > 1 ? from_milliseconds(timing.flash) * (timing.flashes - 1u) : Duration{0};
  return from_milliseconds(timing.flash) * timing.flashes + dark_between + from_milliseconds(timing.pause);
}

/// State of a pattern at one time, and how long it lasts; `left` is 0 if it does not end.
struct IndicatorStep {
  bool lit;
  Duration left;
};

/// Returns the state of a pattern; `phase` is the time since the pattern began.
[[nodiscard]] constexpr IndicatorStep indicator_step(const IndicatorTiming& timing, Duration phase) {
  if (timing.flashes == 0) return {false, Duration{0}};
  if (timing.pause == 0) return {true, Duration{0}};
  const Duration period = period_of(timing);
  while (phase >= period) phase -= period;  // a division costs more on a small core
  bool lit = true;
  Duration end = from_milliseconds(timing.flash);
  for (unsigned half = 1; phase >= end && half < 2u * timing.flashes; ++half) {
    lit = !lit;
    end += half == 2u * timing.flashes - 1u ? from_milliseconds(timing.pause) : from_milliseconds(timing.flash);
  }
  return {lit, end - phase};
}

/// What the RUN indicator (green) shows in addition to the NMT state.
enum class IndicatorActivity : std::uint8_t {
  none,
  bit_rate_or_lss,   ///< bit rate detection or an LSS service is in progress
  program_download,  ///< a program is being downloaded
};

/// Returns the pattern of the RUN indicator.
[[nodiscard]] constexpr IndicatorPattern run_pattern(NmtState state, IndicatorActivity activity) {
  switch (activity) {
    case IndicatorActivity::none: break;
    case IndicatorActivity::bit_rate_or_lss: return IndicatorPattern::flickering;
    case IndicatorActivity::program_download: return IndicatorPattern::triple_flash;
  }
  switch (state) {
    case NmtState::initialisation: return IndicatorPattern::off;
    case NmtState::pre_operational: return IndicatorPattern::blinking;
    case NmtState::stopped: return IndicatorPattern::single_flash;
    case NmtState::operational: return IndicatorPattern::on;
  }
  return IndicatorPattern::off;
}

/// Conditions that the ERR indicator (red) shows. Values are bits of a set.
enum class IndicatorError : std::uint8_t {
  none = 0x00,
  bit_rate_or_lss = 0x01,  ///< not an error: flickers alternately with the RUN indicator
  configuration = 0x02,    ///< the configuration is not valid
  warning_limit = 0x04,    ///< an error counter of the CAN controller has reached its warning limit
  error_control = 0x08,    ///< a guarding or heartbeat event
  sync = 0x10,             ///< no SYNC within the communication cycle period 1006h
  event_timer = 0x20,      ///< an RPDO was not received within its event timer
  bus_off = 0x40,
};

[[nodiscard]] constexpr IndicatorError operator|(IndicatorError a, IndicatorError b) {
  return static_cast<IndicatorError>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}

struct IndicatorErrorPattern {
  IndicatorError error;
  IndicatorPattern pattern;
};

/// The most severe condition first.
inline constexpr IndicatorErrorPattern indicator_error_patterns[] = {
    {IndicatorError::bus_off, IndicatorPattern::on},
    {IndicatorError::event_timer, IndicatorPattern::quadruple_flash},
    {IndicatorError::sync, IndicatorPattern::triple_flash},
    {IndicatorError::error_control, IndicatorPattern::double_flash},
    {IndicatorError::warning_limit, IndicatorPattern::single_flash},
    {IndicatorError::configuration, IndicatorPattern::blinking},
    {IndicatorError::bit_rate_or_lss, IndicatorPattern::flickering},
};

/// Returns the pattern of the ERR indicator: that of the most severe condition.
[[nodiscard]] constexpr IndicatorPattern error_pattern(IndicatorError errors) {
  for (const IndicatorErrorPattern& row : indicator_error_patterns) {
    if ((static_cast<std::uint8_t>(errors) & static_cast<std::uint8_t>(row.error)) != 0) return row.pattern;
  }
  return IndicatorPattern::off;
}

/// State of a single two-colour indicator.
enum class IndicatorColour : std::uint8_t { dark, green, red };

/// Both indicators of a device. They use one time base, ERR one flash after RUN, so that they are lit alternately; only
/// bus-off and a lit RUN are shown at the same time, and a two-colour indicator is then red.
///
/// Call `on_time` at least every half hour.
template <const IndicatorTimings& Timings = cia_303_3_timings>
class Indicators {
 public:
  /// Sets the patterns to show from now on.
  void show(IndicatorPattern run, IndicatorPattern error) {
    run_ = run;
    error_ = error;
  }

  /// Keeps the time base near the present time.
  void on_time(TimePoint now) {
    while (now - begin_ >= indicator_cycle) begin_ = begin_ + indicator_cycle;
  }

  /// Whether the RUN indicator is lit.
  [[nodiscard]] bool run(TimePoint now) const { return run_step(now).lit; }

  /// Whether the ERR indicator is lit.
  [[nodiscard]] bool error(TimePoint now) const { return error_step(now).lit; }

  /// Returns the same for a single two-colour indicator.
  [[nodiscard]] IndicatorColour colour(TimePoint now) const {
    if (error(now)) return IndicatorColour::red;
    return run(now) ? IndicatorColour::green : IndicatorColour::dark;
  }

  /// Returns when one of them changes; empty if neither will.
  [[nodiscard]] std::optional<TimePoint> next_deadline(TimePoint now) const {
    const Duration run = run_step(now).left;
    const Duration error = error_step(now).left;
    const Duration sooner = run.count() == 0 || (error.count() != 0 && error < run) ? error : run;
    return sooner.count() != 0 ? std::optional{now + sooner} : std::nullopt;
  }

 private:
  [[nodiscard]] IndicatorStep run_step(TimePoint now) const {
    return indicator_step(timing_of(Timings, run_), now - begin_);
  }
  [[nodiscard]] IndicatorStep error_step(TimePoint now) const {
    const IndicatorTiming& timing = timing_of(Timings, error_);
    return indicator_step(timing, now - begin_ + period_of(timing) - from_milliseconds(timing.flash));
  }

  TimePoint begin_{};  ///< of the time base
  IndicatorPattern run_ = IndicatorPattern::off;
  IndicatorPattern error_ = IndicatorPattern::off;
};

}  // namespace canopen

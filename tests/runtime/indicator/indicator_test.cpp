#include <gtest/gtest.h>
#include <canopen/indicator/indicator.hpp>

#include <string>
#include <vector>

namespace {

using canopen::cia_303_3_timings;
using canopen::error_pattern;
using canopen::IndicatorActivity;
using canopen::IndicatorColour;
using canopen::IndicatorError;
using canopen::IndicatorPattern;
using canopen::Indicators;
using canopen::NmtState;
using canopen::run_pattern;
using canopen::TimePoint;
using namespace std::chrono_literals;

constexpr IndicatorPattern patterns[] = {IndicatorPattern::off,
                                         IndicatorPattern::flickering,
                                         IndicatorPattern::blinking,
                                         IndicatorPattern::single_flash,
                                         IndicatorPattern::double_flash,
                                         IndicatorPattern::triple_flash,
                                         IndicatorPattern::quadruple_flash,
                                         IndicatorPattern::on};

/// "200 on, 1000 off, ": a pattern through one period, in ms.
std::string one_period(const canopen::IndicatorTiming& timing) {
  std::string text;
  for (canopen::Duration phase{0}; phase < canopen::period_of(timing);) {
    const canopen::IndicatorStep step = canopen::indicator_step(timing, phase);
    if (step.left.count() == 0) return step.lit ? "on" : "off";
    text += std::to_string(step.left.count() / 1000) + (step.lit ? " on, " : " off, ");
    phase += step.left;
  }
  return text;
}

TEST(Indicator, HasTheTimesOfCia303_3) {
  struct Row {
    IndicatorPattern pattern;
    const char* times;
  };
  constexpr Row rows[] = {
      {IndicatorPattern::off, "off"},
      {IndicatorPattern::flickering, "50 on, 50 off, "},
      {IndicatorPattern::blinking, "200 on, 200 off, "},
      {IndicatorPattern::single_flash, "200 on, 1000 off, "},
      {IndicatorPattern::double_flash, "200 on, 200 off, 200 on, 1000 off, "},
      {IndicatorPattern::triple_flash, "200 on, 200 off, 200 on, 200 off, 200 on, 1000 off, "},
      {IndicatorPattern::quadruple_flash, "200 on, 200 off, 200 on, 200 off, 200 on, 200 off, 200 on, 1000 off, "},
      {IndicatorPattern::on, "on"},
  };
  for (const Row& row : rows) EXPECT_EQ(one_period(timing_of(cia_303_3_timings, row.pattern)), row.times);
}

TEST(Indicator, PeriodsDivideTheCycle) {
  for (const canopen::IndicatorTiming& timing : cia_303_3_timings) {
    EXPECT_EQ(canopen::indicator_cycle.count() % canopen::period_of(timing).count(), 0u);
  }
}

TEST(Indicator, ChangesAtTheMicrosecond) {
  const auto lit = [](canopen::Duration phase) {
    return canopen::indicator_step(timing_of(cia_303_3_timings, IndicatorPattern::double_flash), phase).lit;
  };
  EXPECT_TRUE(lit(199'999us));
  EXPECT_FALSE(lit(200ms));
  EXPECT_FALSE(lit(399'999us));
  EXPECT_TRUE(lit(400ms));
  EXPECT_FALSE(lit(600ms));
  EXPECT_FALSE(lit(1'599'999us));
  EXPECT_TRUE(lit(1600ms));
  EXPECT_TRUE(lit(1600ms * 100 + 199ms));
}

TEST(Indicator, RunFollowsTheNmtState) {
  constexpr IndicatorActivity none = IndicatorActivity::none;
  EXPECT_EQ(run_pattern(NmtState::initialisation, none), IndicatorPattern::off);
  EXPECT_EQ(run_pattern(NmtState::pre_operational, none), IndicatorPattern::blinking);
  EXPECT_EQ(run_pattern(NmtState::stopped, none), IndicatorPattern::single_flash);
  EXPECT_EQ(run_pattern(NmtState::operational, none), IndicatorPattern::on);
  for (const NmtState state : {NmtState::pre_operational, NmtState::stopped, NmtState::operational}) {
    EXPECT_EQ(run_pattern(state, IndicatorActivity::bit_rate_or_lss), IndicatorPattern::flickering);
    EXPECT_EQ(run_pattern(state, IndicatorActivity::program_download), IndicatorPattern::triple_flash);
  }
}

TEST(Indicator, ErrShowsEachError) {
  EXPECT_EQ(error_pattern(IndicatorError::none), IndicatorPattern::off);
  EXPECT_EQ(error_pattern(IndicatorError::bit_rate_or_lss), IndicatorPattern::flickering);
  EXPECT_EQ(error_pattern(IndicatorError::configuration), IndicatorPattern::blinking);
  EXPECT_EQ(error_pattern(IndicatorError::warning_limit), IndicatorPattern::single_flash);
  EXPECT_EQ(error_pattern(IndicatorError::error_control), IndicatorPattern::double_flash);
  EXPECT_EQ(error_pattern(IndicatorError::sync), IndicatorPattern::triple_flash);
  EXPECT_EQ(error_pattern(IndicatorError::event_timer), IndicatorPattern::quadruple_flash);
  EXPECT_EQ(error_pattern(IndicatorError::bus_off), IndicatorPattern::on);
}

TEST(Indicator, ErrShowsTheMostSevereError) {
  constexpr IndicatorError ascending[] = {
      IndicatorError::bit_rate_or_lss, IndicatorError::configuration, IndicatorError::warning_limit,
      IndicatorError::error_control,   IndicatorError::sync,          IndicatorError::event_timer,
      IndicatorError::bus_off};
  IndicatorError errors = IndicatorError::none;
  for (const IndicatorError error : ascending) {
    errors = errors | error;
    EXPECT_EQ(error_pattern(errors), error_pattern(error)) << static_cast<int>(error);
  }
}

/// The states of both indicators in steps of 50 ms: '.' both off, 'g' RUN, 'r' ERR, '!' both on.
template <const canopen::IndicatorTimings& Timings>
std::string strip(const Indicators<Timings>& indicators, int steps) {
  std::string text;
  for (int i = 0; i < steps; ++i) {
    const TimePoint now{canopen::Duration{static_cast<std::uint32_t>(i) * 50'000}};
    text += ".gr!"[(indicators.run(now) ? 1 : 0) + (indicators.error(now) ? 2 : 0)];
  }
  return text;
}

TEST(Indicators, AreLitInTurns) {
  Indicators indicators;
  indicators.show(IndicatorPattern::blinking, IndicatorPattern::single_flash);
  EXPECT_EQ(strip(indicators, 24), "ggggrrrrgggg....gggg....");
  indicators.show(IndicatorPattern::blinking, IndicatorPattern::blinking);
  EXPECT_EQ(strip(indicators, 16), "ggggrrrrggggrrrr");
  indicators.show(IndicatorPattern::flickering, IndicatorPattern::flickering);
  EXPECT_EQ(strip(indicators, 8), "grgrgrgr");
  indicators.show(IndicatorPattern::on, IndicatorPattern::on);
  EXPECT_EQ(strip(indicators, 4), "!!!!");
}

TEST(Indicators, AreNeverLitTogetherWhileBothFlash) {
  for (const IndicatorPattern run : patterns) {
    for (const IndicatorPattern error : patterns) {
      const bool flickers = run == IndicatorPattern::flickering || error == IndicatorPattern::flickering;
      if (run == IndicatorPattern::on || error == IndicatorPattern::on || (flickers && run != error)) continue;
      Indicators indicators;
      indicators.show(run, error);
      EXPECT_EQ(strip(indicators, 480).find('!'), std::string::npos)
          << static_cast<int>(run) << " " << static_cast<int>(error);
    }
  }
}

TEST(Indicators, OfTwoColoursAreRedWhereBothAreLit) {
  Indicators indicators;
  indicators.show(IndicatorPattern::on, IndicatorPattern::double_flash);
  EXPECT_EQ(indicators.colour(TimePoint{100ms}), IndicatorColour::green);
  EXPECT_EQ(indicators.colour(TimePoint{200ms}), IndicatorColour::red);
  indicators.show(IndicatorPattern::off, IndicatorPattern::double_flash);
  EXPECT_EQ(indicators.colour(TimePoint{100ms}), IndicatorColour::dark);
}

TEST(Indicators, TellTheirNextChange) {
  Indicators indicators;
  EXPECT_EQ(indicators.next_deadline(TimePoint{}), std::nullopt);
  indicators.show(IndicatorPattern::single_flash, IndicatorPattern::off);
  EXPECT_EQ(indicators.next_deadline(TimePoint{50ms}), TimePoint{200ms});
  EXPECT_EQ(indicators.next_deadline(TimePoint{200ms}), TimePoint{1200ms});
  indicators.show(IndicatorPattern::on, IndicatorPattern::double_flash);
  EXPECT_EQ(indicators.next_deadline(TimePoint{0ms}), TimePoint{200ms});
  EXPECT_EQ(indicators.next_deadline(TimePoint{800ms}), TimePoint{1800ms});
  indicators.show(IndicatorPattern::on, IndicatorPattern::on);
  EXPECT_EQ(indicators.next_deadline(TimePoint{}), std::nullopt);
}

TEST(Indicators, KeepTheirRasterWhenTheTimeWraps) {
  Indicators indicators;
  indicators.show(IndicatorPattern::single_flash, IndicatorPattern::off);
  TimePoint now{};
  for (int changes = 0; changes < 2 * 7200 / 2; ++changes) {  // two hours, with a period of 1.2 s
    indicators.on_time(now);
    EXPECT_EQ(indicators.run(now), changes % 2 == 0) << changes;
    const TimePoint next = *indicators.next_deadline(now);
    EXPECT_EQ(next - now, changes % 2 == 0 ? canopen::Duration{200ms} : canopen::Duration{1000ms}) << changes;
    now = next;
  }
}

// Manual 003, 2.3: the indicators of the I/O modules

/// "flashing twice per second" in Pre-operational (5.4.1, line 2329): the only time that the manual specifies.
constexpr canopen::IndicatorTimings twice_per_second = [] {
  canopen::IndicatorTimings timings = cia_303_3_timings;
  timings[static_cast<std::size_t>(IndicatorPattern::blinking)] = {1, 250, 250};
  return timings;
}();

// shows 003.16
TEST(Indicator, RunShowsWhatManual003Tells) {
  struct Row {
    int line;
    NmtState state;
    IndicatorPattern pattern;
  };
  constexpr Row rows[] = {
      {183, NmtState::initialisation, IndicatorPattern::off},
      {184, NmtState::stopped, IndicatorPattern::single_flash},
      {185, NmtState::pre_operational, IndicatorPattern::blinking},
      {186, NmtState::operational, IndicatorPattern::on},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(run_pattern(row.state, IndicatorActivity::none), row.pattern) << "manual 003, line " << row.line;
  }
}

// shows 003.17
TEST(Indicator, ErrShowsWhatManual003Tells) {
  struct Row {
    int line;
    IndicatorError errors;
    IndicatorPattern pattern;
  };
  constexpr Row rows[] = {
      {199, IndicatorError::none, IndicatorPattern::off},
      {200, IndicatorError::warning_limit, IndicatorPattern::single_flash},
      {201, IndicatorError::error_control, IndicatorPattern::double_flash},
      {202, IndicatorError::bus_off, IndicatorPattern::on},
      {204, IndicatorError::error_control | IndicatorError::bus_off, IndicatorPattern::on},
      {204, IndicatorError::error_control | IndicatorError::warning_limit, IndicatorPattern::double_flash},
  };
  for (const Row& row : rows) EXPECT_EQ(error_pattern(row.errors), row.pattern) << "manual 003, line " << row.line;
}

// shows 003.16
TEST(Indicators, MayBlinkTwicePerSecondAsManual003Tells) {
  Indicators<twice_per_second> indicators;
  indicators.show(run_pattern(NmtState::pre_operational, IndicatorActivity::none), IndicatorPattern::off);
  EXPECT_EQ(strip(indicators, 20), "ggggg.....ggggg.....");
  EXPECT_EQ(canopen::indicator_cycle.count() %
                canopen::period_of(timing_of(twice_per_second, IndicatorPattern::blinking)).count(),
            0u);
}

}  // namespace

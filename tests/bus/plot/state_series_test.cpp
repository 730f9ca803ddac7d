#include "plot/state_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using edsc::StateRun;
using edsc::StateSeries;

TEST(StateSeries, HasARunForEachChange) {
  StateSeries series;
  for (const auto& [time, state] : {std::pair{10, 1}, {20, 1}, {30, 2}, {25, 2}, {50, 1}}) series.add(time, state);
  EXPECT_EQ(series.count(), 5U);
  ASSERT_EQ(series.runs().size(), 3U);
  EXPECT_EQ(series.runs()[0].first_us, 10);
  EXPECT_EQ(series.runs()[0].last_us, 30);
  EXPECT_EQ(series.runs()[1].state, 2);
  EXPECT_EQ(series.runs()[2].first_us, 50);
}

TEST(StateSeries, TheSameStateAfterALossIsAnotherRun) {
  StateSeries series;
  series.add(10, 1);
  series.add(20, 1);
  series.interrupt(15);  // a value is newer
  series.interrupt(25);
  series.add(40, 1);
  ASSERT_EQ(series.runs().size(), 2U);
  EXPECT_EQ(series.runs()[0].last_us, 20);
  EXPECT_EQ(series.runs()[0].lost_us, 25);
  EXPECT_EQ(series.runs()[1].first_us, 40);
  EXPECT_FALSE(series.runs()[1].lost_us);
}

TEST(StateSeries, KeepsLongRunsAmongManyShortOnes) {
  StateSeries series;
  constexpr int changes = 200'000, begin = 5'000'000, end = 6'000'000;
  std::int64_t now = 0;
  for (int i = 0; i < changes; ++i) {
    if (now == begin) {
      series.add(now, 7);
      now = end;
    }
    series.add(now, i % 2);
    now += 100;
  }
  EXPECT_LE(series.runs().size(), StateSeries::max_runs);
  EXPECT_EQ(series.count(), 200'001U);
  const auto found = std::ranges::find(series.runs(), begin, &StateRun::first_us);
  ASSERT_NE(found, series.runs().end());
  EXPECT_EQ(found->state, 7);
  EXPECT_FALSE(found->is_mixed);
  EXPECT_EQ(std::next(found)->first_us, end);
  EXPECT_TRUE(std::prev(found)->is_mixed);
  EXPECT_TRUE(std::ranges::is_sorted(series.runs(), {}, &StateRun::first_us));
}

}  // namespace

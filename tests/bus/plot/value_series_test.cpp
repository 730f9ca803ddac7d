#include "plot/value_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "plot/axis_ticks.hpp"

namespace {

using edsc::ValueSeries;

TEST(ValueSeries, KeepsEachOfFewValues) {
  ValueSeries series;
  for (int i = 0; i < 100; ++i) series.add(i * 10, i % 7);
  ASSERT_EQ(series.bins().size(), 100U);
  EXPECT_EQ(series.bins()[99].first_us, 990);
  EXPECT_EQ(series.bins()[99].last, 99 % 7);
}

TEST(ValueSeries, HasTheTimeOfALossInTheBinBeforeIt) {
  ValueSeries series;
  series.interrupt(5);  // there is no value
  series.add(10, 1);
  series.interrupt(9);  // a value is newer
  EXPECT_FALSE(series.bins()[0].lost_us);
  series.interrupt(15);
  series.add(40, 2);
  ASSERT_EQ(series.bins().size(), 2U);
  EXPECT_EQ(series.bins()[0].lost_us, 15);
  EXPECT_FALSE(series.bins()[1].lost_us);
}

TEST(ValueSeries, KeepsThePeaksOfManyValuesInBins) {
  ValueSeries series;
  constexpr int count = 3'000'000, high = 1'234'567, low = 2'345'678;
  for (int i = 0; i < count; ++i) series.add(i, i == high ? 100 : i == low ? -50 : 1);
  EXPECT_LE(series.bins().size(), ValueSeries::max_bins);
  EXPECT_GE(series.bins().size(), ValueSeries::max_bins / 4);
  EXPECT_EQ(series.count(), 3'000'000U);
  EXPECT_EQ(series.min(), -50);
  EXPECT_EQ(series.max(), 100);
  const auto with = [&](int time) {
    return std::ranges::find_if(series.bins(),
                                [&](const edsc::ValueBin& bin) { return bin.first_us <= time && time <= bin.last_us; });
  };
  EXPECT_EQ(with(high)->max, 100);
  EXPECT_EQ(with(high)->min, 1);
  EXPECT_EQ(with(low)->min, -50);
  EXPECT_EQ(std::ranges::count_if(series.bins(), [](const edsc::ValueBin& bin) { return bin.max > 1; }), 1);
}

TEST(ValueSeries, HasAllValuesInTheirOrderWhenTimesAreIrregular) {
  ValueSeries series;
  std::int64_t time = 0;
  for (int i = 0; i < 100'000; ++i) {
    time += i % 1000 == 0 ? 1'000'000'000 : 1;
    series.add(time, i);
  }
  EXPECT_LE(series.bins().size(), ValueSeries::max_bins);
  double next = 0;
  for (const edsc::ValueBin& bin : series.bins()) {
    EXPECT_EQ(bin.first, next);
    EXPECT_EQ(bin.min, bin.first);
    EXPECT_EQ(bin.max, bin.last);
    next = bin.last + 1;
  }
  EXPECT_EQ(next, 100'000);
}

TEST(ValueSeries, StaysSmallWhenAllTimesAreTheSameOrDecrease) {
  ValueSeries same, decreasing;
  for (int i = 0; i < 100'000; ++i) {
    same.add(5, i);
    decreasing.add(100'000 - i, i);
  }
  EXPECT_LE(same.bins().size(), ValueSeries::max_bins);
  EXPECT_LE(decreasing.bins().size(), ValueSeries::max_bins);
  EXPECT_EQ(decreasing.bins().back().last_us, 100'000);
}

TEST(ValueSeries, CoversTheWholeRangeOfTimes) {
  ValueSeries series;
  for (std::int64_t i = 0; i < 20'000; ++i) series.add(i * (INT64_MAX / 20'000), 1);
  EXPECT_LE(series.bins().size(), ValueSeries::max_bins);
}

std::vector<std::string> texts(double min, double max, unsigned max_count, double min_step = 0) {
  const edsc::AxisTicks ticks = edsc::axis_ticks(min, max, max_count, min_step);
  std::vector<std::string> result;
  for (const double value : ticks.values) result.push_back(ticks.text(value));
  return result;
}

TEST(AxisTicks, AreMultiplesOfOneTwoAndFive) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(texts(0, 10, 5), (Texts{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(texts(-0.3, 0.3, 5), (Texts{"-0.2", "0.0", "0.2"}));
  EXPECT_EQ(texts(0, 0.04, 4), (Texts{"0.00", "0.01", "0.02", "0.03", "0.04"}));
  EXPECT_EQ(texts(3, 4, 5, 1), (Texts{"3", "4"}));
  EXPECT_EQ(texts(0, 4e9, 4), (Texts{"0", "1e+09", "2e+09", "3e+09", "4e+09"}));
}

TEST(AxisTicks, EndForLimitsThatNumbersCannotDistinguish) {
  EXPECT_LE(texts(1e300, 1e300 * (1 + 1e-15), 5).size(), 10U);
  EXPECT_FALSE(texts(-1.7e308, 1.7e308, 5).empty());
  EXPECT_FALSE(texts(0, 5e-324, 5).empty());
}

}  // namespace

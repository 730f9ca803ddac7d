#include "diagnostics/new_errors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

namespace edsc {
namespace {

constexpr std::array<std::string_view, 2> calculated{"network-load", "network-response-time"};

/// The errors that a file with the second one has, and with the first one has not.
std::size_t added_by(ErrorRule rule, const std::string& before, const std::string& after) {
  Diagnostics one, other;
  one.error(rule, {}, before);
  other.error(rule, {}, after);
  return new_errors(other, one, false, calculated).size();
}

TEST(NewErrors, ResultsOfACalculationAreNotCompared) {
  EXPECT_EQ(added_by("network-load", "the bus load is up to 120.4 % (98.0 % without stuff bits) at 125 kbit/s",
                     "the bus load is up to 104.1 % (84.9 % without stuff bits) at 250 kbit/s"),
            0U);
  EXPECT_EQ(added_by("network-response-time", "axis1 TPDO 2 (281h) may end 3.120 ms after its event",
                     "axis1 TPDO 2 (281h) may end 2.900 ms after its event"),
            0U);
}

TEST(NewErrors, NumbersInNamesAreCompared) {
  const std::string before = "axis1 TPDO 2 (281h) may end 3.120 ms after its event";
  for (const char* const after : {"axis2 TPDO 2 (282h) may end 3.120 ms after its event",
                                  "axis1 TPDO 3 (381h) may end 3.120 ms after its event"}) {
    EXPECT_EQ(added_by("network-response-time", before, after), 1U) << after;
  }
  EXPECT_EQ(added_by("number-range", "300 ms", "200 ms"), 1U);
}

}  // namespace
}  // namespace edsc

#include "network/timing/sync_timing.hpp"

#include <gtest/gtest.h>

namespace edsc {
namespace {

using namespace std::chrono_literals;

/// The example of manual 001: twelve axes with two PDOs each at 1 Mbit/s, 24 / 9 / 40 % = 6.67 ms, and 2 ms.
TEST(SyncTiming, RuleOfThumbIsThatOfTheManual) {
  EXPECT_EQ(rule_of_thumb_period(24, 1000), 8'666'666ns);
  EXPECT_EQ(rule_of_thumb_period(0, 1000), 2ms);
}

TEST(SyncTiming, RuleOfThumbIsInProportionToTheBitRate) { EXPECT_EQ(rule_of_thumb_period(9, 500), 9ms); }

}  // namespace
}  // namespace edsc

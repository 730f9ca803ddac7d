#include <gtest/gtest.h>
#include <canopen/nmt/error_behavior.hpp>

namespace {

using canopen::AbortCode;
using canopen::check_error_behavior;
using canopen::NmtState;
using canopen::state_after_error;

constexpr NmtState initialisation = NmtState::initialisation;
constexpr NmtState pre_operational = NmtState::pre_operational;
constexpr NmtState operational = NmtState::operational;
constexpr NmtState stopped = NmtState::stopped;

TEST(ErrorBehavior, LeadsFromEachStateToTheNext) {
  struct Row {
    std::uint8_t behavior;
    NmtState before;
    NmtState after;
  };
  constexpr Row rows[] = {
      {0, operational, pre_operational},   {0, pre_operational, pre_operational}, {0, stopped, stopped},
      {1, operational, operational},       {1, pre_operational, pre_operational}, {1, stopped, stopped},
      {2, operational, stopped},           {2, pre_operational, stopped},         {2, stopped, stopped},
      {3, operational, operational},       {127, operational, operational},       {255, operational, operational},
      {0, initialisation, initialisation}, {2, initialisation, initialisation},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(state_after_error(row.before, row.behavior), row.after)
        << "1029h:01 = " << int{row.behavior} << " in state " << static_cast<int>(row.before);
  }
}

TEST(ErrorBehavior, RefusesReservedValues) {
  for (const unsigned value : {0u, 1u, 2u, 128u, 255u}) {
    EXPECT_EQ(check_error_behavior(static_cast<std::uint8_t>(value)), canopen::ok) << value;
  }
  for (const unsigned value : {3u, 64u, 127u}) {
    EXPECT_EQ(check_error_behavior(static_cast<std::uint8_t>(value)), AbortCode::invalid_value) << value;
  }
}

}  // namespace

#include "decode/log/log_line.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using edsc::LogLineKind;

TEST(LogLine, HasATimeOfTwelveDigitsAtMost) {
  const auto line = edsc::parse_log_line("(999999999999.999999) can0 123#01");
  EXPECT_EQ(line.kind, LogLineKind::frame);
  EXPECT_EQ(line.microseconds, 999'999'999'999'999'999);
  EXPECT_EQ(edsc::parse_log_line("(1000000000000.0) can0 123#01").kind, LogLineKind::broken);
}

TEST(LogLine, IsBrokenByATimeThatNoNumberHolds) {
  for (const std::size_t digits : {19u, 20u, 4'000u}) {
    EXPECT_EQ(edsc::parse_log_line("(" + std::string(digits, '9') + ".0) can0 123#01").kind, LogLineKind::broken)
        << digits;
  }
}

TEST(LogLine, HasAtMostMicroseconds) {
  EXPECT_EQ(edsc::parse_log_line("(1.123456789) can0 123#01").microseconds, 1'123'456);
  EXPECT_EQ(edsc::parse_log_line("(1.5) can0 123#01").microseconds, 1'500'000);
}

}  // namespace

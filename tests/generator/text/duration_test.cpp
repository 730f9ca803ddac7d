#include "text/duration.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edsc {
namespace {

struct DurationCase {
  std::string_view text;
  std::uint64_t microseconds;
};

/// Calculated by hand.
constexpr DurationCase durations[] = {
    {"1us", 1},
    {"1ms", 1000},
    {"1s", 1000000},
    {"1m", 60000000},
    {"1h", 3600000000},
    {"0us", 0},
    {"0s", 0},
    {"0h", 0},
    {"10ms", 10000},
    {"250ms", 250000},
    {"1200ms", 1200000},
    {"90s", 90000000},
    {"24h", 86400000000},
    {"007s", 7000000},
    {"0.5s", 500000},
    {"1.5ms", 1500},
    {"0.001ms", 1},
    {"0.000001s", 1},
    {"1.0us", 1},
    {"0.5m", 30000000},
    {"0.25h", 900000000},
    {"1.50000000s", 1500000},
    {"1000000h", 3600000000000000},
    {"60000000m", 3600000000000000},
    {"3600000000s", 3600000000000000},
    {"3600000000000ms", 3600000000000000},
    {"3600000000000000us", 3600000000000000},
    {"999999.5h", 3599998200000000},
};

TEST(Duration, IsANumberWithAUnit) {
  for (const auto& [text, microseconds] : durations) EXPECT_EQ(parse_duration(text), microseconds) << text;
}

TEST(Duration, HasAMaximum) {
  for (const std::string_view text :
       {"1000001h", "1000000.5h", "60000001m", "3600000001s", "3600000000000001us", "18446744073709551616us",
        "18446744073709551617us", "99999999999999999999999999999999999999h"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

TEST(Duration, DoesNotHaveAFractionOfAMicrosecond) {
  for (const std::string_view text : {"0.5us", "1.0001ms", "0.0000001s", "1.23456789s"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

TEST(Duration, IsNotAnotherText) {
  for (const std::string_view text :
       {"",    "s",    "ms",   ".",     ".s",    "5",          "0",     "5.",   "1.s",  ".5s", "1..5s", "1.2.3s",
        "-1s", "+1s",  " 1s",  "1s ",   "1 s",   "1S",         "1Ms",   "1MS",  "1min", "1d",  "1ns",   "1sec",
        "1s2", "1h1m", "1,5s", "1e3ms", "0x10s", "1\xC2\xB5s", "one s", "1s\n", "infs", "1mss"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
  EXPECT_EQ(parse_duration(std::string_view{"1s\0", 3}), std::nullopt);
}

TEST(Duration, TextHasTheLargestUnitWithoutFraction) {
  constexpr DurationCase texts[] = {
      {"0s", 0},
      {"1us", 1},
      {"999us", 999},
      {"1ms", 1000},
      {"1001us", 1001},
      {"1500us", 1500},
      {"500ms", 500000},
      {"1s", 1000000},
      {"1500ms", 1500000},
      {"59s", 59000000},
      {"1m", 60000000},
      {"90s", 90000000},
      {"61m", 3660000000},
      {"1h", 3600000000},
      {"3601s", 3601000000},
      {"48h", 172800000000},
      {"1000000h", 3600000000000000},
  };
  for (const auto& [text, microseconds] : texts) {
    EXPECT_EQ(duration_text(microseconds), text);
    EXPECT_EQ(parse_duration(text), microseconds) << text;
  }
}

}  // namespace
}  // namespace edsc

/// Prepared formats write what `value_text` writes, for each entry of the reference devices.
#include "decode/value_format.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "device/entry_text.hpp"
#include "load/load_device.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

bool is_formatted(const Entry& entry) {
  using canopen::DataClass;
  return entry.type->kind != DataClass::string && entry.type->kind != DataClass::domain;
}

std::string text_of(const ValueFormat& format, std::uint64_t number, std::optional<std::int64_t> other) {
  std::string text;
  format.append(text, number, other);
  return text;
}

TEST(ValueFormat, WritesEachEntryOfTheDevicesAsValueText) {
  std::mt19937_64 random{301};
  unsigned compared = 0;
  for (const char* const name :
       {"can-2017c", "can-2024c", "can-2053c", "can-2057c", "cpc-tc1", "cpd", "ezd-1136", "rk5c"}) {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = fmt::format("{}/eds/{}.eds", EDSC_SOURCE_DIR, name);
    settings.node_id = 1;
    settings.check = false;
    const auto loaded = load_device(settings, diagnostics);
    ASSERT_TRUE(loaded->device) << name;
    for (const Object& object : loaded->device->objects) {
      for (const Entry& entry : object.entries) {
        if (!is_formatted(entry)) continue;
        const ValueFormat format{*loaded->device, entry};
        for (int i = 0; i < 64; ++i) {
          const std::uint64_t small = random() % 64,
                              number = (i % 2 == 0 ? small : random()) & low_bits(entry.type->bits);
          const std::optional<std::int64_t> other = i % 4 == 3 ? std::nullopt : std::optional<std::int64_t>{i % 11};
          std::string expected;
          append_device_value(expected, *loaded->device, entry, bytes_of(number, bytes_for(entry.type->bits)), other);
          ASSERT_EQ(text_of(format, number, other), expected)
              << name << " " << entry_label(entry.index, entry.sub_index) << " " << number;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 10'000U);
}

TEST(ValueFormat, RepeatsAWordWithTheValueOfTheOtherObject) {
  Diagnostics diagnostics;
  LoadSettings settings;
  settings.path = fmt::format("{}/eds/ezd-1136.eds", EDSC_SOURCE_DIR);
  settings.node_id = 1;
  settings.check = false;
  const auto loaded = load_device(settings, diagnostics);
  const ValueFormat format{*loaded->device, *loaded->device->find(0x6041, 0)};
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(text_of(format, 0x1000, std::nullopt), "1000h not_ready_to_switch_on");
    EXPECT_EQ(text_of(format, 0x1000, 1), "1000h not_ready_to_switch_on, new_location_point_response");
    EXPECT_EQ(text_of(format, 0x1000, 3), "1000h not_ready_to_switch_on, speed_is_0");
  }
}

TEST(DecimalScale, WritesFiniteDecimalsExactly) {
  const auto text = [](std::int64_t numerator, std::int64_t denominator, std::int64_t offset, std::int64_t raw) {
    Quantity quantity;
    quantity.scale = *Rational::of(numerator, denominator);
    quantity.offset = Rational{offset};
    std::string result;
    return DecimalScale{quantity}.append(result, raw) ? result : "none";
  };
  EXPECT_EQ(text(1, 10, 0, 215), "21.5");
  EXPECT_EQ(text(1, 10, 0, 210), "21");
  EXPECT_EQ(text(1, 10, -40, -5), "-40.5");
  EXPECT_EQ(text(1, 8, 0, -1), "-0.125");
  EXPECT_EQ(text(1, 1000, 0, 5), "0.005");
  EXPECT_EQ(text(100, 1, 0, 7), "700");
  EXPECT_EQ(text(1, 3, 0, 3), "none") << "not a decimal";
  EXPECT_EQ(text(1000, 1, 0, INT64_MAX), "none") << "too large";
  EXPECT_EQ(text(1, 1, 0, INT64_MIN), "-9223372036854775808");
}

}  // namespace
}  // namespace edsc

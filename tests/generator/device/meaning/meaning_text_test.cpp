/// Values by their meaning, as text and back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "device/entry_text.hpp"
#include "load/load_device.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::DataClass;

/// Entries 2000h to 2004h with a meaning.
class MeaningOfText : public testing::Test {
 protected:
  MeaningOfText()
      : options(R"({ "meaning": {
  "2001h": {"values": {"-1": "homing", "0": "off", "3": "profile_velocity"}, "closed": true},
  "2002h": {"bits": {"0": "door_open", "1": "remote", "4..6": {"name": "gear", "values": {"1": "low", "2": "high"}},
                     "8..11": {"name": "level", "signed": true}, "12..15": {"name": "oil", "unit": "%", "scale": 10}},
            "masked": {"state": {"ready": ["0x0C", "0x04"], "fault": ["0x0C", "0x08"]}}},
  "2003h": {"depends_on": "2001h", "cases": {"0": {"name": "idle", "bits": {"12": "set_up"}},
                                             "3": {"bits": {"12": "at_speed", "13": "slip"}}},
            "bits": {"3": "fault"}},
  "2004h": {"bits": {"0..1": {"name": "gear", "values": {"1": "low", "2": "high"}, "closed": true}}} } })"),
        device(var("2000", "Delay", "6", "rw", "Unit=s\nFactor=0.001\nHighLimit=9000\n") + var("2001", "Mode", "2") +
                   var("2002", "Status", "6") + var("2003", "Word", "6") + var("2004", "Gears", "5"),
               options.options) {
    EXPECT_TRUE(options.diagnostics.all().empty());
  }

  [[nodiscard]] std::uint64_t raw(std::uint16_t index, std::string_view text) const {
    const ParsedValue value = parse_value_text(device.entry(index), text);
    EXPECT_EQ(value.problem, "") << text;
    return value.ok() ? number_of(value.bytes) : 0xDEAD;
  }
  [[nodiscard]] std::string problem(std::uint16_t index, std::string_view text) const {
    const ParsedValue value = parse_value_text(device.entry(index), text);
    EXPECT_TRUE(value.bytes.empty()) << text;
    return value.problem;
  }
  [[nodiscard]] std::string text(std::uint16_t index, std::uint64_t number,
                                 std::optional<std::int64_t> other = std::nullopt) const {
    const Entry& entry = device.entry(index);
    return value_text(entry, bytes_of(number, bytes_for(entry.type->bits)), other);
  }

  ReadOptions options;
  DeviceFromText device;
};

TEST_F(MeaningOfText, ANumberWithAUnitIsThePhysicalValue) {
  EXPECT_EQ(raw(0x2000, "5 s"), 5000U);
  EXPECT_EQ(raw(0x2000, "5s"), 5000U);
  EXPECT_EQ(raw(0x2000, "5 ms"), 5U);
  EXPECT_EQ(raw(0x2000, "0.1 min"), 6000U);
  EXPECT_EQ(raw(0x2000, "5"), 5U) << "without a unit, it is the raw number";
  EXPECT_EQ(raw(0x2000, "10h"), 0x10U) << "hexadecimal, not hours";
  EXPECT_EQ(raw(0x2000, "0x10"), 0x10U);
  EXPECT_EQ(problem(0x2000, "10 h"), "10 h is outside the range of UNSIGNED16: 2000h:00 \"Delay\"");
  EXPECT_EQ(problem(0x2000, "5 parsec"), "\"parsec\" is not a unit that edsc knows: 2000h:00 \"Delay\"");
  EXPECT_EQ(text(0x2000, 5000), "5 s");
  EXPECT_EQ(text(0x2000, 5), "0.005 s");
  EXPECT_EQ(limits_text(device.entry(0x2000)), "..9 s");
}

/// CiA 402-2, 6040h: quick_stop is the command 0002h with bits 1, 2 and 7, and bit 2 alone.
TEST(MeaningOfWords, ANameOfACommandAndABitIsTheCommandAtTheStartOnly) {
  const DeviceFromText device("[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\nDefaultValue=0x20192\n" +
                              var("6040", "Controlword", "6"));
  const auto parsed = [&](std::string_view text) { return parse_value_text(device.entry(0x6040), text); };
  const auto raw = [&](std::string_view text) { return number_of(parsed(text).bytes); };
  EXPECT_EQ(raw("quick_stop"), 0x0002U);
  EXPECT_EQ(raw("quick_stop=1"), 0x0004U);
  EXPECT_EQ(raw("enable_voltage, quick_stop"), 0x0006U);
  EXPECT_EQ(raw("enable_operation, halt"), 0x010FU);
  EXPECT_EQ(parsed("quick_stop, enable_voltage").problem,
            "quick_stop is a value of bits 86h, which include enable_voltage; quick_stop=1 is the bit alone: 6040h:00 "
            "\"Controlword\"");
}

TEST_F(MeaningOfText, AQuantityHasItsDimensionStepsAndLimits) {
  EXPECT_EQ(problem(0x2000, "5 V"), "V cannot be converted to s: 2000h:00 \"Delay\"");
  EXPECT_EQ(problem(0x2000, "1.0005 s"), "1.0005 s is between 1 s and 1.001 s: 2000h:00 \"Delay\"");
  EXPECT_EQ(problem(0x2000, "9.001 s"), "9.001 s is above the high limit of 2000h:00 \"Delay\", 9 s");
  EXPECT_EQ(problem(0x2000, "-1 s"), "-1 s is outside the range of UNSIGNED16: 2000h:00 \"Delay\"");
}

TEST_F(MeaningOfText, AnEnumerationIsItsNumberAndName) {
  EXPECT_EQ(text(0x2001, 3), "3 profile_velocity");
  EXPECT_EQ(text(0x2001, 0xFF), "-1 homing");
  EXPECT_EQ(text(0x2001, 5), "5");
  EXPECT_EQ(raw(0x2001, "profile_velocity"), 3U);
  EXPECT_EQ(raw(0x2001, "homing"), 0xFFU);
  EXPECT_EQ(raw(0x2001, "3 profile_velocity"), 3U);
  EXPECT_EQ(raw(0x2001, "3"), 3U);
  EXPECT_EQ(problem(0x2001, "5"), "5 is not a value of 2001h:00 \"Mode\"; expected homing, off, profile_velocity");
  EXPECT_EQ(problem(0x2001, "homin"),
            "\"homin\" is not a number or a named value; did you mean \"homing\"?: 2001h:00 \"Mode\"");
  EXPECT_NE(problem(0x2001, "3 homing"), "");
  EXPECT_TRUE(parse_unchecked(device.entry(0x2001), "5").ok());
}

TEST_F(MeaningOfText, AWordIsItsNumberAndTheNamesOfItsBits) {
  EXPECT_EQ(text(0x2002, 0x0025), "0025h ready, door_open, gear=high, level=0, oil=0 %");
  EXPECT_EQ(text(0x2002, 0xAF00), "AF00h gear=0, level=-1, oil=100 %");
  EXPECT_EQ(raw(0x2002, "door_open"), 1U);
  EXPECT_EQ(raw(0x2002, "ready, remote, gear=high"), 0x26U);
  EXPECT_EQ(raw(0x2002, "fault | oil=100 %"), 0xA008U);
  EXPECT_EQ(raw(0x2002, "level=-1, gear=7"), 0x0F70U);
  EXPECT_EQ(raw(0x2002, "state=fault"), 0x08U);
  EXPECT_EQ(raw(0x2002, "remote=0, door_open=1"), 0x01U);
  EXPECT_EQ(raw(0x2002, "0025h"), 0x25U);
  EXPECT_EQ(problem(0x2002, "ready, fault"),
            "fault contradicts what is before it: both have bits Ch: 2002h:00 \"Status\"");
  EXPECT_EQ(problem(0x2002, "gear=8"), "8 does not fit into gear, which has 3 bits: 2002h:00 \"Status\"");
  EXPECT_EQ(problem(0x2002, "gear"), "gear needs a value, such as gear=1: 2002h:00 \"Status\"");
  EXPECT_EQ(problem(0x2002, "remot"),
            "\"remot\" is not a field or value; did you mean \"remote\"?: 2002h:00 \"Status\"");
}

TEST_F(MeaningOfText, AClosedFieldRejectsOtherNumbers) {
  EXPECT_EQ(raw(0x2004, "gear=high"), 2U);
  EXPECT_EQ(raw(0x2004, "0xF1"), 0xF1U);
  for (const char* const text : {"gear=3", "3"}) {
    EXPECT_EQ(problem(0x2004, text), "gear=3 is not a value of 2004h:00 \"Gears\"; expected low, high");
  }
}

TEST_F(MeaningOfText, FieldsOfACaseNeedTheOtherValue) {
  EXPECT_EQ(text(0x2003, 0x1008), "1008h fault");
  EXPECT_EQ(text(0x2003, 0x1008, 0), "1008h fault, set_up");
  EXPECT_EQ(text(0x2003, 0x1008, 3), "1008h fault, at_speed");
  EXPECT_EQ(text(0x2003, 0x1008, 7), "1008h fault");
  EXPECT_EQ(raw(0x2003, "fault, slip"), 0x2008U);
  EXPECT_EQ(raw(0x2003, "profile_velocity.at_speed"), 0x1000U);
  EXPECT_NE(problem(0x2003, "idle.at_speed"), "");
}

TEST_F(MeaningOfText, EachValueOfAWordIsReadAsItIsWritten) {
  for (const std::uint16_t index : {std::uint16_t{0x2002}, std::uint16_t{0x2003}}) {
    for (std::uint64_t number = 0; number <= 0xFFFF; ++number) {
      ASSERT_EQ(raw(index, text(index, number)), number) << text(index, number);
    }
  }
}

// ---- each quantity of the devices ----

/// The number at the beginning of a text, without the conversion that is tested.
long double number_in(const std::string& text) { return std::strtold(text.c_str(), nullptr); }

/// Text -> raw -> text over the limits of an entry and 1,000 random values between them; a value in the middle of two
/// neighbours is rejected with both.
void check_round_trips(const Entry& entry, std::mt19937_64& random) {
  const canopen::DataTypeRow& type = *entry.type;
  const Quantity& quantity = *quantity_of(entry);
  const bool is_signed = type.kind == DataClass::signed_integer;
  const std::uint64_t mask = low_bits(type.bits);
  const auto limit = [&](const std::optional<Value>& value, std::uint64_t of_type) {
    return value && !value->plus_node_id ? value->bits & mask : of_type;
  };
  const std::uint64_t first = limit(entry.low_limit, is_signed ? std::uint64_t{1} << (type.bits - 1) : 0);
  const std::uint64_t last = limit(entry.high_limit, is_signed ? mask >> 1 : mask);
  const std::uint64_t distance = (last - first) & mask;
  const auto shown = [&](std::uint64_t number) {
    return value_text(entry, bytes_of(number & mask, bytes_for(type.bits)));
  };
  for (int i = 0; i < 1002; ++i) {
    const std::uint64_t step = i == 0                          ? 0
                               : i == 1                        ? distance
                               : distance == ~std::uint64_t{0} ? random()
                                                               : random() % (distance + 1);
    const std::uint64_t number = (first + step) & mask;
    const std::string text = shown(number);
    const ParsedValue value = parse_value_text(entry, text);
    ASSERT_EQ(value.problem, "") << text;
    ASSERT_EQ(number_of(value.bytes), number) << text;
    ASSERT_EQ(shown(number_of(value.bytes)), text);
    if (type.bits > 48) continue;  // a long double and the decimals of 64 bits differ
    const auto signed_number = is_signed ? sign_extended(number, type.bits) : static_cast<std::int64_t>(number);
    const long double scale =
        static_cast<long double>(quantity.scale.numerator()) / static_cast<long double>(quantity.scale.denominator());
    const long double offset =
        static_cast<long double>(quantity.offset.numerator()) / static_cast<long double>(quantity.offset.denominator());
    const long double physical = static_cast<long double>(signed_number) * scale + offset;
    const bool is_named = entry.meaning->values && entry.meaning->values->find(signed_number) != nullptr;
    if (!is_named) {
      ASSERT_LE(std::abs(number_in(text) - physical), std::abs(scale) / 100) << text;
    }
    if (step == distance || quantity.symbol.empty()) continue;
    const int decimals = std::max(1, 3 - static_cast<int>(std::floor(std::log10(std::abs(scale)))));
    const std::string above = shown(number + 1);
    const std::string middle = fmt::format("{:.{}Lf} {}", physical + scale / 2, decimals, quantity.symbol);
    const ParsedValue between = parse_value_text(entry, middle);
    ASSERT_FALSE(between.ok()) << middle;
    const bool is_next_named = entry.meaning->values && entry.meaning->values->find(signed_number + 1) != nullptr;
    if (is_named || is_next_named) continue;
    ASSERT_NE(between.problem.find(text), std::string::npos) << between.problem << " has not " << text;
    ASSERT_NE(between.problem.find(above), std::string::npos) << between.problem << " has not " << above;
  }
}

TEST(QuantityText, OfTheDevicesIsReadAsItIsWritten) {
  std::mt19937_64 random{402};
  for (const char* const name :
       {"can-2017c", "can-2024c", "can-2053c", "can-2057c", "cpc-tc1", "cpd", "ezd-1136", "rk5c"}) {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = fmt::format("{}/eds/{}.eds", EDSC_SOURCE_DIR, name);
    settings.node_id = 5;
    const auto loaded = load_device(settings, diagnostics);
    std::size_t quantities = 0;
    for (const Object& object : loaded->device->objects) {
      for (const Entry& entry : object.entries) {
        const bool is_integer = meaning_of_integer(entry) != nullptr;
        if (!is_integer || quantity_of(entry) == nullptr) continue;
        SCOPED_TRACE(fmt::format("{} {}", name, entry_label(entry.index, entry.sub_index)));
        check_round_trips(entry, random);
        if (HasFatalFailure()) return;
        ++quantities;
      }
    }
    EXPECT_GE(quantities, 3U) << name;
  }
}

}  // namespace
}  // namespace edsc

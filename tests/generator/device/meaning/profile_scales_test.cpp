/// Units that objects of profiles 402 and 404 state for others.
#include "device/meaning/profile_scales.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/entry_text.hpp"
#include "device/value_overlay.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

std::string type_of(const char* number) {
  return var("1000", "Device type", "7", "ro", std::string{"DefaultValue="} + number + "\n");
}
const std::string drive_type = type_of("0x00020192");

/// 1500 of an entry as text.
std::string text_of_1500(const std::string& eds, std::uint16_t index, std::uint8_t sub_index = 0) {
  const DeviceFromText device(eds);
  const Entry& entry = device.entry(index, sub_index);
  const std::uint8_t bytes[] = {0xDC, 0x05, 0, 0};
  return value_text(entry, std::span{bytes}.first(entry.type->bits / 8));
}

std::string record(const std::string& index, const char* first, const char* second) {
  return group(index, "R", "9", 3) + sub(index, 0, "n", "5", "DefaultValue=2\n") +
         sub(index, 1, "a", "7", std::string{"DefaultValue="} + first + "\n") +
         sub(index, 2, "b", "7", std::string{"DefaultValue="} + second + "\n");
}

TEST(ProfileScales, ReadTheNotationOfCia303) {
  const auto text = [](std::uint32_t number) {
    const auto quantity = quantity_of_si_unit(number);
    return quantity ? fraction_text(quantity->scale) + " " + quantity->symbol : "";
  };
  EXPECT_EQ(text(0x00B44700), "1 rpm");
  EXPECT_EQ(text(0xFDB44700), "1/1000 rpm");
  EXPECT_EQ(text(0xFD010000), "1/1000 m");
  EXPECT_EQ(text(0xFD010300), "1/1000 m/s");
  EXPECT_EQ(text(0xFF410000), "1/10 °");
  EXPECT_EQ(text(0x03220000), "1000 Pa");
  EXPECT_EQ(text(0x00B50000), "1 inc");
  EXPECT_EQ(text(0x00EE0000), "") << "a unit that edsc does not know";
  EXPECT_EQ(text(0x0001EE00), "") << "a denominator that edsc does not know";
  EXPECT_EQ(text(0x7F010000), "") << "an exponent that does not fit";
}

TEST(ProfileScales, OfADriveAreItsSiUnits) {
  const std::string eds = drive_type + var("6064", "Position", "4", "ro") + var("606C", "Velocity", "4", "ro") +
                          var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n") +
                          var("60A9", "SI unit velocity", "7", "rw", "DefaultValue=0xFFB44700\n");
  EXPECT_EQ(text_of_1500(eds, 0x6064), "1.5 m");
  EXPECT_EQ(text_of_1500(eds, 0x606C), "150 rpm");
  const DeviceFromText device(eds);
  EXPECT_EQ(device.entry(0x6064).meaning->quantity->source, MeaningSource::profile);
}

TEST(ProfileScales, OfPositionsAreRevolutionsOfTheFeedConstantOrEncoder) {
  const std::string position = drive_type + var("6064", "Position", "4", "ro");
  const std::string encoder = record("608F", "4000", "1"), feed = record("6092", "3000", "2");
  EXPECT_EQ(text_of_1500(position + encoder, 0x6064), "0.375 rev");
  EXPECT_EQ(text_of_1500(position + encoder + feed, 0x6064), "1 rev");
  // 1500 increments are 0.375 revolutions of the motor, and 5 of these are 2 of the driving shaft.
  EXPECT_EQ(text_of_1500(position + encoder + record("6091", "5", "2"), 0x6064), "0.15 rev");
  // A unit is 8 increments.
  EXPECT_EQ(text_of_1500(position + encoder + record("6093", "8", "1"), 0x6064), "3 rev");
}

TEST(ProfileScales, AreNotThoseOfObjectsWithoutAStatement) {
  const std::string position = drive_type + var("6064", "Position", "4", "ro");
  const std::string encoder = record("608F", "4000", "1");
  EXPECT_EQ(text_of_1500(position + encoder + record("6092", "0", "1"), 0x6064), "1500");
  EXPECT_EQ(text_of_1500(position + encoder + record("6092", "1", "1"), 0x6064), "1500");
  EXPECT_EQ(text_of_1500(position + encoder + record("6091", "0", "1"), 0x6064), "1500");
  EXPECT_EQ(text_of_1500(position + record("608F", "1", "1"), 0x6064), "1500");
  EXPECT_EQ(text_of_1500(position + encoder + var("60A8", "SI unit", "7", "rw", "DefaultValue=0x00EE0000\n"), 0x6064),
            "1500");
  EXPECT_EQ(text_of_1500(position + encoder + var("60A8", "SI unit", "7", "rw", "DefaultValue=0\n"), 0x6064),
            "0.375 rev");
  EXPECT_EQ(text_of_1500(position + encoder + var("60A8", "SI unit", "7", "rw"), 0x6064), "1500") << "unknown";
}

TEST(ProfileScales, OfVelocitiesAreRevolutionsPerSecond) {
  const std::string velocity = drive_type + var("606C", "Velocity", "4", "ro");
  const std::string encoder = record("608F", "4000", "1"), speed = record("6090", "2000", "1");
  EXPECT_EQ(text_of_1500(velocity + encoder, 0x606C), "1500");
  EXPECT_EQ(text_of_1500(velocity + speed, 0x606C), "0.75 rev/s");
  EXPECT_EQ(text_of_1500(velocity + speed + record("6091", "3", "1"), 0x606C), "0.25 rev/s");
  // A unit is 4 increments per second.
  EXPECT_EQ(text_of_1500(velocity + speed + record("6094", "4", "1"), 0x606C), "3 rev/s");
  EXPECT_EQ(text_of_1500(velocity + encoder + record("6094", "4", "1"), 0x606C), "1.5 rev/s");
  EXPECT_EQ(text_of_1500(velocity + speed + record("6096", "60", "1"), 0x606C), "1500");
  EXPECT_EQ(text_of_1500(velocity + speed + record("6092", "360", "1"), 0x606C), "1500");
}

TEST(ProfileScales, OfAccelerationsAreTheirSiUnit) {
  const std::string acceleration = drive_type + var("6083", "Acceleration", "7", "rw");
  const auto unit = [&](const char* number) {
    return acceleration + var("60AA", "SI unit", "7", "rw", std::string{"DefaultValue="} + number + "\n");
  };
  EXPECT_EQ(text_of_1500(unit("0x00B55700"), 0x6083), "1500 inc/s²");
  EXPECT_EQ(text_of_1500(unit("0xFEB45700"), 0x6083), "15 rev/s²");
  EXPECT_EQ(text_of_1500(unit("0x00C00300"), 0x6083), "1500 (000005DCh)") << "a code of the manufacturer";
}

TEST(ProfileScales, NameTheEntriesThatCanChangeThem) {
  const std::string position = drive_type + var("6064", "Position", "4", "ro") + var("607A", "Target", "4", "rw");
  const DeviceFromText device(position + record("608F", "4000", "1") + record("6091", "5", "2"));
  const Quantity& quantity = *device.entry(0x6064).meaning->quantity;
  EXPECT_EQ(quantity.text, "by the default values of 608Fh, 6091h");
  EXPECT_EQ(quantity.stated_by, (std::vector<EntryKey>{{0x608F, 1}, {0x608F, 2}, {0x6091, 1}, {0x6091, 2}}));
  EXPECT_EQ(device.entry(0x6064).meaning, device.entry(0x607A).meaning) << "one meaning of all positions";
  EXPECT_TRUE(has_profile_scale(device.device, device.entry(0x6064)));
  EXPECT_FALSE(has_profile_scale(device.device, device.entry(0x608F, 1)));
  const DeviceFromText fixed(position + var("60A8", "SI unit", "7", "const", "DefaultValue=0xFD010000\n"));
  EXPECT_TRUE(fixed.entry(0x6064).meaning->quantity->stated_by.empty());
  EXPECT_FALSE(has_profile_scale(fixed.device, fixed.entry(0x6064))) << "constants cannot differ on the device";
}

TEST(ProfileScales, AreThoseOfOtherNumbers) {
  const DeviceFromText device(drive_type + var("6064", "Position", "4", "ro") + record("608F", "4000", "1"));
  const auto scale_for = [&](std::optional<std::uint64_t> resolution) {
    const auto quantity = profile_scale(device.device, device.entry(0x6064), [&](const Entry& entry) {
      return entry.sub_index == 1 ? resolution : std::optional<std::uint64_t>{1};
    });
    return quantity ? fraction_text(quantity->scale) : "";
  };
  EXPECT_EQ(scale_for(1000), "1/1000");
  EXPECT_EQ(scale_for(std::nullopt), "");
}

TEST(ProfileScales, FollowTheValuesOfAnOverlay) {
  const DeviceFromText device(drive_type + var("6064", "Position", "4", "ro") + record("608F", "4000", "1"));
  const auto scale_with = [&](std::uint64_t resolution) {
    ValueOverlay values;
    Value value;
    value.bits = resolution;
    values.set(device.entry(0x608F, 1), value);
    Diagnostics diagnostics;
    const Device changed = with_values(device.device, values, device.options, diagnostics);
    const Entry& entry = *changed.find(0x6064, 0);
    return entry.meaning ? fraction_text(entry.meaning->quantity->scale) : "";
  };
  EXPECT_EQ(scale_with(500), "1/500");
  EXPECT_EQ(scale_with(0), "");
}

TEST(ProfileScales, OfTheSecondAxisAreItsOwn) {
  const std::string eds = drive_type + var("6864", "Position", "4", "ro") +
                          var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n") +
                          var("68A8", "SI unit position", "7", "rw", "DefaultValue=0xFF410000\n");
  EXPECT_EQ(text_of_1500(eds, 0x6864), "150 °");
}

TEST(ProfileScales, DoNotReplaceOptionsAndKeysOfTheEds) {
  const std::string unit = var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n");
  EXPECT_EQ(text_of_1500(drive_type + var("6064", "Position", "4", "ro", "Unit=inc\n") + unit, 0x6064), "1500 inc");
  const ReadOptions options(R"({ "meaning": { "6064h": { "unit": "deg" } } })");
  const DeviceFromText device(drive_type + var("6064", "Position", "4", "ro") + unit, options.options);
  EXPECT_EQ(device.entry(0x6064).meaning->quantity->source, MeaningSource::options);
}

TEST(ProfileScales, OfOtherDevicesAreNotRead) {
  const std::string eds = type_of("0x00020191") + var("6064", "Position", "4", "ro") +
                          var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n");
  EXPECT_EQ(text_of_1500(eds, 0x6064), "1500");
}

TEST(ProfileScales, OfAMeasuringDeviceAreTheDigitsOfTheChannel) {
  const auto channels = [](const std::string& index, const char* type, const char* first, const char* second) {
    return group(index, "Channels", "8", 3) + sub(index, 0, "n", "5", "DefaultValue=2\n") +
           sub(index, 1, "first", type, std::string{"DefaultValue="} + first + "\n") +
           sub(index, 2, "second", type, std::string{"DefaultValue="} + second + "\n");
  };
  const std::string eds = type_of("0x00020194") + channels("7130", "3", "0", "0") +
                          channels("6131", "7", "0x00220000", "0") + channels("6132", "5", "2", "1");
  EXPECT_EQ(text_of_1500(eds, 0x7130, 1), "15 Pa");
  EXPECT_EQ(text_of_1500(eds, 0x7130, 2), "150");
}

}  // namespace
}  // namespace edsc

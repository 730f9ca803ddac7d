/// Units that objects of profiles 402 and 404 state for others.
#include "device/meaning/profile_scales.hpp"

#include <gtest/gtest.h>

#include <string>

#include "device/entry_text.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

std::string type_of(const char* number) {
  return var("1000", "Device type", "7", "ro", std::string{"DefaultValue="} + number + "\n");
}
const std::string drive = type_of("0x00020192");

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
  const std::string eds = drive + var("6064", "Position", "4", "ro") + var("606C", "Velocity", "4", "ro") +
                          var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n") +
                          var("60A9", "SI unit velocity", "7", "rw", "DefaultValue=0xFFB44700\n");
  EXPECT_EQ(text_of_1500(eds, 0x6064), "1.5 m");
  EXPECT_EQ(text_of_1500(eds, 0x606C), "150 rpm");
  const DeviceFromText device(eds);
  EXPECT_EQ(device.entry(0x6064).meaning->quantity->source, MeaningSource::profile);
}

TEST(ProfileScales, OfPositionsAreRevolutionsOfTheFeedConstantOrEncoder) {
  const std::string position = var("6064", "Position", "4", "ro");
  const std::string encoder = record("608F", "4000", "1"), feed = record("6092", "3000", "2");
  EXPECT_EQ(text_of_1500(drive + position + encoder, 0x6064), "0.375 rev");
  EXPECT_EQ(text_of_1500(drive + position + encoder + feed, 0x6064), "1 rev");
  EXPECT_EQ(text_of_1500(drive + position + encoder + record("6092", "0", "1"), 0x6064), "1500");
}

TEST(ProfileScales, OfTheSecondAxisAreItsOwn) {
  const std::string eds = drive + var("6864", "Position", "4", "ro") +
                          var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n") +
                          var("68A8", "SI unit position", "7", "rw", "DefaultValue=0xFF410000\n");
  EXPECT_EQ(text_of_1500(eds, 0x6864), "150 °");
}

TEST(ProfileScales, DoNotReplaceOptionsAndKeysOfTheEds) {
  const std::string unit = var("60A8", "SI unit position", "7", "rw", "DefaultValue=0xFD010000\n");
  EXPECT_EQ(text_of_1500(drive + var("6064", "Position", "4", "ro", "Unit=inc\n") + unit, 0x6064), "1500 inc");
  const ReadOptions options(R"({ "meaning": { "6064h": { "unit": "deg" } } })");
  const DeviceFromText device(drive + var("6064", "Position", "4", "ro") + unit, options.options);
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

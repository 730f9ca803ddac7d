#include "device/value_overlay.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <utility>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

static_assert(!std::is_copy_constructible_v<Device>, "the PDOs of a copy would point to the objects of the original");

/// RPDO 1 maps 2000h (8 bits); 2001h (16 bits) can be mapped instead.
const std::string eds = group("1400", "RPDO 1", "0x9", 3) + sub("1400", 0, "Count", "0x5", "DefaultValue=2\n") +
                        sub("1400", 1, "COB-ID", "0x7", "DefaultValue=0x201\n") +
                        sub("1400", 2, "Type", "0x5", "DefaultValue=255\n") + group("1600", "Mapping 1", "0x9", 2) +
                        sub("1600", 0, "Count", "0x5", "DefaultValue=1\n") +
                        sub("1600", 1, "Object 1", "0x7", "DefaultValue=0x20000008\n") +
                        var("2000", "Narrow", "0x5", "rw", "PDOMapping=1\nDefaultValue=7\n") +
                        var("2001", "Wide", "0x6", "rw", "PDOMapping=1\n");

struct Overlaid : DeviceFromText {
  Overlaid() : DeviceFromText{eds} {}

  void set(std::uint16_t index, std::uint8_t sub_index, std::uint64_t bits) {
    values.set(entry(index, sub_index), Value{.bits = bits});
  }
  [[nodiscard]] Device overlaid() { return with_values(device, values, options, of_mapping); }

  ValueOverlay values;
  Diagnostics of_mapping;
};

bool is_of(const Device& device, const Entry* entry) { return entry == device.find(entry->index, entry->sub_index); }

TEST(ValueOverlay, HasTheLastSettingOfAnEntryAndElseItsDefaultValue) {
  Overlaid text;
  EXPECT_EQ(text.values.value_of(text.entry(0x2000))->bits, 7U);
  EXPECT_EQ(text.values.value_of(text.entry(0x2001)), nullptr);
  text.set(0x2000, 0, 8);
  text.set(0x2001, 0, 300);
  text.set(0x2000, 0, 9);
  EXPECT_EQ(text.values.value_of(text.entry(0x2000))->bits, 9U);
  EXPECT_EQ(text.values.value_of(text.entry(0x2001))->bits, 300U);
  EXPECT_EQ(text.values.size(), 3U);
  EXPECT_EQ(text.values.find(0x2000, 1), nullptr);
}

TEST(ValueOverlay, LeavesTheDeviceBelowAsItIs) {
  Overlaid text;
  text.set(0x2000, 0, 9);
  const Device device = text.overlaid();
  EXPECT_EQ(device.find(0x2000, 0)->default_value->bits, 9U);
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 7U);
}

TEST(ValueOverlay, HasThePdosOfItsValues) {
  Overlaid text;
  ASSERT_EQ(text.device.pdos.front().bits(), 8U);
  text.set(0x1600, 1, 0x20010010);
  const Device device = text.overlaid();
  ASSERT_EQ(device.pdos.size(), 1U);
  EXPECT_EQ(device.pdos.front().bits(), 16U);
  EXPECT_EQ(device.pdos.front().entries.front().index, 0x2001);
  EXPECT_FALSE(device.pdos.front().broken);
  EXPECT_EQ(text.device.pdos.front().bits(), 8U);
}

TEST(ValueOverlay, ReportsAMappingThatTheDeviceDoesNotAllow) {
  Overlaid text;
  text.set(0x1600, 1, 0x20010008);  // 8 of 16 bits
  EXPECT_TRUE(text.overlaid().pdos.front().broken);
  EXPECT_EQ(text.of_mapping.errors(), 1U);
}

TEST(ValueOverlay, PointsToItsOwnObjectsAlsoAfterAMove) {
  Overlaid text;
  text.set(0x2000, 0, 9);
  Device device = text.overlaid();
  const Device moved = std::move(device);
  const Pdo& pdo = moved.pdos.front();
  EXPECT_EQ(pdo.communication, moved.find(0x1400));
  EXPECT_EQ(pdo.mapping, moved.find(0x1600));
  EXPECT_TRUE(is_of(moved, pdo.entries.front().object));
}

}  // namespace
}  // namespace edsc

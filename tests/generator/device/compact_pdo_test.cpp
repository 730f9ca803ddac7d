#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataType;
using Rules = std::vector<std::string>;

std::string device_info(std::string_view compact_pdo, int rx, int tx) {
  return "[DeviceInfo]\nCompactPDO=" + std::string{compact_pdo} + "\nNrOfRXPDO=" + std::to_string(rx) +
         "\nNrOfTXPDO=" + std::to_string(tx) + "\n";
}

const std::string object = var("2000", "Value", "5");

TEST(CompactPdo, DescribesAllPdosThatAreOnlyCounted) {
  const DeviceFromText text(device_info("0x17", 2, 1) + object);
  ASSERT_EQ(text.device.pdos.size(), 3U);
  for (const std::uint16_t index :
       std::initializer_list<std::uint16_t>{0x1400, 0x1401, 0x1600, 0x1601, 0x1800, 0x1A00}) {
    EXPECT_NE(text.device.find(index), nullptr) << index;
  }
  EXPECT_EQ(text.device.find(0x1402), nullptr);
  EXPECT_EQ(text.device.find(0x1801), nullptr);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(CompactPdo, HasASubIndexForEachBit) {
  const DeviceFromText text(device_info("0x17", 1, 0) + object);
  const Object& parameter = *text.device.find(0x1400);
  ASSERT_EQ(parameter.entries.size(), 5U);
  EXPECT_EQ(text.entry(0x1400, 0).default_value->bits, 5U);
  EXPECT_EQ(text.entry(0x1400, 0).access, Access::constant);
  EXPECT_EQ(text.entry(0x1400, 1).type->type, DataType::unsigned32);
  EXPECT_EQ(text.entry(0x1400, 2).type->type, DataType::unsigned8);
  EXPECT_EQ(text.entry(0x1400, 3).type->type, DataType::unsigned16);
  EXPECT_EQ(parameter.find(4), nullptr);
  EXPECT_EQ(text.entry(0x1400, 1).obj_flags, 0U) << "configuration tools read and write it";
  EXPECT_EQ(text.entry(0x1400, 5).type->type, DataType::unsigned16);
  EXPECT_EQ(text.line_of("object-not-listed"), "[2000]");
  EXPECT_EQ(text.source.line(parameter.position.line), "CompactPDO=0x17");
}

TEST(CompactPdo, HasTheCobIdsOfThePredefinedConnectionSet) {
  const DeviceFromText text(device_info("0x01", 5, 5) + object);
  EXPECT_EQ(text.entry(0x1400, 1).default_value->bits, 0x200U);
  EXPECT_TRUE(text.entry(0x1400, 1).default_value->plus_node_id);
  EXPECT_EQ(text.entry(0x1403, 1).default_value->bits, 0x500U);
  EXPECT_EQ(text.entry(0x1803, 1).default_value->bits, 0x480U);
  EXPECT_EQ(text.entry(0x1404, 1).default_value->bits, 0x8000'0000U) << "the others are off";
  EXPECT_FALSE(text.entry(0x1404, 1).default_value->plus_node_id);
}

TEST(CompactPdo, AddsTheNodeIdWhereItIsKnown) {
  const DeviceFromText text(device_info("0x01", 0, 1) + object, {}, {"", std::uint8_t{7}});
  EXPECT_EQ(text.entry(0x1800, 1).default_value->bits, 0x187U);
  EXPECT_FALSE(text.entry(0x1800, 1).default_value->plus_node_id);
}

TEST(CompactPdo, MapsNothingInUpTo64Entries) {
  const DeviceFromText text(device_info("0x01", 1, 0) + object);
  EXPECT_EQ(text.device.find(0x1600)->entries.size(), 65U);
  EXPECT_EQ(text.entry(0x1600, 0).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1600, 0).access, Access::rw);
  EXPECT_EQ(text.entry(0x1600, 64).type->type, DataType::unsigned32);
  EXPECT_TRUE(text.device.pdos[0].entries.empty());
}

TEST(CompactPdo, LeavesPdosWithSectionsOfTheirOwnAlone) {
  const DeviceFromText text(device_info("0x01", 3, 0) + group("1401", "RPDO", "9", 2) + var("1401sub0", "Count", "5") +
                            var("1401sub1", "COB-ID", "7", "rw", "DefaultValue=9\n"));
  EXPECT_EQ(text.device.pdos.size(), 3U) << "1400h and 1402h are new";
  EXPECT_EQ(text.entry(0x1401, 1).default_value->bits, 9U);
  EXPECT_NE(text.device.find(0x1601), nullptr) << "its mapping is only counted";
}

TEST(CompactPdo, AddsNothingToADeviceThatDescribesAllItsPdos) {
  const DeviceFromText text(device_info("0", 4, 4) + object);
  EXPECT_TRUE(text.device.pdos.empty());
}

TEST(CompactPdo, WarnsOfBitsAndNumbersThatCannotBe) {
  EXPECT_EQ(findings(DeviceFromText(device_info("0x41", 1, 0) + object).diagnostics, "compact-pdo"),
            (std::vector{warning_at(2, 12, "compact-pdo")}));
  const DeviceFromText many(device_info("1", 600, 0) + object);
  EXPECT_EQ(findings(many.diagnostics, "compact-pdo"), (std::vector{warning_at(3, 11, "compact-pdo")}));
  EXPECT_EQ(many.device.pdos.size(), 512U);
}

}  // namespace
}  // namespace edsc

/// Values and node-ID of a DCF (CiA 306-1, 5).
#include "device/resolve.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Rules = std::vector<std::string>;

TEST(Dcf, TakesTheParameterValueBeforeTheDefault) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=3\n" +
                            var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=2\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 2U);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Dcf, TakesTheDefaultWhereThereIsNoParameterValue) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=3\n" +
                            var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 1U);
}

TEST(Dcf, GivesTheNodeIdToItsFormulas) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=0x22\n" +
                            var("1014", "COB-ID EMCY", "7", "rw", "DefaultValue=$NODEID+0x80\n"));
  EXPECT_EQ(text.device.node_id, 0x22);
  EXPECT_EQ(text.entry(0x1014).default_value->bits, 0xA2U);
  EXPECT_FALSE(text.entry(0x1014).default_value->plus_node_id);
}

TEST(Dcf, GivesWayToANodeIdFromTheCommandLine) {
  const DeviceFromText text(
      "[DeviceComissioning]\nNodeID=3\n" + var("1014", "COB-ID EMCY", "7", "rw", "DefaultValue=$NODEID+0x80\n"), {},
      {"", std::uint8_t{9}});
  EXPECT_EQ(text.entry(0x1014).default_value->bits, 0x89U);
}

TEST(Dcf, HasNoNodeIdWhenItIs0Or255) {
  for (const char* number : {"0", "255", "0xFF"}) {
    const DeviceFromText text("[DeviceComissioning]\nNodeID=" + std::string{number} + "\n" + var("2000", "V", "5"));
    EXPECT_FALSE(text.device.node_id) << number;
    EXPECT_EQ(rules_of(text.diagnostics), Rules{}) << number;
  }
}

TEST(Dcf, WantsANodeIdOf1To127) {
  for (const char* number : {"128", "-1", "five"}) {
    const DeviceFromText text("[DeviceComissioning]\nNodeID=" + std::string{number} + "\n" + var("2000", "V", "5"));
    EXPECT_EQ(findings(text.diagnostics, "node-id"), (std::vector{error_at(2, 8, "node-id")})) << number;
  }
}

TEST(Eds, KeepsTheDefaultAndWarnsOfAParameterValue) {
  const DeviceFromText text(var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=2\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 1U);
  EXPECT_EQ(findings(text.diagnostics, "parameter-value"), (std::vector{warning_at(7, 16, "parameter-value")}));
}

}  // namespace
}  // namespace edsc

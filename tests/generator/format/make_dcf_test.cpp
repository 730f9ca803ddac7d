/// The DCF of an EDS and a node-ID.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "format/dcf/make_dcf.hpp"
#include "formatted.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

constexpr std::string_view two_entries =
    "[FileInfo]\nFileName=pump.eds\n\n"
    "[2000]\nParameterName=a\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\nDefaultValue=$NODEID+0x180\n"
    "ParameterValue=7\n\n"
    "[2001]\nParameterName=b\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=$NODEID+0x200\n";

TEST(MakeDcf, GivesAllWritableEntriesTheirValueWhenAsked) {
  const std::string dcf = Formatted(std::string{two_entries}, std::uint8_t{5}).dcf(DcfValues::all);
  EXPECT_NE(dcf.find("DefaultValue=$NODEID+0x180\nParameterValue=0x00000185\n"), std::string::npos) << dcf;
  EXPECT_TRUE(dcf.ends_with("AccessType=ro\nDefaultValue=$NODEID+0x200\n")) << dcf;
}

TEST(MakeDcf, HasNoValueThatTheDefaultGives) {
  EXPECT_EQ(Formatted(std::string{two_entries}, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
}

TEST(MakeDcf, DropsAValueThatIsTheDefaultForTheNode) {
  const std::string text = "[DeviceComissioning]\nNodeID=5\n" + object_with("0x0007",
                                                                            "DefaultValue=$NODEID+2\n"
                                                                            "ParameterValue=0x7\n");
  EXPECT_EQ(Formatted(text, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
  EXPECT_NE(Formatted(text, std::uint8_t{5}).dcf(DcfValues::all).find("ParameterValue=0x00000007\n"),
            std::string::npos);
  EXPECT_NE(Formatted(text, std::uint8_t{6}).dcf().find("ParameterValue=0x00000007\n"), std::string::npos);
}

/// A configuration tool writes number and entries of a mapping together; a part of them would be another mapping.
TEST(MakeDcf, KeepsAMappingTogether) {
  const auto entry = [](int sub_index, std::string_view type, std::string_view keys) {
    return fmt::format("\n[1A00sub{}]\nParameterName=n\nObjectType=7\nDataType={}\nAccessType=rw\n{}", sub_index, type,
                       keys);
  };
  const std::string text = "[DeviceComissioning]\nNodeID=5\n\n[1A00]\nParameterName=m\nObjectType=9\nSubNumber=3\n" +
                           entry(0, "5", "DefaultValue=2\n") + entry(1, "7", "DefaultValue=0x60410010\n") +
                           entry(2, "7", "DefaultValue=0x60640020\nParameterValue=0x60640120\n");
  const std::string dcf = Formatted(text, std::uint8_t{5}).dcf();
  EXPECT_NE(dcf.find("DefaultValue=2\nParameterValue=2\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("ParameterValue=0x60410010\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("ParameterValue=0x60640120\n"), std::string::npos) << dcf;
}

TEST(MakeDcf, CommissionsTheNode) {
  const std::string dcf = Formatted(std::string{two_entries}, std::uint8_t{5}).dcf();
  EXPECT_TRUE(
      dcf.starts_with("[FileInfo]\nFileName=pump.eds\nLastEDS=pump.eds\n\n"
                      "[DeviceComissioning]\nNodeID=5\nNodeName=\nNetNumber=0\nNetworkName=\nCANopenManager=0\n\n"))
      << dcf;
}

TEST(MakeDcf, IsTheDeviceWithItsNodeId) {
  const Formatted eds(std::string{two_entries}, std::uint8_t{5});
  const Formatted dcf(eds.dcf());
  EXPECT_EQ(dcf.device.node_id, 5);
  EXPECT_EQ(dcf.view()["objects"], eds.view()["objects"]);
}

TEST(MakeDcf, KeepsTheValuesOfADcf) {
  const std::string dcf = Formatted("[DeviceComissioning]\nNodeID=9\nNodeName=axis\n" +
                                        object_with("0x0007", "DefaultValue=1\nParameterValue=$NODEID+2\n"),
                                    std::uint8_t{5})
                              .dcf();
  EXPECT_NE(dcf.find("NodeID=5\nNodeName=axis\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("DefaultValue=1\nParameterValue=0x00000007\n"), std::string::npos) << dcf;
}

TEST(MakeDcf, DropsAValueOfAnEds) {
  const std::string eds = object_with("0x0007", "DefaultValue=\nParameterValue=7\n");
  EXPECT_EQ(Formatted(eds, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
}

TEST(MakeDcf, GivesCommandsNoValue) {
  const std::string stores = group("1010", "Store parameters", "8", 2) +
                             var("1010sub0", "Highest sub-index", "5", "ro", "DefaultValue=1\n") +
                             var("1010sub1", "Save all", "7", "rw", "DefaultValue=1\nParameterValue=0x65766173\n");
  const std::string clears = group("1003", "Errors", "8", 2) +
                             var("1003sub0", "Number of errors", "5", "rw", "DefaultValue=0\n") +
                             var("1003sub1", "Error", "7", "ro");
  const std::string control = group("1F51", "Program control", "8", 1) +
                              "DataType=5\nAccessType=rw\nCompactSubObj=1\n" + "[1F51Value]\nNrOfEntries=1\n1=1\n";
  const std::string other = var("2000", "Value", "5", "rw", "DefaultValue=3\n");
  for (const std::string& head : {std::string{}, std::string{"[DeviceComissioning]\nNodeID=5\n"}}) {
    const std::string dcf = Formatted(head + clears + stores + control + other, std::uint8_t{5}).dcf(DcfValues::all);
    const std::string_view value = "ParameterValue=";
    const std::size_t first = dcf.find(value);
    EXPECT_EQ(dcf.find("ParameterValue=3"), first) << dcf;
    EXPECT_EQ(dcf.find(value, first + 1), std::string::npos) << dcf;
    EXPECT_EQ(dcf.find("[1F51Value]"), std::string::npos) << dcf;
  }
}

TEST(MakeDcf, ConfiguresNoValueInPlaceOfThatOfCia301) {
  const std::string eds = "[1014]\nParameterName=COB-ID EMCY\nDataType=0x0007\nAccessType=rw\nDefaultValue=";
  const auto dcf = [&](const std::string& value) {
    return Formatted(eds + value, std::uint8_t{5}).dcf(DcfValues::all);
  };
  EXPECT_EQ(dcf("0\n").find("ParameterValue"), std::string::npos) << "CAN-ID 0";
  EXPECT_NE(dcf("$NODEID+0x80\n").find("ParameterValue=0x00000085"), std::string::npos);
}

TEST(MakeDcf, HasTheBitRateOfADeviceThatHasOnlyOne) {
  const std::string info = "[DeviceInfo]\nBaudRate_125=0\nBaudRate_250=1\n";
  EXPECT_NE(Formatted(info + object_with("5", ""), std::uint8_t{5}).dcf().find("Baudrate=250\n"), std::string::npos);
}

}  // namespace
}  // namespace edsc

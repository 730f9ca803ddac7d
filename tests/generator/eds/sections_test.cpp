#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Rules = std::vector<std::string>;

/// A section with its keys, in a complete device.
struct ReadSections : DeviceFromText {
  explicit ReadSections(const std::string& text, std::string file = "test.eds")
      : DeviceFromText(text + var("2000", "Speed", "6"), {}, {}, std::move(file)) {}
};

// ---- [Comments] ----

TEST(CommentsSection, HoldsLinesByTheirNumber) {
  const ReadSections read("[Comments]\nLines=2\nLine2=second\nline1=first; with a semicolon\n");
  EXPECT_EQ(read.device.information.comments, (std::vector<std::string>{"first; with a semicolon", "second"}));
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(CommentsSection, MayHaveItsLinesInAnyOrder) {
  const ReadSections read("[Comments]\nLines=4\nLine3=c\nLine4=d\nLine1=a\nLine2=b\nLine4=other\n");
  EXPECT_EQ(read.device.information.comments, (std::vector<std::string>{"a", "b", "c", "d"}));
  EXPECT_EQ(findings(read.diagnostics, "duplicate-key"), (std::vector{warning_at(7, 1, "duplicate-key")}));
}

TEST(CommentsSection, CountsItsLines) {
  EXPECT_EQ(findings(ReadSections("[Comments]\nLines=3\nLine1=a\n").diagnostics, "comments"),
            (std::vector{warning_at(2, 7, "comments")}));
  EXPECT_EQ(findings(ReadSections("[Comments]\nLines=1\nLine2=a\n").diagnostics, "comments"),
            (std::vector{warning_at(2, 7, "comments")}));
  EXPECT_EQ(findings(ReadSections("[Comments]\nLine1=a\n").diagnostics, "comments"),
            (std::vector{warning_at(1, 2, "comments")}));
}

// ---- [FileInfo] and [DeviceInfo] ----

TEST(FileInfoSection, KeepsDatesAsTheyAreWritten) {
  const ReadSections read(
      "[FileInfo]\nCreationDate=2016-03-25\nCreationTime=17:24:43\nFileVersion=-\nLastEDS=drive.eds\n");
  const FileInformation& file = read.device.information.file;
  EXPECT_EQ(file.creation_date, "2016-03-25");
  EXPECT_EQ(file.creation_time, "17:24:43");
  EXPECT_EQ(file.file_version, "-");
  EXPECT_EQ(file.last_eds, "drive.eds");
  EXPECT_EQ(read.diagnostics.errors(), 0U);
}

TEST(DeviceInfoSection, SaysWhatTheDeviceCanDo) {
  const ReadSections read(
      "[DeviceInfo]\nOrderCode=A-1\nBaudRate_500=1\nBaudrate_125=1\nBaudRate_10=0\nGranularity=0x08\n"
      "SimpleBootUpSlave=1\nNrOfRXPDO=2\nLSS_Supported=0\n");
  const Capabilities& capabilities = read.device.information.capabilities;
  EXPECT_EQ(capabilities.order_code, "A-1");
  EXPECT_EQ(capabilities.baud_rates, (std::vector<std::uint16_t>{125, 500}));
  EXPECT_EQ(capabilities.granularity, 8U);
  EXPECT_EQ(capabilities.simple_boot_up_slave, true);
  EXPECT_EQ(capabilities.nr_of_rx_pdo, 2U);
  EXPECT_EQ(capabilities.lss_supported, false);
  EXPECT_EQ(capabilities.nr_of_tx_pdo, std::nullopt);
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(DeviceInfoSection, MayLeaveNumbersEmptyAndSpellThemInOctal) {
  const ReadSections read("[DeviceInfo]\nVendorNumber=001\nProductNumber=\nRevisionNumber=010\n");
  EXPECT_EQ(read.device.vendor_number, 1U);
  EXPECT_EQ(read.device.product_number, 0U);
  EXPECT_EQ(read.device.revision_number, 8U);
  EXPECT_EQ(findings(read.diagnostics, "number-spelling"), (std::vector{warning_at(4, 16, "number-spelling")}));
  EXPECT_EQ(rules_of(read.diagnostics), Rules{"number-spelling"});
}

// ---- [DeviceComissioning] ----

TEST(CommissioningSection, SaysHowTheNodeIsConfigured) {
  const ReadSections read(
      "[DeviceCommissioning]\nNodeId=0x05\nNODENAME=Lift\nBaudRate=250\nNetNumber=1\nNetworkName=Line\n"
      "CANopenManager=1\nLSS_SerialNumber=0x10\nNodeRefd=N1\nNetRefd=L1\n");
  ASSERT_TRUE(read.device.information.commissioning);
  const Commissioning& commissioning = *read.device.information.commissioning;
  EXPECT_EQ(read.device.node_id, 5);
  EXPECT_EQ(commissioning.node_name, "Lift");
  EXPECT_EQ(commissioning.baudrate, 250U);
  EXPECT_EQ(commissioning.net_number, 1U);
  EXPECT_EQ(commissioning.network_name, "Line");
  EXPECT_EQ(commissioning.canopen_manager, true);
  EXPECT_EQ(commissioning.lss_serial_number, 16U);
  EXPECT_EQ(commissioning.node_refd, "N1");
  EXPECT_EQ(commissioning.net_refd, "L1");
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(CommissioningSection, WarnsOfNumbersThatAreNone) {
  EXPECT_EQ(findings(ReadSections("[DeviceComissioning]\nNetNumber=one\n").diagnostics, "commissioning"),
            (std::vector{warning_at(2, 11, "commissioning")}));
}

TEST(CommissioningSection, IsMissingInAnEds) { EXPECT_FALSE(ReadSections("").device.information.commissioning); }

// ---- [Tools] ----

TEST(ToolsSection, NamesProgramsAndTheirCommands) {
  const ReadSections read(
      "[Tool2]\nName=Scope\nCommand=scope.exe\n[Tools]\nItems=2\n[Tool1]\nName=Setup\nCommand=a b\n");
  ASSERT_EQ(read.device.information.tools.size(), 2U);
  EXPECT_EQ(read.device.information.tools[0].name, "Setup");
  EXPECT_EQ(read.device.information.tools[0].command, "a b");
  EXPECT_EQ(read.device.information.tools[1].name, "Scope");
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(ToolsSection, CountsItsTools) {
  EXPECT_EQ(findings(ReadSections("[Tools]\nItems=2\n[Tool1]\nName=A\n").diagnostics, "tools"),
            (std::vector{warning_at(2, 7, "tools")}));
  EXPECT_EQ(findings(ReadSections("[Tool1]\nName=A\n").diagnostics, "tools"), (std::vector{warning_at(1, 2, "tools")}));
}

TEST(ToolsSection, KeepsTheFirstOfTwoWithOneNumber) {
  const ReadSections read("[Tools]\nItems=1\n[Tool1]\nName=A\n[Tool01]\nName=B\n");
  EXPECT_EQ(findings(read.diagnostics, "duplicate-section"), (std::vector{warning_at(5, 2, "duplicate-section")}));
  ASSERT_EQ(read.device.information.tools.size(), 1U);
  EXPECT_EQ(read.device.information.tools[0].name, "A");
}

TEST(ToolsSection, PlacesAMissingKeyAtTheSection) {
  const ReadSections read("[Tools]\nItems=1\n[Tool1]\nName=A\n");
  ASSERT_EQ(read.sheet.tools.size(), 1U);
  EXPECT_FALSE(read.sheet.tools[0].command.present);
  EXPECT_EQ(read.sheet.tools[0].command.position.file, &read.source);
  EXPECT_EQ(read.sheet.tools[0].command.position.line, 3U);
}

// ---- [DynamicChannels] ----

TEST(DynamicChannelsSection, HoldsSegments) {
  const ReadSections read("[DynamicChannels]\nNrOfSeg=1\nType1=0x0007\nDir1=ro\nRange1=0xA080-0xA0BF\nPPOffset1=4\n");
  ASSERT_EQ(read.device.information.dynamic_channels.size(), 1U);
  const DynamicChannel& channel = read.device.information.dynamic_channels[0];
  EXPECT_EQ(channel.data_type, 7U);
  EXPECT_EQ(channel.direction, "ro");
  EXPECT_EQ(channel.first_index, 0xA080U);
  EXPECT_EQ(channel.last_index, 0xA0BFU);
  EXPECT_EQ(channel.process_picture_offset, 4U);
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(DynamicChannelsSection, MayHaveItsSegmentsInAnyOrder) {
  const ReadSections read(
      "[DynamicChannels]\nType2=6\nNrOfSeg=3\nType3=7\nType1=5\nDir3=ro\nDir1=rw\nDir2=wo\nRange2=0xA0C0\n"
      "Range1=0xA000\nRange3=0xA100\nPPOffset3=0\nPPOffset2=0\nPPOffset1=0\n");
  std::vector<std::optional<std::uint32_t>> types;
  for (const DynamicChannel& channel : read.device.information.dynamic_channels) types.push_back(channel.data_type);
  EXPECT_EQ(types, (std::vector<std::optional<std::uint32_t>>{5, 6, 7}));
}

TEST(DynamicChannelsSection, MayBeEmpty) {
  EXPECT_EQ(rules_of(ReadSections("[DynamicChannels]\n").diagnostics), Rules{});
}

TEST(DynamicChannelsSection, WarnsOfRangesThatAreNone) {
  for (const char* range : {"A080", "0xA0BF-0xA080", "0xA080..0xA0BF", "0x1A080"}) {
    const ReadSections read("[DynamicChannels]\nNrOfSeg=1\nType1=7\nDir1=ro\nRange1=" + std::string{range} +
                            "\nPPOffset1=0\n");
    EXPECT_EQ(findings(read.diagnostics, "dynamic-segment"), (std::vector{warning_at(5, 8, "dynamic-segment")}))
        << range;
  }
}

// ---- [HHHHObjectLinks] and keys with more information ----

TEST(ObjectLinks, NameObjectsThatBelongTogether) {
  const ReadSections read("[2000ObjectLinks]\nObjectLinks=2\n1=0x2001\n2=4096\n");
  EXPECT_EQ(read.device.find(0x2000)->links, (std::vector<std::uint16_t>{0x2001, 0x1000}));
  EXPECT_EQ(rules_of(read.diagnostics), Rules{});
}

TEST(ObjectLinks, WarnOfWhatIsNoIndex) {
  EXPECT_EQ(findings(ReadSections("[2000ObjectLinks]\nObjectLinks=1\n1=Speed\n").diagnostics, "object-links"),
            (std::vector{warning_at(3, 3, "object-links")}));
}

TEST(Entry, KeepsWhatADcfSaysBesides) {
  const DeviceFromText text(
      "[DeviceComissioning]\nNodeID=1\n" +
      var("2000", "Program", "0x000F", "rw",
          "ObjFlags=3\nDenotation=mine\nParamRefd=P1\nUploadFile=up.bin\nDownloadFile=down.bin\n"));
  const Entry& entry = text.entry(0x2000);
  EXPECT_EQ(entry.obj_flags, 3U);
  EXPECT_EQ(entry.denotation, "mine");
  EXPECT_EQ(entry.param_refd, "P1");
  EXPECT_EQ(entry.upload_file, "up.bin");
  EXPECT_EQ(entry.download_file, "down.bin");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Entry, KeepsUnitAndFactorOfVendors) {
  const DeviceFromText text(var("2000", "Voltage", "6", "ro", "Unit=mV\nFactor=0.1\nDescription=at the bridge\n"));
  EXPECT_EQ(text.entry(0x2000).unit, "mV");
  EXPECT_EQ(text.entry(0x2000).factor, "0.1");
  EXPECT_EQ(text.entry(0x2000).description, "at the bridge");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Entry, HasAFileOnlyAsADomain) {
  EXPECT_EQ(findings(DeviceFromText(var("2000", "V", "5", "rw", "UploadFile=up.bin\n")).diagnostics, "domain-value"),
            (std::vector{warning_at(6, 12, "domain-value")}));
}

}  // namespace
}  // namespace edsc

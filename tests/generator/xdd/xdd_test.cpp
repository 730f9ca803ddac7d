/// An XDD as a DataSheet: objects, access and mapping, information of the device and the file, and errors.
#include "xdd/read_xdd.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"
#include "xdd_profile.hpp"

namespace edsc {
namespace {

using Findings = std::vector<Finding>;

TEST(Xdd, IsToldFromIniByItsFirstCharacter) {
  EXPECT_TRUE(is_xml(SourceFile{"a.eds", "\xEF\xBB\xBF \r\n<a/>"}));
  EXPECT_FALSE(is_xml(SourceFile{"a.xdd", "[1000]\nParameterName=<"}));
  EXPECT_FALSE(is_xml(SourceFile{"a.xdd", ""}));
}

TEST(Xdd, PlacesTheAttributesOfAnObject) {
  const ReadXdd read(Profile{
      "<CANopenObject index='1005' name='COB-ID SYNC' objectType='7' dataType='0007' accessType='rw' lowLimit='1'\n"
      " highLimit='9' defaultValue='0x80' PDOmapping='no' objFlags='0001' actualValue='5' denotation='mine'/>",
      "", "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const ObjectDescription& object = read.object();
  EXPECT_EQ(object.index, 0x1005);
  EXPECT_EQ(object.position.line, first_line);
  EXPECT_EQ(object.position.column, 2U);
  EXPECT_EQ(object.position.length, std::string_view{"CANopenObject"}.size());
  EXPECT_EQ(object.parameter_name.text, "COB-ID SYNC");
  EXPECT_EQ(object.object_type.text, "7");
  EXPECT_EQ(object.data_type.text, "0x0007");
  EXPECT_EQ(object.access_type.text, "rw");
  EXPECT_EQ(object.low_limit.text, "1");
  EXPECT_EQ(object.high_limit.text, "9");
  EXPECT_EQ(object.high_limit.position.line, first_line + 1);
  EXPECT_EQ(object.high_limit.position.column, 13U);
  EXPECT_EQ(object.default_value.text, "0x80");
  EXPECT_EQ(object.pdo_mapping.text, "0");
  EXPECT_EQ(object.obj_flags.text, "0x0001");
  EXPECT_EQ(object.parameter_value.text, "5");
  EXPECT_EQ(object.denotation.text, "mine");
}

TEST(Xdd, PointsToTheElementWhereAnAttributeIsMissing) {
  const ReadXdd read(Profile{"<CANopenObject index='1005'/>", "", "", ""});
  EXPECT_FALSE(read.object().data_type.present);
  EXPECT_EQ(read.object().data_type.position.line, first_line);
  EXPECT_EQ(read.object().data_type.position.column, 2U);
}

TEST(Xdd, SortsObjectsAndSubObjectsAndKeepsTheFirstOfTwo) {
  const ReadXdd read(
      Profile{"<CANopenObject index='2001' subNumber='03'><CANopenSubObject subIndex='0A' name='ten'/>"
              "<CANopenSubObject subIndex='00'/><CANopenSubObject subIndex='0a'/></CANopenObject>\n"
              "<CANopenObject index='2000' name='first'/>\n<CANopenObject index='2000' name='second'/>",
              "", "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(first_line, 122, "duplicate-section"),
                                                  warning_at(first_line + 2, 2, "duplicate-section")}));
  ASSERT_EQ(read.sheet.objects.size(), 2U);
  EXPECT_EQ(read.object(0).parameter_name.text, "first");
  EXPECT_EQ(read.object(1).sub_number.text, "3");
  ASSERT_EQ(read.object(1).sub_objects.size(), 2U);
  EXPECT_EQ(read.object(1).sub_objects[1].sub_index, 10);
  EXPECT_EQ(read.object(1).sub_objects[1].parameter_name.text, "ten");
}

TEST(Xdd, LeavesOutAnObjectWithoutIndex) {
  const ReadXdd read(
      Profile{"<CANopenObject index='10005'/>\n<CANopenObject/>\n<CANopenObject index='0x1000'/>", "", "", ""});
  EXPECT_EQ(findings(read.diagnostics),
            (Findings{error_at(first_line, 23, "number"), error_at(first_line + 1, 2, "number")}));
  EXPECT_EQ(read.sheet.objects.size(), 1U);
}

TEST(Xdd, ReadsAnyNamespacePrefix) {
  const ReadXdd read(
      "<c:ISO15745ProfileContainer xmlns:c='x'><c:ISO15745Profile><c:ProfileBody "
      "i:type='q:ProfileBody_CommunicationNetwork_CANopen'><q:ApplicationLayers><q:CANopenObjectList>"
      "<q:CANopenObject index='1000'/></q:CANopenObjectList></q:ApplicationLayers></c:ProfileBody></c:ISO15745Profile>"
      "</c:ISO15745ProfileContainer>");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.sheet.objects.size(), 1U);
}

TEST(Xdd, ReadsTheTextInUtf8WhateverItsDeclarationSays) {
  const ReadXdd read("<?xml version='1.0' encoding='UTF-16'?>" +
                     Profile{"<CANopenObject index='2000' name='W\xC3\xA4rme'/>", "", "", ""}.text());
  EXPECT_EQ(read.object().parameter_name.text, "W\xC3\xA4rme");
  const ReadXdd windows("<?xml version='1.0' encoding='utf-8'?>" +
                        Profile{"<CANopenObject index='2000' name='W\xE4rme'/>", "", "", ""}.text());
  EXPECT_EQ(windows.object().parameter_name.text, "W\xC3\xA4rme");
}

TEST(Xdd, ReadsUtf16) {
  std::string wide = "\xFF\xFE";
  for (const char c : Profile{"<CANopenObject index='2000' name='x'/>", "", "", ""}.text()) wide += {c, '\0'};
  EXPECT_EQ(ReadXdd(wide).object().parameter_name.text, "x");
}

TEST(Xdd, WarnsOfADocumentTypeDeclaration) {
  const ReadXdd read("<!DOCTYPE ISO15745ProfileContainer [<!ENTITY e 'x'>]>" +
                     Profile{"<CANopenObject index='2000' name='&e;'/>", "", "", ""}.text());
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(0, 0, "xml-element")}));
  EXPECT_EQ(read.object().parameter_name.text, "&e;");
}

TEST(Xdd, NotesADocumentTypeDeclarationWithoutEffect) {
  const std::string object = Profile{"<CANopenObject index='2000' name='&lt;&#65;&amp;'/>", "", "", ""}.text();
  const ReadXdd read("<!DOCTYPE ISO15745ProfileContainer SYSTEM 'profile.dtd'>" + object);
  EXPECT_EQ(findings(read.diagnostics), (Findings{note_at(0, 0, "xml-element")}));
  EXPECT_EQ(read.object().parameter_name.text, "<A&");
  const ReadXdd external("<!DOCTYPE ISO15745ProfileContainer SYSTEM 'profile.dtd'>" +
                         Profile{"<CANopenObject index='2000' name='&e;'/>", "", "", ""}.text());
  EXPECT_EQ(findings(external.diagnostics), (Findings{warning_at(0, 0, "xml-element")}));
}

TEST(Xdd, KeepsTextThatDoesNotStandInTheFileLikeThat) {
  DataSheet copy;
  SourceFile source("test.xdd", Profile{"<CANopenObject index='2000' name=' a &lt; &#66;&amp;c ' dataType='0005'/>", "",
                                        "<vendorName> M<!-- - -->&amp;<![CDATA[S ]]></vendorName>", ""}
                                    .text());
  {
    Diagnostics diagnostics;
    const DataSheet sheet = read_xdd(source, diagnostics);
    copy = sheet;
  }
  EXPECT_EQ(copy.objects.at(0).parameter_name.text, "a < B&c");
  EXPECT_EQ(copy.objects.at(0).parameter_name.position.column, 36U);
  EXPECT_EQ(copy.objects.at(0).data_type.text, "0x0005");
  EXPECT_EQ(copy.device_info.vendor_name.text, "M&S");
}

// ---- PDOmapping and access ----

struct MappingCase {
  std::string_view access, mapping;
  std::string_view eds_access, eds_mapping;
  std::size_t warnings;
};

TEST(XddMapping, RestrictsTheDirectionByTheAccess) {
  constexpr MappingCase cases[] = {
      {"rw", "no", "rw", "0", 0},    {"rw", "optional", "rw", "1", 0}, {"rw", "default", "rw", "1", 0},
      {"rw", "TPDO", "rwr", "1", 0}, {"rw", "RPDO", "rww", "1", 0},    {"ro", "TPDO", "ro", "1", 0},
      {"wo", "RPDO", "wo", "1", 0},  {"rww", "RPDO", "rww", "1", 0},   {"const", "TPDO", "const", "1", 0},
      {"ro", "RPDO", "ro", "0", 1},  {"wo", "TPDO", "wo", "0", 1},     {"rwr", "RPDO", "rwr", "0", 1}};
  for (const MappingCase& one : cases) {
    const ReadXdd read(Profile{"<CANopenObject index='2000' accessType='" + std::string{one.access} + "' PDOmapping='" +
                                   std::string{one.mapping} + "'/>",
                               "", "", ""});
    EXPECT_EQ(read.object().access_type.text, one.eds_access) << one.access << " " << one.mapping;
    EXPECT_EQ(read.object().pdo_mapping.text, one.eds_mapping) << one.access << " " << one.mapping;
    EXPECT_EQ(findings(read.diagnostics, "pdo-mapping").size(), one.warnings) << one.access << " " << one.mapping;
  }
}

// ---- the device as a whole ----

const std::string one_xdd_object = "<CANopenObject index='1000'/>";

TEST(XddDevice, ReadsIdentityAndFeatures) {
  const ReadXdd read(Profile{
      one_xdd_object, "",
      "<vendorName>Maker</vendorName><vendorID>00000319</vendorID><productName>Pump</productName><productID>17</"
      "productID>"
      "<orderNumber>P-17</orderNumber><version versionType='FW'>1.2</version>",
      "<NetworkManagement><CANopenGeneralFeatures granularity='08' nrOfRxPDO='4' nrOfTxPDO='2' bootUpSlave='true' "
      "layerSettingServiceSlave='false' groupMessaging='0' dynamicChannels='0'/><CANopenMasterFeatures "
      "bootUpMaster='false'/>"
      "</NetworkManagement><TransportLayers><PhysicalLayer><baudRate><supportedBaudRate value='125 Kbps'/>"
      "<supportedBaudRate value='1000 Kbps'/><supportedBaudRate value='auto-baudRate'/></baudRate></PhysicalLayer>"
      "</TransportLayers>"});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const DeviceInfo& info = read.sheet.device_info;
  EXPECT_TRUE(info.present);
  EXPECT_EQ(info.position.line, 2U);
  EXPECT_EQ(info.vendor_name.text, "Maker");
  EXPECT_EQ(info.vendor_number.text, "0x00000319");
  EXPECT_EQ(info.product_name.text, "Pump");
  EXPECT_EQ(info.product_number.text, "17");
  EXPECT_EQ(info.order_code.text, "P-17");
  EXPECT_EQ(info.granularity.text, "8");
  EXPECT_EQ(info.nr_of_rx_pdo.text, "4");
  EXPECT_EQ(info.nr_of_tx_pdo.text, "2");
  EXPECT_EQ(info.simple_boot_up_slave.text, "1");
  EXPECT_EQ(info.simple_boot_up_master.text, "0");
  EXPECT_EQ(info.lss_supported.text, "0");
  ASSERT_EQ(info.baud_rates.size(), 2U);
  EXPECT_EQ(info.baud_rates[1].kbit_per_second, 1000);
  EXPECT_EQ(info.baud_rates[1].field.text, "1");
  EXPECT_FALSE(read.sheet.is_dcf);
}

TEST(XddDevice, ReadsTheInformationOnTheFile) {
  const ReadXdd read(
      "<ISO15745Profile><ProfileBody fileName='pump.xdd' fileVersion='1' fileCreator='me' "
      "fileCreationDate='2024-05-31' "
      "fileCreationTime='00:05:59Z' fileModificationDate='soon' fileModificationTime='14:07:00+02:00' "
      "fileModifiedBy='you'>"
      "<DeviceIdentity><productText><description lang='en'>A pump</description></productText></DeviceIdentity>"
      "<ApplicationLayers><CANopenObjectList>" +
      one_xdd_object + "</CANopenObjectList></ApplicationLayers></ProfileBody></ISO15745Profile>");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const FileInfo& info = read.sheet.file_info;
  EXPECT_EQ(info.file_name.text, "pump.xdd");
  EXPECT_EQ(info.file_version.text, "1");
  EXPECT_EQ(info.created_by.text, "me");
  EXPECT_EQ(info.modified_by.text, "you");
  EXPECT_EQ(info.creation_date.text, "05-31-2024");
  EXPECT_EQ(info.creation_time.text, "12:05AM");
  EXPECT_EQ(info.modification_date.text, "soon");
  EXPECT_EQ(info.modification_time.text, "02:07PM");
  EXPECT_EQ(info.description.text, "A pump");
}

TEST(XddDevice, IsAConfigurationWhenItIsCommissioned) {
  const ReadXdd read(
      Profile{one_xdd_object, "", "",
              "<NetworkManagement><deviceCommissioning NodeID='005' nodeName='left' actualBaudRate='500 Kbps' "
              "networkNumber='1' networkName='line' CANopenManager='true'/></NetworkManagement>"});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const DeviceCommissioning& commissioning = read.sheet.commissioning;
  EXPECT_TRUE(read.sheet.is_dcf);
  EXPECT_TRUE(commissioning.present);
  EXPECT_EQ(commissioning.node_id.text, "5");
  EXPECT_EQ(commissioning.node_name.text, "left");
  EXPECT_EQ(commissioning.baudrate.text, "500");
  EXPECT_EQ(commissioning.net_number.text, "1");
  EXPECT_EQ(commissioning.network_name.text, "line");
  EXPECT_EQ(commissioning.canopen_manager.text, "1");
  EXPECT_TRUE(ReadXdd(Profile{one_xdd_object, "", "", ""}, "pump.XDC").sheet.is_dcf);
}

TEST(XddDevice, ReadsDummyUsage) {
  const ReadXdd read(
      "<ISO15745Profile><ProfileBody fileName='pump.xdd'><ApplicationLayers><dummyUsage><dummy entry='Dummy0005=1'/>"
      "<dummy entry='Dummy0006=0'/>\n<dummy entry='Dummy'/></dummyUsage><CANopenObjectList>" +
      one_xdd_object + "</CANopenObjectList></ApplicationLayers></ProfileBody></ISO15745Profile>");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(2, 2, "xml-element")}));
  ASSERT_EQ(read.sheet.dummy_usage.size(), 2U);
  EXPECT_EQ(read.sheet.dummy_usage[0].number, 5U);
  EXPECT_EQ(read.sheet.dummy_usage[0].field.text, "1");
  EXPECT_EQ(read.sheet.dummy_usage[1].field.text, "0");
  EXPECT_EQ(read.sheet.file_info.file_name.text, "pump.xdd");
}

// ---- errors ----

TEST(XddErrors, ReportsWhatIsNotWellFormed) {
  EXPECT_EQ(findings(ReadXdd("<a>\n  <b></c>\n</a>").diagnostics), (Findings{error_at(2, 8, "xml-syntax")}));
  EXPECT_EQ(findings(ReadXdd("<a>\n<b>").diagnostics).size(), 1U);
  EXPECT_EQ(findings(ReadXdd("<").diagnostics).size(), 1U);
  EXPECT_EQ(findings(ReadXdd("<a>\n \x01</a>").diagnostics), (Findings{error_at(2, 2, "xml-syntax")}));
  EXPECT_TRUE(ReadXdd("<a><b>").sheet.objects.empty());
}

TEST(XddErrors, ReportsXmlThatIsNoProfile) {
  EXPECT_EQ(findings(ReadXdd("<html/>").diagnostics), (Findings{error_at(1, 2, "xml-profile")}));
  EXPECT_EQ(findings(ReadXdd("<ISO15745ProfileContainer/>").diagnostics), (Findings{error_at(1, 2, "xml-profile")}));
  const ReadXdd other(
      "<ISO15745ProfileContainer><ISO15745Profile><ProfileBody xsi:type='ProfileBody_Device_Powerlink'/>"
      "</ISO15745Profile></ISO15745ProfileContainer>");
  EXPECT_EQ(findings(other.diagnostics, "xml-profile").size(), 1U);
  EXPECT_EQ(findings(other.diagnostics, "xml-element").size(), 1U);
}

TEST(XddErrors, NameTheFileOfAnotherNetwork) {
  const auto message = [](const std::string& text) { return messages(ReadXdd(text).diagnostics).back(); };
  const auto of_type = [](const std::string& type) {
    return "<ISO15745ProfileContainer><ISO15745Profile><ProfileBody xsi:type='" + type +
           "'/></ISO15745Profile></ISO15745ProfileContainer>";
  };
  constexpr const char* end = ", not an XDD or XDC of CiA 311; it does not describe a CANopen device";
  EXPECT_EQ(message(of_type("ProfileBody_Device_Powerlink")), std::string{"this is an Ethernet POWERLINK XDD"} + end);
  EXPECT_EQ(message(of_type("ProfileBody_Device_CANopenFD")),
            std::string{"this is a CANopen FD device description (CiA 1301)"} + end);
  EXPECT_EQ(message("<EtherCATInfo/>"), std::string{"this is an EtherCAT slave information file"} + end);
}

TEST(XddDevice, TakesItsIdentityFromItsObjects) {
  const std::string identity =
      "<CANopenObject index='1018' name='Identity' objectType='9' subNumber='4'>"
      "<CANopenSubObject subIndex='00' name='N' objectType='7' dataType='0005' accessType='const' defaultValue='3'/>"
      "<CANopenSubObject subIndex='01' name='V' objectType='7' dataType='0007' accessType='ro' defaultValue='0x319'/>"
      "<CANopenSubObject subIndex='02' name='P' objectType='7' dataType='0007' accessType='ro' defaultValue='17'/>"
      "<CANopenSubObject subIndex='03' name='R' objectType='7' dataType='0007' accessType='ro' defaultValue='0x10000'/>"
      "</CANopenObject>";
  const ReadXdd read(Profile{identity, "", "<vendorName>Maker</vendorName><vendorID/><productID>20</productID>"});
  EXPECT_EQ(read.sheet.device_info.vendor_number.text, "0x319");
  EXPECT_EQ(read.sheet.device_info.product_number.text, "20");
  EXPECT_EQ(read.sheet.device_info.revision_number.text, "0x10000");
}

TEST(XddErrors, NotesAProfileOfAnotherNetwork) {
  const ReadXdd read(
      "<ISO15745ProfileContainer>\n<ISO15745Profile><ProfileBody xsi:type='ProfileBody_Device_Powerlink'/></ISO15745Profile>"
      "<ISO15745Profile><ProfileBody><ApplicationLayers><CANopenObjectList>" +
      one_xdd_object +
      "</CANopenObjectList></ApplicationLayers></ProfileBody></ISO15745Profile></ISO15745ProfileContainer>");
  EXPECT_EQ(findings(read.diagnostics), (Findings{note_at(2, 19, "xml-element")}));
  EXPECT_EQ(read.sheet.objects.size(), 1U);
}

TEST(XddErrors, ReportsAnEmptyObjectList) {
  EXPECT_EQ(findings(ReadXdd(Profile{}).diagnostics, "no-objects").size(), 1U);
}

TEST(XddErrors, WarnsOnceOfWhatItDoesNotKnow) {
  const ReadXdd read(
      Profile{"<CANopenObject index='1000' colour='red'/>\n<CANopenObject index='1001' colour='red'/>"
              "<Gadget/><Gadget/>",
              parameter("<UINT/>"), "<shoeSize/>", "<moduleManagement/>"});
  EXPECT_EQ(findings(read.diagnostics, "xml-element").size(), 4U);
  EXPECT_EQ(findings(read.diagnostics).size(), 4U);
}

TEST(XddErrors, KeepsTheFirstOfTwoAttributes) {
  const ReadXdd read(Profile{"<CANopenObject index='1000' name='a' name='b'/>", "", "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(first_line, 38, "duplicate-key")}));
  EXPECT_EQ(read.object().parameter_name.text, "a");
}

TEST(XddErrors, SurvivesAnyDepth) {
  std::string deep;
  for (int i = 0; i < 300'000; ++i) deep += "<a>";
  EXPECT_EQ(findings(ReadXdd(deep).diagnostics, "xml-syntax").size(), 1U);
  std::string closed = deep;
  for (int i = 0; i < 300'000; ++i) closed += "</a>";
  EXPECT_EQ(findings(ReadXdd(closed).diagnostics, "xml-profile").size(), 1U);
}

}  // namespace
}  // namespace edsc

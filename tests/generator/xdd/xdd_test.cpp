#include "xdd/read_xdd.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "backend/cpp/name_objects.hpp"
#include "backend/json/device_view.hpp"
#include "device/resolve.hpp"
#include "eds/ini.hpp"
#include "lint/check_device.hpp"
#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using Findings = std::vector<Finding>;

/// A short profile container: the device profile is on line 2, the network profile starts on line 3.
struct Profile {
  std::string objects;
  std::string process;
  std::string identity;
  std::string network;

  [[nodiscard]] std::string text() const {
    return "<ISO15745ProfileContainer xmlns:xsi='x'><ISO15745Profile><ProfileBody "
           "xsi:type='ProfileBody_Device_CANopen'>\n"
           "<DeviceIdentity>" +
           identity + "</DeviceIdentity><ApplicationProcess>" + process +
           "</ApplicationProcess>"
           "</ProfileBody></ISO15745Profile><ISO15745Profile>"
           "<ProfileBody xsi:type='ProfileBody_CommunicationNetwork_CANopen'>\n"
           "<ApplicationLayers><CANopenObjectList>\n" +
           objects + "</CANopenObjectList></ApplicationLayers>" + network +
           "</ProfileBody></ISO15745Profile></ISO15745ProfileContainer>\n";
  }
};

/// Line of the first of `Profile::objects`.
constexpr std::uint32_t first_line = 4;

struct ReadXdd {
  explicit ReadXdd(std::string text, std::string name = "test.xdd")
      : source(std::move(name), std::move(text)), sheet(read_xdd(source, diagnostics)) {}
  explicit ReadXdd(const Profile& profile, std::string name = "test.xdd") : ReadXdd(profile.text(), std::move(name)) {}

  [[nodiscard]] const ObjectDescription& object(std::size_t at = 0) const { return sheet.objects.at(at); }

  SourceFile source;
  Diagnostics diagnostics;
  DataSheet sheet;
};

/// A VAR that refers to the parameter `p`.
const std::string referring_object = "<CANopenObject index='2000' name='x' objectType='7' uniqueIDRef='p'/>";

std::string parameter(std::string_view inside, std::string_view attributes = "") {
  return "<parameterList><parameter uniqueID='p' " + std::string{attributes} + ">" + std::string{inside} +
         "</parameter></parameterList>";
}

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

// ---- the parameters that objects refer to ----

TEST(XddParameter, GivesTypeAccessValuesAndLimits) {
  const ReadXdd read(
      Profile{referring_object,
              parameter("<label lang='de'>Drehzahl</label><label "
                        "lang='en'>Speed</label><UINT/><denotation><label>axis</label></denotation>"
                        "<actualValue value='8'/><defaultValue value='7'/><allowedValues><range><minValue value='1'/>"
                        "<maxValue value='9'/></range></allowedValues>",
                        "access='readWrite'"),
              "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const ObjectDescription& object = read.object();
  EXPECT_EQ(object.parameter_name.text, "x");
  EXPECT_EQ(object.data_type.text, "0x0006");
  EXPECT_EQ(object.access_type.text, "rw");
  EXPECT_EQ(object.default_value.text, "7");
  EXPECT_EQ(object.default_value.position.line, 2U);
  EXPECT_EQ(object.parameter_value.text, "8");
  EXPECT_EQ(object.low_limit.text, "1");
  EXPECT_EQ(object.high_limit.text, "9");
  EXPECT_EQ(object.denotation.text, "axis");
}

TEST(XddParameter, NamesAnObjectWithoutName) {
  const ReadXdd read(Profile{"<CANopenObject index='2000' uniqueIDRef='p'/>",
                             parameter("<label lang='de'>Drehzahl</label><label lang='en'>Speed</label>"), "", ""});
  EXPECT_EQ(read.object().parameter_name.text, "Speed");
}

TEST(XddParameter, IsReadOnlyWhenNeitherItNorTheObjectSaysMore) {
  EXPECT_EQ(ReadXdd(Profile{referring_object, parameter("<UINT/>"), "", ""}).object().access_type.text, "ro");
  const ReadXdd own(
      Profile{"<CANopenObject index='2000' accessType='rw' uniqueIDRef='p'/>", parameter("<UINT/>"), "", ""});
  EXPECT_EQ(own.object().access_type.text, "rw");
}

struct AccessCase {
  std::string_view word;
  std::string_view access_type;
};

TEST(XddParameter, SpellsTheAccessAsAnEdsDoes) {
  constexpr AccessCase cases[] = {{"const", "const"},        {"read", "ro"},
                                  {"write", "wo"},           {"readWrite", "rw"},
                                  {"readWriteInput", "rwr"}, {"readWriteOutput", "rww"}};
  for (const AccessCase& one : cases) {
    const ReadXdd document(
        Profile{referring_object, parameter("<INT/>", "access='" + std::string{one.word} + "'"), "", ""});
    EXPECT_EQ(document.object().access_type.text, one.access_type);
  }
  const ReadXdd none(Profile{referring_object, parameter("<INT/>", "access='noAccess'"), "", ""});
  EXPECT_EQ(none.object().access_type.text, "ro");
  EXPECT_EQ(findings(none.diagnostics).size(), 1U);
}

struct TypeCase {
  std::string_view name;
  std::string_view data_type;
};

TEST(XddParameter, TakesTheTypesOfIec61131ForThoseOfCanopen) {
  constexpr TypeCase cases[] = {{"BOOL", "0x0001"},   {"SINT", "0x0002"},  {"INT", "0x0003"},   {"DINT", "0x0004"},
                                {"LINT", "0x0015"},   {"USINT", "0x0005"}, {"UINT", "0x0006"},  {"UDINT", "0x0007"},
                                {"ULINT", "0x001B"},  {"BYTE", "0x0005"},  {"WORD", "0x0006"},  {"DWORD", "0x0007"},
                                {"LWORD", "0x001B"},  {"REAL", "0x0008"},  {"LREAL", "0x0011"}, {"STRING", "0x0009"},
                                {"WSTRING", "0x000B"}};
  for (const TypeCase& one : cases) {
    const ReadXdd read(Profile{referring_object, parameter("<" + std::string{one.name} + "/>"), "", ""});
    EXPECT_EQ(read.object().data_type.text, one.data_type) << one.name;
  }
}

TEST(XddParameter, TakesABitStringWithoutValueForADomain) {
  EXPECT_EQ(ReadXdd(Profile{referring_object, parameter("<BITSTRING/>"), "", ""}).object().data_type.text, "0x000F");
  const ReadXdd bytes(Profile{referring_object, parameter("<BITSTRING/><defaultValue value='01 FF'/>"), "", ""});
  EXPECT_EQ(bytes.object().data_type.text, "0x000A");
}

TEST(XddParameter, SpellsTruthAsANumber) {
  const ReadXdd read(Profile{referring_object + "<CANopenObject index='2001' dataType='01' defaultValue='false'/>",
                             parameter("<BOOL/><defaultValue value='true'/>"), "", ""});
  EXPECT_EQ(read.object(0).default_value.text, "1");
  EXPECT_EQ(read.object(1).default_value.text, "0");
}

TEST(XddParameter, FollowsEnumsAndDerivedTypes) {
  const ReadXdd read(Profile{referring_object,
                             "<dataTypeList><derived uniqueID='d'><dataTypeIDRef uniqueIDRef='e'/></derived>"
                             "<enum uniqueID='e'><USINT/><enumValue value='0'/></enum></dataTypeList>" +
                                 parameter("<dataTypeIDRef uniqueIDRef='d'/>"),
                             "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.object().data_type.text, "0x0005");
}

TEST(XddParameter, EndsAtATypeThatIsDerivedFromItself) {
  const ReadXdd read(
      Profile{referring_object,
              "<dataTypeList><derived uniqueID='d'><dataTypeIDRef uniqueIDRef='d'/></derived></dataTypeList>" +
                  parameter("<dataTypeIDRef uniqueIDRef='d'/>"),
              "", ""});
  EXPECT_FALSE(read.object().data_type.present);
}

TEST(XddParameter, GivesSubObjectsTheTypesOfItsArrayOrStruct) {
  const ReadXdd read(
      Profile{"<CANopenObject index='2000' objectType='8' uniqueIDRef='p'><CANopenSubObject subIndex='00' "
              "dataType='0005' accessType='const'/>"
              "<CANopenSubObject subIndex='01' PDOmapping='RPDO'/></CANopenObject>"
              "<CANopenObject index='2001' objectType='9' uniqueIDRef='q'><CANopenSubObject subIndex='01' "
              "name='ratio'/></CANopenObject>",
              "<dataTypeList><array uniqueID='a'><subrange lowerLimit='0' upperLimit='1'/><DINT/></array>"
              "<struct uniqueID='s'><varDeclaration name='count' uniqueID='v'><USINT/></varDeclaration>"
              "<varDeclaration name='ratio' uniqueID='w'><REAL/></varDeclaration></struct></dataTypeList>"
              "<parameterList><parameter uniqueID='p' access='readWrite'><dataTypeIDRef uniqueIDRef='a'/></parameter>"
              "<parameter uniqueID='q'><dataTypeIDRef uniqueIDRef='s'/></parameter></parameterList>",
              "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const auto& array = read.object(0).sub_objects;
  EXPECT_EQ(array.at(0).data_type.text, "0x0005");
  EXPECT_EQ(array.at(0).access_type.text, "const");
  EXPECT_EQ(array.at(1).data_type.text, "0x0004");
  EXPECT_EQ(array.at(1).access_type.text, "rww");
  EXPECT_EQ(read.object(1).sub_objects.at(0).data_type.text, "0x0008");
  EXPECT_EQ(read.object(1).sub_objects.at(0).access_type.text, "ro");
}

TEST(XddParameter, LeavesToItsTemplateWhatItDoesNotSay) {
  const ReadXdd read(
      Profile{referring_object,
              "<templateList><parameterTemplate uniqueID='t' access='readWrite'><UINT/><defaultValue value='1'/>"
              "</parameterTemplate></templateList>" +
                  parameter("<defaultValue value='2'/>", "templateIDRef='t'"),
              "", ""});
  EXPECT_EQ(read.object().data_type.text, "0x0006");
  EXPECT_EQ(read.object().access_type.text, "rw");
  EXPECT_EQ(read.object().default_value.text, "2");
}

TEST(XddParameter, WarnsOfAllowedValuesThatAreNoRange) {
  const ReadXdd read(Profile{referring_object,
                             parameter("<UINT/><allowedValues><value value='1'/><value value='5'/></allowedValues>"),
                             "", ""});
  EXPECT_EQ(findings(read.diagnostics, "xml-element").size(), 1U);
  EXPECT_FALSE(read.object().low_limit.present);
}

TEST(XddParameter, WarnsOfAReferenceToNothing) {
  const ReadXdd read(Profile{referring_object, "", "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(first_line, 66, "xml-element")}));
}

TEST(XddParameter, LeavesOutAnObjectThatCanopenEditorHasDisabled) {
  const ReadXdd read(Profile{referring_object + "<CANopenObject index='2001'/>",
                             parameter("<UINT/><property name='CO_disabled' value='true'/>"), "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{note_at(first_line, 2, "xml-element")}));
  ASSERT_EQ(read.sheet.objects.size(), 1U);
  EXPECT_EQ(read.object().index, 0x2001);
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

// ---- the same device as EDS and XDD ----

const std::string pump_eds =
    "[DeviceInfo]\nVendorName=Maker & Sons\nVendorNumber=0x319\nProductName=Pump\nProductNumber=17\n"
    "[DummyUsage]\nDummy0005=1\n"
    "[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n"
    "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x00000191\n"
    "[1001]\nParameterName=Error register\nObjectType=0x7\nDataType=0x0005\nAccessType=ro\nPDOMapping=1\n"
    "[1018]\nParameterName=Identity\nObjectType=0x9\nSubNumber=2\n"
    "[1018sub0]\nParameterName=Highest sub-index supported\nDataType=0x0005\nAccessType=const\nDefaultValue=1\n"
    "[1018sub1]\nParameterName=Vendor-ID\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x319\n"
    "[OptionalObjects]\nSupportedObjects=2\n1=0x1400\n2=0x1600\n"
    "[1400]\nParameterName=RPDO\nObjectType=0x9\nSubNumber=3\n"
    "[1400sub0]\nParameterName=Highest sub-index supported\nDataType=0x0005\nAccessType=const\nDefaultValue=2\n"
    "[1400sub1]\nParameterName=COB-ID\nDataType=0x0007\nAccessType=rw\nDefaultValue=$NODEID+0x200\n"
    "[1400sub2]\nParameterName=Transmission type\nDataType=0x0005\nAccessType=rw\nDefaultValue=254\n"
    "[1600]\nParameterName=RPDO mapping\nObjectType=0x9\nSubNumber=3\n"
    "[1600sub0]\nParameterName=Mapped objects\nDataType=0x0005\nAccessType=rw\nDefaultValue=2\n"
    "[1600sub1]\nParameterName=Mapping 1\nDataType=0x0007\nAccessType=rw\nDefaultValue=0x20000010\n"
    "[1600sub2]\nParameterName=Mapping 2\nDataType=0x0007\nAccessType=rw\nDefaultValue=0x00050008\n"
    "[ManufacturerObjects]\nSupportedObjects=4\n1=0x2000\n2=0x2001\n3=0x2002\n4=0x2003\n"
    "[2000]\nParameterName=Speed\nObjectType=0x7\nDataType=0x0006\nAccessType=rww\nLowLimit=10\nHighLimit=3000\n"
    "DefaultValue=100\nPDOMapping=1\n"
    "[2001]\nParameterName=Running\nObjectType=0x7\nDataType=0x0001\nAccessType=ro\nDefaultValue=1\nPDOMapping=1\n"
    "[2002]\nParameterName=Gain\nObjectType=0x7\nDataType=0x0008\nAccessType=rw\nDefaultValue=1.5\n"
    "[2003]\nParameterName=Log\nObjectType=0x7\nDataType=0x000F\nAccessType=ro\n";

const Profile pump_xdd{
    "<CANopenObject index='2000' name='Speed' objectType='7' PDOmapping='RPDO' uniqueIDRef='speed'/>"
    "<CANopenObject index='2001' name='Running' objectType='7' PDOmapping='TPDO' uniqueIDRef='running'/>"
    "<CANopenObject index='2002' name='Gain' objectType='7' PDOmapping='no' uniqueIDRef='gain'/>"
    "<CANopenObject index='2003' name='Log' objectType='7' uniqueIDRef='log'/>"
    "<CANopenObject index='1000' name='Device type' objectType='7' dataType='0007' accessType='ro' "
    "defaultValue='0x191'/>"
    "<CANopenObject index='1001' name='Error register' objectType='7' dataType='05' accessType='ro' "
    "PDOmapping='optional'/>"
    "<CANopenObject index='1018' name='Identity' objectType='9' subNumber='2'>"
    "<CANopenSubObject subIndex='00' name='Highest sub-index supported' objectType='7' dataType='0005' "
    "accessType='const' "
    "defaultValue='1'/><CANopenSubObject subIndex='01' name='Vendor-ID' objectType='7' dataType='0007' accessType='ro' "
    "defaultValue='0x319'/></CANopenObject>"
    "<CANopenObject index='1400' name='RPDO' objectType='9' subNumber='3'>"
    "<CANopenSubObject subIndex='00' name='Highest sub-index supported' objectType='7' dataType='0005' "
    "accessType='const' "
    "defaultValue='2'/><CANopenSubObject subIndex='01' name='COB-ID' objectType='7' dataType='0007' accessType='rw' "
    "defaultValue='$NODEID+0x200'/><CANopenSubObject subIndex='02' name='Transmission type' objectType='7' "
    "dataType='0005' "
    "accessType='rw' defaultValue='254'/></CANopenObject>"
    "<CANopenObject index='1600' name='RPDO mapping' objectType='9' subNumber='3'>"
    "<CANopenSubObject subIndex='00' name='Mapped objects' objectType='7' dataType='0005' accessType='rw' "
    "defaultValue='2'/>"
    "<CANopenSubObject subIndex='01' name='Mapping 1' objectType='7' dataType='0007' accessType='rw' "
    "defaultValue='0x20000010'/><CANopenSubObject subIndex='02' name='Mapping 2' objectType='7' dataType='0007' "
    "accessType='rw' defaultValue='0x00050008'/></CANopenObject>",
    "<parameterList><parameter uniqueID='speed' access='readWrite'><UINT/><defaultValue "
    "value='100'/><allowedValues><range>"
    "<minValue value='10'/><maxValue value='3000'/></range></allowedValues></parameter>"
    "<parameter uniqueID='running' access='read'><BOOL/><defaultValue value='true'/></parameter>"
    "<parameter uniqueID='gain' access='readWrite'><REAL/><defaultValue value='1.5'/></parameter>"
    "<parameter uniqueID='log'><BITSTRING/></parameter></parameterList>",
    "<vendorName>Maker &amp; Sons</vendorName><vendorID>0x319</vendorID><productName>Pump</productName>"
    "<productID>17</productID>",
    ""};

/// The view without members that depend on the file.
nlohmann::ordered_json view_of(const DataSheet& sheet, Diagnostics& diagnostics) {
  const Options options;
  Device device = resolve_device(sheet, options, {}, diagnostics);
  name_objects(device, options, "pump");
  check_device(device, sheet, options, diagnostics);
  nlohmann::ordered_json view = device_view(device).flatten();
  for (auto row = view.begin(); row != view.end();) {
    row = row.key().ends_with("/line") || row.key() == "/source" ? view.erase(row) : std::next(row);
  }
  return view;
}

/// The rules with findings, except the one about a section that XML does not have.
std::set<std::string> rule_set_of(const Diagnostics& diagnostics) {
  std::set<std::string> rules;
  for (const Diagnostic& diagnostic : diagnostics.all()) rules.emplace(diagnostic.rule);
  rules.erase("file-info");
  return rules;
}

TEST(Xdd, GivesTheDeviceAndTheFindingsThatAnEdsOfItGives) {
  std::string text = pump_xdd.text();
  text.insert(text.find("</ApplicationLayers>"), "<dummyUsage><dummy entry='Dummy0005=1'/></dummyUsage>");
  const SourceFile eds("pump.eds", pump_eds);
  const SourceFile xdd("pump.xdd", text);
  Diagnostics of_eds;
  Diagnostics of_xdd;
  const auto from_eds = view_of(read_data_sheet(parse_ini(eds, of_eds), of_eds), of_eds);
  const auto from_xdd = view_of(read_xdd(xdd, of_xdd), of_xdd);
  EXPECT_EQ(from_eds.dump(1), from_xdd.dump(1));
  EXPECT_EQ(from_xdd["/pdos/0/bits"], 24);
  EXPECT_EQ(of_xdd.errors(), 0U);
  EXPECT_EQ(rule_set_of(of_eds), rule_set_of(of_xdd));
}

TEST(Xdd, GivesTheConfiguredValuesOfAnXdc) {
  Diagnostics diagnostics;
  const SourceFile xdc("pump.xdc",
                       Profile{"<CANopenObject index='2000' name='x' objectType='7' dataType='0007' "
                               "accessType='rw' defaultValue='1' actualValue='$NODEID+0x10'/>",
                               "", "", "<NetworkManagement><deviceCommissioning nodeID='5'/></NetworkManagement>"}
                           .text());
  const DataSheet sheet = read_xdd(xdc, diagnostics);
  const Device device = resolve_device(sheet, {}, {}, diagnostics);
  EXPECT_EQ(findings(diagnostics), Findings{});
  EXPECT_EQ(device.node_id, 5);
  EXPECT_EQ(device.objects.at(0).entries.at(0).default_value->bits, 0x15U);
}

}  // namespace
}  // namespace edsc

/// The same device as EDS and as XDD.
#include "xdd/read_xdd.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "backend/json/device_view.hpp"
#include "device/resolve.hpp"
#include "eds/ini.hpp"
#include "lint/check_device.hpp"
#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"
#include "xdd_profile.hpp"

namespace edsc {
namespace {

using Findings = std::vector<Finding>;

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
  const Device device = resolve_device(sheet, options, {}, diagnostics);
  const CppNames names{device, options, "pump"};
  check_device({device, names}, sheet, options, diagnostics);
  nlohmann::ordered_json view = device_view(device, names.identifiers()).flatten();
  for (auto row = view.begin(); row != view.end();) {
    row = row.key().ends_with("/line") || row.key() == "/source" ? view.erase(row) : std::next(row);
  }
  return view;
}

/// The rules with findings, except the one about a section that XML does not have.
std::set<std::string> rule_set_of(const Diagnostics& diagnostics) {
  std::set<std::string> rules;
  for (const Diagnostic& diagnostic : diagnostics.all()) rules.emplace(diagnostic.rule.text());
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

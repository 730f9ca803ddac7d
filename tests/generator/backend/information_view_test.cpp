/// The parts of the JSON view that do not describe objects. docs/schema/device.schema.json has their names.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "backend/cpp/cpp_view.hpp"
#include "backend/json/device_view.hpp"
#include "diagnostics/diagnostics.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using nlohmann::json;

/// The view of a device with these sections and one object.
json sections_view(const std::string& sections) {
  const DeviceFromText text(sections + var("2000", "Value", "5"));
  return device_view(text.device, text.names.identifiers());
}

TEST(InformationView, HasTheNameOfTheFileWithoutFolders) {
  for (const std::string path : {"drive \xC3\xA4.eds", "/eds/drive \xC3\xA4.eds", "C:\\EDS\\drive \xC3\xA4.eds"}) {
    const DeviceFromText text(var("2000", "Value", "5"), {}, {}, path);
    Diagnostics diagnostics;
    EXPECT_EQ(device_view(text.device, text.names.identifiers())["source"], "drive \xC3\xA4.eds") << path;
    EXPECT_EQ(cpp_view(text.named(), {}, diagnostics)["file"], "drive \xC3\xA4.eds") << path;
  }
}

TEST(InformationView, HasTheFileInfoAsWritten) {
  EXPECT_EQ(sections_view("[FileInfo]\nFileVersion=02\nCreationDate=03-25-2016\nModifiedBy=me\n")["file_info"],
            json::parse(R"({"file_version": "02", "creation_date": "03-25-2016", "modified_by": "me"})"));
}

TEST(InformationView, HasWhatTheDeviceInfoStates) {
  EXPECT_EQ(sections_view("[DeviceInfo]\nOrderCode=A-1\nBaudRate_500=1\nBaudRate_125=1\nBaudRate_10=0\nGranularity=8\n"
                          "SimpleBootUpMaster=0\nNrOfRXPDO=2\nLSS_Supported=1\nCompactPDO=0x17\n")["device_info"],
            json::parse(R"({"order_code": "A-1", "baud_rates": [125, 500], "simple_boot_up_master": false,
                            "lss_supported": true, "granularity": 8, "nr_of_rx_pdo": 2, "compact_pdo": 23})"));
}

TEST(InformationView, HasTheCommissioningOfADcf) {
  EXPECT_EQ(sections_view("")["commissioning"], nullptr);
  EXPECT_EQ(sections_view("[DeviceComissioning]\nNodeID=5\nNodeName=Lift\nBaudrate=250\nNetNumber=1\nNetworkName=Line\n"
                          "CANopenManager=1\nLSS_SerialNumber=16\nNodeRefd=N1\nNetRefd=L1\n")["commissioning"],
            json::parse(R"({"node_name": "Lift", "network_name": "Line", "node_refd": "N1", "net_refd": "L1",
                            "baudrate": 250, "net_number": 1, "lss_serial_number": 16, "canopen_manager": true})"));
}

TEST(InformationView, HasCommentsAndTools) {
  const json view =
      sections_view("[Comments]\nLines=2\nLine1=a\nLine2=b\n[Tools]\nItems=1\n[Tool1]\nName=Setup\nCommand=s 1\n");
  EXPECT_EQ(view["comments"], (json{"a", "b"}));
  EXPECT_EQ(view["tools"], json::parse(R"([{"name": "Setup", "command": "s 1"}])"));
}

TEST(InformationView, HasTheDynamicChannels) {
  const std::string channels = "[DynamicChannels]\nNrOfSeg=2\nType1=7\nDir1=ro\nRange1=0xA080-0xA0BF\nPPOffset1=4\n";
  EXPECT_EQ(sections_view(channels + "Dir2=wo\n")["dynamic_channels"],
            json::parse(R"([{"data_type": 7, "first_index": 41088, "last_index": 41151, "process_picture_offset": 4,
                             "direction": "ro"}, {"direction": "wo"}])"));
}

TEST(InformationView, HasTheModules) {
  EXPECT_EQ(sections_view("[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=DI8\nProductVersion=2\n"
                          "ProductRevision=3\nOrderCode=M-1\n[M1Comments]\nLines=1\nLine1=inputs\n"
                          "[ConnectedModules]\nNrOfEntries=2\n1=1\n2=0\n")["modules"],
            json::parse(R"({"supported": [{"number": 1, "product_name": "DI8", "order_code": "M-1",
                                           "product_version": 2, "product_revision": 3, "comments": ["inputs"]}],
                            "connected": [1, 0]})"));
}

}  // namespace
}  // namespace edsc

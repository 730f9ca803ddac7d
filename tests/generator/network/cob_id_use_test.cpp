#include "network/cob_id_use.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "load/load_device.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

/// An SDO parameter of CiA 301: sub-index 1 is the COB-ID of the requests, sub-index 2 that of the responses.
std::string sdo_parameter(const std::string& index, const std::string& requests, const std::string& responses) {
  return group(index, "SDO parameter", "0x9", 3) +
         sub(index, 0, "Highest sub-index supported", "5", "DefaultValue=2\n") +
         sub(index, 1, "COB-ID 1", "7", "DefaultValue=" + requests + "\n") +
         sub(index, 2, "COB-ID 2", "7", "DefaultValue=" + responses + "\n");
}

using Row = std::tuple<std::uint32_t, bool, SdoFrames>;  ///< CAN-ID, transmits

std::vector<Row> sdo_uses(const std::string& objects) {
  DeviceFromText text(objects + var("2000", "Value", "5"), {}, {"", std::uint8_t{5}});
  LoadedDevice loaded;
  loaded.device = std::move(text.device);
  Network network;
  network.nodes.emplace_back();
  network.nodes.back().name = "request";  // a text that a name may have
  network.nodes.back().node_id = 5;
  network.nodes.back().loaded = &loaded;
  std::vector<Row> rows;
  for (const CobIdUse& use : cob_id_uses(network)) {
    EXPECT_EQ(use.sdo != SdoFrames::none, use.service == FrameService::sdo) << use.what;
    if (use.service == FrameService::sdo) rows.emplace_back(use.can_id, use.transmits, use.sdo);
  }
  return rows;
}

TEST(CobIdUse, StatesWhichFramesAnSdoCarries) {
  EXPECT_EQ(sdo_uses(""), (std::vector<Row>{{0x605, false, SdoFrames::requests}, {0x585, true, SdoFrames::responses}}));
  EXPECT_EQ(sdo_uses(sdo_parameter("1200", "0x605", "0x585") + sdo_parameter("1201", "0x611", "0x591") +
                     sdo_parameter("1280", "0x607", "0x587")),
            (std::vector<Row>{{0x605, false, SdoFrames::requests},
                              {0x585, true, SdoFrames::responses},
                              {0x611, false, SdoFrames::requests},
                              {0x591, true, SdoFrames::responses},
                              {0x607, true, SdoFrames::requests},
                              {0x587, false, SdoFrames::responses}}));
}

}  // namespace
}  // namespace edsc

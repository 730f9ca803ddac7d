/// Every trace of the manuals, replayed with the generated device that it names.
#include <gtest/gtest.h>

#include <algorithm>
#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <ezd_1136/device.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <rk5c/device.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "application_station.hpp"
#include "player.hpp"
#include "station.hpp"
#include "trace.hpp"
#include "trace_files.hpp"

namespace {

struct DeviceRow {
  std::string_view name;  ///< as in a trace
  std::unique_ptr<trace::Station> (*make)(canopen::NodeId);
};

constexpr DeviceRow devices[] = {
    {"can-2017c", trace::make_station<can_2017c::Device>}, {"can-2024c", trace::make_station<can_2024c::Device>},
    {"can-2053c", trace::make_station<can_2053c::Device>}, {"can-2057c", trace::make_station<can_2057c::Device>},
    {"cpc-tc1", trace::make_station<cpc_tc1::Device>},     {"cpd", trace::make_station<cpd::Device>},
    {"ezd-1136", trace::make_station<ezd_1136::Device>},   {"rk5c", trace::make_station<rk5c::Device>},
};

class Traces : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Traces, AreWhatTheDevicesDo) {
  const trace::Trace trace = trace::read(GetParam());
  std::vector<std::unique_ptr<trace::Station>> stations;
  for (const trace::NodeOfTrace& node : trace.nodes) {
    if (node.has_application) {
      stations.push_back(trace::make_application(node.device, node.node_id));
      ASSERT_NE(stations.back(), nullptr) << trace.file << ": no application is named " << node.device;
      continue;
    }
    const auto* device = std::ranges::find(devices, node.device, &DeviceRow::name);
    ASSERT_NE(device, std::end(devices)) << trace.file << ": no device is named " << node.device;
    stations.push_back(device->make(node.node_id));
  }
  for (const trace::Failure& failure : trace::play(trace, stations)) {
    ADD_FAILURE_AT(trace.file.c_str(), static_cast<int>(failure.line)) << "  " << failure.message;
  }
}

TEST_P(Traces, AreListedInTheReadme) {
  std::ifstream readme{std::filesystem::path{EDSC_TRACES_DIR} / "README.md"};
  const std::string text{std::istreambuf_iterator<char>{readme}, {}};
  EXPECT_NE(text.find("`" + GetParam().stem().string() + "`"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Manuals, Traces, testing::ValuesIn(trace::files_in(EDSC_TRACES_DIR)), trace::test_name);

}  // namespace

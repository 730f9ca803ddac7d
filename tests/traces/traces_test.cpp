/// Every trace of the manuals, replayed against the generated device that it names.
#include <gtest/gtest.h>

#include <algorithm>
#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>
#include <cctype>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <ezd_1136/device.hpp>
#include <filesystem>
#include <rk5c/device.hpp>
#include <string>
#include <vector>

#include "player.hpp"
#include "trace.hpp"

namespace {

struct DeviceRow {
  const char* name;  ///< as a trace names it
  std::vector<trace::Failure> (*play)(const trace::Trace&);
};

constexpr DeviceRow devices[] = {
    {"can-2017c", trace::play<can_2017c::Device>}, {"can-2024c", trace::play<can_2024c::Device>},
    {"can-2053c", trace::play<can_2053c::Device>}, {"can-2057c", trace::play<can_2057c::Device>},
    {"cpc-tc1", trace::play<cpc_tc1::Device>},     {"cpd", trace::play<cpd::Device>},
    {"ezd-1136", trace::play<ezd_1136::Device>},   {"rk5c", trace::play<rk5c::Device>},
};

std::vector<std::filesystem::path> trace_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{EDSC_TRACES_DIR}) {
    if (entry.path().extension() == ".trace") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::string test_name(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.stem().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class Traces : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Traces, AreWhatTheDeviceDoes) {
  const trace::Trace trace = trace::read(GetParam());
  const auto* device = std::ranges::find_if(devices, [&](const DeviceRow& row) { return trace.device == row.name; });
  ASSERT_NE(device, std::end(devices)) << trace.file << ": no device is named " << trace.device;
  for (const trace::Failure& failure : device->play(trace)) {
    ADD_FAILURE_AT(trace.file.c_str(), static_cast<int>(failure.line)) << "  " << failure.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Manuals, Traces, testing::ValuesIn(trace_files()), test_name);

}  // namespace

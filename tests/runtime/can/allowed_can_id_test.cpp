/// CAN-IDs that CiA 301 restricts and an application profile uses: the option pdo.allowed_can_ids, here 180h of CiA
/// 417.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/node/accepted_frames.hpp>
#include <cstring>
#include <lift_device/device.hpp>
#include <pdo_device/device.hpp>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

namespace od = lift_device::od;
using namespace std::chrono_literals;

constexpr auto refused = "585 80 01 18 01 30 00 09 06";

template <class Device>
bool accepts(bench::Bench<Device>& device, std::uint32_t id) {
  std::vector<std::uint32_t> ids;
  canopen::for_each_accepted_frame(device.node, [&](const canopen::AcceptedFrame& frame) { ids.push_back(frame.id); });
  return std::ranges::find(ids, id) != ids.end();
}

TEST(AllowedCanId, AnRpdoHasItByDefault) {
  bench::Bench<lift_device::Device> device;
  EXPECT_TRUE(accepts(device, 0x180));
  device.ask(bench::start);
  device.ask("180 34 12 78 56 34 12");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x1234);
  EXPECT_EQ(device.node.get<od::long_word>(), 0x12345678u);
}

TEST(AllowedCanId, ATpdoCanBeGivenIt) {
  bench::Bench<lift_device::Device> device;
  EXPECT_EQ(device.ask("605 23 00 18 01 85 01 00 80"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 00 18 01 80 01 00 00"), "585 60 00 18 01 00 00 00 00");
  const std::string sent = device.ask(bench::start);
  EXPECT_NE(sent.find("180 00 00 00 00 00 00"), std::string::npos) << sent;
  EXPECT_EQ(device.ask("605 23 00 18 01 81 01 00 00"), "585 80 00 18 01 30 00 09 06") << "while it is valid";
}

TEST(AllowedCanId, OthersAndOtherServicesAreRefused) {
  bench::Bench<lift_device::Device> device;
  device.ask("605 23 01 18 01 85 02 00 80");
  for (const char* const id : {"7F 01 00 00", "01 01 00 00", "E0 06 00 00", "05 07 00 00"}) {
    EXPECT_EQ(device.ask(std::string{"605 23 01 18 01 "} + id), refused) << id;
  }
  device.ask("605 23 14 10 00 85 00 00 80");
  EXPECT_EQ(device.ask("605 23 14 10 00 80 01 00 00"), "585 80 14 10 00 30 00 09 06");
}

TEST(AllowedCanId, WithoutTheOptionItIsRefusedAndNotReceived) {
  bench::Bench<pdo_device::Device> device;
  device.ask("605 23 01 18 01 85 02 00 80");
  EXPECT_EQ(device.ask("605 23 01 18 01 80 01 00 00"), refused);
  const canopen::EntryAccess entries = device.node.entries();
  constexpr std::uint32_t id = 0x180;
  std::memcpy(entries.ram(entries.find(0x1400, 1)), &id, sizeof id);
  EXPECT_FALSE(accepts(device, 0x180));
}

}  // namespace

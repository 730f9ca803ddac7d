/// A mapping over the bus accepts objects whose length is a multiple of the EDS's Granularity.
#include <gtest/gtest.h>

#include <coarse_pdo_device/device.hpp>
#include <pdo_device/device.hpp>

#include "support/bench.hpp"

namespace {

/// Maps 16 bits, and then one bit, to RPDO3, which is not valid.
template <class Device>
std::string map_a_bit() {
  bench::Bench<Device> device;
  EXPECT_EQ(device.ask("605 2F 02 16 00 00 00 00 00"), "585 60 02 16 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 02 16 01 10 00 01 20"), "585 60 02 16 01 00 00 00 00");
  return device.ask("605 23 02 16 02 01 01 04 20");
}

TEST(Granularity, Of8RefusesABit) {
  static_assert(coarse_pdo_device::Device::granularity == 8);
  EXPECT_EQ(map_a_bit<coarse_pdo_device::Device>(), "585 80 02 16 02 41 00 04 06");
}

TEST(Granularity, Of1TakesIt) {
  static_assert(pdo_device::Device::granularity == 1);
  EXPECT_EQ(map_a_bit<pdo_device::Device>(), "585 60 02 16 02 00 00 00 00");
}

}  // namespace

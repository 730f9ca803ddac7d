/// A device with 512 RPDOs and 512 TPDOs, the maximum of CiA 301 (7.5.2.35 and 7.5.2.37).
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <many_pdos/device.hpp>

#include "support/bench.hpp"

namespace {

using many_pdos::Device;

/// All TPDOs are sent on entering Operational.
class ManyPdos : public testing::Test {
 protected:
  ManyPdos() {
    device.ask(bench::start);
    device.pass(canopen::from_milliseconds(1));
  }

  std::string sent() { return device.pass(canopen::from_milliseconds(1)); }

  bench::Bench<Device> device;
};

TEST_F(ManyPdos, AllAreServed) {
  EXPECT_EQ(canopen::TpdoService<Device>::count, 512u);
  EXPECT_EQ(canopen::RpdoService<Device>::count, 512u);
}

TEST_F(ManyPdos, EachTpdoIsSentWhenItsObjectChanges) {
  device.node.set(many_pdos::od::input_1{}, 0x11);
  EXPECT_EQ(sent(), "00020001 11");
  device.node.set(many_pdos::od::input_257{}, 0x22);
  EXPECT_EQ(sent(), "00020101 22");
  device.node.set(many_pdos::od::input_512{}, 0x33);
  EXPECT_EQ(sent(), "00020200 33");
}

TEST_F(ManyPdos, EachRpdoSetsItsObject) {
  device.ask("00010001 44");
  device.ask("00010101 55");
  device.ask("00010200 66");
  EXPECT_EQ(device.node.get(many_pdos::od::output_1{}), 0x44);
  EXPECT_EQ(device.node.get(many_pdos::od::output_256{}), 0);
  EXPECT_EQ(device.node.get(many_pdos::od::output_257{}), 0x55);
  EXPECT_EQ(device.node.get(many_pdos::od::output_512{}), 0x66);
}

}  // namespace

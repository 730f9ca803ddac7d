/// The values of another node with their meaning: over SDO and in PDOs, by the master of a host and by a device.
#include <gtest/gtest.h>

#include <canopen/host/master.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>

#include <optional>
#include <typed_drive/device.hpp>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::NodeId;
using canopen::raw;
using namespace canopen::literals;
using namespace std::chrono_literals;
namespace od = typed_drive::od;
using typed_drive::Device;
using heater = od::heater_state::value;
using mode = od::modes_of_operation::value;

struct TypedMaster : testing::Test {
  TypedMaster() {
    canopen::VirtualBus::connect(endpoint, node);
    node.start(bus.now());
  }
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& endpoint = bus.attach();
  bench::NodeOf<Device, canopen::VirtualBus::Endpoint> node{endpoint, NodeId{5}};
  canopen::VirtualBusPort port{bus};
  canopen::Master<canopen::VirtualBusPort> master{port};
  canopen::MasterRemote<Device, canopen::VirtualBusPort> drive{master, NodeId{5}};
};

TEST_F(TypedMaster, WritesAndReadsAQuantity) {
  EXPECT_TRUE(drive.write(od::setpoint{}, 21.5_degC));
  EXPECT_EQ(node.get(od::setpoint{}).raw(), 215);
  EXPECT_TRUE(*drive.read(od::setpoint{}) == 21.5_degC);
  EXPECT_TRUE(drive.write<od::setpoint>(raw(300)));
  EXPECT_TRUE(node.get(od::setpoint{}) == 30_degC);
  EXPECT_EQ(drive.write(od::setpoint{}, raw(901)).abort_code(), AbortCode::value_too_high);
}

TEST_F(TypedMaster, WritesAndReadsAWord) {
  EXPECT_TRUE(drive.write(od::controlword{}, od::controlword::type{}.switch_on(true).halt(true)));
  EXPECT_EQ(node.get(od::controlword{}).raw(), 0x0101);
  EXPECT_TRUE(drive.read(od::controlword{})->halt());
  node.modify(od::statusword{}, [](auto& word) { word.fault(true); });
  EXPECT_TRUE(drive.read<od::statusword>()->is(od::statusword::type::state_value::fault));
}

TEST_F(TypedMaster, WritesAndReadsAnEnumeration) {
  EXPECT_TRUE(drive.write(od::modes_of_operation{}, mode::homing));
  EXPECT_EQ(node.get(od::modes_of_operation{}), mode::homing);
  EXPECT_EQ(*drive.read(od::modes_of_operation{}), mode::homing);
  EXPECT_EQ(drive.write(od::heater_state{}, static_cast<heater>(2)).abort_code(), AbortCode::invalid_value);
}

TEST_F(TypedMaster, WritesAndReadsWithoutWaiting) {
  std::optional<od::setpoint::type> got;
  EXPECT_TRUE(
      drive.write(od::setpoint{}, od::setpoint::type{5_degC}, [](canopen::Result<void> done) { EXPECT_TRUE(done); }));
  EXPECT_TRUE(drive.read(od::setpoint{}, [&](canopen::Result<od::setpoint::type> value) { got = *value; }));
  master.poll(10ms);
  ASSERT_TRUE(got.has_value());
  EXPECT_TRUE(*got == 5_degC);
}

TEST_F(TypedMaster, SendsAndTakesPdos) {
  std::optional<od::temperature::type> measured;
  EXPECT_TRUE(drive.on_pdo<typed_drive::Tpdo1>(
      [&](od::statusword::type, auto, od::temperature::type temperature, auto, auto) { measured = temperature; }));
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, NodeId{5}));
  master.poll(10ms);
  node.set(od::temperature{}, -5_degC);
  master.poll(10ms);
  ASSERT_TRUE(measured.has_value());
  EXPECT_TRUE(*measured == -5_degC);
  const od::setpoint::type wanted{40_degC};
  EXPECT_TRUE(drive.send<typed_drive::Rpdo2>(heater::cooling, wanted, od::controlword::type{}.halt(true)));
  master.poll(10ms);
  EXPECT_EQ(node.get(od::heater_state{}), heater::cooling);
  EXPECT_TRUE(node.get(od::setpoint{}) == 40_degC);
  EXPECT_TRUE(node.get(od::controlword{}).halt());
  EXPECT_TRUE(drive.send<typed_drive::Rpdo2>(heater::off, 21.5_degC, raw(std::uint16_t{0x0F})));
  master.poll(10ms);
  EXPECT_EQ(node.get(od::setpoint{}).raw(), 215);
  EXPECT_EQ(node.get(od::controlword{}).raw(), 0x0F);
}

TEST(TypedSdoClient, WritesAndReadsValues) {
  bench::RecordingBus bus;
  canopen::SdoClient<bench::RecordingBus> client{bus, NodeId{5}};
  EXPECT_TRUE(client.write<od::setpoint>(21.5_degC, {}));
  EXPECT_EQ(bus.take(), "605 2B 00 20 00 D7 00 00 00");
  client.on_frame(frame("585 60 00 20 00 00 00 00 00"), {});
  EXPECT_TRUE(client.write<od::modes_of_operation>(mode::homing, {}));
  EXPECT_EQ(bus.take(), "605 2F 60 60 00 06 00 00 00");
  client.on_frame(frame("585 60 60 60 00 00 00 00 00"), {});
  EXPECT_TRUE(client.write<od::controlword>(raw(0x0F), {}));
  EXPECT_EQ(bus.take(), "605 2B 40 60 00 0F 00 00 00");
  client.on_frame(frame("585 60 40 60 00 00 00 00 00"), {});
  EXPECT_TRUE(client.read<od::statusword>({}));
  client.on_frame(frame("585 4B 41 60 00 08 00 00 00"), {});
  EXPECT_TRUE(client.value<od::statusword>()->fault());
}

}  // namespace

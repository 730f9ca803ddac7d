#include <gtest/gtest.h>

#include <canopen/base/lock.hpp>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/node.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/pdo/pdo_compatible.hpp>
#include <canopen/sdo/remote_node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <tuple>

#include <typed_drive/device.hpp>
#include "support/bench.hpp"

namespace {

using bench::frame;
using bench::text;
using canopen::AbortCode;
using canopen::NodeId;
using canopen::raw;
using canopen::TimePoint;
using namespace canopen::literals;
using namespace std::chrono_literals;
namespace od = typed_drive::od;
using typed_drive::Device;
using typed_drive::Rpdo1;
using typed_drive::Rpdo2;
using typed_drive::Tpdo1;
using heater = od::heater_state::value;
using mode = od::modes_of_operation::value;

TEST(TypedNode, GetsAndSetsValues) {
  bench::Bench<Device> device;
  device.node.set(od::setpoint{}, 21.5_degC);
  EXPECT_EQ(device.node.get(od::setpoint{}), od::setpoint::type{21.5_degC});
  device.node.set(od::setpoint{}, 300.15_K);
  EXPECT_EQ(device.node.get<od::setpoint>().raw(), 270);
  device.node.set(od::modes_of_operation{}, mode::profile_velocity);
  EXPECT_EQ(device.node.get(od::modes_of_operation{}), mode::profile_velocity);
  EXPECT_EQ((device.node.set<od::setpoint, 5_degC>()), canopen::ok);
  EXPECT_EQ(device.node.get(od::setpoint{}).raw(), 50);
  device.node.set(od::cooling_depth{}, -2.5_K);
  EXPECT_EQ(device.node.get(od::cooling_depth{}).raw(), 5);
  device.node.set(od::total_energy{}, 2_kWh);
  EXPECT_EQ(device.node.get(od::total_energy{}).raw(), 2'000U);
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4B 00 20 00 32 00 00 00");
}

TEST(TypedNode, ChecksVariablesAndRawNumbers) {
  bench::Bench<Device> device;
  EXPECT_EQ(device.node.set(od::setpoint{}, od::setpoint::type{90.1_degC}), AbortCode::value_too_high);
  EXPECT_EQ(device.node.set(od::setpoint{}, od::setpoint::type{-0.1_degC}), AbortCode::value_too_low);
  EXPECT_EQ(device.node.set(od::setpoint{}, raw(std::int16_t{901})), AbortCode::value_too_high);
  EXPECT_EQ(device.node.set(od::setpoint{}, raw(std::int16_t{900})), canopen::ok);
  device.node.set(od::setpoint{}, raw(215));
  EXPECT_EQ(device.node.get(od::setpoint{}).raw(), 215);
  device.node.set(od::target_position{}, raw(std::int32_t{-7}));
  EXPECT_EQ(device.node.get(od::target_position{}).raw(), -7);
  const auto checked = canopen::CheckedValue<od::setpoint>::from(raw(1'000'000));
  EXPECT_EQ(checked.abort_code(), AbortCode::value_too_high);
}

TEST(TypedNode, RejectsOtherValuesOfAClosedEnumeration) {
  bench::Bench<Device> device;
  device.node.set(od::heater_state{}, heater::cooling);
  EXPECT_EQ(device.node.set(od::heater_state{}, static_cast<heater>(3)), AbortCode::invalid_value);
  EXPECT_EQ(device.node.set(od::heater_state{}, raw(std::uint8_t{3})), AbortCode::invalid_value);
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::cooling);
  // By SDO: 3 is between the limits, 6 above them.
  EXPECT_EQ(device.ask("605 2F 02 20 00 03 00 00 00"), "585 80 02 20 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 2F 02 20 00 06 00 00 00"), "585 80 02 20 00 31 00 09 06");
  EXPECT_EQ(device.ask("605 2F 02 20 00 01 00 00 00"), "585 60 02 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::heating);
  const std::array<std::uint8_t, 1> three{3};
  EXPECT_EQ(device.node.set(0x2002, 0, three), AbortCode::invalid_value);
  // An open enumeration accepts any number.
  EXPECT_EQ(device.ask("605 2F 60 60 00 63 00 00 00"), "585 60 60 60 00 00 00 00 00");
  EXPECT_EQ(device.node.get(od::modes_of_operation{}), static_cast<mode>(0x63));
}

TEST(TypedNode, AppliesRpdosOfBothMappings) {
  bench::Bench<Device> device;
  device.ask(bench::start);
  device.ask("205 0F 01 06 10 27 00 00 01");  // static: 1.0 rev
  EXPECT_TRUE(device.node.get(od::controlword{}).enable_operation());
  EXPECT_EQ(device.node.get(od::modes_of_operation{}), mode::homing);
  EXPECT_TRUE(device.node.get(od::target_position{}) == 1_rev);
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::heating);
  device.ask("205 00 01 06 20 4E 00 00 03");  // 3 is not a state of the heater
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::heating);
  EXPECT_FALSE(device.node.get(od::controlword{}).enable_operation());

  device.ask("305 05 D7 00 02 00");  // mapped at run time
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::cooling);
  EXPECT_TRUE(device.node.get(od::setpoint{}) == 21.5_degC);
  device.ask("305 03 85 03 04 00");  // 3 and 901 are rejected, the control word is not
  EXPECT_EQ(device.node.get(od::heater_state{}), heater::cooling);
  EXPECT_TRUE(device.node.get(od::setpoint{}) == 21.5_degC);
  EXPECT_TRUE(device.node.get(od::controlword{}).quick_stop());
}

TEST(TypedNode, ModifySendsTheTpdoOfAMappedObject) {
  bench::Bench<Device> device;
  device.ask(bench::start);
  device.pass(0ms);
  device.node.modify(od::statusword{}, [](auto& word) { word.ready_to_switch_on(true).switched_on(true); });
  EXPECT_EQ(device.pass(0ms), "185 03 00 00 00 00 00 00 00");
  device.node.modify(od::door{}, [](auto& door) { door.zone(9); });
  EXPECT_EQ(device.pass(0ms), "185 03 00 00 00 00 90 00 00");
  EXPECT_EQ(device.node.modify(od::setpoint{}, [](auto& value) { value = 95_degC; }), AbortCode::value_too_high);
  EXPECT_EQ(device.pass(0ms), "");
}

TEST(TypedNode, HasElementsOfAnArrayByTheirRunTimeSubIndex) {
  bench::Bench<Device> device;
  for (std::uint8_t i = 1; i <= 4; ++i) EXPECT_EQ(device.node.set(od::zone_temperature{}, i, 20.5_degC), canopen::ok);
  const auto element = device.node.get(od::zone_temperature{}, 4);
  ASSERT_TRUE(element);
  EXPECT_TRUE(*element == 20.5_degC);
  EXPECT_EQ(device.node.set(od::zone_temperature{}, 2, od::zone_temperature<2>::type{-40.1_degC}),
            AbortCode::value_too_low);
  EXPECT_EQ(device.node.set(od::zone_temperature{}, 5, 20_degC), AbortCode::no_sub_index);
  device.node.set(od::zone_temperature<3>{}, -3_degC);
  EXPECT_EQ(device.node.get(od::zone_temperature<3>{}).raw(), -30);
}

struct Heater {
  AbortCode write(od::setpoint, od::setpoint::type value) {
    return value > 50_degC ? AbortCode::local_control : canopen::ok;
  }
  void written(od::heater_state, heater state, auto& node) {
    node.set(od::modes_of_operation_display{}, state == heater::off ? mode::no_mode : mode::profile_position);
  }
  template <std::uint8_t SubIndex>
  void written(od::zone_temperature<SubIndex>, od::temperature::type value) {
    last_zone = SubIndex;
    zone = value;
  }
  od::temperature::type read(od::temperature) { return 36.6_degC; }

  int last_zone = 0;
  od::temperature::type zone{};
};

TEST(TypedNode, CallsFunctionsOfItsApplicationWithValues) {
  bench::Bench<Device, Heater> device{Heater{}};
  EXPECT_EQ(device.ask("605 2B 00 20 00 F5 01 00 00"), "585 80 00 20 00 21 00 00 08");  // 50.1 °C
  EXPECT_EQ(device.ask("605 2B 00 20 00 F4 01 00 00"), "585 60 00 20 00 00 00 00 00");
  device.ask("605 2F 02 20 00 01 00 00 00");
  EXPECT_EQ(device.node.get(od::modes_of_operation_display{}), mode::profile_position);
  EXPECT_EQ(device.ask("605 40 01 20 00 00 00 00 00"), "585 4B 01 20 00 6E 01 00 00");
  device.ask("605 2B 05 20 03 D7 00 00 00");
  EXPECT_EQ(device.node.application<Heater>().last_zone, 3);
  EXPECT_TRUE(device.node.application<Heater>().zone == 21.5_degC);
}

TEST(TypedNode, CallsHandlersThatNameTheRawNumber) {
  using Number = canopen::Object<0x6040, 0, std::uint16_t, canopen::Access::rww, canopen::Mappable::rpdo>;
  std::uint16_t last = 0;
  const auto handler = canopen::on_write(Number{}, [&](std::uint16_t word) { last = word; });
  bench::Bench<Device, std::remove_const_t<decltype(handler)>> device{handler};
  device.ask(bench::start);
  device.ask("205 0F 01 06 10 27 00 00 01");
  EXPECT_EQ(last, 0x010F);
  EXPECT_EQ(device.node.get(Number{}), 0x010F);
}

TEST(TypedPdo, IsPackedAndUnpacked) {
  canopen::Frame out{};
  const auto state = canopen::CheckedValue<od::setpoint>::from(od::setpoint::type{21.5_degC});
  Tpdo1::pack_into(out, od::statusword::type{}.fault(true), mode::homing, -5_degC, od::door::type{}.zone(3), *state);
  EXPECT_EQ(text(out), "000 08 00 06 CE FF 30 D7 00");
  const auto [status, display, temperature, door, setpoint] = Tpdo1::unpack(out);
  EXPECT_TRUE(status.fault());
  EXPECT_EQ(display, mode::homing);
  EXPECT_TRUE(temperature == -5_degC);
  EXPECT_EQ(door.zone(), 3);
  EXPECT_TRUE(setpoint == 21.5_degC);
  EXPECT_TRUE(Tpdo1::get<od::temperature>(out) == -5_degC);
  Tpdo1::set<od::temperature>(out, 10_degC);
  EXPECT_EQ(Tpdo1::get<2>(out).raw(), 100);
  constexpr Rpdo2::Data data = Rpdo2::pack(heater::cooling, 90_degC, od::controlword::type{});
  EXPECT_EQ(data, (Rpdo2::Data{5, 0x84, 3, 0, 0}));
}

struct OtherScale : od::temperature {
  using type = canopen::Quantity<std::int16_t, canopen::unit::degree_celsius, std::ratio<1, 100>>;
};
struct Number : od::temperature {
  using type = std::int16_t;
};
template <class Object>
using Consumer = canopen::PdoLayout<od::statusword, od::modes_of_operation_display, Object>;
static_assert(canopen::compatible<Tpdo1, Consumer<od::temperature>>);
static_assert(canopen::compatible<Tpdo1, Consumer<Number>>);
static_assert(!canopen::compatible<Tpdo1, Consumer<OtherScale>>);

TEST(TypedRemote, WritesAndReadsValues) {
  bench::RecordingBus bus;
  canopen::RemoteNode<Device, bench::RecordingBus> remote{bus, NodeId{5}};
  const auto answer = [&](const char* response) { remote.on_frame(frame(response), {}); };
  EXPECT_TRUE(remote.write<od::setpoint>(21.5_degC, {}));
  EXPECT_EQ(bus.take(), "605 2B 00 20 00 D7 00 00 00");
  answer("585 60 00 20 00 00 00 00 00");
  EXPECT_TRUE(remote.write<od::setpoint>(raw(300), {}));
  EXPECT_EQ(bus.take(), "605 2B 00 20 00 2C 01 00 00");
  answer("585 60 00 20 00 00 00 00 00");
  EXPECT_EQ(remote.write<od::setpoint>(raw(100'000), {}).abort_code(), AbortCode::value_too_high);
  EXPECT_EQ(remote.write<od::heater_state>(static_cast<heater>(2), {}).abort_code(), AbortCode::invalid_value);
  EXPECT_TRUE(remote.write<od::controlword>(od::controlword::type{}.halt(true), {}));
  EXPECT_EQ(bus.take(), "605 2B 40 60 00 00 01 00 00");
  answer("585 60 40 60 00 00 00 00 00");
  EXPECT_TRUE(remote.read<od::temperature>({}));
  EXPECT_EQ(bus.take(), "605 40 01 20 00 00 00 00 00");
  answer("585 4B 01 20 00 CE FF 00 00");
  EXPECT_TRUE(*remote.value<od::temperature>() == -5_degC);
}

TEST(TypedRemote, IsAccessedWhileTheProgramWaits) {
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& endpoint = bus.attach();
  bench::NodeOf<Device, canopen::VirtualBus::Endpoint> node{endpoint, NodeId{5}};
  canopen::VirtualBus::connect(endpoint, node);
  canopen::VirtualBusPort port{bus};
  canopen::BlockingSdo sdo{port};
  node.start(bus.now());
  auto remote = sdo.remote<Device>(NodeId{5});
  EXPECT_TRUE(remote.write(od::setpoint{}, 21.5_degC));
  EXPECT_TRUE(remote.write<od::modes_of_operation>(mode::homing));
  EXPECT_TRUE(remote.write(od::target_position{}, raw(-5)));
  EXPECT_EQ(remote.write(od::setpoint{}, raw(901)).abort_code(), AbortCode::value_too_high);
  EXPECT_TRUE(*remote.read(od::setpoint{}) == 21.5_degC);
  EXPECT_EQ(*remote.read(od::modes_of_operation{}), mode::homing);
  EXPECT_EQ(remote.read(od::target_position{})->raw(), -5);
}

TEST(TypedNode, TakesValuesFromOtherContexts) {
  canopen::Mailbox<od::temperature, od::setpoint, od::modes_of_operation> mailbox;
  bench::Bench<Device, decltype(canopen::values_from(mailbox))> device{canopen::values_from(mailbox)};
  mailbox.post(od::temperature{}, 36.6_degC);
  mailbox.post(od::setpoint{}, 20_degC);
  EXPECT_EQ(mailbox.post(od::setpoint{}, od::setpoint::type{91_degC}), AbortCode::value_too_high);
  EXPECT_EQ(mailbox.post(od::setpoint{}, raw(std::int16_t{-1})), AbortCode::value_too_low);
  mailbox.post(od::modes_of_operation{}, mode::homing);
  device.pass(0ms);
  EXPECT_TRUE(device.node.get(od::temperature{}) == 36.6_degC);
  EXPECT_TRUE(device.node.get(od::setpoint{}) == 20_degC);
  EXPECT_EQ(device.node.get(od::modes_of_operation{}), mode::homing);
}

struct CountingLock {
  int& count;
  void lock() { ++count; }
  void unlock() {}
};

TEST(TypedNode, IsModifiedWhileTheLockIsHeld) {
  bench::Bench<Device> device;
  int count = 0;
  CountingLock lock{count};
  canopen::Locked locked{device.node, lock};
  locked.modify(od::controlword{}, [](auto& word) { word.halt(true).quick_stop(true); });
  EXPECT_EQ(count, 1);
  locked.set(od::setpoint{}, 12_degC);
  EXPECT_EQ(locked.get(od::controlword{}).raw(), 0x0104);
  EXPECT_TRUE(locked.get(od::setpoint{}) == 12_degC);
}

}  // namespace

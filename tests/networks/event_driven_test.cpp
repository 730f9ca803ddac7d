/// The master of a network whose values are sent when they change.
#include <gtest/gtest.h>

#include <canopen/profile/cia402_master.hpp>
#include <canopen_plant/plant.hpp>
#include <chrono>
#include <cstdint>
#include <event_driven.hpp>
#include <string>
#include <vector>

#include "plant_bench.hpp"

namespace {

using namespace std::chrono_literals;
using namespace canopen::literals;
using Bytes = std::vector<std::uint8_t>;
namespace od = ezd_1136::od;

using Mode = od::modes_of_operation::type;
constexpr std::uint32_t mode_can_id = event_driven::controller::Tpdo2::parameters.cob_id & 0x7FF;
constexpr std::uint32_t can_id = event_driven::controller::Tpdo1::parameters.cob_id & 0x7FF;

template <class Bus>
struct Control {
  explicit Control(Bus& bus) : plant{bus} {}
  canopen::Plant<event_driven::Network, Bus> plant;
};

struct Line : plant_bench::PlantBench<Control> {
  Line() : PlantBench{500'000} {}
  plant_bench::LiveNode<ezd_1136::Device> axis{bus, 1};
};

TEST(EventDriven, AValueIsSentOnceWhenItChanges) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  bench.forget();
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.count(can_id), 1U);
  EXPECT_EQ(bench.last(can_id), (Bytes{0xE8, 0x03, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.count(can_id), 1U);
}

/// The drive has lost the value with its RAM, and nobody sets it again.
TEST(EventDriven, AValueIsSentAgainToANodeThatHasBooted) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  bench.axis.switch_off();
  bench.bus.run_for(1s);
  bench.forget();
  bench.axis.switch_on();
  ASSERT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 0);
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
  for (const canopen::Frame& frame : bench.frames) {
    if (frame.id == can_id) {
      EXPECT_EQ((Bytes{frame.data.begin(), frame.data.begin() + frame.size}), (Bytes{0xE8, 0x03, 0, 0, 0, 0, 0, 0}));
    }
  }
}

/// As an application does in its constructor. The mode is in a PDO with the controlword.
TEST(EventDriven, AValueThatIsSetBeforeTheStartIsSent) {
  namespace axis = event_driven::signals::axis;
  Line bench;
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.control.plant.set(axis::profile_velocity{}, canopen::raw(2000U));
  EXPECT_EQ(bench.control.plant.set(axis::modes_of_operation{}, Mode::profile_velocity), canopen::ok);
  bench.start();
  EXPECT_EQ(canopen::to_raw(bench.control.plant.get(axis::target_position{})), 1000);
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.last(can_id), (Bytes{0xE8, 0x03, 0, 0, 0xD0, 0x07, 0, 0}));
  EXPECT_EQ(bench.last(mode_can_id), (Bytes{3, 0, 0}));
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::profile_velocity{})), 2000U);
  EXPECT_EQ(bench.axis.node().get(od::modes_of_operation{}), Mode::profile_velocity);
}

/// A program that starts the plant again, for instance after the bus was lost.
TEST(EventDriven, AValueRemainsWhenThePlantIsStartedAgain) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
}

/// 6060h of the drive is 1 by default and has the limits 1..8: 0 would be rejected.
TEST(EventDriven, AValueThatWasNotSetIsTheDefaultValueOfTheNode) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.axis.node().get(od::modes_of_operation{}), Mode::profile_position);
  for (const canopen::Frame& frame : bench.frames) {
    if (frame.id == mode_can_id) {
      EXPECT_EQ(frame.data[0], 1);
    }
  }
  EXPECT_EQ(bench.faults, std::vector<std::string>{});
}

/// The statuswords of CiA 402-2, table 31, and the commands of the transitions to Operation Enabled.
TEST(EventDriven, ADriveIsEnabledByItsStatuswords) {
  Line bench;
  auto& plant = bench.control.plant;
  canopen::cia402::DriveCommander drive;
  drive.enable();
  plant.on(event_driven::signals::axis::statusword{},
           [&plant, &drive](auto word) { plant.axis.controlword(drive.next(word)); });
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  struct Step {
    std::uint16_t statusword, controlword;
  };
  for (const Step& step : {Step{0x0250, 0x06}, Step{0x0231, 0x07}, Step{0x0233, 0x0F}, Step{0x0237, 0x0F}}) {
    bench.axis.node().set(od::statusword{}, canopen::raw(step.statusword));
    bench.bus.run_for(100ms);
    EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::controlword{})), step.controlword);
  }
  EXPECT_TRUE(drive.is_enabled());
}

TEST(EventDriven, AValueOfTwoConstantsHasTheTypeOfItsObject) {
  Line bench;
  auto& plant = bench.control.plant;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  for (const bool runs : {true, false}) {
    using Velocity = event_driven::signals::axis::profile_velocity::type;
    plant.axis.profile_velocity(runs ? Velocity{5_rev_per_s} : Velocity{0_rev_per_s});
    bench.bus.run_for(100ms);
    EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::profile_velocity{})), runs ? 500U : 0U);
  }
}

}  // namespace

/// The runnable stepper drive: the statements of manual 001 about motion, modes and states.
#include "ezd_1136/ezd_1136.hpp"

#include <gtest/gtest.h>

#include <canopen_sim/virtual_bus.hpp>
#include <string>

#include "ezd_1136_bench.hpp"
#include "node_bench.hpp"

namespace {

using canopen::cia402::State;
using ezd_1136_bench::Stepper;
namespace od = ezd_1136::od;
using namespace std::chrono_literals;

constexpr auto to_position = "605 2F 60 60 00 01 00 00 00";
constexpr auto to_velocity = "605 2F 60 60 00 03 00 00 00";
constexpr auto to_homing = "605 2F 60 60 00 06 00 00 00";
constexpr auto to_csp = "605 2F 60 60 00 08 00 00 00";

// shows 001.50, 001.91, 001.159
TEST(Ezd1136Node, TellsItsRunStateIn206DhAndByItsLamp) {
  Stepper drive;
  EXPECT_EQ(drive.get<od::run_state>(), 1);
  EXPECT_TRUE(drive.logged("LED green flashing"));
  drive.enable();
  EXPECT_EQ(drive.get<od::run_state>(), 2);
  drive.set<od::target_position>(10'000);
  drive.control(0x3F);
  drive.pass(100ms);
  EXPECT_EQ(drive.get<od::run_state>(), 3);
  EXPECT_TRUE(drive.logged("LED green steady"));
  drive.pass(2s);
  EXPECT_EQ(drive.get<od::run_state>(), 2);
  EXPECT_TRUE(drive.logged("LED green flashing"));
}

// shows 001.72, 001.99, 001.194
TEST(Ezd1136Node, MovesInPulsesHundredthsOfATurnPerSecondAndTurnsPerSecondSquared) {
  Stepper drive;
  drive.set<od::profile_acceleration>(5);  // turns per second squared
  drive.ask(to_velocity);
  drive.enable();
  drive.set<od::target_velocity>(1'000);  // 10 turns per second, 600 turns per minute
  drive.pass(1s);
  EXPECT_NEAR(drive.get<od::velocity_actual_value>(), 500, 6);  // up to 10 ms and a step old
  drive.pass(1s + 10ms);
  EXPECT_EQ(drive.get<od::velocity_actual_value>(), 1'000);
  const std::int32_t from = drive.app->axis().position();
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().position() - from, 40'000);  // pulses of 20F2h: 10 turns
}

// shows 001.75, 001.162
TEST(Ezd1136Node, TellsItsCurrentAndItsAnalogueInputInThousandths) {
  Stepper drive;
  EXPECT_NE(drive.input("current 1.25"), "?");
  EXPECT_EQ(drive.ask("605 40 64 20 00 00 00 00 00"), "585 4B 64 20 00 E2 04 00 00");  // 1250 mA
  EXPECT_NE(drive.input("analogue 3.3"), "?");
  EXPECT_EQ(drive.ask("605 40 90 20 00 00 00 00 00"), "585 4B 90 20 00 E4 0C 00 00");  // 3300 mV
  EXPECT_EQ(drive.input("current much"), "?");
}

struct QuickStop {
  std::int16_t option;
  std::chrono::milliseconds stands;  ///< time until rest, from 10 turns per second
  State then;
};

// shows 001.51, 001.228
TEST(Ezd1136Node, StopsQuicklyAsItsOptionSays) {
  constexpr QuickStop rows[] = {
      {1, 100ms, State::switch_on_disabled},
      {2, 10ms, State::switch_on_disabled},
      {5, 100ms, State::quick_stop_active},
      {6, 10ms, State::quick_stop_active},
  };
  for (const QuickStop& row : rows) {
    SCOPED_TRACE(row.option);
    Stepper drive;
    drive.set<od::quick_stop_option_code>(row.option);
    drive.set<od::quick_stop_deceleration>(1'000);
    drive.set<od::target_velocity>(1'000);
    drive.ask(to_velocity);
    drive.enable();
    drive.pass(1s);
    drive.control(0x02);
    EXPECT_EQ(drive.statusword() & 0x016F, 0x0107);  // bit 8, and bit 5 is 0
    drive.pass(row.stands - 2ms);
    EXPECT_EQ(drive.state(), State::quick_stop_active);
    drive.pass(5ms);
    EXPECT_EQ(drive.app->axis().velocity(), 0);
    EXPECT_EQ(drive.state(), row.then);
  }
  Stepper drive;
  EXPECT_EQ(drive.get<od::quick_stop_option_code>(), 2);
  EXPECT_EQ(drive.ask("605 2B 5A 60 00 03 00 00 00"), "585 80 5A 60 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 2B 5A 60 00 04 00 00 00"), "585 80 5A 60 00 30 00 09 06");
}

// shows 001.52
TEST(Ezd1136Node, LeavesOperationAsItsOptionsSay) {
  Stepper drive;
  drive.set<od::target_velocity>(1'000);
  drive.ask(to_velocity);
  drive.enable();
  drive.pass(1s);
  drive.control(0x06);  // 605Bh is 0: immediately
  EXPECT_EQ(drive.state(), State::ready_to_switch_on);
  drive.pass(20s);
  drive.enable();
  drive.pass(1s);
  drive.control(0x07);  // 605Ch is 1: with the ramp
  EXPECT_EQ(drive.state(), State::operation_enabled);
  drive.pass(105ms);
  EXPECT_EQ(drive.state(), State::switched_on);
  drive.set<od::quick_stop_deceleration>(1'000);
  drive.control(0x0F);
  drive.pass(1s);
  drive.input("alarm 26");  // 605Eh is 2: with the quick stop ramp
  EXPECT_EQ(drive.state(), State::fault_reaction_active);
  drive.pass(15ms);
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.ask("605 2B 5B 60 00 02 00 00 00"), "585 80 5B 60 00 30 00 09 06");
}

// shows 001.53
TEST(Ezd1136Node, TakesItsModesAndNoOther) {
  Stepper drive;
  for (const int mode : {1, 3, 6, 8}) {
    drive.ask("605 2F 60 60 00 0" + std::to_string(mode) + " 00 00 00");
    EXPECT_EQ(drive.ask("605 40 61 60 00 00 00 00 00"), "585 4F 61 60 00 0" + std::to_string(mode) + " 00 00 00");
  }
  EXPECT_EQ(drive.ask("605 2F 60 60 00 04 00 00 00"), "585 80 60 60 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 40 02 65 00 00 00 00 00"), "585 43 02 65 00 25 00 00 00");
}

// shows 001.54, 001.57, 001.58, 001.59, 001.65, 001.104, 001.228
TEST(Ezd1136Node, FollowsTheControlword) {
  Stepper drive;
  EXPECT_EQ(drive.statusword(), 0x0250);  // bit 4: voltage enabled; bit 5 is 0
  EXPECT_EQ(drive.control(0x00), "");
  EXPECT_EQ(drive.control(0x06), "185 31 02 00 00 01");
  EXPECT_EQ(drive.control(0x07), "185 33 02 00 00 01");
  EXPECT_EQ(drive.control(0x0F), "185 37 82 00 00 01");
  EXPECT_EQ(drive.control(0x0B), "185 17 07 00 00 01");  // quick stop: bit 5 is 0; bit 8
  EXPECT_EQ(drive.pass(1ms), "185 50 02 00 00 01");
}

// shows 001.60, 001.108
TEST(Ezd1136Node, TakesNoCommandBelowPreOperational) {
  Stepper drive;
  drive.ask(bench::stop);
  EXPECT_EQ(drive.statusword() & 0x0200, 0);  // bit 9
  EXPECT_EQ(drive.app->node().set<od::controlword>(canopen::raw(0x06)), canopen::ok);
  drive.pass(1ms);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
  drive.ask(bench::enter_pre_operational);
  EXPECT_EQ(drive.statusword() & 0x0200, 0x0200);
  EXPECT_EQ(drive.state(), State::ready_to_switch_on);
}

// shows 001.55, 001.67, 001.105
TEST(Ezd1136Node, GoesToAPositionWhenBit4RisesWithBit5) {
  Stepper drive;
  drive.enable();
  drive.set<od::target_position>(10'000);
  EXPECT_EQ(drive.control(0x2F), "");
  EXPECT_EQ(drive.control(0x3F), "185 37 12 00 00 01");
  drive.pass(100ms);
  drive.set<od::target_position>(2'000);
  EXPECT_EQ(drive.control(0x2F), "");  // bit 12 remains 1
  EXPECT_EQ(drive.control(0x3F), "");  // changes immediately to the new set-point
  EXPECT_EQ(drive.pass(2s), "185 37 16 00 00 01");
  EXPECT_EQ(drive.get<od::position_actual_value>(), 2'000);
  drive.control(0x4F);
  drive.control(0x5F);  // bit 6: relative, 2'000 further
  drive.pass(2s);
  EXPECT_EQ(drive.get<od::position_actual_value>(), 4'000);
}

// shows 001.56, 001.66, 001.106, 001.205
TEST(Ezd1136Node, RunsWhenItIsEnabledInProfileVelocity) {
  Stepper drive;
  drive.ask(to_velocity);
  drive.set<od::target_velocity>(500);
  drive.enable();
  EXPECT_EQ(drive.pass(1s), "185 37 02 00 00 03 | 185 37 06 00 00 03");  // bit 12, speed is 0, falls as it turns
  EXPECT_EQ(drive.get<od::velocity_actual_value>(), 500);
  drive.set<od::target_velocity>(-500);
  drive.pass(1s);
  EXPECT_EQ(drive.get<od::velocity_actual_value>(), -500);
}

// shows 001.56, 001.63, 001.68, 001.107, 001.152, 001.228
TEST(Ezd1136Node, HomesWithBit4AndTellsAnErrorInBit13) {
  Stepper drive;
  drive.set<od::homing_speeds<1>>(200);
  drive.set<od::homing_speeds<2>>(50);
  drive.set<od::homing_acceleration>(100);
  drive.set<od::homing_method>(35);
  drive.ask(to_homing);
  drive.enable();
  EXPECT_EQ(drive.statusword(), 0x8237);
  EXPECT_EQ(drive.control(0x1F), "185 37 02 00 00 06");
  EXPECT_EQ(drive.pass(5ms), "185 37 16 00 00 06");
  drive.control(0x0F);
  drive.set<od::homing_method>(0);
  drive.control(0x1F);
  drive.pass(5ms);
  EXPECT_EQ(drive.statusword(), 0x2637);
  EXPECT_TRUE(drive.logged("LED red steady"));  // warning 8192
  EXPECT_EQ(drive.get<od::error_code>(), 8'192);
}

// shows 001.63
TEST(Ezd1136Node, TellsAParameterThatIs0InBit14) {
  Stepper drive;
  EXPECT_EQ(drive.statusword() & 0x4000, 0);
  drive.set<od::profile_acceleration>(0);
  EXPECT_EQ(drive.statusword() & 0x4000, 0x4000);
  drive.set<od::profile_acceleration>(100);
  drive.set<od::profile_velocity>(0);
  EXPECT_EQ(drive.statusword() & 0x4000, 0x4000);
  drive.ask(to_velocity);
  EXPECT_EQ(drive.statusword() & 0x4000, 0);
  drive.ask(to_homing);
  EXPECT_EQ(drive.statusword() & 0x4000, 0x4000);
}

// shows 001.62, 001.69
TEST(Ezd1136Node, TellsAHaltInBit8InEachMode) {
  for (const char* mode : {to_position, to_velocity, to_homing}) {
    Stepper drive;
    drive.ask(mode);
    drive.enable();
    drive.control(0x10F);
    EXPECT_EQ(drive.statusword() & 0x0500, 0x0500);
    drive.control(0x0F);
    EXPECT_EQ(drive.statusword() & 0x0100, 0);
  }
}

// shows 001.64
TEST(Ezd1136Node, TellsInBit12WhetherItFollowsTheMaster) {
  Stepper drive;
  drive.ask(to_csp);
  EXPECT_EQ(drive.statusword() & 0x1000, 0);
  drive.enable();
  EXPECT_EQ(drive.statusword() & 0x1000, 0x1000);
  drive.set<od::target_position>(100);
  drive.pass(5ms);
  EXPECT_EQ(drive.app->axis().position(), 100);
  drive.control(0x10F);
  EXPECT_EQ(drive.statusword() & 0x1000, 0);
  drive.control(0x00);
  EXPECT_EQ(drive.statusword() & 0x1000, 0);
}

// shows 001.73
TEST(Ezd1136Node, MovesWithoutRegardToOtherAxes) {
  using Endpoint = canopen::VirtualBus::Endpoint;
  canopen::VirtualBus bus;
  Endpoint& master = bus.attach();
  Endpoint& first_port = bus.attach();
  Endpoint& second_port = bus.attach();
  nodes::Surroundings first_around{canopen::NodeId{1}};
  nodes::Surroundings second_around{canopen::NodeId{2}};
  ezd_1136_node::Ezd1136<Endpoint> first{first_port, first_around};
  ezd_1136_node::Ezd1136<Endpoint> second{second_port, second_around};
  bus.connect(first_port, first);
  bus.connect(second_port, second);
  first.start(bus.now());
  second.start(bus.now());
  const auto ask = [&](const std::string& text) {
    ASSERT_TRUE(master.send(bench::frame(text)));
    bus.run_for(1ms);
  };
  for (const char* id : {"601", "602"}) {
    for (const char* data : {" 23 81 60 00 E8 03 00 00", " 23 83 60 00 64 00 00 00", " 23 84 60 00 64 00 00 00",
                             " 2B 40 60 00 06 00 00 00", " 2B 40 60 00 07 00 00 00", " 2B 40 60 00 0F 00 00 00",
                             " 23 7A 60 00 10 27 00 00"}) {
      ask(std::string{id} + data);
    }
  }
  ask("601 2B 40 60 00 3F 00 00 00");
  bus.run_for(2s);
  EXPECT_EQ(first.axis().position(), 10'000);
  EXPECT_EQ(second.axis().position(), 0);
  ask("602 2B 40 60 00 3F 00 00 00");
  bus.run_for(2s);
  EXPECT_EQ(second.axis().position(), 10'000);
}

}  // namespace

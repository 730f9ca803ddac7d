/// The runnable stepper drive: the statements of manual 001 about its application.
#include "ezd_1136/ezd_1136.hpp"

#include <gtest/gtest.h>

#include <canopen/host/virtual_bus.hpp>
#include <string>

#include "node_bench.hpp"

namespace {

using namespace std::chrono_literals;
using canopen::cia402::State;
namespace od = ezd_1136::od;

constexpr auto to_position = "605 2F 60 60 00 01 00 00 00";
constexpr auto to_velocity = "605 2F 60 60 00 03 00 00 00";
constexpr auto to_homing = "605 2F 60 60 00 06 00 00 00";
constexpr auto to_csp = "605 2F 60 60 00 08 00 00 00";

/// Operational. TPDO1 is 6041h, 603Fh, 6061h; TPDO2 and TPDO3 are not valid.
struct Stepper : bench::NodeBench<ezd_1136_node::Ezd1136> {
  Stepper() {
    set<od::profile_velocity>(1'000);
    set<od::profile_acceleration>(100);
    set<od::profile_deceleration>(100);
    ask("605 23 01 18 01 85 02 00 80");
    ask("605 23 02 18 01 85 03 00 80");
    ask(bench::start);
  }

  /// Writes 6040h over SDO; returns what follows the answer.
  std::string control(std::uint16_t word) {
    const canopen::Frame frame{
        .id = 0x605,
        .size = 8,
        .data = {0x2B, 0x40, 0x60, 0x00, static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)}};
    const std::string got = ask(bench::text(frame));
    const std::string answer = "585 60 40 60 00 00 00 00 00";
    EXPECT_EQ(got.substr(0, answer.size()), answer);
    return got.size() > answer.size() ? got.substr(answer.size() + 3) : "";
  }
  void enable() {
    control(0x06);
    control(0x07);
    control(0x0F);
    EXPECT_EQ(state(), State::operation_enabled);
  }
  template <class O>
  void set(typename O::type value) {
    EXPECT_EQ(app->node().template set<O>(value), canopen::ok);
    app->on_time(now);
    bus.take();
  }
  template <class O>
  [[nodiscard]] typename O::type get() {
    return app->node().template get<O>();
  }
  [[nodiscard]] State state() const { return app->drive().state(); }
  [[nodiscard]] std::uint16_t statusword() { return get<od::statusword>(); }
};

struct AlarmRow {
  const char* line;
  const char* emergency;
  const char* lamp;
};

// shows 001.44, 001.45, 001.109
TEST(Ezd1136Node, SendsAnAlarmAsTheLowByteOfItsCode) {
  constexpr AlarmRow rows[] = {
      {"alarm 10", "085 0A 00 03 00 00 00 00 00", "LED 1 green + 1 red"},
      {"alarm 11", "085 0B 00 03 00 00 00 00 00", "LED 1 green + 2 red"},
      {"alarm 12", "085 0C 00 03 00 00 00 00 00", "LED 1 green + 1 red"},
      {"alarm 13", "085 0D 00 05 00 00 00 00 00", "LED 1 green + 4 red"},
      {"alarm 14", "085 0E 00 05 00 00 00 00 00", "LED 1 green + 3 red"},
      {"alarm 15", "085 0F 00 09 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 16", "085 10 00 81 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 20", "085 14 00 81 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 24", "085 18 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 25", "085 19 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 26", "085 1A 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 50", "085 32 00 11 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 100", "085 64 00 11 00 00 00 00 00", "LED 1 green + 5 red"},
  };
  for (const AlarmRow& row : rows) {
    SCOPED_TRACE(row.line);
    Stepper drive;
    const std::string code = std::string{row.emergency}.substr(4, 5);
    EXPECT_EQ(drive.input(row.line), std::string{row.emergency} + " | 185 18 02 " + code + " 01");
    EXPECT_EQ(drive.state(), State::fault);
    EXPECT_TRUE(drive.logged(row.lamp));
    EXPECT_EQ(drive.get<od::drive_error_code>(), drive.get<od::error_code>());
    EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 " + code + " 01");
    EXPECT_TRUE(drive.logged("LED green flashing"));
    EXPECT_EQ(drive.get<od::drive_error_code>(), 0);
  }
  Stepper drive;
  EXPECT_EQ(drive.input("alarm 17"), "?");
}

// shows 001.44, 001.45
TEST(Ezd1136Node, AddsWarningsInTheHighByteOfTheCode) {
  Stepper drive;
  EXPECT_EQ(drive.input("warning 2048 on"), "085 00 08 81 00 00 00 00 00 | 185 50 02 00 08 01");
  EXPECT_TRUE(drive.logged("LED red steady"));
  EXPECT_EQ(drive.input("warning 4096 on"), "085 00 18 81 00 00 00 00 00 | 185 50 02 00 18 01");  // 6144
  EXPECT_EQ(drive.input("alarm 26"), "085 1A 18 A1 00 00 00 00 00 | 185 18 02 1A 18 01");
  EXPECT_EQ(drive.control(0x80), "085 00 00 81 00 00 00 00 00 | 185 50 02 1A 18 01");  // the warnings remain
  EXPECT_EQ(drive.input("warning 2048 off"), "085 00 00 81 00 00 00 00 00");
  EXPECT_EQ(drive.input("warning 4096 off"), "085 00 00 00 00 00 00 00 00");
  for (const char* bits : {"256", "512", "1024", "8192"}) {
    EXPECT_NE(drive.input("warning " + std::string{bits} + " on"), "?");
  }
  EXPECT_EQ(drive.get<od::drive_error_code>(), 256 + 512 + 1'024 + 8'192);
}

// shows 001.46
TEST(Ezd1136Node, RaisesAlarms13And14OutsideItsSupply) {
  Stepper drive;
  EXPECT_EQ(drive.input("supply 18"), "");
  EXPECT_EQ(drive.input("supply 60"), "");
  EXPECT_EQ(drive.get<od::bus_voltage>(), 6'000);
  EXPECT_EQ(drive.input("supply 17"), "085 0D 00 05 00 00 00 00 00 | 185 18 02 0D 00 01");
  EXPECT_EQ(drive.control(0x80), "");  // as long as the fault lasts
  drive.control(0x00);
  EXPECT_EQ(drive.input("supply 24"), "");
  EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 0D 00 01");
  EXPECT_EQ(drive.input("supply 61"), "085 0E 00 05 00 00 00 00 00 | 185 18 02 0E 00 01");
}

// shows 001.48
TEST(Ezd1136Node, RaisesAlarm50WhenTheBusIsLostWhileEnabledAnd100WhenItIsStartedAgain) {
  Stepper drive;
  drive.ask("605 23 16 10 01 64 00 01 00");  // node 1 within 100 ms
  drive.ask("701 05");
  drive.enable();
  drive.pass(99ms);
  const std::string lost = drive.pass(2ms);
  EXPECT_NE(lost.find("085 30 81 11 00 00 00 00 00"), std::string::npos);  // the service's own EMCY
  EXPECT_NE(lost.find("085 32 00 11 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.state(), State::fault);
  drive.ask("701 05");
  drive.control(0x80);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
  EXPECT_NE(drive.ask(bench::start).find("085 64 00 11 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.state(), State::fault);
  Stepper not_enabled;
  not_enabled.ask("605 23 16 10 01 64 00 01 00");
  not_enabled.ask("701 05");
  EXPECT_EQ(not_enabled.pass(200ms).find("085 32"), std::string::npos);
}

// shows 001.49, 001.61, 001.62
TEST(Ezd1136Node, WarnsAtItsLimits) {
  Stepper drive;
  EXPECT_EQ(drive.input("limit positive on"), "085 00 08 81 00 00 00 00 00 | 185 50 0B 00 08 01");  // bits 8 and 11
  EXPECT_EQ(drive.input("limit positive off"), "085 00 00 00 00 00 00 00 00 | 185 50 02 00 08 01");
  EXPECT_EQ(drive.input("limit negative on"), "085 00 10 81 00 00 00 00 00 | 185 50 0B 00 10 01");
  EXPECT_EQ(drive.input("limit negative off"), "085 00 00 00 00 00 00 00 00 | 185 50 02 00 10 01");
  // A software limit: only the warning.
  drive.set<od::software_position_limit<2>>(1'000);
  drive.enable();
  drive.set<od::target_position>(5'000);
  drive.control(0x3F);
  EXPECT_NE(drive.pass(1s).find("085 00 08 81 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.get<od::position_actual_value>(), 1'000);
  EXPECT_EQ(drive.statusword(), 0x1637);
}

// shows 001.50, 001.91
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

// shows 001.72
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
  EXPECT_EQ(drive.app->axis().position() - from, 100'000);  // pulses: 10 turns
}

// shows 001.75
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

// shows 001.51
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

// shows 001.54, 001.57, 001.58, 001.59, 001.65
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
  EXPECT_EQ(drive.app->node().set<od::controlword>(0x06), canopen::ok);
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

// shows 001.56, 001.66, 001.106
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

// shows 001.56, 001.63, 001.68
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

// shows 001.70
TEST(Ezd1136Node, HasA38hInTheLowByteOfAFault) {
  Stepper drive;
  drive.enable();
  EXPECT_EQ(drive.input("alarm 16"), "085 10 00 81 00 00 00 00 00 | 185 38 02 10 00 01");
}

// shows 001.45
TEST(Ezd1136Node, RaisesAlarm25ForAPositionDeviation) {
  Stepper drive;
  drive.set<od::position_error_threshold>(1'000);
  drive.enable();
  drive.set<od::target_position>(100'000);
  drive.control(0x3F);
  drive.pass(100ms);
  drive.input("block on");
  EXPECT_NE(drive.pass(500ms).find("085 19 00 21 00 00 00 00 00"), std::string::npos);
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

/// The finite state automaton of CiA 402: every state with every command, statuswords as bytes.
#include <gtest/gtest.h>

#include "cia402_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::DriveBench;
using bench::State;
namespace od = bench::od;

struct Row {
  State from;
  std::uint16_t controlword;
  State to;
  const char* frame;  ///< TPDO1; empty if the statusword does not change
};

constexpr Row rows[] = {
    // switch on disabled
    {State::switch_on_disabled, 0x00, State::switch_on_disabled, ""},
    {State::switch_on_disabled, 0x02, State::switch_on_disabled, ""},
    {State::switch_on_disabled, 0x06, State::ready_to_switch_on, "185 31 02"},  // 2
    {State::switch_on_disabled, 0x07, State::switch_on_disabled, "185 70 02"},
    {State::switch_on_disabled, 0x0F, State::switch_on_disabled, "185 70 02"},
    {State::switch_on_disabled, 0x80, State::switch_on_disabled, ""},
    // ready to switch on
    {State::ready_to_switch_on, 0x00, State::switch_on_disabled, "185 50 02"},  // 7
    {State::ready_to_switch_on, 0x02, State::switch_on_disabled, "185 50 02"},  // 7
    {State::ready_to_switch_on, 0x06, State::ready_to_switch_on, ""},
    {State::ready_to_switch_on, 0x07, State::switched_on, "185 33 02"},        // 3
    {State::ready_to_switch_on, 0x0F, State::operation_enabled, "185 37 06"},  // 3 and 4
    {State::ready_to_switch_on, 0x80, State::ready_to_switch_on, ""},
    // switched on
    {State::switched_on, 0x00, State::switch_on_disabled, "185 50 02"},  // 10
    {State::switched_on, 0x02, State::switch_on_disabled, "185 50 02"},  // 10
    {State::switched_on, 0x06, State::ready_to_switch_on, "185 31 02"},  // 6
    {State::switched_on, 0x07, State::switched_on, ""},
    {State::switched_on, 0x0F, State::operation_enabled, "185 37 06"},  // 4
    {State::switched_on, 0x80, State::switched_on, ""},
    // operation enabled
    {State::operation_enabled, 0x00, State::switch_on_disabled, "185 50 02"},  // 9
    {State::operation_enabled, 0x02, State::quick_stop_active, "185 17 06"},   // 11
    {State::operation_enabled, 0x06, State::ready_to_switch_on, "185 31 02"},  // 8
    {State::operation_enabled, 0x07, State::switched_on, "185 33 02"},         // 5
    {State::operation_enabled, 0x0F, State::operation_enabled, ""},
    {State::operation_enabled, 0x80, State::operation_enabled, ""},
    // quick stop active
    {State::quick_stop_active, 0x00, State::switch_on_disabled, "185 50 02"},  // 12
    {State::quick_stop_active, 0x02, State::quick_stop_active, ""},
    {State::quick_stop_active, 0x06, State::quick_stop_active, ""},
    {State::quick_stop_active, 0x07, State::quick_stop_active, ""},
    {State::quick_stop_active, 0x0F, State::operation_enabled, "185 37 06"},  // 16
    {State::quick_stop_active, 0x80, State::quick_stop_active, ""},
    // fault reaction active: no command ends it
    {State::fault_reaction_active, 0x00, State::fault_reaction_active, "185 1F 02"},
    {State::fault_reaction_active, 0x02, State::fault_reaction_active, "185 1F 02"},
    {State::fault_reaction_active, 0x06, State::fault_reaction_active, ""},
    {State::fault_reaction_active, 0x07, State::fault_reaction_active, ""},
    {State::fault_reaction_active, 0x0F, State::fault_reaction_active, ""},
    {State::fault_reaction_active, 0x80, State::fault_reaction_active, "185 1F 02"},
    // fault
    {State::fault, 0x00, State::fault, ""},
    {State::fault, 0x02, State::fault, ""},
    {State::fault, 0x06, State::fault, "185 38 02"},
    {State::fault, 0x07, State::fault, "185 38 02"},
    {State::fault, 0x0F, State::fault, "185 38 02"},
    {State::fault, 0x80, State::switch_on_disabled, "085 00 00 00 00 00 00 00 00 | 185 50 02"},  // 15
};

/// Brings a drive into a state; the frames of its statusword have been removed.
void reach(DriveBench& drive, State state) {
  switch (state) {
    case State::not_ready_to_switch_on:
    case State::switch_on_disabled: return;
    case State::ready_to_switch_on: drive.control(0x06); return;
    case State::switched_on:
      drive.control(0x06);
      drive.control(0x07);
      return;
    case State::operation_enabled: return drive.enable(1);
    case State::quick_stop_active:
      drive.set<od::quick_stop_option_code>(6);
      drive.enable(1);
      drive.control(0x02);
      drive.pass(1s);
      return;
    case State::fault_reaction_active:
      drive.set<od::fault_reaction_option_code>(1);
      drive.set<od::profile_deceleration>(100);
      drive.run(10'000);
      drive.input("fault 0x2310 0x02");
      return;
    case State::fault:
      drive.input("fault 0x2310 0x02");
      drive.bus.take();
      return;
  }
}

TEST(Cia402StateMachine, FollowsEveryCommandInEveryState) {
  for (const Row& row : rows) {
    SCOPED_TRACE(std::string{nodes::to_text(row.from)} + ", controlword " + std::to_string(row.controlword));
    DriveBench drive;
    reach(drive, row.from);
    ASSERT_EQ(drive.state(), row.from);
    EXPECT_EQ(drive.control(row.controlword), row.frame);
    EXPECT_EQ(drive.state(), row.to);
  }
}

TEST(Cia402StateMachine, IsInSwitchOnDisabledAfterPowerOn) {
  bench::NodeBench<bench::PlainDrive> drive;
  EXPECT_EQ(drive.ask(bench::start), "185 50 02");
}

TEST(Cia402StateMachine, HasAStatuswordForEachState) {
  constexpr std::uint16_t mask = 0x004F;  // bit 5 is undefined in some states
  constexpr std::uint16_t expected[] = {0x0000, 0x0040, 0x0001, 0x0003, 0x0007, 0x0007, 0x000F, 0x0008};
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(canopen::cia402::bits_of(static_cast<State>(i)) & mask, expected[i]) << i;
  }
  EXPECT_EQ(canopen::cia402::bits_of(State::operation_enabled) & 0x20, 0x20);
  EXPECT_EQ(canopen::cia402::bits_of(State::quick_stop_active) & 0x20, 0x00);
}

TEST(Cia402StateMachine, ResetsAFaultWithTheRisingEdgeOfBit7Alone) {
  DriveBench drive;
  drive.control(0x80);
  EXPECT_EQ(drive.input("fault 0x2310 0x02"), "085 10 23 03 00 00 00 00 00 | 185 18 02");
  EXPECT_EQ(drive.get<od::error_code>(), 0x2310);
  EXPECT_EQ(drive.control(0x80), "");  // it was 1 before
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.control(0x00), "");
  EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02");
}

TEST(Cia402StateMachine, ResetsNoFaultThatIsThereStill) {
  DriveBench drive;
  drive.app->device_control().keep_fault(true);
  drive.input("fault 0x3210 0x04");
  EXPECT_EQ(drive.control(0x80), "");
  EXPECT_EQ(drive.state(), State::fault);
  drive.app->device_control().keep_fault(false);
  drive.control(0x00);
  drive.control(0x80);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

TEST(Cia402StateMachine, EndsAFaultReactionInFaultWhenTheAxisStands) {
  DriveBench drive;
  drive.set<od::fault_reaction_option_code>(1);
  drive.run(10'000);
  EXPECT_EQ(drive.input("fault 0x2310 0x02"), "085 10 23 03 00 00 00 00 00 | 185 3F 02");  // 13
  EXPECT_EQ(drive.pass(99ms), "");                                                         // 100'000 per second squared
  EXPECT_EQ(drive.pass(10ms), "185 38 02");                                                // 14
  EXPECT_EQ(drive.velocity(), 0);
}

TEST(Cia402StateMachine, IgnoresCommandsInStopped) {
  DriveBench drive;
  drive.ask(bench::stop);
  EXPECT_EQ(drive.statusword(), 0x0050);  // bit 9, remote, is 0
  drive.control(0x06);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

TEST(Cia402StateMachine, TellsVoltageAndWarning) {
  DriveBench drive;
  drive.app->device_control().set_voltage_enabled(false);
  drive.app->device_control().set_warning(true);
  EXPECT_EQ(drive.pass(1ms), "185 C0 02");
}

/// The effect of an option code on a motor that turns at 10'000: states and the time until it is at rest.
struct Braking {
  std::int16_t code;
  int milliseconds;  ///< until rest; ramps: 100'000 and 1'000'000; 50'000 without power
  State meanwhile;
  State then;
};

template <class O>
void expect_braking(std::uint16_t controlword, std::span<const Braking> brakings) {
  for (const Braking& braking : brakings) {
    SCOPED_TRACE(braking.code);
    DriveBench drive;
    drive.set<O>(braking.code);
    drive.run(10'000);
    drive.control(controlword);
    EXPECT_EQ(drive.state(), braking.meanwhile);
    drive.pass(std::chrono::milliseconds{braking.milliseconds - 2});
    EXPECT_EQ(drive.state(), braking.meanwhile);
    EXPECT_NE(drive.velocity(), 0);
    drive.pass(5ms);
    EXPECT_EQ(drive.velocity(), 0);
    EXPECT_EQ(drive.state(), braking.then);
  }
}

TEST(Cia402OptionCode, QuickStopBrakesAndStaysOrNot) {
  constexpr Braking brakings[] = {
      {0, 200, State::switch_on_disabled, State::switch_on_disabled},
      {1, 100, State::quick_stop_active, State::switch_on_disabled},
      {2, 10, State::quick_stop_active, State::switch_on_disabled},
      {5, 100, State::quick_stop_active, State::quick_stop_active},
      {6, 10, State::quick_stop_active, State::quick_stop_active},
  };
  expect_braking<od::quick_stop_option_code>(0x02, brakings);
}

TEST(Cia402OptionCode, ShutdownCoastsOrSlowsDownFirst) {
  constexpr Braking brakings[] = {
      {0, 200, State::ready_to_switch_on, State::ready_to_switch_on},
      {1, 100, State::operation_enabled, State::ready_to_switch_on},
  };
  expect_braking<od::shutdown_option_code>(0x06, brakings);
}

TEST(Cia402OptionCode, DisableOperationCoastsOrSlowsDownFirst) {
  constexpr Braking brakings[] = {
      {0, 200, State::switched_on, State::switched_on},
      {1, 100, State::operation_enabled, State::switched_on},
  };
  expect_braking<od::disable_operation_option_code>(0x07, brakings);
}

TEST(Cia402OptionCode, HaltTakesEitherRamp) {
  constexpr Braking brakings[] = {
      {1, 100, State::operation_enabled, State::operation_enabled},
      {2, 10, State::operation_enabled, State::operation_enabled},
  };
  expect_braking<od::halt_option_code>(0x10F, brakings);
}

TEST(Cia402OptionCode, FaultReactionCoastsOrTakesEitherRamp) {
  constexpr Braking brakings[] = {
      {0, 200, State::fault, State::fault},
      {1, 100, State::fault_reaction_active, State::fault},
      {2, 10, State::fault_reaction_active, State::fault},
  };
  for (const Braking& braking : brakings) {
    SCOPED_TRACE(braking.code);
    DriveBench drive;
    drive.set<od::fault_reaction_option_code>(braking.code);
    drive.run(10'000);
    drive.input("fault 0x2310");
    EXPECT_EQ(drive.state(), braking.meanwhile);
    drive.pass(std::chrono::milliseconds{braking.milliseconds - 2});
    EXPECT_EQ(drive.state(), braking.meanwhile);
    EXPECT_NE(drive.velocity(), 0);
    drive.pass(5ms);
    EXPECT_EQ(drive.velocity(), 0);
    EXPECT_EQ(drive.state(), braking.then);
  }
}

TEST(Cia402OptionCode, DisableVoltageCoasts) {
  DriveBench drive;
  drive.run(10'000);
  EXPECT_EQ(drive.control(0x00), "185 50 02");
  drive.pass(190ms);
  EXPECT_NE(drive.velocity(), 0);
  drive.pass(20ms);
  EXPECT_EQ(drive.velocity(), 0);
}

TEST(Cia402OptionCode, ShutdownEndsAHoming) {
  DriveBench drive;
  drive.set<od::shutdown_option_code>(1);
  drive.set<od::homing_method>(17);
  drive.enable(canopen::cia402::mode::homing);
  drive.control(0x1F);
  drive.pass(500ms);
  drive.control(0x06);
  drive.input("limit negative on");
  drive.pass(500ms);
  EXPECT_EQ(drive.velocity(), 0);
  EXPECT_EQ(drive.state(), State::ready_to_switch_on);
}

TEST(Cia402StateMachine, TakesNoStepsForTheTimeWithoutPower) {
  DriveBench drive;
  drive.set<od::modes_of_operation>(canopen::cia402::mode::profile_velocity);
  drive.set<od::target_velocity>(10'000);
  drive.control(0x06);
  drive.now = drive.now + 1s;
  drive.control(0x0F);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  EXPECT_EQ(drive.app->axis().velocity_demand(), 0);
}

TEST(Cia402OptionCode, EnableOperationTakesALeaveBackThatHasNotEnded) {
  DriveBench drive;
  drive.run(10'000);
  drive.control(0x07);
  drive.pass(50ms);
  EXPECT_LT(drive.velocity(), 6'000);
  drive.control(0x0F);
  drive.pass(200ms);
  EXPECT_EQ(drive.velocity(), 10'000);
  EXPECT_EQ(drive.state(), State::operation_enabled);
}

}  // namespace

/// The functions of the servo drive of manual 002, chapter 6.4, as frames of the runnable node.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "cpd_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::Servo;
using canopen::cia402::State;

constexpr auto limit_error = "085 12 86 21 12 86 1C 30 08";

bool has(const std::string& frames, const std::string& wanted) { return frames.find(wanted) != std::string::npos; }

// 6.4.6: limit switches

struct Movement {
  std::int32_t velocity;       ///< 60FFh
  std::uint32_t deceleration;  ///< 6084h; 6083h is 20,000
};

/// A host calls the node some milliseconds late; the drive has stopped the axis by then.
// shows 002.114, 002.300, 002.301
TEST(CpdNode, ReportsEachLimitSwitchThatStopsAMovementWhateverTheRampAndTheTime) {
  for (const auto& [velocity, deceleration] : {Movement{300, 200'000}, Movement{30, 20'000}, Movement{100, 0},
                                               Movement{-300, 200'000}, Movement{-30, 20'000}, Movement{-100, 0}}) {
    const std::string limit = velocity > 0 ? "limit positive " : "limit negative ";
    for (int run = 0; run < 100; ++run) {
      SCOPED_TRACE(std::to_string(velocity) + ", " + std::to_string(deceleration) + ", run " + std::to_string(run));
      Servo drive;
      drive.write(0x6083, 0, 4, 20'000);
      drive.write(0x6084, 0, 4, deceleration);
      drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(velocity));
      drive.enable(3);
      drive.pass(100ms + run * 10us);
      drive.now = drive.now + canopen::Duration{run * 97};
      EXPECT_TRUE(has(drive.input(limit + "on"), limit_error));
      drive.pass(1s);
      EXPECT_EQ(drive.state(), State::fault);
      EXPECT_EQ(drive.read(0x6041, 0, 2) & 0x004F, 0x0008u);  // bit 3
      EXPECT_EQ(drive.read(0x301C, 8, 2), 0x0002u);
      EXPECT_EQ(drive.app->axis().velocity(), 0);
    }
  }
}

/// The same of a switch at a place on the machine, which the axis reaches within a call.
// shows 002.301
TEST(CpdNode, ReportsALimitSwitchThatTheAxisReaches) {
  for (int run = 0; run < 100; ++run) {
    Servo drive;
    drive.input("switches -20000 20000");
    drive.write(0x60FF, 0, 4, 1'000);
    drive.enable(3);
    std::string frames;
    while (drive.state() == State::operation_enabled && drive.now < canopen::TimePoint{} + 1s) {
      drive.now = drive.now + canopen::Duration{1'000 + run * 97};
      drive.app->on_time(drive.now);
      frames += drive.bus.take();
    }
    EXPECT_TRUE(has(frames, limit_error)) << run;
  }
}

/// The signal is shorter than a step.
// shows 002.305, 002.306
TEST(CpdNode, ReportsALimitSwitchThatIsReleasedAtOnce) {
  Servo drive;
  drive.write(0x60FF, 0, 4, 100);
  drive.enable(3);
  drive.pass(100ms);
  EXPECT_TRUE(has(drive.input("limit positive on"), limit_error));
  drive.input("limit positive off");
  EXPECT_EQ(drive.read(0x301C, 7, 2), 0u);
  EXPECT_EQ(drive.read(0x301C, 8, 2), 0x0002u);
}

TEST(CpdNode, ReportsNoErrorForALimitSwitchAtStandstillOrDuringHoming) {
  Servo drive;
  drive.enable(3);
  drive.pass(10ms);
  EXPECT_FALSE(has(drive.input("limit positive on"), "085"));
  drive.pass(10ms);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  drive.write(0x60FF, 0, 4, 100);  // does not begin towards the active switch
  EXPECT_FALSE(has(drive.pass(100ms), "085"));
  EXPECT_EQ(drive.app->axis().position(), 0);
  drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(-100));
  EXPECT_FALSE(has(drive.pass(100ms), "085"));
  EXPECT_LT(drive.app->axis().position(), 0);
}

// 6.4.6: the contacts of the limit switches

// shows 002.182, 002.302, 002.303
TEST(CpdNode, EvaluatesALimitSwitchAs3006hSelects) {
  struct Row {
    std::uint16_t setting;
    const char* contact;   ///< of the machine
    const char* actuated;  ///< by the machine
    bool trips;
  };
  constexpr Row rows[] = {
      {0, "break", "on", false}, {0, "make", "on", false}, {1, "break", "on", true},
      {1, "make", "off", true},  {2, "make", "on", true},  {2, "break", "off", true},
  };
  for (const bool positive : {true, false}) {
    const std::string side = positive ? "positive " : "negative ";
    for (const auto& [setting, contact, actuated, trips] : rows) {
      SCOPED_TRACE(side + std::to_string(setting) + contact);
      const std::string before = std::string{actuated} == "on" ? "off" : "on";
      Servo drive;
      drive.input("contact " + side + contact);
      drive.input("limit " + side + before);
      EXPECT_TRUE(has(drive.write(0x3006, positive ? 0x10 : 0x0F, 2, setting), "585 60 06 30"));
      EXPECT_EQ(drive.read(0x301C, 7, 2), 0u);
      drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(positive ? 500 : -500));
      drive.enable(3);
      drive.pass(100ms);
      EXPECT_EQ(has(drive.input("limit " + side + actuated), limit_error), trips);
      drive.pass(1s);
      EXPECT_EQ(drive.read(0x301C, 7, 2), trips ? 0x0002u : 0u);
      EXPECT_EQ(drive.state(), trips ? State::fault : State::operation_enabled);
      EXPECT_EQ(drive.app->axis().velocity(), trips ? 0 : positive ? 500 : -500);
    }
  }
}

// shows 002.302, 002.303, 002.549
TEST(CpdNode, HasLimitSwitchesWithTheContactOf3006hWithoutALine) {
  for (const std::uint16_t setting : {std::uint16_t{1}, std::uint16_t{2}}) {
    Servo drive;
    drive.write(0x3006, 0x10, 2, setting);
    drive.write(0x60FF, 0, 4, 500);
    drive.enable(3);
    drive.pass(100ms);
    EXPECT_TRUE(has(drive.input("limit positive on"), limit_error));
  }
  Servo drive;
  EXPECT_EQ(drive.write(0x3006, 0x0F, 2, 3), "585 80 06 30 0F 31 00 09 06");
}

// 6.4.5: reversal of the direction of rotation

// shows 002.294, 002.295
TEST(CpdNode, TurnsInTheOtherDirectionWith3006h12h) {
  for (const bool reversed : {false, true}) {
    Servo drive;
    drive.input("switches -20000 30000");
    drive.write(0x3006, 0x12, 2, reversed);
    drive.write(0x60FF, 0, 4, 1'000);
    drive.enable(3);
    drive.pass(50ms);
    EXPECT_EQ(drive.read(0x606C, 0, 4), 1'000u);
    EXPECT_TRUE(drive.logged(reversed ? "shaft turns anticlockwise" : "shaft turns clockwise"));
    EXPECT_GT(drive.app->axis().position(), 0);
    EXPECT_EQ(drive.app->axis().machine_position() > 0, !reversed);
    const std::string frames = drive.pass(1s);
    EXPECT_TRUE(has(frames, limit_error));  // the axis ends at the switch in the direction of the shaft
    EXPECT_EQ(drive.app->axis().inputs(), reversed ? 1u : 2u);
  }
}

// shows 002.294
TEST(CpdNode, CountsAShaftThatIsTurnedByHandInTheDirectionOf3006h12h) {
  Servo drive;
  EXPECT_NE(drive.input("turn 1000"), "?");
  EXPECT_EQ(drive.read(0x6064, 0, 4), 1'000u);
  drive.write(0x3006, 0x12, 2, 1);
  EXPECT_EQ(drive.read(0x6064, 0, 4), 1'000u);  // keeps its position
  drive.input("turn 300");
  EXPECT_EQ(drive.read(0x6064, 0, 4), 700u);
  drive.write(0x3006, 0x12, 2, 0);
  drive.input("turn 300");
  EXPECT_EQ(drive.read(0x6064, 0, 4), 1'000u);
}

TEST(CpdNode, ReversesTheDirectionAtStandstillOnly) {
  Servo drive;
  drive.write(0x60FF, 0, 4, 1'000);
  drive.enable(3);
  drive.pass(50ms);
  drive.write(0x3006, 0x12, 2, 1);
  drive.pass(50ms);
  EXPECT_EQ(drive.app->axis().turning(), 1);
  drive.write(0x60FF, 0, 4, 0);
  drive.pass(50ms);
  drive.write(0x60FF, 0, 4, 1'000);
  drive.pass(50ms);
  EXPECT_EQ(drive.app->axis().turning(), -1);
}

// 6.4.6: software limits in the modes of the manufacturer

// shows 002.297, 002.299, 002.545
TEST(CpdNode, EndsManualMovementAtASoftwareLimit) {
  Servo drive;
  drive.write(0x607D, 1, 4, static_cast<std::uint32_t>(-1'000));
  drive.write(0x607D, 2, 4, 10'000);
  drive.write(0x3029, 4, 2, 100);
  drive.enable(-1);
  drive.write(0x301B, 9, 2, 1);
  drive.pass(3s);
  EXPECT_EQ(drive.read(0x6064, 0, 4), 10'000u);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
  EXPECT_EQ(drive.read(0x301C, 7, 2), 0x0004u);
  EXPECT_EQ(drive.read(0x301C, 8, 2), 0x0004u);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  drive.write(0x301B, 9, 2, 2);  // in the other direction
  drive.pass(3s);
  EXPECT_EQ(drive.read(0x6064, 0, 4), static_cast<std::uint32_t>(-1'000));
}

// shows 002.299
TEST(CpdNode, EndsSpeedCurrentAndGearAtASoftwareLimit) {
  for (const int mode : {-2, -3, -4}) {
    for (const bool positive : {true, false}) {
      SCOPED_TRACE(mode);
      Servo drive;
      drive.write(0x607D, 1, 4, static_cast<std::uint32_t>(-1'000));
      drive.write(0x607D, 2, 4, 10'000);
      drive.write(0x301B, 0x10, 2, 2);
      drive.write(0x301B, 0x11, 2, 2);
      drive.write(0x301B, 0x12, 2, 1);
      drive.write(0x3005, 2, 2, 1);
      drive.enable(mode);
      drive.pass(10ms);
      drive.write(0x3020, 4, 2, positive ? 100 : 0xFF9C);
      drive.write(0x3021, 4, 2, positive ? 100 : 0xFF9C);
      drive.input(positive ? "pulses 20000" : "pulses -20000");
      drive.pass(3s);
      EXPECT_EQ(drive.read(0x6064, 0, 4), positive ? 10'000u : static_cast<std::uint32_t>(-1'000));
      EXPECT_EQ(drive.read(0x301C, 8, 2), 0x0004u);
    }
  }
}

// 6.4.3: motor stop

// shows 002.291
TEST(CpdNode, ContinuesAManualMovementAfterHalt) {
  Servo drive;
  drive.write(0x3029, 4, 2, 100);
  drive.write(0x6084, 0, 4, 1'000);
  drive.enable(-1);
  drive.write(0x301B, 9, 2, 1);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 100u);
  drive.ask("205 0F 01");
  drive.pass(50ms);  // of 100 ms at 1,000 rpm/s
  EXPECT_NEAR(drive.read(0x606C, 0, 4), 50, 12);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
  drive.ask("205 0F 00");
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 100u);
}

// shows 002.291
TEST(CpdNode, ContinuesSpeedCurrentAndGearAfterHalt) {
  for (const int mode : {-2, -3, -4}) {
    SCOPED_TRACE(mode);
    Servo drive;
    drive.write(0x301B, 0x10, 2, 2);
    drive.write(0x301B, 0x11, 2, 2);
    drive.write(0x301B, 0x12, 2, 1);
    drive.write(0x3005, 2, 2, 1);
    drive.enable(mode);
    drive.pass(10ms);
    drive.write(0x3020, 4, 2, 10);
    drive.write(0x3021, 4, 2, 100);
    drive.input("pulses 2000000");
    drive.pass(50ms);
    ASSERT_NE(drive.read(0x606C, 0, 4), 0u);
    drive.ask("205 0F 01");
    drive.pass(1s);
    const std::uint32_t position = drive.read(0x6064, 0, 4);
    EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
    drive.ask("205 0F 00");
    drive.pass(1s);
    EXPECT_GT(drive.read(0x6064, 0, 4), position);
  }
}

// 6.4.1: 607Fh limits the set speed

// shows 002.285
TEST(CpdNode, LimitsTheSpeedOfEachModeTo607Fh) {
  for (const int mode : {-1, -2, -4, 3}) {
    SCOPED_TRACE(mode);
    Servo drive;
    drive.write(0x607F, 0, 4, 200);
    drive.write(0x3029, 4, 2, 1'000);
    drive.write(0x301B, 0x11, 2, 2);
    drive.write(0x301B, 0x12, 2, 1);
    drive.write(0x3005, 2, 2, 1);
    drive.enable(mode);
    drive.pass(10ms);
    drive.write(0x301B, 9, 2, 2);
    drive.write(0x3021, 4, 2, 0xFC18);  // -1,000
    drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(-1'000));
    drive.input("pulses -2000000");
    drive.pass(1s);
    EXPECT_NEAR(static_cast<std::int32_t>(drive.read(0x606C, 0, 4)), -200, 3);
    drive.write(0x607F, 0, 4, 0);  // no limit
    drive.pass(100ms);
    EXPECT_LE(static_cast<std::int32_t>(drive.read(0x606C, 0, 4)), -1'000);
  }
}

// 6.4.2: the current of a quick stop

// shows 002.288, 002.290, 002.548
TEST(CpdNode, BrakesAQuickStopWithTheCurrentOf3011h05h) {
  struct Row {
    std::uint16_t current;  ///< 0.01 A
    int milliseconds;       ///< from 1,000 rpm to standstill
  };
  // 0.01 A are 20 rpm/s; without a current, the ramp 6084h.
  for (const auto& [current, milliseconds] : {Row{0, 500}, Row{100, 500}, Row{500, 100}, Row{1'000, 50}}) {
    SCOPED_TRACE(current);
    Servo drive;
    drive.write(0x6084, 0, 4, 2'000);
    drive.write(0x3011, 5, 2, current);
    drive.write(0x60FF, 0, 4, 1'000);
    drive.enable(3);
    drive.pass(100ms);
    ASSERT_EQ(drive.read(0x606C, 0, 4), 1'000u);
    drive.ask("205 0B 00");  // quick stop
    EXPECT_EQ(drive.state(), State::quick_stop_active);
    drive.pass(canopen::Duration{(milliseconds - 3) * 1'000});
    EXPECT_EQ(drive.state(), State::quick_stop_active);
    EXPECT_GT(drive.read(0x606C, 0, 4), 0u);
    drive.pass(6ms);
    EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
    EXPECT_NE(drive.state(), State::quick_stop_active);
  }
}

// shows 002.289, 002.290, 002.548
TEST(CpdNode, LimitsTheRampOfAStopToTheCurrentOf3011h06h) {
  struct Row {
    std::uint16_t current;  ///< 0.01 A
    int milliseconds;       ///< from 1,000 rpm to standstill
  };
  for (const auto& [current, milliseconds] : {Row{0, 50}, Row{5'000, 50}, Row{250, 200}, Row{100, 500}}) {
    SCOPED_TRACE(current);
    Servo drive;
    drive.write(0x6084, 0, 4, 20'000);
    drive.write(0x3011, 6, 2, current);
    drive.write(0x60FF, 0, 4, 1'000);
    drive.enable(3);
    drive.pass(100ms);
    drive.ask("205 0F 01");  // Halt
    drive.pass(canopen::Duration{(milliseconds - 3) * 1'000});
    EXPECT_GT(drive.read(0x606C, 0, 4), 0u);
    drive.pass(6ms);
    EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
  }
}

// shows 002.287
TEST(CpdNode, BrakesWithTheQuickStopCurrentIfAFaultOccurs) {
  Servo drive;
  drive.write(0x6084, 0, 4, 2'000);
  drive.write(0x3011, 5, 2, 500);
  drive.write(0x60FF, 0, 4, 1'000);
  drive.enable(3);
  drive.pass(100ms);
  drive.input("fault 0x2310");
  drive.pass(97ms);
  EXPECT_EQ(drive.state(), State::fault_reaction_active);
  drive.pass(6ms);
  EXPECT_EQ(drive.state(), State::fault);
}

// 6.4.7: inputs and outputs

// shows 002.183, 002.310, 002.311
TEST(CpdNode, ShowsItsAnalogueInputsIn3009hInMillivolts) {
  Servo drive;
  EXPECT_EQ(drive.read(0x3009, 1, 2), 0u);
  EXPECT_NE(drive.input("analogue 1 5000"), "?");
  EXPECT_NE(drive.input("analogue 2 -10000"), "?");
  EXPECT_EQ(drive.ask("605 40 09 30 01 00 00 00 00"), "585 4B 09 30 01 88 13 00 00");
  EXPECT_EQ(drive.ask("605 40 09 30 05 00 00 00 00"), "585 4B 09 30 05 F0 D8 00 00");
  EXPECT_EQ(drive.input("analogue 3 1"), "?");
  EXPECT_EQ(drive.input("analogue 1 40000"), "?");
  drive.ask(bench::reset_node);
  EXPECT_EQ(drive.read(0x3009, 1, 2), 5'000u);
  // In T_PDO4, on each change.
  drive.write(0x1A03, 1, 4, 0x3009'0110);
  drive.write(0x1A03, 2, 4, 0x3009'0510);
  drive.write(0x1A03, 0, 1, 2);
  drive.write(0x1803, 1, 4, 0x485);
  drive.ask(bench::start);
  EXPECT_EQ(drive.input("analogue 1 -1"), "485 FF FF F0 D8");
}

// shows 002.312, 002.313, 002.544, 002.551
TEST(CpdNode, ShowsItsDigitalInputsIn3008h) {
  Servo drive;
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x0006u);  // LIMN and LIMP are break contacts
  drive.input("limit negative on");
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x0004u);
  drive.input("limit positive on");
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x0000u);
  drive.input("home on");
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x0001u);
  drive.input("digital 3 on");
  drive.input("digital 15 on");
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x8009u);
  EXPECT_EQ(drive.input("digital 2 on"), "?");
  drive.write(0x3006, 0x0F, 2, 2);  // a make contact, actuated
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x800Bu);
  drive.input("contact negative break");  // the level does not depend on the setting any more
  EXPECT_EQ(drive.read(0x3008, 1, 2), 0x8009u);
  drive.write(0x1A03, 1, 4, 0x3008'0110);
  drive.write(0x1A03, 0, 1, 1);
  drive.write(0x1803, 1, 4, 0x485);
  drive.bus.take();
  EXPECT_EQ(drive.input("digital 3 off"), "485 01 80");
}

// 6.4.6: monitoring objects

// shows 002.307, 002.308, 002.319, 002.551
TEST(CpdNode, ShowsWarningsIn301ChAndTheStatuswords) {
  Servo drive;
  EXPECT_TRUE(has(drive.input("warning 0x0404 on"), "185 B1 66"));  // bit 7
  EXPECT_EQ(drive.read(0x301C, 0x0B, 2), 0x0404u);
  EXPECT_EQ(drive.read(0x301C, 0x0C, 2), 0x0404u);
  EXPECT_EQ(drive.read(0x2041, 0, 2), 0x0080u);
  drive.input("warning 0x0400 off");
  EXPECT_EQ(drive.read(0x301C, 0x0B, 2), 0x0004u);
  EXPECT_TRUE(has(drive.input("warning 0x0004 off"), "185 31 66"));
  EXPECT_EQ(drive.read(0x301C, 0x0B, 2), 0u);
  EXPECT_EQ(drive.read(0x301C, 0x0C, 2), 0x0404u);
  EXPECT_EQ(drive.read(0x2041, 0, 2), 0u);
  drive.input("warning 0x0001 on");
  drive.ask("205 80 00");  // deletes the saved warnings that are not active
  EXPECT_EQ(drive.read(0x301C, 0x0C, 2), 0x0001u);
  drive.enable(1);  // a warning does not change the state
}

// shows 002.309, 002.551
TEST(CpdNode, ShowsItsMovementInTheActionWord) {
  Servo drive;
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x0A40u);  // standstill, no profile, in the window
  drive.write(0x6067, 0, 4, 100'000);
  drive.write(0x6083, 0, 4, 1'000);
  drive.write(0x6084, 0, 4, 1'000);
  drive.write(0x60FF, 0, 4, 500);
  drive.enable(3);
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x2280u);  // accelerates in positive direction
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x4280u);  // constant speed
  drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(-500));
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x1280u);  // decelerates
  drive.pass(2s);
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x4300u);  // negative direction
  drive.input("warning 1 on");
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x4301u);
  drive.input("fault 0x2310");
  drive.pass(2s);
  EXPECT_EQ(drive.read(0x301C, 4, 2), 0x0A49u);
}

// 9.4.3: the list of errors

// shows 002.121, 002.396
TEST(CpdNode, KeepsFiveErrorsIn1003hTheNewestFirst) {
  Servo drive;
  for (int i = 1; i <= 6; ++i) drive.input("fault " + std::to_string(0x1000 + i));
  EXPECT_EQ(drive.read(0x1003, 0, 1), 5u);
  for (std::uint8_t sub_index = 1; sub_index <= 5; ++sub_index) {
    EXPECT_EQ(drive.read(0x1003, sub_index, 4), 0x1007u - sub_index);
  }
  EXPECT_EQ(drive.ask("605 40 03 10 06 00 00 00 00"), "585 80 03 10 06 11 00 09 06");
  EXPECT_EQ(drive.write(0x1003, 0, 1, 0), "585 60 03 10 00 00 00 00 00");
  EXPECT_EQ(drive.read(0x1003, 0, 1), 0u);
}

// 6.2.1, 6.2.2, 6.4.1: ramps and speeds

/// Runs for a time and returns the velocity of the axis, which is one step late.
std::int32_t velocity_after(Servo& drive, canopen::Duration span) {
  drive.pass(span + 1ms);
  return drive.app->axis().velocity();
}

// shows 002.177, 002.259..002.261, 002.283, 002.284, 002.550
TEST(CpdNode, MovesToAPositionWithTheRampsAndTheSpeedOf621) {
  Servo drive;
  drive.write(0x6083, 0, 4, 2'000);
  drive.write(0x6084, 0, 4, 4'000);
  drive.write(0x607F, 0, 4, 6'000);
  drive.write(0x6081, 0, 4, 4'000);
  drive.write(0x607A, 0, 4, 10'000'000);
  drive.enable(1);
  drive.ask("205 1F 00");
  EXPECT_NEAR(velocity_after(drive, 500ms), 1'000, 3);  // 2,000 rpm/s
  EXPECT_NEAR(velocity_after(drive, 3s), 4'000, 1);
  drive.ask("205 1F 01");
  EXPECT_NEAR(velocity_after(drive, 500ms), 2'000, 8);  // 4,000 rpm/s
  drive.ask("205 0F 00");
  drive.write(0x6081, 0, 4, 7'000);
  drive.ask("205 3F 00");
  EXPECT_NEAR(velocity_after(drive, 3s), 6'000, 1);  // 607Fh
}

// shows 002.266, 002.283, 002.284
TEST(CpdNode, RunsWithTheRampsAndTheLimitOf622) {
  Servo drive;
  drive.write(0x6083, 0, 4, 2'000);
  drive.write(0x6084, 0, 4, 10'000);
  drive.write(0x607F, 0, 4, 10'000);
  drive.write(0x60FF, 0, 4, 1'000);
  drive.enable(3);
  EXPECT_NEAR(velocity_after(drive, 250ms), 500, 3);
  EXPECT_EQ(velocity_after(drive, 1s), 1'000);
  drive.write(0x60FF, 0, 4, 0);
  EXPECT_NEAR(velocity_after(drive, 50ms), 500, 12);
  drive.write(0x60FF, 0, 4, 11'000);
  EXPECT_EQ(velocity_after(drive, 6s), 10'000);
}

// shows 002.286
TEST(CpdNode, HasLinearRampsOnly) {
  Servo drive;
  EXPECT_EQ(drive.write(0x6086, 0, 2, 0), "585 60 86 60 00 00 00 00 00");
  EXPECT_EQ(drive.write(0x6086, 0, 2, 1), "585 80 86 60 00 30 00 09 06");
}

// shows 002.268, 002.269
TEST(CpdNode, SearchesTheSwitchFastAndLeavesItSlowly) {
  Servo drive;
  drive.input("switches -20000 100000");
  drive.write(0x6098, 0, 1, 17);
  drive.write(0x6099, 1, 4, 100);
  drive.write(0x6099, 2, 4, 10);
  drive.write(0x6083, 0, 4, 1'000);
  drive.enable(6);
  drive.ask("205 1F 00");
  drive.pass(200ms);
  EXPECT_EQ(drive.app->axis().velocity(), -100);
  drive.pass(900ms);
  EXPECT_EQ(drive.app->axis().velocity(), 10);
  drive.pass(5s);
  EXPECT_EQ(drive.statusword(), 0xD637);
  EXPECT_NEAR(drive.app->axis().machine_position(), -20'000, 30);
}

// 6.3.4

// shows 002.230, 002.282
TEST(CpdNode, StartsAManualMovementByRpdo4) {
  Servo drive;
  drive.write(0x3029, 5, 2, 250);
  drive.write(0x1603, 1, 4, 0x301B'0910);
  drive.write(0x1603, 2, 4, 0x6040'0010);
  drive.write(0x1603, 3, 4, 0x3026'0320);
  drive.write(0x1603, 0, 1, 3);
  drive.write(0x1403, 1, 4, 0x505);
  drive.enable(-1);
  drive.ask("505 05 00 0F 00 07 00 00 00");
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 250u);
  EXPECT_EQ(drive.read(0x3026, 3, 4), 7u);
  drive.ask("505 00 00 0F 00 07 00 00 00");
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
}

// 6.4.4

// shows 002.292, 002.293
TEST(CpdNode, ReportsStandstillByTheWindowOf6067hAnd6068h) {
  struct Row {
    std::uint32_t window;
    std::uint16_t milliseconds;
    int reported;  ///< ms after the shaft has been blocked 400 increments before the target
  };
  for (const auto& [window, milliseconds, reported] : {Row{1'000, 100, 100}, Row{1'000, 300, 300}, Row{1, 0, -1}}) {
    Servo drive;
    drive.write(0x6067, 0, 4, window);
    drive.write(0x6068, 0, 2, milliseconds);
    drive.write(0x6081, 0, 4, 100);
    drive.write(0x607A, 0, 4, 10'000);
    drive.enable(1);
    drive.pass(1s);
    drive.ask("205 1F 00");
    while (drive.app->axis().position() < 9'600) drive.pass(1ms);
    drive.input("block on");
    drive.pass(50ms);  // the set position arrives
    drive.pass(canopen::Duration{static_cast<std::uint32_t>(milliseconds) * 1'000});
    EXPECT_EQ((drive.statusword() & 0x0400) != 0, reported >= 0);
  }
}

// 6.4.6: positions

// shows 002.113, 002.296
TEST(CpdNode, ReachesEachEndOfTheRangeOfTheAxis) {
  Servo drive;
  drive.write(0x6098, 0, 1, 35);
  drive.enable(6);
  drive.ask("205 1F 00");
  drive.pass(10ms);
  drive.write(0x6081, 0, 4, 12'000);
  for (const std::int32_t end : {0x1000'0000, -0x1000'0000}) {
    drive.ask("205 00 00");
    EXPECT_NE(drive.input("position " + std::to_string(end / 256 * 255)), "?");
    drive.write(0x607A, 0, 4, static_cast<std::uint32_t>(end));
    drive.enable(1);
    drive.ask("205 1F 00");
    drive.pass(2s);
    EXPECT_EQ(drive.read(0x6064, 0, 4), static_cast<std::uint32_t>(end));
    EXPECT_EQ(drive.statusword() & 0x8000, 0x8000);
    drive.ask("205 0F 00");
  }
}

/// The motor is blocked: the set position reaches the limit, the motor does not.
// shows 002.298
TEST(CpdNode, WatchesSoftwareLimitsByTheSetPosition) {
  Servo drive;
  drive.write(0x607D, 1, 4, static_cast<std::uint32_t>(-10'000));
  drive.write(0x607D, 2, 4, 10'000);
  drive.write(0x6081, 0, 4, 1'000);
  drive.write(0x607A, 0, 4, 20'000);
  drive.input("block on");
  drive.enable(1);
  drive.ask("205 1F 00");
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6064, 0, 4), 0u);
  EXPECT_EQ(drive.read(0x60F4, 0, 4), 10'000u);
  EXPECT_EQ(drive.read(0x301C, 8, 2), 0x0004u);
}

/// The shaft is blocked: the ramp generator goes on, the motor does not.
// shows 002.556, 002.367, 002.371, 002.372, 002.384
TEST(CpdNode, ShowsTheRampGeneratorAndTheMotorInTheirObjects) {
  Servo drive;
  drive.write(0x6083, 0, 4, 1'000);
  drive.write(0x60FF, 0, 4, static_cast<std::uint32_t>(-600));
  drive.enable(3);
  drive.pass(310ms);
  const auto speed = static_cast<std::int32_t>(drive.read(0x606B, 0, 4));
  EXPECT_NEAR(speed, -300, 15);
  EXPECT_NEAR(static_cast<std::int32_t>(drive.read(0x606C, 0, 4)), speed, 2);
  EXPECT_NEAR(static_cast<std::int32_t>(drive.read(0x6064, 0, 4)), drive.app->axis().position(), 1'000);
  drive.input("block on");
  const std::uint32_t blocked_at = drive.read(0x6064, 0, 4);
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x606B, 0, 4), static_cast<std::uint32_t>(-600));
  EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
  EXPECT_NEAR(static_cast<std::int32_t>(drive.read(0x6064, 0, 4) - blocked_at), 0, 1'000);
  const std::uint32_t ramp = drive.read(0x301F, 2, 4);
  EXPECT_LT(static_cast<std::int32_t>(ramp), static_cast<std::int32_t>(blocked_at) - 100'000);
  drive.ask("205 0F 01");  // Halt: both are at rest
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x60F4, 0, 4), drive.read(0x301F, 2, 4) - drive.read(0x6064, 0, 4));
}

// 6.4.8

// shows 002.314, 002.315
TEST(CpdNode, WorksWithTheValuesInRamUntilTheyAreSaved) {
  Servo drive;
  drive.write(0x3029, 4, 2, 100);
  drive.enable(-1);
  drive.write(0x301B, 9, 2, 1);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 100u);
  drive.power_cycle();
  EXPECT_EQ(drive.read(0x3029, 4, 2), 0u);
  drive.write(0x3029, 4, 2, 100);
  drive.write(0x3004, 1, 2, 1);
  drive.power_cycle();
  EXPECT_EQ(drive.read(0x3029, 4, 2), 100u);
}

// shows 002.552
TEST(CpdNode, AcceptsTheValuesOfItsCommandObjects) {
  Servo drive;
  for (const std::uint8_t sub_index : {std::uint8_t{1}, std::uint8_t{8}}) {
    const std::string place = Servo::sdo(0x585, 0x60, 0x3004, sub_index, 0);
    EXPECT_EQ(drive.write(0x3004, sub_index, 2, 0), place);
    EXPECT_EQ(drive.write(0x3004, sub_index, 2, 1), place);
    EXPECT_EQ(drive.write(0x3004, sub_index, 2, 2), Servo::sdo(0x585, 0x80, 0x3004, sub_index, 0x0609'0030));
  }
  EXPECT_EQ(drive.write(0x303B, 5, 2, 7), "585 60 3B 30 05 00 00 00 00");
  drive.write(0x3021, 4, 2, 100);
  drive.write(0x301B, 0x11, 2, 1);
  drive.enable(-4);
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x606C, 0, 4), 0u);
}

// Chapters 3, 5 and 7: the node

// shows 002.251, 002.316
TEST(CpdNode, SendsItsBootUpMessageWithNodeId127ByDefault) {
  bench::NodeBench<cpd_node::Cpd> drive{std::nullopt};
  EXPECT_EQ(drive.boot_up, "77F 00");
  EXPECT_EQ(drive.ask("000 01 7F"), "1FF 31 66");
}

// shows 002.216, 002.241
TEST(CpdNode, SendsNothingWithoutAnEventOrARequest) {
  Servo drive;
  EXPECT_EQ(drive.pass(3'600s), "");
  EXPECT_EQ(drive.ask("605 40 80 1F 00 00 00 00 00"), "585 80 80 1F 00 00 00 02 06");  // 1F80h, of an NMT master
}

// shows 002.214
TEST(CpdNode, IgnoresTheServicesOfTable32ThatItDoesNotHave) {
  Servo drive;
  for (const char* can_id : {"7E4", "7E5", "7E6", "7E7", "7E8", "7E9", "7EA"}) {
    EXPECT_EQ(drive.ask(std::string{can_id} + " 04 01 00 00 00 00 00 00"), "");
    EXPECT_EQ(drive.ask(std::string{can_id} + " 5E 00 00 00 00 00 00 00"), "");
  }
}

// shows 002.233
TEST(CpdNode, StartsTogetherWithOtherDrivesAtSync) {
  Servo drives[2];
  for (Servo& drive : drives) {
    drive.write(0x1401, 2, 1, 1);
    drive.write(0x1401, 1, 4, 0x305);
    drive.write(0x6081, 0, 4, 1'000);
    drive.enable(1);
  }
  drives[0].ask("305 1F 00 40 42 0F 00");
  drives[0].pass(50ms);
  drives[1].pass(50ms);
  drives[1].ask("305 1F 00 40 42 0F 00");
  for (Servo& drive : drives) {
    drive.pass(50ms);
    EXPECT_EQ(drive.read(0x6064, 0, 4), 0u);
    drive.ask("080");
    drive.pass(20ms);
    EXPECT_EQ(drive.app->axis().velocity(), 1'000);
  }
  EXPECT_EQ(drives[0].app->axis().position(), drives[1].app->axis().position());
}

// shows 002.33, 002.320, 002.547
TEST(CpdNode, HasNoReservedBitsInItsErrorRegister) {
  Servo drive;
  EXPECT_EQ(drive.input("fault 0x1000 0xFF").substr(0, 12), "085 00 10 B1");
  EXPECT_EQ(drive.read(0x1001, 0, 1), 0xB1u);
  drive.ask("205 80 00");
  EXPECT_EQ(drive.input("fault 0x1000 0x4E").substr(0, 12), "085 00 10 01");
}

}  // namespace

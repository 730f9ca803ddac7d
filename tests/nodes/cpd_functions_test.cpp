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

}  // namespace

/// The runnable stepper drive: the parameters of manual 001 and their effect on the motor.
#include "ezd_1136/ezd_1136.hpp"

#include <gtest/gtest.h>

#include <string>

#include "ezd_1136_bench.hpp"

namespace {

using canopen::cia402::State;
using ezd_1136_bench::Stepper;
using manual::refused;
namespace od = ezd_1136::od;
using namespace std::chrono_literals;

constexpr std::uint32_t invalid_value = 0x0609'0030;

/// In profile velocity, enabled.
struct Runner : Stepper {
  Runner() { put(0x6060, 0, 1, 3); }
  void run(std::int32_t velocity) {
    put(0x60FF, 0, 4, static_cast<std::uint32_t>(velocity));
    if (state() != State::operation_enabled) enable();
    pass(1s);
  }
};

// shows 001.112, 001.119, 001.174
TEST(Ezd1136Settings, TurnsTheMotorInThePulsesOf20F2h) {
  Runner drive;
  EXPECT_EQ(drive.read(0x20F2), 4'000);
  drive.run(100);  // a turn per second
  std::int32_t from = drive.app->axis().position();
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().position() - from, 4'000);
  drive.put(0x20F2, 0, 4, 8'000);
  drive.pass(20ms);
  EXPECT_EQ(drive.read(0x606C), 100);  // as fast as before
  from = drive.app->axis().position();
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().position() - from, 8'000);
  drive.run(0);
  drive.pass(100ms);
  const std::int32_t rest = drive.read(0x6064);
  drive.put(0x20F2, 0, 4, 200);
  EXPECT_EQ(drive.read(0x6064), rest);  // the position keeps its number
}

struct Direction {
  std::uint32_t value;  ///< of 20C9h
  int shaft;
  int encoder;
};

// shows 001.164, 001.216
TEST(Ezd1136Settings, ReversesMotorAndEncoderWith20C9h) {
  constexpr Direction rows[] = {{0, 1, 1}, {1, -1, -1}, {2, 1, -1}, {3, -1, 1}};
  for (const Direction& row : rows) {
    SCOPED_TRACE(row.value);
    Runner drive;
    drive.put(0x20C9, 0, 2, row.value);
    drive.run(100);
    EXPECT_EQ(drive.read(0x606C), 100 * row.encoder);
    EXPECT_NEAR(drive.read(0x6064), 4'000 * row.encoder, 200);
    EXPECT_NEAR(drive.app->axis().shaft_turns(), row.shaft, 0.05);
  }
  Stepper drive;
  drive.put(0x20C9, 0, 2, 3);
  drive.enable();
  drive.put(0x607A, 0, 4, 4'000);
  drive.control(0x3F);
  drive.pass(2s);
  EXPECT_EQ(drive.read(0x6064), 4'000);
  EXPECT_NEAR(drive.app->axis().shaft_turns(), -1, 0.001);
}

// shows 001.160, 001.217
TEST(Ezd1136Settings, DetectsALockedRotorIn207Ch) {
  Runner drive;
  drive.run(100);
  EXPECT_EQ(drive.read(0x207C), 0);
  drive.put(0x1802, 1, 4, 0x0000'0385);  // TPDO3 maps 207Ch and 60FDh
  EXPECT_EQ(drive.input("block on"), "");
  EXPECT_NE(drive.pass(5ms).find("385 01 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.read(0x207C), 1);
  drive.input("block off");
  EXPECT_NE(drive.pass(5ms).find("385 00 00 00 00 00 00"), std::string::npos);
  drive.put(0x20DD, 0, 2, 50);  // after 50 ms
  drive.input("block on");
  drive.pass(49ms);
  EXPECT_EQ(drive.read(0x207C), 0);
  drive.pass(5ms);
  EXPECT_EQ(drive.read(0x207C), 1);
  drive.control(0x06);  // a motor without power does not have to turn
  EXPECT_EQ(drive.read(0x207C), 0);
}

// shows 001.160
TEST(Ezd1136Settings, DetectsALockedRotorAbove20DBhInClosedLoop) {
  Runner drive;
  drive.put(0x20DB, 0, 2, 200);
  drive.input("block on");
  drive.run(200);
  EXPECT_EQ(drive.read(0x207C), 0);
  drive.run(201);
  EXPECT_EQ(drive.read(0x207C), 1);
  drive.put(0x20D9, 0, 2, 0);  // open loop: nothing shows it
  EXPECT_EQ(drive.read(0x207C), 0);
}

// shows 001.148, 001.180, 001.217
TEST(Ezd1136Settings, RaisesAlarm24Above20FEh) {
  Runner drive;
  drive.put(0x20FE, 0, 2, 500);
  drive.run(500);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  drive.put(0x60FF, 0, 4, 1'000);
  const std::string sent = drive.pass(100ms);
  EXPECT_NE(sent.find("085 18 00 21 00 00 00 00 00"), std::string::npos) << sent;
  drive.pass(1s);
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.read(0x206C), 24);
}

// shows 001.177
TEST(Ezd1136Settings, IsInPositionWithin20F7h) {
  Stepper drive;
  drive.enable();
  drive.put(0x607A, 0, 4, 10'000);
  drive.control(0x3F);
  drive.pass(200ms);
  drive.input("block on");
  drive.pass(2s);
  const std::int32_t missing = 10'000 - drive.read(0x6064);
  ASSERT_GT(missing, 1);
  EXPECT_EQ(drive.read(0x6041) & 0x0400, 0);
  drive.put(0x20F7, 0, 2, static_cast<std::uint32_t>(missing - 1));
  EXPECT_EQ(drive.read(0x6041) & 0x0400, 0);
  drive.put(0x20F7, 0, 2, static_cast<std::uint32_t>(missing));
  EXPECT_EQ(drive.read(0x6041) & 0x0400, 0x0400);
}

// shows 001.6, 001.121, 001.165, 001.211, 001.212
TEST(Ezd1136Settings, FollowsThePulseInputOrTheModesAs20CEhSays) {
  Runner drive;
  for (const std::uint32_t mode : {2u, 3u, 4u}) {
    EXPECT_EQ(manual::write(drive, 0x20CE, 0, 2, mode), refused(0x20CE, 0, invalid_value));
  }
  EXPECT_EQ(manual::write(drive, 0x20CE, 0, 2, 7), refused(0x20CE, 0, 0x0609'0031));
  drive.run(100);
  EXPECT_EQ(drive.read(0x606C), 100);  // software control is the mode at power-on
  drive.put(0x20CE, 0, 2, 0);
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x606C), 0);
  drive.put(0x60FF, 0, 4, 500);
  drive.pass(100ms);
  const std::int32_t from = drive.read(0x6064);
  EXPECT_EQ(drive.input("pulses 4000"), "");
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6064) - from, 4'000);
  drive.input("pulses -1000");
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6064) - from, 3'000);
  drive.put(0x20CE, 0, 2, 1);
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x606C), 500);
}

// shows 001.97, 001.156, 001.166, 001.185, 001.195, 001.196, 001.217
TEST(Ezd1136Settings, AppliesTheTorqueOf6071hWith20CEh5) {
  Stepper drive;
  drive.put(0x6071, 0, 2, 500);
  drive.enable();
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x6074), 0);  // another control mode
  EXPECT_EQ(drive.read(0x606C), 0);
  drive.put(0x6087, 0, 4, 1'000);  // per second
  drive.put(0x20CE, 0, 2, 5);
  drive.pass(100ms);
  EXPECT_NEAR(drive.read(0x6074), 100, 2);
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6074), 500);
  EXPECT_EQ(drive.read(0x606C), 500);  // 211Fh, not more
  EXPECT_EQ(drive.read(0x6078), 0);    // without a load it keeps its speed without torque
  drive.input("load 300");
  drive.pass(10ms);
  EXPECT_EQ(drive.read(0x6078), 300);
  EXPECT_EQ(drive.read(0x2064), 450);  // mA, 30 % of 20F1h
  drive.put(0x211F, 0, 2, 200);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C), 200);
  drive.input("load 600");
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C), 0);  // the load is stronger
  EXPECT_EQ(drive.read(0x6078), 500);
  EXPECT_EQ(drive.read(0x207C), 1);
  drive.input("load 0");
  drive.put(0x6071, 0, 2, static_cast<std::uint16_t>(-800));
  drive.pass(2s);
  EXPECT_EQ(drive.read(0x606C), -200);
  drive.control(0x10F);  // halt
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C), 0);
  EXPECT_EQ(drive.read(0x6074), 0);
  drive.control(0x0F);
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6074), -800);
  drive.input("block on");
  drive.pass(100ms);
  const std::int32_t held = drive.read(0x6064);
  EXPECT_EQ(drive.read(0x6078), -800);
  drive.input("block off");
  drive.pass(1ms);
  EXPECT_NEAR(drive.read(0x6064), held, 20);
  drive.control(0x06);
  EXPECT_EQ(drive.read(0x6078), 0);
}

// shows 001.199
TEST(Ezd1136Settings, KeepsItsLimitsInEachControlMode) {
  for (const std::uint32_t control : {0u, 1u, 5u}) {
    SCOPED_TRACE(control);
    Runner drive;
    drive.put(0x607D, 2, 4, 1'000);
    drive.put(0x20CE, 0, 2, control);
    drive.put(0x6071, 0, 2, 500);
    drive.run(500);
    drive.input("pulses 4000");
    drive.pass(1s);
    EXPECT_NEAR(drive.read(0x6064), 1'000, 300);  // it brakes at the limit
    EXPECT_EQ(drive.read(0x606C), 0);
    EXPECT_EQ(drive.read(0x206C), 2'048);
    drive.put(0x607D, 2, 4, 2'000'000'000);
    drive.input("limit positive on");
    const std::int32_t held = drive.read(0x6064);
    drive.input("pulses 4000");
    drive.pass(1s);
    EXPECT_NEAR(drive.read(0x6064), held, 100);
  }
}

// shows 001.167, 001.182, 001.219
TEST(Ezd1136Settings, PressesUntilTheTorqueIs2103hWith20CEh6) {
  Stepper drive;
  drive.put(0x20CE, 0, 2, 6);
  drive.put(0x2103, 0, 2, 800);
  drive.put(0x211E, 0, 2, 20);
  drive.enable();
  drive.put(0x607A, 0, 4, 40'000);
  drive.control(0x3F);
  drive.pass(200ms);
  drive.input("load 700");
  drive.pass(200ms);
  EXPECT_EQ(drive.read(0x206D), 3);  // the load is less
  drive.input("load 900");
  drive.pass(15ms);
  EXPECT_EQ(drive.read(0x206D), 3);
  drive.pass(50ms);
  EXPECT_EQ(drive.read(0x206D), 2);  // stopped, in position
  EXPECT_EQ(drive.read(0x6041) & 0x0400, 0x0400);
  EXPECT_LT(drive.read(0x6064), 40'000);
  drive.input("load 0");
  drive.put(0x20CE, 0, 2, 1);
  drive.control(0x2F);
  drive.control(0x3F);
  drive.pass(3s);
  EXPECT_EQ(drive.read(0x6064), 40'000);
}

// shows 001.116, 001.118, 001.120, 001.156, 001.169, 001.173, 001.175
TEST(Ezd1136Settings, TakesTheIdleCurrentAfterTheHalfCurrentTime) {
  Runner drive;
  EXPECT_EQ(drive.read(0x2064), 0);  // no power
  drive.run(100);
  EXPECT_EQ(drive.read(0x2064), 1'500);  // mA, 20F1h
  drive.put(0x20F1, 0, 2, 2'000);
  EXPECT_EQ(drive.read(0x2064), 2'000);
  drive.put(0x60FF, 0, 4, 0);
  drive.pass(150ms);  // it stops within 10 ms
  EXPECT_EQ(drive.read(0x2064), 2'000);
  drive.pass(100ms);
  EXPECT_EQ(drive.read(0x2064), 1'000);  // 50 % after 200 ms
  drive.put(0x20D5, 0, 2, 30);
  EXPECT_EQ(drive.read(0x2064), 600);
  drive.put(0x20F5, 0, 2, 1'000);
  EXPECT_EQ(drive.read(0x2064), 2'000);
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x2064), 600);
  drive.input("current 1.25");
  EXPECT_EQ(drive.read(0x2064), 1'250);
  drive.input("current off");
  EXPECT_EQ(drive.read(0x2064), 600);
}

// shows 001.170, 001.218
TEST(Ezd1136Settings, DoesNotUseTheEncoderInOpenLoop) {
  Runner drive;
  EXPECT_EQ(drive.read(0x20D9), 1);
  drive.put(0x20D9, 0, 2, 0);
  drive.put(0x2102, 0, 2, 100);
  drive.run(100);
  drive.input("block on");
  const std::int32_t from = drive.read(0x6064);
  drive.pass(1s);
  EXPECT_NEAR(drive.read(0x6064) - from, 4'000, 100);  // the commanded position
  EXPECT_EQ(drive.state(), State::operation_enabled);
  Runner closed;
  closed.put(0x2102, 0, 2, 100);
  closed.run(100);
  closed.input("block on");
  const std::int32_t held = closed.read(0x6064);
  closed.pass(1s);
  EXPECT_NEAR(closed.read(0x6064), held, 100);
  EXPECT_EQ(closed.read(0x603F), 25);
}

// shows 001.176, 001.181, 001.218
TEST(Ezd1136Settings, CountsTheDeviationInTheResolutionOfTheEncoder) {
  for (const std::uint32_t resolution : {4'000u, 8'000u}) {
    SCOPED_TRACE(resolution);
    Runner drive;
    EXPECT_EQ(drive.read(0x20F6), 4'000);
    drive.put(0x20F6, 0, 2, resolution);
    drive.put(0x2102, 0, 2, 1'000);
    drive.run(100);
    drive.input("block on");
    drive.pass(120ms);  // 480 pulses
    EXPECT_EQ(drive.state(), State::operation_enabled);
    drive.pass(20ms);  // 560 pulses
    EXPECT_EQ(drive.state() == State::operation_enabled, resolution == 4'000);
    drive.pass(120ms);
    EXPECT_EQ(drive.read(0x603F), 25);
  }
}

// shows 001.168
TEST(Ezd1136Settings, DetectsTheMotorInOpenLoopWith2127h) {
  Stepper drive;
  drive.put(0x20D0, 0, 2, 77);
  drive.put(0x20D1, 0, 2, 88);
  drive.put(0x2127, 0, 2, 1);
  EXPECT_EQ(drive.read(0x20D0), 77);  // closed loop
  drive.put(0x2127, 0, 2, 0);
  drive.put(0x20D9, 0, 2, 0);
  EXPECT_EQ(drive.read(0x20D0), 77);  // as it was set
  drive.put(0x2127, 0, 2, 1);
  EXPECT_EQ(drive.read(0x20D0), 3'200);
  EXPECT_EQ(drive.read(0x20D1), 1'100);
}

// shows 001.186, 001.188, 001.203, 001.213..001.215
TEST(Ezd1136Settings, GivesFunctionsAndLogicToItsInputs) {
  Stepper drive;
  EXPECT_EQ(drive.read(0x60FD), 0);
  drive.input("input 1 on");
  EXPECT_EQ(drive.read(0x60FD), 0x0001'0001);  // negative limit
  drive.input("input 1 off");
  drive.input("input 3 on");
  EXPECT_EQ(drive.read(0x60FD), 0x0004'0004);  // origin
  drive.input("input 3 off");
  drive.input("input 8 on");
  EXPECT_EQ(drive.read(0x60FD), 0x0080'0000);                                                 // no function
  EXPECT_EQ(drive.put(0x2190, 8, 2, 2), "085 00 08 81 00 00 00 00 00 | 185 50 0B 00 08 01");  // positive limit
  EXPECT_EQ(drive.read(0x60FD), 0x0080'0002);
  EXPECT_EQ(drive.put(0x21AD, 0, 2, 0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 00 08 01");  // input 8 is inverted
  EXPECT_EQ(drive.read(0x60FD), 0);
  drive.input("input 8 off");
  EXPECT_EQ(drive.read(0x60FD), 0x0080'0002);
  EXPECT_EQ(manual::write(drive, 0x2190, 1, 2, 5), refused(0x2190, 1, 0x0609'0031));
  EXPECT_EQ(drive.input("input 9 on"), "?");
}

// shows 001.186
TEST(Ezd1136Settings, StopsAtALimitSwitchOnlyWithItsFunction) {
  for (const std::uint32_t function : {0u, 2u}) {
    Runner drive;
    drive.put(0x2190, 2, 2, function);
    drive.run(100);
    drive.input("limit positive on");  // at input 2
    drive.pass(100ms);
    EXPECT_EQ(drive.read(0x606C), function == 0 ? 100 : 0);
  }
}

// shows 001.151, 001.186
TEST(Ezd1136Settings, StopsForTheEmergencyStopInput) {
  Runner drive;
  drive.put(0x6085, 0, 4, 1'000);
  drive.run(100);
  const std::string sent = drive.input("input 4 on");
  EXPECT_NE(sent.find("085 00 04 81 00 00 00 00 00"), std::string::npos) << sent;
  drive.pass(50ms);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
  EXPECT_EQ(drive.read(0x606C), 0);
  drive.control(0x06);
  drive.control(0x0F);
  drive.pass(50ms);
  EXPECT_NE(drive.state(), State::operation_enabled);  // as long as it is on
  drive.input("input 4 off");
  drive.enable();
}

// shows 001.102, 001.187, 001.189, 001.204, 001.214, 001.215
TEST(Ezd1136Settings, SwitchesItsOutputs) {
  Stepper drive;
  drive.put(0x60FE, 1, 4, 0x0003'0000);
  EXPECT_EQ(drive.app->outputs(), 0x00);  // 60FEh:02 does not release them
  drive.put(0x60FE, 2, 4, 0x0002'0000);
  EXPECT_EQ(drive.app->outputs(), 0x02);
  EXPECT_TRUE(drive.logged("output 2 on"));
  drive.put(0x21AE, 0, 2, 0x12);
  EXPECT_EQ(drive.app->outputs(), 0x10);  // outputs 2 and 5 are inverted
  EXPECT_TRUE(drive.logged("output 5 on"));
  drive.put(0x21AE, 0, 2, 0);
  drive.put(0x21A4, 1, 2, 1);  // alarm
  drive.put(0x21A4, 3, 2, 2);  // in position
  drive.put(0x21A4, 4, 2, 3);  // the motor has power
  EXPECT_EQ(drive.app->outputs(), 0x06);
  drive.enable();
  EXPECT_EQ(drive.app->outputs(), 0x0E);
  drive.put(0x607A, 0, 4, 4'000);
  drive.control(0x3F);
  EXPECT_EQ(drive.app->outputs(), 0x0A);
  drive.pass(2s);
  EXPECT_EQ(drive.app->outputs(), 0x0E);
  drive.input("alarm 26");
  EXPECT_EQ(drive.app->outputs(), 0x07);
  EXPECT_TRUE(drive.logged("output 1 on"));
  EXPECT_EQ(manual::write(drive, 0x21A4, 1, 2, 4), refused(0x21A4, 1, 0x0609'0031));
}

// shows 001.208, 001.220
TEST(Ezd1136Settings, BeginsAndEndsAMotionAtTheJumpingSpeed) {
  const auto seconds_at_10 = [](std::uint32_t jump) {
    Stepper drive;
    drive.put(0x6083, 0, 4, 10);
    drive.put(0x6084, 0, 4, 10);
    drive.put(0x6082, 0, 4, jump);
    drive.enable();
    drive.put(0x607A, 0, 4, 8'000);
    drive.control(0x3F);
    drive.pass(3ms);
    const std::int32_t first = drive.app->axis().velocity();
    std::int32_t last = 0;
    int steps = 3;
    for (; drive.app->axis().moving() && steps < 10'000; ++steps) {
      last = drive.app->axis().velocity();
      drive.pass(1ms);
    }
    EXPECT_EQ(drive.read(0x6064), 8'000);
    EXPECT_NEAR(first, static_cast<std::int32_t>(jump), 4);
    EXPECT_NEAR(last, static_cast<std::int32_t>(jump), 20);
    return steps;
  };
  EXPECT_LT(seconds_at_10(300), seconds_at_10(0) - 200);  // ms
}

// shows 001.171, 001.229
TEST(Ezd1136Settings, SmoothsTheMotionWithASmallerFilterCoefficient) {
  struct Run {
    std::int32_t velocity;  ///< 20 ms after a step of 5 turns per second
    int behind;             ///< at constant speed, pulses
    int end;                ///< ms until the position is reached
  };
  const auto run_with = [](std::uint32_t filter) {
    Run run{};
    Runner drive;
    drive.put(0x20E0, 0, 2, filter);
    drive.put(0x6083, 0, 4, 2'000);
    drive.put(0x60FF, 0, 4, 500);
    drive.enable();
    drive.pass(20ms);
    run.velocity = drive.app->axis().velocity();
    drive.pass(1s);
    EXPECT_NEAR(drive.app->axis().velocity(), 500, 2);
    run.behind = drive.app->axis().position_demand() - drive.app->axis().position();
    Stepper mover;
    mover.put(0x20E0, 0, 2, filter);
    mover.enable();
    mover.put(0x607A, 0, 4, 4'000);
    mover.control(0x3F);
    while ((mover.read(0x6041) & 0x0400) == 0 && run.end < 5'000) {
      mover.pass(1ms);
      ++run.end;
    }
    EXPECT_EQ(mover.read(0x6064), 4'000);
    return run;
  };
  const Run usual = run_with(50);
  const Run smooth = run_with(30);
  const Run smoothest = run_with(0);
  EXPECT_EQ(usual.velocity, 500);
  EXPECT_GT(usual.velocity, smooth.velocity);
  EXPECT_GT(smooth.velocity, smoothest.velocity);
  EXPECT_NEAR(usual.behind, 20, 5);
  EXPECT_NEAR(smooth.behind, 420, 10);  // 20 ms more
  EXPECT_NEAR(smoothest.behind, 1'020, 10);
  EXPECT_LT(usual.end, smooth.end);
  EXPECT_LT(smooth.end, smoothest.end);
  EXPECT_EQ(run_with(700).end, usual.end);
}

// shows 001.147
TEST(Ezd1136Settings, RaisesAlarm11WhileTheMotorIsNotConnected) {
  Stepper drive;
  EXPECT_EQ(drive.input("phases off"), "085 0B 00 03 00 00 00 00 00 | 185 18 02 0B 00 01");
  EXPECT_EQ(drive.control(0x80), "");
  drive.control(0x00);
  EXPECT_EQ(drive.input("phases on"), "");
  EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 0B 00 01");
}

// shows 001.150
TEST(Ezd1136Settings, RaisesAlarm26ForALoadAboveTheRatedTorque) {
  Runner drive;
  drive.run(100);
  drive.input("load 1000");
  drive.pass(10ms);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  const std::string sent = drive.input("load 1001") + drive.pass(10ms);
  EXPECT_NE(sent.find("085 1A 00 21 00 00 00 00 00"), std::string::npos) << sent;
}

// shows 001.113
TEST(Ezd1136Settings, IsOffWithoutAnAlarmAtPowerOn) {
  Stepper drive;
  EXPECT_EQ(drive.read(0x206D), 1);
  EXPECT_EQ(drive.read(0x206C), 0);
  EXPECT_EQ(drive.read(0x603F), 0);
  EXPECT_EQ(drive.read(0x2065), 4'800);
}

// shows 001.197, 001.200, 001.206
TEST(Ezd1136Settings, PlansTheTrajectoryFromTheMotionParameters) {
  Stepper drive;
  drive.put(0x6081, 0, 4, 400);  // 4 turns per second
  drive.put(0x6083, 0, 4, 4);    // in 1 s
  drive.put(0x6084, 0, 4, 8);    // in 0.5 s
  drive.enable();
  drive.put(0x607A, 0, 4, 4'000 * 7);  // 2 turns, 4 turns, 1 turn
  drive.control(0x3F);
  drive.pass(500ms);
  EXPECT_NEAR(drive.read(0x606C), 200, 6);
  drive.pass(500ms);
  EXPECT_NEAR(drive.read(0x6064), 8'000, 200);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C), 400);
  drive.pass(750ms);
  EXPECT_NEAR(drive.read(0x606C), 200, 12);
  drive.pass(300ms);
  EXPECT_EQ(drive.read(0x6064), 28'000);
  EXPECT_EQ(drive.read(0x206D), 2);
}

// shows 001.198
TEST(Ezd1136Settings, SetsTheOriginWithItsOffset) {
  Stepper drive;
  drive.put(0x607C, 0, 4, 1'000);
  drive.put(0x6098, 0, 1, 35);
  drive.put(0x6060, 0, 1, 6);
  drive.enable();
  drive.control(0x1F);
  drive.pass(10ms);
  EXPECT_EQ(drive.read(0x6064), -1'000);
}

// shows 001.202, 001.222
TEST(Ezd1136Settings, HomesWithItsSpeedsAndAcceleration) {
  Stepper drive;
  drive.put(0x6098, 0, 1, 17);
  drive.put(0x6099, 1, 4, 200);
  drive.put(0x6099, 2, 4, 50);
  drive.put(0x609A, 0, 4, 4);  // 2 turns per second in 0.5 s
  drive.put(0x6060, 0, 1, 6);
  drive.enable();
  drive.control(0x1F);
  drive.pass(250ms);
  EXPECT_NEAR(drive.read(0x606C), -100, 6);
  drive.pass(500ms);
  EXPECT_EQ(drive.read(0x606C), -200);
  drive.input("limit negative on");
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x606C), 50);
  drive.input("limit negative off");
  drive.pass(1s);
  EXPECT_EQ(drive.read(0x6041) & 0x1400, 0x1400);
}

// shows 001.201
TEST(Ezd1136Settings, StopsQuicklyWith6085hInEachMode) {
  for (const std::uint32_t mode : {1u, 3u, 6u}) {
    SCOPED_TRACE(mode);
    Stepper drive;
    drive.put(0x6085, 0, 4, 20);  // 2 turns per second in 0.1 s
    drive.put(0x6081, 0, 4, 200);
    drive.put(0x60FF, 0, 4, 200);
    drive.put(0x607A, 0, 4, 1'000'000);
    drive.put(0x6098, 0, 1, 18);
    drive.put(0x6099, 1, 4, 200);
    drive.put(0x6099, 2, 4, 200);
    drive.put(0x609A, 0, 4, 100);
    drive.put(0x6060, 0, 1, mode);
    drive.enable();
    if (mode != 3) drive.control(mode == 1 ? 0x3F : 0x1F);
    drive.pass(500ms);
    ASSERT_EQ(drive.read(0x606C), 200);
    drive.control(0x02);
    drive.pass(90ms);
    EXPECT_EQ(drive.state(), State::quick_stop_active);
    drive.pass(15ms);
    EXPECT_EQ(drive.state(), State::switch_on_disabled);
  }
}

// shows 001.207
TEST(Ezd1136Settings, AddsThePositionOffsetInCyclicPosition) {
  Stepper drive;
  drive.put(0x6060, 0, 1, 8);
  drive.enable();
  drive.put(0x607A, 0, 4, 300);
  drive.pass(50ms);
  EXPECT_EQ(drive.read(0x6064), 300);
  drive.put(0x60B0, 0, 4, static_cast<std::uint32_t>(-100));
  drive.pass(50ms);
  EXPECT_EQ(drive.read(0x6064), 200);
}

// shows 001.209
TEST(Ezd1136Settings, DoesNotUseBits9To15OfTheControlword) {
  Stepper drive;
  drive.control(0xFE06);
  EXPECT_EQ(drive.state(), State::ready_to_switch_on);
  drive.control(0xFE07);
  drive.control(0xFE0F);
  EXPECT_EQ(drive.state(), State::operation_enabled);
  EXPECT_EQ(drive.statusword(), 0x8237);
  drive.control(0x0F);
  EXPECT_EQ(drive.statusword(), 0x8237);
}

// shows 001.143, 001.144
TEST(Ezd1136Settings, AnswersNeitherSyncNorTheEmcyOfOtherNodes) {
  Stepper drive;
  drive.enable();
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("081 10 23 01 00 00 00 00 00"), "");
  EXPECT_EQ(drive.ask("086 10 23 01 00 00 00 00 00"), "");
  EXPECT_EQ(drive.state(), State::operation_enabled);
  EXPECT_EQ(drive.read(0x603F), 0);
  EXPECT_EQ(drive.read(0x1003), 0);
}

}  // namespace

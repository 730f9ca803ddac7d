/// Homing of CiA 402: controlword and statusword bits as bytes, and the motion of the axis.
#include <gtest/gtest.h>

#include "cia402_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::DriveBench;
namespace od = bench::od;
namespace mode = canopen::cia402::mode;

struct Method {
  std::int8_t number;
  std::int32_t place;  ///< home, relative to the start; limit switches at -5'000 and 5'000, home switch from 2'000 on
  std::int32_t near;   ///< distance of one step
};

TEST(Homing, FindsHomeByEachMethod) {
  constexpr Method methods[] = {
      {1, -4'000, 20}, {2, 4'000, 20}, {3, 1'000, 20},  {17, -5'000, 20}, {18, 5'000, 20},
      {19, 2'000, 20}, {33, 0, 20},    {34, 1'000, 20}, {35, 0, 0},       {37, 0, 0},
  };
  for (const Method& method : methods) {
    SCOPED_TRACE(int{method.number});
    DriveBench drive;
    drive.app->axis().negative_limit = -5'000;
    drive.app->axis().positive_limit = 5'000;
    drive.app->axis().home_switch = 2'000;
    drive.set<od::homing_method>(method.number);
    drive.enable(mode::homing);
    EXPECT_EQ(drive.control(0x1F), "185 37 02");
    drive.pass(10s);
    EXPECT_EQ(drive.statusword(), 0x1637);  // bits 10 and 12
    EXPECT_NEAR(drive.app->axis().machine_position() - drive.position(), method.place, method.near);
  }
}

TEST(Homing, LeavesTheHomeSwitchThatItHasFoundTheOtherWay) {
  for (const int method : {5, 21}) {
    SCOPED_TRACE(method);
    DriveBench drive;
    drive.set<od::homing_method>(static_cast<std::int8_t>(method));
    drive.enable(mode::homing);
    drive.control(0x1F);
    drive.pass(300ms);
    EXPECT_EQ(drive.velocity(), -10'000);
    drive.input("home on");
    drive.pass(300ms);
    EXPECT_EQ(drive.velocity(), 1'000);
    drive.input("home off");
    drive.pass(3s);
    EXPECT_EQ(drive.statusword(), 0x1637);
  }
}

TEST(Homing, TakesTheHomeOffset) {
  DriveBench drive;
  drive.set<od::homing_method>(35);
  drive.set<od::home_offset>(250);
  drive.enable(mode::homing);
  drive.control(0x1F);
  EXPECT_EQ(drive.pass(10ms), "185 37 16");
  EXPECT_EQ(drive.position(), -250);
  EXPECT_EQ(drive.get<od::position_actual_value>(), -250);
}

TEST(Homing, EndsWhenTheDriveLeavesOperationEnabled) {
  for (const int controlword : {0x10, 0x16, 0x17}) {
    SCOPED_TRACE(controlword);
    DriveBench drive;
    drive.set<od::homing_method>(17);
    drive.set<od::shutdown_option_code>(0);
    drive.set<od::disable_operation_option_code>(0);
    drive.enable(mode::homing);
    drive.control(0x1F);
    drive.pass(300ms);
    EXPECT_EQ(drive.velocity(), -10'000);
    drive.control(static_cast<std::uint16_t>(controlword));
    drive.pass(3s);
    for (const int word : {0x16, 0x17, 0x1F}) drive.control(static_cast<std::uint16_t>(word));
    EXPECT_EQ(drive.state(), bench::State::operation_enabled);
    drive.input("limit negative on");  // the switch that homing was looking for
    drive.pass(300ms);
    EXPECT_EQ(drive.velocity(), 0) << "bit 4 has not risen again";
    drive.input("limit negative off");
    drive.pass(3s);
    EXPECT_EQ(drive.statusword() & 0x3000, 0) << "home is neither attained nor missed";
  }
}

TEST(Homing, IsInterruptedWhenBit4Falls) {
  DriveBench drive;
  drive.set<od::homing_method>(17);
  drive.enable(mode::homing);
  EXPECT_EQ(drive.control(0x1F), "185 37 02");
  drive.pass(500ms);
  EXPECT_NE(drive.velocity(), 0);
  drive.control(0x0F);
  EXPECT_EQ(drive.pass(1s), "185 37 06");  // bit 10 without bit 12
  EXPECT_EQ(drive.velocity(), 0);
}

TEST(Homing, IsInterruptedByHalt) {
  DriveBench drive;
  drive.set<od::homing_method>(17);
  drive.enable(mode::homing);
  drive.control(0x1F);
  drive.pass(500ms);
  drive.control(0x11F);
  EXPECT_EQ(drive.pass(1s), "185 37 06");
  EXPECT_EQ(drive.control(0x1F), "");
  drive.pass(1s);
  EXPECT_EQ(drive.velocity(), 0);
}

TEST(Homing, FailsWithoutAMethodWithoutASpeedAndAtTheOtherLimitSwitch) {
  DriveBench drive;
  drive.enable(mode::homing);
  drive.control(0x1F);  // method 0
  drive.pass(10ms);
  EXPECT_EQ(drive.statusword(), 0x2637);  // bit 13, and the axis is at rest
  drive.control(0x0F);
  drive.set<od::homing_method>(17);
  drive.set<od::homing_speeds<1>>(0);
  drive.control(0x1F);
  drive.pass(10ms);
  EXPECT_EQ(drive.statusword(), 0x2637);
  drive.control(0x0F);
  drive.set<od::homing_speeds<1>>(10'000);
  drive.set<od::homing_method>(19);
  drive.control(0x1F);
  EXPECT_EQ(drive.pass(10ms), "");
  EXPECT_EQ(drive.statusword() & 0x2000, 0);
  drive.input("limit positive on");
  drive.pass(1s);
  EXPECT_EQ(drive.statusword(), 0x2E37);  // bit 11: the limit switch
}

}  // namespace

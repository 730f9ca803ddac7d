/// The runnable servo drive with its own modes: the statements of manual 002 about its application.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "cpd_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::Servo;
using canopen::cia402::State;
namespace od = cpd::od;

constexpr auto next_error = "605 40 3C 30 01 00 00 00 00";
constexpr auto oldest_error = "605 2B 3B 30 05 01 00 00 00";

std::string error_number(unsigned code) {
  return bench::text(
      {.id = 0x585,
       .size = 8,
       .data = {0x4B, 0x3C, 0x30, 0x01, static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8)}});
}

// shows 002.103
TEST(CpdNode, IsReadyToSwitchOnByItself) {
  bench::NodeBench<cpd_node::Cpd> drive;
  EXPECT_EQ(drive.ask(bench::start), "185 31 66");
  EXPECT_EQ(drive.ask("205 00 00"), "");
  EXPECT_EQ(drive.ask("205 06 00"), "");
  EXPECT_EQ(drive.ask("205 0F 00"), "185 37 46");
}

// shows 002.104, 002.256, 002.257, 002.263
TEST(CpdNode, HasItsModes) {
  Servo drive;
  const auto mode = [](int number, const char* answer) {
    return bench::text({.id = answer[0] == 'r' ? 0x605u : 0x585u,
                        .size = 8,
                        .data = {static_cast<std::uint8_t>(answer[0] == 'r' ? 0x2F : 0x4F),
                                 static_cast<std::uint8_t>(answer[0] == 'r' ? 0x60 : 0x61), 0x60, 0x00,
                                 static_cast<std::uint8_t>(number)}});
  };
  for (const int number : {1, 3, 6, -1, -2, -3, -4}) {
    EXPECT_EQ(drive.ask(mode(number, "request")), "585 60 60 60 00 00 00 00 00");
    EXPECT_EQ(drive.ask("605 40 61 60 00 00 00 00 00"), mode(number, "shown"));
  }
  EXPECT_EQ(drive.ask(mode(8, "request")), "585 80 60 60 00 30 00 09 06");
  EXPECT_EQ(drive.ask(mode(-5, "request")), "585 80 60 60 00 30 00 09 06");
}

// shows 002.35, 002.39, 002.116, 002.188, 002.240, 002.318, 002.319
TEST(CpdNode, SendsAnEmcyForAnErrorAndGoesToFault) {
  Servo drive;
  drive.enable(1);
  EXPECT_EQ(drive.input("fault 0x2212 0x20"), "085 12 22 21 00 00 00 00 00 | 185 38 66");
  EXPECT_EQ(drive.ask("605 40 3F 60 00 00 00 00 00"), "585 4B 3F 60 00 12 22 00 00");
  EXPECT_EQ(drive.ask("605 40 41 20 00 00 00 00 00"), "585 4B 41 20 00 20 00 00 00");  // bit 5
  EXPECT_EQ(drive.ask("205 80 00"), "085 00 00 00 00 00 00 00 00 | 185 31 66");
  EXPECT_EQ(drive.ask("605 40 41 20 00 00 00 00 00"), "585 4B 41 20 00 00 00 00 00");
  EXPECT_EQ(drive.get<od::error_code>(), 0x2212);  // of the last error
}

// shows 002.57
TEST(CpdNode, SwitchesToErrorStatusWhenNobodyGuardsItAnyMore) {  // 9.4.9, 7.2.2
  Servo drive;
  drive.ask("605 2B 0C 10 00 64 00 00 00");  // 100Ch: 100 ms
  drive.ask("605 2F 0D 10 00 03 00 00 00");  // 100Dh: 3
  drive.set<od::target_velocity>(500);
  drive.set<od::profile_deceleration>(5'000);
  drive.enable(3);
  drive.pass(500ms);
  ASSERT_EQ(drive.app->axis().velocity(), 500);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  EXPECT_EQ(drive.pass(310ms), "085 30 81 11 00 00 00 00 00");
  drive.pass(1s);
  EXPECT_EQ(drive.statusword() & 0x004F, 0x0008);  // bit 3, fault
  EXPECT_EQ(drive.app->axis().velocity(), 0);
  EXPECT_EQ(drive.ask("605 40 3F 60 00 00 00 00 00"), "585 4B 3F 60 00 30 81 00 00");
  EXPECT_EQ(drive.ask("605 40 41 20 00 00 00 00 00"), "585 4B 41 20 00 20 00 00 00");
  EXPECT_EQ(drive.ask(next_error), error_number(0x8130));
  EXPECT_EQ(drive.ask(next_error), error_number(0));
}

TEST(CpdNode, SwitchesToErrorStatusWithoutPowerToo) {
  Servo drive;
  drive.ask("605 2B 0C 10 00 64 00 00 00");
  drive.ask("605 2F 0D 10 00 03 00 00 00");
  drive.ask("705 R 1");
  EXPECT_EQ(drive.pass(310ms), "085 30 81 11 00 00 00 00 00");
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.ask("605 2B 40 60 00 80 00 00 00"), "585 60 40 60 00 00 00 00 00 | 085 00 00 11 00 00 00 00 00");
  EXPECT_EQ(drive.state(), State::ready_to_switch_on);
}

TEST(CpdNode, HasErrorsOfServicesIn603FhAndInItsErrorMemory) {  // 3.5.1
  Servo drive;
  EXPECT_EQ(drive.ask("205 0F"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 3F 60 00 00 00 00 00"), "585 4B 3F 60 00 10 82 00 00");
  EXPECT_EQ(drive.input("fault 0x2212 0x20").substr(0, 27), "085 12 22 31 00 00 00 00 00");
  EXPECT_EQ(drive.ask(next_error), error_number(0x8210));
  EXPECT_EQ(drive.ask(next_error), error_number(0x2212));
  EXPECT_EQ(drive.ask(next_error), error_number(0));
}

// shows 002.38
TEST(CpdNode, KeepsTheLast20ErrorsAndReadsThemFromTheOldestOn) {
  const std::string store = testing::TempDir() + "cpd_error_memory";
  for (const char* suffix : {"", ".application", ".lss"}) std::filesystem::remove(store + suffix);
  {
    Servo drive{store};
    EXPECT_EQ(drive.ask(next_error), error_number(0));
    for (int i = 1; i <= 22; ++i) drive.input("fault " + std::to_string(0x1000 + i));
    EXPECT_EQ(drive.ask(next_error), error_number(0x1003));
    EXPECT_EQ(drive.ask(next_error), error_number(0x1004));
    EXPECT_EQ(drive.ask(oldest_error), "585 60 3B 30 05 00 00 00 00");
    EXPECT_EQ(drive.ask(next_error), error_number(0x1003));
  }
  Servo again{store};  // a new process
  for (unsigned code = 0x1003; code <= 0x1016; ++code) EXPECT_EQ(again.ask(next_error), error_number(code));
  EXPECT_EQ(again.ask(next_error), error_number(0));
  for (const char* suffix : {"", ".application", ".lss"}) std::filesystem::remove(store + suffix);
}

// shows 002.99, 002.181, 002.314
TEST(CpdNode, SavesAndResetsItsSettingsBy3004h) {
  Servo drive;
  drive.ask("605 2B 29 30 04 64 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 04 30 01 01 00 00 00"), "585 60 04 30 01 00 00 00 00");  // PAReeprSave
  drive.power_cycle();
  EXPECT_EQ(drive.ask("605 40 29 30 04 00 00 00 00"), "585 4B 29 30 04 64 00 00 00");
  EXPECT_EQ(drive.ask("605 40 04 30 04 00 00 00 00"), "585 80 04 30 04 11 00 09 06");
  EXPECT_EQ(drive.ask("605 2B 04 30 08 01 00 00 00"), "585 60 04 30 08 00 00 00 00");  // PARusrReset
  drive.ask(bench::reset_node);
  EXPECT_EQ(drive.ask("605 40 29 30 04 00 00 00 00"), "585 4B 29 30 04 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 04 30 08 02 00 00 00"), "585 80 04 30 08 30 00 09 06");
}

// shows 002.74, 002.459
TEST(CpdNode, TakesAndSendsAPdoWhileBit31OfItsCobIdIs0) {
  Servo drive;
  drive.enable(3);
  drive.ask("405 0F 00 E8 03 00 00");  // R_PDO3: 1402h:01 is 8000 0405h
  EXPECT_EQ(drive.get<od::target_velocity>(), 0);
  EXPECT_EQ(drive.ask("605 23 02 14 01 05 04 00 00"), "585 60 02 14 01 00 00 00 00");
  drive.ask("405 0F 00 E8 03 00 00");
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().velocity(), 1'000);
  EXPECT_EQ(drive.ask("605 23 02 14 01 05 04 00 80"), "585 60 02 14 01 00 00 00 00");
  drive.ask("405 0F 00 00 00 00 00");
  EXPECT_EQ(drive.get<od::target_velocity>(), 1'000);
  EXPECT_EQ(drive.ask("080"), "");  // T_PDO2: 1801h:01 is C000 0285h
  EXPECT_EQ(drive.ask("605 23 01 18 01 85 02 00 40"), "585 60 01 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("080").substr(0, 4), "285 ");
}

// shows 002.88, 002.232, 002.484, 002.491, 002.494, 002.526, 002.539, 002.542
TEST(CpdNode, MapsPdo4OverTheBusAndPdo1To3Never) {
  Servo drive;
  for (const char* object : {"00 16", "01 16", "02 16", "00 1A", "01 1A", "02 1A"}) {
    EXPECT_EQ(drive.ask(std::string{"605 2F "} + object + " 00 00 00 00 00"),
              std::string{"585 80 "} + object + " 00 02 00 01 06");
  }
  EXPECT_EQ(drive.ask("605 23 03 16 01 20 00 FF 60"), "585 60 03 16 01 00 00 00 00");  // R_PDO4: 60FFh
  EXPECT_EQ(drive.ask("605 2F 03 16 00 01 00 00 00"), "585 60 03 16 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 03 14 01 05 05 00 00"), "585 60 03 14 01 00 00 00 00");
  drive.ask("505 F4 01 00 00");
  EXPECT_EQ(drive.get<od::target_velocity>(), 500);
  EXPECT_EQ(drive.ask("605 23 03 1A 01 20 00 64 60"), "585 60 03 1A 01 00 00 00 00");  // T_PDO4: 6064h
  EXPECT_EQ(drive.ask("605 2F 03 1A 00 01 00 00 00"), "585 60 03 1A 00 00 00 00 00");
  drive.ask("605 23 03 18 01 85 04 00 40");
  EXPECT_EQ(drive.input("position 1000"), "485 E8 03 00 00");
}

// shows 002.162
TEST(CpdNode, HasTheSubIndicesThatTable92LeavesOutReadOnly) {
  Servo drive;
  for (const char* object :
       {"01 16 03", "01 16 04", "02 16 03", "02 16 04", "01 1A 03", "01 1A 04", "02 1A 03", "02 1A 04"}) {
    EXPECT_EQ(drive.ask(std::string{"605 40 "} + object + " 00 00 00 00"),
              std::string{"585 43 "} + object + " 00 00 00 00");
    EXPECT_EQ(drive.ask(std::string{"605 23 "} + object + " 20 00 64 60"),
              std::string{"585 80 "} + object + " 02 00 01 06");
  }
}

// shows 002.111
TEST(CpdNode, BrakesInHaltAndGoesOnWithTheMovement) {
  Servo drive;
  drive.ask("605 23 01 14 01 05 03 00 00");  // R_PDO2
  drive.set<od::profile_velocity>(1'000);
  drive.set<od::profile_acceleration>(2'000);
  drive.set<od::profile_deceleration>(2'000);
  drive.enable(1);
  drive.ask("305 5F 00 A0 86 01 00");  // relative 100'000
  drive.pass(200ms);
  EXPECT_EQ(drive.app->axis().velocity(), 398);  // 2'000 rpm/s, one step late
  drive.ask("205 5F 01");
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().velocity(), 0);
  EXPECT_LT(drive.app->axis().position(), 100'000);
  drive.ask("205 5F 00");
  drive.pass(2s);
  EXPECT_EQ(drive.app->axis().position(), 100'000);
}

// shows 002.112
TEST(CpdNode, TellsStandstillWhenItHasStayedInTheWindow) {
  Servo drive;
  drive.set<od::position_window>(10);
  drive.set<od::position_window_time>(200);
  drive.set<od::profile_velocity>(1'000);
  drive.enable(1);
  drive.pass(1s);
  drive.set<od::target_position>(1'000);
  drive.ask("205 1F 00");
  drive.pass(150ms);
  EXPECT_EQ(drive.app->axis().position(), 1'000);
  EXPECT_EQ(drive.statusword() & 0x0400, 0);
  drive.pass(200ms);
  EXPECT_EQ(drive.statusword() & 0x0400, 0x0400);
}

// shows 002.113, 002.184
TEST(CpdNode, LosesItsReferenceBeyondTheRangeOfTheAxis) {
  Servo drive;
  drive.set<od::homing_method>(35);
  drive.enable(6);
  drive.ask("205 1F 00");
  drive.pass(10ms);
  EXPECT_EQ(drive.statusword(), 0xD637);  // bit 15
  drive.ask("205 00 00");
  EXPECT_NE(drive.input("position 0x10000000"), "?");
  EXPECT_EQ(drive.statusword() & 0x8000, 0x8000);
  EXPECT_NE(drive.input("position 0x10000001"), "?");
  EXPECT_EQ(drive.statusword() & 0x8000, 0);
}

// shows 002.114, 002.297, 002.305, 002.306
TEST(CpdNode, LatchesItsLimitsIn301Ch) {
  Servo drive;
  drive.set<od::target_velocity>(100);
  drive.enable(3);
  drive.pass(100ms);
  drive.input("limit positive on");
  EXPECT_EQ(drive.bus.take(), "");
  EXPECT_EQ(drive.ask("605 40 1C 30 08 00 00 00 00"), "585 4B 1C 30 08 02 00 00 00");
  drive.input("limit positive off");
  EXPECT_EQ(drive.ask("605 40 1C 30 07 00 00 00 00"), "585 4B 1C 30 07 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 1C 30 08 00 00 00 00"), "585 4B 1C 30 08 02 00 00 00");
  EXPECT_EQ(drive.ask("605 40 41 20 00 00 00 00 00"), "585 4B 41 20 00 40 00 00 00");  // an external error
  drive.pass(1s);
  drive.ask("205 80 00");
  EXPECT_EQ(drive.ask("605 40 1C 30 08 00 00 00 00"), "585 4B 1C 30 08 00 00 00 00");
  drive.set<od::software_position_limit<1>>(-1'000);
  drive.set<od::software_position_limit<2>>(1'000);
  drive.set<od::profile_velocity>(1'000);
  drive.set<od::target_position>(20'000);
  drive.enable(1);
  drive.ask("205 1F 00");
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().position(), 1'000);
  EXPECT_EQ(drive.ask("605 40 1C 30 08 00 00 00 00"), "585 4B 1C 30 08 04 00 00 00");
}

// shows 002.34, 002.35, 002.115, 002.304
TEST(CpdNode, ReportsAFollowingErrorBeyond6065h) {
  Servo drive;
  drive.set<od::following_error_window>(500);
  drive.set<od::target_velocity>(100);
  drive.enable(3);
  drive.pass(100ms);
  drive.input("block on");
  EXPECT_NE(drive.pass(100ms).find("085 11 86 21 11 86 65 60 00"), std::string::npos);
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.ask("605 40 3F 60 00 00 00 00 00"), "585 4B 3F 60 00 11 86 00 00");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 21 00 00 00");
}

// shows 002.108, 002.280
TEST(CpdNode, MovesByHandInEitherDirectionSlowAndFast) {
  Servo drive;
  drive.set<od::manual_movement::slow_speed>(100);
  drive.set<od::manual_movement::fast_speed>(250);
  drive.enable(-1);
  struct Row {
    std::uint16_t activation;
    std::int32_t velocity;
  };
  for (const auto& [activation, velocity] : {Row{1, 100}, Row{5, 250}, Row{2, -100}, Row{6, -250}, Row{0, 0}}) {
    drive.set<od::operating_mode_settings::manual_movement_activation>(activation);
    drive.pass(1s);
    EXPECT_EQ(drive.app->axis().velocity(), velocity);
  }
}

// shows 002.109, 002.271, 002.274
TEST(CpdNode, TakesCurrentAndSpeedFromParametersWhenTheyAreSelected) {
  Servo drive;
  drive.set<od::current_control::current_setpoint>(1'000);
  drive.enable(-3);
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().velocity(), 0);
  drive.set<od::operating_mode_settings::current_setpoint_specification>(2);
  drive.pass(101ms);
  EXPECT_EQ(drive.app->axis().velocity(), 2'000);  // 20'000 rpm/s
  drive.set<od::current_control::current_setpoint>(0);
  drive.pass(1s);
  drive.set<od::modes_of_operation>(-4);
  drive.set<od::speed_control::speed_setpoint>(-300);
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().velocity(), 0);
  drive.set<od::operating_mode_settings::speed_setpoint_specification>(2);
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().velocity(), -300);
}

// shows 002.110, 002.277, 002.278
TEST(CpdNode, FollowsPulsesByItsGear) {
  Servo drive;
  drive.set<od::electronic_gear::gear_numerator>(2);
  drive.set<od::electronic_gear::gear_denominator>(3);
  drive.enable(-2);
  drive.input("pulses 300");
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().position(), 0);  // neither selected nor switched on
  drive.set<od::position_interface::signal_selection>(1);
  drive.set<od::operating_mode_settings::gear_activation>(1);
  drive.pass(10ms);
  drive.input("pulses 300");
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().position(), 200);
  drive.input("pulses -600");
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().position(), -200);
}

}  // namespace

/// The reaction of a drive to a loss of communication while the motor turns: 6007h, abort connection option code
/// (CiA 402-2).
#include <gtest/gtest.h>

#include <canopen/can/bus_status.hpp>
#include <string>

#include "cia402_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::DriveBench;
using bench::State;
namespace od = bench::od;

constexpr auto watch_node_1_for_100_ms = "605 23 16 10 01 64 00 01 00";
constexpr auto heartbeat_of_node_1 = "701 05";
constexpr auto guard_time_100_ms = "605 2B 0C 10 00 64 00 00 00";
constexpr auto life_time_factor_3 = "605 2F 0D 10 00 03 00 00 00";
constexpr auto guarding_request = "705 R 1";
constexpr auto emcy_error_control = "085 30 81 11 00 00 00 00 00";
constexpr auto read_error_code = "605 40 3F 60 00 00 00 00 00";
constexpr auto fault_reset = "605 2B 40 60 00 80 00 00 00";

/// Runs at profile velocity 1000; `option` is the value of 6007h.
struct RunningDrive : DriveBench {
  explicit RunningDrive(std::int16_t option = 1) {
    set<od::abort_connection_option_code>(option);
    set<od::profile_deceleration>(10'000);
    run(1'000);
    bus.take();
  }
  void expect_fault() {
    EXPECT_TRUE(state() == State::fault_reaction_active || state() == State::fault);
    pass(1s);
    EXPECT_EQ(state(), State::fault);
    EXPECT_EQ(velocity(), 0);
    EXPECT_EQ(statusword() & 0x004F, 0x0008);
  }
};

TEST(Cia402AbortConnection, IsAFaultWhenNmtStopsTheNode) {
  RunningDrive drive;
  EXPECT_EQ(drive.ask(bench::stop), "");
  drive.expect_fault();
  EXPECT_EQ(drive.ask(bench::enter_pre_operational), "085 00 81 11 00 00 00 00 00");
  EXPECT_EQ(drive.ask(read_error_code), "585 4B 3F 60 00 00 81 00 00");
  EXPECT_EQ(drive.ask(fault_reset), "585 60 40 60 00 00 00 00 00 | 085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

TEST(Cia402AbortConnection, IsAFaultWhenAHeartbeatIsLost) {
  RunningDrive drive;
  drive.ask(watch_node_1_for_100_ms);
  drive.ask(heartbeat_of_node_1);
  EXPECT_EQ(drive.pass(99ms), "");
  EXPECT_EQ(drive.state(), State::operation_enabled);
  EXPECT_EQ(drive.pass(3ms), emcy_error_control);  // one EMCY, and Pre-operational by 1029h: no TPDO
  drive.expect_fault();
  EXPECT_EQ(drive.ask(read_error_code), "585 4B 3F 60 00 30 81 00 00");
  EXPECT_EQ(drive.ask(heartbeat_of_node_1), "085 00 00 11 00 00 00 00 00");  // the fault remains
  EXPECT_EQ(drive.state(), State::fault);
  EXPECT_EQ(drive.ask(fault_reset), "585 60 40 60 00 00 00 00 00 | 085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

TEST(Cia402AbortConnection, IsAFaultWhenAHeartbeatIsLateByOneFrame) {
  RunningDrive drive;
  drive.ask(watch_node_1_for_100_ms);
  drive.ask(heartbeat_of_node_1);
  drive.pass(99ms);
  drive.now = drive.now + 2ms;
  drive.app->node().on_time(drive.now);  // lost, and received again before the drive is called
  drive.app->node().on_frame(bench::frame(heartbeat_of_node_1), drive.now);
  ASSERT_TRUE(drive.app->drive().next_deadline());
  EXPECT_LE(*drive.app->drive().next_deadline(), drive.now);
  drive.app->on_time(drive.now);
  drive.expect_fault();
}

TEST(Cia402AbortConnection, IsAFaultWhenNobodyGuardsAnyMore) {
  RunningDrive drive;
  drive.ask(guard_time_100_ms);
  drive.ask(life_time_factor_3);
  EXPECT_EQ(drive.ask(guarding_request), "705 05");
  EXPECT_EQ(drive.pass(299ms), "");
  EXPECT_EQ(drive.state(), State::operation_enabled);
  EXPECT_EQ(drive.pass(3ms), emcy_error_control);
  drive.expect_fault();
}

TEST(Cia402AbortConnection, IsAFaultWhenTheControllerIsBusOff) {
  RunningDrive drive;
  drive.app->on_bus_status({canopen::BusState::off}, drive.now);
  drive.expect_fault();
  EXPECT_EQ(drive.get<od::error_code>(), 0x8140);
}

struct Row {
  std::int16_t option;
  State after;    ///< at once
  State at_rest;  ///< when the axis is at rest
  bool stays_on;  ///< the motor continues as before
};

TEST(Cia402AbortConnection, DoesWhat6007hSays) {
  for (const Row& row : {Row{0, State::operation_enabled, State::operation_enabled, true},
                         Row{1, State::fault_reaction_active, State::fault, false},
                         Row{2, State::switch_on_disabled, State::switch_on_disabled, false},
                         Row{3, State::quick_stop_active, State::switch_on_disabled, false},
                         Row{-1, State::fault_reaction_active, State::fault, false}}) {
    SCOPED_TRACE(row.option);
    RunningDrive stopped{row.option};
    stopped.set<od::quick_stop_deceleration>(10'000);
    stopped.ask(bench::stop);
    EXPECT_EQ(stopped.state(), row.after);
    stopped.pass(1s);
    EXPECT_EQ(stopped.state(), row.at_rest);
    EXPECT_EQ(stopped.velocity(), row.stays_on ? 1'000 : 0);

    RunningDrive off{row.option};
    off.app->on_bus_status({canopen::BusState::off}, off.now);
    EXPECT_EQ(off.state(), row.after);
  }
}

TEST(Cia402AbortConnection, LeavesAnAxisWithoutPowerAsItIs) {
  DriveBench drive;
  drive.control(0x06);
  drive.control(0x07);
  EXPECT_EQ(drive.ask(bench::stop), "");
  EXPECT_EQ(drive.state(), State::switched_on);
  EXPECT_EQ(drive.ask(bench::enter_pre_operational), "");
}

TEST(Cia402AbortConnection, CountsOncePerLoss) {
  RunningDrive drive;
  drive.ask(bench::stop);
  drive.pass(1s);
  drive.ask(bench::enter_pre_operational);
  drive.ask(fault_reset);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

/// A manufacturer's drive with its own reaction.
template <canopen::Bus B>
class OwnReaction : public nodes::DriveNode<OwnReaction<B>, cia402_drive::Device, B, canopen::cia402::Options{}> {
  using Base = nodes::DriveNode<OwnReaction<B>, cia402_drive::Device, B, canopen::cia402::Options{}>;

 public:
  OwnReaction(B& bus, nodes::Surroundings& around) : Base{bus, around, canopen::NodeId{5}, bench::plain_axis} {}

  void abort_connection(std::int16_t option) {
    seen = option;
    this->fault(0xFF01, canopen::ErrorRegister::manufacturer);
  }
  std::int16_t seen = 0;
};

TEST(Cia402AbortConnection, LeavesTheManufacturersCodesToTheApplication) {
  bench::NodeBench<OwnReaction> drive;
  drive.ask(bench::start);
  ASSERT_EQ(drive.app->node().set<od::abort_connection_option_code>(canopen::raw(-7)), canopen::ok);
  for (const char* word : {"205 06 00", "205 07 00", "205 0F 00"}) drive.ask(word);
  ASSERT_EQ(drive.app->drive().state(), State::operation_enabled);
  drive.ask(bench::stop);
  EXPECT_EQ(drive.app->seen, -7);
  EXPECT_EQ(drive.ask(bench::enter_pre_operational), "085 01 FF 81 00 00 00 00 00");
}

TEST(Cia402Drive, CatchesUpABoundedTimeAfterAStall) {
  RunningDrive drive;
  const std::int32_t before = drive.position();
  drive.now = drive.now + 60s;
  drive.app->on_time(drive.now);
  EXPECT_EQ(drive.position() - before, 100);  // 100 steps of 1 ms at 1000 increments per second
  drive.pass(1s);
  EXPECT_EQ(drive.position() - before, 1'100);
}

TEST(Cia402Drive, HasErrorsOfServicesIn603Fh) {
  DriveBench drive;
  EXPECT_EQ(drive.ask("205 0F"), "085 10 82 11 00 00 00 00 00");  // the RPDO is too short
  EXPECT_EQ(drive.ask(read_error_code), "585 4B 3F 60 00 10 82 00 00");
}

}  // namespace

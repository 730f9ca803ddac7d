#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <self_starting/device.hpp>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::Bench;
using canopen::NmtState;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(Nmt, SendsTheBootUpMessageAndEntersPreOperationalAtPowerOn) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  EXPECT_EQ(node.state(), NmtState::initialisation);
  node.start(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(node.state(), NmtState::pre_operational);
}

TEST(Nmt, EntersOperationalByItselfWhere1F80hSaysSo) {
  bench::RecordingBus bus;
  auto node = bench::make_node<self_starting::Device>(bus, canopen::NodeId{5});
  node.start(canopen::TimePoint{});
  EXPECT_TRUE(bus.take().starts_with("705 00")) << "the boot-up message is the first frame";
  EXPECT_EQ(node.state(), NmtState::operational);
  for (const char* const reset : {"000 81 05", "000 82 05"}) {
    node.on_frame(bench::frame("000 80 05"), canopen::TimePoint{});
    EXPECT_EQ(node.state(), NmtState::pre_operational);
    bus.take();
    node.on_frame(bench::frame(reset), canopen::TimePoint{});
    EXPECT_TRUE(bus.take().starts_with("705 00"));
    EXPECT_EQ(node.state(), NmtState::operational);
  }
}

TEST(Nmt, WaitsForTheMasterWhereStored1F80hSaysSo) {
  bench::RecordingBus bus;
  canopen::MemoryStorage storage;
  auto node = bench::make_node<self_starting::Device>(bus, canopen::NodeId{5}, canopen::stored_in(storage));
  node.start(canopen::TimePoint{});
  bus.take();
  node.on_frame(bench::frame("605 23 80 1F 00 04 00 00 00"), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "585 60 80 1F 00 00 00 00 00");
  node.on_frame(bench::frame("605 23 10 10 01 73 61 76 65"), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "585 60 10 10 01 00 00 00 00");
  node.on_frame(bench::frame("000 81 05"), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(node.state(), NmtState::pre_operational);
}

TEST(Nmt, IsDeafBeforeItIsStarted) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  node.on_frame(bench::frame("000 01 05"), canopen::TimePoint{});
  node.on_frame(bench::frame("605 40 00 10 00 00 00 00 00"), canopen::TimePoint{});
  node.on_time(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "");
  EXPECT_EQ(node.state(), NmtState::initialisation);
  EXPECT_FALSE(node.next_deadline());
}

TEST(Nmt, FollowsEachCommand) {
  Bench device;
  device.ask("000 01 05");
  EXPECT_EQ(device.node.state(), NmtState::operational);
  device.ask("000 80 05");
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  device.ask("000 02 05");
  EXPECT_EQ(device.node.state(), NmtState::stopped);
  device.ask("000 01 05");
  EXPECT_EQ(device.node.state(), NmtState::operational);
}

TEST(Nmt, TakesCommandsToAllNodes) {
  Bench device;
  device.ask("000 01 00");
  EXPECT_EQ(device.node.state(), NmtState::operational);
}

TEST(Nmt, IgnoresCommandsToOtherNodes) {
  Bench device;
  device.ask("000 01 06");
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
}

TEST(Nmt, IgnoresUnknownCommandsAndShortRemoteOrExtendedFrames) {
  Bench device;
  for (const char* frame : {"000 03 05", "000 00 05", "000 01", "000", "000 R 2", "00000000 01 05"}) {
    device.ask(frame);
    EXPECT_EQ(device.node.state(), NmtState::pre_operational) << frame;
  }
}

TEST(Nmt, TakesCommandsWithMoreThanTwoBytes) {
  Bench device;
  device.ask("000 01 05 00 00");
  EXPECT_EQ(device.node.state(), NmtState::operational);
}

TEST(Nmt, AnswersEachResetWithTheBootUpMessage) {
  Bench device;
  for (const char* reset : {"000 81 05", "000 82 05", "000 81 00", "000 82 00"}) {
    device.ask(bench::start);
    EXPECT_EQ(device.ask(reset), "705 00") << reset;
    EXPECT_EQ(device.node.state(), NmtState::pre_operational) << reset;
  }
}

TEST(Nmt, ResetNodeTakesAllDefaultValues) {
  Bench device;
  device.node.set<od::profile_acceleration>(5);
  EXPECT_EQ(device.node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 1000u);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::producer_heartbeat_time>()), 0);
}

TEST(Nmt, ResetCommunicationKeepsTheValuesOfTheApplication) {
  Bench device;
  device.node.set<od::profile_acceleration>(5);
  EXPECT_EQ(device.node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  device.ask(bench::reset_communication);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 5u);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::producer_heartbeat_time>()), 0);
}

TEST(Nmt, TellsTheApplicationEachStateOnce) {
  std::vector<NmtState> states;
  auto device = bench::with(canopen::on_state([&](NmtState state) { states.push_back(state); }));
  device.ask(bench::start);
  device.ask(bench::start);
  device.ask(bench::stop);
  device.ask(bench::reset_communication);
  EXPECT_EQ(states, (std::vector{NmtState::initialisation, NmtState::pre_operational, NmtState::operational,
                                 NmtState::stopped, NmtState::initialisation, NmtState::pre_operational}));
}

TEST(Nmt, KeepsTheBootUpMessageUntilTheBusHasRoom) {
  bench::RecordingBus bus;
  bus.room = 0;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  node.start(canopen::TimePoint{5ms});
  EXPECT_EQ(bus.take(), "");
  EXPECT_EQ(node.next_deadline(), canopen::TimePoint{5ms});
  bus.room = 10;
  node.on_time(canopen::TimePoint{6ms});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_FALSE(node.next_deadline());
}

TEST(Nmt, ANodeIdReadAtStartUpCountsForAllIdentifiers) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{});
  node.start(canopen::NodeId{0x7F}, canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "77F 00");
  EXPECT_EQ(canopen::to_raw(node.get<od::tpdo_communication_parameter_1::cob_id_used_by_tpdo>()), 0x400001FFu);
  node.on_frame(bench::frame("67F 40 00 12 01 00 00 00 00"), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "5FF 43 00 12 01 7F 06 00 00");
}

}  // namespace

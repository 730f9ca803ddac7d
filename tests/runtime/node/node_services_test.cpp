/// Error control, LSS and bus status, as a node serves them.
#include <gtest/gtest.h>

#include <can_2057c/device.hpp>
#include <cpc_tc1/device.hpp>
#include <every_service/device.hpp>
#include <rk5c/device.hpp>

#include <cstring>

#include "support/bench.hpp"

namespace {

using canopen::HeartbeatEvent;
using canopen::LssBitTiming;
using canopen::LssError;
using canopen::NmtState;
using canopen::NodeId;
using namespace std::chrono_literals;

// Heartbeat consumer: the servo drive has four entries of 1016h.

using Drive = bench::Bench<cpc_tc1::Device>;

TEST(WatchedNode, LostSendsAnEmcyAndLeavesOperational) {
  Drive device;
  device.ask("605 23 16 10 01 64 00 07 00");  // node 7, 100 ms
  device.ask("605 2B 00 18 05 00 00 00 00");
  device.ask(bench::start);
  device.pass(10ms);
  EXPECT_EQ(device.node.state_of(NodeId{7}), std::nullopt);
  device.ask("707 05");
  EXPECT_EQ(device.node.state_of(NodeId{7}), NmtState::operational);
  device.pass(99'999us);
  EXPECT_EQ(device.node.state(), NmtState::operational);
  const std::string sent = device.pass(1us);
  EXPECT_NE(sent.find("085 30 81 11 00 00 00 00 00"), std::string::npos) << sent;
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  EXPECT_EQ(device.ask("707 05"), "085 00 00 00 00 00 00 00 00");
}

TEST(WatchedNode, HasOneEntryOnly) {
  Drive device;
  EXPECT_EQ(device.ask("605 23 16 10 01 64 00 07 00"), "585 60 16 10 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 16 10 02 C8 00 07 00"), "585 80 16 10 02 43 00 04 06");
  EXPECT_EQ(device.ask("605 23 16 10 01 C8 00 07 00"), "585 60 16 10 01 00 00 00 00");
}

TEST(WatchedNode, TellsTheApplication) {
  std::string log;
  auto device = bench::with<cpc_tc1::Device>(canopen::on_heartbeat([&](HeartbeatEvent event, NodeId node_id, NmtState) {
    log += "s~u-+"[static_cast<int>(event)] + std::to_string(node_id.value()) + " ";
  }));
  device.ask("605 23 16 10 01 64 00 07 00");
  device.ask("707 7F");
  device.ask("707 05");
  device.pass(1s);
  device.ask("707 05");
  EXPECT_EQ(log, "s7 ~7 -7 +7 ");
}

// Node guarding: an I/O module.

using Module = bench::Bench<can_2057c::Device>;

TEST(GuardedNode, AnswersWithAnAlternatingToggleBit) {
  Module device;
  EXPECT_EQ(device.ask("705 R 1"), "705 7F");
  EXPECT_EQ(device.ask("705 R 1"), "705 FF");
  device.ask(bench::start);
  EXPECT_EQ(device.ask("705 R 1"), "705 05");
  EXPECT_EQ(device.ask("706 R 1"), "");
}

TEST(GuardedNode, TellsThatItsGuardIsLostAndBack) {
  std::string log;
  auto device =
      bench::with<can_2057c::Device>(canopen::on_life_guarding([&](bool lost) { log += lost ? "lost " : "back "; }));
  device.ask("605 2B 0C 10 00 FA 00 00 00");  // 250 ms
  device.ask("605 2F 0D 10 00 04 00 00 00");  // life time factor 4
  device.ask(bench::start);
  device.pass(10s);
  EXPECT_EQ(log, "");
  device.ask("705 R 1");
  EXPECT_EQ(device.pass(999'999us), "");
  EXPECT_EQ(device.pass(1us), "085 30 81 11 07 00 00 00 00");
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  EXPECT_EQ(device.ask("705 R 1"), "705 FF | 085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(log, "lost back ");
}

TEST(GuardedNode, DoesNotAnswerWhileItHasAHeartbeat) {
  Module device;
  EXPECT_EQ(device.ask("605 2B 17 10 00 FA 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(device.ask("705 R 1"), "");
}

// Bus status

TEST(BusStatus, IsToldByEmcys) {
  Module device;
  device.node.on_bus_status({canopen::BusState::passive, false}, device.now);
  EXPECT_EQ(device.pass(0s), "085 20 81 11 00 00 00 00 00");
  device.node.on_bus_status({canopen::BusState::active, true}, device.now);
  EXPECT_EQ(device.pass(0s), "085 10 81 11 06 00 00 00 00 | 085 00 00 11 00 00 00 00 00");
  device.node.on_bus_status({canopen::BusState::active, false}, device.now);
  EXPECT_EQ(device.pass(0s), "085 00 00 00 00 00 00 00 00");
}

TEST(BusStatus, BusOffIsToldWhenItIsOver) {
  Module device;
  device.ask(bench::start);
  device.bus.take();
  device.bus.room = 0;
  device.node.on_bus_status({canopen::BusState::off, false}, device.now);
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  device.bus.room = 100;
  device.node.on_bus_status({canopen::BusState::active, false}, device.now);
  EXPECT_EQ(device.pass(0s), "085 40 81 11 08 00 00 00 00 | 085 00 00 00 00 00 00 00 00");
}

// LSS: the position sensor

struct Port {
  NodeId stored{126};
  int restarts = 0;

  LssError accept(NodeId) { return canopen::lss::success; }
  LssError accept(LssBitTiming) { return canopen::lss::success; }
  LssError store(NodeId node_id, LssBitTiming) {
    stored = node_id;
    return canopen::lss::success;
  }
  LssBitTiming bit_timing() { return {}; }
  void stop_communication() {}
  void start_communication(LssBitTiming) { ++restarts; }
};

template <class Device>
struct DeviceWithLss {
  explicit DeviceWithLss(NodeId node_id) : node{bus, node_id, canopen::configured_by_lss(port)} { node.start(now); }
  std::string ask(const std::string& request) {
    node.on_frame(bench::frame(request), now);
    return bus.take();
  }

  Port port;
  bench::RecordingBus bus;
  canopen::TimePoint now{};
  bench::NodeOf<Device, bench::RecordingBus, canopen::ConfiguredByLss<Port>> node;
};
using Sensor = DeviceWithLss<rk5c::Device>;

TEST(NodeWithLss, WithoutNodeIdStaysInInitialisationUntilItGetsOne) {
  Sensor device{canopen::unconfigured_node_id};
  EXPECT_EQ(device.bus.take(), "");
  EXPECT_EQ(device.node.state(), NmtState::initialisation);
  EXPECT_EQ(device.ask("000 01 00"), "");
  EXPECT_EQ(device.ask("7E5 04 01 00 00 00 00 00 00"), "");                             // configuration state
  EXPECT_EQ(device.ask("7E5 5E 00 00 00 00 00 00 00"), "7E4 5E FF 00 00 00 00 00 00");  // inquire node-ID
  EXPECT_EQ(device.ask("7E5 11 20 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");  // node-ID 32
  EXPECT_EQ(device.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");  // store
  EXPECT_EQ(device.ask("7E5 04 00 00 00 00 00 00 00"), "720 00");                       // waiting: boots up
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  EXPECT_EQ(device.port.stored, NodeId{32});
}

TEST(NodeWithLss, NewNodeIdCountsAfterResetCommunication) {
  Sensor device{NodeId{5}};
  EXPECT_EQ(device.bus.take(), "705 00");
  device.ask("7E5 04 01 00 00 00 00 00 00");
  device.ask("7E5 11 20 00 00 00 00 00 00");
  device.ask("7E5 04 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.node_id(), NodeId{5});
  EXPECT_EQ(device.ask("605 40 00 18 01 00 00 00 00").substr(0, 3), "585");
  EXPECT_EQ(device.ask("000 82 05"), "720 00");
  EXPECT_EQ(device.ask("620 40 00 18 01 00 00 00 00"), "5A0 42 00 18 01 A0 01 00 00");  // 180h + 32
}

TEST(NodeWithLss, ResetNodeBringsTheStoredNodeIdBack) {
  Sensor device{NodeId{5}};
  device.bus.take();
  device.ask("7E5 04 01 00 00 00 00 00 00");
  device.ask("7E5 11 20 00 00 00 00 00 00");
  device.ask("7E5 04 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("000 81 05"), "705 00");
}

TEST(NodeWithLss, WithoutNodeIdSendsNoHeartbeatThatIsDue) {
  DeviceWithLss<every_service::Device> device{NodeId{5}};  // the node-ID of the sensor cannot be removed
  device.ask("605 2B 17 10 00 0A 00 00 00");               // every 10 ms
  device.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 11 FF 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  device.now = device.now + 20ms;
  EXPECT_EQ(device.ask("000 82 05"), "");
  EXPECT_EQ(device.node.state(), NmtState::initialisation);
}

TEST(NodeWithLss, TellsItsIdentityAndTakesABitRate) {
  Sensor device{NodeId{5}};
  device.bus.take();
  device.ask("7E5 04 01 00 00 00 00 00 00");
  const std::uint32_t vendor_id = device.node.entries().number(rk5c::Device::dictionary.find(0x1018, 1));
  canopen::Frame answer{.id = 0x7E4, .size = 8, .data = {0x5A}};
  std::memcpy(&answer.data[1], &vendor_id, sizeof vendor_id);
  EXPECT_EQ(device.ask("7E5 5A 00 00 00 00 00 00 00"), bench::text(answer));
  EXPECT_EQ(device.ask("7E5 13 00 02 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");  // 500 kbit/s
}

TEST(NodeWithLss, SleepsWhileTheBitRateIsSwitched) {
  Sensor device{NodeId{5}};
  device.bus.take();
  device.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");  // 125 kbit/s
  device.ask("7E5 15 64 00 00 00 00 00 00");                                            // in 100 ms
  const canopen::TimePoint begin = device.now;
  device.now = begin + 100ms;
  device.node.on_time(device.now);
  device.node.emergency(0x1000, canopen::ErrorRegister::generic);
  EXPECT_EQ(device.node.next_deadline(), begin + 200ms);
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), "");
  device.now = begin + 200ms;
  device.node.on_time(device.now);
  EXPECT_EQ(device.port.restarts, 1);
  EXPECT_EQ(device.bus.take(), "085 00 10 01 00 00 00 00 00");
}

}  // namespace

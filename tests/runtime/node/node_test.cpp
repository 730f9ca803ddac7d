#include <gtest/gtest.h>
#include <canopen/node.hpp>

#include <array>
#include <limits>
#include <type_traits>

#include "support/bench.hpp"

namespace {

using bench::Bench;
using canopen::AbortCode;
namespace od = sample::od;
using namespace std::chrono_literals;

struct Nowhere {
  static bool send(const canopen::Frame&) { return true; }
};
Nowhere nowhere;
constinit auto at_link_time = bench::make_node<sample::Device>(
    nowhere, canopen::NodeId{}, canopen::on_write<od::controlword>([](std::uint16_t) {}));

TEST(Node, IsInitialisedWhenTheProgramIsLinked) {
  at_link_time.start(canopen::NodeId{9}, canopen::TimePoint{});
  EXPECT_EQ(at_link_time.node_id(), canopen::NodeId{9});
  EXPECT_EQ(at_link_time.get<od::profile_acceleration>(), 1000u);
}

TEST(Node, ABusWithoutStateAndHandlersWithoutCapturesTakeNoMemory) {
  auto two = bench::make_node<sample::Device>(nowhere, canopen::NodeId{},
                                              canopen::on_write<od::controlword>([](std::uint16_t) {}),
                                              canopen::on_read<od::statusword>([] {}));
  EXPECT_EQ(sizeof at_link_time, sizeof two);
  // Plus the state of a handler call.
  EXPECT_LE(sizeof at_link_time, sizeof(bench::NodeOf<sample::Device, Nowhere>) + 8);
}

TEST(Node, CannotBeCopied) {
  using Node = bench::NodeOf<sample::Device, Nowhere>;
  static_assert(!std::is_copy_constructible_v<Node> && !std::is_move_constructible_v<Node>);
}

TEST(Node, SetsAndGetsObjectsWhateverTheirAccessOnTheBus) {
  Bench device;
  EXPECT_EQ(device.node.set<od::statusword>(0x0237), canopen::ok);
  EXPECT_EQ(device.node.get<od::statusword>(), 0x0237);
  EXPECT_EQ(device.node.set<od::password>(1), canopen::ok);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::device_type>()), 0x000F0191u);
  EXPECT_EQ(device.node.get<od::lowest_temperature>(), -5);
}

TEST(Node, RefusesValuesOutsideTheirLimits) {
  Bench device;
  EXPECT_EQ(device.node.set<od::integer8_value>(std::int8_t{101}), AbortCode::value_too_high);
  EXPECT_EQ(device.node.set<od::integer8_value>(std::int8_t{-101}), AbortCode::value_too_low);
  EXPECT_EQ(device.node.set<od::unsigned24_value>(std::uint32_t{0x1000000}), AbortCode::value_too_high);
  EXPECT_EQ(device.node.set<od::real32_value>(1.6f), AbortCode::value_too_high);
  EXPECT_EQ(device.node.set<od::real32_value>(std::numeric_limits<float>::quiet_NaN()), AbortCode::invalid_value);
  EXPECT_EQ(device.node.get<od::integer8_value>(), 0);
}

TEST(Node, SetsObjectsByNumber) {
  Bench device;
  const std::uint8_t two[] = {0x34, 0x12};
  EXPECT_EQ(device.node.set(0x6041, 0, two), canopen::ok);
  EXPECT_EQ(device.node.get<od::statusword>(), 0x1234);
  EXPECT_EQ(device.node.set(0x1000, 0, two), AbortCode::read_only);
  EXPECT_EQ(device.node.set(0x5000, 0, two), AbortCode::no_object);
  EXPECT_EQ(device.node.set(0x6041, 1, two), AbortCode::no_sub_index);
  EXPECT_EQ(device.node.set(0x6060, 0, two), AbortCode::length_too_high);
  const std::uint8_t eleven[] = {11};
  EXPECT_EQ(device.node.set(0x6060, 0, eleven), AbortCode::value_too_high);
}

TEST(Node, DoesNotCallHandlersForItsOwnApplication) {
  int calls = 0;
  auto device = bench::with(canopen::on_write<od::controlword>([&](std::uint16_t) { ++calls; }));
  device.node.set<od::controlword>(1);
  EXPECT_EQ(calls, 0);
}

TEST(Node, ADomainStaysBoundOverAReset) {
  Bench device;
  std::array<std::uint8_t, 6> memory{1, 2, 3, 4, 5, 6};
  device.node.bind<od::parameter_file>(memory);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.ask("605 40 12 20 00 00 00 00 00"), "585 41 12 20 00 06 00 00 00");
}

TEST(Node, EndsTheTransferOfADomainThatGetsOtherMemory) {
  std::array<std::uint8_t, 16> memory{};
  std::array<std::uint8_t, 16> other{};
  const auto downloading = [&](bench::Bench<>& device) {
    device.node.bind<od::parameter_file>(memory);
    EXPECT_EQ(device.ask("605 21 12 20 00 0A 00 00 00"), "585 60 12 20 00 00 00 00 00");
    device.node.bind<od::parameter_file>(other);
  };
  const std::string aborted = "585 80 12 20 00 20 00 00 08";
  Bench device;
  downloading(device);
  ASSERT_TRUE(device.node.next_deadline());
  EXPECT_LE(*device.node.next_deadline(), device.now) << "at once";
  EXPECT_EQ(device.pass(0s), aborted);
  Bench asked;
  downloading(asked);
  EXPECT_EQ(asked.ask("605 40 01 10 00 00 00 00 00"), aborted + " | 585 4F 01 10 00 00 00 00 00");
}

TEST(Node, SendsConstantBytesAsADomain) {
  static constexpr std::uint8_t bytes[] = {1, 2, 3};
  Bench device;
  device.node.bind_constant<od::log_file>(bytes);
  EXPECT_EQ(device.ask("605 40 1A 20 00 00 00 00 00"), "585 47 1A 20 00 01 02 03 00");
}

TEST(Node, EndsTheTransferOfADomainThatGetsOtherConstantBytes) {
  static constexpr std::uint8_t bytes[] = {1, 2, 3, 4, 5, 6, 7, 8};
  Bench device;
  device.node.bind_constant<od::log_file>(bytes);
  EXPECT_EQ(device.ask("605 40 1A 20 00 00 00 00 00"), "585 41 1A 20 00 08 00 00 00");
  device.node.bind_constant<od::log_file>(bytes);
  EXPECT_EQ(device.ask("605 40 01 10 00 00 00 00 00"), "585 80 1A 20 00 20 00 00 08 | 585 4F 01 10 00 00 00 00 00");
}

// shows 000.32
TEST(Node, ChangesItsStateWhenTheApplicationAsks) {
  Bench device;
  device.node.request(canopen::NmtCommand::start, device.now);
  EXPECT_EQ(device.node.state(), canopen::NmtState::operational);
  EXPECT_EQ(device.bus.take(), "185 00 00 00 00 00 00");
  device.node.request(canopen::NmtCommand::stop, device.now);
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "");
  device.node.request(canopen::NmtCommand::enter_pre_operational, device.now);
  EXPECT_EQ(device.ask("605 2B 17 10 00 64 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  device.node.request(canopen::NmtCommand::reset_communication, device.now);
  EXPECT_EQ(device.bus.take(), "705 00");
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 00 00 00");
  device.node.request(canopen::NmtCommand::reset_node, device.now);
  EXPECT_EQ(device.bus.take(), "705 00");
}

TEST(Node, StaysAsItIsBeforeItHasPower) {
  bench::RecordingBus bus;
  bench::NodeOf<sample::Device, bench::RecordingBus> node{bus, canopen::NodeId{5}};
  node.request(canopen::NmtCommand::start, {});
  EXPECT_EQ(node.state(), canopen::NmtState::initialisation);
  EXPECT_EQ(bus.take(), "");
}

TEST(Node, TellsTheNearestDeadline) {
  Bench device;
  EXPECT_FALSE(device.node.next_deadline());
  EXPECT_EQ(device.node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(30)), canopen::ok);
  EXPECT_EQ(device.pass(0ms), "705 7F");
  device.ask(bench::start);
  EXPECT_EQ(device.node.next_deadline(), device.now + 30ms);
  device.pass(90ms);
  EXPECT_EQ(device.node.next_deadline(), device.now + 10ms);
}

TEST(Node, TwoOfTheSameDeviceShareNothing) {
  Bench first;
  Bench second;
  first.node.set<od::statusword>(1);
  EXPECT_EQ(second.node.get<od::statusword>(), 0);
}

TEST(Node, SendsTheAnswerBeforeTheHeartbeatAndTheHeartbeatBeforePdos) {
  auto device = bench::with(canopen::on_write<od::profile_acceleration>([](auto& node, std::uint32_t) {
    node.template set<od::statusword>(1);
    EXPECT_EQ(node.template set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  }));
  device.ask(bench::start);
  EXPECT_EQ(device.ask("605 23 83 60 00 01 00 00 00"), "585 60 83 60 00 00 00 00 00 | 705 05 | 185 01 00 00 00 00 00");
}

}  // namespace

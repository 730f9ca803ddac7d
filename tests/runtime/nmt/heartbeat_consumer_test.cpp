#include <gtest/gtest.h>
#include <canopen/nmt/heartbeat_consumer.hpp>

#include <can_2057c/device.hpp>
#include <cpc_tc1/device.hpp>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::ConsumerHeartbeatTime;
using canopen::HeartbeatEvent;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

constexpr const char* event_names[] = {"started", "state changed", "boot-up", "lost", "back"};

/// A consumer that records its events: "5 started 7F".
template <std::size_t Count>
class Listener {
 public:
  /// Returns the events that a frame causes.
  std::string hear(const std::string& text) {
    if (const auto message = canopen::error_control_message(bench::frame(text))) {
      consumer.on_message(*message, now, Host{*this});
    }
    return take();
  }

  /// Returns the events during this time.
  std::string pass(canopen::Duration span) {
    const TimePoint end = now + span;
    while (const auto deadline = consumer.next_deadline()) {
      if (*deadline > end) break;
      now = *deadline;
      consumer.on_time(now, Host{*this});
    }
    now = end;
    consumer.on_time(now, Host{*this});
    return take();
  }

  void watch(std::size_t entry, std::uint32_t value) { consumer.configure(entry, ConsumerHeartbeatTime{value}); }
  [[nodiscard]] AbortCode check(std::size_t entry, std::uint32_t value) const {
    return consumer.check(entry, ConsumerHeartbeatTime{value});
  }

  canopen::HeartbeatConsumer<Count> consumer;
  TimePoint now{};

 private:
  struct Host {
    Listener& listener;
    void happened(HeartbeatEvent event, NodeId node_id, NmtState state) {
      char state_text[8];
      std::snprintf(state_text, sizeof state_text, "%02X", static_cast<unsigned>(state));
      listener.reported_ += (listener.reported_.empty() ? "" : " | ") + std::to_string(node_id.value()) + " " +
                            event_names[static_cast<int>(event)] + " " + state_text;
    }
  };

  std::string take() { return std::exchange(reported_, {}); }

  std::string reported_;
};

TEST(HeartbeatConsumer, ReadsAnEntryOf1016h) {
  constexpr ConsumerHeartbeatTime time{0x0005'01F4};
  static_assert(time.node_id() == NodeId{5} && time.milliseconds() == 500 && time.used());
  static_assert(ConsumerHeartbeatTime{NodeId{127}, 65535}.value() == 0x007F'FFFF);
  EXPECT_FALSE(ConsumerHeartbeatTime{0x0005'0000}.used());
  EXPECT_FALSE(ConsumerHeartbeatTime{0x0000'01F4}.used());
  EXPECT_FALSE(ConsumerHeartbeatTime{0x0080'01F4}.used());
}

TEST(HeartbeatConsumer, CostsEightBytesForEachNode) {
  EXPECT_EQ(sizeof(canopen::HeartbeatConsumer<1>), 8u);
  EXPECT_EQ(sizeof(canopen::HeartbeatConsumer<127>), 127u * 8u);
}

TEST(HeartbeatConsumer, WatchesFromTheFirstHeartbeatOn) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  EXPECT_FALSE(listener.consumer.next_deadline());
  EXPECT_EQ(listener.pass(10s), "");
  EXPECT_EQ(listener.hear("705 7F"), "5 started 7F");
  EXPECT_EQ(listener.consumer.next_deadline(), listener.now + 100ms);
  EXPECT_EQ(listener.pass(99'999us), "");
  EXPECT_EQ(listener.pass(1us), "5 lost 7F");
  EXPECT_TRUE(listener.consumer.any_lost());
  EXPECT_FALSE(listener.consumer.next_deadline());
  EXPECT_EQ(listener.pass(10s), "");
}

TEST(HeartbeatConsumer, EachHeartbeatBeginsTheTimeAnew) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(listener.pass(99ms), "");
    EXPECT_EQ(listener.hear("705 05"), "");
  }
  EXPECT_EQ(listener.pass(100ms), "5 lost 05");
}

TEST(HeartbeatConsumer, TellsStateChanges) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  EXPECT_EQ(listener.hear("705 7F"), "5 started 7F");
  EXPECT_EQ(listener.hear("705 7F"), "");
  EXPECT_EQ(listener.hear("705 05"), "5 state changed 05");
  EXPECT_EQ(listener.consumer.state_of(NodeId{5}), NmtState::operational);
  EXPECT_EQ(listener.hear("705 04"), "5 state changed 04");
}

TEST(HeartbeatConsumer, TellsThatANodeIsBack) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  listener.pass(100ms);
  EXPECT_EQ(listener.consumer.state_of(NodeId{5}), std::nullopt);
  EXPECT_EQ(listener.hear("705 7F"), "5 back 7F");
  EXPECT_FALSE(listener.consumer.any_lost());
  EXPECT_EQ(listener.pass(100ms), "5 lost 7F");
}

TEST(HeartbeatConsumer, ABootUpMessageAloneDoesNotStartIt) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  EXPECT_EQ(listener.hear("705 00"), "5 boot-up 00");
  EXPECT_EQ(listener.pass(1s), "");
  EXPECT_EQ(listener.hear("705 7F"), "5 started 7F");
}

TEST(HeartbeatConsumer, ABootUpMessageOfAWatchedNodeCountsAsAHeartbeat) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  listener.pass(60ms);
  EXPECT_EQ(listener.hear("705 00"), "5 boot-up 00");
  EXPECT_EQ(listener.pass(99ms), "");
  EXPECT_EQ(listener.hear("705 7F"), "5 state changed 7F");
  listener.hear("705 00");
  EXPECT_EQ(listener.pass(100ms), "5 lost 00");
}

TEST(HeartbeatConsumer, ALostNodeIsNotBackWithItsBootUpMessage) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  listener.pass(100ms);
  EXPECT_EQ(listener.hear("705 00"), "5 boot-up 00");
  EXPECT_TRUE(listener.consumer.any_lost());
  EXPECT_EQ(listener.hear("705 7F"), "5 back 7F");
}

TEST(HeartbeatConsumer, LeavesUnusedEntriesAndOtherNodesAlone) {
  for (const std::uint32_t unused : {0x0005'0000u, 0x0000'0064u, 0x0080'0064u, 0x00FF'0064u}) {
    Listener<1> listener;
    listener.watch(0, unused);
    EXPECT_EQ(listener.hear("705 05"), "") << unused;
    EXPECT_EQ(listener.pass(1s), "") << unused;
  }
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  EXPECT_EQ(listener.hear("706 05"), "");
  EXPECT_EQ(listener.hear("705 85"), "") << "an answer to a guarding request";
  EXPECT_EQ(listener.hear("705 R 1"), "");
  EXPECT_EQ(listener.pass(1s), "");
}

TEST(HeartbeatConsumer, RefusesTwoTimesForOneNode) {
  Listener<3> listener;
  listener.watch(0, 0x0005'0064);
  EXPECT_EQ(listener.check(1, 0x0005'00C8), AbortCode::parameter_incompatible);
  EXPECT_EQ(listener.check(0, 0x0005'00C8), canopen::ok) << "its own entry";
  EXPECT_EQ(listener.check(0, 0x0005'0064), canopen::ok) << "the same value again";
  EXPECT_EQ(listener.check(1, 0x0005'0000), canopen::ok) << "not used";
  EXPECT_EQ(listener.check(1, 0x0006'0064), canopen::ok);
  EXPECT_EQ(listener.check(2, 0x0000'0064), canopen::ok) << "no node";
  listener.watch(0, 0x0005'0000);
  EXPECT_EQ(listener.check(1, 0x0005'00C8), canopen::ok) << "the other one is not used any more";
}

TEST(HeartbeatConsumer, IgnoresTheLaterOfTwoStoredTimesForOneNode) {
  Listener<3> listener;
  listener.watch(0, 0x0006'0064);
  listener.watch(2, 0x0006'03E8);
  EXPECT_EQ(listener.hear("706 05"), "6 started 05");
  EXPECT_EQ(listener.pass(100ms), "6 lost 05") << "after the time of the first one";
  EXPECT_EQ(listener.pass(1s), "");
  EXPECT_EQ(listener.hear("706 05"), "6 back 05");
  EXPECT_EQ(listener.check(0, 0x0006'0065), AbortCode::parameter_incompatible) << "as long as there are two";
  listener.watch(0, 0);
  EXPECT_EQ(listener.hear("706 05"), "6 started 05");
  EXPECT_EQ(listener.pass(999ms), "");
  EXPECT_EQ(listener.pass(1ms), "6 lost 05");
}

TEST(HeartbeatConsumer, ANewValueForgetsTheNode) {
  Listener<1> listener;
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  listener.pass(100ms);
  listener.watch(0, 0x0005'00C8);
  EXPECT_FALSE(listener.consumer.any_lost());
  EXPECT_EQ(listener.hear("705 05"), "5 started 05");
  EXPECT_EQ(listener.pass(199ms), "");
  EXPECT_EQ(listener.pass(1ms), "5 lost 05");
}

TEST(HeartbeatConsumer, WatchesFor65535Milliseconds) {
  Listener<1> listener;
  listener.watch(0, 0x0005'FFFF);
  listener.hear("705 05");
  EXPECT_EQ(listener.pass(65'534ms), "");
  EXPECT_EQ(listener.pass(1ms), "5 lost 05");
}

TEST(HeartbeatConsumer, WatchesOnWhenTheTimeWraps) {
  Listener<1> listener;
  listener.now = TimePoint{canopen::Duration{0xFFFF'F000}};
  listener.watch(0, 0x0005'0064);
  listener.hear("705 05");
  EXPECT_EQ(listener.pass(99ms), "");
  EXPECT_EQ(listener.pass(1ms), "5 lost 05");
}

TEST(HeartbeatConsumer, Watches127Nodes) {
  Listener<127> listener;
  for (unsigned id = 1; id <= 127; ++id) listener.watch(127 - id, (id << 16) | (100 + id));
  for (unsigned id = 1; id <= 127; ++id) {
    char text[16];
    std::snprintf(text, sizeof text, "%03X 05", 0x700 + id);
    EXPECT_EQ(listener.hear(text), std::to_string(id) + " started 05");
  }
  EXPECT_EQ(listener.pass(100ms), "");
  for (unsigned id = 1; id <= 127; ++id) {
    EXPECT_EQ(listener.consumer.next_deadline(), listener.now + 1ms);
    EXPECT_EQ(listener.pass(1ms), std::to_string(id) + " lost 05");
  }
  EXPECT_FALSE(listener.consumer.next_deadline());
  EXPECT_EQ(listener.hear("77F 05"), "127 back 05");
}

TEST(HeartbeatConsumer, HasAnEntryForEachOf1016h) {
  static_assert(canopen::consumer_heartbeat_times(cpc_tc1::Device::dictionary) == 4);
  static_assert(canopen::consumer_heartbeat_times(can_2057c::Device::dictionary) == 0);
  canopen::ObjectStore<cpc_tc1::Device> store;
  store.set<cpc_tc1::od::consumer_heartbeat_time<1>>(
      canopen::from_raw<cpc_tc1::od::consumer_heartbeat_time<1>::type>(0x0005'0064));
  store.set<cpc_tc1::od::consumer_heartbeat_time<4>>(
      canopen::from_raw<cpc_tc1::od::consumer_heartbeat_time<4>::type>(0x0006'00C8));
  Listener<4> listener;
  listener.consumer.configure(store.entries());
  EXPECT_EQ(listener.hear("705 05"), "5 started 05");
  EXPECT_EQ(listener.hear("706 05"), "6 started 05");
  EXPECT_EQ(listener.pass(200ms), "5 lost 05 | 6 lost 05");
}

}  // namespace

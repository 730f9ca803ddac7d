/// Node guarding and life guarding: the slave, the master, and both on the wire.
#include <gtest/gtest.h>
#include <canopen/nmt/node_guarding.hpp>

#include <string>
#include <utility>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::GuardingEvent;
using canopen::NmtState;
using canopen::NodeGuardingMaster;
using canopen::NodeGuardingSlave;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

// The slave

/// A guarded node 5 in Pre-operational with its own guard time and life time factor.
struct Slave {
  Slave(std::uint16_t guard_time_ms, std::uint8_t factor) : guard_time{guard_time_ms}, life_time_factor{factor} {}

  std::string ask(const std::string& text = "705 R 1") {
    if (canopen::is_guarding_request(frame(text), NodeId{5})) {
      guarding.on_request(guard_time, life_time_factor, now);
      EXPECT_TRUE(guarding.serve(bus, NodeId{5}, state));
    }
    return bus.take();
  }

  /// Returns the number of life guarding events during this time.
  int pass(canopen::Duration span) {
    int events = 0;
    const TimePoint end = now + span;
    while (const auto deadline = guarding.next_deadline()) {
      if (*deadline > end) break;
      now = *deadline;
      events += guarding.on_time(guard_time, now) ? 1 : 0;
    }
    now = end;
    return events + (guarding.on_time(guard_time, now) ? 1 : 0);
  }

  NodeGuardingSlave guarding;
  bench::RecordingBus bus;
  TimePoint now{};
  NmtState state = NmtState::pre_operational;
  std::uint16_t guard_time;
  std::uint8_t life_time_factor;
};

TEST(NodeGuarding, AnswersWithTheStateAndAToggleBitThatBeginsWith0) {
  Slave slave{0, 0};
  EXPECT_EQ(slave.ask(), "705 7F");
  EXPECT_EQ(slave.ask(), "705 FF");
  EXPECT_EQ(slave.ask(), "705 7F");
  slave.state = NmtState::operational;
  EXPECT_EQ(slave.ask(), "705 85");
  slave.state = NmtState::stopped;
  EXPECT_EQ(slave.ask(), "705 04");
  EXPECT_EQ(slave.ask(), "705 84");
}

TEST(NodeGuarding, ResetCommunicationResetsTheToggleBit) {
  Slave slave{100, 2};
  EXPECT_EQ(slave.ask(), "705 7F");
  slave.guarding.reset();
  EXPECT_FALSE(slave.guarding.next_deadline());
  EXPECT_EQ(slave.ask(), "705 7F");
}

TEST(NodeGuarding, TakesRequestsOfAnyLengthForThisNodeOnly) {
  Slave slave{0, 0};
  EXPECT_EQ(slave.ask("705 R 0"), "705 7F");
  EXPECT_EQ(slave.ask("705 R 8"), "705 FF");
  for (const char* other : {"706 R 1", "700 R 1", "00000705 R 1", "705 00", "705"})
    EXPECT_EQ(slave.ask(other), "") << other;
}

TEST(NodeGuarding, KeepsTheAnswerUntilTheBusHasRoom) {
  Slave slave{0, 0};
  slave.bus.room = 0;
  slave.guarding.on_request(0, 0, slave.now);
  EXPECT_FALSE(slave.guarding.serve(slave.bus, NodeId{5}, slave.state));
  EXPECT_TRUE(slave.guarding.has_answer());
  slave.bus.room = 10;
  EXPECT_TRUE(slave.guarding.serve(slave.bus, NodeId{5}, NmtState::operational));
  EXPECT_EQ(slave.bus.take(), "705 05");
  EXPECT_TRUE(slave.guarding.serve(slave.bus, NodeId{5}, NmtState::operational));
  EXPECT_EQ(slave.bus.take(), "") << "one answer for one request";
  EXPECT_EQ(slave.ask(), "705 FF");
}

TEST(LifeGuarding, BeginsWithTheFirstRequest) {
  Slave slave{250, 4};
  EXPECT_FALSE(slave.guarding.next_deadline());
  EXPECT_EQ(slave.pass(10s), 0);
  EXPECT_EQ(slave.ask(), "705 7F");
  EXPECT_EQ(slave.pass(1s), 1);
}

TEST(LifeGuarding, FailsAtExactlyTheLifeTime) {
  struct Row {
    std::uint16_t guard_time;
    std::uint8_t factor;
    std::uint32_t life_time;  ///< ms
  };
  constexpr Row rows[] = {{250, 4, 1000},  {1, 1, 1},          {100, 1, 100},
                          {10, 255, 2550}, {65535, 1, 65'535}, {65535, 255, 16'711'425}};
  for (const Row& row : rows) {
    Slave slave{row.guard_time, row.factor};
    slave.ask();
    std::uint32_t left = row.life_time - 1;
    for (; left > 1'000'000; left -= 1'000'000)
      EXPECT_EQ(slave.pass(1'000'000ms), 0);  // longer than the range of a TimePoint
    EXPECT_EQ(slave.pass(std::chrono::milliseconds{left}), 0) << row.guard_time << " * " << int{row.factor};
    EXPECT_EQ(slave.pass(999us), 0) << row.guard_time << " * " << int{row.factor};
    EXPECT_FALSE(slave.guarding.failed());
    EXPECT_EQ(slave.pass(1us), 1) << row.guard_time << " * " << int{row.factor};
    EXPECT_TRUE(slave.guarding.failed());
  }
}

TEST(LifeGuarding, FailsOnceAndIsOverWithTheNextRequest) {
  Slave slave{100, 2};
  slave.ask();
  EXPECT_EQ(slave.pass(10s), 1);
  EXPECT_EQ(slave.ask(), "705 FF") << "the toggle bit goes on";
  EXPECT_FALSE(slave.guarding.failed());
  EXPECT_EQ(slave.pass(199ms), 0);
  EXPECT_EQ(slave.pass(1ms), 1);
}

TEST(LifeGuarding, EachRequestBeginsTheLifeTimeAnew) {
  Slave slave{100, 3};
  for (int i = 0; i < 20; ++i) {
    slave.ask();
    EXPECT_EQ(slave.pass(299ms), 0);
  }
  EXPECT_EQ(slave.pass(1ms), 1);
}

TEST(LifeGuarding, IsOffWithATimeOrFactorOf0ButAnswers) {
  for (const auto& [guard_time, factor] : {std::pair{0, 4}, std::pair{250, 0}, std::pair{0, 0}}) {
    Slave slave{static_cast<std::uint16_t>(guard_time), static_cast<std::uint8_t>(factor)};
    EXPECT_EQ(slave.ask(), "705 7F");
    EXPECT_EQ(slave.ask(), "705 FF");
    EXPECT_FALSE(slave.guarding.next_deadline());
    EXPECT_EQ(slave.pass(60s), 0);
  }
}

TEST(LifeGuarding, EndsWhenAParameterBecomes0) {
  Slave slave{100, 2};
  slave.ask();
  slave.guarding.configure(100, 0);
  EXPECT_EQ(slave.pass(1s), 0);
  slave.ask();
  slave.pass(1s);
  EXPECT_TRUE(slave.guarding.failed());
  slave.guarding.configure(0, 2);
  EXPECT_FALSE(slave.guarding.failed());
}

TEST(LifeGuarding, NewTimesCountFromTheNextRequestOn) {
  Slave slave{100, 2};
  slave.ask();
  slave.life_time_factor = 5;
  slave.guarding.configure(100, 5);
  EXPECT_EQ(slave.pass(150ms), 0);
  slave.ask();
  EXPECT_EQ(slave.pass(499ms), 0);
  EXPECT_EQ(slave.pass(1ms), 1);
}

// The master

constexpr const char* event_names[] = {"started",          "state changed", "boot-up", "toggle error",
                                       "unexpected state", "lost",          "back"};

/// A master that guards node 5; what it sends and its events are in one line.
struct Master {
  Master(std::uint16_t guard_time, std::uint8_t factor) { guard.start(NodeId{5}, guard_time, factor, now); }

  std::string hear(const std::string& text) {
    if (const auto message = canopen::error_control_message(frame(text))) guard.on_message(*message, Host{*this});
    return take();
  }

  std::string pass(canopen::Duration span) {
    const TimePoint end = now + span;
    while (const auto deadline = guard.next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now) now = *deadline;
      const bool served = guard.serve(bus, now, Host{*this});
      collect();
      if (!served) break;
    }
    now = end;
    return take();
  }

  struct Host {
    Master& master;
    void happened(GuardingEvent event, NodeId node_id, NmtState state) {
      char text[40];
      std::snprintf(text, sizeof text, "%d %s %02X", node_id.value(), event_names[static_cast<int>(event)],
                    static_cast<unsigned>(state));
      master.add(text);
    }
  };

  void add(const std::string& text) {
    if (!text.empty()) log += (log.empty() ? "" : " | ") + text;
  }
  void collect() { add(bus.take()); }
  std::string take() { return std::exchange(log, {}); }

  NodeGuardingMaster guard;
  bench::RecordingBus bus;
  std::string log;
  TimePoint now{};
};

TEST(NodeGuardingMaster, AsksEveryGuardTime) {
  Master master{100, 3};
  EXPECT_EQ(master.pass(0ms), "705 R 1");
  EXPECT_EQ(master.hear("705 7F"), "5 started 7F");
  EXPECT_EQ(master.pass(99ms), "");
  EXPECT_EQ(master.pass(1ms), "705 R 1");
  EXPECT_EQ(master.hear("705 FF"), "");
  EXPECT_EQ(master.pass(100ms), "705 R 1");
  EXPECT_EQ(master.hear("705 05"), "5 state changed 05");
  EXPECT_EQ(master.guard.state(), NmtState::operational);
}

TEST(NodeGuardingMaster, IgnoresAnAnswerWithTheWrongToggleBit) {
  Master master{100, 2};
  master.pass(0ms);
  master.hear("705 7F");
  EXPECT_EQ(master.hear("705 7F"), "5 toggle error 7F") << "a second answer to the same request";
  EXPECT_EQ(master.pass(100ms), "705 R 1");
  EXPECT_EQ(master.hear("705 05"), "5 toggle error 7F") << "its state is not taken";
  EXPECT_EQ(master.guard.state(), NmtState::pre_operational);
  EXPECT_EQ(master.pass(100ms), "705 R 1");
  EXPECT_EQ(master.hear("705 05"), "5 toggle error 7F");
  EXPECT_EQ(master.pass(100ms), "5 lost 7F | 705 R 1") << "two requests without a good answer";
}

TEST(NodeGuardingMaster, GetsOverAnAnswerThatWasLostOnItsWay) {
  Master master{100, 4};
  master.pass(0ms);
  master.hear("705 05");
  master.pass(100ms);  // 705 85 does not arrive
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 05"), "5 toggle error 05");
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 85"), "");
}

TEST(NodeGuardingMaster, LosesANodeAtExactlyTheLifeTime) {
  Master master{100, 3};
  master.pass(0ms);
  master.hear("705 05");
  master.pass(100ms);  // the first request without an answer
  EXPECT_EQ(master.pass(299ms), "705 R 1 | 705 R 1");
  EXPECT_EQ(master.pass(1ms), "5 lost 05 | 705 R 1");
  EXPECT_EQ(master.guard.state(), std::nullopt);
  EXPECT_EQ(master.pass(200ms), "705 R 1 | 705 R 1") << "it is asked on";
  EXPECT_EQ(master.hear("705 05"), "5 back 05") << "with any toggle bit";
}

TEST(NodeGuardingMaster, ANodeThatNeverAnswersIsLost) {
  Master master{100, 0};
  EXPECT_EQ(master.pass(99ms), "705 R 1");
  EXPECT_EQ(master.pass(1ms), "5 lost 00 | 705 R 1");
}

TEST(NodeGuardingMaster, WantsToggleBit0AfterABootUpMessage) {
  Master master{100, 3};
  master.pass(0ms);
  master.hear("705 7F");
  EXPECT_EQ(master.hear("705 00"), "5 boot-up 00");
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 FF"), "5 toggle error 00");
  EXPECT_EQ(master.hear("705 7F"), "5 state changed 7F");
}

TEST(NodeGuardingMaster, TellsAStateThatWasNotCommanded) {
  Master master{100, 3};
  master.pass(0ms);
  master.hear("705 7F");
  master.pass(100ms);
  master.guard.expect(NmtState::operational);
  EXPECT_EQ(master.hear("705 FF"), "") << "the request was earlier than the command";
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 7F"), "5 unexpected state 7F");
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 FF"), "") << "told once";
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 05"), "5 state changed 05");
  master.pass(100ms);
  EXPECT_EQ(master.hear("705 84"), "5 state changed 04 | 5 unexpected state 04");
}

TEST(NodeGuardingMaster, WaitsForRoomOnTheBus) {
  Master master{100, 2};
  master.bus.room = 0;
  EXPECT_EQ(master.pass(50ms), "");
  master.bus.room = 10;
  EXPECT_EQ(master.pass(0ms), "705 R 1");
  EXPECT_EQ(master.guard.next_deadline(), TimePoint{100ms}) << "the raster stays";
}

TEST(NodeGuardingMaster, StopsAsking) {
  Master master{100, 2};
  master.pass(0ms);
  master.guard.stop();
  EXPECT_EQ(master.pass(10s), "");
  EXPECT_EQ(master.hear("705 7F"), "");
}

TEST(NodeGuardingMaster, AndSlaveAgreeOnTheWire) {
  Master master{100, 3};
  Slave slave{100, 3};
  std::string log;
  for (int i = 0; i < 6; ++i) {
    const std::string request = master.pass(i == 0 ? 0ms : 100ms);
    slave.pass(i == 0 ? 0ms : 100ms);
    if (i == 3) slave.state = NmtState::operational;
    const std::string answer = slave.ask(request);
    const std::string told = master.hear(answer);
    log += request + ", " + answer + (told.empty() ? "; " : " (" + told + "); ");
  }
  EXPECT_EQ(log,
            "705 R 1, 705 7F (5 started 7F); 705 R 1, 705 FF; 705 R 1, 705 7F; "
            "705 R 1, 705 85 (5 state changed 05); 705 R 1, 705 05; 705 R 1, 705 85; ");
  EXPECT_FALSE(slave.guarding.failed());
}

}  // namespace

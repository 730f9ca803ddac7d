#include <gtest/gtest.h>
#include <canopen/node.hpp>
#include <canopen_sim/virtual/key_tree.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::Duration;
using canopen::Frame;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = sample::od;
using namespace std::chrono_literals;

/// All frames on the bus, each with its time in microseconds.
class Log {
 public:
  explicit Log(VirtualBus& bus) {
    bus.listen([this](const Frame& frame, TimePoint now) {
      lines.push_back(std::to_string(now.since_start().count()) + ": " + bench::text(frame));
    });
  }
  std::vector<std::string> lines;
};

using Lines = std::vector<std::string>;

TEST(VirtualBus, DeliversToAllOthersButNotToTheSender) {
  VirtualBus bus;
  int received[3] = {};
  VirtualBus::Endpoint* endpoints[3] = {&bus.attach(), &bus.attach(), &bus.attach()};
  for (int i = 0; i < 3; ++i) {
    endpoints[i]->on_frame = [&received, i](const Frame&, TimePoint) { ++received[i]; };
  }
  endpoints[0]->send(frame("181 01"));
  EXPECT_EQ(bus.settle(), 1u);
  EXPECT_EQ(received[0], 0);
  EXPECT_EQ(received[1], 1);
  EXPECT_EQ(received[2], 1);
}

TEST(VirtualBus, TheLowestCanIdWins) {
  VirtualBus bus;
  Log log{bus};
  auto& first = bus.attach();
  auto& second = bus.attach();
  first.send(frame("701 05"));
  first.send(frame("081 00"));
  second.send(frame("181 01"));
  second.send(frame("18100000 01"));
  bus.settle();
  // A controller sends its own frames in the order of the calls.
  EXPECT_EQ(log.lines, (Lines{"0: 181 01", "0: 18100000 01", "0: 701 05", "0: 081 00"}));
}

TEST(VirtualBus, FramesSentDuringDeliveryWaitTheirTurn) {
  VirtualBus bus;
  Log log{bus};
  auto& client = bus.attach();
  auto& server = bus.attach();
  bool inside = false;
  server.on_frame = [&](const Frame& got, TimePoint) { server.send(Frame{.id = got.id + 1}); };
  client.on_frame = [&](const Frame& got, TimePoint) {
    EXPECT_FALSE(inside);
    inside = true;
    if (got.id < 0x105) client.send(Frame{.id = got.id + 1});
    inside = false;
  };
  client.send(frame("100"));
  EXPECT_EQ(bus.settle(), 6u);
}

TEST(VirtualBus, AnEndpointThatWaitsForRoomLetsTimePass) {
  VirtualBus bus{1'000'000};
  auto& sender = bus.attach();
  sender.queue_limit = 1;
  int left = 3;
  const auto send = [&] {
    while (left != 0 && sender.send(frame("100"))) --left;
  };
  sender.next_deadline = [&] { return left != 0 ? std::optional{bus.now()} : std::nullopt; };
  sender.on_time = [&](TimePoint) { send(); };
  Log log{bus};
  bus.run_for(1ms);
  EXPECT_EQ(log.lines, (Lines{"47: 100", "94: 100", "141: 100"}));
}

TEST(VirtualBus, AFrameTakesItsTimeOnTheWire) {
  VirtualBus bus{500'000};
  Log log{bus};
  auto& sender = bus.attach();
  sender.send(frame("181 01 02 03 04 05 06 07 08"));  // 111 bits
  sender.send(frame("701 05"));                       // 55 bits
  bus.run_for(1ms);
  EXPECT_EQ(log.lines, (Lines{"222: 181 01 02 03 04 05 06 07 08", "332: 701 05"}));
}

TEST(VirtualBus, AFullQueueHasNoRoom) {
  VirtualBus bus;
  auto& sender = bus.attach();
  sender.queue_limit = 1;
  EXPECT_TRUE(sender.send(frame("181")));
  EXPECT_FALSE(sender.send(frame("181")));
}

TEST(VirtualBus, TimeGoesFromDeadlineToDeadline) {
  VirtualBus bus;
  Log log{bus};
  auto& endpoint = bus.attach();
  auto node = bench::make_node<sample::Device>(endpoint, canopen::NodeId{5});
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  EXPECT_EQ(node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  bus.run_for(250ms);
  EXPECT_EQ(log.lines, (Lines{"0: 705 00", "0: 705 7F", "100000: 705 7F", "200000: 705 7F"}));
  EXPECT_EQ(bus.now(), TimePoint{250ms});
}

TEST(VirtualBus, NodesTalkToEachOther) {
  VirtualBus bus{250'000};
  Log log{bus};
  auto& master = bus.attach();
  auto& endpoint = bus.attach();
  auto node = bench::make_node<sample::Device>(endpoint, canopen::NodeId{5},
                                               canopen::on_write<od::controlword>([](auto& device, std::uint16_t v) {
                                                 device.template set<od::statusword>(v);
                                               }));
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  bus.settle();
  master.send(frame("000 01 05"));
  bus.settle();
  log.lines.clear();
  master.send(frame("205 0F 00 00 00 00 00 00"));
  bus.settle();
  ASSERT_EQ(log.lines.size(), 2u);
  EXPECT_NE(log.lines[1].find("185 0F 00 00 00 00 00"), std::string::npos);
}

TEST(VirtualBus, ANodeWhoseQueueIsFullSendsLater) {
  VirtualBus bus{1'000'000};
  Log log{bus};
  auto& endpoint = bus.attach();
  endpoint.queue_limit = 1;
  auto node = bench::make_node<sample::Device>(endpoint, canopen::NodeId{5});
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  EXPECT_EQ(node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  bus.run_for(10ms);
  EXPECT_EQ(log.lines, (Lines{"55: 705 00", "110: 705 7F"}));
}

TEST(VirtualBus, AsksAnEndpointForItsDeadlineOnlyWhenItMayHaveChanged) {
  VirtualBus bus;
  unsigned asked = 0;
  auto& idle = bus.attach();
  idle.next_deadline = [&] {
    ++asked;
    return std::optional{TimePoint{10s}};
  };
  auto& busy = bus.attach();
  TimePoint next{};
  busy.next_deadline = [&] { return std::optional{next}; };
  busy.on_time = [&](TimePoint now) { next = now + 1ms; };
  bus.run_for(1s);
  EXPECT_LE(asked, 1u);
}

TEST(VirtualBus, SettlesTwoEndpointsThatAnswerEachOtherForTheGivenNumberOfFrames) {
  VirtualBus bus;
  auto& left = bus.attach();
  auto& right = bus.attach();
  left.on_frame = [&](const Frame&, TimePoint) { (void)left.send(frame("181 01")); };
  right.on_frame = [&](const Frame&, TimePoint) { (void)right.send(frame("182 01")); };
  (void)left.send(frame("181 01"));
  EXPECT_EQ(bus.settle(10), 10u);
}

TEST(VirtualBus, SettlesADeadlineThatItsOwnerHasChangedMeanwhile) {
  VirtualBus bus;
  std::optional<TimePoint> due;
  auto& endpoint = bus.attach();
  endpoint.next_deadline = [&] { return due; };
  endpoint.on_time = [&](TimePoint) {
    due.reset();
    (void)endpoint.send(frame("181 01"));
  };
  bus.run_for(1ms);
  due = bus.now();
  EXPECT_EQ(bus.settle(), 1u);
}

TEST(VirtualBus, AnEndpointWhoseDeadlineAnotherOneHasChangedSaysSo) {
  VirtualBus bus;
  std::optional<TimePoint> begin{TimePoint{5ms}};
  std::optional<TimePoint> caused;
  std::vector<TimePoint> calls;
  auto& effect = bus.attach();
  effect.next_deadline = [&] { return caused; };
  effect.on_time = [&](TimePoint now) {
    calls.push_back(now);
    caused.reset();
  };
  auto& cause = bus.attach();
  cause.next_deadline = [&] { return begin; };
  cause.on_time = [&](TimePoint now) {
    begin.reset();
    caused = now + 2ms;
    effect.deadline_changed();
  };
  bus.run_for(1s);
  EXPECT_EQ(calls, std::vector{TimePoint{7ms}});
}

TEST(VirtualBus, DeadlinesAreServedInTheOrderInWhichEndpointsWereAttached) {
  VirtualBus bus;
  std::string order;
  std::vector<std::optional<TimePoint>> deadlines(9, TimePoint{3ms});
  for (std::size_t i = 0; i < deadlines.size(); ++i) {
    auto& endpoint = bus.attach();
    endpoint.next_deadline = [&deadlines, i] { return deadlines[i]; };
    endpoint.on_time = [&, i](TimePoint) {
      order += static_cast<char>('0' + i);
      deadlines[i].reset();
    };
  }
  bus.run_for(3ms);
  EXPECT_EQ(order, "012345678");
}

TEST(VirtualBus, TimePassesUntilAConditionHolds) {
  VirtualBus bus{1'000'000};
  auto& device = bus.attach();
  auto& tester = bus.attach();
  std::string received;
  tester.on_frame = [&](const Frame& frame, TimePoint) { received = bench::text(frame); };
  const auto any = [&] { return !received.empty(); };
  tester.send(frame("081"));     // 47 us; not received by its sender
  device.send(frame("181 01"));  // 55 us after that
  device.send(frame("281 01 02 03"));
  bus.run_until(any, 1ms);
  EXPECT_EQ(received, "181 01");
  EXPECT_EQ(bus.now(), TimePoint{Duration{102}});
  received.clear();
  bus.run_until(any, Duration{10});
  EXPECT_EQ(received, "");
  EXPECT_EQ(bus.now(), TimePoint{Duration{112}});
  bus.run_until(any, 1ms);
  EXPECT_EQ(received, "281 01 02 03");
  EXPECT_EQ(bus.elapsed(), 173u);
}

TEST(VirtualBus, FramesOfAnEndpointWithoutPowerAreLost) {
  VirtualBus bus{1'000'000};
  Log log{bus};
  auto& device = bus.attach();
  auto& tester = bus.attach();
  device.send(frame("081"));
  device.send(frame("181"));
  tester.send(frame("281"));
  bus.run_for(Duration{10});  // 081 is on the wire
  device.discard();
  device.send(frame("381"));
  bus.run_for(1ms);
  EXPECT_EQ(log.lines, (Lines{"57: 281", "104: 381"}));
}

TEST(VirtualBus, ElapsedTimeDoesNotWrap) {
  VirtualBus bus;
  bus.run_for(Duration{0x8000'0000});
  bus.run_for(Duration{0x8000'0000});
  EXPECT_EQ(bus.elapsed(), 0x1'0000'0000u);
  EXPECT_EQ(bus.now(), TimePoint{});
}

TEST(VirtualBus, TimeBeginsAtZeroAgain) {
  VirtualBus bus;
  std::vector<TimePoint> calls;
  auto& endpoint = bus.attach();
  TimePoint next{30min};
  endpoint.next_deadline = [&] { return std::optional{next}; };
  endpoint.on_time = [&](TimePoint now) {
    calls.push_back(now);
    next = now + 30min;
  };
  bus.run_for(60min);
  bus.run_for(60min);
  const TimePoint half_hour{30min};
  EXPECT_EQ(calls, (std::vector{half_hour, half_hour + 30min, half_hour + 60min, half_hour + 60min + 30min}));
}

TEST(KeyTree, FindsWhatALoopOverAllKeysFinds) {
  using canopen::KeyTree;
  for (const std::size_t size : {1u, 2u, 3u, 8u, 13u, 127u}) {
    std::mt19937 random{static_cast<std::uint32_t>(size)};
    KeyTree tree;
    std::vector<KeyTree::Key> keys;
    for (int round = 0; round < 2000; ++round) {
      if (keys.size() < size) {
        keys.push_back(KeyTree::none);
        tree.resize(keys.size());
      }
      const std::size_t place = random() % keys.size();
      keys[place] = random() % 4 == 0 ? KeyTree::none : random() % 50;
      tree.set(place, keys[place]);
      ASSERT_EQ(tree.least(), *std::min_element(keys.begin(), keys.end()));
      const KeyTree::Key limit = random() % 50;
      const std::size_t from = random() % (keys.size() + 1);
      const auto first = std::find_if(keys.begin() + static_cast<std::ptrdiff_t>(from), keys.end(),
                                      [limit](KeyTree::Key key) { return key <= limit; });
      const std::size_t expected =
          first == keys.end() ? KeyTree::no_place : static_cast<std::size_t>(first - keys.begin());
      ASSERT_EQ(tree.first_up_to(limit, from), expected);
    }
  }
}

}  // namespace

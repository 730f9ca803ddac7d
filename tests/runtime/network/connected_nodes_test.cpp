/// Nodes that report their use to a VirtualBus send the same frames at the same times as nodes whose endpoints get each
/// frame and are asked for their deadline after each: those with callbacks of their own.
#include <gtest/gtest.h>

#include <can_2053c/device.hpp>
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::Duration;
using canopen::EmergencyCode;
using canopen::ErrorRegister;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using namespace std::chrono_literals;

constexpr std::uint8_t max_nodes = 24;

struct Dice {
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine()); }
  std::mt19937 engine;
};

/// What an application does with a node.
class Application {
 public:
  virtual ~Application() = default;
  virtual void set(std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t size) = 0;
  virtual void report(std::uint16_t code) = 0;
  virtual void end_report() = 0;
  virtual void request(canopen::NmtCommand command, TimePoint now) = 0;
  virtual void restart(TimePoint now) = 0;
  virtual void change_values() = 0;
  [[nodiscard]] virtual TimePoint now() const = 0;
};

/// `own_callbacks`: the bus does not know what its callbacks do.
template <class Device>
class Station final : public Application {
 public:
  Station(VirtualBus& bus, std::uint8_t node_id, bool own_callbacks)
      : endpoint_{bus.attach()}, node_{endpoint_, NodeId{node_id}} {
    endpoint_.queue_limit = 3;
    VirtualBus::connect(endpoint_, node_);
    if (own_callbacks) endpoint_.on_frame = [this](const Frame& got, TimePoint now) { node_.on_frame(got, now); };
    node_.start(bus.now());
  }
  void set(std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t size) override {
    std::array<std::uint8_t, 4> bytes{};
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    (void)node_.set(index, sub_index, std::span{bytes}.first(size));
  }
  void report(std::uint16_t code) override { node_.emergency(EmergencyCode{code}, ErrorRegister{}); }
  void end_report() override { node_.emergency_over(ErrorRegister{}); }
  void request(canopen::NmtCommand command, TimePoint now) override { node_.request(command, now); }
  void restart(TimePoint now) override {
    endpoint_.discard();
    node_.start(now);
  }
  void change_values() override { (void)node_.values(); }
  [[nodiscard]] TimePoint now() const override { return node_.now(); }

 private:
  VirtualBus::Endpoint& endpoint_;
  bench::NodeOf<Device, VirtualBus::Endpoint> node_;
};

struct Conditions {
  std::uint32_t bit_rate;
  canopen::WireModel model;
  std::uint32_t seed;
};

class Network {
 public:
  Network(bool own_callbacks, const Conditions& conditions)
      : dice_{std::mt19937{conditions.seed}},
        own_callbacks_{own_callbacks},
        bus_{conditions.bit_rate, conditions.model},
        has_errors_{conditions.bit_rate != 0} {
    tester_.queue_limit = 40;
    for (int i = 0; i < 12; ++i) add();
    bus_.listen([this](const Frame& sent, TimePoint now) {
      log(now, bench::text(sent));
      if (dice_() % 16 == 0) use();
      if (dice_() % 64 == 0) tester_.send(random_frame());
    });
    // Another endpoint uses nodes while it processes a frame, before and after they get it.
    VirtualBus::Endpoint& user = bus_.attach();
    user.on_frame = [this](const Frame&, TimePoint) {
      if (dice_() % 16 == 0) use();
    };
    for (int i = 0; i < 4; ++i) add();
    // Its own time: only the next frame makes the bus ask for the deadlines of other nodes.
    user.on_time = [this](TimePoint) {
      use();
      next_use_ = bus_.now() + Duration{1 + dice_() % 50'000};
    };
    user.next_deadline = [this] { return std::optional{next_use_}; };
  }

  void run(int steps) {
    for (int step = 0; step < steps; ++step) {
      for (std::uint32_t i = dice_() % 3; i != 0; --i) use();
      for (std::uint32_t i = dice_() % 3; i != 0; --i) tester_.send(random_frame());
      if (dice_() % 50 == 0) burst();
      if (dice_() % 40 == 0 && stations_.size() < max_nodes) add();
      if (dice_() % 40 == 0 && has_errors_) bus_.make_errors(Duration{dice_() % 3 == 0 ? 0 : 500 + dice_() % 100'000});
      switch (dice_() % 24) {
        case 0: bus_.run_for(Duration{dice_() % 400'000}); break;
        case 1: bus_.settle(100); break;
        case 2: bus_.run_until([this] { return dice_() % 8 == 0; }, 10ms); break;
        default: bus_.run_for(Duration{dice_() % 20'000});
      }
      // The time that a handler or a parameter would use.
      const Application& one = *stations_[dice_() % stations_.size()];
      log(bus_.now(), "at " + std::to_string(one.now().since_start().count()));
    }
  }

  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  void log(TimePoint now, const std::string& text) {
    lines_.push_back(std::to_string(now.since_start().count()) + ": " + text);
  }

  void add() {
    const auto node_id = static_cast<std::uint8_t>(stations_.size() + 1);
    switch (stations_.size() % 4) {
      case 0: return add<cpc_tc1::Device>(node_id);
      case 1: return add<cpd::Device>(node_id);
      case 2: return add<can_2053c::Device>(node_id);
      default: return add<rk5c::Device>(node_id);
    }
  }
  template <class Device>
  void add(std::uint8_t node_id) {
    stations_.push_back(std::make_unique<Station<Device>>(bus_, node_id, own_callbacks_));
  }

  /// Values that have an effect at once, at the next SYNC, or after a time.
  void use() {
    Application& node = *stations_[dice_() % stations_.size()];
    const auto any = [this] { return dice_() % static_cast<std::uint32_t>(stations_.size()) + 1; };
    const auto sub_index = static_cast<std::uint8_t>(1 + dice_() % 4);
    const auto pdo = static_cast<std::uint16_t>(dice_() % 4);
    switch (dice_() % 16) {
      case 0: return node.set(0x1017, 0, dice_() % 300, 2);
      case 1: return node.set(0x1016, sub_index, any() << 16 | dice_() % 300, 4);
      case 2: return node.set(static_cast<std::uint16_t>(0x1800 + pdo), 5, dice_() % 400, 2);
      case 3: return node.set(static_cast<std::uint16_t>(0x1800 + pdo), 3, dice_() % 100, 2);
      case 4: return node.set(static_cast<std::uint16_t>(0x1800 + pdo), 2, dice_() % 2 == 0 ? 255 : dice_() % 4, 1);
      case 5: return node.set(static_cast<std::uint16_t>(0x1400 + pdo), 1, 0x180 + 0x80 * (dice_() % 8) + any(), 4);
      case 6: return node.set(0x1005, 0, 0x80 + dice_() % 3, 4);
      case 7: return node.report(static_cast<std::uint16_t>(0x1000 + dice_() % 0x100));
      case 8: return node.end_report();
      case 9: return node.request(canopen::NmtCommand::start, bus_.now());
      case 10: return dice_() % 8 == 0 ? node.restart(bus_.now()) : node.set(0x1015, 0, dice_() % 50, 2);
      case 11: return dice_() % 64 == 0 ? node.change_values() : node.set(0x100C, 0, dice_() % 200, 2);
      case 12: return node.set(0x6200, sub_index, dice_(), 1);
      case 13: return node.set(0x6000, sub_index, dice_(), 1);
      case 14: return node.set(0x6064, 0, dice_(), 4);
      default: return node.set(0x6041, 0, dice_(), 2);
    }
  }

  [[nodiscard]] Frame random_frame() {
    static constexpr std::uint8_t commands[] = {1, 1, 1, 1, 1, 2, 128, 129, 130};
    const auto node_id = static_cast<std::uint8_t>(dice_() % (stations_.size() + 1));
    switch (dice_() % 8) {
      case 0: return {.id = 0, .size = 2, .data = {commands[dice_() % std::size(commands)], node_id}};
      case 1:
      case 2: return {.id = 0x80 + dice_() % 3};
      case 3: return {.id = 0x700u + node_id, .remote = true};
      case 4: return {.id = 0x180 + 0x80 * (dice_() % 8) + node_id, .remote = dice_() % 2 == 0};
      case 5: return {.id = dice_() % 0x800, .size = 8, .data = {static_cast<std::uint8_t>(dice_())}};
      case 6: return {.id = dice_() & 0x1FFF'FFFF, .size = 1, .extended = true};
      default: return {.id = 0x600u + node_id, .size = 8, .data = {0x40, 0x18, 0x10, 0x01}};
    }
  }

  /// A full bus: the queues of the nodes become full.
  void burst() {
    for (int i = 0; i < 30; ++i) tester_.send({.id = 0x001 + dice_() % 4, .size = 8});
  }

  Dice dice_;
  bool own_callbacks_;
  VirtualBus bus_;
  bool has_errors_;
  VirtualBus::Endpoint& tester_ = bus_.attach();
  std::vector<std::unique_ptr<Application>> stations_;
  std::vector<std::string> lines_;
  TimePoint next_use_{5ms};
};

class ConnectedNodes : public testing::TestWithParam<Conditions> {};

TEST_P(ConnectedNodes, SendTheSameFramesAtTheSameTimes) {
  Network own_callbacks{true, GetParam()};
  Network connected{false, GetParam()};
  own_callbacks.run(400);
  connected.run(400);
  ASSERT_GT(own_callbacks.lines().size(), 2'000u);
  const std::size_t common = std::min(own_callbacks.lines().size(), connected.lines().size());
  for (std::size_t i = 0; i < common; ++i) ASSERT_EQ(own_callbacks.lines()[i], connected.lines()[i]) << i;
  EXPECT_EQ(own_callbacks.lines().size(), connected.lines().size());
}

INSTANTIATE_TEST_SUITE_P(Buses, ConnectedNodes,
                         testing::Values(Conditions{125'000, canopen::WireModel::plain, 1},
                                         Conditions{125'000, canopen::WireModel::exact, 2},
                                         Conditions{1'000'000, canopen::WireModel::plain, 3},
                                         Conditions{1'000'000, canopen::WireModel::exact, 4},
                                         Conditions{0, canopen::WireModel::plain, 5},
                                         Conditions{500'000, canopen::WireModel::exact, 6}));

using Drive = bench::NodeOf<cpd::Device, VirtualBus::Endpoint>;

TEST(ConnectedNode, GetsOnlyTheFramesThatItAccepts) {
  VirtualBus bus{1'000'000};
  VirtualBus::Endpoint& tester = bus.attach();
  VirtualBus::Endpoint& endpoint = bus.attach();
  Drive node{endpoint, NodeId{6}};
  EXPECT_TRUE(endpoint.gets_all_frames());
  VirtualBus::connect(endpoint, node);
  EXPECT_FALSE(endpoint.gets_all_frames());
  node.start(bus.now());
  bus.run_for(1ms);
  tester.send(frame("181 01"));
  bus.run_for(1ms);
  EXPECT_FALSE(endpoint.gets_all_frames());
  EXPECT_EQ(node.now(), TimePoint{Duration{1'055}}) << "as if it had ignored the frame";
}

TEST(ConnectedNode, WhoseValuesMayChangeUnseenGetsAllFrames) {
  VirtualBus bus;
  VirtualBus::Endpoint& first = bus.attach();
  VirtualBus::Endpoint& second = bus.attach();
  Drive one{first, NodeId{6}};
  Drive other{second, NodeId{7}};
  VirtualBus::connect(first, one);
  VirtualBus::connect(second, other);
  (void)one.values();
  (void)other.entries();
  EXPECT_TRUE(first.gets_all_frames());
  EXPECT_TRUE(second.gets_all_frames());
  VirtualBus::connect(first, one);
  EXPECT_FALSE(first.gets_all_frames());
}

TEST(ConnectedNode, ThatIsReplacedByACallbackGetsEachFrame) {
  VirtualBus bus;
  VirtualBus::Endpoint& tester = bus.attach();
  VirtualBus::Endpoint& endpoint = bus.attach();
  Drive node{endpoint, NodeId{6}};
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  bus.settle();
  unsigned received = 0;
  bus.listen([&](const Frame&, TimePoint) { endpoint.on_frame = [&](const Frame&, TimePoint) { ++received; }; });
  tester.send(frame("181 01"));
  tester.send(frame("182 01"));
  bus.settle();
  EXPECT_EQ(received, 2u);
}

TEST(ConnectedNode, OfAnotherEndpointIsAskedAfterEachFrame) {
  VirtualBus bus{1'000'000};
  VirtualBus::Endpoint& tester = bus.attach();
  VirtualBus::Endpoint& first = bus.attach();
  VirtualBus::Endpoint& second = bus.attach();
  Drive node{first, NodeId{6}};
  VirtualBus::connect(second, node);
  node.start(bus.now());
  bus.run_for(1ms);
  std::vector<std::string> heartbeats;
  bus.listen([&](const Frame& sent, TimePoint now) {
    if (sent.id == 0x181) (void)node.set(0x1017, 0, std::array<std::uint8_t, 2>{10, 0});
    if (sent.id == 0x706) heartbeats.push_back(std::to_string(now.since_start().count()));
  });
  tester.send(frame("181 01"));
  bus.run_for(12ms);
  EXPECT_EQ(heartbeats, (std::vector<std::string>{"1110", "10110"}));  // a frame takes 55 us
}

TEST(ConnectedNode, WithAMailboxSendsAtOnceWhatAListenerPosts) {
  VirtualBus bus{1'000'000};
  VirtualBus::Endpoint& tester = bus.attach();
  VirtualBus::Endpoint& endpoint = bus.attach();
  canopen::Mailbox<sample::od::statusword> mailbox;
  auto node = bench::make_node<sample::Device>(endpoint, NodeId{5}, canopen::values_from(mailbox));
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  EXPECT_TRUE(endpoint.gets_all_frames());
  tester.send(frame("000 01 05"));
  bus.run_for(1ms);
  std::vector<std::string> sent_at;
  bus.listen([&](const Frame& sent, TimePoint now) {
    if (sent.id == 0x181) mailbox.post<sample::od::statusword>(0x1234);
    if (sent.id == 0x185) sent_at.push_back(std::to_string(now.since_start().count()) + ": " + bench::text(sent));
  });
  tester.send(frame("181 01"));
  bus.run_for(1ms);
  ASSERT_EQ(sent_at.size(), 1u);
  // 55 us for the request, then 44 + 3 bits and 6 bytes
  EXPECT_EQ(sent_at[0], "1150: 185 34 12 00 00 00 00");
}

}  // namespace

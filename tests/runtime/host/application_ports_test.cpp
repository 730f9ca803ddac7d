/// One application on each port: as a class and as lambdas, `start` is called once and a periodic function at its
/// period.
#include <gtest/gtest.h>

#include <canopen/host/host_loop.hpp>
#include <canopen/os/node_task.hpp>
#include <canopen_sim/simulated_node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <deque>
#include <optional>
#include <sample/device.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::Duration;
using canopen::Frame;
using canopen::Milliseconds;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// What the application has done, with times in ms.
struct Record {
  int starts = 0;
  std::vector<std::uint32_t> calls;
};
/// Of the application that runs: a simulated device is default-constructed.
Record* record = nullptr;

void note_call(TimePoint now) { record->calls.push_back(now.since_start().count() / 1000); }

struct Class {
  void start(auto& node) {
    EXPECT_EQ(node.state(), canopen::NmtState::initialisation);
    ++record->starts;
  }
  void every(Milliseconds<10>, auto& node) { note_call(node.now()); }
};

/// The form of an application: its handlers.
struct AsClass {
  using Application = Class;
  static auto handlers() { return std::tuple{Class{}}; }
};
struct AsClassElsewhere {
  using Application = Class;
  static auto handlers() {
    static Class application;
    return std::tuple{canopen::application_at(application)};
  }
};
struct AsLambdas {
  static auto handlers() {
    return std::tuple{canopen::on_start([] { ++record->starts; }),
                      canopen::every<Milliseconds<10>>([](auto& node) { note_call(node.now()); })};
  }
  struct Application {
    auto handlers() { return AsLambdas::handlers(); }
  };
};

template <class Form>
class ApplicationOn : public ::testing::Test {
 protected:
  ApplicationOn() { record = &record_; }
  ~ApplicationOn() override {
    EXPECT_EQ(record_.starts, 1);
    EXPECT_EQ(record_.calls, (std::vector<std::uint32_t>{10, 20, 30, 40, 50, 60, 70, 80, 90, 100}));
  }

 private:
  Record record_;
};
using Forms = ::testing::Types<AsClass, AsClassElsewhere, AsLambdas>;
TYPED_TEST_SUITE(ApplicationOn, Forms);

TYPED_TEST(ApplicationOn, VirtualBus) {
  canopen::VirtualBus bus{1'000'000};
  auto& port = bus.attach();
  auto node = bench::make_node<sample::Device>(port, NodeId{5}, TypeParam::handlers());
  canopen::VirtualBus::connect(port, node);
  node.start(bus.now());
  bus.run_for(100ms);
}

/// Like the loop of a firmware: more often than each period, and not in step with it.
TYPED_TEST(ApplicationOn, LoopThatPolls) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, NodeId{5}, TypeParam::handlers());
  node.start(TimePoint{});
  for (Duration now{0}; now <= 100ms; now += 300us) node.on_time(TimePoint{now});
  node.on_time(TimePoint{100ms});
}

/// Like a loop that sets a timer and sleeps.
TYPED_TEST(ApplicationOn, LoopThatSleeps) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, NodeId{5}, TypeParam::handlers());
  node.start(TimePoint{});
  int wake_ups = 0;
  node.on_time(TimePoint{});
  for (TimePoint now = *node.next_deadline(); now <= TimePoint{100ms}; now = *node.next_deadline(), ++wake_ups) {
    node.on_time(now);
  }
  EXPECT_EQ(wake_ups, 10);
}

/// Time passes in `wait` alone.
struct FakeSystem {
  TimePoint time{};
  [[nodiscard]] TimePoint now() const { return time; }
  void wait(Duration span) { time = time + span; }
  void wake() {}
  static Duration shortest_wait() { return 1ms; }
};
struct SilentPort : bench::RecordingBus {
  std::optional<Frame> receive() { return std::nullopt; }
};

TYPED_TEST(ApplicationOn, NodeTask) {
  SilentPort port;
  FakeSystem system;
  auto node = bench::make_node<sample::Device>(port, NodeId{5}, TypeParam::handlers());
  canopen::NodeTask task{node, port, system};
  node.start(system.now());
  for (int i = 0; i <= 10; ++i) task.run_once();
}

/// A port of a host whose bus has no room, for a long time because it is off.
struct PortWithoutRoom {
  static std::optional<TimePoint> next_deadline() { return std::nullopt; }
  static Duration hold_off() { return 100ms; }
};

TYPED_TEST(ApplicationOn, HostWhoseBusHasNoRoom) {
  bench::RecordingBus bus;
  bus.room = 0;
  auto node = bench::make_node<sample::Device>(bus, NodeId{5}, TypeParam::handlers());
  node.start(TimePoint{});
  EXPECT_EQ(canopen::host_loop::next_deadline(PortWithoutRoom{}, node, TimePoint{}), TimePoint{10ms});
  for (TimePoint now{10ms}; now <= TimePoint{100ms};
       now = *canopen::host_loop::next_deadline(PortWithoutRoom{}, node, now)) {
    node.on_time(now);
  }
}

/// As `edsc` and the conformance test in CMake run it.
struct Bus final : canopen::SimulatedBus {
  bool send(const Frame&) override { return true; }
};

TYPED_TEST(ApplicationOn, SimulatedDevice) {
  Bus bus;
  canopen::SimulatedMemory memory{NodeId{5}};
  const auto node = canopen::make_simulated_node<sample::Device, typename TypeParam::Application>(bus, memory);
  node->start(TimePoint{});
  for (TimePoint now = *node->next_deadline(); now <= TimePoint{100ms}; now = *node->next_deadline()) {
    node->on_time(now);
  }
}

}  // namespace

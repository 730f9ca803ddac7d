#include <gtest/gtest.h>

#include <canopen/os/node_task.hpp>

#include <deque>
#include <optional>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::Duration;
using canopen::Frame;
using canopen::TimePoint;
namespace od = sample::od;
using namespace std::chrono_literals;

/// Time passes in `wait` alone.
struct FakeSystem {
  TimePoint time{};
  std::vector<Duration> waits;

  [[nodiscard]] TimePoint now() const { return time; }
  void wait(Duration span) {
    waits.push_back(span);
    time = time + span;
  }
  void wake() {}
  static Duration shortest_wait() { return 1ms; }
};

struct PolledPort : bench::RecordingBus {
  std::deque<Frame> received;
  std::optional<canopen::BusStatus> status;

  std::optional<Frame> receive() {
    if (received.empty()) return std::nullopt;
    const Frame first = received.front();
    received.pop_front();
    return first;
  }
  std::optional<canopen::BusStatus> status_change() { return std::exchange(status, std::nullopt); }
};

struct Port : PolledPort {
  static constexpr bool has_status_interrupt = true;
};

template <class Port>
struct Task {
  Task() { node.start(system.now()); }
  Port port;
  FakeSystem system;
  bench::NodeOf<sample::Device, Port> node{port, canopen::NodeId{5}};
  canopen::NodeTask<decltype(node), Port, FakeSystem> task{node, port, system};
};

TEST(NodeTask, WaitsUntilTheNextDeadline) {
  Task<Port> it;
  it.port.take();
  ASSERT_EQ(it.node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  it.task.run_once();
  it.task.run_once();
  it.task.run_once();
  EXPECT_EQ(it.system.waits, (std::vector<Duration>{100ms, 100ms, 100ms}));
  EXPECT_EQ(it.port.take(), "705 7F | 705 7F | 705 7F");
}

TEST(NodeTask, WaitsAQuarterOfAnHourWithoutADeadline) {
  Task<Port> it;
  it.task.run_once();
  EXPECT_EQ(it.system.waits, (std::vector<Duration>{15min}));
}

/// 1029h = 0: a communication error ends Operational.
TEST(NodeTask, BusOffEndsOperationalThoughNothingIsDue) {
  Task<Port> it;
  it.port.received = {frame(bench::start)};
  it.task.run_once();
  ASSERT_EQ(it.node.state(), canopen::NmtState::operational);
  it.port.status = canopen::BusStatus{canopen::BusState::off};
  it.task.run_once();  // the interrupt has ended the wait
  EXPECT_EQ(it.node.state(), canopen::NmtState::pre_operational);
}

TEST(NodeTask, LooksAtTheStatusUntilTheControllerIsErrorActive) {
  Task<Port> it;
  it.port.status = canopen::BusStatus{canopen::BusState::off};
  it.task.run_once();
  it.task.run_once();
  it.port.status = canopen::BusStatus{canopen::BusState::active};
  it.task.run_once();
  it.port.take();
  it.task.run_once();
  EXPECT_EQ(it.system.waits, (std::vector<Duration>{100ms, 100ms, 15min, 15min}));
}

TEST(NodeTask, LooksAtTheStatusOfAPortWithoutAnInterruptForIt) {
  Task<PolledPort> it;
  it.task.run_once();
  EXPECT_EQ(it.system.waits, (std::vector<Duration>{100ms}));
}

TEST(NodeTask, ProcessesAllReceivedFramesBeforeItWaits) {
  Task<Port> it;
  it.port.take();
  it.port.received = {frame("605 40 00 10 00 00 00 00 00"), frame("605 40 18 10 00 00 00 00 00")};
  it.task.run_once();
  EXPECT_EQ(it.port.take(), "585 43 00 10 00 91 01 0F 00 | 585 4F 18 10 00 04 00 00 00");
  EXPECT_EQ(it.system.waits.size(), 1u);
}

TEST(NodeTask, LetsOtherTasksRunWhileTheBusHasNoRoom) {
  Task<Port> it;
  it.port.take();
  it.port.room = 0;
  it.port.received = {frame("605 40 00 10 00 00 00 00 00")};
  it.task.run_once();
  it.task.run_once();
  EXPECT_EQ(it.system.waits, (std::vector<Duration>{1ms, 1ms}));
  it.port.room = 1;
  it.task.run_once();
  EXPECT_EQ(it.port.take(), "585 43 00 10 00 91 01 0F 00");
}

struct NodeWithoutWork {
  int statuses = 0;
  void on_frame(const Frame&, TimePoint) {}
  void on_time(TimePoint) {}
  void on_bus_status(const canopen::BusStatus& status, TimePoint) { statuses += status.overrun ? 1 : 0; }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return std::nullopt; }
};

TEST(NodeTask, ReportsEachChangeOfTheController) {
  Port port;
  FakeSystem system;
  NodeWithoutWork node;
  canopen::NodeTask task{node, port, system};
  port.status = canopen::BusStatus{.overrun = true};
  task.run_once();
  task.run_once();
  EXPECT_EQ(node.statuses, 1);
}

}  // namespace

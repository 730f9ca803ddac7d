#include <gtest/gtest.h>

#include <canopen/base/lock.hpp>
#include <canopen/node/accepted_frames.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/port/cortex_m.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::InterruptLock;
using canopen::Locked;
namespace od = sample::od;

/// Records what happens to a lock, and what the node sends meanwhile.
struct RecordingLock {
  std::string& log;
  void lock() { log += "("; }
  void unlock() { log += ")"; }
};

struct LoggingBus {
  std::string& log;
  bool send(const canopen::Frame& frame) {
    log += bench::text(frame);
    return true;
  }
};

TEST(Locked, HoldsTheLockWhileTheNodeWorks) {
  std::string log;
  LoggingBus bus{log};
  RecordingLock lock{log};
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  Locked locked{node, lock};
  locked.start(canopen::TimePoint{});
  EXPECT_EQ(log, "(705 00)");
  log.clear();
  locked.on_frame(bench::frame(bench::start), {});
  log.clear();
  EXPECT_EQ(locked.set<od::statusword>(0x1234), canopen::ok);
  EXPECT_EQ(locked.next_deadline(), canopen::TimePoint{});
  locked.on_time({});
  EXPECT_EQ(log, "()()(185 34 12 00 00 00 00)");
  log.clear();
  EXPECT_EQ(locked.get<od::statusword>(), 0x1234);
  EXPECT_EQ(locked.state(), canopen::NmtState::operational);
  locked.emergency(0x1000, canopen::ErrorRegister::generic);
  EXPECT_EQ(log, "()()()");
  log.clear();
  locked.request(canopen::NmtCommand::reset_communication, {});
  EXPECT_EQ(log, "(705 00)");
  log.clear();
  EXPECT_EQ(locked.with([](auto& device) { return device.node_id(); }), canopen::NodeId{5});
  EXPECT_EQ(log, "()");
}

TEST(Locked, HoldsTheLockWhileAPortReadsItsFrames) {
  std::string log;
  LoggingBus bus{log};
  RecordingLock lock{log};
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  Locked locked{node, lock};
  locked.start(canopen::TimePoint{});
  const auto ids_of = [](auto& some) {
    std::vector<std::uint32_t> ids;
    for_each_accepted_frame(some, [&](const canopen::AcceptedFrame& frame) { ids.push_back(frame.id); });
    return ids;
  };
  log.clear();
  const std::vector<std::uint32_t> ids = ids_of(locked);
  EXPECT_EQ(log, "()");
  EXPECT_EQ(ids, ids_of(node));
  EXPECT_NE(std::ranges::find(ids, 0x605U), ids.end());
}

TEST(Locked, HoldsTheLockWhileTheNodeStartsWithANodeId) {
  std::string log;
  LoggingBus bus{log};
  RecordingLock lock{log};
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{});
  Locked locked{node, lock};
  locked.start(canopen::NodeId{9}, canopen::TimePoint{});
  EXPECT_EQ(log, "(709 00)");
}

TEST(Locked, WithoutALockIsAReference) {
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  Locked plain{node};
  plain.start(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(sizeof plain, sizeof(void*));
}

struct FakeInterrupts {
  static inline std::uint32_t masked = 0;
  static inline std::string log;
  static std::uint32_t disable() {
    log += "d";
    return std::exchange(masked, 1u);
  }
  static void restore(std::uint32_t before) {
    log += before == 0 ? "e" : "-";
    masked = before;
  }
};

TEST(InterruptLock, EnablesInterruptsOnlyWhereTheyWereEnabled) {
  InterruptLock<FakeInterrupts> lock;
  lock.lock();
  EXPECT_EQ(FakeInterrupts::masked, 1u);
  lock.lock();
  lock.unlock();
  EXPECT_EQ(FakeInterrupts::masked, 1u);
  lock.unlock();
  EXPECT_EQ(FakeInterrupts::masked, 0u);
  EXPECT_EQ(FakeInterrupts::log, "dde");
  FakeInterrupts::masked = 1;  // within an interrupt of the same priority, or a critical section
  lock.lock();
  lock.unlock();
  EXPECT_EQ(FakeInterrupts::masked, 1u);
}

}  // namespace

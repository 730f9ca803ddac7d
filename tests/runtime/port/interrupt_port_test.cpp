/// A controller that receives in its interrupt: the loop of the node finds every frame, and hears of those that are
/// lost.
#include <gtest/gtest.h>

#include <canopen/port/interrupt_port.hpp>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::BusState;
using canopen::BusStatus;
using canopen::Frame;

/// A controller with a receive FIFO of three frames, as bxCAN has.
class SmallController {
 public:
  static constexpr std::size_t fifo_size = 3;

  // ---- for the test ----
  void arrive(const std::string& text) {
    if (fifo.size() == fifo_size) return report_.note_overrun();
    fifo.push_back(frame(text));
  }
  std::deque<Frame> fifo;
  std::vector<Frame> sent;
  BusState state = BusState::active;
  bool interrupts = false;
  int acknowledged = 0;

  // ---- the driver ----
  [[nodiscard]] bool start(std::uint32_t, std::uint32_t, canopen::BusMode) { return true; }
  bool stop() { return true; }
  void accept_all() {}
  void accept(std::span<const canopen::AcceptedFrame>) {}
  [[nodiscard]] bool send(const Frame& one) {
    sent.push_back(one);
    return true;
  }
  [[nodiscard]] std::optional<Frame> receive() {
    if (fifo.empty()) return std::nullopt;
    const Frame first = fifo.front();
    fifo.pop_front();
    return first;
  }
  [[nodiscard]] std::optional<BusStatus> status_change() { return report_.change(state); }
  void enable_interrupts() { interrupts = true; }
  void acknowledge_interrupts() { ++acknowledged; }

 private:
  canopen::StatusReport report_;
};

struct InterruptPort : testing::Test {
  [[nodiscard]] std::string received() {
    const std::optional<Frame> got = bus.receive();
    return got ? bench::text(*got) : "nothing";
  }

  SmallController controller;
  canopen::InterruptPort<SmallController, 4> bus{controller};
};

TEST_F(InterruptPort, GivesTheLoopTheFramesInTheirOrder) {
  bus.enable_interrupts();
  EXPECT_TRUE(controller.interrupts);
  EXPECT_TRUE(bus.idle());
  controller.arrive("181 01");
  controller.arrive("181 02");
  EXPECT_EQ(received(), "nothing") << "the interrupt moves them";
  bus.on_interrupt();
  EXPECT_EQ(controller.acknowledged, 1);
  EXPECT_TRUE(controller.fifo.empty());
  EXPECT_FALSE(bus.idle());
  EXPECT_EQ(received(), "181 01");
  EXPECT_EQ(received(), "181 02");
  EXPECT_EQ(received(), "nothing");
  EXPECT_TRUE(bus.idle());
}

TEST_F(InterruptPort, ReportsFramesWithoutRoomInTheQueueOnce) {
  for (const char* const text : {"181 01", "181 02", "181 03", "181 04", "181 05", "181 06"}) {
    controller.arrive(text);
    bus.on_interrupt();
  }
  EXPECT_EQ(bus.status_change(), (BusStatus{BusState::active, true}));
  EXPECT_EQ(bus.status_change(), (BusStatus{BusState::active, false})) << "none was lost since";
  EXPECT_EQ(bus.status_change(), std::nullopt);
  for (const char* const text : {"181 01", "181 02", "181 03", "181 04"}) EXPECT_EQ(received(), text);
  EXPECT_EQ(received(), "nothing");
}

TEST_F(InterruptPort, ReportsFramesThatTheControllerHasLost) {
  for (int i = 0; i < 4; ++i) controller.arrive("181 01");
  controller.state = BusState::passive;
  EXPECT_EQ(bus.status_change(), (BusStatus{BusState::passive, true}));
  EXPECT_EQ(bus.status_change(), (BusStatus{BusState::passive, false}));
  controller.state = BusState::active;
  EXPECT_EQ(bus.status_change(), (BusStatus{BusState::active, false}));
}

TEST_F(InterruptPort, SendsThroughTheController) {
  EXPECT_TRUE(bus.send(frame("705 05")));
  ASSERT_EQ(controller.sent.size(), 1u);
  EXPECT_EQ(bench::text(controller.sent[0]), "705 05");
}

}  // namespace

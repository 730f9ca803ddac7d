/// The steps of docs/porting.md for a new CAN controller: a driver, and a controller in memory that tests it.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <canopen/port/bit_timing.hpp>
#include <canopen/port/can_controller.hpp>
#include <cstddef>
#include <optional>
#include <sample/device.hpp>
#include <span>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

// clang-format off
struct SimpleCanRegisters {
  struct Box { volatile std::uint32_t id, length, low, high; };
  volatile std::uint32_t control;  // 1: INIT, 2: LISTEN
  volatile std::uint32_t status;   // 1: INIT, 2: RECEIVED, 4: SENDING, 8: PASSIVE, 10h: OFF, 20h: LOST
  volatile std::uint32_t timing;
  volatile std::uint32_t command;  // 1: SEND, 2: RELEASE, 4: FORGET LOST
  Box transmit, receive;
};

template <class Registers = SimpleCanRegisters>
class SimpleCan {
 public:
  static constexpr canopen::BitTimingRange range{64, 16, 8, 4};

  explicit constexpr SimpleCan(Registers& registers) : registers_{registers} {}

  [[nodiscard]] bool start(std::uint32_t clock, std::uint32_t bit_rate,
                           canopen::BusMode mode = canopen::BusMode::normal) {
    const auto timing = canopen::bit_timing(clock, bit_rate, range);
    if (!timing || !stop()) return false;
    registers_.timing = (timing->prescaler - 1u) | (timing->before_sample - 1u) << 8 | (timing->after_sample - 1u) << 16 |
                        (timing->resynchronization - 1u) << 24;
    registers_.control = mode == canopen::BusMode::silent ? 2 : 0;
    return canopen::wait_until([this] { return (registers_.status & 1) == 0; });
  }

  bool stop() {
    registers_.control = 1;
    return canopen::wait_until([this] { return (registers_.status & 1) != 0; });
  }

  void accept_all() {}  // this controller has no filters: the node looks at all frames
  void accept(std::span<const canopen::AcceptedFrame>) {}

  [[nodiscard]] bool send(const canopen::Frame& frame) {
    if (registers_.control != 0 || (registers_.status & (1 | 4)) != 0) return false;
    const canopen::FrameWords words = canopen::words_of(frame);
    registers_.transmit.id = frame.id | (frame.extended ? 1u << 31 : 0) | (frame.remote ? 1u << 30 : 0);
    registers_.transmit.length = frame.size;
    registers_.transmit.low = words.first;
    registers_.transmit.high = words.second;
    registers_.command = 1;
    return true;
  }

  [[nodiscard]] std::optional<canopen::Frame> receive() {
    const std::uint32_t status = registers_.status;
    if ((status & 0x20) != 0) {
      report_.note_overrun();
      registers_.command = 4;
    }
    if ((status & 2) == 0) return std::nullopt;
    const std::uint32_t id = registers_.receive.id;
    const canopen::Frame frame = canopen::make_frame(
        id & 0x1FFF'FFFF, canopen::size_of_code(registers_.receive.length),
        {registers_.receive.low, registers_.receive.high}, id >> 31 != 0, (id >> 30 & 1) != 0);
    registers_.command = 2;
    return frame;
  }

  [[nodiscard]] std::optional<canopen::BusStatus> status_change() {
    const std::uint32_t status = registers_.status;
    using canopen::BusState;
    return report_.change((status & 0x10) != 0 ? BusState::off : (status & 8) != 0 ? BusState::passive : BusState::active);
  }

 private:
  Registers& registers_;
  canopen::StatusReport report_;
};
static_assert(canopen::CanController<SimpleCan<>>);
// clang-format on

/// Registers that behave as in the manual: one with side effects is a type with `operator=`, one with a computed value
/// is a type with a conversion operator.
struct FakeSimpleCan {
  struct Box {
    std::uint32_t id = 0, length = 0, low = 0, high = 0;
  };
  struct Status {
    const FakeSimpleCan& can;
    operator std::uint32_t() const {
      return (can.control & 1) | (can.waiting.empty() ? 0u : 2u) | (can.sending ? 4u : 0) | can.errors;
    }
  };
  struct Command {
    FakeSimpleCan& can;
    void operator=(std::uint32_t value) {
      if ((value & 1) != 0) can.sending = true;
      if ((value & 2) != 0) can.waiting.erase(can.waiting.begin());
      if ((value & 4) != 0) can.errors &= ~0x20u;
      if (!can.waiting.empty()) can.receive = can.waiting.front();
    }
  };

  void arrive(const Box& box) {
    waiting.push_back(box);
    receive = waiting.front();
  }
  /// Acknowledges the frame on the wire and returns it.
  std::string take() {
    if (!sending) return "";
    sending = false;
    return bench::text(canopen::make_frame(transmit.id & 0x1FFF'FFFF, static_cast<std::uint8_t>(transmit.length),
                                           {transmit.low, transmit.high}));
  }

  bool sending = false;
  std::uint32_t errors = 0;
  std::vector<Box> waiting;

  std::uint32_t control = 1;
  Status status{*this};
  std::uint32_t timing = 0;
  Command command{*this};
  Box transmit, receive;
};

struct NewController : testing::Test {
  FakeSimpleCan controller;
  SimpleCan<FakeSimpleCan> bus{controller};
};

TEST_F(NewController, GoesOnTheBusAndCarriesANode) {
  auto node = bench::make_node<sample::Device>(bus);
  canopen::TimePoint now{};
  node.start(canopen::NodeId{5}, now);
  EXPECT_EQ(controller.take(), "");  // not on the bus yet: the boot-up message waits
  ASSERT_TRUE(bus.start(16'000'000, 500'000));
  EXPECT_EQ(controller.timing, 0x0101'0C01u);  // 2 + 1 quanta of 1/16 of a bit after 13
  node.on_time(now);
  EXPECT_EQ(controller.take(), "705 00");
  controller.arrive({0x605, 8, 0x0010'0040, 0});
  const std::optional<canopen::Frame> request = bus.receive();
  ASSERT_TRUE(request);
  node.on_frame(*request, now);
  EXPECT_EQ(controller.take().substr(0, 15), "585 43 00 10 00");
  EXPECT_EQ(bus.receive(), std::nullopt);
}

TEST_F(NewController, HasNoRoomWhileItSends) {
  ASSERT_TRUE(bus.start(16'000'000, 500'000));
  EXPECT_TRUE(bus.send(bench::frame("185 37 12")));
  EXPECT_FALSE(bus.send(bench::frame("080")));
  EXPECT_EQ(controller.take(), "185 37 12");
  EXPECT_TRUE(bus.send(bench::frame("080")));
}

TEST_F(NewController, SendsNothingInSilence) {
  ASSERT_TRUE(bus.start(16'000'000, 500'000, canopen::BusMode::silent));
  EXPECT_FALSE(bus.send(bench::frame("080")));
}

TEST_F(NewController, TellsItsState) {
  ASSERT_TRUE(bus.start(16'000'000, 500'000));
  controller.errors = 0x30;
  EXPECT_EQ(bus.receive(), std::nullopt);
  EXPECT_EQ(bus.status_change(), (canopen::BusStatus{.state = canopen::BusState::off, .overrun = true}));
  controller.errors = 0;
  EXPECT_EQ(bus.status_change(), canopen::BusStatus{});
}

}  // namespace

#include <gtest/gtest.h>

#include <canopen/port/bxcan.hpp>
#include <canopen/port/interrupt_port.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace {

using canopen::BusState;
using canopen::Frame;

/// A controller that executes each request immediately.
struct FakeController {
  struct Mailbox {
    std::uint32_t id = 0, length = 0, low = 0, high = 0;
  };
  struct FilterBank {
    std::uint32_t id = 0, mask = 0;
  };
  /// MSR: in initialisation mode if MCR requests it, after the frame on the wire has ended.
  struct Status {
    FakeController& controller;
    operator std::uint32_t() const {
      if (!controller.powered) return 2;
      if (controller.wire_busy > 0 && --controller.wire_busy > 0) return 0;
      return (controller.master_control & 1) | (controller.error_interrupt ? 4u : 0);
    }
    /// 04h clears the error interrupt.
    void operator=(std::uint32_t value) {
      if ((value & 4) != 0) controller.error_interrupt = false;
    }
  };
  /// RF0R: 20h releases a frame, which takes some reads, and 10h clears the overrun.
  struct Fifo {
    FakeController& controller;
    operator std::uint32_t() const {
      const auto frames = static_cast<std::uint32_t>(controller.waiting.size());
      const std::uint32_t shown = frames | (controller.lost ? 0x10u : 0) | (controller.releasing > 0 ? 0x20u : 0);
      if (controller.releasing > 0 && --controller.releasing == 0) controller.release();
      return shown;
    }
    void operator=(std::uint32_t value) {
      if ((value & 0x10) != 0) controller.lost = false;
      if ((value & 0x20) == 0 || controller.waiting.empty() || controller.releasing > 0) return;
      controller.releasing = controller.release_takes;
      if (controller.releasing == 0) controller.release();
    }
  };

  void arrive(Mailbox box) {
    waiting.push_back(box);
    show();
  }
  void show() {
    if (!waiting.empty()) receive[0] = waiting.front();
  }
  void release() {
    waiting.pop_front();
    show();
  }

  /// The error counters reach a state: EPVF, BOFF.
  void enter(std::uint32_t state) {
    const std::uint32_t begun = state & ~error_status;
    error_status = state;
    const std::uint32_t enabled = ((interrupts & 1u << 9) != 0 ? 2u : 0) | ((interrupts & 1u << 10) != 0 ? 4u : 0);
    if ((begun & enabled) != 0) error_interrupt = true;
  }
  /// Whether the line for the status is active: ERRIE.
  [[nodiscard]] bool interrupts_for_status() const { return error_interrupt && (interrupts & 1u << 15) != 0; }

  bool powered = true;
  bool error_interrupt = false;  ///< MSR.ERRI
  bool lost = false;
  int wire_busy = 0;      ///< reads of MSR until the frame on the wire has ended
  int release_takes = 0;  ///< reads of RF0R
  int releasing = 0;      ///< reads until the release is complete
  std::deque<Mailbox> waiting;

  std::uint32_t master_control = 0x0001'0002;  // asleep, as after a reset
  Status master_status{*this};
  std::uint32_t transmit_status = 0x1C00'0000;
  Fifo receive_fifo[1] = {{*this}};
  std::uint32_t interrupts = 0;
  std::uint32_t error_status = 0;
  std::uint32_t bit_timing = 0;
  Mailbox transmit[3];
  Mailbox receive[1];
  std::uint32_t filter_master = 0x2A1C'0E01, filter_list = 0, filter_wide = 0, filter_fifo = 0, filter_active = 0;
  FilterBank filters[28];
};

static_assert(canopen::CanController<canopen::BxCan<>>);

struct BxCan : testing::Test {
  BxCan() { controller.master_control = 0; }  // on the bus

  FakeController controller;
  canopen::BxCan<FakeController> bus{controller};
};

TEST(BitTiming, HasTheSamplePointOfCia301) {
  constexpr canopen::BitTimingRange range = canopen::BxCan<>::range;
  EXPECT_EQ(canopen::bit_timing(42'000'000, 500'000, range), (canopen::BitTiming{6, 11, 2, 2}));  // 85.7 %
  EXPECT_EQ(canopen::bit_timing(36'000'000, 1'000'000, range), (canopen::BitTiming{2, 15, 2, 2}));
  EXPECT_EQ(canopen::bit_timing(8'000'000, 125'000, range), (canopen::BitTiming{4, 13, 2, 2}));  // 87.5 %
  EXPECT_EQ(canopen::bit_timing(8'000'000, 10'000, range), (canopen::BitTiming{50, 13, 2, 2}));
  EXPECT_EQ(canopen::bit_timing(36'000'000, 800'000, range),
            (canopen::BitTiming{3, 12, 2, 2}));  // 86.7 %, 88.9 % with prescaler 5
  EXPECT_EQ(canopen::bit_timing(8'000'000, 300'000, range), std::nullopt);
  EXPECT_EQ(canopen::bit_timing(4'000'000, 1'000'000, range), std::nullopt);  // four quanta
}

TEST_F(BxCan, HasTheRegistersWhereTheManualSays) {
  using Registers = canopen::BxCanRegisters;
  EXPECT_EQ(offsetof(Registers, bit_timing), 0x01Cu);
  EXPECT_EQ(offsetof(Registers, transmit), 0x180u);
  EXPECT_EQ(offsetof(Registers, receive), 0x1B0u);
  EXPECT_EQ(offsetof(Registers, filter_master), 0x200u);
  EXPECT_EQ(offsetof(Registers, filter_wide), 0x20Cu);
  EXPECT_EQ(offsetof(Registers, filter_active), 0x21Cu);
  EXPECT_EQ(offsetof(Registers, filters), 0x240u);
}

TEST_F(BxCan, GoesOnTheBusWithItsBitTiming) {
  controller.master_control = 0x0001'0002;  // asleep, as after a reset
  ASSERT_TRUE(bus.start(8'000'000, 125'000));
  EXPECT_EQ(controller.bit_timing, 0x011C'0003u);  // SJW 2, TS2 2, TS1 13, BRP 4
  EXPECT_EQ(controller.master_control, 0x40u);     // awake, running, recovers from bus-off by itself
  EXPECT_EQ(controller.filter_active, 1u);
  EXPECT_EQ(controller.filters[0].mask, 0u);
  EXPECT_EQ(controller.filter_master & 1, 0u);
}

TEST_F(BxCan, InterruptsForAFrameAndForAFreeMailbox) {
  static_assert(canopen::InterruptingController<canopen::BxCan<>>);
  bus.enable_interrupts();
  EXPECT_EQ(controller.interrupts, 0x8603u);  // IER.FMPIE0, IER.TMEIE, IER.EPVIE, IER.BOFIE, IER.ERRIE
  EXPECT_FALSE(bus.acknowledge_interrupts());
  EXPECT_EQ(controller.transmit_status, 0x0001'0101u);  // TSR.RQCP0 to RQCP2 are cleared by writing 1
  EXPECT_EQ(offsetof(canopen::BxCanRegisters, interrupts), 0x014u);
}

TEST_F(BxCan, InterruptsForErrorPassiveAndForBusOff) {
  canopen::InterruptPort<canopen::BxCan<FakeController>, 4> port{bus};
  static_assert(canopen::has_status_interrupt<decltype(port)>);
  port.enable_interrupts();
  controller.enter(2);
  ASSERT_TRUE(controller.interrupts_for_status());
  port.on_other_interrupt();
  EXPECT_FALSE(controller.interrupts_for_status()) << "acknowledged";
  EXPECT_FALSE(port.idle()) << "the loop must look at the status before it sleeps";
  EXPECT_EQ(port.status_change(), canopen::BusStatus{BusState::passive});
  EXPECT_TRUE(port.idle());
  controller.enter(6);
  ASSERT_TRUE(controller.interrupts_for_status());
  port.on_interrupt();
  EXPECT_FALSE(port.idle());
  EXPECT_EQ(port.status_change(), canopen::BusStatus{BusState::off});
}

TEST_F(BxCan, DoesNotStartWithoutAClock) {
  controller.powered = false;
  EXPECT_FALSE(bus.start(8'000'000, 125'000));
  controller.powered = true;
  EXPECT_FALSE(bus.start(8'000'000, 300'000));
}

TEST_F(BxCan, ChangesTheBitRateWhenTheWireIsFree) {
  ASSERT_TRUE(bus.start(8'000'000, 125'000));
  const canopen::AcceptedFrame frames[] = {{0x000}, {0x7E5}};
  bus.accept(frames);
  ASSERT_TRUE(bus.send({.id = 0x7E4, .size = 8}));
  controller.transmit_status = 0x1800'0000;
  controller.wire_busy = 5;
  EXPECT_TRUE(bus.stop());
  EXPECT_EQ(controller.wire_busy, 0);
  EXPECT_FALSE(bus.send({.id = 0x701, .size = 1}));  // the controller is not on the bus
  EXPECT_EQ(controller.bit_timing, 0x011C'0003u);
  ASSERT_TRUE(bus.start(8'000'000, 250'000));
  EXPECT_EQ(controller.bit_timing, 0x011C'0001u);
  EXPECT_EQ(controller.filter_list, 1u);  // as accepted before
  EXPECT_EQ(controller.filters[0].mask, 0x7E5u << 21);
  EXPECT_EQ(controller.transmit[0].id, 0x7E4u << 21 | 1);  // transmission is still requested
  EXPECT_TRUE(bus.send({.id = 0x701, .size = 1}));
}

TEST_F(BxCan, ListensInSilence) {
  ASSERT_TRUE(bus.start(8'000'000, 125'000, canopen::BusMode::silent));
  EXPECT_EQ(controller.bit_timing, 0x811C'0003u);
  EXPECT_FALSE(bus.send({.id = 0x701, .size = 1}));
  controller.arrive({0x705u << 21, 1, 0x7F, 0});
  EXPECT_EQ(bus.receive(), (Frame{.id = 0x705, .size = 1, .data = {0x7F}}));
  ASSERT_TRUE(bus.start(8'000'000, 125'000));
  EXPECT_TRUE(bus.send({.id = 0x701, .size = 1}));
}

TEST_F(BxCan, SendsFromAFreeMailbox) {
  // 185 37 12
  ASSERT_TRUE(bus.send({.id = 0x185, .size = 2, .data = {0x37, 0x12}}));
  EXPECT_EQ(controller.transmit[0].id, 0x185u << 21 | 1);
  EXPECT_EQ(controller.transmit[0].length, 2u);
  EXPECT_EQ(controller.transmit[0].low, 0x1237u);
  controller.transmit_status = 0x1800'0000;  // mailbox 0 is full
  ASSERT_TRUE(bus.send({.id = 0x1234'5678, .size = 8, .extended = true, .data = {1, 2, 3, 4, 5, 6, 7, 8}}));
  EXPECT_EQ(controller.transmit[1].id, 0x1234'5678u << 3 | 5);
  EXPECT_EQ(controller.transmit[1].high, 0x0807'0605u);
  controller.transmit_status = 0x1000'0000;
  ASSERT_TRUE(bus.send({.id = 0x701, .size = 1, .remote = true}));
  EXPECT_EQ(controller.transmit[2].id, 0x701u << 21 | 3);
  controller.transmit_status = 0;
  EXPECT_FALSE(bus.send({.id = 0x80, .size = 0}));
}

TEST_F(BxCan, KeepsFramesOfTheSameIdentifierInOrder) {
  ASSERT_TRUE(bus.send({.id = 0x585, .size = 8, .data = {0x00}}));
  controller.transmit_status = 0x1800'0000;
  EXPECT_FALSE(bus.send({.id = 0x585, .size = 8, .data = {0x10}}));
  EXPECT_TRUE(bus.send({.id = 0x185, .size = 2}));
  controller.transmit_status = 0x1C00'0000;  // both have been sent
  EXPECT_TRUE(bus.send({.id = 0x585, .size = 8, .data = {0x10}}));
}

TEST_F(BxCan, ReceivesInOrder) {
  EXPECT_EQ(bus.receive(), std::nullopt);
  controller.arrive({0x605u << 21, 0xAB00'0108, 0x0010'0040, 0});  // with a time stamp above the length
  controller.arrive({0x1ABC'DEF0u << 3 | 4, 1, 0x7F, 0});
  controller.arrive({0x705u << 21 | 2, 1, 0, 0});
  EXPECT_EQ(bus.receive(), (Frame{.id = 0x605, .size = 8, .data = {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}}));
  EXPECT_EQ(bus.receive(), (Frame{.id = 0x1ABC'DEF0, .size = 1, .extended = true, .data = {0x7F}}));
  EXPECT_EQ(bus.receive(), (Frame{.id = 0x705, .size = 1, .remote = true}));
  EXPECT_EQ(bus.receive(), std::nullopt);
}

TEST_F(BxCan, GivesAFrameOnceWhileItsReleaseTakesTime) {
  controller.release_takes = 2;
  controller.arrive({0x205u << 21, 1, 0x11, 0});
  controller.arrive({0x205u << 21, 1, 0x22, 0});
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 12; ++i) {
    if (const std::optional<Frame> frame = bus.receive()) bytes.push_back(frame->data[0]);
  }
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x11, 0x22}));
}

TEST_F(BxCan, AcceptsTheFramesOfANodeAlone) {
  const canopen::AcceptedFrame frames[] = {{0x000}, {0x605}, {.id = 0x185, .remote = true}};
  bus.accept(frames);
  EXPECT_EQ(controller.filter_active, 3u);
  EXPECT_EQ(controller.filter_list, 3u);
  EXPECT_EQ(controller.filter_wide, 3u);
  EXPECT_EQ(controller.filters[0].id, 0u);
  EXPECT_EQ(controller.filters[0].mask, 0x605u << 21);
  EXPECT_EQ(controller.filters[1].id, 0x185u << 21 | 2);
  EXPECT_EQ(controller.filters[1].mask, 0x185u << 21 | 2);
}

TEST_F(BxCan, AcceptsAllWhereTheFiltersDoNotSuffice) {
  const std::vector<canopen::AcceptedFrame> frames(29);
  bus.accept(frames);
  EXPECT_EQ(controller.filter_active, 1u);
  EXPECT_EQ(controller.filter_list, 0u);
  EXPECT_EQ(controller.filters[0].mask, 0u);
}

TEST_F(BxCan, TellsItsErrorStateOnce) {
  EXPECT_EQ(bus.status_change(), std::nullopt);
  controller.error_status = 0x0088'0003;  // warning, passive
  EXPECT_EQ(bus.status_change(), (canopen::BusStatus{.state = BusState::passive}));
  EXPECT_EQ(bus.status_change(), std::nullopt);
  controller.error_status = 0x00F8'0007;
  EXPECT_EQ(bus.status_change(), (canopen::BusStatus{.state = BusState::off}));
  controller.error_status = 0;
  EXPECT_EQ(bus.status_change(), canopen::BusStatus{});
}

TEST_F(BxCan, TellsThatFramesAreLost) {
  controller.lost = true;
  EXPECT_EQ(bus.receive(), std::nullopt);
  EXPECT_EQ(bus.status_change(), (canopen::BusStatus{.overrun = true}));
  EXPECT_EQ(bus.status_change(), canopen::BusStatus{});
  EXPECT_FALSE(controller.lost);
}

}  // namespace

/// The driver of FDCAN in the STM32G4 and STM32H7: start, frames, filters, bus states and LSS.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <canopen/node/accepted_frames.hpp>
#include <canopen/port/fdcan.hpp>
#include <canopen/port/interrupt_port.hpp>
#include <cstddef>
#include <optional>
#include <sample/device.hpp>
#include <string>
#include <vector>

#include "fake_m_can.hpp"
#include "fdcan_bench.hpp"
#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::BusState;
using canopen::BusStatus;
using fdcan_bench::chip;
using fdcan_bench::Fdcan;

static_assert(canopen::CanController<canopen::FdcanG4> && canopen::CanController<canopen::FdcanH7>);

struct ChipNames {
  template <class Kind>
  static std::string GetName(int) {
    return chip<Kind> == fake::Chip::g4 ? "G4" : "H7";
  }
};
using Chips = testing::Types<canopen::FdcanOfG4, canopen::FdcanOfH7>;
TYPED_TEST_SUITE(Fdcan, Chips, ChipNames);

TYPED_TEST(Fdcan, InterruptsForAFrameAndForAFreeBuffer) {
  static_assert(canopen::InterruptingController<typename TestFixture::Bus>);
  this->go_on_the_bus();
  EXPECT_FALSE(this->controller.interrupts());
  this->bus.enable_interrupts();
  EXPECT_TRUE(this->controller.interrupts());
  this->go_on_the_bus();
  EXPECT_TRUE(this->controller.interrupts()) << "also after a change of the bit rate";
  EXPECT_FALSE(this->bus.acknowledge_interrupts());
  // IR.RF0N, IR.TC, IR.EP, IR.BO
  EXPECT_EQ(this->controller.acknowledged(), chip<TypeParam> == fake::Chip::g4 ? 0x000A'0081u : 0x0280'0201u);
}

TYPED_TEST(Fdcan, InterruptsForErrorPassiveAndForBusOff) {
  canopen::InterruptPort<typename TestFixture::Bus, 4> port{this->bus};
  this->go_on_the_bus();
  port.enable_interrupts();
  EXPECT_FALSE(this->controller.interrupts_for_status());
  this->controller.error_state(true, true);
  ASSERT_TRUE(this->controller.interrupts_for_status());
  port.on_interrupt();
  EXPECT_FALSE(this->controller.interrupts_for_status()) << "acknowledged";
  EXPECT_FALSE(port.idle()) << "the loop must look at the status before it sleeps";
  EXPECT_EQ(port.status_change(), canopen::BusStatus{canopen::BusState::passive});
  EXPECT_TRUE(port.idle());
  this->controller.go_bus_off();
  ASSERT_TRUE(this->controller.interrupts_for_status());
  port.on_other_interrupt();
  EXPECT_EQ(port.status_change(), canopen::BusStatus{canopen::BusState::off}) << "and the recovery begins";
  while ((this->controller.common.cccr & 1) != 0) {
  }
  ASSERT_TRUE(this->controller.pass_recovery());
  EXPECT_TRUE(this->controller.interrupts_for_status()) << "it is on the bus again";
}

TYPED_TEST(Fdcan, GoesOnTheBusWithItsBitTiming) {
  ASSERT_TRUE(this->bus.start(80'000'000, 500'000));
  EXPECT_TRUE(this->controller.on_the_bus());
  EXPECT_TRUE(this->controller.classic());
  EXPECT_EQ(this->controller.nominal_bit_timing(), 19u << 25 | 0u << 16 | 138u << 8 | 19u);
}

TYPED_TEST(Fdcan, DoesNotStartWithoutAClock) {
  this->controller.powered = false;
  EXPECT_FALSE(this->bus.start(80'000'000, 500'000));
  EXPECT_FALSE(this->send("705 00"));
}

TYPED_TEST(Fdcan, StaysOnTheBusWhenTheClockDoesNotGiveABitRate) {
  this->go_on_the_bus();
  EXPECT_FALSE(this->bus.start(80'000'000, 300'000));
  EXPECT_TRUE(this->send("705 00"));
  EXPECT_EQ(this->sent(), "705 00");
}

TYPED_TEST(Fdcan, SendsEveryKindOfFrame) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("185 37 12"));
  EXPECT_TRUE(this->send("12345678 01 02 03 04 05 06 07 08"));
  EXPECT_EQ(this->sent(), "185 37 12 | 12345678 01 02 03 04 05 06 07 08");
  EXPECT_TRUE(this->send("701 R 1"));
  EXPECT_TRUE(this->send("080"));
  EXPECT_EQ(this->sent(), "080 | 701 R 1");
}

TYPED_TEST(Fdcan, SendsTheLowestIdentifierFirst) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("705 7F"));
  EXPECT_TRUE(this->send("585 60"));
  EXPECT_TRUE(this->send("085 00"));
  EXPECT_EQ(this->sent(), "085 00 | 585 60 | 705 7F");
}

TYPED_TEST(Fdcan, HasNoRoomInAFullQueue) {
  this->go_on_the_bus();
  constexpr std::uint32_t room = TestFixture::Bus::layout.transmitted;
  for (std::uint32_t i = 0; i < room; ++i) EXPECT_TRUE(this->bus.send({.id = 0x200 + i, .size = 0}));
  EXPECT_FALSE(this->send("080"));
  EXPECT_TRUE(this->controller.begin_frame());
  EXPECT_FALSE(this->send("080"));
  this->controller.end_frame(false);  // not acknowledged
  EXPECT_FALSE(this->send("080"));
  EXPECT_TRUE(this->controller.begin_frame());
  this->controller.end_frame();
  EXPECT_TRUE(this->send("080"));
  (void)this->sent();
  EXPECT_EQ(this->controller.requests(), 0u);
}

TYPED_TEST(Fdcan, KeepsFramesOfTheSameIdentifierInOrder) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("585 00"));
  EXPECT_FALSE(this->send("585 10"));
  EXPECT_TRUE(this->send("185 37"));
  EXPECT_TRUE(this->send("185 R 1"));  // a different frame
  EXPECT_EQ(this->sent(), "185 37 | 185 R 1 | 585 00");
  EXPECT_TRUE(this->send("585 10"));
  EXPECT_EQ(this->sent(), "585 10");
}

TYPED_TEST(Fdcan, ReceivesInOrder) {
  this->go_on_the_bus();
  EXPECT_EQ(this->received(), "nothing");
  this->arrive("605 40 00 10 00 00 00 00 00");
  this->arrive("1ABCDEF0 7F");
  this->arrive("705 R 1");
  EXPECT_EQ(this->received(), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(this->received(), "1ABCDEF0 7F");
  EXPECT_EQ(this->received(), "705 R 1");
  EXPECT_EQ(this->received(), "nothing");
}

TYPED_TEST(Fdcan, GoesRoundItsFifo) {
  this->go_on_the_bus();
  for (std::uint32_t i = 0; i < 200; ++i) {
    this->arrive(bench::text({.id = i, .size = 1, .data = {static_cast<std::uint8_t>(i)}}));
    this->arrive("605 40");
    EXPECT_EQ(this->received(), bench::text({.id = i, .size = 1, .data = {static_cast<std::uint8_t>(i)}}));
    EXPECT_EQ(this->received(), "605 40");
  }
}

TYPED_TEST(Fdcan, TakesAnyLengthCodeAboveEightForEight) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->controller.arrive({.id = 0x205, .size = 15, .data = {1, 2, 3, 4, 5, 6, 7, 8}}));
  EXPECT_EQ(this->received(), "205 01 02 03 04 05 06 07 08");
}

TYPED_TEST(Fdcan, TellsThatFramesAreLost) {
  this->go_on_the_bus();
  constexpr std::uint32_t room = TestFixture::Bus::layout.received;
  for (std::uint32_t i = 0; i < room; ++i) EXPECT_TRUE(this->controller.arrive({.id = i, .size = 0}));
  EXPECT_EQ(this->bus.status_change(), std::nullopt);
  EXPECT_FALSE(this->controller.arrive(frame("205 11")));  // the FIFO is full: the frame is lost
  EXPECT_EQ(this->received(), "000");
  EXPECT_EQ(this->bus.status_change(), (BusStatus{.overrun = true}));
  for (std::uint32_t i = 1; i < room; ++i) EXPECT_EQ(this->received(), bench::text({.id = i, .size = 0}));
  EXPECT_EQ(this->received(), "nothing");
  EXPECT_EQ(this->bus.status_change(), BusStatus{});
  this->arrive("205 22");
  EXPECT_EQ(this->received(), "205 22");
  EXPECT_EQ(this->bus.status_change(), std::nullopt);
}

TYPED_TEST(Fdcan, AcceptsTheFramesOfANodeAlone) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->accepts("606 40"));  // all, until filters are set
  EXPECT_TRUE(this->accepts("00012345 01"));
  const canopen::AcceptedFrame frames[] = {{0x000}, {0x605}, {.id = 0x185, .remote = true}};
  this->bus.accept(frames);
  EXPECT_TRUE(this->accepts("000 01 05"));
  EXPECT_TRUE(this->accepts("605 40"));
  EXPECT_TRUE(this->accepts("185 R 8"));
  for (const char* other : {"001", "604", "606 40", "705 00", "7FF", "00000605 01", "1FFFFFFF"}) {
    EXPECT_FALSE(this->accepts(other)) << other;
  }
  this->bus.accept_all();
  EXPECT_TRUE(this->accepts("606 40"));
  EXPECT_TRUE(this->accepts("1FFFFFFF"));
}

TYPED_TEST(Fdcan, AcceptsFramesWith29BitsWhereTheNodeHasThem) {
  this->go_on_the_bus();
  const canopen::AcceptedFrame frames[] = {{0x605},
                                           {.id = 0x605, .extended = true},
                                           {0x000},
                                           {.id = 0x1234'5678, .extended = true},
                                           {.id = 7, .extended = true}};
  this->bus.accept(frames);
  for (const char* one : {"605 40", "00000605 01", "000 01 05", "12345678", "00000007"}) {
    EXPECT_TRUE(this->accepts(one)) << one;
  }
  for (const char* other : {"007", "00000000", "12345679", "1FFFFFFF", "678"})
    EXPECT_FALSE(this->accepts(other)) << other;
}

TYPED_TEST(Fdcan, AcceptsAsManyAsTheFiltersHold) {
  this->go_on_the_bus();
  std::vector<canopen::AcceptedFrame> frames;
  for (std::uint32_t i = 0; i < TestFixture::Bus::max_standard; ++i) frames.push_back({.id = 2 * i});
  for (std::uint32_t i = 0; i < TestFixture::Bus::max_extended; ++i) frames.push_back({.id = 3 * i, .extended = true});
  this->bus.accept(frames);
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    EXPECT_EQ(this->accepts(bench::text({.id = id, .size = 0})),
              id % 2 == 0 && id < 2 * TestFixture::Bus::max_standard);
    EXPECT_EQ(this->accepts(bench::text({.id = id, .size = 0, .extended = true})),
              id % 3 == 0 && id < 3 * TestFixture::Bus::max_extended);
  }
}

TYPED_TEST(Fdcan, AcceptsAllWhereTheFiltersDoNotSuffice) {
  this->go_on_the_bus();
  for (const bool extended : {false, true}) {
    const std::size_t most = extended ? TestFixture::Bus::max_extended : TestFixture::Bus::max_standard;
    this->bus.accept(std::vector<canopen::AcceptedFrame>(most + 1, {.id = 1, .extended = extended}));
    EXPECT_TRUE(this->accepts("7FF"));
    EXPECT_TRUE(this->accepts("1FFFFFFF"));
  }
  this->bus.accept({});
  EXPECT_TRUE(this->accepts("7FF"));
}

TYPED_TEST(Fdcan, TellsItsErrorStateOnce) {
  this->go_on_the_bus();
  EXPECT_EQ(this->bus.status_change(), std::nullopt);
  this->controller.error_state(true, false);  // error warning: still active
  EXPECT_EQ(this->bus.status_change(), std::nullopt);
  this->controller.error_state(true, true);
  EXPECT_EQ(this->bus.status_change(), (BusStatus{.state = BusState::passive}));
  EXPECT_EQ(this->bus.status_change(), std::nullopt);
  this->controller.error_state(false, false);
  EXPECT_EQ(this->bus.status_change(), BusStatus{});
}

TYPED_TEST(Fdcan, RecoversFromBusOffAndSendsWhatWaited) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("185 37"));
  EXPECT_TRUE(this->controller.begin_frame());
  this->controller.go_bus_off();
  EXPECT_FALSE(this->send("285 11"));
  EXPECT_FALSE(this->controller.pass_recovery());  // the controller waits for the software
  EXPECT_EQ(this->bus.status_change(), (BusStatus{.state = BusState::off}));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(this->bus.status_change(), std::nullopt);
  EXPECT_EQ(this->sent(), "");
  EXPECT_TRUE(this->controller.pass_recovery());
  EXPECT_EQ(this->bus.status_change(), BusStatus{});
  EXPECT_EQ(this->sent(), "185 37");
  EXPECT_TRUE(this->send("285 11"));
}

TYPED_TEST(Fdcan, StaysOffTheBusWhenItHasBeenStopped) {
  this->go_on_the_bus();
  this->controller.go_bus_off();
  EXPECT_TRUE(this->bus.stop());
  for (int i = 0; i < 9; ++i) (void)this->bus.status_change();
  EXPECT_FALSE(this->controller.on_the_bus());
  EXPECT_FALSE(this->controller.pass_recovery());
  ASSERT_TRUE(this->bus.start(80'000'000, 500'000));
  EXPECT_TRUE(this->controller.pass_recovery());
  EXPECT_TRUE(this->controller.on_the_bus());
}

TYPED_TEST(Fdcan, ChangesTheBitRateWithoutHarmToTheFrameOnTheWire) {
  this->go_on_the_bus();
  const canopen::AcceptedFrame frames[] = {{0x7E5}};
  this->bus.accept(frames);
  EXPECT_TRUE(this->send("7E4 13"));
  EXPECT_TRUE(this->controller.begin_frame());
  EXPECT_TRUE(this->send("705 7F"));
  EXPECT_TRUE(this->send("185 37"));
  EXPECT_TRUE(this->bus.stop());
  EXPECT_EQ(this->sent(), "7E4 13");  // it was on the wire; the others wait
  EXPECT_FALSE(this->send("085 00"));
  EXPECT_EQ(this->controller.nominal_bit_timing() >> 16 & 0x1FF, 0u);
  ASSERT_TRUE(this->bus.start(80'000'000, 125'000));
  EXPECT_EQ(this->controller.nominal_bit_timing() >> 16 & 0x1FF, 3u);
  EXPECT_EQ(this->sent(), "185 37 | 705 7F");
  EXPECT_TRUE(this->accepts("7E5 04 01"));  // as accepted before
  EXPECT_FALSE(this->accepts("605 40"));
  EXPECT_TRUE(this->send("085 00"));
  EXPECT_EQ(this->sent(), "085 00");
}

TYPED_TEST(Fdcan, ChangesTheBitRateWhileNobodyAcknowledges) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("705 00"));
  EXPECT_TRUE(this->controller.begin_frame());
  this->controller.end_frame(false);
  ASSERT_TRUE(this->bus.start(80'000'000, 250'000));
  EXPECT_EQ(this->sent(), "705 00");
}

TYPED_TEST(Fdcan, ListensInSilence) {
  this->go_on_the_bus();
  EXPECT_TRUE(this->send("705 00"));
  ASSERT_TRUE(this->bus.start(80'000'000, 250'000, canopen::BusMode::silent));
  EXPECT_FALSE(this->send("185 37"));
  EXPECT_EQ(this->sent(), "");
  EXPECT_TRUE(this->accepts("605 40"));
  ASSERT_TRUE(this->bus.start(80'000'000, 250'000));
  EXPECT_EQ(this->sent(), "705 00");
  EXPECT_TRUE(this->send("185 37"));
}

TYPED_TEST(Fdcan, HasItsOwnPartOfTheMessageRam) {
  fake::MCan second_controller{chip<TypeParam>, 1};
  constexpr std::uint16_t size = TestFixture::Bus::layout.size;
  typename TestFixture::Bus second{second_controller, second_controller.ram, size};
  ASSERT_TRUE(second.start(80'000'000, 500'000));
  const canopen::AcceptedFrame frames[] = {{0x605}, {.id = 5, .extended = true}};
  second.accept(frames);
  for (std::uint32_t i = 0; i < 9; ++i) {
    EXPECT_TRUE(second_controller.arrive(frame("605 40")));
    EXPECT_TRUE(second.receive());
    EXPECT_TRUE(second.send(frame("585 60")));
    second_controller.send_all();
  }
  EXPECT_EQ(second_controller.sent.size(), 9u);
  for (std::uint32_t i = 0; i < fake::MCan::ram_words; ++i) {
    const bool its_own = i >= size && i < 2 * size;
    ASSERT_TRUE(its_own || second_controller.ram[i] == 0xDEAD'BEEF) << i;
  }
}

/// A complete node that uses the controller.
TYPED_TEST(Fdcan, CarriesANode) {
  this->go_on_the_bus();
  auto node = bench::make_node<sample::Device>(this->bus);
  canopen::TimePoint now{};
  node.start(canopen::NodeId{5}, now);
  EXPECT_EQ(this->sent(), "705 00");
  std::vector<canopen::AcceptedFrame> frames;
  canopen::for_each_accepted_frame(node, [&](const canopen::AcceptedFrame& one) { frames.push_back(one); });
  this->bus.accept(frames);
  EXPECT_FALSE(this->controller.arrive(frame("606 40 00 10 00 00 00 00 00")));
  this->arrive("605 40 00 10 00 00 00 00 00");
  if (const std::optional<canopen::Frame> request = this->bus.receive()) node.on_frame(*request, now);
  const std::string answer = this->sent();
  EXPECT_EQ(answer.substr(0, 15), "585 43 00 10 00") << answer;
}

/// LSS with the controller's bit rate.
template <class Bus>
struct LssOnCan {
  Bus& bus;

  [[nodiscard]] canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError store(canopen::NodeId, canopen::LssBitTiming) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssBitTiming bit_timing() const { return {0, 2}; }
  void stop_communication() { EXPECT_TRUE(bus.stop()); }
  void start_communication(canopen::LssBitTiming timing) {
    EXPECT_TRUE(bus.start(80'000'000, canopen::lss::bit_rates[timing.index] * 1000u));
  }
};

TYPED_TEST(Fdcan, HasItsBitRateChangedByLss) {
  this->go_on_the_bus();
  LssOnCan<typename TestFixture::Bus> port{this->bus};
  auto node = bench::make_node<sample::Device>(this->bus, canopen::configured_by_lss(port));
  canopen::TimePoint now{};
  node.start(canopen::NodeId{5}, now);
  EXPECT_EQ(this->sent(), "705 00");
  const auto ask = [&](const std::string& text) {
    this->arrive(text);
    if (const std::optional<canopen::Frame> request = this->bus.receive()) node.on_frame(*request, now);
    return this->sent();
  };
  const auto pass = [&](canopen::Duration span) {
    now = now + span;
    node.on_time(now);
  };
  EXPECT_EQ(ask("7E5 04 01 00 00 00 00 00 00"), "");
  EXPECT_EQ(ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");  // 125 kbit/s
  EXPECT_EQ(ask("7E5 15 0A 00 00 00 00 00 00"), "");                             // in 10 ms, then 10 ms of silence
  pass(std::chrono::milliseconds{10});
  EXPECT_FALSE(this->controller.on_the_bus());
  pass(std::chrono::milliseconds{10});
  EXPECT_TRUE(this->controller.on_the_bus());
  EXPECT_EQ(this->controller.nominal_bit_timing() >> 16 & 0x1FF, 3u);
  EXPECT_EQ(ask("7E5 5E 00 00 00 00 00 00 00"), "7E4 5E 05 00 00 00 00 00 00");
}

}  // namespace

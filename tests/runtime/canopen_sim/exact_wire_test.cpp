/// A VirtualBus with stuff bits, transmission by priority and errors. Times are counted by hand, at 1 Mbit/s: a frame
/// with CAN-ID 0 and without data has 47 bits and 6 stuff bits.
#include <gtest/gtest.h>
#include <canopen/can/frame_length.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::Duration;
using canopen::Frame;
using canopen::VirtualBus;
using canopen::WireModel;

constexpr std::uint32_t bit_rate = 1'000'000;

/// `ID queued..started..ended` of each frame, with `!` if it was destroyed.
std::vector<std::string> observed(VirtualBus& bus, Duration span) {
  std::vector<std::string> lines;
  bus.observe([&lines](const VirtualBus::Transmission& one) {
    lines.push_back(std::to_string(one.frame.id) + " " + std::to_string(one.queued) + ".." +
                    std::to_string(one.started) + ".." + std::to_string(one.ended) + (one.is_destroyed ? "!" : ""));
  });
  bus.run_for(span);
  bus.observe({});
  return lines;
}

using Lines = std::vector<std::string>;

TEST(ExactWire, AFrameTakesItsStuffBits) {
  VirtualBus plain{bit_rate};
  plain.attach().send({});
  EXPECT_EQ(observed(plain, Duration{1000}), (Lines{"0 0..0..47"}));
  VirtualBus exact{bit_rate, WireModel::exact};
  exact.attach().send({});
  EXPECT_EQ(observed(exact, Duration{1000}), (Lines{"0 0..0..53"}));
}

TEST(ExactWire, AnEndpointSendsItsMostDominantFrameFirst) {
  VirtualBus bus{bit_rate, WireModel::exact};
  auto& endpoint = bus.attach();
  for (const char* const text : {"701 05", "181 01", "081 00", "181 02"}) endpoint.send(frame(text));
  EXPECT_EQ(endpoint.waiting(), 4U);
  std::vector<std::string> sent;
  bus.listen([&](const Frame& one, canopen::TimePoint) { sent.push_back(bench::text(one)); });
  bus.run_for(Duration{1000});
  EXPECT_EQ(sent, (Lines{"081 00", "181 01", "181 02", "701 05"}));
}

TEST(ExactWire, AFrameOnTheWireIsNotPreempted) {
  VirtualBus bus{bit_rate, WireModel::exact};
  auto& low = bus.attach();
  auto& high = bus.attach();
  low.send(frame("7FF"));
  bus.run_for(Duration{10});
  high.send(frame("000"));
  const Lines lines = observed(bus, Duration{1000});
  ASSERT_EQ(lines.size(), 2U);
  const std::uint32_t end = canopen::stuffed_bits_on_wire(frame("7FF"));
  EXPECT_EQ(lines[0], "2047 0..0.." + std::to_string(end));
  EXPECT_EQ(lines[1], "0 10.." + std::to_string(end) + ".." + std::to_string(end + 53));
}

TEST(ExactWire, AnErrorDestroysTheFrameWhichIsSentAgain) {
  VirtualBus bus{bit_rate, WireModel::exact};
  int received = 0;
  bus.attach().on_frame = [&received](const Frame&, canopen::TimePoint) { ++received; };
  auto& sender = bus.attach();
  bus.make_errors(Duration{100});
  sender.send({});
  sender.send({});
  // The error at 100 us destroys the second frame 47 bits after its start; 31 bits later it begins again.
  EXPECT_EQ(observed(bus, Duration{199}), (Lines{"0 0..0..53", "0 0..53..131!", "0 0..131..184"}));
  EXPECT_EQ(received, 2);
}

TEST(ExactWire, AfterAnErrorAMoreDominantFrameGoesFirst) {
  VirtualBus bus{bit_rate, WireModel::exact};
  auto& sender = bus.attach();
  bus.make_errors(Duration{20});
  sender.send(frame("7FF"));
  bus.run_for(Duration{10});
  sender.send({});
  bus.run_for(Duration{11});
  bus.make_errors(Duration{0});
  EXPECT_EQ(observed(bus, Duration{1000}).at(1), "0 10..51..104");
}

TEST(ExactWire, AnErrorOnAnIdleBusHasNoEffect) {
  VirtualBus bus{bit_rate, WireModel::exact};
  auto& sender = bus.attach();
  bus.make_errors(Duration{100});
  bus.run_for(Duration{120});
  sender.send({});
  EXPECT_EQ(observed(bus, Duration{75}), (Lines{"0 120..120..173"}));
}

}  // namespace

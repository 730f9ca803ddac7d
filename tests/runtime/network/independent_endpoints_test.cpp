/// A VirtualBus whose endpoints are declared independent carries the same frames at the same times as one whose
/// endpoints all receive each frame.
#include <gtest/gtest.h>

#include <can_2053c/device.hpp>
#include <canopen/node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include <deque>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::AcceptedFrame;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using namespace std::chrono_literals;

struct Random {
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine()); }
  std::mt19937 engine;
};

template <class Device>
struct Station {
  Station(VirtualBus& bus, std::uint8_t node_id) : endpoint{bus.attach()}, node{endpoint, NodeId{node_id}} {
    VirtualBus::connect(endpoint, node);
    endpoint.on_frame = [this](const Frame& got, TimePoint now) {
      ++received;
      node.on_frame(got, now);
    };
    node.start(bus.now());
  }
  VirtualBus::Endpoint& endpoint;
  bench::NodeOf<Device, VirtualBus::Endpoint> node;
  unsigned received = 0;
};

struct Network {
  explicit Network(bool independent) {
    if (independent) bus.assume_independent_endpoints();
    for (std::uint8_t id = 1; id < 6; ++id) producers.emplace_back(bus, id);
    for (std::uint8_t id = 6; id < 11; ++id) drives.emplace_back(bus, id);
    for (std::uint8_t id = 11; id < 16; ++id) modules.emplace_back(bus, id);
    for (std::uint8_t id = 16; id < 21; ++id) sensors.emplace_back(bus, id);
    bus.listen([this](const Frame& sent, TimePoint now) {
      lines.push_back(std::to_string(now.since_start().count()) + ": " + bench::text(sent));
    });
  }

  VirtualBus bus{500'000};
  VirtualBus::Endpoint& tester = bus.attach();
  std::deque<Station<cpc_tc1::Device>> producers;
  std::deque<Station<cpd::Device>> drives;
  std::deque<Station<can_2053c::Device>> modules;
  std::deque<Station<rk5c::Device>> sensors;
  std::vector<std::string> lines;
};

/// An SDO download of a parameter that selects received frames, or starts transmitted ones.
Frame random_download(Random& random) {
  const std::uint32_t node_id = 1 + random() % 20;
  const std::uint32_t pdo = random() % 4;
  const std::uint32_t pdo_id = 0x180 + 0x80 * (random() % 8) + 1 + random() % 20;
  const std::uint32_t sometimes_invalid = random() % 2 == 0 ? 0x8000'0000 : 0;
  struct Write {
    std::uint32_t index;
    std::uint32_t sub_index;
    std::uint32_t size;
    std::uint32_t value;
  };
  const Write writes[] = {
      {0x1400 + pdo, 1, 4, pdo_id | sometimes_invalid},
      {0x1800 + pdo, 1, 4, pdo_id | sometimes_invalid},
      {0x1800 + pdo, 1, 4, 0xC000'0000 | pdo_id},
      {0x1800 + pdo, 2, 1, random() % 2 == 0 ? 255u : 1 + random() % 3},
      {0x1800 + pdo, 5, 2, random() % 500},
      {0x1005, 0, 4, 0x80 + random() % 3},
      {0x1014, 0, 4, 0x80 + node_id},
      {0x1016, 1 + random() % 4, 4, (1 + random() % 20) << 16 | random() % 300},
      {0x1017, 0, 2, random() % 200},
      {0x100C, 0, 2, random() % 200},
      {0x100D, 0, 1, random() % 4},
  };
  const Write& write = writes[random() % std::size(writes)];
  Frame request{.id = 0x600 + node_id, .size = 8};
  request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - write.size) << 2);
  request.data[1] = static_cast<std::uint8_t>(write.index);
  request.data[2] = static_cast<std::uint8_t>(write.index >> 8);
  request.data[3] = static_cast<std::uint8_t>(write.sub_index);
  for (unsigned i = 0; i < 4; ++i) request.data[4 + i] = static_cast<std::uint8_t>(write.value >> (8 * i));
  return request;
}

Frame random_frame(Random& random) {
  static constexpr std::uint8_t commands[] = {1, 1, 1, 1, 2, 128, 129, 130};
  const auto node_id = static_cast<std::uint8_t>(random() % 21);
  switch (random() % 8) {
    case 0: return {.id = 0, .size = 2, .data = {commands[random() % std::size(commands)], node_id}};
    case 1: return {.id = 0x80 + random() % 3};
    case 2: return {.id = 0x700u + node_id, .remote = true};
    case 3: return {.id = 0x180 + 0x80 * (random() % 8) + node_id, .remote = true};
    case 4: return {.id = random() % 0x800, .size = 8, .data = {static_cast<std::uint8_t>(random())}};
    case 5: return {.id = random(), .size = 1, .extended = true};
    default: return random_download(random);
  }
}

TEST(IndependentEndpoints, SendTheSameFramesAtTheSameTimes) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    Network all{false};
    Network independent{true};
    for (Network* network : {&all, &independent}) {
      Random random{std::mt19937{seed}};
      for (int i = 0; i < 600; ++i) {
        network->tester.send(random_frame(random));
        network->bus.run_for(canopen::Duration{random() % 30'000});
      }
    }
    ASSERT_GT(all.lines.size(), 1000u);
    ASSERT_EQ(all.lines.size(), independent.lines.size()) << seed;
    for (std::size_t i = 0; i < all.lines.size(); ++i) ASSERT_EQ(all.lines[i], independent.lines[i]) << seed;
  }
}

TEST(IndependentEndpoints, ReceiveOnlyTheFramesThatTheyAccept) {
  Network network{true};
  network.bus.settle();
  Station<cpd::Device>& drive = network.drives.front();  // node-ID 6
  drive.received = 0;
  network.tester.send(frame("181 01"));
  network.tester.send(frame("607 40 00 10 00 00 00 00 00"));
  network.tester.send(frame("18100000 01"));
  network.bus.settle();
  EXPECT_EQ(drive.received, 0u);
  network.tester.send(frame("000 01 00"));
  network.tester.send(frame("606 40 00 10 00 00 00 00 00"));
  network.bus.settle();
  EXPECT_EQ(drive.received, 2u);
}

TEST(IndependentEndpoints, WithoutAListReceiveAllFrames) {
  VirtualBus bus;
  bus.assume_independent_endpoints();
  VirtualBus::Endpoint& sender = bus.attach();
  unsigned received = 0;
  bus.attach().on_frame = [&](const Frame&, TimePoint) { ++received; };
  sender.send(frame("181 01"));
  sender.send(frame("18100000 01"));
  bus.settle();
  bus.attach().on_frame = [&](const Frame&, TimePoint) { received += 10; };
  sender.send(frame("181 01"));
  bus.settle();
  EXPECT_EQ(received, 13u);
}

TEST(IndependentEndpoints, AreCalledOftenEnoughToCompareTimes) {
  VirtualBus bus;
  bus.assume_independent_endpoints();
  VirtualBus::Endpoint& sender = bus.attach();
  VirtualBus::Endpoint& receiver = bus.attach();
  receiver.accepted_frames = [](std::vector<AcceptedFrame>&) {};
  std::vector<TimePoint> calls;
  receiver.on_frame = [&](const Frame&, TimePoint now) { calls.push_back(now); };
  for (int minute = 0; minute < 40; ++minute) {
    sender.send(frame("181 01"));
    bus.run_for(1min);
  }
  EXPECT_EQ(calls, (std::vector{TimePoint{15min}, TimePoint{30min}}));
}

}  // namespace

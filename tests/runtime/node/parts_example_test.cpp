/// The programs of "The composition of a device" in docs/application.md.
#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <cstdint>
#include <rk5c/device.hpp>

#include "support/bench.hpp"

namespace {

namespace pump = rk5c;  // a device with 1010h and LSS
using Bus = bench::RecordingBus;
using Flash = canopen::MemoryStorage;

struct Port {
  canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssError store(canopen::NodeId, canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssBitTiming bit_timing() { return {}; }
  void stop_communication() {}
  void start_communication(canopen::LssBitTiming) {}
};

struct Pump {
  void start() { is_started = true; }
  bool is_started = false;
};

constexpr canopen::NodeId id{5};

template <class Node>
void expect_start(Node& node) {
  node.start(canopen::TimePoint{});
  EXPECT_TRUE(node.template application<Pump>().is_started);
  EXPECT_EQ(node.state(), canopen::NmtState::pre_operational);
}

TEST(PartsExample, NodeListsTheTypesOfTheParts) {
  Bus bus;
  Flash flash;
  Port port;
  canopen::Node<pump::Device, Bus, Pump, canopen::StoredIn<Flash>, canopen::ConfiguredByLss<Port>> node{
      bus, id, canopen::stored_in(flash), canopen::configured_by_lss(port)};
  expect_start(node);
}

TEST(PartsExample, MakeNodeHasTheValuesOfTheParts) {
  Bus bus;
  Flash flash;
  Port port;
  auto node =
      canopen::make_node<pump::Device>(bus, id, Pump{}, canopen::stored_in(flash), canopen::configured_by_lss(port));
  expect_start(node);
}

using PumpParts = canopen::Composition<pump::Device, Pump, canopen::without<canopen::part::lss>>;

TEST(PartsExample, HardwareFollowsTheComposition) {
  Bus bus;
  Flash flash;
  canopen::Node<PumpParts, Bus, canopen::StoredIn<Flash>> node{bus, id, canopen::stored_in(flash)};
  expect_start(node);
}

TEST(PartsExample, HardwareFollowsTheCompositionInMakeNode) {
  Bus bus;
  Flash flash;
  auto node = canopen::make_node<PumpParts>(bus, id, canopen::stored_in(flash));
  expect_start(node);
}

}  // namespace

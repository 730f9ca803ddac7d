/// The frames that a node accepts: all that its services need, and none for a service that it does not have.
#include <gtest/gtest.h>
#include <canopen/node/accepted_frames.hpp>

#include <cstring>
#include <every_service/device.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

template <class Device>
std::set<std::string> accepted_by(bench::Bench<Device>& device) {
  std::set<std::string> frames;
  std::size_t count = 0;
  canopen::for_each_accepted_frame(device.node, [&](const canopen::AcceptedFrame& accepted) {
    frames.insert(bench::text({.id = accepted.id, .extended = accepted.extended, .remote = accepted.remote}));
    ++count;
  });
  EXPECT_LE(count, canopen::max_accepted_frames<Device>);
  return frames;
}

std::string joined(const std::set<std::string>& frames) {
  std::string text;
  for (const std::string& frame : frames) text += (text.empty() ? "" : " | ") + frame;
  return text;
}

TEST(AcceptedFrames, AreThoseOfThePredefinedConnectionSet) {
  bench::Bench<> device;
  EXPECT_EQ(joined(accepted_by(device)), "000 | 205 | 305 | 605");
}

TEST(AcceptedFrames, FollowTheCobIds) {
  bench::Bench<> device;
  ASSERT_EQ(device.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(accepted_by(device).count("205"), 0u) << "not valid";
  ASSERT_EQ(device.ask("605 23 00 14 01 34 12 34 32"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(accepted_by(device).count("12341234"), 1u) << "valid again, with 29 bits";
  ASSERT_EQ(device.ask("605 23 16 10 01 64 00 07 00"), "585 60 16 10 01 00 00 00 00");
  EXPECT_EQ(accepted_by(device).count("707"), 1u) << "a node whose heartbeat is watched";
}

TEST(AcceptedFrames, OfANodeWithoutNodeIdAreThoseOfNoService) {
  bench::RecordingBus bus;
  bench::NodeOf<sample::Device, bench::RecordingBus> node{bus, canopen::unconfigured_node_id};
  node.start(canopen::TimePoint{});
  std::size_t count = 0;
  canopen::for_each_accepted_frame(node, [&](const canopen::AcceptedFrame&) { ++count; });
  EXPECT_EQ(count, 0u);
}

/// A node behaves the same whether or not it receives the other frames.
TEST(AcceptedFrames, AreAllThatANodeLooksAt) {
  bench::Bench<every_service::Device> device;
  const std::set<std::string> accepted = accepted_by(device);
  (void)device.ask(bench::start);
  (void)device.pass(canopen::Duration{0});
  std::vector<unsigned char> before(sizeof device.node.values());
  std::size_t ignored = 0;
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    for (const bool remote : {false, true}) {
      canopen::Frame frame{
          .id = id, .size = 8, .remote = remote, .data = {0x40, 0x00, 0x10, 0x00, 0x01, 0x80, 0x05, 0x11}};
      if (accepted.count(bench::text({.id = id, .remote = remote})) != 0) continue;
      ++ignored;
      std::memcpy(before.data(), &device.node.values(), before.size());
      for (frame.size = 0; frame.size <= 8; ++frame.size) device.node.on_frame(frame, device.now);
      EXPECT_EQ(device.bus.take(), "") << bench::text(frame);
      EXPECT_EQ(std::memcmp(before.data(), &device.node.values(), before.size()), 0) << bench::text(frame);
    }
  }
  EXPECT_GT(ignored, 4000u);
}

}  // namespace

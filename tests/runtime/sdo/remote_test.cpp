#include <gtest/gtest.h>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/sdo/remote_node.hpp>
#include <canopen_sim/virtual_bus_port.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/bench.hpp"
#include "support/flooded_bus.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::NodeId;
using canopen::TimePoint;
namespace od = sample::od;
using namespace std::chrono_literals;

using Remote = canopen::RemoteNode<sample::Device, bench::RecordingBus>;

// Which reads and writes do not compile: tests/compile_fail.

static_assert(canopen::check_value<od::integer8_value>(100) == canopen::ok);
static_assert(canopen::check_value<od::integer8_value>(101) == AbortCode::value_too_high);
static_assert(canopen::check_value<od::integer8_value>(-101) == AbortCode::value_too_low);
static_assert(canopen::check_value<od::controlword>(0x10000) == AbortCode::value_too_high);
static_assert(canopen::check_value<od::controlword>(-1) == AbortCode::value_too_low);
static_assert(canopen::check_value<od::unsigned24_value>(0x1000000) == AbortCode::value_too_high);
static_assert(canopen::check_value<od::real32_value>(1.6) == AbortCode::value_too_high);

static_assert(canopen::check_value<od::real64_value>(1e300) == canopen::ok);

// Limits of a REAL; a single limit is also possible.
struct Ratio : canopen::Object<0x5000, 0, float, canopen::Access::rw> {
  static constexpr float low_limit = -0.5F;
  static constexpr float high_limit = 1.5F;
};
struct AtMost : canopen::Object<0x5001, 0, double, canopen::Access::rw> {
  static constexpr double high_limit = 2.0;
};
struct AtLeast : canopen::Object<0x5002, 0, double, canopen::Access::rw> {
  static constexpr double low_limit = -2.0;
};
static_assert(canopen::check_value<Ratio>(1.5F) == canopen::ok && canopen::check_value<Ratio>(-0.5F) == canopen::ok);
static_assert(canopen::check_value<Ratio>(1.625F) == AbortCode::value_too_high);
static_assert(canopen::check_value<Ratio>(-0.625F) == AbortCode::value_too_low);
static_assert(canopen::check_value<Ratio>(2) == AbortCode::value_too_high);
static_assert(canopen::check_value<AtMost>(2.0) == canopen::ok && canopen::check_value<AtMost>(-1e300) == canopen::ok);
static_assert(canopen::check_value<AtMost>(2.5) == AbortCode::value_too_high);
static_assert(canopen::check_value<AtLeast>(-2.0) == canopen::ok &&
              canopen::check_value<AtLeast>(1e300) == canopen::ok);
static_assert(canopen::check_value<AtLeast>(-2.5) == AbortCode::value_too_low);
static_assert(canopen::check_value<AtMost>(std::numeric_limits<double>::quiet_NaN()) == AbortCode::invalid_value);
static_assert(canopen::check_value<AtLeast>(std::numeric_limits<double>::quiet_NaN()) == AbortCode::invalid_value);

// Without blocking

TEST(RemoteNode, ReadsAnObject) {
  bench::RecordingBus bus;
  Remote remote{bus, NodeId{5}};
  EXPECT_TRUE(remote.read<od::statusword>(TimePoint{}));
  EXPECT_EQ(bus.take(), "605 40 41 60 00 00 00 00 00");
  EXPECT_TRUE(remote.busy());
  EXPECT_EQ(remote.value<od::statusword>().abort_code(), AbortCode::no_resource);
  remote.on_frame(frame("585 4B 41 60 00 37 02 00 00"), TimePoint{});
  EXPECT_FALSE(remote.busy());
  EXPECT_EQ(remote.value<od::statusword>().value(), 0x0237);
}

TEST(RemoteNode, WritesAnObject) {
  bench::RecordingBus bus;
  Remote remote{bus, NodeId{5}};
  EXPECT_TRUE(remote.write<od::controlword>(0x0F, TimePoint{}));
  EXPECT_EQ(bus.take(), "605 2B 40 60 00 0F 00 00 00");
  EXPECT_EQ(remote.write<od::controlword>(0x0F, TimePoint{}).abort_code(), AbortCode::no_resource);
  remote.on_frame(frame("585 60 40 60 00 00 00 00 00"), TimePoint{});
  EXPECT_TRUE(remote.result());
  EXPECT_TRUE((remote.write<od::integer24_value, -2>(TimePoint{})));
  EXPECT_EQ(bus.take(), "605 27 03 20 00 FE FF FF 00");
  remote.on_frame(frame("585 80 03 20 00 22 00 00 08"), TimePoint{});
  EXPECT_EQ(remote.result().abort_code(), AbortCode::device_state);
}

TEST(RemoteNode, SendsNoValueOutsideTheLimits) {
  bench::RecordingBus bus;
  Remote remote{bus, NodeId{5}};
  EXPECT_EQ(remote.write<od::integer8_value>(101, TimePoint{}).abort_code(), AbortCode::value_too_high);
  EXPECT_EQ(remote.write<od::real32_value>(std::nanf(""), TimePoint{}).abort_code(), AbortCode::invalid_value);
  const std::array<std::uint8_t, 17> text{};
  EXPECT_EQ(remote.write<od::visible_string_value>(text, TimePoint{}).abort_code(), AbortCode::length_too_high);
  EXPECT_EQ(bus.take(), "");
  EXPECT_FALSE(remote.busy());
}

TEST(RemoteNode, RefusesAnAnswerOfAnotherLength) {
  bench::RecordingBus bus;
  Remote remote{bus, NodeId{5}};
  for (const char* answer : {"585 43 41 60 00 37 02 00 00", "585 4F 41 60 00 37 00 00 00"}) {
    EXPECT_TRUE(remote.read<od::statusword>(TimePoint{}));
    remote.on_frame(frame(answer), TimePoint{});
    EXPECT_EQ(remote.value<od::statusword>().abort_code(), AbortCode::length_mismatch);
  }
}

TEST(RemoteNode, ReadsAStringIntoMemory) {
  bench::RecordingBus bus;
  Remote remote{bus, NodeId{5}};
  std::array<std::uint8_t, 16> memory{};
  EXPECT_TRUE(remote.read<od::visible_string_value>(memory, TimePoint{}));
  remote.on_frame(frame("585 4B 0C 20 00 48 69 00 00"), TimePoint{});
  EXPECT_EQ(std::string(remote.data().begin(), remote.data().end()), "Hi");
}

// Blocking

struct Plant {
  Plant() {
    VirtualBus::connect(device_end, device);
    device.start(bus.now());
    bus.settle();
  }
  using VirtualBus = canopen::VirtualBus;

  VirtualBus bus{125'000};
  VirtualBus::Endpoint& device_end = bus.attach();
  bench::NodeOf<sample::Device, VirtualBus::Endpoint> device{device_end, NodeId{5}};
  canopen::VirtualBusPort port{bus};
  canopen::BlockingSdo<canopen::VirtualBusPort> master{port};
  canopen::BlockingRemoteNode<sample::Device, canopen::VirtualBusPort> drive = master.remote<sample::Device>(NodeId{5});
};

TEST(BlockingSdo, ReadsAndWritesObjects) {
  Plant plant;
  EXPECT_TRUE(plant.drive.write<od::integer24_value>(-5));
  EXPECT_EQ(plant.device.get<od::integer24_value>(), -5);
  EXPECT_EQ(plant.drive.read<od::integer24_value>().value(), -5);
  EXPECT_TRUE((plant.drive.write<od::integer64_value, -123'456'789'012>()));
  EXPECT_EQ(plant.drive.read<od::integer64_value>().value(), -123'456'789'012);
  EXPECT_TRUE(plant.drive.write<od::time_of_day_value>(canopen::TimeOfDay{1, 2}));
  EXPECT_EQ(plant.drive.read<od::time_of_day_value>().value(), (canopen::TimeOfDay{1, 2}));
}

TEST(BlockingSdo, ReadsAndWritesStringsAndDomains) {
  Plant plant;
  EXPECT_EQ(plant.drive.read<od::manufacturer_device_name>()->view(), "Sample device");
  EXPECT_TRUE(plant.drive.write<od::visible_string_value>("hello, world"));
  EXPECT_EQ(plant.drive.read<od::visible_string_value>()->view(), "hello, world");
  EXPECT_EQ(plant.drive.write<od::visible_string_value>("more than sixteen").abort_code(), AbortCode::length_too_high);

  std::array<std::uint8_t, 100> memory{};
  plant.device.bind<od::parameter_file>(memory, 0);
  const std::vector<std::uint8_t> bytes(99, 0x5A);
  EXPECT_TRUE(plant.drive.write<od::parameter_file>(bytes));
  EXPECT_EQ(plant.drive.read<od::parameter_file>().value(), bytes);
}

TEST(BlockingSdo, TellsWhyNot) {
  Plant plant;
  EXPECT_EQ(plant.master.upload(NodeId{5}, 0x5000, 0).abort_code(), AbortCode::no_object);
  EXPECT_EQ(plant.master.upload(NodeId{5}, 0x1008, 0, 5).abort_code(), AbortCode::out_of_memory);
  EXPECT_EQ(plant.drive.read<od::parameter_file>().abort_code(), AbortCode::no_data);
  const TimePoint before = plant.bus.now();
  EXPECT_EQ(plant.master.upload(NodeId{6}, 0x1000, 0).abort_code(), AbortCode::timeout);
  EXPECT_GE(plant.bus.now() - before, canopen::Duration{500ms});
  EXPECT_LT(plant.bus.now() - before, canopen::Duration{510ms});
}

TEST(BlockingSdo, EndsOnABusThatTakesNoFrame) {
  struct Full {
    canopen::VirtualBusPort port;
    bool send(const canopen::Frame&) { return false; }
    std::optional<canopen::Frame> receive(canopen::Duration timeout) { return port.receive(timeout); }
    TimePoint now() const { return port.now(); }
  };
  canopen::VirtualBus bus;
  Full full{canopen::VirtualBusPort{bus}};
  canopen::BlockingSdo master{full};
  for (int i = 0; i < 2; ++i) {
    const TimePoint before = bus.now();
    EXPECT_EQ(master.upload(NodeId{5}, 0x1000, 0).abort_code(), AbortCode::timeout);
    EXPECT_LT(bus.now() - before, canopen::Duration{510ms});
  }
}

TEST(BlockingSdo, AnAnswerThatWasNotReadInTimeIsNotThatOfTheNextRequest) {
  canopen::VirtualBus bus;
  canopen::VirtualBusPort port{bus};
  canopen::VirtualBus::Endpoint& slave = bus.attach();
  canopen::BlockingSdo master{port};
  EXPECT_EQ(master.upload(NodeId{5}, 0x6041, 0).abort_code(), AbortCode::timeout);
  bus.settle();
  ASSERT_TRUE(slave.send(bench::frame("585 4B 41 60 00 37 06 00 00")));
  bus.run_for(2s);
  slave.on_frame = [&](const canopen::Frame& frame, TimePoint) {
    if (frame.data[0] == 0x40) (void)slave.send(bench::frame("585 4B 41 60 00 33 06 00 00"));
  };
  EXPECT_EQ(master.upload(NodeId{5}, 0x6041, 0).value(), (std::vector<std::uint8_t>{0x33, 0x06}));
}

TEST(BlockingSdo, CompletesATransferInsideOfWhichAnotherOneHasRun) {
  canopen::VirtualBus bus;
  canopen::VirtualBusPort port{bus};
  canopen::VirtualBus::Endpoint& slaves = bus.attach();
  slaves.on_frame = [&](const canopen::Frame& frame, TimePoint) {
    if (frame.id == 0x606) (void)slaves.send(bench::frame("585 4B 41 60 00 05 00 00 00"));
    if (frame.id == 0x606) (void)slaves.send(bench::frame("586 4B 41 60 00 06 00 00 00"));
    if (frame.id == 0x605) (void)slaves.send(bench::frame("705 7F"));
  };
  canopen::BlockingSdo master{port};
  std::vector<std::uint8_t> inner;
  master.on_frame = [&](const canopen::Frame& frame, TimePoint) {
    if (frame.id == 0x705) inner = master.upload(NodeId{6}, 0x6041, 0).value();
  };
  EXPECT_EQ(master.upload(NodeId{5}, 0x6041, 0).value(), (std::vector<std::uint8_t>{5, 0}));
  EXPECT_EQ(inner, (std::vector<std::uint8_t>{6, 0}));
}

TEST(BlockingSdo, RefusesATransferToTheNodeThatItWaitsFor) {
  Plant plant;
  EXPECT_EQ(plant.device.set<od::producer_heartbeat_time>(canopen::raw(10)), canopen::ok);
  AbortCode nested = canopen::ok;
  plant.master.on_frame = [&](const canopen::Frame&, TimePoint) {
    if (nested == canopen::ok) nested = plant.master.upload(NodeId{6}, 0x1000, 0).abort_code();
  };
  EXPECT_EQ(plant.master.upload(NodeId{6}, 0x1000, 0).abort_code(), AbortCode::timeout);
  EXPECT_EQ(nested, AbortCode::no_resource);
}

TEST(BlockingSdo, RefusesATransferToTheNodeBeforeItsOwnHasReturned) {
  Plant plant;
  EXPECT_EQ(plant.device.set<od::integer24_value>(-5), canopen::ok);
  AbortCode nested = canopen::ok;
  plant.master.on_frame = [&](const canopen::Frame& frame, TimePoint) {  // also for the frame that ends the transfer
    if (frame.id == 0x585) nested = plant.master.upload(NodeId{5}, 0x1000, 0).abort_code();
  };
  EXPECT_EQ(plant.drive.read<od::integer24_value>().value(), -5);
  EXPECT_EQ(nested, AbortCode::no_resource);
  EXPECT_EQ(plant.drive.read<od::integer24_value>().value(), -5) << "the next one may begin";
}

TEST(BlockingSdo, EndsOnABusThatIsNeverSilent) {
  bench::expect_timeout_on_a_flooded_bus<canopen::BlockingSdo<bench::FloodedBus>>();
}

TEST(BlockingSdo, HandsOtherFramesOnWhileItWaits) {
  Plant plant;
  EXPECT_EQ(plant.device.set<od::producer_heartbeat_time>(canopen::raw(10)), canopen::ok);
  int heartbeats = 0;
  plant.master.on_frame = [&](const canopen::Frame& frame, TimePoint) { heartbeats += frame.id == 0x705 ? 1 : 0; };
  (void)plant.master.upload(NodeId{6}, 0x1000, 0);
  EXPECT_GE(heartbeats, 49);
}

}  // namespace

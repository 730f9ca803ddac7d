/// `start` and the periodic functions of an application, as a class and as lambdas: which calls at which times.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/host/memory_storage.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/storage/background_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <cstdint>
#include <random>
#include <rk5c/device.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runtime/storage/flash_emulation.hpp"
#include "support/bench.hpp"

namespace {

using canopen::Duration;
using canopen::ErrorRegister;
using canopen::Milliseconds;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;
namespace od = rk5c::od;

using Calls = std::vector<std::string>;

[[nodiscard]] std::string at(TimePoint time) { return std::to_string(time.since_start().count() / 1000) + " ms"; }

struct Sensor {
  void start(auto& node) {
    calls.push_back("start, state " + std::to_string(static_cast<int>(node.state())));
    node.set(od::cyclic_timer{}, canopen::raw(7));
  }
  void on_state(NmtState state) { calls.push_back("state " + std::to_string(static_cast<int>(state))); }
  void every(Milliseconds<10>, auto& node) { calls.push_back("10 ms at " + at(node.now())); }
  void every(canopen::Microseconds<25'000>) { calls.push_back("25 ms"); }
  Calls calls;
};

using Device = bench::Bench<rk5c::Device, Sensor>;

[[nodiscard]] Calls take(Device& device) { return std::exchange(device.node.application<Sensor>().calls, {}); }

TEST(Start, IsTheFirstCallAfterTheDefaultValuesHaveBeenSet) {
  bench::RecordingBus bus;
  bench::NodeOf<rk5c::Device, bench::RecordingBus, Sensor> node{bus, NodeId{5}};
  EXPECT_EQ(node.application<Sensor>().calls, Calls{});
  node.start(TimePoint{});
  EXPECT_EQ(node.application<Sensor>().calls, (Calls{"start, state 0", "state 0", "state 127"}));
  EXPECT_EQ(canopen::to_raw(node.get(od::cyclic_timer{})), 7) << "default values do not replace it";
  EXPECT_EQ(bus.take(), "705 00");
}

/// CiA 301, 7.3.2.2.1: Initialising follows power-on or a hardware reset alone. Values return to their power-on values.
TEST(Start, IsNotCalledByAReset) {
  for (const char* const reset : {bench::reset_node, bench::reset_communication}) {
    Device device{Sensor{}};
    static_cast<void>(take(device));
    device.ask(reset);
    EXPECT_EQ(take(device), (Calls{"state 0", "state 127"}));
  }
}

TEST(Start, IsCalledOnceForEachPowerOn) {
  Device device{Sensor{}};
  device.ask(bench::start);
  static_cast<void>(take(device));
  device.node.start(device.now);
  EXPECT_EQ(take(device), (Calls{"start, state 0", "state 0", "state 127"})) << "not Operational any more";
}

TEST(Start, IsCalledWithoutANodeId) {
  bench::RecordingBus bus;
  bench::NodeOf<rk5c::Device, bench::RecordingBus, Sensor> node{bus, canopen::unconfigured_node_id};
  node.start(TimePoint{});
  EXPECT_EQ(node.application<Sensor>().calls, (Calls{"start, state 0", "state 0"}));
  EXPECT_EQ(bus.take(), "");
}

TEST(Start, MayReportAnErrorAndConfigureTheNode) {
  bench::RecordingBus bus;
  auto node = bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::on_start([](auto& starting) {
                                               starting.emergency(0x5000, ErrorRegister::manufacturer);
                                               EXPECT_EQ(starting.set(od::producer_heartbeat_time{}, canopen::raw(100)),
                                                         canopen::ok);
                                               starting.request(NmtCommand::start, starting.now());
                                             }));
  node.start(TimePoint{});
  EXPECT_EQ(bus.take(), "705 00 | 085 00 50 81 00 00 00 00 00") << "after the boot-up message";
  EXPECT_EQ(node.state(), NmtState::pre_operational) << "a command in Initialisation has no effect";
  node.on_time(TimePoint{100ms});
  EXPECT_EQ(bus.take(), "705 7F");
}

TEST(Start, SeesStoredValues) {
  canopen::MemoryStorage storage;
  bench::RecordingBus bus;
  {
    auto node = bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::stored_in(storage));
    node.start(TimePoint{});
    node.set(od::cyclic_timer{}, canopen::raw(9));
    ASSERT_EQ(node.save(), canopen::ok);
  }
  std::uint16_t seen = 0;
  auto node = bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::stored_in(storage),
                                             canopen::on_start([&](auto& starting) {
                                               seen = canopen::to_raw(starting.get(od::cyclic_timer{}));
                                               EXPECT_EQ(starting.save(), canopen::ok);
                                             }));
  node.start(TimePoint{});
  EXPECT_EQ(seen, 9);
}

/// Members with the names of functions that a node calls: data, and a function for the class alone.
TEST(Start, IsAPublicFunction) {
  class Machine {
   public:
    void on_state(NmtState) { start(); }
    void tick() { ++starts; }
    int starts = 0;
    int each = 0;
    int read = 0;

   private:
    void start() { ++starts; }
    int periodic = 0;
  };
  auto device = bench::with<rk5c::Device>(Machine{});
  EXPECT_EQ(device.node.application<Machine>().starts, 2) << "by its on_state alone";
}

TEST(Start, IsCalledForEachHandlerInTheirOrder) {
  std::string calls;
  struct First {
    void start() { *calls += "class "; }
    std::string* calls;
  };
  First application{&calls};
  bench::RecordingBus bus;
  auto node = bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::on_start([&] { calls += "lambda "; }),
                                             canopen::application_at(application),
                                             canopen::on_start([&](auto&) { calls += "last"; }));
  node.start(TimePoint{});
  EXPECT_EQ(calls, "lambda class last");
}

TEST(Periodic, IsCalledAfterEachPeriod) {
  Device device{Sensor{}};
  static_cast<void>(take(device));
  device.pass(50ms);
  EXPECT_EQ(take(device), (Calls{"10 ms at 10 ms", "10 ms at 20 ms", "25 ms", "10 ms at 30 ms", "10 ms at 40 ms",
                                 "10 ms at 50 ms", "25 ms"}));
  EXPECT_EQ(device.node.next_deadline(), TimePoint{60ms});
}

TEST(Periodic, IsNotCalledBeforeStart) {
  bench::RecordingBus bus;
  bench::NodeOf<rk5c::Device, bench::RecordingBus, Sensor> node{bus, NodeId{5}};
  node.on_time(TimePoint{100ms});
  EXPECT_EQ(node.next_deadline(), std::nullopt);
  EXPECT_EQ(node.application<Sensor>().calls, Calls{});
  node.start(TimePoint{107ms});
  EXPECT_EQ(node.next_deadline(), TimePoint{117ms});
}

TEST(Periodic, IsNotShiftedByALateCall) {
  Device device{Sensor{}};
  static_cast<void>(take(device));
  device.node.on_time(TimePoint{19ms});
  EXPECT_EQ(take(device), Calls{"10 ms at 19 ms"});
  EXPECT_EQ(device.node.next_deadline(), TimePoint{20ms});
  device.node.on_time(TimePoint{20ms});
  EXPECT_EQ(take(device), Calls{"10 ms at 20 ms"});
}

TEST(Periodic, IsCalledOnceForSeveralMissedPeriods) {
  Device device{Sensor{}};
  static_cast<void>(take(device));
  device.node.on_time(TimePoint{1003ms});
  EXPECT_EQ(take(device), (Calls{"10 ms at 1003 ms", "25 ms"}));
  EXPECT_EQ(device.node.next_deadline(), TimePoint{1010ms});
  device.node.on_time(TimePoint{1003ms});
  EXPECT_EQ(take(device), Calls{});
  device.node.on_time(TimePoint{1030ms});
  EXPECT_EQ(take(device), (Calls{"10 ms at 1030 ms", "25 ms"}));
  EXPECT_EQ(device.node.next_deadline(), TimePoint{1040ms});
}

/// Each period that has ended since the last call makes one call in all: computed with 64 bits.
TEST(Periodic, KeepsItsTimesWhileTheClockWraps) {
  constexpr std::uint64_t period = 333'333;
  std::uint64_t calls = 0;
  bench::RecordingBus bus;
  auto node =
      bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::every(canopen::Microseconds<period>{}, [&] { ++calls; }));
  constexpr std::uint64_t start = 0xFFFF'0000;
  std::uint64_t now = start;
  const auto time = [&] { return TimePoint{Duration{static_cast<std::uint32_t>(now)}}; };
  node.start(time());
  std::mt19937 random{1};
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t before = (now - start) / period;
    constexpr std::uint64_t spans[] = {1, period / 3, period, 5 * period, 1'800'000'000};
    now += random() % spans[random() % 5] + 1;
    calls = 0;
    node.on_time(time());
    const std::uint64_t after = (now - start) / period;
    ASSERT_EQ(calls, after == before ? 0u : 1u) << "at " << now;
    ASSERT_EQ(node.next_deadline(), (TimePoint{Duration{static_cast<std::uint32_t>(start + (after + 1) * period)}}));
  }
}

/// A node that was not called for longer than it may be.
TEST(Periodic, GoesOnWithinOnePeriodAfterAnyGap) {
  for (std::uint64_t wraps = 0; wraps < 4; ++wraps) {
    for (std::int64_t around = -7'000'000; around <= 7'000'000; around += 499'999) {
      Device device{Sensor{}};
      static_cast<void>(take(device));
      const auto now = static_cast<std::uint32_t>((wraps << 32) + static_cast<std::uint64_t>(around));
      device.node.on_time(TimePoint{Duration{now}});
      static_cast<void>(take(device));
      device.now = TimePoint{Duration{now}};
      device.pass(10ms);
      EXPECT_EQ(take(device).empty(), false) << wraps << " wraps and " << around << " us";
    }
  }
}

TEST(Periodic, DoesNotDependOnNodeIdAndState) {
  bench::RecordingBus bus;
  bench::NodeOf<rk5c::Device, bench::RecordingBus, Sensor> unconfigured{bus, canopen::unconfigured_node_id};
  unconfigured.start(TimePoint{});
  EXPECT_EQ(unconfigured.next_deadline(), TimePoint{10ms});
  unconfigured.on_time(TimePoint{10ms});
  EXPECT_EQ(unconfigured.application<Sensor>().calls.back(), "10 ms at 10 ms");
  EXPECT_EQ(unconfigured.next_deadline(), TimePoint{20ms});
  EXPECT_EQ(bus.take(), "");

  Device device{Sensor{}};
  for (const char* const command : {bench::start, bench::stop, bench::reset_communication, bench::reset_node}) {
    device.ask(command);
    static_cast<void>(take(device));
    device.pass(10ms);
    EXPECT_NE(std::ranges::count(take(device), "10 ms at " + at(device.now)), 0) << command;
  }
}

/// CiA 305: a node sends nothing while its bit rate is being switched.
TEST(Periodic, IsCalledWhileTheBitRateIsSwitched) {
  struct Port {
    [[nodiscard]] canopen::LssBitTiming bit_timing() const { return {}; }
    [[nodiscard]] canopen::LssError accept(NodeId) const { return canopen::lss::success; }
    [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming) const { return canopen::lss::success; }
    [[nodiscard]] canopen::LssError store(NodeId, canopen::LssBitTiming) const { return canopen::lss::success; }
    void stop_communication() {}
    void start_communication(canopen::LssBitTiming) {}
  };
  Port port;
  auto device = bench::with<rk5c::Device>(canopen::configured_by_lss<rk5c::Device::lss_options>(port), Sensor{});
  device.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
  device.ask("7E5 15 64 00 00 00 00 00 00");  // 100 ms
  Calls& calls = device.node.application<Sensor>().calls;
  calls.clear();
  device.ask("605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(device.pass(50ms), "");
  EXPECT_EQ(calls.size(), 7u);
}

TEST(Periodic, SendsWhatItCausesAtOnce) {
  auto device = bench::with<rk5c::Device>(
      canopen::every<Milliseconds<10>>([](auto& node) { node.emergency(0x5000, ErrorRegister::manufacturer); }));
  device.now = TimePoint{10ms};
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), "085 00 50 81 00 00 00 00 00");
}

TEST(Periodic, IsServedWhileTheBusHasNoRoom) {
  Device device{Sensor{}};
  device.bus.room = 0;
  device.ask("605 40 00 10 00 00 00 00 00");
  static_cast<void>(take(device));
  device.node.on_time(TimePoint{10ms});
  EXPECT_EQ(take(device), Calls{"10 ms at 10 ms"});
}

TEST(Periodic, MayResetItsNode) {
  for (const NmtCommand command : {NmtCommand::reset_node, NmtCommand::reset_communication}) {
    int calls = 0;
    auto device = bench::with<rk5c::Device>(canopen::every<Milliseconds<10>>([&, command](auto& node) {
                                              ++calls;
                                              node.request(command, node.now());
                                            }),
                                            canopen::every<Milliseconds<10>>([&](auto&) { ++calls; }));
    EXPECT_EQ(device.pass(30ms), "705 00 | 705 00 | 705 00");
    EXPECT_EQ(calls, 6);
    EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  }
}

TEST(Periodic, BelongsToEachOfSeveralApplications) {
  Sensor other;
  auto device = bench::with<rk5c::Device>(Sensor{}, canopen::application_at(other));
  other.calls.clear();
  device.pass(10ms);
  EXPECT_EQ(other.calls, Calls{"10 ms at 10 ms"});
  EXPECT_EQ(device.node.application<Sensor>().calls.back(), "10 ms at 10 ms");
}

TEST(Periodic, IsCalledWithTheLockHeld) {
  struct Counting {
    void lock() { ++held; }
    void unlock() { --held; }
    int held = 0;
  };
  Counting lock;
  int held = 0;
  bench::RecordingBus bus;
  auto node =
      bench::make_node<rk5c::Device>(bus, NodeId{5}, canopen::every<Milliseconds<10>>([&] { held = lock.held; }));
  canopen::Locked locked{node, lock};
  locked.start(TimePoint{});
  EXPECT_EQ(locked.next_deadline(), TimePoint{10ms});
  locked.on_time(TimePoint{10ms});
  EXPECT_EQ(held, 1);
}

/// A value that an interrupt has posted before the call.
TEST(Periodic, SeesPostedValues) {
  canopen::Mailbox<od::speed_value<1>> mailbox;
  int seen = 0;
  auto device = bench::with<rk5c::Device>(
      canopen::every<Milliseconds<10>>([&](auto& node) { seen = canopen::to_raw(node.get(od::speed_value<1>{})); }),
      canopen::values_from(mailbox));
  mailbox.post<od::speed_value<1>>(canopen::raw(33));
  EXPECT_TRUE(device.node.next_deadline() <= device.now);
  device.node.on_time(TimePoint{10ms});
  EXPECT_EQ(seen, 33);
  EXPECT_EQ(device.node.next_deadline(), TimePoint{20ms});
}

/// A storage that is written in steps, one in each on_time.
TEST(Periodic, IsCalledWhileParametersAreStored) {
  bench::FlashEmulation<1024, 8> pages;
  canopen::FlashStorage flash{pages};
  canopen::BackgroundStorage<decltype(flash), 512> storage{flash};
  int calls = 0;
  auto device = bench::with<rk5c::Device>(canopen::stored_in(storage), canopen::every<Milliseconds<1>>([&](auto& node) {
                                            if (++calls == 2) {
                                              EXPECT_EQ(node.save(), canopen::ok);
                                            }
                                          }));
  device.pass(100ms);
  EXPECT_EQ(calls, 100);
  EXPECT_FALSE(storage.busy());
  EXPECT_FALSE(storage.failed());
  EXPECT_GT(pages.steps, 0);
}

/// 4 bytes for each function, and one flag.
TEST(Periodic, TakesFourBytesOfRam) {
  struct One {
    void every(Milliseconds<1>) {}
  };
  struct Three {
    void every(Milliseconds<1>) {}
    void every(Milliseconds<2>) {}
    void every(canopen::Seconds<1'800>) {}
  };
  using Without = bench::NodeOf<rk5c::Device, bench::RecordingBus>;
  using WithOne = bench::NodeOf<rk5c::Device, bench::RecordingBus, One>;
  using WithThree = bench::NodeOf<rk5c::Device, bench::RecordingBus, Three>;
  EXPECT_LE(sizeof(WithOne), sizeof(Without) + 8);
  EXPECT_EQ(sizeof(WithThree), sizeof(WithOne) + 8);
}

}  // namespace

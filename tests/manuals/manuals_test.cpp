/// The statements of the manuals of all five reference devices, tested with a device of each.
#include <gtest/gtest.h>

#include <can_2057c/device.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <ezd_1136/device.hpp>
#include <rk5c/device.hpp>
#include <string>

#include "manual_bench.hpp"
#include "support/omitting.hpp"

namespace {

using canopen::AbortCode;
using canopen::ErrorRegister;
using canopen::NmtState;
using namespace std::chrono_literals;

struct Manual000 {
  using Device = cpc_tc1::Device;
  static constexpr auto device_type = "585 43 00 10 00 92 01 42 00";
  static constexpr auto announced_reset = "";
};
struct Manual001 {
  using Device = ezd_1136::Device;
  static constexpr auto device_type = "585 43 00 10 00 92 01 04 00";
  static constexpr auto announced_reset = "";
};
struct Manual002 {
  using Device = cpd::Device;
  static constexpr auto device_type = "585 43 00 10 00 92 01 02 00";
  static constexpr auto announced_reset = "";
};
struct Manual003 {
  using Device = can_2057c::Device;
  static constexpr auto device_type = "585 43 00 10 00 91 01 02 00";
  static constexpr auto announced_reset = "085 00 FF 80 0A 00 00 00 00 | ";
};
struct Manual004 {
  using Device = rk5c::Device;
  static constexpr auto device_type = "585 42 00 10 00 96 01 0A 00";
  static constexpr auto announced_reset = "";
};

template <class Manual>
struct EveryDevice : testing::Test {
  using Device = typename Manual::Device;
};

using Manuals = testing::Types<Manual000, Manual001, Manual002, Manual003, Manual004>;
TYPED_TEST_SUITE(EveryDevice, Manuals);

struct Command {
  const char* frame;
  NmtState target;
  bool resets;
};

constexpr Command commands[] = {
    {bench::start, NmtState::operational, false},
    {bench::stop, NmtState::stopped, false},
    {bench::enter_pre_operational, NmtState::pre_operational, false},
    {bench::reset_node, NmtState::pre_operational, true},
    {bench::reset_communication, NmtState::pre_operational, true},
};

struct State {
  const char* command;  ///< enters the state
  bool sdo;             ///< SDO, SYNC and EMCY are served
  const char* heartbeat;
};

constexpr State states[] = {
    {bench::enter_pre_operational, true, "705 7F"},
    {bench::start, true, "705 05"},
    {bench::stop, false, "705 04"},
};

constexpr auto read_device_type = "605 40 00 10 00 00 00 00 00";

// shows 000.29, 000.33, 000.43, 000.101, 001.14, 002.45, 002.194, 003.4, 004.104, 004.106
TYPED_TEST(EveryDevice, SendsTheBootUpMessageAndEntersPreOperationalByItself) {
  bench::RecordingBus bus;
  bench::NodeOf<typename TestFixture::Device, bench::RecordingBus> node{bus, canopen::NodeId{5}};
  node.on_frame(bench::frame(read_device_type), {});
  node.on_frame(bench::frame(bench::start), {});
  EXPECT_EQ(bus.take(), "");
  node.start({});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(node.state(), NmtState::pre_operational);
  node.on_time(canopen::TimePoint{} + 1s);
  EXPECT_EQ(bus.take(), "");
}

// shows 000.30, 000.31, 001.1, 001.15, 002.47, 003.5..003.10, 003.15, 004.103..004.105, 001.88, 004.136, 004.163
TYPED_TEST(EveryDevice, FollowsEachNmtCommandInEachState) {
  for (const State& from : states) {
    for (const Command& command : commands) {
      SCOPED_TRACE(std::string{from.command} + ", then " + command.frame);
      bench::Bench<typename TestFixture::Device> device;
      device.ask(from.command);
      const std::string sent = device.ask(command.frame);
      EXPECT_EQ(device.node.state(), command.target);
      if (command.resets || command.target != NmtState::operational) {
        const std::string announced = from.sdo ? TypeParam::announced_reset : "";
        EXPECT_EQ(sent, command.resets ? announced + "705 00" : "");
      }
    }
  }
}

// shows 000.14, 001.2, 001.3, 002.1, 002.48, 003.11
TYPED_TEST(EveryDevice, FollowsNmtCommandsToItAndToAllOfAnyLength) {
  bench::Bench<typename TestFixture::Device> device;
  device.ask("000 01 06");
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
  device.ask("000 01 00");
  EXPECT_EQ(device.node.state(), NmtState::operational);
  device.ask("000 02 7F");
  EXPECT_EQ(device.node.state(), NmtState::operational);
  device.ask("000 02 05 AA AA AA AA AA AA");
  EXPECT_EQ(device.node.state(), NmtState::stopped);
  EXPECT_EQ(device.ask("000 81 00 00 00 00 00 00 00"), "705 00");
}

// shows 000.36, 000.37, 001.16, 002.53, 003.13, 004.27, 004.105, 000.45, 001.8, 004.26, 002.193
TYPED_TEST(EveryDevice, ServesSdoButInStopped) {
  for (const State& state : states) {
    SCOPED_TRACE(state.command);
    bench::Bench<typename TestFixture::Device> device;
    device.ask(state.command);
    EXPECT_EQ(device.ask(read_device_type), state.sdo ? TypeParam::device_type : "");
    EXPECT_EQ(device.ask("606 40 00 10 00 00 00 00 00"), "");
  }
}

// shows 000.34, 000.36, 000.129, 002.51, 003.14, 004.101, 004.105, 002.198
TYPED_TEST(EveryDevice, TakesSyncButInStopped) {
  for (const State& state : states) {
    SCOPED_TRACE(state.command);
    int syncs = 0;
    auto device = bench::with<typename TestFixture::Device>(canopen::on_sync([&](std::uint8_t) { ++syncs; }));
    device.ask(state.command);
    device.ask("080");
    EXPECT_EQ(syncs, state.sdo ? 1 : 0);
  }
}

// shows 000.34, 000.36, 000.38, 000.108, 002.51, 003.14, 003.67, 004.101, 004.109, 001.43, 002.187
TYPED_TEST(EveryDevice, SendsEmcyButInStopped) {
  for (const State& state : states) {
    SCOPED_TRACE(state.command);
    bench::Bench<typename TestFixture::Device> device;
    device.ask(state.command);
    device.node.emergency(0x5000, ErrorRegister::manufacturer);
    const std::string sent = device.pass(0s);
    EXPECT_EQ(sent, state.sdo ? "085 00 50 81 00 00 00 00 00" : "");
    EXPECT_EQ(device.ask(bench::enter_pre_operational), state.sdo ? "" : "085 00 50 81 00 00 00 00 00");
  }
}

// shows 000.42, 001.22, 002.53, 002.60, 003.89, 004.102, 004.107
TYPED_TEST(EveryDevice, SendsItsStateAsHeartbeatInEachState) {
  for (const State& state : states) {
    SCOPED_TRACE(state.command);
    bench::Bench<typename TestFixture::Device> device;
    device.ask("605 23 00 18 01 05 00 00 80");  // TPDO1 is not valid: only the heartbeat is sent
    for (std::uint16_t index = 0x1800; index <= 0x1803; ++index) manual::write(device, index, 1, 4, 0xC0000000);
    device.ask(state.command);
    EXPECT_EQ(device.node.set(0x1017, 0, std::array<std::uint8_t, 2>{100, 0}), canopen::ok);
    const std::string at_once = device.pass(0s);
    EXPECT_EQ(at_once, state.heartbeat);
    EXPECT_EQ(device.pass(99ms), "");
    EXPECT_EQ(device.pass(1ms), state.heartbeat);
  }
}

// shows 000.40, 000.136, 001.22, 002.59, 003.89, 003.90, 004.78
// shows 000.221
TYPED_TEST(EveryDevice, StartsChangesAndEndsTheHeartbeatAtOnce) {
  bench::Bench<typename TestFixture::Device> device;
  EXPECT_EQ(device.pass(10s), "");
  EXPECT_EQ(device.ask("605 2B 17 10 00 E8 03 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(device.pass(1s), "705 7F");
  EXPECT_EQ(device.ask("605 2B 17 10 00 64 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(device.pass(200ms), "705 7F | 705 7F");
  EXPECT_EQ(device.ask("605 2B 17 10 00 00 00 00 00"), "585 60 17 10 00 00 00 00 00");
  EXPECT_EQ(device.pass(10s), "");
}

// shows 000.60, 000.61, 000.64, 001.9, 001.13, 002.9, 002.15, 002.19, 002.20, 002.26, 003.28, 003.31, 004.30, 004.31
// shows 004.34, 004.35, 001.85, 004.119
TYPED_TEST(EveryDevice, AbortsWhatItCannotDo) {
  bench::Bench<typename TestFixture::Device> device;
  EXPECT_EQ(device.ask("605 40 FE 1F 07 00 00 00 00"), "585 80 FE 1F 07 00 00 02 06");
  EXPECT_EQ(device.ask("605 2F FE 1F 07 00 00 00 00"), "585 80 FE 1F 07 00 00 02 06");
  EXPECT_EQ(device.ask("605 40 18 10 05 00 00 00 00"), "585 80 18 10 05 11 00 09 06");
  EXPECT_EQ(device.ask("605 23 18 10 05 00 00 00 00"), "585 80 18 10 05 11 00 09 06");
  EXPECT_EQ(device.ask("605 23 00 10 00 00 00 00 00"), "585 80 00 10 00 02 00 01 06");
  EXPECT_EQ(device.ask("605 23 18 10 01 00 00 00 00"), "585 80 18 10 01 02 00 01 06");
  EXPECT_EQ(device.ask("605 23 00 12 01 00 00 00 00"), "585 80 00 12 01 02 00 01 06");
  EXPECT_EQ(device.ask("605 E0 00 10 00 00 00 00 00"), "585 80 00 10 00 01 00 04 05");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00").substr(16), "01 00 04 05");
}

// shows 000.1, 001.5, 002.5, 003.110
TYPED_TEST(EveryDevice, IgnoresExtendedFrames) {
  bench::Bench<typename TestFixture::Device> device;
  EXPECT_EQ(device.ask("00000605 40 00 10 00 00 00 00 00"), "");
  EXPECT_EQ(device.ask("00000000 01 05"), "");
  EXPECT_EQ(device.node.state(), NmtState::pre_operational);
}

// shows 000.9, 001.4, 002.1
TYPED_TEST(EveryDevice, TakesNodeIds1To127) {
  EXPECT_FALSE(canopen::NodeId::from(0));
  EXPECT_FALSE(canopen::NodeId::from(128));
  bench::RecordingBus bus;
  bench::NodeOf<typename TestFixture::Device, bench::RecordingBus> first{bus, canopen::NodeId{1}};
  bench::NodeOf<typename TestFixture::Device, bench::RecordingBus> last{bus, canopen::NodeId{127}};
  first.start({});
  last.start({});
  EXPECT_EQ(bus.take(), "701 00 | 77F 00");
}

// shows 000.102, 000.103, 000.105, 003.70, 004.112, 002.32
TYPED_TEST(EveryDevice, TellsErrorsOnceAndWhatIsLeftWhenOneGoes) {
  bench::Bench<typename TestFixture::Device> device;
  device.node.emergency(0x5000, ErrorRegister::manufacturer);
  EXPECT_EQ(device.pass(10s), "085 00 50 81 00 00 00 00 00");
  device.node.emergency(0x8100, ErrorRegister::communication);
  EXPECT_EQ(device.pass(10s), "085 00 81 91 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::manufacturer);
  EXPECT_EQ(device.pass(10s), "085 00 00 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 01 10 00 00 00 00 00").substr(16), "11 00 00 00");
  device.node.emergency_over(ErrorRegister::communication);
  EXPECT_EQ(device.pass(10s), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 01 10 00 00 00 00 00").substr(16), "00 00 00 00");
}

// shows 000.106
TYPED_TEST(EveryDevice, AResetForgetsItsErrors) {
  bench::Bench<typename TestFixture::Device> device;
  device.node.emergency(0x5000, ErrorRegister::manufacturer);
  device.pass(0s);
  EXPECT_TRUE(device.ask(bench::reset_communication).ends_with("705 00"));
  EXPECT_EQ(device.ask("605 40 01 10 00 00 00 00 00").substr(16), "00 00 00 00");
}

/// The abort codes that the manuals list and that only an application uses.
constexpr std::uint32_t application_codes[] = {
    0x0601'0000, 0x0604'0043, 0x0604'0047, 0x0606'0000, 0x0609'0036, 0x060A'0023, 0x0800'0000,
    0x0800'0020, 0x0800'0021, 0x0800'0022, 0x0800'0023, 0x0800'0024, 0x0800'1234,
};

// shows 000.65, 002.17, 002.23, 002.28, 002.29, 003.29, 004.40
TEST(AbortCodes, AnApplicationAnswersWithEachOfThem) {
  std::uint32_t code = 0;
  auto device = bench::with<can_2057c::Device>(canopen::on_write<can_2057c::od::guard_time>(
      [&](can_2057c::od::guard_time::type) { return static_cast<AbortCode>(code); }));
  for (const std::uint32_t one : application_codes) {
    code = one;
    EXPECT_EQ(device.ask("605 2B 0C 10 00 01 00 00 00"), manual::refused(0x100C, 0, one));
  }
}

}  // namespace

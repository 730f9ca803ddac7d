/// Manual 004, the position sensor RK5C: LSS.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/host/memory_storage.hpp>
#include <iterator>
#include <rk5c/device.hpp>
#include <string>

#include "manual_bench.hpp"
#include "support/omitting.hpp"

namespace {

using manual::write;
namespace od = rk5c::od;
using namespace std::chrono_literals;

/// Node-ID 1..127 only, no Fastscan; served in the states with communication objects (3.2, 6.1).
constexpr canopen::LssOptions lss{
    .unconfigurable = false, .fastscan = false, .served_in_stopped = false, .served_in_operational = true};

/// What the sensor retains without power.
struct Memory {
  canopen::NodeId node_id{5};
  canopen::LssBitTiming bit_timing{0, 4};  // 125 kbit/s
  canopen::MemoryStorage parameters;
};

struct Port {
  Memory& memory;
  std::string log;  ///< stops and starts of the CAN controller

  canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssError store(canopen::NodeId node_id, canopen::LssBitTiming bit_timing) {
    memory.node_id = node_id;
    memory.bit_timing = bit_timing;
    return canopen::lss::success;
  }
  canopen::LssBitTiming bit_timing() { return memory.bit_timing; }
  void stop_communication() { log += "stop "; }
  void start_communication(canopen::LssBitTiming timing) { log += std::to_string(timing.index) + " "; }
};

/// The sensor with its memory, switched on; its boot-up message has been removed.
struct LssSensor {
  explicit LssSensor(Memory& memory)
      : port{memory, {}},
        node{bus, memory.node_id, canopen::stored_in(memory.parameters), canopen::configured_by_lss<lss>(port)} {
    node.start(now);
    static_cast<void>(node.set<od::identity_object::serial_number>(0x1501'1234));  // of this sensor
    bus.take();
  }

  std::string ask(const std::string& request) {
    node.on_frame(bench::frame(request), now);
    return bus.take();
  }
  void pass(canopen::Duration span) {
    now = now + span;
    node.on_time(now);
  }

  Port port;
  bench::RecordingBus bus;
  canopen::TimePoint now{};
  bench::NodeOf<rk5c::Device, bench::RecordingBus, canopen::StoredIn<canopen::MemoryStorage>,
                canopen::LssHandler<lss, Port>>
      node;
};

constexpr auto to_configuration = "7E5 04 01 00 00 00 00 00 00";
constexpr auto to_waiting = "7E5 04 00 00 00 00 00 00 00";
constexpr auto inquire_node_id = "7E5 5E 00 00 00 00 00 00 00";

// shows 004.1, 004.2, 004.20
TEST(Manual004, AnswersLssAt7E4hInConfigurationStateOnly) {
  Memory memory;
  LssSensor sensor{memory};
  EXPECT_EQ(sensor.ask(inquire_node_id), "");
  EXPECT_EQ(sensor.ask(to_configuration), "");
  EXPECT_EQ(sensor.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 5E"), "");
  EXPECT_EQ(sensor.ask("7E4 5E 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(sensor.ask(to_waiting), "");
  EXPECT_EQ(sensor.ask(inquire_node_id), "");
}

// No service inquires the bit rate or changes the LSS address.
// shows 004.117
TEST(Manual004, IgnoresOtherLssCommands) {
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  constexpr unsigned served[] = {0x04, 0x11, 0x13, 0x15, 0x17, 0x40, 0x41, 0x42, 0x43, 0x46, 0x47,
                                 0x48, 0x49, 0x4A, 0x4B, 0x4C, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E};
  for (unsigned command = 0; command <= 0xFF; ++command) {
    if (std::ranges::find(served, command) != std::end(served)) continue;
    char request[32];
    std::snprintf(request, sizeof request, "7E5 %02X 00 00 00 00 00 00 00", command);
    EXPECT_EQ(sensor.ask(request), "") << request;
  }
}

// shows 004.3, 004.4, 004.5, 004.114
TEST(Manual004, IsSelectedByItsIdentityAlone) {
  struct Row {
    const char *vendor, *product, *revision, *serial, *answer;
  };
  constexpr Row rows[] = {
      {"93 00 00 00", "52 4B 35 43", "01 00 01 00", "34 12 01 15", "7E4 44 00 00 00 00 00 00 00"},
      {"94 00 00 00", "52 4B 35 43", "01 00 01 00", "34 12 01 15", ""},
      {"93 00 00 00", "52 4B 35 53", "01 00 01 00", "34 12 01 15", ""},
      {"93 00 00 00", "52 4B 35 43", "02 00 01 00", "34 12 01 15", ""},
      {"93 00 00 00", "52 4B 35 43", "01 00 01 00", "35 12 01 15", ""},
  };
  for (const auto& [vendor, product, revision, serial, answer] : rows) {
    Memory memory;
    LssSensor sensor{memory};
    EXPECT_EQ(sensor.ask(std::string{"7E5 40 "} + vendor + " 00 00 00"), "");
    EXPECT_EQ(sensor.ask(std::string{"7E5 41 "} + product + " 00 00 00"), "");
    EXPECT_EQ(sensor.ask(std::string{"7E5 42 "} + revision + " 00 00 00"), "");
    EXPECT_EQ(sensor.ask(std::string{"7E5 43 "} + serial + " 00 00 00"), answer);
    EXPECT_EQ(sensor.ask(inquire_node_id), *answer != 0 ? "7E4 5E 05 00 00 00 00 00 00" : "");
  }
}

// shows 004.5, 004.21
TEST(Manual004, TellsTheIdentityOf1018h) {
  struct Row {
    const char *inquiry, *upload, *bytes;
  };
  constexpr Row rows[] = {
      {"7E5 5A 00 00 00 00 00 00 00", "605 40 18 10 01 00 00 00 00", "93 00 00 00"},
      {"7E5 5B 00 00 00 00 00 00 00", "605 40 18 10 02 00 00 00 00", "52 4B 35 43"},
      {"7E5 5C 00 00 00 00 00 00 00", "605 40 18 10 03 00 00 00 00", "01 00 01 00"},
      {"7E5 5D 00 00 00 00 00 00 00", "605 40 18 10 04 00 00 00 00", "34 12 01 15"},
  };
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  for (const auto& [inquiry, upload, bytes] : rows) {
    EXPECT_EQ(sensor.ask(inquiry), std::string{"7E4 "} + std::string{inquiry}.substr(4, 3) + bytes + " 00 00 00");
    EXPECT_EQ(sensor.ask(upload).substr(16), bytes);
  }
}

// shows 004.8, 004.9, 004.116
TEST(Manual004, TakesNodeIds1To127) {
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  for (unsigned node_id = 0; node_id <= 255; ++node_id) {
    char request[32];
    std::snprintf(request, sizeof request, "7E5 11 %02X 00 00 00 00 00 00", node_id);
    const bool good = node_id >= 1 && node_id <= 127;
    EXPECT_EQ(sensor.ask(request), good ? "7E4 11 00 00 00 00 00 00 00" : "7E4 11 01 00 00 00 00 00 00") << node_id;
  }
}

// shows 004.10, 004.11, 004.13, 004.118, 004.169
TEST(Manual004, UsesANodeIdAfterResetCommunicationAndForgetsItWithoutStore) {
  Memory memory;
  {
    LssSensor sensor{memory};
    sensor.ask(to_configuration);
    EXPECT_EQ(sensor.ask("7E5 11 7E 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
    EXPECT_EQ(sensor.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
    sensor.ask(to_waiting);
    EXPECT_EQ(sensor.ask("605 40 00 10 00 00 00 00 00"), "585 42 00 10 00 96 01 0A 00");
    EXPECT_EQ(sensor.ask(bench::reset_communication), "77E 00");
    EXPECT_EQ(sensor.ask("67E 40 00 10 00 00 00 00 00"), "5FE 42 00 10 00 96 01 0A 00");
  }
  EXPECT_EQ(LssSensor{memory}.node.node_id(), canopen::NodeId{5});
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  sensor.ask("7E5 11 7E 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  EXPECT_EQ(LssSensor{memory}.node.node_id(), canopen::NodeId{126});
}

// shows 004.12, 004.118, 004.132, 004.133
TEST(Manual004, HasTheDefaultCobIdsOfANewNodeId) {
  constexpr auto with_own_cob_ids = [](LssSensor& sensor) {
    write(sensor, 0x1005, 0, 4, 0xA0);
    write(sensor, 0x1014, 0, 4, 0x8000'0085);
    write(sensor, 0x1014, 0, 4, 0x690);
    write(sensor, 0x1800, 1, 4, 0x8000'0185);
    write(sensor, 0x1800, 1, 4, 0x333);
    EXPECT_EQ(sensor.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
    sensor.ask(to_configuration);
    sensor.ask("7E5 11 09 00 00 00 00 00 00");
  };
  constexpr auto expect_defaults = [](LssSensor& sensor) {
    EXPECT_EQ(sensor.ask("609 40 05 10 00 00 00 00 00"), "589 42 05 10 00 80 00 00 00");
    EXPECT_EQ(sensor.ask("609 40 14 10 00 00 00 00 00"), "589 42 14 10 00 89 00 00 00");
    EXPECT_EQ(sensor.ask("609 40 00 12 01 00 00 00 00"), "589 42 00 12 01 09 06 00 00");
    EXPECT_EQ(sensor.ask("609 40 00 12 02 00 00 00 00"), "589 42 00 12 02 89 05 00 00");
    EXPECT_EQ(sensor.ask("609 40 00 18 01 00 00 00 00"), "589 42 00 18 01 89 01 00 00");
  };
  Memory memory;
  LssSensor reset{memory};
  with_own_cob_ids(reset);
  EXPECT_EQ(reset.ask(bench::reset_communication), "709 00");
  expect_defaults(reset);

  Memory other;
  LssSensor stored{other};
  with_own_cob_ids(stored);
  EXPECT_EQ(stored.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  LssSensor powered{other};
  expect_defaults(powered);
}

// shows 004.14, 004.15
TEST(Manual004, TakesTheBitRatesOfTable2) {
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  for (unsigned index = 0; index <= 255; ++index) {
    char request[32];
    std::snprintf(request, sizeof request, "7E5 13 00 %02X 00 00 00 00 00", index);
    const bool good = index <= 8 && index != 5;
    EXPECT_EQ(sensor.ask(request), good ? "7E4 13 00 00 00 00 00 00 00" : "7E4 13 01 00 00 00 00 00 00") << index;
  }
}

// shows 004.16, 004.17, 004.19
TEST(Manual004, KeepsABitRateBeyondPowerOffWhenItIsStored) {
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  EXPECT_EQ(sensor.ask("7E5 13 00 02 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
  EXPECT_EQ(sensor.port.log, "");
  EXPECT_EQ(sensor.ask("7E5 15 0A 00 00 00 00 00 00"), "");
  sensor.pass(10ms);
  sensor.pass(10ms);
  EXPECT_EQ(sensor.port.log, "stop 2 ");
  EXPECT_EQ(memory.bit_timing, (canopen::LssBitTiming{0, 4}));
  EXPECT_EQ(sensor.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  EXPECT_EQ(memory.bit_timing, (canopen::LssBitTiming{0, 2}));
}

// shows 004.18, 004.115
TEST(Manual004, SwitchesTheBitRateBetweenTwoDelays) {
  Memory memory;
  LssSensor sensor{memory};
  sensor.ask(to_configuration);
  sensor.ask("7E5 13 00 03 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 15 2C 01 00 00 00 00 00"), "");  // 300 ms: the delay has two bytes
  sensor.pass(299ms);
  EXPECT_EQ(sensor.port.log, "");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.port.log, "stop ");
  EXPECT_EQ(sensor.ask("605 40 00 10 00 00 00 00 00"), "");
  sensor.pass(299ms);
  EXPECT_EQ(sensor.port.log, "stop ");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.port.log, "stop 3 ");
}

// shows 004.22, 004.23, 004.167
TEST(Manual004, IdentifiesItselfWithinTheRanges) {
  struct Row {
    const char *vendor, *product, *low_revision, *high_revision, *low_serial, *high_serial;
    bool found;
  };
  constexpr Row rows[] = {
      {"93 00 00 00", "52 4B 35 43", "01 00 01 00", "01 00 01 00", "34 12 01 15", "34 12 01 15", true},
      {"93 00 00 00", "52 4B 35 43", "00 00 00 00", "FF FF FF FF", "00 00 00 00", "FF FF FF FF", true},
      {"94 00 00 00", "52 4B 35 43", "00 00 00 00", "FF FF FF FF", "00 00 00 00", "FF FF FF FF", false},
      {"93 00 00 00", "53 4B 35 43", "00 00 00 00", "FF FF FF FF", "00 00 00 00", "FF FF FF FF", false},
      {"93 00 00 00", "52 4B 35 43", "00 00 02 00", "FF FF FF FF", "00 00 00 00", "FF FF FF FF", false},
      {"93 00 00 00", "52 4B 35 43", "00 00 00 00", "FF FF 00 00", "00 00 00 00", "FF FF FF FF", false},
      {"93 00 00 00", "52 4B 35 43", "00 00 00 00", "FF FF FF FF", "35 12 01 15", "FF FF FF FF", false},
      {"93 00 00 00", "52 4B 35 43", "00 00 00 00", "FF FF FF FF", "00 00 00 00", "33 12 01 15", false},
  };
  Memory memory;
  LssSensor sensor{memory};
  for (const Row& row : rows) {
    sensor.ask(std::string{"7E5 46 "} + row.vendor + " 00 00 00");
    sensor.ask(std::string{"7E5 47 "} + row.product + " 00 00 00");
    sensor.ask(std::string{"7E5 48 "} + row.low_revision + " 00 00 00");
    sensor.ask(std::string{"7E5 49 "} + row.high_revision + " 00 00 00");
    EXPECT_EQ(sensor.ask(std::string{"7E5 4A "} + row.low_serial + " 00 00 00"), "");
    EXPECT_EQ(sensor.ask(std::string{"7E5 4B "} + row.high_serial + " 00 00 00"),
              row.found ? "7E4 4F 00 00 00 00 00 00 00" : "");
  }
}

// shows 004.24, 004.116
TEST(Manual004, IdentifiesItselfAsNonConfiguredWithoutNodeIdOnly) {
  Memory memory;
  LssSensor configured{memory};
  EXPECT_EQ(configured.ask("7E5 4C 00 00 00 00 00 00 00"), "");
  Memory factory_new{canopen::unconfigured_node_id, {0, 4}, {}};
  LssSensor sensor{factory_new};
  EXPECT_EQ(sensor.node.state(), canopen::NmtState::initialisation);
  EXPECT_EQ(sensor.ask("7E5 4C 00 00 00 00 00 00 00"), "7E4 50 00 00 00 00 00 00 00");
}

// shows 004.25, 004.137
TEST(Manual004, ServesLssButInStopped) {
  Memory memory;
  LssSensor sensor{memory};
  for (const char* command : {bench::enter_pre_operational, bench::start}) {
    sensor.ask(command);
    sensor.ask(to_configuration);
    EXPECT_EQ(sensor.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  }
  sensor.ask(bench::stop);
  sensor.ask(to_configuration);
  EXPECT_EQ(sensor.ask(inquire_node_id), "");
}

}  // namespace

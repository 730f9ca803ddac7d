/// Manual 004: the position sensor RK5C as node 5.
#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <rk5c/device.hpp>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
namespace od = rk5c::od;
using namespace std::chrono_literals;

using Sensor = bench::Bench<rk5c::Device>;
using Position = od::position_values_for_multi_sensor_devices<1>;
using Speed = od::speed_value<1>;

constexpr std::uint32_t invalid_value = 0x0609'0030;

// Object dictionary

// shows 004.26, 004.42, 004.54, 004.79..004.81, 004.91, 004.93, 004.95, 004.119..004.121, 004.123, 004.126..004.131
TEST(Manual004, HasTheObjectsOf41) {
  constexpr manual::Entry entries[] = {
      {0x1000, 0, 4, ro, 0x000A'0196}, {0x1001, 0, 1, ro, 0},           {0x1005, 0, 4, rw, 0x80},
      {0x1010, 0, 1, ro, 1},           {0x1010, 1, 4, rw, 1},           {0x1011, 0, 1, ro, 1},
      {0x1011, 1, 4, rw, 1},           {0x1014, 0, 4, rw, 0x85},        {0x1015, 0, 2, rw, 0},
      {0x1017, 0, 2, rw, 0},           {0x1018, 0, 1, ro, 4},           {0x1018, 1, 4, ro, 0x93},
      {0x1018, 2, 4, ro, 0x4335'4B52}, {0x1200, 0, 1, ro, 2},           {0x1200, 1, 4, ro, 0x605},
      {0x1200, 2, 4, ro, 0x585},       {0x1800, 0, 1, ro, 5},           {0x1800, 1, 4, rw, 0x185},
      {0x1800, 2, 1, rw, 254},         {0x1800, 5, 2, rw, 1},           {0x1A00, 0, 1, ro, 2},
      {0x1A00, 1, 4, ro, 0x6020'0120}, {0x1A00, 2, 4, ro, 0x6030'0110}, {0x2000, 0, 1, ro, 1},
      {0x6005, 0, 1, ro, 2},           {0x6005, 1, 4, ro, 100'000},     {0x6005, 2, 4, ro, 100},
      {0x6010, 0, 1, ro, 1},           {0x6010, 1, 4, rw, 0},           {0x6020, 0, 1, ro, 1},
      {0x6020, 1, 4, ro, 0},           {0x6030, 0, 1, ro, 1},           {0x6030, 1, 2, ro, 0},
      {0x6200, 0, 2, rw, 1},           {0x6501, 0, 4, ro, 100'000},
  };
  Sensor sensor;
  manual::expect_entries(sensor, entries, false);
}

// shows 004.38, 004.81, 004.99, 004.124, 004.125
TEST(Manual004, HasNoOtherEntries) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 40 18 10 05 00 00 00 00"), "585 80 18 10 05 11 00 09 06");
  EXPECT_EQ(sensor.ask("605 40 00 18 03 00 00 00 00"), "585 80 00 18 03 11 00 09 06");
  EXPECT_EQ(sensor.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(sensor.ask("605 40 10 10 02 00 00 00 00"), "585 80 10 10 02 11 00 09 06");
  EXPECT_EQ(sensor.ask("605 40 00 60 00 00 00 00 00"), "585 80 00 60 00 00 00 02 06");
  EXPECT_EQ(sensor.ask("605 40 00 65 00 00 00 00 00"), "585 80 00 65 00 00 00 02 06");
  EXPECT_EQ(sensor.ask("605 40 00 14 00 00 00 00 00"), "585 80 00 14 00 00 00 02 06");
}

// shows 004.33
TEST(Manual004, HasNoWriteOnlyEntry) {
  Sensor sensor;
  sensor.node.entries().dictionary().for_each_entry(
      [](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
        EXPECT_NE(word & canopen::entry::readable, 0u) << index << ":" << unsigned{sub_index};
      });
}

// shows 004.29, 004.67
TEST(Manual004, TellsItsName) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 40 08 10 00 00 00 00 00"), "585 42 08 10 00 52 4B 35 43");
}

// SDO

// shows 004.28, 004.29
TEST(Manual004, AnswersEveryExpeditedUploadWith42h) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 2F 00 18 02 FF AA AA AA"), "585 60 00 18 02 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 18 02 00 00 00 00"), "585 42 00 18 02 FF 00 00 00");
  EXPECT_EQ(sensor.ask("605 2B 17 10 00 00 00 AA AA"), "585 60 17 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 05 10 00 00 00 00 00"), "585 42 05 10 00 A0 00 00 00");
  EXPECT_EQ(sensor.ask("605 27 05 10 00 A0 00 00 00"), "585 80 05 10 00 10 00 07 06");  // no object has 3 bytes
}

// shows 004.37
TEST(Manual004, RefusesEveryWrongLengthAlike) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 2F 17 10 00 00 00 00 00"), "585 80 17 10 00 10 00 07 06");
  EXPECT_EQ(sensor.ask("605 23 17 10 00 00 00 00 00"), "585 80 17 10 00 10 00 07 06");
}

// shows 004.39
TEST(Manual004, HasNoEntryWithLimitsThatAWriteCanMiss) {
  Sensor sensor;
  sensor.node.entries().dictionary().for_each_entry(
      [](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
        if ((word & canopen::entry::writable) == 0) return;
        EXPECT_EQ(word & canopen::entry::limited, 0u) << index << ":" << unsigned{sub_index};
      });
  EXPECT_EQ(sensor.ask("605 2F 00 18 02 F1 00 00 00"), "585 80 00 18 02 30 00 09 06");
}

// COB-IDs

struct CanIdRange {
  std::uint32_t first;
  std::uint32_t last;
};

constexpr CanIdRange restricted[] = {{0x000, 0x000}, {0x001, 0x07F}, {0x101, 0x180}, {0x581, 0x5FF},
                                     {0x601, 0x67F}, {0x6E0, 0x6FF}, {0x701, 0x77F}, {0x780, 0x7FF}};
constexpr std::uint32_t free_can_ids[] = {0x080, 0x100, 0x181, 0x580, 0x600, 0x680, 0x6DF, 0x700};

// shows 004.58..004.66
TEST(Manual004, RefusesRestrictedCanIdsForSyncAndTpdo1) {
  Sensor sensor;
  write(sensor, 0x1800, 1, 4, 0x8000'0185);
  for (const auto& [first, last] : restricted) {
    for (std::uint32_t can_id = first; can_id <= last; ++can_id) {
      EXPECT_EQ(write(sensor, 0x1005, 0, 4, can_id), refused(0x1005, 0, invalid_value)) << can_id;
      EXPECT_EQ(write(sensor, 0x1800, 1, 4, can_id), refused(0x1800, 1, invalid_value)) << can_id;
    }
  }
  for (const std::uint32_t can_id : free_can_ids) {
    EXPECT_EQ(write(sensor, 0x1005, 0, 4, can_id), taken(0x1005, 0)) << can_id;
    EXPECT_EQ(write(sensor, 0x1800, 1, 4, can_id), taken(0x1800, 1)) << can_id;
    write(sensor, 0x1800, 1, 4, 0x8000'0000 | can_id);
  }
}

// shows 004.57, 004.75
TEST(Manual004, RefusesRestrictedCanIdsAndBits29And30ForEmcy) {
  Sensor sensor;
  write(sensor, 0x1014, 0, 4, 0x8000'0085);
  EXPECT_EQ(write(sensor, 0x1014, 0, 4, 0x0000'0701), refused(0x1014, 0, invalid_value));
  EXPECT_EQ(write(sensor, 0x1014, 0, 4, 0x2000'0085), refused(0x1014, 0, invalid_value));
  EXPECT_EQ(write(sensor, 0x1014, 0, 4, 0x4000'0085), refused(0x1014, 0, invalid_value));
  for (const auto& [first, last] : restricted) {
    for (std::uint32_t can_id = first; can_id <= last; ++can_id) {
      EXPECT_EQ(write(sensor, 0x1014, 0, 4, can_id), refused(0x1014, 0, invalid_value)) << can_id;
    }
  }
  for (const std::uint32_t can_id : free_can_ids) {
    EXPECT_EQ(write(sensor, 0x1014, 0, 4, can_id), taken(0x1014, 0)) << can_id;
    write(sensor, 0x1014, 0, 4, 0x8000'0000 | can_id);
  }
}

// shows 004.55, 000.119
TEST(Manual004, ProducesNoSync) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 23 05 10 00 80 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(sensor.ask("605 23 05 10 00 80 00 00 20"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(sensor.ask("605 23 05 10 00 80 08 00 00"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(sensor.ask("605 23 05 10 00 80 00 00 80"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(sensor.pass(10s), "");
}

// shows 004.56
TEST(Manual004, ListensToTheSyncOf1005h) {
  Sensor sensor;
  sensor.ask("605 2F 00 18 02 01 00 00 00");
  sensor.ask("605 23 05 10 00 A0 00 00 00");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.ask("080"), "");
  EXPECT_EQ(sensor.ask("0A0"), "185 00 00 00 00 00 00");
}

// shows 004.76
TEST(Manual004, SendsEmcyAtTheCobIdOf1014hOrNotAtAll) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 23 14 10 00 85 00 00 80"), "585 60 14 10 00 00 00 00 00");
  sensor.node.emergency(0x5000, ErrorRegister::manufacturer);
  EXPECT_EQ(sensor.pass(1s), "");
  EXPECT_EQ(sensor.ask("605 23 14 10 00 90 00 00 00"), "585 60 14 10 00 00 00 00 00");
  sensor.node.emergency_over(ErrorRegister::manufacturer);
  EXPECT_EQ(sensor.pass(1s), "090 00 00 00 00 00 00 00 00");
}

// shows 004.83
TEST(Manual004, MovesTpdo1AndItsRemoteFrame) {
  Sensor sensor;
  sensor.ask("605 2F 00 18 02 FD 00 00 00");
  EXPECT_EQ(sensor.ask("605 23 00 18 01 85 01 00 80"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 23 00 18 01 33 03 00 00"), "585 60 00 18 01 00 00 00 00");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.ask("185 R 0"), "");
  EXPECT_EQ(sensor.ask("333 R 0"), "333 00 00 00 00 00 00");
}

TEST(Manual004, HasNoTpdo1WhileItIsNotValid) {
  Sensor sensor;
  sensor.ask("605 23 00 18 01 85 01 00 80");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.pass(1s), "");
  EXPECT_EQ(sensor.ask("605 23 00 18 01 85 01 00 20"), "585 80 00 18 01 30 00 09 06");
}

// shows 004.82
TEST(Manual004, RefusesBit30InTheCobIdOfTpdo1) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 23 00 18 01 85 01 00 40"), "585 80 00 18 01 30 00 09 06");
}

// TPDO1

// shows 004.84
TEST(Manual004, RefusesReservedTransmissionTypes) {
  Sensor sensor;
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool reserved = type >= 241 && type <= 251;
    EXPECT_EQ(write(sensor, 0x1800, 2, 1, type), reserved ? refused(0x1800, 2, invalid_value) : taken(0x1800, 2));
  }
}

// shows 004.85
TEST(Manual004, SendsTypeNAtEveryNthSync) {
  for (const std::uint32_t type : {1u, 2u, 240u}) {
    Sensor sensor;
    write(sensor, 0x1800, 2, 1, type);
    sensor.ask(bench::start);
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t sync = 1; sync < type; ++sync) EXPECT_EQ(sensor.ask("080"), "") << type << ", " << sync;
      EXPECT_EQ(sensor.ask("080"), "185 00 00 00 00 00 00") << type;
    }
  }
}

// shows 004.86, 004.135
TEST(Manual004, SendsType0AtTheSyncAfterAChange) {
  Sensor sensor;
  write(sensor, 0x1800, 2, 1, 0);
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.ask("080"), "");
  sensor.node.set<Position>(1);
  EXPECT_EQ(sensor.pass(1s), "");
  EXPECT_EQ(sensor.ask("080"), "185 01 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("080"), "");
}

// shows 004.87
TEST(Manual004, SendsTypes252And253WhenAsked) {
  for (const std::uint32_t type : {252u, 253u}) {
    Sensor sensor;
    write(sensor, 0x1800, 2, 1, type);
    sensor.ask(bench::start);
    sensor.node.set<Position>(1);
    EXPECT_EQ(sensor.pass(1s), "");
    EXPECT_EQ(sensor.ask("080"), "");
    EXPECT_EQ(sensor.ask("185 R 0"), "185 01 00 00 00 00 00");
  }
}

// shows 004.88, 004.134
TEST(Manual004, SendsTypes254And255EachTimeTheEventTimerElapses) {
  for (const std::uint32_t type : {254u, 255u}) {
    Sensor sensor;
    write(sensor, 0x1800, 2, 1, type);
    write(sensor, 0x1800, 5, 2, 10);
    EXPECT_EQ(sensor.ask(bench::start), "");
    sensor.node.set<Position>(1);
    EXPECT_EQ(sensor.pass(9ms), "");
    EXPECT_EQ(sensor.pass(1ms), "185 01 00 00 00 00 00");
    EXPECT_EQ(sensor.pass(10ms), "185 01 00 00 00 00 00");
  }
}

// shows 004.89
TEST(Manual004, SendsNothingWithAnEventTimerOf0) {
  Sensor sensor;
  write(sensor, 0x1800, 5, 2, 0);
  sensor.ask(bench::start);
  sensor.node.set<Position>(1);
  EXPECT_EQ(sensor.pass(1s), "");
}

// shows 004.36, 004.91, 004.123
TEST(Manual004, HasAFixedMapping) {
  Sensor sensor;
  sensor.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(sensor.ask("605 2F 00 1A 00 00 00 00 00"), "585 80 00 1A 00 02 00 01 06");
  EXPECT_EQ(sensor.ask("605 23 00 1A 01 10 01 30 60"), "585 80 00 1A 01 02 00 01 06");
}

// shows 004.92, 004.94
TEST(Manual004, SdoAndTpdo1CarryTheSameValues) {
  Sensor sensor;
  sensor.node.set<Position>(-200);
  sensor.node.set<Speed>(-300);
  EXPECT_EQ(sensor.ask("605 40 20 60 01 00 00 00 00"), "585 42 20 60 01 38 FF FF FF");
  EXPECT_EQ(sensor.ask("605 40 30 60 01 00 00 00 00"), "585 42 30 60 01 D4 FE 00 00");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.pass(1ms), "185 38 FF FF FF D4 FE");
}

// shows 004.100, 004.105
TEST(Manual004, SendsTpdo1InOperationalOnly) {
  Sensor sensor;
  EXPECT_EQ(sensor.pass(10ms), "");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.pass(1ms), "185 00 00 00 00 00 00");
  sensor.ask(bench::stop);
  EXPECT_EQ(sensor.pass(10ms), "");
  EXPECT_EQ(sensor.ask("185 R 0"), "");
}

// EMCY

// shows 004.43, 004.109..004.112
TEST(Manual004, TellsDataSetAndHardwareErrors) {
  Sensor sensor;
  sensor.node.emergency(0x6300, ErrorRegister::generic);
  EXPECT_EQ(sensor.pass(1s), "085 00 63 01 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 01 10 00 00 00 00 00"), "585 42 01 10 00 01 00 00 00");
  sensor.node.emergency(0x5000, ErrorRegister::manufacturer);
  EXPECT_EQ(sensor.pass(1s), "085 00 50 81 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 01 10 00 00 00 00 00"), "585 42 01 10 00 81 00 00 00");
  sensor.node.emergency_over(ErrorRegister::manufacturer);
  EXPECT_EQ(sensor.pass(1s), "085 00 00 01 00 00 00 00 00");
  sensor.node.emergency_over(ErrorRegister::generic);
  EXPECT_EQ(sensor.pass(1s), "085 00 00 00 00 00 00 00 00");
}

TEST(Manual004, KeepsTheInhibitTimeOfEmcy) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 2B 15 10 00 0A 00 00 00"), "585 60 15 10 00 00 00 00 00");  // 1 ms
  sensor.node.emergency(0x6300, ErrorRegister::generic);
  sensor.node.emergency(0x5000, ErrorRegister::manufacturer);
  EXPECT_EQ(sensor.pass(999us), "085 00 63 01 00 00 00 00 00");
  EXPECT_EQ(sensor.pass(1us), "085 00 50 81 00 00 00 00 00");
}

// shows 004.77
TEST(Manual004, TakesInhibitTimesOfWholeMillisecondsOnly) {
  Sensor sensor;
  EXPECT_EQ(write(sensor, 0x1015, 0, 2, 15), refused(0x1015, 0, invalid_value));
  EXPECT_EQ(write(sensor, 0x1015, 0, 2, 65535), refused(0x1015, 0, invalid_value));
  EXPECT_EQ(write(sensor, 0x1015, 0, 2, 65530), taken(0x1015, 0));
  EXPECT_EQ(write(sensor, 0x1015, 0, 2, 0), taken(0x1015, 0));
}

// LSS

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
  canopen::Node<rk5c::Device, bench::RecordingBus, canopen::StoredIn<canopen::MemoryStorage>,
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

// shows 004.10, 004.11, 004.13, 004.118
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

// shows 004.22, 004.23
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

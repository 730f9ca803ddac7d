/// Manual 004, the position sensor RK5C as node 5: object dictionary, SDO, COB-IDs, TPDO1 and EMCY.
#include <gtest/gtest.h>

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
// shows 004.143, 004.150..004.152, 004.155..004.157, 004.159
TEST(Manual004, HasTheObjectsOf41) {
  constexpr manual::Entry entries[] = {
      {0x1000, 0, 4, ro, 0x000A'0196}, {0x1001, 0, 1, ro, 0},           {0x1005, 0, 4, rw, 0x80},
      {0x1002, 0, 4, ro, 1},           {0x1018, 3, 4, ro, 0x0001'0001}, {0x1018, 4, 4, ro, 0},
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

// shows 004.38, 004.81, 004.99, 004.124, 004.125, 004.160
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

// shows 004.29, 004.67, 004.151
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

// shows 004.113, 004.151, 004.153
TEST(Manual004, HasReadOnlyStringsForItsVersions) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("605 40 09 10 00 00 00 00 00"), "585 42 09 10 00 31 2E 30 00");
  EXPECT_EQ(sensor.ask("605 40 0A 10 00 00 00 00 00"), "585 42 0A 10 00 31 2E 30 00");
  for (const unsigned string : {0x1008u, 0x1009u, 0x100Au}) {
    const auto index = static_cast<std::uint16_t>(string);
    EXPECT_EQ(write(sensor, index, 0, 4, 0), refused(index, 0, 0x0601'0002));
  }
}

/// The value ranges of the entry descriptions of 4.2.
template <class Object>
constexpr bool has_range(std::int64_t low, std::int64_t high) {
  return canopen::low_limit<Object>() == low && canopen::high_limit<Object>() == high;
}
constexpr std::int64_t lowest_32 = -2147483648;
constexpr std::int64_t highest_32 = 2147483647;
static_assert(has_range<od::device_type>(0x000A'0196, 0x000A'0196));
static_assert(has_range<od::error_register>(0x00, 0x81));
static_assert(has_range<od::manufacturer_status_register>(0x00, 0x7F));
static_assert(has_range<od::inhibit_time_emcy>(0, 0xFFFF));
static_assert(has_range<od::producer_heartbeat_time>(0, 0xFFFF));
static_assert(has_range<od::identity_object::vendor_id>(0x93, 0x93));
static_assert(has_range<od::identity_object::product_code>(0x4335'4B52, 0x4335'4B52));
static_assert(has_range<od::sdo_server_parameter::cob_id_client_to_server_rx>(0x601, 0x67F));
static_assert(has_range<od::sdo_server_parameter::cob_id_server_to_client_tx>(0x581, 0x5FF));
static_assert(has_range<od::tpdo_communication_parameter_1::transmission_type>(0, 255));  // 241..251 are rejected
static_assert(has_range<od::tpdo_communication_parameter_1::event_timer>(0, 0xFFFF));
static_assert(has_range<od::tpdo_mapping_parameter_1::mapping_entry_1>(0x6020'0120, 0x6020'0120));
static_assert(has_range<od::tpdo_mapping_parameter_1::mapping_entry_2>(0x6030'0110, 0x6030'0110));
static_assert(has_range<od::number_of_cursors>(1, 1));
static_assert(has_range<od::preset_values_for_multi_sensor_devices<1>>(lowest_32, highest_32));
static_assert(has_range<od::position_values_for_multi_sensor_devices<1>>(lowest_32, highest_32));
static_assert(has_range<od::speed_value<1>>(-32768, 32767));
static_assert(has_range<od::cyclic_timer>(0, 0xFFFF));
static_assert(!canopen::can_be_refused<od::cyclic_timer>, "the range of its type rejects no value");
static_assert(has_range<od::measuring_step>(100'000, 100'000));

// shows 004.171
TEST(Manual004, AcceptsTheWholeValueRanges) {
  Sensor sensor;
  for (const std::uint32_t value : {0x0000u, 0x0001u, 0xFFFFu}) {
    EXPECT_EQ(write(sensor, 0x1017, 0, 2, value).substr(0, 27), taken(0x1017, 0));
    EXPECT_EQ(write(sensor, 0x1800, 5, 2, value), taken(0x1800, 5));
    EXPECT_EQ(write(sensor, 0x6200, 0, 2, value), taken(0x6200, 0));
  }
  for (const std::uint32_t value : {0x8000'0000u, 0x7FFF'FFFFu}) {
    EXPECT_EQ(write(sensor, 0x6010, 1, 4, value), taken(0x6010, 1));
    EXPECT_EQ(sensor.ask("605 40 10 60 01 00 00 00 00"), manual::sdo("585", 0x42, 0x6010, 1, value));
  }
}

// shows 004.165
TEST(Manual004, HasNoNodeGuarding) {
  Sensor sensor;
  EXPECT_EQ(sensor.ask("705 R 1"), "");
  EXPECT_EQ(sensor.ask("605 40 0C 10 00 00 00 00 00"), "585 80 0C 10 00 00 00 02 06");
  EXPECT_EQ(sensor.ask("605 40 0D 10 00 00 00 00 00"), "585 80 0D 10 00 00 00 02 06");
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

// shows 004.57, 004.66, 004.75
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
  EXPECT_EQ(write(sensor, 0x1014, 0, 4, 0x80), refused(0x1014, 0, invalid_value)) << "a SYNC for the other nodes";
  for (const std::uint32_t can_id : free_can_ids) {
    if (can_id == 0x80) continue;
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

// shows 004.83, 004.162
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

// shows 004.85, 004.147
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
  sensor.node.set<Position>(canopen::raw(1));
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
    sensor.node.set<Position>(canopen::raw(1));
    EXPECT_EQ(sensor.pass(1s), "");
    EXPECT_EQ(sensor.ask("080"), "");
    EXPECT_EQ(sensor.ask("185 R 0"), "185 01 00 00 00 00 00");
  }
}

// shows 004.88, 004.134, 004.147
TEST(Manual004, SendsTypes254And255EachTimeTheEventTimerElapses) {
  for (const std::uint32_t type : {254u, 255u}) {
    Sensor sensor;
    write(sensor, 0x1800, 2, 1, type);
    write(sensor, 0x1800, 5, 2, 10);
    EXPECT_EQ(sensor.ask(bench::start), "");
    sensor.node.set<Position>(canopen::raw(1));
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
  sensor.node.set<Position>(canopen::raw(1));
  EXPECT_EQ(sensor.pass(1s), "");
}

// shows 004.36, 004.91, 004.123
TEST(Manual004, HasAFixedMapping) {
  Sensor sensor;
  sensor.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(sensor.ask("605 2F 00 1A 00 00 00 00 00"), "585 80 00 1A 00 02 00 01 06");
  EXPECT_EQ(sensor.ask("605 23 00 1A 01 10 01 30 60"), "585 80 00 1A 01 02 00 01 06");
}

// shows 004.92, 004.94, 004.161
TEST(Manual004, SdoAndTpdo1CarryTheSameValues) {
  Sensor sensor;
  sensor.node.set<Position>(canopen::raw(-200));
  sensor.node.set<Speed>(canopen::raw(-300));
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

// shows 004.43, 004.109..004.112, 004.168
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

}  // namespace

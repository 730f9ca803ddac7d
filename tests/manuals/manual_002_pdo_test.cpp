/// Manual 002, the servo drive CPD as node 5: PDOs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cpd/device.hpp>
#include <iterator>

#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::taken;
using manual::write;
namespace od = cpd::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpd::Device>;

constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr std::uint32_t read_only = 0x0601'0002;
constexpr std::uint32_t not_mappable = 0x0604'0041;

// shows 002.52, 002.76, 002.100, 002.217, 002.223, 002.226
TEST(Manual002, EvaluatesRpdo1AtOnce) {
  Drive drive;
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("205 0F 00"), "");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
}

// shows 002.77, 002.78, 002.84
TEST(Manual002, Rpdo2And3CarryTargetsOnceTheyAreEnabled) {
  Drive drive;
  drive.ask(bench::start);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), 0);
  write(drive, 0x1401, 1, 4, 0x305);
  write(drive, 0x1402, 1, 4, 0x405);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), 1);
  drive.ask("405 1F 00 FE FF FF FF");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), -2);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x1F);
  EXPECT_EQ(drive.ask("305 0F 00 01 00 00"), "085 10 82 11 00 00 00 00 00");
}

// shows 002.80, 002.84, 002.217, 002.225, 002.501
TEST(Manual002, SendsTpdo1AfterTheStartAndAtEveryChange) {
  Drive drive;
  drive.node.set<od::statusword>(canopen::raw(0x6631));
  EXPECT_EQ(drive.ask(bench::start), "185 31 66");
  drive.node.set<od::statusword>(canopen::raw(0x4637));
  EXPECT_EQ(drive.pass(1s), "185 37 46");
}

// shows 002.81, 002.82, 002.149, 002.150, 002.217, 002.225, 002.234
TEST(Manual002, SendsTpdo2And3AtEachSyncOnceTheyAreEnabled) {
  Drive drive;
  drive.node.set<od::statusword>(canopen::raw(0x4637));
  drive.node.set<od::position_actual_value>(30000);
  drive.node.set<od::velocity_actual_value>(canopen::raw(-1));
  EXPECT_EQ(drive.ask(bench::start), "185 37 46");
  EXPECT_EQ(drive.ask("080"), "");
  write(drive, 0x1801, 1, 4, 0x285);
  write(drive, 0x1802, 1, 4, 0x385);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("080"), "285 37 46 30 75 00 00 | 385 37 46 FF FF FF FF");
  EXPECT_EQ(drive.ask("080"), "285 37 46 30 75 00 00 | 385 37 46 FF FF FF FF");
}

TEST(Manual002, HasAStaticMappingOfPdo1To3) {
  constexpr std::uint16_t mappings[] = {0x1600, 0x1601, 0x1602, 0x1A00, 0x1A01, 0x1A02};
  Drive drive;
  for (const std::uint16_t index : mappings) {
    EXPECT_EQ(write(drive, index, 0, 1, 0), refused(index, 0, read_only));
    EXPECT_EQ(write(drive, index, 1, 4, 0), refused(index, 1, read_only));
  }
}

constexpr std::uint32_t mappable_in_tpdos[] = {0x3008'0110, 0x3009'0110, 0x3009'0510, 0x301C'0410, 0x301F'0220,
                                               0x6041'0010, 0x6061'0008, 0x6064'0020, 0x606C'0020};
constexpr std::uint32_t mappable_in_rpdos[] = {0x301B'0910, 0x3020'0410, 0x3021'0410, 0x3026'0320, 0x3026'0420,
                                               0x6040'0010, 0x607A'0020, 0x6081'0020, 0x60FF'0020};

// shows 002.21, 002.85, 002.89..002.91, 002.229, 002.243, 002.324
TEST(Manual002, MapsTheObjectsOf334AndNoOther) {
  Drive drive;
  drive.node.entries().dictionary().for_each_entry(
      [&](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
        const auto bits = static_cast<std::uint32_t>(canopen::entry::wire_bytes(word) * 8);
        const std::uint32_t entry = (canopen::object_key(index, sub_index) << 8) | bits;
        const bool in_tpdos = std::ranges::find(mappable_in_tpdos, entry) != std::end(mappable_in_tpdos);
        const bool in_rpdos = std::ranges::find(mappable_in_rpdos, entry) != std::end(mappable_in_rpdos);
        EXPECT_EQ(write(drive, 0x1A03, 1, 4, entry), in_tpdos ? taken(0x1A03, 1) : refused(0x1A03, 1, not_mappable));
        EXPECT_EQ(write(drive, 0x1603, 1, 4, entry), in_rpdos ? taken(0x1603, 1) : refused(0x1603, 1, not_mappable));
      });
  for (const std::uint32_t entry : mappable_in_tpdos) EXPECT_EQ(write(drive, 0x1A03, 1, 4, entry), taken(0x1A03, 1));
  for (const std::uint32_t entry : mappable_in_rpdos) EXPECT_EQ(write(drive, 0x1603, 1, 4, entry), taken(0x1603, 1));
}

// shows 002.22, 002.79, 002.91, 002.210, 002.224, 002.230, 002.254
TEST(Manual002, MapsNoMoreThanEightBytes) {
  Drive drive;
  write(drive, 0x1603, 1, 4, 0x607A'0020);
  write(drive, 0x1603, 2, 4, 0x60FF'0020);
  write(drive, 0x1603, 3, 4, 0x6040'0010);
  EXPECT_EQ(drive.ask("605 2F 03 16 00 03 00 00 00"), "585 80 03 16 00 42 00 04 06");
  EXPECT_EQ(drive.ask("605 2F 03 16 00 02 00 00 00"), "585 60 03 16 00 00 00 00 00");
}

// shows 002.92
TEST(Manual002, KeepsTheInhibitTime) {
  Drive drive;
  write(drive, 0x1800, 1, 4, 0x8000'0185);
  EXPECT_EQ(drive.ask("605 2B 00 18 03 64 00 00 00"), "585 60 00 18 03 00 00 00 00");  // 10 ms
  write(drive, 0x1800, 1, 4, 0x185);
  EXPECT_EQ(drive.ask(bench::start), "185 00 00");
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(9999us), "");
  EXPECT_EQ(drive.pass(1us), "185 01 00");
}

// shows 002.93
TEST(Manual002, SendsAnEventControlledTpdoEachTimeItsTimerExpires) {
  Drive drive;
  write(drive, 0x1800, 5, 2, 100);
  EXPECT_EQ(drive.ask(bench::start), "185 00 00");
  EXPECT_EQ(drive.pass(99ms), "");
  EXPECT_EQ(drive.pass(1ms), "185 00 00");
  EXPECT_EQ(drive.pass(100ms), "185 00 00");
}

// shows 002.94, 002.153, 002.154, 002.227, 002.234, 002.235
TEST(Manual002, HasTheTransmissionTypesOf9421) {
  Drive drive;
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool reserved = type >= 241 && type <= 251;
    EXPECT_EQ(write(drive, 0x1800, 2, 1, type), reserved ? refused(0x1800, 2, invalid_value) : taken(0x1800, 2));
  }
  write(drive, 0x1800, 2, 1, 0);
  drive.ask(bench::start);
  drive.ask("080");
  EXPECT_EQ(drive.ask("080"), "");
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("080"), "185 01 00");
  write(drive, 0x1800, 2, 1, 2);
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("080"), "185 01 00");
}

// shows 002.94, 002.97
TEST(Manual002, UpdatesType252AtSyncAndType253WhenAsked) {
  Drive drive;
  drive.ask(bench::start);
  write(drive, 0x1800, 2, 1, 252);
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("185 R 0"), "185 01 00");
  write(drive, 0x1800, 2, 1, 253);
  drive.node.set<od::statusword>(canopen::raw(2));
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("185 R 0"), "185 02 00");
}

// shows 002.95, 002.96
TEST(Manual002, TakesSynchronousRpdosAtTheNextSyncWhateverTheirNumber) {
  for (const std::uint32_t type : {0u, 1u, 3u, 240u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0) << type;
    drive.ask("080");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F) << type;
  }
}

// shows 002.101, 002.213, 002.217, 002.225
TEST(Manual002, AnswersRemoteFramesForTpdo1Only) {
  Drive drive;
  write(drive, 0x1801, 1, 4, 0x285);
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(drive.ask("285 R 0"), "");
}

// shows 002.102, 002.173
TEST(Manual002, HasFixedTransmissionTypesOfPdo4) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2F 03 14 02 FF 00 00 00"), "585 80 03 14 02 02 00 01 06");
  EXPECT_EQ(drive.ask("605 2F 03 18 02 FE 00 00 00"), "585 80 03 18 02 02 00 01 06");
}

// shows 002.163, 002.253
TEST(Manual002, MapsFourObjectsOfTwoBytes) {
  Drive drive;
  const std::uint32_t mapped[] = {0x3008'0110, 0x3009'0110, 0x3009'0510, 0x301C'0410};
  for (std::uint8_t i = 0; i < 4; ++i) {
    EXPECT_EQ(write(drive, 0x1A03, static_cast<std::uint8_t>(i + 1), 4, mapped[i]),
              taken(0x1A03, static_cast<std::uint8_t>(i + 1)));
  }
  EXPECT_EQ(write(drive, 0x1A03, 0, 1, 5), refused(0x1A03, 0, 0x0604'0042));
  EXPECT_EQ(write(drive, 0x1A03, 0, 1, 4), taken(0x1A03, 0));
  write(drive, 0x1803, 1, 4, 0x485);
  EXPECT_EQ(drive.ask(bench::start), "185 00 00 | 485 00 00 00 00 00 00 00 00");
}

// shows 002.465, 002.470
TEST(Manual002, TakesRpdo2And3WithSyncOrAtOnceByTheirType) {
  for (const std::uint32_t type : {0u, 1u, 240u, 255u}) {
    Drive drive;
    for (const std::uint16_t index : {std::uint16_t{0x1401}, std::uint16_t{0x1402}}) {
      write(drive, index, 2, 1, type);
      write(drive, index, 1, 4, index == 0x1401 ? 0x305 : 0x405);
    }
    drive.ask(bench::start);
    drive.ask("305 0F 00 01 00 00 00");
    drive.ask("405 0F 00 02 00 00 00");
    EXPECT_EQ(drive.node.get<od::target_position>(), type == 255 ? 1 : 0);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), type == 255 ? 2 : 0);
    drive.ask("080");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), 1);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), 2);
  }
}

}  // namespace

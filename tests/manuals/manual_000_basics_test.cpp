/// Manual 000, the servo drive cpc TC1: CAN-IDs, services, data types, and the sequences that chapter 12 describes.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>
#include <cstdint>
#include <string>

#include "manual_000_bench.hpp"
#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::taken;
using manual::write;
using manual_000::Drive;
using manual_000::start_with;
namespace od = cpc_tc1::od;
using namespace std::chrono_literals;

constexpr std::uint32_t not_mappable = 0x0604'0041;

// Frames and CAN-IDs

// shows 000.18, 000.182, 000.195, 000.196
TEST(Manual000, SendsBaseDataFramesOnly) {
  Drive drive;
  for (const char* request :
       {"605 2B 17 10 00 64 00 00 00", "605 40 08 10 00 00 00 00 00", "605 60 00 00 00 00 00 00 00",
        "605 40 FE 1F 00 00 00 00 00", bench::start, "205 0F", "205 0F 00"}) {
    drive.node.on_frame(bench::frame(request), drive.now);
  }
  drive.node.emergency(0x2310, canopen::ErrorRegister::current);
  for (int i = 0; i < 100; ++i) drive.node.on_time(drive.now = drive.now + 10ms);
  EXPECT_GT(drive.bus.sent.size(), 40u);  // heartbeats, responses, TPDOs, EMCYs
  for (const canopen::Frame& frame : drive.bus.sent) {
    EXPECT_FALSE(frame.remote);
    EXPECT_FALSE(frame.extended);
    EXPECT_LE(frame.id, 0x7FFu);
    EXPECT_LE(frame.size, 8);
  }
}

struct CobIdRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  unsigned function;  ///< bits 7 to 10
};
constexpr CobIdRow cob_ids[] = {
    {0x1014, 0, 0b0001}, {0x1800, 1, 0b0011}, {0x1400, 1, 0b0100}, {0x1801, 1, 0b0101},
    {0x1401, 1, 0b0110}, {0x1802, 1, 0b0111}, {0x1402, 1, 0b1000}, {0x1803, 1, 0b1001},
    {0x1403, 1, 0b1010}, {0x1200, 2, 0b1011}, {0x1200, 1, 0b1100},
};

// shows 000.9, 000.10, 000.198, 000.199, 000.236, 000.336
TEST(Manual000, HasThePredefinedCanIdsOfTheFirstAndTheLastNodeId) {
  for (const unsigned id : {1u, 127u}) {
    bench::RecordingBus bus;
    bench::NodeOf<cpc_tc1::Device, bench::RecordingBus> node{bus, canopen::NodeId{static_cast<std::uint8_t>(id)}};
    node.start({});
    EXPECT_EQ(bench::frame(bus.take()).id, 0b1110u << 7 | id);
    const auto ask = [&](std::uint16_t index, std::uint8_t sub_index) {
      canopen::Frame request = bench::frame(manual::sdo("600", 0x40, index, sub_index, 0));
      request.id += id;
      node.on_frame(request, {});
      const canopen::Frame response = bench::frame(bus.take());
      EXPECT_EQ(response.id, 0b1011u << 7 | id);
      return static_cast<std::uint32_t>(response.data[4] | response.data[5] << 8) & 0x7FFu;
    };
    for (const auto& [index, sub_index, function] : cob_ids) EXPECT_EQ(ask(index, sub_index), function << 7 | id);
    EXPECT_EQ(ask(0x1005, 0), 0b0001u << 7);
  }
}

// shows 000.14, 000.200, 000.201, 000.204
TEST(Manual000, RespondsToConfirmedServicesOnly) {
  Drive drive;
  start_with(drive, 0x1800, 240);
  EXPECT_EQ(drive.ask("205 06 00"), "");                    // PDO
  EXPECT_EQ(drive.ask("080"), "");                          // SYNC
  EXPECT_EQ(drive.ask("100 00 00 00 00 00 00"), "");        // TIME
  EXPECT_EQ(drive.ask("086 10 23 03 00 00 00 00 00"), "");  // EMCY of another device
  EXPECT_EQ(drive.ask("000 80 05"), "");                    // NMT, to it and to all
  EXPECT_EQ(drive.ask("000 01 00"), "");
  EXPECT_EQ(drive.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 15 10 00 0A 00 00 00"), "585 60 15 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("606 40 17 10 00 00 00 00 00"), "");
}

// shows 000.202
TEST(Manual000, IgnoresAnRpdoThatIsNotValid) {
  Drive drive;
  drive.ask(bench::start);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(drive.ask("605 40 7A 60 00 00 00 00 00"), "585 43 7A 60 00 00 00 00 00");
  write(drive, 0x1401, 1, 4, 0x305);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(drive.ask("605 40 7A 60 00 00 00 00 00").substr(0, 27), "585 43 7A 60 00 01 00 00 00");
  write(drive, 0x1401, 1, 4, 0x8000'0305);
  drive.ask("305 0F 00 02 00 00 00");
  EXPECT_EQ(drive.ask("605 40 7A 60 00 00 00 00 00").substr(0, 27), "585 43 7A 60 00 01 00 00 00");
}

// shows 000.180, 000.238
TEST(Manual000, IgnoresTime) {
  for (const char* state : {bench::enter_pre_operational, bench::stop}) {
    Drive drive;
    drive.ask(state);
    EXPECT_EQ(drive.ask("100 78 56 34 02 01 3C"), "");
    EXPECT_EQ(drive.pass(1s), "");
    drive.ask(bench::enter_pre_operational);
    EXPECT_EQ(drive.ask("605 40 12 10 00 00 00 00 00"), refused(0x1012, 0, 0x0602'0000));
  }
}

// shows 000.220
TEST(Manual000, SdoSetsParametersAndCanIdsInPreOperational) {
  Drive drive;
  write(drive, 0x1801, 1, 4, 0xC000'0285);
  write(drive, 0x1802, 1, 4, 0xC000'0385);
  write(drive, 0x1803, 1, 4, 0xC000'0485);
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 C0"), taken(0x1800, 1));
  EXPECT_EQ(drive.ask("605 2F 00 18 02 02 00 00 00"), taken(0x1800, 2));
  EXPECT_EQ(drive.ask("605 23 00 18 01 91 02 00 40"), taken(0x1800, 1));
  EXPECT_EQ(drive.ask("605 23 05 10 00 90 00 00 00"), taken(0x1005, 0));
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("090"), "");
  EXPECT_EQ(drive.ask("090"), "291 00 00");
}

// Data types

struct RangeRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  unsigned bytes;
  std::uint32_t value;
  const char* octets;
};
constexpr RangeRow ranges[] = {
    {0x1400, 2, 1, 0x00, "00 00 00 00"},        {0x1400, 2, 1, 0xFF, "FF 00 00 00"},
    {0x1015, 0, 2, 0x0000, "00 00 00 00"},      {0x1015, 0, 2, 0xFFFF, "FF FF 00 00"},
    {0x1015, 0, 2, 0x1234, "34 12 00 00"},      {0x1013, 0, 4, 0x0000'0000, "00 00 00 00"},
    {0x1013, 0, 4, 0xFFFF'FFFF, "FF FF FF FF"}, {0x1013, 0, 4, 0x1234'5678, "78 56 34 12"},
    {0x607A, 0, 4, 0x8000'0000, "00 00 00 80"}, {0x607A, 0, 4, 0x7FFF'FFFF, "FF FF FF 7F"},
    {0x607A, 0, 4, 0xFFFF'FEEC, "EC FE FF FF"},
};

// shows 000.22, 000.24, 000.186, 000.187, 000.207..000.211
TEST(Manual000, TakesTheFullRangeOfItsTypesLowOctetFirst) {
  for (const auto& [index, sub_index, bytes, value, octets] : ranges) {
    Drive drive;
    EXPECT_EQ(write(drive, index, sub_index, bytes, value), taken(index, sub_index));
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, sub_index, 0)).substr(16), octets);
  }
  Drive drive;
  write(drive, 0x607A, 0, 4, 0x8000'0000);
  EXPECT_EQ(drive.node.get<od::target_position>(), -2'147'483'647 - 1);
}

// SYNC

// shows 000.118, 000.255
TEST(Manual000, CountsSyncFrom1WheneverItsGenerationBegins) {
  Drive drive;
  write(drive, 0x1019, 0, 1, 10);
  write(drive, 0x1006, 0, 4, 10'000);
  write(drive, 0x1005, 0, 4, 0x4000'0080);
  EXPECT_EQ(drive.pass(30ms), "080 01 | 080 02 | 080 03");
  EXPECT_EQ(write(drive, 0x1005, 0, 4, 0x80), taken(0x1005, 0));
  EXPECT_EQ(drive.pass(30ms), "");
  EXPECT_EQ(write(drive, 0x1005, 0, 4, 0x4000'0080), taken(0x1005, 0));
  EXPECT_EQ(drive.pass(10ms), "080 01");
}

// shows 000.68, 000.318
TEST(Manual000, SendsTheFirstAndTheLastCyclicTypes) {
  for (const std::uint32_t type : {2u, 240u}) {
    Drive drive;
    start_with(drive, 0x1800, type);
    for (std::uint32_t sync = 1; sync <= 2 * type; ++sync) {
      EXPECT_EQ(drive.ask("080"), sync % type == 0 ? "185 00 00" : "") << type << ", " << sync;
    }
  }
}

// shows 000.233, 000.318
TEST(Manual000, EventDrivenTpdosDoNotFollowSync) {
  for (const std::uint32_t type : {254u, 255u}) {
    Drive drive;
    start_with(drive, 0x1800, type);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(drive.ask("080"), "");
    drive.node.set<od::statusword>(canopen::raw(1));
    EXPECT_EQ(drive.pass({}), "185 01 00");
  }
}

// Mapping

/// A drive whose RPDO1 and TPDO1 are not valid and map nothing.
struct Unmapped : Drive {
  Unmapped() {
    write(*this, 0x1400, 1, 4, 0x8000'0205);
    write(*this, 0x1600, 0, 1, 0);
    for (std::uint16_t index = 0x1800; index <= 0x1803; ++index) write(*this, index, 1, 4, 0xC000'0000);
    write(*this, 0x1A00, 0, 1, 0);
  }
};

// shows 000.86, 000.95, 000.206, 000.316, 000.332
TEST(Manual000, MapsFourEntriesOfDifferentLengthsInTheirOrder) {
  Unmapped drive;
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x0005'0008), taken(0x1600, 1));  // UNSIGNED8 as a dummy
  EXPECT_EQ(write(drive, 0x1600, 2, 4, 0x6040'0010), taken(0x1600, 2));
  EXPECT_EQ(write(drive, 0x1600, 3, 4, 0x0002'0008), taken(0x1600, 3));  // INTEGER8 as a dummy
  EXPECT_EQ(write(drive, 0x1600, 4, 4, 0x60FF'0020), taken(0x1600, 4));
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 4), taken(0x1600, 0));
  EXPECT_EQ(write(drive, 0x1400, 1, 4, 0x205), taken(0x1400, 1));
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x6041'0010), taken(0x1A00, 1));
  EXPECT_EQ(write(drive, 0x1A00, 2, 4, 0x606C'0020), taken(0x1A00, 2));
  EXPECT_EQ(write(drive, 0x1A00, 3, 4, 0x6041'0010), taken(0x1A00, 3));
  EXPECT_EQ(write(drive, 0x1A00, 0, 1, 3), taken(0x1A00, 0));
  write(drive, 0x1800, 2, 1, 1);
  EXPECT_EQ(write(drive, 0x1800, 1, 4, 0x4000'0185), taken(0x1800, 1));
  drive.ask(bench::start);
  drive.ask("205 AA 0F 00 BB 04 03 02 01");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
  EXPECT_EQ(drive.node.get<od::target_velocity>(), 0x0102'0304);
  drive.node.set<od::statusword>(canopen::raw(0x1234));
  drive.node.set<od::velocity_actual_value>(0x0A0B'0C0D);
  EXPECT_EQ(drive.ask("080"), "185 34 12 0D 0C 0B 0A 34 12");
}

// shows 000.91
TEST(Manual000, AnRpdoIsRemappedInBothStates) {
  for (const char* state : {bench::enter_pre_operational, bench::start}) {
    Drive drive;
    drive.ask(state);
    EXPECT_EQ(write(drive, 0x1400, 1, 4, 0x8000'0205).substr(0, 27), taken(0x1400, 1));
    EXPECT_EQ(write(drive, 0x1600, 0, 1, 0), taken(0x1600, 0));
    EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x607A'0020), taken(0x1600, 1));
    EXPECT_EQ(write(drive, 0x1600, 2, 4, 0x6040'0010), taken(0x1600, 2));
    EXPECT_EQ(write(drive, 0x1600, 0, 1, 2), taken(0x1600, 0));
    EXPECT_EQ(write(drive, 0x1400, 1, 4, 0x205), taken(0x1400, 1));
    drive.ask(bench::start);
    drive.ask("205 04 03 02 01 1F 00");
    EXPECT_EQ(drive.node.get<od::target_position>(), 0x0102'0304);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x1F);
  }
}

// shows 000.90, 000.178, 000.326
TEST(Manual000, RejectsTheMappingOfATpdoInSteps3And4) {
  Unmapped drive;
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x2FFF'0010), refused(0x1A00, 1, not_mappable));  // no such object
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x6040'0010), refused(0x1A00, 1, not_mappable));  // not in this direction
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x6041'0020), refused(0x1A00, 1, not_mappable));  // another length
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x0005'0008), refused(0x1A00, 1, not_mappable));  // a dummy is for RPDOs
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x6064'0020), taken(0x1A00, 1));
  EXPECT_EQ(write(drive, 0x1A00, 2, 4, 0x606C'0020), taken(0x1A00, 2));
  EXPECT_EQ(write(drive, 0x1A00, 3, 4, 0x6041'0010), taken(0x1A00, 3));
  EXPECT_EQ(write(drive, 0x1A00, 0, 1, 3), refused(0x1A00, 0, not_mappable));  // 80 bits
  EXPECT_EQ(write(drive, 0x1A00, 0, 1, 4), refused(0x1A00, 0, not_mappable));  // entry 4 is empty
  EXPECT_EQ(write(drive, 0x1A00, 0, 1, 5), refused(0x1A00, 0, not_mappable));
  EXPECT_EQ(write(drive, 0x1A00, 0, 1, 2), taken(0x1A00, 0));
}

}  // namespace

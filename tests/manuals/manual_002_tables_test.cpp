/// Manual 002, the servo drive CPD as node 5: the tables of chapter 9, row by row.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen/od/data_type.hpp>
#include <canopen/od/description.hpp>
#include <cctype>
#include <cpd/description.hpp>
#include <cpd/device.hpp>
#include <string>
#include <string_view>

#include "manual_bench.hpp"

namespace {

using canopen::DataType;
using manual::Access;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpd::Device>;

constexpr DataType i8 = DataType::integer8;
constexpr DataType i16 = DataType::integer16;
constexpr DataType i32 = DataType::integer32;
constexpr DataType u8 = DataType::unsigned8;
constexpr DataType u16 = DataType::unsigned16;
constexpr DataType u32 = DataType::unsigned32;
constexpr DataType string = DataType::visible_string;

unsigned bytes_of(DataType type) { return type == u8 || type == i8 ? 1 : type == u16 || type == i16 ? 2 : 4; }

/// A row of 9.4, or of the descriptions of the manufacturer's objects. Values are those of node 5.
struct Row {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  Access access;
  std::uint32_t value;
};

void expect_row(Drive& drive, const Row& row) {
  char place[16];
  std::snprintf(place, sizeof place, "%04Xh:%02X", static_cast<unsigned>(row.index),
                static_cast<unsigned>(row.sub_index));
  SCOPED_TRACE(place);
  const canopen::EntryDescription* const entry = canopen::find_description(cpd::descriptions, row.index, row.sub_index);
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->type, row.type);
  if (row.type == string) {  // 8 characters, in segments
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, row.index, row.sub_index, 0)),
              manual::sdo("585", 0x41, row.index, row.sub_index, 8));
    drive.ask("605 80 00 00 00 00 00 00 00");
    EXPECT_EQ(write(drive, row.index, row.sub_index, 4, 0), refused(row.index, row.sub_index, 0x0601'0002));
    return;
  }
  const manual::Entry entries[] = {{row.index, row.sub_index, bytes_of(row.type), row.access, row.value}};
  manual::expect_entries(drive, entries);
}

// shows 002.206, 002.208, 002.388, 002.391, 002.394, 002.395, 002.399, 002.403, 002.405, 002.407, 002.409, 002.411
// shows 002.413..002.416, 002.418..002.421, 002.423, 002.425, 002.427, 002.428, 002.432, 002.434..002.438
// shows 002.440..002.442, 002.444, 002.445, 002.447..002.449, 002.451..002.454, 002.456..002.458, 002.462..002.464
// shows 002.467..002.469, 002.472..002.474, 002.476, 002.477, 002.479..002.483, 002.486..002.490, 002.493
// shows 002.496..002.500, 002.503..002.506, 002.508, 002.510..002.513, 002.515, 002.517..002.520, 002.522, 002.524
// shows 002.525, 002.528..002.532, 002.534..002.538, 002.541
TEST(Manual002, HasEachRowOf94WithItsTypeAccessAndDefaultValue) {
  // clang-format off
  constexpr Row rows[] = {
    {0x1000, 0, u32, ro, 0x0002'0192},
    {0x1001, 0, u8, ro, 0},
    {0x1003, 0, u8, rw, 0},
    {0x1003, 1, u32, ro, 0},
    {0x1005, 0, u32, rw, 0x8000'0080},
    {0x1008, 0, string, ro, 0},
    {0x1009, 0, string, ro, 0},
    {0x100A, 0, string, ro, 0},
    {0x100C, 0, u16, rw, 0},
    {0x100D, 0, u8, rw, 0},
    {0x1010, 0, u8, ro, 3},
    {0x1010, 1, u32, rw, 1},
    {0x1010, 2, u32, rw, 1},
    {0x1010, 3, u32, rw, 1},
    {0x1011, 0, u8, ro, 3},
    {0x1011, 1, u32, rw, 1},
    {0x1011, 2, u32, rw, 1},
    {0x1011, 3, u32, rw, 1},
    {0x1014, 0, u32, rw, 133},
    {0x1015, 0, u16, rw, 0},
    {0x1016, 0, u8, ro, 3},
    {0x1016, 1, u32, rw, 0},
    {0x1017, 0, u16, rw, 0},
    {0x1018, 0, u8, ro, 4},
    {0x1018, 1, u32, ro, 0x0100'002E},
    {0x1018, 2, u32, ro, 0},
    {0x1018, 3, u32, ro, 0},
    {0x1018, 4, u32, ro, 0},
    {0x1020, 0, u8, ro, 2},
    {0x1020, 1, u32, rw, 0},
    {0x1020, 2, u32, rw, 0},
    {0x1029, 0, u8, ro, 1},
    {0x1029, 1, u8, rw, 0},
    {0x1200, 0, u8, ro, 2},
    {0x1200, 1, u32, ro, 0x0000'0605},
    {0x1200, 2, u32, ro, 0x0000'0585},
    {0x1201, 0, u8, ro, 3},
    {0x1201, 1, u32, rw, 0x8000'0000},
    {0x1201, 2, u32, rw, 0x8000'0000},
    {0x1201, 3, u8, rw, 1},
    {0x1400, 0, u8, ro, 2},
    {0x1400, 1, u32, rw, 0x0000'0205},
    {0x1400, 2, u8, rw, 255},
    {0x1401, 0, u8, ro, 2},
    {0x1401, 1, u32, rw, 0x8000'0305},
    {0x1401, 2, u8, rw, 255},
    {0x1402, 0, u8, ro, 2},
    {0x1402, 1, u32, rw, 0x8000'0405},
    {0x1402, 2, u8, rw, 255},
    {0x1403, 0, u8, ro, 2},
    {0x1403, 1, u32, rw, 0x8000'0505},
    {0x1403, 2, u8, ro, 254},
    {0x1600, 0, u8, ro, 1},
    {0x1600, 1, u32, ro, 0x6040'0010},
    {0x1601, 0, u8, ro, 2},
    {0x1601, 1, u32, ro, 0x6040'0010},
    {0x1601, 2, u32, ro, 0x607A'0020},
    {0x1601, 3, u32, ro, 0},
    {0x1601, 4, u32, ro, 0},
    {0x1602, 0, u8, ro, 2},
    {0x1602, 1, u32, ro, 0x6040'0010},
    {0x1602, 2, u32, ro, 0x60FF'0020},
    {0x1602, 3, u32, ro, 0},
    {0x1602, 4, u32, ro, 0},
    {0x1603, 0, u8, rw, 0},
    {0x1800, 0, u8, ro, 5},
    {0x1800, 1, u32, rw, 0x0000'0185},
    {0x1800, 2, u8, rw, 255},
    {0x1800, 3, u16, rw, 0},
    {0x1800, 5, u16, rw, 0},
    {0x1801, 0, u8, ro, 5},
    {0x1801, 1, u32, rw, 0xC000'0285},
    {0x1801, 2, u8, rw, 1},
    {0x1801, 3, u16, rw, 0},
    {0x1801, 5, u16, rw, 100},
    {0x1802, 0, u8, ro, 5},
    {0x1802, 1, u32, rw, 0xC000'0385},
    {0x1802, 2, u8, rw, 1},
    {0x1802, 3, u16, rw, 0},
    {0x1802, 5, u16, rw, 100},
    {0x1803, 0, u8, ro, 5},
    {0x1803, 1, u32, rw, 0xC000'0485},
    {0x1803, 2, u8, ro, 255},
    {0x1803, 3, u16, rw, 0},
    {0x1803, 5, u16, rw, 0},
    {0x1A00, 0, u8, ro, 1},
    {0x1A00, 1, u32, ro, 0x6041'0010},
    {0x1A01, 0, u8, ro, 2},
    {0x1A01, 1, u32, ro, 0x6041'0010},
    {0x1A01, 2, u32, ro, 0x6064'0020},
    {0x1A01, 3, u32, ro, 0},
    {0x1A01, 4, u32, ro, 0},
    {0x1A02, 0, u8, ro, 2},
    {0x1A02, 1, u32, ro, 0x6041'0010},
    {0x1A02, 2, u32, ro, 0x606C'0020},
    {0x1A02, 3, u32, ro, 0},
    {0x1A02, 4, u32, ro, 0},
    {0x1A03, 0, u8, rw, 0},
  };
  // clang-format on
  Drive drive;
  for (const Row& row : rows) expect_row(drive, row);
}

struct Range {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  std::uint32_t low;
  std::uint32_t high;
};

/// The ranges of 9.4 that are not those of a COB-ID or of a mapping. TPDOs have to be invalid for 180xh:03.
// shows 002.325, 002.409, 002.411, 002.425, 002.428, 002.432, 002.441, 002.442, 002.454, 002.506, 002.508, 002.513
// shows 002.515, 002.520, 002.522
TEST(Manual002, AcceptsTheRangesOf94) {
  constexpr Range rows[] = {
      {0x100C, 0, u16, 0, 65535}, {0x100D, 0, u8, 0, 255},          {0x1015, 0, u16, 0, 65535},
      {0x1017, 0, u16, 0, 65535}, {0x1020, 1, u32, 0, 0xFFFF'FFFF}, {0x1020, 2, u32, 0, 0xFFFF'FFFF},
      {0x1201, 3, u8, 1, 127},    {0x1801, 3, u16, 0, 65535},       {0x1801, 5, u16, 0, 65535},
      {0x1802, 3, u16, 0, 65535}, {0x1802, 5, u16, 0, 65535},       {0x1803, 3, u16, 0, 65535},
      {0x1803, 5, u16, 0, 65535}, {0x1016, 1, u32, 0, 0x007F'FFFF},
  };
  for (const auto& [index, sub_index, type, low, high] : rows) {
    Drive drive;
    for (const std::uint32_t value : {high, low}) {
      EXPECT_EQ(write(drive, index, sub_index, bytes_of(type), value).substr(0, 27), taken(index, sub_index));
    }
  }
  Drive drive;
  EXPECT_EQ(write(drive, 0x1201, 3, 1, 0), refused(0x1201, 3, 0x0609'0032));
  EXPECT_EQ(write(drive, 0x1201, 3, 1, 128), refused(0x1201, 3, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x3006, 0x0F, 2, 3), refused(0x3006, 0x0F, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x3006, 0x10, 2, 3), refused(0x3006, 0x10, 0x0609'0031));
}

/// Only letters and digits, in lower case: "Control word" is "Controlword".
std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

struct Assignment {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  std::string_view name;
};

// shows 002.204, 002.362..002.386
TEST(Manual002, HasTheObjectsOf93WithTheirTypesAndNames) {
  // clang-format off
  constexpr Assignment rows[] = {
    {0x603F, 0, u16, "Error code"},
    {0x6040, 0, u16, "Control word"},
    {0x6041, 0, u16, "Status word"},
    {0x6060, 0, i8, "Modes of operation"},
    {0x6061, 0, i8, "Modes of operation display"},
    {0x6064, 0, i32, "Position actual value"},
    {0x6065, 0, u32, "Following error window"},
    {0x6067, 0, u32, "Position window"},
    {0x6068, 0, u16, "Position window time"},
    {0x606B, 0, i32, "Velocity demand value"},
    {0x606C, 0, i32, "Velocity actual value"},
    {0x607A, 0, i32, "Target position"},
    {0x607D, 1, i32, "Min position limit"},
    {0x607D, 2, i32, "Max position limit"},
    {0x607F, 0, u32, "Max profile velocity"},
    {0x6081, 0, u32, "Profile velocity"},
    {0x6083, 0, u32, "Profile acceleration"},
    {0x6084, 0, u32, "Profile deceleration"},
    {0x6086, 0, i16, "Motion profile type"},
    {0x6098, 0, i8, "Homing method"},
    {0x6099, 1, u32, "Homing speed during search for switch"},
    {0x6099, 2, u32, "Homing speed during search for zero"},
    {0x60F4, 0, i32, "Following error actual value"},
    {0x60FF, 0, i32, "Target velocity"},
    {0x6502, 0, u32, "Supported drive modes"},
  };
  // clang-format on
  Drive drive;
  for (const auto& [index, sub_index, type, name] : rows) {
    SCOPED_TRACE(name);
    const canopen::EntryDescription* const entry = canopen::find_description(cpd::descriptions, index, sub_index);
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->type, type);
    EXPECT_EQ(plain(index == 0x6099 ? "Homing " + std::string{entry->name()} : std::string{entry->name()}),
              plain(name));
    const std::string answer = drive.ask(manual::sdo("605", 0x40, index, sub_index, 0));
    EXPECT_EQ(bench::frame(answer).data[0], 0x43 | manual::unused(bytes_of(type)));
  }
  EXPECT_EQ(std::ranges::count_if(cpd::descriptions,
                                  [](const canopen::EntryDescription& entry) {
                                    return entry.index >= 0x6000 && (entry.sub_index != 0 || entry.entry.empty());
                                  }),
            static_cast<std::ptrdiff_t>(std::size(rows)));
}

/// The objects of the manufacturer that the manual names, all with two or four bytes.
// shows 002.204
TEST(Manual002, HasTheNamedObjectsOfTheManufacturer) {
  // clang-format off
  constexpr Row rows[] = {
    {0x2041, 0, u16, ro, 0},
    {0x3004, 1, u16, rw, 0}, {0x3004, 8, u16, rw, 0},
    {0x3005, 2, u16, rw, 0},
    {0x3006, 0x0F, u16, rw, 1}, {0x3006, 0x10, u16, rw, 1}, {0x3006, 0x12, u16, rw, 0},
    {0x3008, 1, u16, ro, 0},
    {0x3009, 1, i16, ro, 0}, {0x3009, 5, i16, ro, 0},
    {0x3011, 5, u16, rw, 0}, {0x3011, 6, u16, rw, 0},
    {0x301B, 9, u16, rw, 0}, {0x301B, 0x10, u16, rw, 0}, {0x301B, 0x11, u16, rw, 0}, {0x301B, 0x12, u16, rw, 0},
    {0x301C, 4, u16, ro, 0}, {0x301C, 7, u16, ro, 0}, {0x301C, 8, u16, ro, 0},
    {0x301C, 0x0B, u16, ro, 0}, {0x301C, 0x0C, u16, ro, 0},
    {0x301F, 2, i32, ro, 0},
    {0x3020, 4, i16, rw, 0}, {0x3021, 4, i16, rw, 0},
    {0x3026, 3, i32, rw, 1}, {0x3026, 4, i32, rw, 1},
    {0x3029, 4, u16, rw, 0}, {0x3029, 5, u16, rw, 0},
    {0x303B, 5, u16, rw, 0}, {0x303C, 1, u16, ro, 0},
  };
  // clang-format on
  Drive drive;
  for (const Row& row : rows) expect_row(drive, row);
}

// shows 002.323
TEST(Manual002, HasTheDataTypesOf91) {
  constexpr std::uint16_t codes[] = {1, 2, 3, 4, 5, 6, 7, 9};
  constexpr DataType types[] = {DataType::boolean, i8, i16, i32, u8, u16, u32, string};
  for (std::size_t i = 0; i < std::size(codes); ++i) EXPECT_EQ(static_cast<std::uint16_t>(types[i]), codes[i]);
  Drive drive;  // the lowest and the highest value of a type
  EXPECT_EQ(drive.ask("605 23 7A 60 00 00 00 00 80"), "585 60 7A 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 7A 60 00 FF FF FF 7F"), "585 60 7A 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 21 30 04 00 80 00 00"), "585 60 21 30 04 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 21 30 04 FF 7F 00 00"), "585 60 21 30 04 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2F 98 60 00 80 00 00 00"), "585 60 98 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 29 30 04 FF FF 00 00"), "585 60 29 30 04 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 81 60 00 FF FF FF FF"), "585 60 81 60 00 00 00 00 00");
}

// shows 002.209
TEST(Manual002, HasTheLimitsOfTable31) {
  constexpr Row rows[] = {{0x607D, 0, u8, ro, 2}, {0x607D, 1, i32, rw, 0}, {0x607D, 2, i32, rw, 0}};
  Drive drive;
  for (const Row& row : rows) expect_row(drive, row);
  EXPECT_EQ(canopen::find_description(cpd::descriptions, 0x607D, 1)->name(), "Min position limit");
  EXPECT_EQ(canopen::find_description(cpd::descriptions, 0x607D, 2)->name(), "Max position limit");
}

// shows 002.207
TEST(Manual002, HasObjectsInTheRangesOf123Only) {
  for (const canopen::EntryDescription& entry : cpd::descriptions) {
    EXPECT_GE(entry.index, 0x1000);
    EXPECT_LT(entry.index, 0xA000);
    EXPECT_TRUE(entry.index < 0x2000 || entry.index == 0x2041 || entry.index >= 0x3000);
  }
}

}  // namespace

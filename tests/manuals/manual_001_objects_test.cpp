/// Manual 001: the lists of objects of the stepper drive EZD-1136, typed from the manual, with the drive as node 5.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <ezd_1136/description.hpp>
#include <ezd_1136/device.hpp>
#include <initializer_list>
#include <optional>
#include <string>

#include "manual_bench.hpp"

namespace {

using canopen::DataType;
using manual::refused;
using manual::sdo;
using manual::taken;
using manual::unused;
using manual::write;

using Drive = bench::Bench<ezd_1136::Device>;

constexpr auto I8 = DataType::integer8;
constexpr auto I16 = DataType::integer16;
constexpr auto I32 = DataType::integer32;
constexpr auto U8 = DataType::unsigned8;
constexpr auto U16 = DataType::unsigned16;
constexpr auto U32 = DataType::unsigned32;
constexpr auto text = DataType::visible_string;

/// The access column. RWW is read and write, and can be mapped to an RPDO.
enum class Column : std::uint8_t { RO, RW, WO, RWW, CO };
using enum Column;

struct Row {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  Column access;
  std::optional<std::uint32_t> value = std::nullopt;  ///< the printed default value
};

unsigned bytes_of(DataType type) {
  switch (type) {
    case I8:
    case U8: return 1;
    case I16:
    case U16: return 2;
    case I32:
    case U32: return 4;
    default: return 0;
  }
}

/// Expects type, access and default value of each row in the answers of the drive.
void expect_rows(std::initializer_list<Row> rows) {
  Drive drive;
  for (std::uint16_t pdo = 0; pdo < 4; ++pdo) {  // the mapping of a PDO that is not valid can be written
    write(drive, static_cast<std::uint16_t>(0x1400 + pdo), 1, 4, 0x8000'0205u + 0x100u * pdo);
    write(drive, static_cast<std::uint16_t>(0x1800 + pdo), 1, 4, 0x8000'0185u + 0x100u * pdo);
    write(drive, static_cast<std::uint16_t>(0x1600 + pdo), 0, 1, 0);
    write(drive, static_cast<std::uint16_t>(0x1A00 + pdo), 0, 1, 0);
  }
  for (const auto& [index, sub_index, type, access, value] : rows) {
    char place[16];
    std::snprintf(place, sizeof place, "%04Xh:%02X", static_cast<unsigned>(index), static_cast<unsigned>(sub_index));
    SCOPED_TRACE(place);
    const canopen::EntryDescription* const entry = find_description(ezd_1136::descriptions, index, sub_index);
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->type, type);
    const unsigned bytes = bytes_of(type);
    const std::string answer = drive.ask(sdo("605", 0x40, index, sub_index, 0));
    if (access == WO) {
      EXPECT_EQ(answer, refused(index, sub_index, 0x0601'0001));
    } else if (bytes != 0) {
      EXPECT_EQ(answer.substr(0, 16), sdo("585", 0x43 | unused(bytes), index, sub_index, 0).substr(0, 16));
      if (value) {
        EXPECT_EQ(answer, sdo("585", 0x43 | unused(bytes), index, sub_index, *value));
      }
    }
    if (access == RO || access == CO) {
      const std::string attempt = bytes == 0 ? sdo("605", 0x21, index, sub_index, 1)
                                             : sdo("605", 0x23 | unused(bytes), index, sub_index, value.value_or(0));
      EXPECT_EQ(drive.ask(attempt), refused(index, sub_index, 0x0601'0002));
    } else if (value) {
      EXPECT_EQ(write(drive, index, sub_index, bytes, *value), taken(index, sub_index));
    } else if (bytes != 0) {
      const canopen::Frame got = bench::frame(answer);
      const std::uint32_t present = access == WO
                                        ? 0
                                        : got.data[4] | std::uint32_t{got.data[5]} << 8 |
                                              std::uint32_t{got.data[6]} << 16 | std::uint32_t{got.data[7]} << 24;
      EXPECT_EQ(write(drive, index, sub_index, bytes, present), taken(index, sub_index));
    }
    if (access == RWW) {
      const std::uint32_t mapped = std::uint32_t{index} << 16 | std::uint32_t{sub_index} << 8 | 8 * bytes;
      EXPECT_EQ(write(drive, 0x1603, 1, 4, mapped), taken(0x1603, 1));
    }
  }
}

// shows 001.9, 001.82, 001.133, 001.137
TEST(Manual001, HasTheListOfCommunicationObjects) {
  expect_rows({
      {0x1000, 0, U32, RO},  {0x1001, 0, U8, RO},   {0x1005, 0, U32, RW}, {0x1006, 0, U32, RW}, {0x1008, 0, text, CO},
      {0x1009, 0, text, CO}, {0x100A, 0, text, CO}, {0x100C, 0, U16, RW}, {0x1014, 0, U32, RW}, {0x1017, 0, U16, RW},
      {0x1200, 1, U32, RO},  {0x1200, 2, U32, RO},  {0x1400, 1, U32, RW}, {0x1400, 2, U8, RW},  {0x1401, 1, U32, RW},
      {0x1401, 2, U8, RW},   {0x1402, 1, U32, RW},  {0x1402, 2, U8, RW},  {0x1403, 2, U8, RW},  {0x1600, 0, U8, RW},
      {0x1600, 1, U32, RW},  {0x1600, 4, U32, RW},  {0x1601, 0, U8, RW},  {0x1601, 1, U32, RW}, {0x1602, 0, U8, RW},
      {0x1602, 1, U32, RW},  {0x1603, 0, U8, RW},   {0x1603, 1, U32, RW}, {0x1800, 1, U32, RW}, {0x1800, 2, U8, RW},
      {0x1800, 3, U16, RW},  {0x1800, 5, U16, RW},  {0x1801, 1, U32, RW}, {0x1801, 2, U8, RW},  {0x1801, 3, U16, RW},
      {0x1801, 5, U16, RW},  {0x1802, 1, U32, RW},  {0x1802, 2, U8, RW},  {0x1802, 3, U16, RW}, {0x1802, 5, U16, RW},
      {0x1803, 1, U32, RW},  {0x1803, 2, U8, RW},   {0x1803, 3, U16, RW}, {0x1803, 5, U16, RW}, {0x1A00, 0, U8, RW},
      {0x1A01, 0, U8, RW},   {0x1A02, 0, U8, RW},   {0x1A03, 0, U8, RW},
  });
}

// shows 001.9, 001.76, 001.91, 001.92, 001.154, 001.155, 001.212
TEST(Manual001, HasTheListOfConfigurationParameters) {
  expect_rows({
      {0x2064, 0, I16, RO, 0},   {0x2065, 0, U16, RO, 0}, {0x206C, 0, U16, RO, 0}, {0x206D, 0, I16, RO, 4},
      {0x207C, 0, U16, RO, 0},   {0x2090, 0, U16, RO},    {0x20C8, 0, U16, RW},    {0x20C9, 0, U16, RW},
      {0x20CE, 0, U16, WO, 0},   {0x20D0, 0, U16, RW, 0}, {0x20D1, 0, U16, RW, 0}, {0x20D5, 0, U16, RW},
      {0x20D7, 0, U16, RW},      {0x20D9, 0, I16, RW},    {0x20DB, 0, U16, RW},    {0x20DC, 0, U16, RW},
      {0x20DD, 0, U16, RW},      {0x20DE, 0, U16, RW},    {0x20E0, 0, U16, RW},    {0x20E1, 0, U16, RW},
      {0x20E4, 0, U16, RW},      {0x20F1, 0, I16, RW},    {0x20F2, 0, U32, RW},    {0x20F5, 0, U16, RW},
      {0x20F6, 0, U16, RW},      {0x20F7, 0, U16, RW},    {0x20F8, 0, U16, RW},    {0x20FB, 0, U16, RW},
      {0x20FC, 0, U16, RW},      {0x20FD, 0, U16, RW},    {0x20FE, 0, I16, RW},    {0x20FF, 0, U16, RW},
      {0x2100, 0, U16, RW},      {0x2101, 0, U16, RW},    {0x2102, 0, U16, RW},    {0x2103, 0, I16, RW},
      {0x2108, 0, U16, RW},      {0x2109, 0, U16, RW},    {0x2110, 0, U16, RW},    {0x2113, 0, U16, RW},
      {0x2114, 0, U16, RW},      {0x2115, 0, U16, RW},    {0x2116, 0, U16, RW},    {0x2117, 0, U16, RW},
      {0x2118, 0, U16, RW},      {0x2119, 0, U16, RW},    {0x211A, 0, U16, RW},    {0x211E, 0, I16, RW, 10},
      {0x211F, 0, I16, RW, 500}, {0x2127, 0, U16, RW},    {0x2190, 1, U16, RW},    {0x2190, 2, U16, RW},
      {0x2190, 3, U16, RW},      {0x2190, 4, U16, RW},    {0x2190, 5, U16, RW},    {0x2190, 6, U16, RW},
      {0x2190, 7, U16, RW},      {0x2190, 8, U16, RW},    {0x21A4, 1, U16, RW},    {0x21A4, 2, U16, RW},
      {0x21A4, 3, U16, RW},      {0x21A4, 4, U16, RW},    {0x21A4, 5, U16, RW},    {0x21AD, 0, U16, WO},
      {0x21AE, 0, U16, WO},      {0x21E0, 0, I32, RW},    {0x21E2, 0, I32, RW},    {0x21E4, 0, I32, RW},
      {0x21E6, 0, I32, RW},      {0x21E8, 0, I32, RW},
  });
}

// shows 001.52, 001.53, 001.98, 001.100, 001.132, 001.191, 001.192, 001.221
TEST(Manual001, HasTheListOfMotionParameters) {
  expect_rows({
      {0x603F, 0, U16, RO, 0},
      {0x6040, 0, U16, RWW},
      {0x6041, 0, U16, RO},
      {0x605A, 0, I16, RW, 2},
      {0x605B, 0, I16, RW, 0},
      {0x605C, 0, I16, RW, 1},
      {0x605E, 0, I16, RW, 2},
      {0x6060, 0, I8, RWW},
      {0x6061, 0, I8, RO},
      {0x6064, 0, I32, RO},
      {0x606C, 0, I32, RO},
      {0x6071, 0, I16, RWW, 0},
      {0x6074, 0, I16, RO, 0},
      {0x6078, 0, I16, RO, 0},
      {0x607A, 0, I32, RWW},
      {0x607C, 0, I32, RWW, 0},
      {0x607D, 1, I32, RW, 0x88CA'6C00},
      {0x607D, 2, I32, RW, 0x7735'9400},
      {0x6081, 0, U32, RWW},
      {0x6083, 0, U32, RWW},
      {0x6084, 0, U32, RWW},
      {0x6085, 0, U32, RWW},
      {0x6087, 0, U32, RWW, 0},
      {0x6098, 0, I8, RWW, 0},
      {0x6099, 1, U32, RWW, 0},
      {0x6099, 2, U32, RWW, 0},
      {0x609A, 0, U32, RWW},
      {0x60FD, 0, U32, RO, 0},
      {0x60FE, 1, U32, RWW, 0},
      {0x60FE, 2, U32, RWW, 0},
      {0x60FF, 0, I32, RWW},
      {0x6502, 0, U32, RO, 37},
  });
}

struct Setting {
  std::uint16_t index;
  unsigned bytes;
  std::uint32_t lowest;
  std::uint32_t highest;
  std::optional<std::uint32_t> value;
};

// shows 001.112, 001.115..001.121, 001.211
TEST(Manual001, HasTheRangesAndValuesOfTheSettingList) {
  constexpr Setting rows[] = {
      {0x20C9, 2, 0, 3, 0},         {0x20D5, 2, 10, 100, 50},         {0x20E0, 2, 0, 700, 50},
      {0x20F1, 2, 100, 6500, 1500}, {0x20F2, 4, 200, 102'400, 4'000}, {0x20F5, 2, 1, 30'000, 200},
      {0x20CE, 2, 0, 6, {}},
  };
  Drive drive;
  for (const Setting& row : rows) {
    SCOPED_TRACE(row.index);
    if (row.value) {
      EXPECT_EQ(drive.ask(sdo("605", 0x40, row.index, 0, 0)),
                sdo("585", 0x43 | unused(row.bytes), row.index, 0, *row.value));
    }
    EXPECT_EQ(write(drive, row.index, 0, row.bytes, row.lowest), taken(row.index, 0));
    EXPECT_EQ(write(drive, row.index, 0, row.bytes, row.highest), taken(row.index, 0));
    EXPECT_EQ(write(drive, row.index, 0, row.bytes, row.highest + 1), refused(row.index, 0, 0x0609'0031));
    if (row.lowest != 0) {
      EXPECT_EQ(write(drive, row.index, 0, row.bytes, row.lowest - 1), refused(row.index, 0, 0x0609'0032));
    }
  }
}

// shows 001.128..001.130
TEST(Manual001, HasObjectsInTheThreeAreasOnly) {
  Drive drive;
  for (const canopen::EntryDescription& entry : ezd_1136::descriptions) {
    EXPECT_GE(entry.index, 0x1000);
    EXPECT_LE(entry.index, 0x9FFF);
  }
  for (const unsigned index : {0x0000u, 0x0001u, 0x0005u, 0x0020u, 0x0040u, 0x0060u, 0x0080u, 0x00A0u, 0x0FFFu}) {
    const auto at = static_cast<std::uint16_t>(index);
    EXPECT_EQ(drive.ask(sdo("605", 0x40, at, 0, 0)), refused(at, 0, 0x0602'0000));
  }
  EXPECT_EQ(drive.ask(sdo("605", 0x40, 0x607D, 3, 0)), refused(0x607D, 3, 0x0609'0011));
  EXPECT_EQ(drive.ask(sdo("605", 0x40, 0x607D, 2, 0)), sdo("585", 0x43, 0x607D, 2, 2'000'000'000));
}

// shows 001.110, 001.111, 001.124
TEST(Manual001, StatesItsOrderCodeVersionAndProfile) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 08 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 00 45 5A 44 2D 31 31 33");
  EXPECT_EQ(drive.ask("605 70 00 00 00 00 00 00 00"), "585 1D 36 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 18 10 03 00 00 00 00"), "585 43 18 10 03 05 00 01 00");  // 1.5
  EXPECT_EQ(drive.ask("605 40 00 10 00 00 00 00 00").substr(16), "92 01 04 00");       // profile 402
}

// shows 001.136, 001.137
TEST(Manual001, MapsOneObjectAsInTheFigures) {
  struct Figure {
    std::uint16_t communication;
    std::uint16_t mapping;
    std::uint32_t cob_id;
    std::uint32_t object;
  };
  constexpr Figure figures[] = {{0x1400, 0x1600, 0x205, 0x6040'0010}, {0x1800, 0x1A00, 0x185, 0x6041'0010}};
  Drive drive;
  for (const auto& [communication, mapping, cob_id, object] : figures) {
    write(drive, communication, 1, 4, 0x8000'0000 | cob_id);
    EXPECT_EQ(write(drive, mapping, 0, 1, 0), taken(mapping, 0));
    EXPECT_EQ(write(drive, mapping, 1, 4, object), taken(mapping, 1));
    for (std::uint8_t sub_index = 2; sub_index <= 4; ++sub_index) {
      EXPECT_EQ(write(drive, mapping, sub_index, 4, 0), taken(mapping, sub_index));
    }
    EXPECT_EQ(write(drive, mapping, 0, 1, 1), taken(mapping, 0));
    write(drive, communication, 1, 4, cob_id);
    EXPECT_EQ(drive.ask(sdo("605", 0x40, mapping, 0, 0)), sdo("585", 0x4F, mapping, 0, 1));
    EXPECT_EQ(drive.ask(sdo("605", 0x40, mapping, 1, 0)), sdo("585", 0x43, mapping, 1, object));
    EXPECT_EQ(drive.ask(sdo("605", 0x40, mapping, 4, 0)), sdo("585", 0x43, mapping, 4, 0));
  }
  drive.node.set<ezd_1136::od::statusword>(canopen::raw(0x00F3));
  EXPECT_EQ(drive.ask(bench::start).substr(0, 9), "185 F3 00");
  EXPECT_EQ(drive.ask("205 11 22"), "");
  EXPECT_EQ(canopen::to_raw(drive.node.get<ezd_1136::od::controlword>()), 0x2211);
}

// shows 001.190
TEST(Manual001, KeepsTheValuesOfItsGlobalVariables) {
  constexpr std::uint16_t variables[] = {0x21E0, 0x21E2, 0x21E4, 0x21E6, 0x21E8};
  Drive drive;
  for (const std::uint16_t index : variables) {
    EXPECT_EQ(write(drive, index, 0, 4, 0xFFFF'0000u + index), taken(index, 0));
  }
  for (const std::uint16_t index : variables) {
    EXPECT_EQ(drive.ask(sdo("605", 0x40, index, 0, 0)), sdo("585", 0x43, index, 0, 0xFFFF'0000u + index));
  }
}

}  // namespace

/// Manual 000, the servo drive cpc TC1: the tables of chapter 12, with the drive's objects and with the EDS that it
/// sends.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "manual_000_bench.hpp"
#include "manual_000_eds.hpp"
#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::taken;
using manual::write;
using manual_000::Drive;
using manual_000::section_of;
using manual_000::SentEds;

constexpr std::uint32_t not_mappable = 0x0604'0041;
constexpr std::uint32_t read_only = 0x0601'0002;

// The tables "Object description"

enum ObjectCode { variable = 7, array = 8, record = 9 };
enum TypeCode { none = 0, u8 = 5, u16 = 6, u32 = 7, visible_string = 9, domain = 15 };

/// `name`: as printed; `eds_name`: if the EDS has the name of CiA 301 instead.
struct ObjectRow {
  std::uint16_t index;
  const char* name;
  ObjectCode code;
  TypeCode type;
  const char* eds_name = nullptr;
};

// clang-format off
constexpr ObjectRow objects[] = {
    {0x1000, "Device type",                          variable, u32},
    {0x1001, "Error register",                       variable, u8},
    {0x1002, "Manufacturer status register",         variable, u32},
    {0x1003, "Pre-defined error field",              array,    u32},
    {0x1005, "COB-ID SYNC message",                  variable, u32, "COB-ID SYNC"},
    {0x1006, "Communication cycle period",           variable, u32},
    {0x1008, "Manufacturer device name",             variable, visible_string},
    {0x1009, "Manufacturer hardware version",        variable, visible_string},
    {0x100A, "Manufacturer software version",        variable, visible_string},
    {0x1010, "Store parameters",                     array,    u32},
    {0x1011, "Restore default parameters",           array,    u32},
    {0x1013, "High resolution time stamp",           variable, u32},
    {0x1014, "COB-ID EMCY",                          variable, u32},
    {0x1015, "Inhibit time EMCY",                    variable, u16},
    {0x1016, "Consumer heartbeat time",              array,    u32},
    {0x1017, "Producer heartbeat time",              variable, u16},
    {0x1018, "Identity object",                      record,   none},
    {0x1019, "Synchronous counter overflow value",   variable, u8},
    {0x1021, "Store EDS",                            variable, domain},
    {0x1022, "Store format",                         variable, u8},
    {0x1200, "SDO server parameter",                 record,   none},  // printed: Variable
    {0x1400, "RPDO communication parameter",         record,   none, "RPDO communication parameter 1"},
    {0x1401, "RPDO communication parameter",         record,   none, "RPDO communication parameter 2"},
    {0x1402, "RPDO communication parameter",         record,   none, "RPDO communication parameter 3"},
    {0x1403, "RPDO communication parameter",         record,   none, "RPDO communication parameter 4"},
    {0x1600, "RPDO mapping parameter",               record,   none, "RPDO mapping parameter 1"},
    {0x1601, "RPDO mapping parameter",               record,   none, "RPDO mapping parameter 2"},
    {0x1602, "RPDO mapping parameter",               record,   none, "RPDO mapping parameter 3"},
    {0x1603, "RPDO mapping parameter",               record,   none, "RPDO mapping parameter 4"},
    {0x1800, "TPDO communication parameter",         record,   none, "TPDO communication parameter 1"},
    {0x1801, "TPDO communication parameter",         record,   none, "TPDO communication parameter 2"},
    {0x1802, "TPDO communication parameter",         record,   none, "TPDO communication parameter 3"},
    {0x1803, "TPDO communication parameter",         record,   none, "TPDO communication parameter 4"},
    {0x1A00, "TPDO mapping parameter",               record,   none, "TPDO mapping parameter 1"},
    {0x1A01, "TPDO mapping parameter",               record,   none, "TPDO mapping parameter 2"},
    {0x1A02, "TPDO mapping parameter",               record,   none, "TPDO mapping parameter 3"},
    {0x1A03, "TPDO mapping parameter",               record,   none, "TPDO mapping parameter 4"},
};
// clang-format on

std::string hex(unsigned digits, unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%0*X", static_cast<int>(digits), value);
  return text;
}

// shows 000.167, 000.214, 000.241, 000.244, 000.246, 000.249, 000.253, 000.256, 000.259, 000.262, 000.264
// shows 000.267, 000.271, 000.274, 000.277, 000.279, 000.281, 000.284, 000.287, 000.293, 000.296, 000.299
// shows 000.302, 000.307, 000.311, 000.319, 000.327, 000.339, 000.345, 000.346
TEST(Manual000, HasTheObjectDescriptionsOfChapter12) {
  Drive drive;
  const SentEds eds{drive};
  for (const auto& [index, name, code, type, eds_name] : objects) {
    const std::string section = section_of(index);
    SCOPED_TRACE(section);
    EXPECT_EQ(eds.value(section, "ParameterName"), eds_name != nullptr ? eds_name : name);
    EXPECT_EQ(eds.value(section, "ObjectType"), hex(1, code));
    if (code == variable) {
      EXPECT_EQ(eds.value(section, "DataType"), hex(4, type));
    } else {
      EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, 0, 0)).substr(4, 2), "4F");  // sub-index 0: UNSIGNED8
    }
    if (code == array) {
      EXPECT_EQ(eds.value(section_of(index, 1), "DataType"), hex(4, type));
    }
  }
}

// The tables "Entry description"

enum Access { c, ro, rw };
constexpr bool no = false;
constexpr bool yes = true;

struct Range {
  std::uint32_t low, high;
};
constexpr std::optional<Range> any{};
constexpr const char* no_unit = "-";

/// A row without a default value has 0; COB-IDs are those of node 5. The range is the one in the EDS: printed, or
/// decided where the manual contradicts itself.
struct EntryRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  TypeCode type;
  Access access;
  bool mapped;
  std::uint32_t value;
  std::optional<Range> range = any;
  const char* unit = no_unit;
  const char* factor = "-";
};

// clang-format off
constexpr EntryRow entries[] = {
    {0x1000, 0x00, u32, c,  no,  0x0042'0192},
    {0x1001, 0x00, u8,  ro, no,  0},
    {0x1002, 0x00, u32, ro, no,  0},
    {0x1003, 0x00, u8,  rw, no,  0},
    {0x1005, 0x00, u32, rw, no,  0x80, Range{0, 0x8000'07FF}},
    {0x1006, 0x00, u32, rw, no,  0, any, "us"},
    {0x1010, 0x00, u8,  c,  no,  6, Range{0x01, 0x7F}},
    {0x1010, 0x01, u32, rw, no,  1},
    {0x1010, 0x02, u32, rw, no,  1},
    {0x1010, 0x03, u32, rw, no,  1},
    {0x1010, 0x04, u32, rw, no,  1},
    {0x1010, 0x05, u32, rw, no,  1},
    {0x1010, 0x06, u32, rw, no,  1},
    {0x1011, 0x00, u8,  c,  no,  6, Range{0x01, 0x7F}},
    {0x1011, 0x01, u32, rw, no,  1},
    {0x1011, 0x02, u32, rw, no,  1},
    {0x1011, 0x03, u32, rw, no,  1},
    {0x1011, 0x04, u32, rw, no,  1},
    {0x1011, 0x05, u32, rw, no,  1},
    {0x1011, 0x06, u32, rw, no,  1},
    {0x1013, 0x00, u32, rw, yes, 0, any, "us"},
    {0x1014, 0x00, u32, ro, no,  0x80 + 5},
    {0x1015, 0x00, u16, rw, no,  0, any, "us", "100"},
    {0x1016, 0x00, u8,  c,  no,  4, Range{0x01, 0x7F}},
    {0x1016, 0x01, u32, rw, no,  0},
    {0x1016, 0x02, u32, rw, no,  0},
    {0x1016, 0x03, u32, rw, no,  0},
    {0x1016, 0x04, u32, rw, no,  0},
    {0x1017, 0x00, u16, rw, no,  0, any, "ms"},
    {0x1018, 0x00, u8,  ro, no,  4, Range{4, 4}},
    {0x1018, 0x01, u32, ro, no,  0x0000'03F5},
    {0x1018, 0x02, u32, ro, no,  1},
    {0x1018, 0x03, u32, ro, no,  1},
    {0x1018, 0x04, u32, ro, no,  0},
    {0x1019, 0x00, u8,  rw, no,  0, Range{0, 240}},
    {0x1022, 0x00, u8,  ro, no,  0},
    {0x1200, 0x00, u8,  c,  no,  2, Range{2, 2}},
    {0x1200, 0x01, u32, c,  no,  0x600 + 5},
    {0x1200, 0x02, u32, ro, no,  0x580 + 5},
    {0x1400, 0x00, u8,  c,  no,  2, Range{2, 2}},
    {0x1400, 0x01, u32, rw, no,  0x0000'0200 + 5},
    {0x1400, 0x02, u8,  rw, no,  0xFF},
    {0x1401, 0x00, u8,  c,  no,  2, Range{2, 2}},
    {0x1401, 0x01, u32, rw, no,  0x8000'0300 + 5},
    {0x1401, 0x02, u8,  rw, no,  0xFF},
    {0x1402, 0x00, u8,  c,  no,  2, Range{2, 2}},
    {0x1402, 0x01, u32, rw, no,  0x8000'0400 + 5},
    {0x1402, 0x02, u8,  rw, no,  0xFF},
    {0x1403, 0x00, u8,  c,  no,  2, Range{2, 2}},
    {0x1403, 0x01, u32, rw, no,  0x8000'0500 + 5},
    {0x1403, 0x02, u8,  rw, no,  0xFF},
    {0x1600, 0x00, u8,  rw, no,  1, Range{0x00, 0x04}},
    {0x1600, 0x01, u32, rw, no,  0x6040'0010},
    {0x1600, 0x02, u32, rw, no,  0},
    {0x1600, 0x03, u32, rw, no,  0},
    {0x1600, 0x04, u32, rw, no,  0},
    {0x1601, 0x00, u8,  rw, no,  2, Range{0x00, 0x04}},
    {0x1601, 0x01, u32, rw, no,  0x6040'0010},
    {0x1601, 0x02, u32, rw, no,  0x607A'0020},
    {0x1601, 0x03, u32, rw, no,  0},
    {0x1601, 0x04, u32, rw, no,  0},
    {0x1602, 0x00, u8,  rw, no,  2, Range{0x00, 0x04}},
    {0x1602, 0x01, u32, rw, no,  0x6040'0010},
    {0x1602, 0x02, u32, rw, no,  0x60FF'0020},
    {0x1602, 0x03, u32, rw, no,  0},
    {0x1602, 0x04, u32, rw, no,  0},
    {0x1603, 0x00, u8,  rw, no,  0, Range{0x00, 0x04}},
    {0x1603, 0x01, u32, rw, no,  0},
    {0x1603, 0x02, u32, rw, no,  0},
    {0x1603, 0x03, u32, rw, no,  0},
    {0x1603, 0x04, u32, rw, no,  0},
    {0x1800, 0x00, u8,  c,  no,  5, Range{2, 5}},
    {0x1800, 0x01, u32, rw, no,  0x4000'0180 + 5},
    {0x1800, 0x02, u8,  rw, no,  0xFF},
    {0x1800, 0x03, u16, rw, no,  0, any, "us", "100"},
    {0x1800, 0x05, u16, rw, no,  0x64, any, "ms"},
    {0x1801, 0x00, u8,  c,  no,  5, Range{2, 5}},
    {0x1801, 0x01, u32, rw, no,  0x4000'0280 + 5},
    {0x1801, 0x02, u8,  rw, no,  0xFF},
    {0x1801, 0x03, u16, rw, no,  0, any, "us", "100"},
    {0x1801, 0x05, u16, rw, no,  0x64, any, "ms"},
    {0x1802, 0x00, u8,  c,  no,  5, Range{2, 5}},
    {0x1802, 0x01, u32, rw, no,  0x4000'0380 + 5},
    {0x1802, 0x02, u8,  rw, no,  0xFF},
    {0x1802, 0x03, u16, rw, no,  0, any, "us", "100"},
    {0x1802, 0x05, u16, rw, no,  0x64, any, "ms"},
    {0x1803, 0x00, u8,  c,  no,  5, Range{2, 5}},
    {0x1803, 0x01, u32, rw, no,  0x4000'0480 + 5},
    {0x1803, 0x02, u8,  rw, no,  0xFF},
    {0x1803, 0x03, u16, rw, no,  0, any, "us", "100"},
    {0x1803, 0x05, u16, rw, no,  0x64, any, "ms"},
    {0x1A00, 0x00, u8,  rw, no,  1, Range{0x00, 0x04}},
    {0x1A00, 0x01, u32, rw, no,  0x6041'0010},
    {0x1A00, 0x02, u32, rw, no,  0},
    {0x1A00, 0x03, u32, rw, no,  0},
    {0x1A00, 0x04, u32, rw, no,  0},
    {0x1A01, 0x00, u8,  rw, no,  2, Range{0x00, 0x04}},
    {0x1A01, 0x01, u32, rw, no,  0x6041'0010},
    {0x1A01, 0x02, u32, rw, no,  0x6064'0020},
    {0x1A01, 0x03, u32, rw, no,  0},
    {0x1A01, 0x04, u32, rw, no,  0},
    {0x1A02, 0x00, u8,  rw, no,  2, Range{0x00, 0x04}},
    {0x1A02, 0x01, u32, rw, no,  0x6041'0010},
    {0x1A02, 0x02, u32, rw, no,  0x606C'0020},
    {0x1A02, 0x03, u32, rw, no,  0},
    {0x1A02, 0x04, u32, rw, no,  0},
    {0x1A03, 0x00, u8,  rw, no,  2, Range{0x00, 0x04}},
    {0x1A03, 0x01, u32, rw, no,  0x6041'0010},
    {0x1A03, 0x02, u32, rw, no,  0x606C'0020},
    {0x1A03, 0x03, u32, rw, no,  0},
    {0x1A03, 0x04, u32, rw, no,  0},
};
// clang-format on

constexpr unsigned bytes_of(TypeCode type) { return type == u8 ? 1 : type == u16 ? 2 : 4; }

/// 1003h:01 to 10h, which cannot be read without an error.
constexpr EntryRow error_field(std::uint8_t sub_index) { return {0x1003, sub_index, u32, ro, no, 0}; }

/// The keys of an entry in the EDS that the drive sends.
void expect_keys(const SentEds& eds, const EntryRow& row) {
  const bool single = eds.value(section_of(row.index), "ObjectType") == "0x7";
  const std::string section = single ? section_of(row.index) : section_of(row.index, row.sub_index);
  EXPECT_EQ(eds.value(section, "DataType"), hex(4, row.type));
  constexpr const char* words[] = {"const", "ro", "rw"};
  EXPECT_EQ(eds.value(section, "AccessType"), words[row.access]);
  EXPECT_EQ(eds.value(section, "PDOMapping"), row.mapped ? "1" : "0");
  EXPECT_EQ(eds.value(section, "Unit"), row.unit);
  EXPECT_EQ(eds.value(section, "Factor"), row.factor);
  for (const bool high : {false, true}) {
    const std::string limit = eds.value(section, high ? "HighLimit" : "LowLimit");
    EXPECT_EQ(limit == "-", !row.range);
    if (row.range && limit != "-") {
      EXPECT_EQ(std::stoul(limit, nullptr, 0), high ? row.range->high : row.range->low);
    }
  }
}

/// Whether an entry can be mapped into TPDO1 and RPDO1.
void expect_mapping(std::uint16_t index, std::uint8_t sub_index, unsigned bytes, bool mapped) {
  const std::uint32_t mapping = std::uint32_t{index} << 16 | std::uint32_t{sub_index} << 8 | 8 * bytes;
  Drive drive;
  write(drive, 0x1800, 1, 4, 0xC000'0185);
  write(drive, 0x1A00, 0, 1, 0);
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, mapping), mapped ? taken(0x1A00, 1) : refused(0x1A00, 1, not_mappable));
  write(drive, 0x1400, 1, 4, 0x8000'0205);
  write(drive, 0x1600, 0, 1, 0);
  EXPECT_EQ(write(drive, 0x1600, 1, 4, mapping), mapped ? taken(0x1600, 1) : refused(0x1600, 1, not_mappable));
}
void expect_mapping(const EntryRow& row) { expect_mapping(row.index, row.sub_index, bytes_of(row.type), row.mapped); }

// shows 000.28, 000.89, 000.99, 000.111, 000.141, 000.152, 000.155, 000.157, 000.160..000.163, 000.166
// shows 000.168, 000.169, 000.175, 000.177, 000.179, 000.215..000.217, 000.223, 000.240, 000.242, 000.245
// shows 000.247, 000.250, 000.254, 000.257, 000.268, 000.269, 000.272, 000.273, 000.275, 000.276, 000.278
// shows 000.280, 000.282, 000.283, 000.285, 000.288..000.292, 000.294, 000.298, 000.300, 000.301
// shows 000.303..000.305, 000.308..000.310, 000.312..000.315, 000.317, 000.320..000.323, 000.325
// shows 000.328..000.331, 000.344, 000.347
TEST(Manual000, HasTheEntryDescriptionsOfChapter12) {
  Drive sender;
  const SentEds eds{sender};
  for (const EntryRow& row : entries) {
    SCOPED_TRACE(section_of(row.index, row.sub_index));
    const unsigned bytes = bytes_of(row.type);
    expect_keys(eds, row);
    expect_mapping(row);
    Drive drive;
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, row.index, row.sub_index, 0)),
              manual::sdo("585", 0x43 | manual::unused(bytes), row.index, row.sub_index, row.value));
    const std::string answer = write(drive, row.index, row.sub_index, bytes, row.value);
    const std::string refusal = refused(row.index, row.sub_index, read_only);
    EXPECT_EQ(answer == refusal, row.access != rw) << answer;
  }
}

// shows 000.251
TEST(Manual000, HasSixteenErrorFields) {
  Drive drive;
  const SentEds eds{drive};
  for (std::uint8_t sub_index = 1; sub_index <= 0x10; ++sub_index) {
    SCOPED_TRACE(static_cast<unsigned>(sub_index));
    drive.node.emergency(static_cast<std::uint16_t>(0x2300 + sub_index), canopen::ErrorRegister::current);
    drive.pass({});
  }
  for (std::uint8_t sub_index = 1; sub_index <= 0x10; ++sub_index) {
    const EntryRow row = error_field(sub_index);
    expect_keys(eds, row);
    expect_mapping(row);
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, 0x1003, sub_index, 0)),
              manual::sdo("585", 0x43, 0x1003, sub_index, 0x2311u - sub_index));
    EXPECT_EQ(write(drive, 0x1003, sub_index, 4, 0), refused(0x1003, sub_index, read_only));
  }
  EXPECT_FALSE(eds.has(section_of(0x1003, 0x11)));
}

struct TextRow {
  std::uint16_t index;
  Access access;
  TypeCode type;
  const char* text;
};

// shows 000.205, 000.212, 000.258, 000.260, 000.261, 000.263, 000.265, 000.297
TEST(Manual000, HasTheTextsOfChapter12) {
  Drive drive;
  const SentEds eds{drive};
  constexpr TextRow rows[] = {{0x1008, c, visible_string, "TC1-8/230"},  // the manual's first example of a model
                              {0x1009, c, visible_string, "00.100"},
                              {0x100A, c, visible_string, "0.7.15"},  // the only version that the manual names
                              {0x1021, ro, domain, nullptr}};
  for (const auto& [index, access, type, text] : rows) {
    SCOPED_TRACE(section_of(index));
    EXPECT_EQ(manual_000::upload_text(drive, index), text != nullptr ? text : eds.text);
    EXPECT_EQ(write(drive, index, 0, 4, 0), refused(index, 0, read_only));
    EXPECT_EQ(eds.value(section_of(index), "AccessType"), access == c ? "const" : "ro");
    EXPECT_EQ(eds.value(section_of(index), "DataType"), hex(4, type));
    EXPECT_EQ(eds.value(section_of(index), "PDOMapping"), "0");
    EXPECT_EQ(eds.value(section_of(index), "Unit"), "-");
    expect_mapping(index, 0, 4, no);
  }
  EXPECT_GT(eds.text.size(), 20'000u);
}

// shows 000.157, 000.162, 000.254
TEST(Manual000, KeepsItsLimits) {
  Drive drive;
  EXPECT_EQ(write(drive, 0x1005, 0, 4, 0x8000'0081), taken(0x1005, 0));
  EXPECT_EQ(write(drive, 0x1005, 0, 4, 0xC000'0081), refused(0x1005, 0, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x1006, 0, 4, 240), taken(0x1006, 0));
  EXPECT_EQ(write(drive, 0x1006, 0, 4, 241), taken(0x1006, 0));
  EXPECT_EQ(write(drive, 0x1014, 0, 4, 0x86), refused(0x1014, 0, read_only));
  EXPECT_EQ(write(drive, 0x1014, 0, 4, 0x8000'0085), refused(0x1014, 0, read_only));
}

// The objects of the drive

// shows 000.6, 000.158, 000.180, 000.181, 000.213, 000.338, 000.340, 000.343
TEST(Manual000, HasTheObjectsOfTheManualAndNoOther) {
  Drive drive;
  std::set<std::uint16_t> expected{0x6040, 0x6041, 0x6064, 0x606C, 0x607A, 0x60FF};  // of the default mapping
  for (const ObjectRow& row : objects) expected.insert(row.index);
  for (std::uint32_t index = 0x1000; index <= 0xFFFF; ++index) {
    const auto object = static_cast<std::uint16_t>(index);
    const bool exists = drive.ask(manual::sdo("605", 0x40, object, 0, 0)) != refused(object, 0, 0x0602'0000);
    EXPECT_EQ(exists, expected.contains(object)) << section_of(object);
  }
  for (const ObjectRow& row : objects) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, row.index, 0xFF, 0)), refused(row.index, 0xFF, 0x0609'0011));
  }
}

// shows 000.13, 000.150, 000.192, 000.218, 000.295, 000.342
TEST(Manual000, TheEdsDescribesTheDrive) {
  Drive drive;
  const SentEds eds{drive};
  EXPECT_EQ(eds.value("DeviceInfo", "VendorName"), "Chieftek Precision Co., Ltd.");
  EXPECT_EQ(eds.value("DeviceInfo", "VendorNumber"), "0x000003F5");
  EXPECT_EQ(eds.value("DeviceInfo", "SimpleBootUpMaster"), "0");
  EXPECT_EQ(eds.value("DeviceInfo", "SimpleBootUpSlave"), "1");
  EXPECT_EQ(eds.value("DeviceInfo", "Granularity"), "8");
  EXPECT_EQ(eds.value("DeviceInfo", "NrOfRXPDO"), "4");
  EXPECT_EQ(eds.value("DeviceInfo", "NrOfTXPDO"), "4");
  EXPECT_EQ(eds.value("DeviceInfo", "LSS_Supported"), "1");
  for (const char* rate : {"10", "20", "50", "125", "250", "500", "800", "1000"}) {
    EXPECT_EQ(eds.value("DeviceInfo", "BaudRate_" + std::string{rate}), "1");
  }
  EXPECT_NE(eds.value("FileInfo", "EDSVersion"), "-");
  for (const EntryRow& row : entries) EXPECT_TRUE(eds.has(section_of(row.index)));
  write(drive, 0x1400, 1, 4, 0x8000'0205);
  write(drive, 0x1600, 0, 1, 0);
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x6040'0004), refused(0x1600, 1, not_mappable));  // 4 bits
}

}  // namespace

/// Data types that a file or CiA 301 defines: all rows of the predefined records, and invalid definitions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::DataType;

/// A RECORD of a type, whose sub-objects have no DataType of their own.
std::string record_of_type(std::string_view type, int sub_index) {
  return fmt::format(
      "[2000]\nParameterName=Record\nObjectType=0x9\nSubNumber=2\nDataType={}\n"
      "[2000sub0]\nParameterName=Count\nObjectType=0x7\nDataType=0x5\nAccessType=const\nDefaultValue={}\n"
      "[2000sub{:X}]\nParameterName=Member\nObjectType=0x7\nAccessType=rw\n",
      type, sub_index, sub_index);
}

struct TypedMember {
  int sub_index;
  DataType type;
};

struct PredefinedRecord {
  std::string_view code;
  std::vector<TypedMember> members;
  int beyond;  ///< the sub-index after the last one
};

/// CiA 301, 7.4.8: the records with the data types 20h to 25h.
const PredefinedRecord predefined_records[] = {
    {"0x0020",
     {{1, DataType::unsigned32},  // COB-ID
      {2, DataType::unsigned8},   // transmission type
      {3, DataType::unsigned16},  // inhibit time
      {4, DataType::unsigned8},   // reserved
      {5, DataType::unsigned16},  // event timer
      {6, DataType::unsigned8}},  // SYNC start value
     7},
    {"0x0021", {{1, DataType::unsigned32}, {2, DataType::unsigned32}, {0x40, DataType::unsigned32}}, 0x41},
    {"0x0022",
     {{1, DataType::unsigned32},  // COB-ID client -> server
      {2, DataType::unsigned32},  // COB-ID server -> client
      {3, DataType::unsigned8}},  // node-ID of the other node
     4},
    {"0x0023",
     {{1, DataType::unsigned32},   // vendor-ID
      {2, DataType::unsigned32},   // product code
      {3, DataType::unsigned32},   // revision number
      {4, DataType::unsigned32}},  // serial number
     5},
    {"0x0024",
     {{1, DataType::octet_string},   // command to the debugger
      {2, DataType::unsigned8},      // status
      {3, DataType::octet_string}},  // reply
     4},
    {"0x0025",
     {{1, DataType::octet_string},   // command to the operating system
      {2, DataType::unsigned8},      // status
      {3, DataType::octet_string}},  // reply
     4},
};

TEST(TypeTable, GivesEachMemberOfAPredefinedRecordItsType) {
  for (const PredefinedRecord& record : predefined_records) {
    for (const TypedMember& member : record.members) {
      const DeviceFromText text(record_of_type(record.code, member.sub_index));
      const Entry* const entry = text.device.find(0x2000, static_cast<std::uint8_t>(member.sub_index));
      ASSERT_NE(entry, nullptr) << record.code << " sub-index " << member.sub_index;
      EXPECT_EQ(entry->type->type, member.type) << record.code << " sub-index " << member.sub_index;
    }
  }
}

TEST(TypeTable, HasNoMemberAfterTheLastOneOfAPredefinedRecord) {
  for (const PredefinedRecord& record : predefined_records) {
    const DeviceFromText text(record_of_type(record.code, record.beyond));
    EXPECT_EQ(text.entry(0x2000, static_cast<std::uint8_t>(record.beyond)).type->type, DataType::domain) << record.code;
    EXPECT_EQ(text.finding("data-type").severity, Severity::error) << record.code;
  }
}

TEST(TypeTable, TakesAllCodesFrom20hTo3FhForRecords) {
  for (int code = 0x20; code <= 0x3F; ++code) {
    const DeviceFromText text(var("2000", "Value", fmt::format("0x{:04X}", code)));
    EXPECT_EQ(text.finding("complex-data-type").severity, Severity::warning) << code;
  }
}

/// A range of a type: a RECORD with the index of the type, and its lowest and highest value.
std::string range_of_type(std::string_view type) {
  return fmt::format(
      "[00A0]\nParameterName=Range\nObjectType=0x9\nSubNumber=4\n"
      "[00A0sub0]\nParameterName=Count\nDataType=0x5\n"
      "[00A0sub1]\nParameterName=Type\nDataType=0x5\nDefaultValue={}\n"
      "[00A0sub2]\nParameterName=Low\nDataType=0x6\nDefaultValue=5\n"
      "[00A0sub3]\nParameterName=High\nDataType=0x6\nDefaultValue=60\n",
      type);
}

TEST(TypeTable, WarnsOfARangeWhoseTypeIsUnknown) {
  for (const char* type : {"0x0099", "0", "", "UNSIGNED16"}) {
    const DeviceFromText text(range_of_type(type) + var("2000", "Speed", "0x00A0"));
    EXPECT_EQ(findings(text.diagnostics, "type-definition").size(), 1U) << type;
    EXPECT_EQ(text.finding("type-definition").severity, Severity::warning) << type;
    EXPECT_EQ(text.finding("data-type").severity, Severity::error) << type;
    EXPECT_EQ(text.entry(0x2000).type->type, DataType::domain) << type;
  }
}

TEST(TypeTable, WarnsOfADefstructWhoseMemberIsOfAnUnknownType) {
  const DeviceFromText text(
      "[0060]\nParameterName=Axis\nObjectType=0x6\nSubNumber=2\n"
      "[0060sub0]\nParameterName=Count\nDataType=0x5\n"
      "[0060sub1]\nParameterName=Position\nDataType=0x6\nDefaultValue=0x0099\n" +
      record_of_type("0x0060", 1));
  EXPECT_EQ(text.line_of("type-definition"), "DefaultValue=0x0099");
  EXPECT_EQ(text.entry(0x2000, 1).type->type, DataType::domain);
}

// ---- object codes ----

TEST(ObjectCode, OfADomainWithSubIndex0IsThatOfARecord) {
  for (const char* code : {"0x2", "0x7"}) {
    const DeviceFromText text(group("2000", "Program", code, 2) +
                              "[2000sub0]\nParameterName=Count\nDataType=0x5\nAccessType=ro\nDefaultValue=1\n"
                              "[2000sub1]\nParameterName=Part\nObjectType=0x2\nDataType=0xF\nAccessType=rw\n");
    ASSERT_NE(text.device.find(0x2000), nullptr) << code;
    EXPECT_EQ(text.device.find(0x2000)->type, ObjectType::record) << code;
    EXPECT_EQ(text.entry(0x2000, 1).type->type, DataType::domain) << code;
    EXPECT_EQ(text.line_of("object-type"), std::string{"ObjectType="} + code);
  }
}

}  // namespace
}  // namespace edsc

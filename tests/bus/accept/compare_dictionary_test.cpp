/// The comparison of a device with its EDS: each kind of difference, each evidence. What is expected comes from CiA 301
/// and the texts of the EDS.
#include "accept/compare_dictionary.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "accept/decisions.hpp"
#include "compared.hpp"
#include "dictionary_port.hpp"
#include "support/device_from_text.hpp"

namespace edsc::accept {
namespace {

/// The ids of the rows that have decided, over all tests.
std::set<std::string>& used_evidence() {
  static std::set<std::string> used;
  return used;
}

/// `1018h:02 value eds_wrong device-info [1018sub2] DefaultValue=0x41 => 0x00000042`
std::string line_of(const Difference& one) {
  std::string line = fmt::format("{} {} {} {}", entry_label(one.index, one.sub_index), row_of(one.kind).name,
                                 row_of(one.mark).name, one.evidence);
  for (const Correction& correction : one.corrections) {
    line += fmt::format(" [{}] {}={} => {}", correction.section, correction.key, correction.old_text.value_or(""),
                        correction.new_text);
  }
  return line;
}

/// Expects these differences, each with a request and a response, a reason, and without a write.
void expect(const std::string& eds, const std::function<void(DictionaryPort&)>& change,
            const std::vector<std::string>& expected) {
  const Compared result = run(eds, change);
  std::vector<std::string> found;
  for (const Difference& one : result.comparison.differences) {
    found.push_back(line_of(one));
    used_evidence().emplace(one.evidence);
    EXPECT_FALSE(one.reason.empty());
    EXPECT_EQ(one.reason.find("  "), std::string::npos) << one.reason;
    ASSERT_FALSE(one.frames.empty());
    EXPECT_TRUE(one.frames.front().sent);
    EXPECT_EQ(one.frames.front().frame.id, 0x605U);
    if (one.kind != Kind::no_response) {
      EXPECT_FALSE(one.frames.at(1).sent);
      EXPECT_EQ(one.frames.at(1).frame.id, 0x585U);
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_TRUE(result.comparison.is_complete()) << result.comparison.lost;
  EXPECT_EQ(result.downloads, 0U);
}

const ComparedEntry& entry_of(const Comparison& comparison, unsigned index, unsigned sub_index) {
  for (const ComparedEntry& entry : comparison.entries) {
    if (entry.index == index && entry.sub_index == sub_index) return entry;
  }
  throw std::runtime_error{"no such entry"};
}

const auto unchanged = [](DictionaryPort&) {};

TEST(CompareDictionary, FindsNothingInTheDeviceOfTheEds) {
  expect(base_eds(), unchanged, {});
  const Compared result = run(base_eds(), unchanged);
  EXPECT_EQ(result.comparison.entries.size(), 7U);
  const ComparedEntry& code = entry_of(result.comparison, 0x1018, 2);
  EXPECT_EQ(code.exists, Aspect::same);
  EXPECT_EQ(code.length, Aspect::same);
  EXPECT_EQ(code.readable, Aspect::same);
  EXPECT_EQ(code.value, Aspect::same);
  EXPECT_EQ(code.limits, Aspect::not_compared);
  EXPECT_EQ(compare_identity(result.comparison.in_eds, result.comparison.in_device), IdentityMatch::same);
}

/// One step of 6501h is 0.001 um.
TEST(CompareDictionary, ValuesHaveTheUnitOfTheirEntry) {
  const std::string step = var("6501", "Measuring step", u32, "const", value("200000") + "Unit=um\nFactor=0.001\n");
  const Compared result = run(base_eds() + step, [](DictionaryPort& device) {
    device.values[{0x6501, 0}] = {0xA0, 0x86, 0x01, 0};
  });
  ASSERT_EQ(result.comparison.differences.size(), 1U);
  EXPECT_EQ(result.comparison.differences.front().in_eds, "200 um");
  EXPECT_EQ(result.comparison.differences.front().in_device, "100 um");
  EXPECT_EQ(entry_of(result.comparison, 0x6501, 0).default_value, "200 um");
}

// ---- missing objects ----

TEST(CompareDictionary, AMandatoryObjectIsMissingInTheDevice) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values.erase({0x1001, 0});
         },
         {"1001h:00 object_missing device_wrong mandatory-object"});
}

TEST(CompareDictionary, AnOptionalObjectIsUndecided) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values.erase({0x1017, 0});
         },
         {"1017h:00 object_missing undecided optional-object [1017] Remove= => 1"});
}

/// CiA 402 requires 6040h.
TEST(CompareDictionary, TheProfileOfTheDeviceRequiresAnObject) {
  expect(base_eds() + var("6040", "Controlword", u16), unchanged,
         {"6040h:00 object_missing device_wrong profile-object"});
}

/// CiA 301, 7.5.2.6: 1006h is a parameter of SYNC, 1005h.
TEST(CompareDictionary, AnotherObjectOfTheDeviceRequiresAnObject) {
  expect(base_eds() + var("1005", "COB-ID SYNC", u32, "rw", value("0x80")) + var("1006", "Cycle period", u32),
         [](DictionaryPort& device) {
           device.values[{0x1006, 0}] = {0, 0, 0, 0};
         },
         {"1005h:00 object_missing device_wrong needed-object"});
}

std::string tpdo(int number) {
  const std::string communication = fmt::format("18{:02}", number - 1), mapping = fmt::format("1A{:02}", number - 1);
  return group(communication, "TPDO parameter", "0x9", 3) + var(communication + "sub0", "Count", u8, "ro", value("2")) +
         var(communication + "sub1", "COB-ID", u32, "rw", value(fmt::format("$NODEID+0x{:X}", 0x80 + 0x100 * number))) +
         var(communication + "sub2", "Type", u8, "rw", value("255")) + group(mapping, "TPDO mapping", "0x9", 1) +
         var(mapping + "sub0", "Count", u8, "rw", value("0"));
}
void fill_tpdo(DictionaryPort& device, unsigned number) {
  const unsigned communication = 0x1800 + number - 1;
  device.values[{communication, 0}] = {2};
  device.values[{communication, 1}] = {0x85, static_cast<std::uint8_t>(number), 0, 0};
  device.values[{communication, 2}] = {255};
  device.values[{communication + 0x200, 0}] = {0};
}

TEST(CompareDictionary, APdoHasBothParameters) {
  expect(base_eds() + tpdo(1),
         [](DictionaryPort& device) {
           fill_tpdo(device, 1);
           device.values.erase({0x1A00, 0});
         },
         {"1A00h:00 object_missing device_wrong needed-object"});
}

/// NrOfTXPDO of [DeviceInfo] is 1.
TEST(CompareDictionary, TheEdsHasMorePdosThanItCounts) {
  expect(base_eds() + tpdo(1) + tpdo(2), [](DictionaryPort& device) { fill_tpdo(device, 1); },
         {"1801h:00 object_missing eds_wrong pdo-count [1801] Remove= => 1",
          "1A01h:00 object_missing eds_wrong pdo-count [1A01] Remove= => 1"});
}

TEST(CompareDictionary, TheObjectListsOfTheEdsDoNotHaveTheObject) {
  const std::string lists =
      "[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n"
      "[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n";
  expect(lists + base_eds() + var("2000", "Not listed", u16), unchanged,
         {"2000h:00 object_missing eds_wrong object-not-listed [2000] Remove= => 1"});
}

// ---- missing sub-indices ----

/// CiA 301, 7.5.2.21: sub-index 1, the vendor-ID, is mandatory.
TEST(CompareDictionary, ARequiredSubIndexIsMissingInTheDevice) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values.erase({0x1018, 1});
         },
         {"1018h:01 sub_index_missing device_wrong required-sub-index"});
}

TEST(CompareDictionary, AnOptionalSubIndexIsUndecided) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values.erase({0x1018, 2});
         },
         {"1018h:02 sub_index_missing undecided optional-sub-index [1018sub2] Remove= => 1"});
}

std::string array_of(unsigned described, std::string_view count, std::string_view type = u16) {
  std::string text =
      group("2010", "Gains", "0x8", static_cast<int>(described) + 1) + var("2010sub0", "Count", u8, "ro", value(count));
  for (unsigned i = 1; i <= described; ++i) text += sub("2010", static_cast<int>(i), fmt::format("Gain {}", i), type);
  return text;
}
std::function<void(DictionaryPort&)> with_array(unsigned elements, std::uint8_t count) {
  return [=](DictionaryPort& device) {
    device.values[{0x2010, 0}] = {count};
    for (unsigned i = 1; i <= elements; ++i) device.values[{0x2010, i}] = {7, 0};
  };
}

TEST(CompareDictionary, TheEdsDescribesMoreThanItCounts) {
  expect(base_eds() + array_of(3, "2"), with_array(2, 2),
         {"2010h:03 sub_index_missing eds_wrong eds-count [2010sub3] Remove= => 1"});
}

/// An unused entry of the error history is neither missing nor a difference (CiA 301, 7.5.2.4).
TEST(CompareDictionary, AnUnusedEntryOfTheErrorHistoryIsNoDifference) {
  const std::string history = group("1003", "Pre-defined error field", "0x8", 3) +
                              var("1003sub0", "Count", u8, "rw", value("0")) + var("1003sub1", "Error", u32, "ro") +
                              var("1003sub2", "Error", u32, "ro");
  expect(base_eds() + history,
         [](DictionaryPort& device) {
           device.values[{0x1003, 0}] = {0};
           device.aborts[{0x1003, 1}] = 0x0800'0024;
         },
         {});
}

// ---- entries that only the device has ----

TEST(CompareDictionary, TheEdsLacksAMandatoryObject) {
  std::string eds = base_eds();
  eds.erase(eds.find("[1001]"), eds.find("[1017]") - eds.find("[1001]"));
  expect(eds, unchanged,
         {"1001h:00 not_in_eds eds_wrong required-entry [1001] ParameterName= => error register "
          "[1001] DataType= => 0x0005 [1001] AccessType= => ro"});
}

/// CiA 301, 7.5.2.21: sub-index 4, the serial number, is optional.
TEST(CompareDictionary, AnAdditionalSubIndexOfTheStandardIsUndecided) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values[{0x1018, 0}] = {4};
           device.values[{0x1018, 4}] = {0, 0, 0, 0};
         },
         {"1018h:00 value undecided constant [1018sub0] DefaultValue=3 => 4",
          "1018h:04 not_in_eds undecided additional-entry [1018sub4] ParameterName= => identity object "
          "[1018sub4] DataType= => 0x0007 [1018sub4] AccessType= => ro"});
}

/// CiA 301, 7.5.2.21: the identity object has sub-indices 0 to 4.
TEST(CompareDictionary, TheDeviceHasASubIndexThatTheStandardDoesNotDefine) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.values[{0x1018, 0}] = {5};
           device.values[{0x1018, 5}] = {0, 0, 0, 0};
         },
         {"1018h:00 value device_wrong standard-count", "1018h:05 not_in_eds device_wrong undefined-sub-index"});
}

TEST(CompareDictionary, TheEdsCountsMoreThanItDescribes) {
  expect(base_eds() + array_of(2, "3"), with_array(3, 3),
         {"2010h:03 not_in_eds eds_wrong eds-counts-more [2010sub3] ParameterName= => Gains 3 "
          "[2010sub3] DataType= => 0x0006 [2010sub3] AccessType= => rw"});
}

TEST(CompareDictionary, AnAdditionalElementIsUndecided) {
  expect(base_eds() + array_of(2, "2"), with_array(3, 3),
         {"2010h:00 value undecided constant [2010sub0] DefaultValue=2 => 3",
          "2010h:03 not_in_eds undecided additional-entry [2010sub3] ParameterName= => Gains 3 "
          "[2010sub3] DataType= => 0x0006 [2010sub3] AccessType= => rw"});
}

// ---- length ----

std::function<void(DictionaryPort&)> with_value(unsigned index, unsigned sub_index, Bytes bytes) {
  return [=](DictionaryPort& device) { device.values[{index, sub_index}] = bytes; };
}

/// CiA 301, 7.5.2.20: 1017h is UNSIGNED16.
TEST(CompareDictionary, TheDeviceHasAnotherTypeThanTheStandard) {
  expect(base_eds(), with_value(0x1017, 0, {0, 0, 0, 0}), {"1017h:00 length device_wrong standard-type"});
}

TEST(CompareDictionary, TheEdsHasAnotherTypeThanTheStandard) {
  std::string eds = base_eds();
  const std::size_t at = eds.find("DataType=0x6");
  eds.replace(at, 12, "DataType=0x7");
  expect(eds, unchanged, {"1017h:00 length eds_wrong eds-type [1017] DataType=0x7 => 0x0006"});
}

TEST(CompareDictionary, NeitherHasTheTypeOfTheStandard) {
  std::string eds = base_eds();
  eds.replace(eds.find("DataType=0x6"), 12, "DataType=0x7");
  expect(eds, with_value(0x1017, 0, {0}), {"1017h:00 length device_wrong no-standard-type"});
}

/// CiA 402: 6041h is UNSIGNED16; the device states CiA 402 in 1000h.
TEST(CompareDictionary, AProfileDefinesTheType) {
  expect(base_eds() + var("6041", "Statusword", u8, "ro"), with_value(0x6041, 0, {0x40, 2}),
         {"6041h:00 length eds_wrong eds-type [6041] DataType=0x5 => 0x0006"});
}

TEST(CompareDictionary, ATypeThatNoStandardDefinesIsUndecided) {
  expect(base_eds() + var("2000", "Speed", u16), with_value(0x2000, 0, {1, 0, 0, 0}),
         {"2000h:00 length undecided free-type [2000] DataType=0x6 => 0x0007"});
}

std::string mapped_speed(std::string_view type, std::string_view mapping) {
  return base_eds() + var("2000", "Speed", type, "ro", "PDOMapping=1\n") + group("1800", "TPDO", "0x9", 3) +
         var("1800sub0", "Count", u8, "ro", value("2")) + var("1800sub1", "COB-ID", u32, "rw", value("$NODEID+0x180")) +
         var("1800sub2", "Type", u8, "rw", value("255")) + group("1A00", "Mapping", "0x9", 2) +
         var("1A00sub0", "Count", u8, "rw", value("1")) + var("1A00sub1", "Mapping", u32, "rw", value(mapping));
}
void fill_mapped_speed(DictionaryPort& device, Bytes speed, std::uint8_t bits) {
  fill_tpdo(device, 1);
  device.values[{0x1A00, 0}] = {1};
  device.values[{0x1A00, 1}] = {bits, 0, 0, 0x20};
  device.values[{0x2000, 0}] = std::move(speed);
}

TEST(CompareDictionary, TheDeviceMapsAnEntryWithTheLengthOfTheEds) {
  expect(mapped_speed(u16, "0x20000010"), [](DictionaryPort& device) { fill_mapped_speed(device, {1}, 16); },
         {"2000h:00 length device_wrong device-mapping"});
}

TEST(CompareDictionary, TheEdsMapsAnEntryWithTheLengthOfTheDevice) {
  expect(mapped_speed(u16, "0x20000008"), [](DictionaryPort& device) { fill_mapped_speed(device, {1}, 8); },
         {"2000h:00 length eds_wrong eds-mapping [2000] DataType=0x6 => 0x0005"});
}

// ---- access ----

/// CiA 301, 7.5.2.20: 1017h is rw.
TEST(CompareDictionary, TheDeviceDoesNotGiveAValueThatTheStandardMakesReadable) {
  expect(base_eds(),
         [](DictionaryPort& device) {
           device.aborts[{0x1017, 0}] = 0x0601'0001;
         },
         {"1017h:00 access device_wrong standard-access"});
}

TEST(CompareDictionary, TheEdsMakesAnObjectWriteOnlyThatTheStandardMakesReadable) {
  std::string eds = base_eds();
  eds.replace(eds.find("AccessType=rw"), 13, "AccessType=wo");
  expect(eds, unchanged, {"1017h:00 access eds_wrong eds-access [1017] AccessType=wo => rw"});
}

/// CiA 402-2: 6041h and 6064h are ro, 6040h is rw. The objects of the second axis are 800h above.
TEST(CompareDictionary, AProfileDefinesTheAccess) {
  expect(base_eds() + var("6064", "Position", i32, "wo"), with_value(0x6064, 0, {1, 0, 0, 0}),
         {"6064h:00 access eds_wrong eds-access [6064] AccessType=wo => ro"});
  expect(base_eds() + var("6864", "Position", i32, "wo"), with_value(0x6864, 0, {1, 0, 0, 0}),
         {"6864h:00 access eds_wrong eds-access [6864] AccessType=wo => ro"});
  const auto write_only = [](DictionaryPort& device) { device.aborts[{0x6041, 0}] = 0x0601'0001; };
  expect(base_eds() + var("6041", "Statusword", u16, "ro"), write_only,
         {"6041h:00 access device_wrong standard-access"});
  expect(base_eds() + var("6040", "Controlword", u16, "wo"), with_value(0x6040, 0, {0, 0}),
         {"6040h:00 access undecided free-access [6040] AccessType=wo => rw"});
  const Compared result = run(base_eds() + var("6064", "Position", i32, "wo"), with_value(0x6064, 0, {1, 0, 0, 0}));
  EXPECT_EQ(result.comparison.differences.at(0).reason,
            "CiA 402 does not allow the access of the EDS, wo, and allows the access of the device");
}

/// Without the profile in 1000h, no standard defines the access.
TEST(CompareDictionary, AProfileThatTheDeviceDoesNotStateDefinesNothing) {
  expect(base_eds() + var("6064", "Position", i32, "wo"),
         [](DictionaryPort& device) {
           device.values[{0x1000, 0}] = {0x91, 1, 0, 0};
           device.values[{0x6064, 0}] = {1, 0, 0, 0};
         },
         {"1000h:00 value undecided other-identity [1000] DefaultValue=0x192 => 0x00000191",
          "6064h:00 access undecided free-access [6064] AccessType=wo => rw"});
}

TEST(CompareDictionary, AnAccessThatNoStandardDefinesIsUndecided) {
  expect(base_eds() + var("2000", "Command", u16, "wo"), with_value(0x2000, 0, {1, 0}),
         {"2000h:00 access undecided free-access [2000] AccessType=wo => rw"});
  expect(base_eds() + var("2000", "Command", u16),
         [](DictionaryPort& device) {
           device.aborts[{0x2000, 0}] = 0x0601'0001;
         },
         {"2000h:00 access undecided free-access [2000] AccessType=rw => wo"});
}

TEST(CompareDictionary, AWriteOnlyEntryThatIsNotReadIsNoDifference) {
  expect(base_eds() + var("2000", "Command", u16, "wo"),
         [](DictionaryPort& device) {
           device.aborts[{0x2000, 0}] = 0x0601'0001;
         },
         {});
}

// ---- values ----

TEST(CompareDictionary, DeviceInfoHasTheNumberOfTheDevice) {
  expect(base_eds("0x41"), unchanged,
         {"1018h:02 value eds_wrong device-info [1018sub2] DefaultValue=0x41 => 0x00000042"});
}

TEST(CompareDictionary, AnotherRevisionIsUndecided) {
  expect(base_eds(), with_value(0x1018, 3, {1, 0, 1, 0}),
         {"1018h:03 value undecided other-identity [1018sub3] DefaultValue=0x10000 => 0x00010001"});
}

/// CiA 301, 7.5.2.37: the default COB-ID of TPDO 1 is 180h and the node-ID.
TEST(CompareDictionary, TheEdsHasACobIdWithoutTheNodeId) {
  std::string eds = base_eds() + tpdo(1);
  eds.replace(eds.find("$NODEID+0x180"), 13, "0x180");
  expect(eds, [](DictionaryPort& device) { fill_tpdo(device, 1); },
         {"1800h:01 value eds_wrong eds-cob-id [1800sub1] DefaultValue=0x180 => $NODEID+0x180"});
}

/// CiA 301, 7.5.2.33: the COB-IDs of the default SDO are 600h and 580h and the node-ID.
std::string default_sdo(std::string_view request) {
  return group("1200", "SDO server", "0x9", 3) + var("1200sub0", "Count", u8, "ro", value("2")) +
         var("1200sub1", "Request", u32, "ro", value(request)) +
         var("1200sub2", "Response", u32, "ro", value("$NODEID+0x580"));
}
std::function<void(DictionaryPort&)> with_default_sdo(std::uint8_t request) {
  return [=](DictionaryPort& device) {
    device.values[{0x1200, 0}] = {2};
    device.values[{0x1200, 1}] = {request, 6, 0, 0};
    device.values[{0x1200, 2}] = {0x85, 5, 0, 0};
  };
}

TEST(CompareDictionary, TheEdsHasAnotherCobIdOfTheDefaultSdo) {
  expect(base_eds() + default_sdo("0x601"), with_default_sdo(5),
         {"1200h:01 value eds_wrong eds-cob-id [1200sub1] DefaultValue=0x601 => $NODEID+0x600"});
}

/// 620h and node-ID 5 are 625h.
TEST(CompareDictionary, AFormulaOfTheEdsHasItsValueForTheNode) {
  const Compared result = run(base_eds() + default_sdo("$NODEID+0x620"), with_default_sdo(5));
  ASSERT_EQ(result.comparison.differences.size(), 1U);
  const Difference& one = result.comparison.differences.front();
  EXPECT_EQ(one.in_eds, "$NODEID+0x620 (00000625h)");
  EXPECT_EQ(one.in_device, "00000605h");
}

TEST(CompareDictionary, TheDeviceHasAnotherCobIdOfTheDefaultSdo) {
  expect(base_eds() + default_sdo("$NODEID+0x600"), with_default_sdo(9),
         {"1200h:01 value device_wrong predefined-cob-id"});
}

TEST(CompareDictionary, SubIndex0OfTheEdsIsNotItsHighestSubIndex) {
  expect(base_eds() + array_of(2, "4"), with_array(2, 2),
         {"2010h:00 value eds_wrong eds-sub-index-0 [2010sub0] DefaultValue=4 => 2"});
}

TEST(CompareDictionary, SubIndex0OfTheDeviceIsNotItsHighestSubIndex) {
  expect(base_eds() + array_of(2, "2"), with_array(2, 6), {"2010h:00 value device_wrong device-sub-index-0"});
  expect(base_eds() + array_of(2, "2"), with_array(2, 1), {"2010h:00 value device_wrong device-sub-index-0"});
}

TEST(CompareDictionary, AConstantThatNoStandardDefinesIsUndecided) {
  expect(base_eds() + var("2001", "Version", text_type, "const", value("V1.0")),
         with_value(0x2001, 0, {'V', '1', '.', '1'}),
         {"2001h:00 value undecided constant [2001] DefaultValue=V1.0 => V1.1"});
}

/// A value that a user may have stored, or that the device measures.
TEST(CompareDictionary, AStoredOrLiveValueIsNoDifference) {
  const std::string eds = base_eds() + var("2000", "Speed", u16, "ro", value("0"));
  const auto change = [](DictionaryPort& device) {
    device.values[{0x1017, 0}] = {200, 0};
    device.values[{0x2000, 0}] = {1, 0};
  };
  expect(eds, change, {});
  const Compared result = run(eds, change);
  EXPECT_EQ(entry_of(result.comparison, 0x1017, 0).value, Aspect::may_differ);
  EXPECT_EQ(entry_of(result.comparison, 0x2000, 0).value, Aspect::may_differ);
}

// ---- limits ----

TEST(CompareDictionary, AValueOutsideLimitsIsUndecided) {
  expect(base_eds() + var("2000", "Level", u8, "rw", "HighLimit=10\n"), with_value(0x2000, 0, {11}),
         {"2000h:00 limit undecided free-limit [2000] HighLimit=10 => 0x0B"});
  expect(base_eds() + var("2000", "Offset", "0x2", "rw", "LowLimit=-5\n"), with_value(0x2000, 0, {0xF0}),
         {"2000h:00 limit undecided free-limit [2000] LowLimit=-5 => -16"});
  expect(base_eds() + var("2000", "Level", u8, "rw", "HighLimit=10\n"), with_value(0x2000, 0, {10}), {});
}

TEST(CompareDictionary, TheDefaultValueOfTheEdsIsOutsideItsLimits) {
  expect(base_eds() + var("2000", "Level", u8, "rw", "HighLimit=10\nDefaultValue=12\n"), with_value(0x2000, 0, {12}),
         {"2000h:00 limit eds_wrong eds-default [2000] HighLimit=10 => 12"});
}

/// CiA 301, 7.5.2.22: the counter of SYNC is 0 or 2 to 240.
TEST(CompareDictionary, TheStandardReservesTheValue) {
  expect(base_eds() + var("1005", "COB-ID SYNC", u32, "rw", value("0x80")) +
             var("1019", "Counter overflow", u8, "rw", "HighLimit=240\nDefaultValue=0\n"),
         [](DictionaryPort& device) {
           device.values[{0x1005, 0}] = {0x80, 0, 0, 0};
           device.values[{0x1019, 0}] = {250};
         },
         {"1019h:00 limit device_wrong reserved-value"});
}

// ---- no value ----

TEST(CompareDictionary, AnAbortWithoutACauseIsUndecided) {
  expect(base_eds() + var("2000", "Speed", u16),
         [](DictionaryPort& device) {
           device.aborts[{0x2000, 0}] = 0x0800'0000;
         },
         {"2000h:00 unreadable undecided abort-without-cause"});
}

TEST(CompareDictionary, AnAbortThatDependsOnTheStateIsNoDifference) {
  const auto change = [](DictionaryPort& device) { device.aborts[{0x2000, 0}] = 0x0800'0022; };
  const std::string eds = base_eds() + var("2000", "Speed", u16);
  expect(eds, change, {});
  EXPECT_FALSE(entry_of(run(eds, change).comparison, 0x2000, 0).remark.empty());
}

TEST(CompareDictionary, ARequestWithoutResponseIsUndecided) {
  expect(base_eds() + var("2000", "Speed", u16),
         [](DictionaryPort& device) {
           device.silent.insert({0x2000, 0});
         },
         {"2000h:00 no_response undecided no-response"});
}

/// ObjFlags bit 1: configuration tools do not read the entry (CiA 306-1, 4.6.2).
TEST(CompareDictionary, AnEntryThatObjFlagsExcludeIsNotRead) {
  const std::string eds = base_eds() + var("2000", "Secret", u16, "rw", "ObjFlags=2\n");
  expect(eds, unchanged, {});
  EXPECT_EQ(entry_of(run(eds, unchanged).comparison, 0x2000, 0).exists, Aspect::not_compared);
}

// ---- the comparison as a whole ----

TEST(CompareDictionary, ADifferenceThatASecondReadDoesNotShowIsNone) {
  const auto change = [](DictionaryPort& device) { device.first_values[{0x1017, 0}] = {0, 0, 0, 0}; };
  expect(base_eds(), change, {});
  EXPECT_EQ(run(base_eds(), change).comparison.unstable.size(), 1U);
}

TEST(CompareDictionary, EndsWhenTheDeviceDoesNotRespond) {
  const Compared result = run(base_eds(), [](DictionaryPort& device) { device.silent.insert({0x1000, 0}); });
  EXPECT_EQ(result.comparison.lost, "node 5 does not respond");
  EXPECT_TRUE(result.comparison.entries.empty());
}

TEST(CompareDictionary, EndsWhenTheDeviceNoLongerResponds) {
  std::string eds = base_eds();
  for (int i = 0; i != 9; ++i) eds += var(fmt::format("200{}", i), fmt::format("Value {}", i), u16);
  const Compared result = run(eds, [](DictionaryPort& device) {
    for (unsigned i = 0; i != 9; ++i) device.silent.insert({0x2000 + i, 0});
  });
  EXPECT_EQ(result.comparison.lost, "node 5 no longer responds");
  EXPECT_TRUE(result.comparison.differences.empty());
}

// ---- the table of decisions ----

TEST(Decisions, EachIsUsedByATest) {
  std::set<std::string> all;
  for (const Decision& row : decisions()) all.emplace(row.id);
  EXPECT_EQ(all.size(), decisions().size());
  EXPECT_EQ(used_evidence(), all);
}

TEST(Decisions, OfADeviceThatIsWrongDoNotChangeTheEds) {
  for (const Decision& row : decisions()) {
    if (row.mark == Mark::undecided) continue;
    EXPECT_EQ(row.correct != nullptr, row.mark == Mark::eds_wrong) << row.id;
  }
}

/// The table of docs/accept.md has each row.
TEST(Decisions, AreDocumented) {
  std::ifstream file{EDSC_SOURCE_DIR "/docs/accept.md"};
  const std::string page{std::istreambuf_iterator<char>{file}, {}};
  for (const Decision& row : decisions()) {
    const std::string line =
        fmt::format("| `{}` | {} | {} | {} |", row.id, row_of(row.kind).text, row.evidence, row_of(row.mark).text);
    EXPECT_NE(page.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace edsc::accept

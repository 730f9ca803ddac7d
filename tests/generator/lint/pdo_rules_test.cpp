#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lint/rule_groups.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Rules = std::vector<std::string>;

/// Objects of every access type, for mappings.
const std::string objects =
    "[DummyUsage]\nDummy0005=1\nDummy0006=0\n" + var("2000", "Input", "0x0006", "ro", "PDOMapping=1\n") +
    var("2001", "Output", "0x0006", "wo", "PDOMapping=1\n") +
    var("2002", "Process output", "0x0006", "rww", "PDOMapping=1\n") +
    var("2003", "Process input", "0x0006", "rwr", "PDOMapping=1\n") +
    var("2004", "Parameter", "0x0006", "rw", "PDOMapping=0\n") + var("2005", "Text", "0x0009", "rw", "PDOMapping=1\n") +
    var("2008", "Name", "0x0009", "ro", "PDOMapping=1\nDefaultValue=READY\n") +
    var("2009", "Memory", "0x000F", "rw", "PDOMapping=1\n") + var("2006", "Switch", "0x0001", "rw", "PDOMapping=1\n") +
    var("2007", "Position", "0x0007", "rw", "PDOMapping=1\n");

/// PDO 1 of one direction that maps these words; it is valid after a reset unless `cob_id` says otherwise.
std::string pdo(bool receive, const std::vector<std::string>& mapping, std::string_view cob_id = "$NODEID+0x200") {
  const std::string communication = receive ? "1400" : "1800";
  const std::string parameter = receive ? "1600" : "1A00";
  std::string text = group(communication, "Communication", "0x9", 2) +
                     var(communication + "sub0", "Count", "5", "ro", "DefaultValue=1\n") +
                     var(communication + "sub1", "COB-ID", "7", "rw", fmt::format("DefaultValue={}\n", cob_id)) +
                     group(parameter, "Mapping", "0x9", static_cast<int>(mapping.size()) + 1) +
                     var(parameter + "sub0", "Count", "5", "ro", fmt::format("DefaultValue={}\n", mapping.size()));
  for (std::size_t i = 0; i < mapping.size(); ++i) {
    text += var(fmt::format("{}sub{:X}", parameter, i + 1), fmt::format("Entry {}", i + 1), "7", "ro",
                fmt::format("DefaultValue={}\n", mapping[i]));
  }
  return objects + text;
}

/// Mappings are checked when the device is resolved.
using CheckedPdos = DeviceFromText;

/// Expects one finding, of `rule`, at the line of the mapping entry with this word.
void expect_one(const CheckedPdos& checked, Severity severity, const std::string& rule, const std::string& word) {
  ASSERT_EQ(rules_of(checked.diagnostics), Rules{rule});
  EXPECT_EQ(checked.finding(rule).severity, severity);
  EXPECT_EQ(checked.line_of(rule), "DefaultValue=" + word);
  EXPECT_EQ(checked.finding(rule).position.column, 14U);
}

bool message_has(const CheckedPdos& checked, const std::string& rule, const std::string& text) {
  return checked.finding(rule).message.find(text) != std::string::npos;
}

TEST(PdoRules, AreSilentOnAGoodMapping) {
  for (const bool receive : {true, false}) {
    const std::string first = receive ? "0x20020010" : "0x20000010";
    const CheckedPdos checked(pdo(receive, {first, "0x20070020", "0x20060001"}));
    EXPECT_EQ(rules_of(checked.diagnostics), Rules{});
    EXPECT_FALSE(checked.device.pdos.front().broken);
    EXPECT_EQ(checked.device.pdos.front().bits(), 49U);
  }
}

TEST(PdoRules, RefuseAnObjectThatTheDeviceDoesNotHave) {
  const CheckedPdos checked(pdo(false, {"0x21000010"}));
  expect_one(checked, Severity::error, "pdo-object", "0x21000010");
  EXPECT_TRUE(message_has(checked, "pdo-object", "TPDO 1"));
  EXPECT_TRUE(message_has(checked, "pdo-object", "2100h:00"));
  EXPECT_TRUE(message_has(checked, "pdo-object", "which does not exist"));
  EXPECT_TRUE(checked.device.pdos.front().broken);
}

TEST(PdoRules, RefuseASubIndexThatTheObjectDoesNotHave) {
  const CheckedPdos checked(pdo(true, {"0x20020110"}));
  expect_one(checked, Severity::error, "pdo-object", "0x20020110");
  EXPECT_TRUE(message_has(checked, "pdo-object", "2002h:01"));
  EXPECT_TRUE(message_has(checked, "pdo-object", "a sub-index that does not exist"));
}

TEST(PdoRules, RefuseAnObjectThatCannotBeMapped) {
  const CheckedPdos checked(pdo(false, {"0x20000010", "0x20040010"}));
  expect_one(checked, Severity::error, "pdo-mappable", "0x20040010");
  EXPECT_TRUE(message_has(checked, "pdo-mappable", "2004h:00 \"Parameter\""));
}

TEST(PdoRules, RefuseAnObjectOfTheOtherDirection) {
  struct Row {
    bool receive;
    const char* word;
    const char* object;
  };
  for (const Row& row :
       {Row{true, "0x20000010", "2000h:00 \"Input\""}, Row{true, "0x20030010", "2003h:00 \"Process input\""},
        Row{false, "0x20010010", "2001h:00 \"Output\""}, Row{false, "0x20020010", "2002h:00 \"Process output\""}}) {
    const CheckedPdos checked(pdo(row.receive, {row.word}));
    expect_one(checked, Severity::error, "pdo-direction", row.word);
    EXPECT_TRUE(message_has(checked, "pdo-direction", row.object)) << row.object;
  }
}

TEST(PdoRules, RefuseAnotherLengthThanTheObjectHas) {
  const CheckedPdos checked(pdo(false, {"0x20000008"}));
  expect_one(checked, Severity::error, "pdo-length", "0x20000008");
  EXPECT_TRUE(message_has(checked, "pdo-length", "2000h:00 \"Input\""));
  EXPECT_TRUE(message_has(checked, "pdo-length", "UNSIGNED16"));
}

TEST(PdoRules, RefuseAValueOfNoFixedLength) {
  const CheckedPdos checked(pdo(false, {"0x20050010"}));
  expect_one(checked, Severity::error, "pdo-variable-length", "0x20050010");
  EXPECT_TRUE(message_has(checked, "pdo-variable-length", "2005h:00 \"Text\""));
  EXPECT_TRUE(message_has(checked, "pdo-variable-length", "VISIBLE_STRING"));
}

TEST(PdoRules, LetAStringTakeAsManyBytesAsItHasRoomFor) {
  EXPECT_EQ(rules_of(CheckedPdos(pdo(false, {"0x20080028"})).diagnostics), Rules{});
  EXPECT_EQ(rules_of(CheckedPdos(pdo(false, {"0x20080018"})).diagnostics), Rules{});
  const CheckedPdos longer(pdo(false, {"0x20080030"}));
  expect_one(longer, Severity::error, "pdo-length", "0x20080030");
  EXPECT_TRUE(message_has(longer, "pdo-length", "TPDO 1 entry 1 maps 48 bits of 2008h:00 \"Name\""));
}

TEST(PdoRules, LetTheOptionsSayHowMuchAStringHolds) {
  Options options;
  options.string_capacity[{0x2005, 0}] = 4;
  EXPECT_EQ(rules_of(CheckedPdos(pdo(true, {"0x20050020"}), options).diagnostics), Rules{});
  EXPECT_EQ(rules_of(CheckedPdos(pdo(true, {"0x20050028"}), options).diagnostics), Rules{"pdo-length"});
}

TEST(PdoRules, RefusePartsOfAByteOfAString) {
  const CheckedPdos checked(pdo(false, {"0x2008000C"}));
  expect_one(checked, Severity::error, "pdo-variable-length", "0x2008000C");
  EXPECT_TRUE(message_has(checked, "pdo-variable-length", "expected a multiple of 8 bits"));
}

TEST(PdoRules, RefuseADomain) {
  expect_one(CheckedPdos(pdo(false, {"0x20090020"})), Severity::error, "pdo-variable-length", "0x20090020");
}

TEST(PdoRules, NameTheEntry) {
  const CheckedPdos checked(pdo(false, {"0x20000010", "0x20020010"}));
  EXPECT_TRUE(message_has(checked, "pdo-direction",
                          "TPDO 1 entry 2 maps 2002h:00 \"Process output\", which is not TPDO-mappable"));
  const CheckedPdos sub_index(pdo(true, {"0x20020110"}));
  EXPECT_TRUE(message_has(sub_index, "pdo-object", "entry 1 maps 2002h:01 of \"Process output\""));
  const CheckedPdos dummy(pdo(true, {"0x00060010"}));
  EXPECT_TRUE(message_has(dummy, "pdo-dummy", "entry 1 maps the dummy 0006h UNSIGNED16"));
  const CheckedPdos size(pdo(false, {"0x20070020", "0x20070020", "0x20000010"}));
  EXPECT_TRUE(message_has(size, "pdo-size", "which entry 3, 2000h:00 \"Input\" exceeds"));
}

TEST(PdoRules, LetABooleanTakeAByteWithAWarning) {
  const CheckedPdos checked(pdo(false, {"0x20060008"}));
  expect_one(checked, Severity::warning, "pdo-boolean-byte", "0x20060008");
  EXPECT_TRUE(message_has(checked, "pdo-boolean-byte", "2006h:00 \"Switch\""));
  EXPECT_FALSE(checked.device.pdos.front().broken);
}

TEST(PdoRules, RefuseMoreThan64BitsAtTheEntryThatIsTooMuch) {
  const CheckedPdos checked(pdo(false, {"0x20070020", "0x20070020", "0x20000010"}));
  expect_one(checked, Severity::error, "pdo-size", "0x20000010");
  EXPECT_TRUE(message_has(checked, "pdo-size", "80 bits"));
  EXPECT_FALSE(CheckedPdos(pdo(false, {"0x20070020", "0x20070020"})).device.pdos.front().broken);
}

TEST(PdoRules, RefuseMoreThan64Objects) {
  const CheckedPdos checked(pdo(false, std::vector<std::string>(65, "0x20060001")));
  EXPECT_EQ(rules_of(checked.diagnostics), (Rules{"pdo-size", "pdo-entries"}));
  EXPECT_EQ(rules_of(CheckedPdos(pdo(false, std::vector<std::string>(64, "0x20060001"))).diagnostics), Rules{});
}

TEST(PdoRules, LetAnRpdoMapADummyThatTheDeviceAllows) {
  const CheckedPdos checked(pdo(true, {"0x00050008", "0x20020010"}));
  EXPECT_EQ(rules_of(checked.diagnostics), Rules{});
  EXPECT_EQ(checked.device.pdos.front().bits(), 24U);
}

TEST(PdoRules, RefuseADummyThatTheDeviceDoesNotAllow) {
  const CheckedPdos checked(pdo(true, {"0x00060010"}));
  expect_one(checked, Severity::error, "pdo-dummy", "0x00060010");
  EXPECT_TRUE(message_has(checked, "pdo-dummy", "UNSIGNED16"));
}

TEST(PdoRules, RefuseADummyInATpdo) {
  expect_one(CheckedPdos(pdo(false, {"0x00050008"})), Severity::error, "pdo-dummy", "0x00050008");
}

TEST(PdoRules, RefuseADummyOfAnotherLength) {
  expect_one(CheckedPdos(pdo(true, {"0x00050010"})), Severity::error, "pdo-length", "0x00050010");
}

TEST(PdoRules, WarnOnlyWhenThePdoIsOffByDefault) {
  const CheckedPdos checked(pdo(false, {"0x20040010"}, "$NODEID+0x80000180"));
  expect_one(checked, Severity::warning, "pdo-mappable", "0x20040010");
  EXPECT_TRUE(message_has(checked, "pdo-mappable", "disabled by default"));
  EXPECT_TRUE(checked.device.pdos.front().broken) << "no layout can be made of it all the same";
}

TEST(PdoRules, WarnOfAPdoThatLacksOneOfItsParameters) {
  DeviceFromText communication(objects + group("1801", "Communication", "0x9", 2) +
                               var("1801sub0", "Count", "5", "ro", "DefaultValue=1\n") +
                               var("1801sub1", "COB-ID", "7", "rw", "DefaultValue=$NODEID+0x280\n"));
  check_pdo_communication({communication.device, communication.sheet, {}, communication.diagnostics});
  ASSERT_EQ(rules_of(communication.diagnostics), Rules{"pdo-pair"});
  EXPECT_EQ(communication.line_of("pdo-pair"), "[1801]");
  EXPECT_TRUE(message_has(communication, "pdo-pair", "TPDO 2 has no mapping parameter 1A01h"));

  DeviceFromText mapping(objects + group("1603", "Mapping", "0x9", 1) +
                         var("1603sub0", "Count", "5", "ro", "DefaultValue=0\n"));
  check_pdo_communication({mapping.device, mapping.sheet, {}, mapping.diagnostics});
  ASSERT_EQ(rules_of(mapping.diagnostics), Rules{"pdo-pair"});
  EXPECT_TRUE(message_has(mapping, "pdo-pair", "RPDO 4 has no communication parameter 1403h"));
}

TEST(PdoRules, ReportEachWrongEntry) {
  const CheckedPdos checked(pdo(false, {"0x20040010", "0x21000010", "0x20010010"}));
  EXPECT_EQ(rules_of(checked.diagnostics), (Rules{"pdo-mappable", "pdo-object", "pdo-direction"}));
}

}  // namespace
}  // namespace edsc

#include "device/options/options.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "device/options/option_table.hpp"
#include "support/diagnostic_matchers.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

using Findings = std::vector<Finding>;
using Runtime = ReadOptions::Runtime;

/// An options file with one option.
std::string in_group(const OptionRow& row, const std::string& value) {
  return fmt::format(R"({{ "{}": {{ "{}": {} }} }})", row.group.name, row.name, value);
}

TEST(OptionsFile, MayBeEmpty) {
  const ReadOptions read(R"({ "$schema": "options.schema.json" })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_FALSE(read.options.zero_terminated_strings);
  EXPECT_EQ(read.runtime(), Runtime{});
}

TEST(OptionsFile, NamesEntriesByIndexAndSubIndex) {
  const ReadOptions read(
      R"({ "names": { "1018h:04": "serial", "2000": "speed", "2A:fF": "last", "FFFFh": "highest" } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.names.at({0x1018, 4}), "serial");
  EXPECT_EQ(read.options.names.at({0x2000, 0}), "speed");
  EXPECT_EQ(read.options.names.at({0x2A, 0xFF}), "last");
  EXPECT_EQ(read.options.names.at({0xFFFF, 0}), "highest");
}

TEST(OptionsFile, TakesNamesThatAreIdentifiersOnly) {
  for (const char* name : {"", "class", "Speed", "1st", "a b", "a-b", "x;int y",
                           "gr\xC3\xB6\xC3\x9F"
                           "e",
                           "type"}) {
    const ReadOptions read("{\n  \"names\": {\n    \"2000h\": \"" + std::string{name} + "\"\n  }\n}\n");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(3, 5, "options")})) << name;
    EXPECT_TRUE(read.options.names.empty()) << name;
  }
}

TEST(OptionsFile, GivesStringsTheirCapacity) {
  const ReadOptions read(R"({ "string_capacity": { "1008h:00": 15, "2000h": 0, "2001h": 65535 } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.string_capacity.at({0x1008, 0}), 15);
  EXPECT_EQ(read.options.string_capacity.at({0x2001, 0}), 65535);
}

TEST(OptionsFile, RefusesACapacityOutside0To65535) {
  for (const char* value : {"-1", "65536", "1.5", "\"15\"", "null"}) {
    const ReadOptions read("{\n\"string_capacity\": { \"1008h\": " + std::string{value} + " } }");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(2, 22, "options")})) << value;
  }
}

TEST(OptionsFile, ListsWhatTheApplicationSets) {
  const ReadOptions read(R"({ "settable": ["1008h:00", "1018h:04"] })");
  EXPECT_EQ(read.options.settable, (std::vector<EntryKey>{{0x1008, 0}, {0x1018, 4}}));
}

TEST(OptionsFile, ListsRulesToSilence) {
  const ReadOptions read(R"({ "silence": ["sub-number", "object-type"] })");
  ASSERT_EQ(read.options.silence.size(), 2U);
  EXPECT_EQ(read.options.silence[0].rule, "sub-number");
  EXPECT_EQ(read.options.silence[1].rule, "object-type");
  EXPECT_EQ(read.options.silence[1].position.column, 29U);
}

TEST(OptionsFile, ListsAllowedFindings) {
  const ReadOptions read(R"({ "allow": [
{"rule": "pdo-empty", "reason": "mapped at \"start\""},
{"rule": "live-default", "object": "6401h:03", "reason": "of the manual"}, {"object": "6040h", "rule": "a", "reason": "b"}] })");
  EXPECT_TRUE(findings(read.diagnostics).empty());
  ASSERT_EQ(read.options.allow.size(), 3U);
  EXPECT_EQ(read.options.allow[0].rule, "pdo-empty");
  EXPECT_EQ(read.options.allow[0].reason, "mapped at \"start\"");
  EXPECT_EQ(read.options.allow[0].object, std::nullopt);
  EXPECT_EQ(read.options.allow[0].position.line, 2U);
  EXPECT_EQ(read.options.allow[1].object, (EntryAddress{0x6401, 3}));
  EXPECT_EQ(read.options.allow[2].object, (EntryAddress{0x6040, std::nullopt}));
}

TEST(OptionsFile, RefusesAllowedFindingsWithoutRuleOrReason) {
  for (const char* item :
       {R"("pdo-empty")", R"({"rule": "a"})", R"({"rule": "a", "reason": " "})", R"({"reason": "a"})",
        R"({"rule": 1, "reason": "a"})", R"({"rule": "a", "reason": "b", "object": "x"})",
        R"({"rule": "a", "reason": "b", "entry": "6040h"})"}) {
    const ReadOptions read("{\"allow\": [" + std::string{item} + "]}");
    EXPECT_EQ(read.diagnostics.errors(), 1U) << item;
    EXPECT_TRUE(read.options.allow.empty()) << item;
  }
  EXPECT_EQ(ReadOptions(R"({"allow": {}})").diagnostics.errors(), 1U);
}

TEST(OptionsFile, NamesASimilarOption) {
  const ReadOptions read(R"({ "setable": [], "colour": 1, "allow": [{"rul": "a"}] })");
  EXPECT_EQ(messages(read.diagnostics), (std::vector<std::string>{
                                            "allow.rul: unknown member; did you mean \"rule\"?",
                                            "colour: unknown option",
                                            "setable: unknown option; did you mean \"settable\"?",
                                        }));
}

TEST(OptionsFile, SaysThatStringsEndWithAZero) {
  EXPECT_TRUE(ReadOptions(R"({ "sdo": { "zero_terminated_strings": true } })").options.zero_terminated_strings);
  EXPECT_FALSE(ReadOptions(R"({ "sdo": { "zero_terminated_strings": false } })").options.zero_terminated_strings);
}

TEST(OptionsFile, HandsEachDepartureToTheRuntime) {
  for (const OptionRow& row : options_table) {
    if (row.form != OptionForm::flag || row.group.name == "lss") continue;
    for (const char* value : {"true", "false"}) {
      const ReadOptions read(in_group(row, value));
      EXPECT_EQ(findings(read.diagnostics), Findings{}) << row.name;
      EXPECT_EQ(read.runtime(), (Runtime{{member_of(row), value}}));
    }
  }
  for (const std::string group : {"pdo", "sync", "emcy"}) {
    EXPECT_EQ(ReadOptions("{ \"" + group + R"(": { "cob_id_writable": "0x80000780" } })").runtime(),
              (Runtime{{group + "_cob_id_writable", "0x80000780"}}));
  }
  EXPECT_EQ(ReadOptions(R"({ "pdo": { "inhibit_time_unit": 1000 } })").runtime(),
            (Runtime{{"inhibit_time_unit", "1000"}}));
  EXPECT_EQ(ReadOptions(R"({ "emcy": { "inhibit_time_step": 10 } })").runtime(),
            (Runtime{{"emcy_inhibit_time_step", "10"}}));
  for (const std::string value : {"0", "1000", "65535"}) {
    EXPECT_EQ(ReadOptions("{ \"sdo\": { \"timeout\": " + value + " } }").runtime(), (Runtime{{"sdo_timeout", value}}));
  }
  EXPECT_EQ(ReadOptions(R"({ "pdo": { "reserved_can_ids": ["0x80", "0x100"] } })").runtime(),
            (Runtime{{"pdo_reserved_can_ids", "{0x080, 0x100}"}}));
  EXPECT_EQ(ReadOptions(R"({ "emcy": { "reset_code": "ff00h" } })").runtime(),
            (Runtime{{"reset_emergency", "0xFF00"}}));
  EXPECT_EQ(ReadOptions(R"({ "pdo": { "mapping_abort_code": "0x6040041" } })").runtime(),
            (Runtime{{"pdo_mapping_abort_code", "0x06040041"}}));
  EXPECT_EQ(ReadOptions(R"({ "emcy": { "history_abort_code": "0x06090031" } })").runtime(),
            (Runtime{{"error_history_abort_code", "0x06090031"}}));
  EXPECT_EQ(ReadOptions(R"({ "storage": { "signature_abort_code": "0x08000022" } })").runtime(),
            (Runtime{{"storage_signature_abort_code", "0x08000022"}}));
}

TEST(OptionsFile, SaysHowLssConfiguresTheDevice) {
  EXPECT_FALSE(ReadOptions("{}").options.lss.has_value());
  EXPECT_EQ(ReadOptions(R"({ "lss": {} })").options.lss, LssSettings{});
  EXPECT_EQ(ReadOptions(R"({ "lss": { "bit_rates": "fixed" } })").options.lss->bit_rates, 0);
  EXPECT_EQ(ReadOptions(R"({ "lss": { "bit_rates": [10, 125, 1000] } })").options.lss->bit_rates, 0x0111);
  EXPECT_EQ(ReadOptions(R"({ "lss": { "bit_rates": [500, "auto"] } })").options.lss->bit_rates, 0x0204);
  const ReadOptions read(R"({ "lss": { "unconfigurable": false, "served_in_operational": true } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.lss->flags,
            (std::map<std::string, bool>{{"served_in_operational", true}, {"unconfigurable", false}}));
}

TEST(OptionsFile, RefusesWhatLssDoesNotHave) {
  for (const char* lss : {"true", "[125]", R"({ "bit_rates": [] })", R"({ "bit_rates": 125 })",
                          R"({ "bit_rates": [100] })", R"({ "bit_rates": [0] })", R"({ "bit_rates": ["fixed"] })",
                          R"({ "bit_rates": [125, true] })", R"({ "fastscan": 1 })", R"({ "fast_scan": true })"}) {
    const ReadOptions read("{ \"lss\": " + std::string{lss} + " }");
    EXPECT_EQ(read.diagnostics.errors(), 1u) << lss;
  }
}

TEST(OptionsFile, SaysWhatTheDeviceKeepsOfItsDataSheet) {
  EXPECT_EQ(ReadOptions(R"({ "stored_eds": false })").options.stored_eds, StoredEds::of_application);
  EXPECT_EQ(ReadOptions(R"({ "stored_eds": true })").options.stored_eds, StoredEds::text);
  EXPECT_EQ(ReadOptions(R"({ "stored_eds": "compressed" })").options.stored_eds, StoredEds::compressed);
  for (const char* value : {"1", "\"gzip\"", "null", "[]"}) {
    const ReadOptions read("{ \"stored_eds\": " + std::string{value} + " }");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(1, 3, "options")})) << value;
  }
}

TEST(OptionsFile, MakesTheMappingOfAllPdosStatic) {
  EXPECT_TRUE(ReadOptions(R"({ "pdo": { "static_mapping": true } })").options.static_mapping.applies_to(0x1600));
  EXPECT_FALSE(ReadOptions(R"({ "pdo": { "static_mapping": false } })").options.static_mapping.applies_to(0x1600));
}

TEST(OptionsFile, MakesTheMappingOfSomePdosStatic) {
  const ReadOptions read(R"({ "pdo": { "static_mapping": ["1600h", "17FF", "1A00h", "1bffh"] } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.static_mapping.parameters, (std::vector<std::uint16_t>{0x1600, 0x17FF, 0x1A00, 0x1BFF}));
  EXPECT_TRUE(read.options.static_mapping.applies_to(0x1A00));
  EXPECT_FALSE(read.options.static_mapping.applies_to(0x1A01));
}

TEST(OptionsFile, RefusesAStaticMappingOfWhatIsNoMappingParameter) {
  for (const char* index : {"15FFh", "1800h", "19FFh", "1C00h", "1600h:01", "", "11600h"}) {
    const ReadOptions read("{\"pdo\": {\n  \"static_mapping\": [\"" + std::string{index} + "\"] }}");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(2, 22, "options")})) << index;
    EXPECT_TRUE(read.options.static_mapping.parameters.empty()) << index;
  }
}

TEST(OptionsFile, NamesObjectsAndEntriesThatRaiseNoEvent) {
  const ReadOptions read(R"({ "pdo": { "no_event": ["6401h", "6000h:02", "2000h:00"] } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.no_event, (std::vector<EntryAddress>{{0x6401, {}}, {0x6000, 2}, {0x2000, 0}}));
}

TEST(OptionsFile, SaysWhatIsStored) {
  const ReadOptions read(
      R"({ "storage": { "entries": { "1005h": "with_node_id", "6010:01": "never", "6081h:00": "always" } } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  using Row = std::pair<EntryAddress, std::string>;
  EXPECT_EQ(read.options.storing,
            (std::vector<Row>{{{0x1005, {}}, "with_node_id"}, {{0x6010, 1}, "never"}, {{0x6081, 0}, "always"}}));
}

TEST(OptionsFile, RefusesAnotherWayToStore) {
  for (const char* member :
       {R"("6010h": "by_access")", R"("6010h": true)", R"("6010h:100": "never")", R"("2000h": "with_node_id")"}) {
    const ReadOptions read("{\"storage\": {\n\"entries\": { " + std::string{member} + " } } }");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(2, 14, "options")})) << member;
    EXPECT_TRUE(read.options.storing.empty()) << member;
  }
}

TEST(OptionsFile, GivesEmergenciesTheirBytes) {
  const ReadOptions read(R"({ "emcy": { "info": { "8210h": "0900000000", "ff00": "0a0B0c0D0e" } } })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.options.emergency_info.at(0x8210), (EmergencyInfo{9, 0, 0, 0, 0}));
  EXPECT_EQ(read.options.emergency_info.at(0xFF00), (EmergencyInfo{0x0A, 0x0B, 0x0C, 0x0D, 0x0E}));
}

TEST(OptionsFile, RefusesAnEmergencyWithoutCodeOrFiveBytes) {
  for (const char* member :
       {R"("": "0900000000")", R"("10000h": "0900000000")", R"("x": "0900000000")", R"("8210h": "09")",
        R"("8210h": "090000000000")", R"("8210h": "09000000+1")", R"("8210h": "090000000x")", R"("8210h": 9)"}) {
    const ReadOptions read("{ \"emcy\": { \"info\": { " + std::string{member} + " } } }");
    ASSERT_EQ(read.diagnostics.errors(), 1U) << member;
    EXPECT_EQ(read.diagnostics.all().front().rule.text(), "options") << member;
    EXPECT_TRUE(read.options.emergency_info.empty()) << member;
  }
}

TEST(OptionsFile, RefusesAValueOfTheWrongType) {
  for (const char* member : {R"("names": [])",
                             R"("names": { "2000h": 1 })",
                             R"("string_capacity": 5)",
                             R"("settable": "1008h:00")",
                             R"("settable": [4104])",
                             R"("silence": {})",
                             R"("silence": [1])",
                             R"("sdo": {"zero_terminated_strings": 1})",
                             R"("pdo": {"extended_ids": "no"})",
                             R"("pdo": {"event_driven_on_change": null})",
                             R"("pdo": {"cob_id_writable": 5})",
                             R"("pdo": {"cob_id_writable": "all"})",
                             R"("pdo": {"cob_id_writable": "0x1FFFFFFFF"})",
                             R"("pdo": {"mapping_abort_code": 100925505})",
                             R"("pdo": {"mapping_abort_code": "0"})",
                             R"("pdo": {"mapping_abort_code": "0x06040040"})",
                             R"("pdo": {"mpdo": 1})",
                             R"("sync": {"cob_id_writable": true})",
                             R"("pdo": {"inhibit_time_unit": 0})",
                             R"("pdo": {"inhibit_time_unit": 32768})",
                             R"("pdo": {"inhibit_time_unit": "100"})",
                             R"("emcy": {"inhibit_time_step": 0})",
                             R"("emcy": {"inhibit_time_step": 65536})",
                             R"("emcy": {"inhibit_time_step": -1})",
                             R"("pdo": {"reserved_can_ids": "0x080"})",
                             R"("pdo": {"reserved_can_ids": ["0x080"]})",
                             R"("pdo": {"reserved_can_ids": ["0x100", "0x080"]})",
                             R"("pdo": {"reserved_can_ids": ["0x080", "0x800"]})",
                             R"("pdo": {"reserved_can_ids": ["x", "0x100"]})",
                             R"("pdo": {"reserved_can_ids": [128, 256]})",
                             R"("emcy": {"reset_code": 65280})",
                             R"("emcy": {"reset_code": "0000h"})",
                             R"("emcy": {"reset_code": "x"})",
                             R"("pdo": {"static_mapping": "1600h"})",
                             R"("pdo": {"static_mapping": [5632]})",
                             R"("pdo": {"no_event": "6401h"})",
                             R"("pdo": {"no_event": [25601]})",
                             R"("pdo": {"no_event": ["6401h:100"]})",
                             R"("emcy": {"info": ["8210h"]})"}) {
    const ReadOptions read("{ " + std::string{member} + " }");
    ASSERT_EQ(read.diagnostics.errors(), 1U) << member;
    EXPECT_EQ(read.diagnostics.all().front().rule.text(), "options") << member;
    EXPECT_EQ(read.runtime(), Runtime{}) << member;
  }
}

TEST(OptionsFile, RefusesEntriesThatAreNone) {
  for (const char* entry : {"", "h", "G000", "1018h:", "1018h:100", "10000h", "1018h:4:5", "-1"}) {
    const ReadOptions read("{ \"settable\": [\"" + std::string{entry} + "\"] }");
    EXPECT_EQ(read.diagnostics.errors(), 1U) << entry;
    EXPECT_TRUE(read.options.settable.empty()) << entry;
  }
}

TEST(OptionsFile, ReportsTheSecondOfTwoMembersWithOneName) {
  const std::pair<const char*, Finding> rows[] = {
      {"{ \"sdo\": {\"timeout\": 5},\n  \"sdo\": {\"zero_terminated_strings\": true} }",
       error_at(2, 3, "options-syntax")},
      {"{ \"sdo\": {\"timeout\": 5,\n\"timeout\": 6} }", error_at(2, 1, "options-syntax")},
      {"{ \"sdo\": {\"timeout\": 5,\n\"time\\u006fut\": 5} }", error_at(2, 1, "options-syntax")},
      {"{ \"allow\": [{\"rule\": \"pdo-empty\", \"reason\": \"a\", \"rule\": \"sub-number\"}] }",
       error_at(1, 50, "options-syntax")},
      {"{ \"names\": {\"2000h\": \"a\"}, \"names\": {\"2000h\": \"b\"} }", error_at(1, 28, "options-syntax")},
      {"{ \"names\": {\"2000h\": \"a\", \"2000h:00\": \"b\"} }", error_at(1, 27, "options")},
      {"{ \"string_capacity\": {\"2000h\": 1, \"2000:0\": 2} }", error_at(1, 35, "options")},
      {"{ \"emcy\": {\"info\": {\"8210h\": \"0900000000\", \"8210\": \"0900000001\"}} }", error_at(1, 44, "options")},
      {"{ \"storage\": {\"entries\": {\"6010:01\": \"never\", \"6010h:01\": \"always\"}} }",
       error_at(1, 47, "options")},
  };
  for (const auto& [text, finding] : rows) {
    const ReadOptions read(text);
    EXPECT_EQ(findings(read.diagnostics), Findings{finding}) << text;
    ASSERT_EQ(read.diagnostics.all().front().notes.size(), 1U) << text;
  }
}

TEST(OptionsFile, MayRepeatANameInAnotherObject) {
  const ReadOptions read(
      R"({ "sdo": {"timeout": 5}, "allow": [{"rule": "a", "reason": "b"}, {"rule": "a", "reason": "b"}],
    "names": {"1018h:04": "timeout"} /* "names": {} */ })");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
}

TEST(OptionsFile, HasAPositionForEachAllowedFinding) {
  const ReadOptions read(
      "{ \"silence\": [\"pdo-empty\",\n\"pdo-empty\"], \"allow\": [\n{\"rule\": \"a\", \"reason\": \"pdo-empty\"},\n"
      "{\"reason\": \"pdo-empty\", \"rule\": \"a\"}] }");
  ASSERT_EQ(read.options.allow.size(), 2U);
  EXPECT_EQ(read.options.allow[0].position.line, 3U);
  EXPECT_EQ(read.options.allow[0].position.column, 25U);
  EXPECT_EQ(read.options.allow[1].position.line, 4U);
  EXPECT_EQ(read.options.allow[1].position.column, 12U);
  ASSERT_EQ(read.options.silence.size(), 2U);
  EXPECT_EQ(read.options.silence[0].position.line, 1U);
  EXPECT_EQ(read.options.silence[1].position.line, 2U);
}

TEST(OptionsFile, ReportsAFaultInAnArrayAtItsElement) {
  const ReadOptions allow(
      "{ \"allow\": [\n{\"rule\": \"a\", \"reason\": \"b\"},\n{\"rule\": \"a\", \"reason\": \"\"},\n{}] }");
  EXPECT_EQ(findings(allow.diagnostics), (Findings{error_at(3, 15, "options"), error_at(4, 1, "options")}));
  const ReadOptions settable("{ \"settable\": [\"1008h\",\n \"x\"] }");
  EXPECT_EQ(findings(settable.diagnostics), (Findings{error_at(2, 2, "options")}));
  const ReadOptions storage("{ \"storage\": {\"sub_indices\": {\"05h\": [\"2111h\",\n \"1017h\"]}} }");
  EXPECT_EQ(findings(storage.diagnostics), (Findings{error_at(2, 2, "options")}));
}

TEST(OptionsFile, MayHaveDeepValues) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  for (const std::string& text :
       {R"({ "storage": {"sub_indices": {"05h": )" + deep + "}} }", R"({ "storage": {"sub_indices": )" + deep + "} }",
        R"({ "lss": {"bit_rates": )" + deep + "} }", R"({ "allow": )" + deep + " }", "{ \"sdo\": " + deep + " }"}) {
    EXPECT_EQ(findings(ReadOptions(text).diagnostics, "options").size(), 1U) << text.substr(0, 60);
  }
}

TEST(OptionsFile, HasTheSameLinesWithEachLineEnd) {
  for (const std::string line_end : {"\n", "\r\n", "\r"}) {
    const ReadOptions read("{" + line_end + "  \"silence\": [], // \"colour\" {" + line_end + "  \"colour\": 1" +
                           line_end + "}");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(3, 3, "options")}));
    const ReadOptions broken("{" + line_end + "  \"settable\": [,]" + line_end + "}");
    EXPECT_EQ(findings(broken.diagnostics), (Findings{error_at(2, 16, "options-syntax")}));
  }
}

TEST(OptionsFile, RefusesAnUnknownMemberWhereItStands) {
  const ReadOptions read("{\n  \"silence\": [],\n  \"colour\": 1\n}\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(3, 3, "options")}));
  EXPECT_NE(read.diagnostics.all().front().message.find("colour"), std::string::npos);
}

TEST(OptionsFile, NamesThePathOfTheMemberThatIsWrong) {
  const ReadOptions read("{ \"string_capacity\": { \"1008h\": true } }");
  EXPECT_NE(read.diagnostics.all().front().message.find("string_capacity.1008h"), std::string::npos);
}

TEST(OptionsFile, ThatIsNoJsonIsAnErrorWhereItBreaks) {
  EXPECT_EQ(findings(ReadOptions("{\n  \"settable\": [,]\n}\n").diagnostics),
            (Findings{error_at(2, 16, "options-syntax")}));
  EXPECT_EQ(ReadOptions("").diagnostics.all().front().rule.text(), "options-syntax");
  EXPECT_EQ(ReadOptions("{").diagnostics.all().front().rule.text(), "options-syntax");
}

TEST(OptionsFile, WithANumberThatNothingHoldsIsAnError) {
  EXPECT_EQ(ReadOptions(R"({ "string_capacity": { "1008h": 1e999 } })").diagnostics.errors(), 1U);
}

TEST(OptionsFile, HoldsOneObject) {
  for (const char* text : {"[]", "1", "\"names\"", "null"}) {
    const ReadOptions read(text);
    ASSERT_EQ(read.diagnostics.errors(), 1U) << text;
    EXPECT_EQ(read.diagnostics.all().front().rule.text(), "options") << text;
  }
}

}  // namespace
}  // namespace edsc

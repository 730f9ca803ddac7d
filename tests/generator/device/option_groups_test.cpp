/// Options in the group of their service, and by their deprecated names outside it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/options/option_table.hpp"
#include "support/diagnostic_matchers.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

using Messages = std::vector<std::string>;

/// The messages about the options file of a text.
Messages faults(const std::string& text) { return messages(ReadOptions(text).diagnostics); }

/// The first finding about the options file of a text.
Finding first_finding(const std::string& text) { return findings(ReadOptions(text).diagnostics).at(0); }

TEST(OptionGroups, HoldTheOptionsOfAService) {
  const ReadOptions read(R"({ "sdo": { "timeout": 500, "block_transfer": true }, "pdo": { "mpdo": true } })");
  EXPECT_EQ(messages(read.diagnostics), Messages{});
  EXPECT_EQ(read.runtime(),
            (ReadOptions::Runtime{{"mpdo", "true"}, {"sdo_block_transfer", "true"}, {"sdo_timeout", "500"}}));
  EXPECT_TRUE(read.options.deprecated.empty());
}

TEST(OptionGroups, MayBeEmpty) {
  for (const OptionRow& row : options_table) {
    if (row.group.name.empty()) continue;
    EXPECT_EQ(faults("{ \"" + std::string{row.group.name} + "\": {} }"), Messages{});
  }
}

TEST(OptionGroups, KeepTheOldNameOfAnOption) {
  const ReadOptions read("{\n  \"sdo_timeout\": 500,\n  \"no_event\": [\"6401h\"]\n}");
  EXPECT_EQ(messages(read.diagnostics), Messages{});
  EXPECT_EQ(read.runtime(), (ReadOptions::Runtime{{"sdo_timeout", "500"}}));
  EXPECT_EQ(read.options.no_event, (std::vector<EntryAddress>{{0x6401, {}}}));
  ASSERT_EQ(read.options.deprecated.size(), 2U);
  EXPECT_EQ(read.options.deprecated[0].message, "\"no_event\" is deprecated; use \"no_event\" in \"pdo\"");
  EXPECT_EQ(read.options.deprecated[0].position.line, 3U);
  EXPECT_EQ(read.options.deprecated[1].message, "\"sdo_timeout\" is deprecated; use \"timeout\" in \"sdo\"");
  EXPECT_EQ(read.options.deprecated[1].position.line, 2U);
  EXPECT_EQ(read.options.deprecated[1].position.column, 3U);
}

TEST(OptionGroups, GiveAnOptionTheSameValueByEachName) {
  for (const OptionRow& row : options_table) {
    if (row.form != OptionForm::flag || row.flat_name.empty()) continue;
    const std::string name{row.name}, flat_name{row.flat_name}, group{row.group.name};
    const ReadOptions grouped("{ \"" + group + "\": { \"" + name + "\": true } }");
    const ReadOptions flat("{ \"" + flat_name + "\": true }");
    EXPECT_EQ(grouped.runtime(), (ReadOptions::Runtime{{flat_name, "true"}}));
    EXPECT_EQ(flat.runtime(), grouped.runtime());
    EXPECT_EQ(flat.options.deprecated.size(), 1U) << flat_name;
  }
}

TEST(OptionGroups, RejectAnOptionByBothNames) {
  const ReadOptions read("{\n  \"sdo\": { \"timeout\": 500 },\n  \"sdo_timeout\": 600\n}");
  EXPECT_EQ(messages(read.diagnostics), (Messages{"sdo_timeout: already set by \"timeout\" in \"sdo\""}));
  EXPECT_EQ(findings(read.diagnostics), (std::vector<Finding>{error_at(3, 3, "options")}));
  EXPECT_EQ(faults(R"({ "sdo": { "block_transfer": true }, "sdo_timeout": 600 })"), Messages{});
}

TEST(OptionGroups, AreNamedWhenASimilarOneIsUnknown) {
  EXPECT_EQ(faults(R"({ "sdos": { "timeout": 500 } })"), (Messages{"sdos: unknown option; did you mean \"sdo\"?"}));
  EXPECT_EQ(faults(R"({ "nmt": {} })"), (Messages{"nmt: unknown option"}));
  EXPECT_EQ(faults(R"({ "sdo_timeot": 5 })"),
            (Messages{"sdo_timeot: unknown option; did you mean \"timeout\" in \"sdo\"?"}));
  EXPECT_EQ(faults(R"({ "sdo.timeout": 5 })"),
            (Messages{"sdo.timeout: unknown option; did you mean \"timeout\" in \"sdo\"?"}));
}

TEST(OptionGroups, NameASimilarOptionOfTheGroup) {
  EXPECT_EQ(faults(R"({ "sdo": { "timeot": 5 } })"),
            (Messages{"sdo.timeot: unknown option; did you mean \"timeout\"?"}));
  EXPECT_EQ(faults(R"({ "sdo": { "sdo_timeout": 5 } })"),
            (Messages{"sdo.sdo_timeout: unknown option; did you mean \"timeout\"?"}));
  EXPECT_EQ(faults(R"({ "pdo": { "timeout": 5 } })"), (Messages{"pdo.timeout: unknown option"}));
  EXPECT_EQ(faults(R"({ "lss": { "fast_scan": true } })"),
            (Messages{"lss.fast_scan: unknown option; did you mean \"fastscan\"?"}));
}

TEST(OptionGroups, PointAtAValueOfTheWrongType) {
  const std::string pdo = R"("pdo": { "cob_id_writable": "0xFFFFFF80" })";
  EXPECT_EQ(first_finding("{ " + pdo + ",\n  \"emcy\": { \"cob_id_writable\": true } }"), error_at(2, 13, "options"));
  EXPECT_EQ(first_finding("{\n  \"emcy\": { \"info\": {\n    \"8210h\": 9 } } }"), error_at(3, 5, "options"));
  EXPECT_EQ(first_finding("{ \"silence\": [\"sdo\\\"\", \"timeout\"],\n\"sdo\": {\"timeout\" : \"5\"} }"),
            error_at(2, 9, "options"));
  EXPECT_EQ(faults(R"({ "sdo": { "timeout": "5" } })"), (Messages{"sdo.timeout: expected a number from 0 to 65535"}));
}

TEST(OptionGroups, AreObjects) {
  for (const char* value : {"true", "[]", "null", "500"}) {
    EXPECT_EQ(faults("{ \"sdo\": " + std::string{value} + " }"),
              (Messages{"sdo: expected an object with SDO options"}));
  }
}

}  // namespace
}  // namespace edsc

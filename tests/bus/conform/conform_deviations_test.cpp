/// Declared deviations of a device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "conform/deviations.hpp"
#include "report_runs.hpp"
#include "support/device_from_text.hpp"

namespace edsc::conform {
namespace {

struct ReadDeviations {
  explicit ReadDeviations(std::string text)
      : source{"pump.json", std::move(text)}, rows{read_deviations(source, diagnostics)} {}

  [[nodiscard]] std::string problem() const {
    if (diagnostics.all().empty()) return {};
    const Diagnostic& first = diagnostics.all().front();
    return fmt::format("{}:{}: {}", first.position.line, first.position.column, first.message);
  }

  Diagnostics diagnostics;
  SourceFile source;
  std::vector<Deviation> rows;
};

TEST(ConformDeviations, AreRead) {
  const ReadDeviations read{R"({ "$schema": "deviations.schema.json",
  "deviations": [
    { "case": "3.7", "object": "1800h:02", "reason": "type 0 at every SYNC", "source": "manual, page 12" },
    { "case": "8.4", "reason": "loads after a power cycle" } ] })"};
  EXPECT_EQ(read.problem(), "");
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[0].id, "3.7");
  EXPECT_EQ(read.rows[0].object, (EntryAddress{0x1800, 2}));
  EXPECT_EQ(read.rows[1].object, std::nullopt);
  EXPECT_EQ(read.rows[1].position.line, 4u);
}

TEST(ConformDeviations, MayHaveComments) {
  const ReadDeviations read{"// of the pump\n{ /* none */ \"deviations\": [] }"};
  EXPECT_EQ(read.problem(), "");
}

std::string text_of_file(const std::string& name) {
  std::ifstream file(EDSC_SOURCE_DIR "/docs/" + name);
  return {std::istreambuf_iterator<char>{file}, {}};
}

TEST(ConformDeviations, HaveTheMembersOfTheSchema) {
  const auto schema = nlohmann::ordered_json::parse(text_of_file("schema/deviations.schema.json"));
  const auto& items = schema["properties"]["deviations"]["items"];
  auto properties = nlohmann::ordered_json::object();
  auto required = nlohmann::ordered_json::array();
  for (const DeviationMember& member : deviation_members()) {
    properties[std::string{member.name}] = {
        {"description", member.meaning}, {"type", "string"}, {"pattern", member.pattern}};
    if (member.is_required) required.push_back(member.name);
  }
  EXPECT_EQ(items["properties"].dump(2), properties.dump(2));
  EXPECT_EQ(items["required"], required);
}

TEST(ConformDeviations, HaveTheMembersOfTheDocuments) {
  const std::string page = text_of_file("conform.md");
  for (const DeviationMember& member : deviation_members()) {
    const std::string row =
        fmt::format("| `{}` | {} | {} |\n", member.name, member.is_required ? "required" : "optional", member.meaning);
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(ConformDeviations, AreReadStrictly) {
  const std::pair<const char*, const char*> wrong[] = {
      {"[]", "1:1: expected one JSON object"},
      {"{}", "1:1: missing member deviations"},
      {R"({"deviations": 1})",
       R"(1:2: expected an array of objects: [{"case": "3.7", "object": "1800h:02", "reason": "..."}])"},
      {R"({"deviations": [1]})",
       R"(1:2: expected an array of objects: [{"case": "3.7", "object": "1800h:02", "reason": "..."}])"},
      {"{\"deviations\": [],\n \"more\": 1}", "2:2: unknown member more"},
      {R"({"deviation": []})", "1:2: unknown member deviation; did you mean \"deviations\"?"},
      {R"({"deviations": [{"case": "3.7"}]})", "1:17: missing member reason"},
      {R"({"deviations": [{"reason": "x"}]})", "1:17: missing member case"},
      {"{\"deviations\": [{\"case\": \"3.7\", \"reason\": \"x\"},\n  {\"case\": \"3.700\", \"reason\": \"x\"}]}",
       "2:4: case: unknown case 3.700; edsc conform --list prints the cases"},
      {R"({"deviations": [{"case": "3.7", "reason": " "}]})", "1:33: reason: expected a non-empty string"},
      {R"({"deviations": [{"case": "3.7", "reason": 5}]})", "1:33: reason: expected a non-empty string"},
      {R"({"deviations": [{"case": "3.7", "reason": "x", "object": "speed"}]})",
       "1:48: object: expected an object or entry such as \"1800h\" or \"1800h:02\""},
      {R"({"deviations": [{"case": "3.7", "reason": "x", "resaon": "y"}]})",
       "1:48: unknown member resaon; did you mean \"reason\"?"},
      {R"({"deviations": [{"case": "3.7", "reason": "x", "case": "3.6"}]})", "1:48: duplicate member \"case\""},
      {R"({"deviations": [], "deviations": []})", "1:20: duplicate member \"deviations\""},
      {"{\"deviations\": [],\r\r \"more\": 1}", "3:2: unknown member more"},
  };
  for (const auto& [text, problem] : wrong) EXPECT_EQ(ReadDeviations{text}.problem(), problem) << text;
  const std::string syntax = ReadDeviations{"{\"deviations\": [\n  {\"case\": \"3.7\" \"reason\": 1}]}"}.problem();
  EXPECT_TRUE(syntax.starts_with("2:25: not JSON: ")) << syntax;
  EXPECT_EQ(ReadDeviations{std::string{"{\"deviations\": \"\xFF\"}"}}.rows.size(), 0u);
}

TEST(ConformDeviations, TurnAFailureIntoADeviation) {
  const ReadDeviations read{R"({"deviations": [{"case": "3.7", "reason": "at every SYNC", "source": "page 12"}]})"};
  CaseResult declared = failure(sync_row, "no TPDO", "TPDO 1");
  apply_deviations(read.rows, declared);
  EXPECT_EQ(declared.verdict, Verdict::deviates);
  EXPECT_EQ(declared.deviation, "at every SYNC (page 12)");
  CaseResult other = failure(read_row, "0602 0000h", "no answer");
  apply_deviations(read.rows, other);
  EXPECT_EQ(other.verdict, Verdict::failed);
  CaseResult passed = result_of(sync_row, Verdict::passed);
  apply_deviations(read.rows, passed);
  EXPECT_EQ(passed.verdict, Verdict::passed);
}

TEST(ConformDeviations, OfAnObjectDoNotHideFailuresOfOthers) {
  const ReadDeviations read{R"({"deviations": [{"case": "3.7", "object": "1800h", "reason": "x"}]})"};
  const auto verdict = [&](const std::string& got) {
    CaseResult result = failure(sync_row, "0601 0000h", got);
    apply_deviations(read.rows, result);
    return result.verdict;
  };
  EXPECT_EQ(verdict("1800h:02 is written"), Verdict::deviates);
  EXPECT_EQ(verdict("1801h:02 is written"), Verdict::failed);
  EXPECT_EQ(verdict("1801h:02 and 1800h:02 are written"), Verdict::deviates);
  EXPECT_EQ(verdict("no answer"), Verdict::deviates) << "a failure that names no entry may be that of the object";
}

TEST(ConformDeviations, CoverEachEntryThatFails) {
  const ReadDeviations read{R"({"deviations": [{"case": "3.7", "object": "1800h:01", "reason": "x"},
                                               {"case": "3.7", "object": "1801h", "reason": "x"}]})"};
  const auto result_with = [&](std::vector<EntryAddress> entries) {
    CaseResult result = failure(sync_row, "each COB-ID", "1800h:01: accepted; and others");
    result.failed_entries = std::move(entries);
    apply_deviations(read.rows, result);
    return result;
  };
  const EntryAddress first{0x1800, std::uint8_t{1}}, second{0x1801, std::uint8_t{1}}, third{0x1802, std::uint8_t{1}};
  EXPECT_EQ(result_with({first, second}).verdict, Verdict::deviates);
  EXPECT_EQ(result_with({first, second}).deviation, "x") << "the same reason once";
  EXPECT_EQ(result_with({first, third}).verdict, Verdict::failed);
  EXPECT_EQ(result_with({third}).verdict, Verdict::failed);
}

TEST(ConformDeviations, AreUnusedWhereTheirCasePasses) {
  const ReadDeviations read{R"({"deviations": [{"case": "3.7", "reason": "x"},
 {"case": "8.4", "reason": "y"}]})"};
  RunReport run;
  run.cases = {result_of(sync_row, Verdict::passed)};
  find_unused_deviations(read.rows, run);
  EXPECT_EQ(run.unused_deviations, std::vector<std::string>{"pump.json:1: case 3.7 passed: x"});
  for (const Verdict verdict : {Verdict::deviates, Verdict::not_applicable, Verdict::inconclusive, Verdict::not_run}) {
    RunReport other;
    other.cases = {result_of(sync_row, verdict)};
    find_unused_deviations(read.rows, other);
    EXPECT_TRUE(other.unused_deviations.empty());
  }
}

/// Case 4.2 compares the constants of 1000h to 1FFFh, of which the identity is a part.
TEST(ConformDeviations, DeclareDifferencesOfTheIdentity) {
  ReadDeviations read{R"({"deviations": [{"case": "4.2", "object": "1018h:03", "reason": "newer", "source": "page 3"},
                                         {"case": "4.2", "object": "1018h:04", "reason": "x"},
                                         {"case": "2.1", "object": "1018h:02", "reason": "y"}]})"};
  RunReport run;
  run.identity_entries = {{0x1018, std::uint8_t{3}}};
  apply_deviations(read.rows, run);
  EXPECT_EQ(run.identity_deviation, "newer (page 3)");
  EXPECT_TRUE(read.rows[0].is_used);
  EXPECT_FALSE(read.rows[1].is_used);
  RunReport other;
  other.identity_entries = {{0x1018, std::uint8_t{2}}, {0x1018, std::uint8_t{3}}};
  apply_deviations(read.rows, other);
  EXPECT_EQ(other.identity_deviation, "") << "the product code is not declared";
  RunReport same;
  apply_deviations(read.rows, same);
  EXPECT_EQ(same.identity_deviation, "");
}

TEST(ConformDeviations, OfADifferenceAreUsedAlthoughTheirCasePasses) {
  ReadDeviations read{R"({"deviations": [{"case": "3.7", "reason": "x"}]})"};
  RunReport run;
  run.cases = {result_of(sync_row, Verdict::passed)};
  read.rows[0].is_used = true;
  find_unused_deviations(read.rows, run);
  EXPECT_TRUE(run.unused_deviations.empty());
}

/// The spellings of docs/conform.md, for edsc and for the pattern of the schema.
TEST(ConformDeviations, HaveTheObjectsThatTheSchemaAllows) {
  const std::regex pattern{std::string{deviation_members()[1].pattern}};
  const std::pair<const char*, bool> spellings[] = {
      {"1018h", true},      {"1018", true},        {"0x1018", true},     {"1018h:02", true},   {"1018:2", true},
      {"0x1018:2", true},   {"0x1018:0x02", true}, {"1a00h:0A", true},   {"speed", false},     {"18h", false},
      {"01018h", false},    {"1018h:", false},     {"1018h:123", false}, {"1018h:xx", false},  {"0x1018:256", false},
      {" 1018h:02 ", true}, {"1018h:002h", true},  {"0x1018:255", true}, {"0x1018:1Fh", true}, {"0x1018h", false}};
  for (const auto& [text, is_valid] : spellings) {
    EXPECT_EQ(std::regex_search(text, pattern), is_valid) << text;
    const ReadDeviations read{
        fmt::format(R"({{"deviations": [{{"case": "3.7", "reason": "x", "object": "{}"}}]}})", text)};
    EXPECT_EQ(read.rows.size(), is_valid ? 1U : 0U) << text << ' ' << read.problem();
  }
}

}  // namespace
}  // namespace edsc::conform

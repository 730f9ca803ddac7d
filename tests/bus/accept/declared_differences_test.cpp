/// Declared deviations of an acceptance: which differences each case declares, and what the reports say about them.
#include "accept/declared_differences.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "accept/acceptance.hpp"
#include "accept/report/html_report.hpp"
#include "accept/report/json_report.hpp"
#include "accept/report/junit_report.hpp"
#include "accept/report/text_report.hpp"
#include "compared.hpp"
#include "conform/case.hpp"

namespace edsc::accept {
namespace {

conform::Deviation deviation_of(std::string id, std::uint16_t index, std::optional<std::uint8_t> sub_index = {}) {
  conform::Deviation deviation;
  deviation.id = std::move(id);
  deviation.object = EntryAddress{index, sub_index};
  deviation.reason = "known <difference>";
  deviation.source = "manual, page 3";
  return deviation;
}

constexpr conform::CaseRow passing_row{
    "4.2", "Constants", "CiA 306-1", conform::Level::read, conform::Permission::none, nullptr};

/// A run in which case 4.2 has passed.
conform::RunReport passed_run() {
  conform::RunReport run;
  run.node = DictionaryPort::node_id;
  run.cases.emplace_back();
  run.cases.front().row = &passing_row;
  return run;
}

/// The device of `base_eds` with another revision number.
const auto newer_revision = [](DictionaryPort& device) { device.values[{0x1018, 3}] = {1, 0, 1, 0}; };

// ---- which case declares which difference ----

struct Row {
  const char* id;
  std::uint16_t index;
  std::uint8_t sub_index;
  std::vector<Kind> covered;
};

/// What the cases compare by their titles: 4.1 and 4.7 read each entry with its size, 4.2 and 4.8 compare
/// constants, 4.4 reads write-only entries, 4.5 sub-index FFh, 4.6 limits. The others write.
TEST(DeclaredDifferences, AreThoseThatTheCaseCompares) {
  using enum Kind;
  const std::vector<Kind> read = {object_missing, sub_index_missing, not_in_eds, length,
                                  access,         unreadable,        no_response};
  const Row rows[] = {
      {"4.1", 0x1200, 1, read},
      {"4.1", 0x2000, 0, {}},
      {"4.2", 0x1200, 1, {value}},
      {"4.2", 0x2000, 0, {}},
      {"4.3", 0x1200, 1, {}},
      {"4.4", 0x1200, 1, {access}},
      {"4.4", 0x2000, 0, {access}},
      {"4.5", 0x1200, 1, {}},
      {"4.6", 0x1200, 1, {limit}},
      {"4.6", 0x2000, 0, {limit}},
      {"4.7", 0x1200, 1, {}},
      {"4.7", 0x2000, 0, read},
      {"4.8", 0x1200, 1, {}},
      {"4.8", 0x2000, 0, {value}},
      {"4.9", 0x2000, 0, {}},
      {"4.10", 0x1200, 1, {}},
      {"4.11", 0x1200, 1, {}},
      {"4.12", 0x2000, 0, {}},
      {"2.1", 0x1000, 0, {}},
      {"3.21", 0x1A00, 1, {}},
      {"4.5", 0x1018, 0xFF, {sub_index_missing, length, access, Kind::value, unreadable, no_response}},
  };
  for (const Row& row : rows) {
    const conform::Deviation deviation = deviation_of(row.id, row.index, row.sub_index);
    for (const KindRow& kind : kinds) {
      const bool expected = std::ranges::find(row.covered, kind.kind) != row.covered.end();
      EXPECT_EQ(covers(deviation, kind.kind, row.index, row.sub_index), expected) << row.id << ' ' << kind.name;
    }
  }
}

TEST(DeclaredDifferences, AreThoseOfTheObject) {
  EXPECT_TRUE(covers(deviation_of("4.2", 0x1200), Kind::value, 0x1200, 1)) << "each entry of the object";
  EXPECT_FALSE(covers(deviation_of("4.2", 0x1200, 2), Kind::value, 0x1200, 1));
  EXPECT_FALSE(covers(deviation_of("4.2", 0x1201), Kind::value, 0x1200, 1));
  conform::Deviation of_any = deviation_of("4.2", 0x1200);
  of_any.object.reset();
  EXPECT_FALSE(covers(of_any, Kind::value, 0x1200, 1)) << "a deviation without an object is about the case alone";
}

TEST(DeclaredDifferences, AreDocumented) {
  std::ifstream file{EDSC_SOURCE_DIR "/docs/accept.md"};
  const std::string page{std::istreambuf_iterator<char>{file}, {}};
  for (const DeclaringCase& row : declaring_cases()) {
    std::string names;
    for (const Kind kind : row.kinds) names += fmt::format("{}{}", names.empty() ? "" : ", ", row_of(kind).text);
    const std::string line = fmt::format("| {} | {} | {} |", row.id, row.objects_text, names);
    EXPECT_NE(page.find(line), std::string::npos) << line;
  }
}

// ---- unused deviations ----

/// The COB-ID of the default SDO is not a constant for case 4.2, which passes; only the comparison finds the
/// difference.
TEST(DeclaredDifferences, MakeTheirDeviationUsed) {
  const std::string sdo = group("1200", "SDO server", "0x9", 3) + var("1200sub0", "Count", u8, "ro", value("2")) +
                          var("1200sub1", "Request", u32, "ro", value("$NODEID+0x620")) +
                          var("1200sub2", "Response", u32, "ro", value("$NODEID+0x580"));
  Compared result = run(base_eds() + sdo, [](DictionaryPort& device) {
    device.values[{0x1200, 0}] = {2};
    device.values[{0x1200, 1}] = {5, 6, 0, 0};
    device.values[{0x1200, 2}] = {0x85, 5, 0, 0};
  });
  std::vector<conform::Deviation> deviations = {deviation_of("4.2", 0x1200, 1), deviation_of("4.2", 0x1018, 1)};
  const SourceFile source{"pump.json", "{}"};
  for (conform::Deviation& one : deviations) one.position = {&source, 4, 1};
  apply_deviations(deviations, result.comparison);
  ASSERT_EQ(result.comparison.differences.size(), 1U);
  EXPECT_EQ(result.comparison.differences.front().deviation, "known <difference> (manual, page 3)");
  EXPECT_EQ(result.comparison.undeclared(), 0U);
  conform::RunReport report = passed_run();
  conform::find_unused_deviations(deviations, report);
  EXPECT_EQ(report.unused_deviations,
            std::vector<std::string>{"pump.json:4: case 4.2 passed: known <difference> (manual, page 3)"});
}

TEST(DeclaredDifferences, AreNotHiddenByACaseThatCannotCauseThem) {
  Compared result = run(base_eds(), newer_revision);
  std::vector<conform::Deviation> deviations = {deviation_of("4.5", 0x1018, 3), deviation_of("4.1", 0x1018)};
  apply_deviations(deviations, result.comparison);
  ASSERT_EQ(result.comparison.differences.size(), 1U);
  EXPECT_FALSE(result.comparison.differences.front().is_declared());
  for (const conform::Deviation& one : deviations) EXPECT_FALSE(one.is_used);
}

// ---- reports ----

std::string message_of(const pugi::xml_document& junit, const char* test, const char* element) {
  const pugi::xml_node node = junit.find_node([&](const pugi::xml_node& one) {
    return std::string_view{one.name()} == "testcase" && one.attribute("name").value() == std::string_view{test};
  });
  return node.child(element).attribute("message").value();
}

TEST(DeclaredDifferences, OfTheIdentityAreInEachReportAsDeclared) {
  Compared result = run(base_eds(), newer_revision);
  std::vector<conform::Deviation> deviations = {deviation_of("4.2", 0x1018, 3)};
  conform::RunReport report = passed_run();
  report.identity = "revision number is 00010001h, expected 00010000h";
  report.identity_entries = {{0x1018, 3}};
  const Diagnostics findings{};
  Acceptance acceptance{findings, result.eds->device, report, std::move(result.comparison)};
  EXPECT_EQ(acceptance.objections().size(), 1U);
  EXPECT_NE(html_report(acceptance).find("class=\"failed\">differs<"), std::string::npos);

  apply_deviations(deviations, acceptance.comparison);
  conform::apply_deviations(deviations, report);
  EXPECT_TRUE(acceptance.objections().empty());
  const std::string reason = "known <difference> (manual, page 3)";

  pugi::xml_document junit;
  ASSERT_TRUE(junit.load_string(junit_report(acceptance).c_str()));
  EXPECT_EQ(junit.child("testsuites").attribute("failures").as_int(), 0);
  EXPECT_EQ(message_of(junit, "revision number", "skipped"), "00010001h; EDS 00010000h; declared: " + reason);
  EXPECT_EQ(message_of(junit, "revision number", "failure"), "");

  const auto json = nlohmann::json::parse(json_report(acceptance));
  EXPECT_EQ(json["accepted"], true);
  EXPECT_EQ(json["identity"][3]["number"], "revision_number");
  EXPECT_EQ(json["identity"][3]["deviation"], reason);
  EXPECT_EQ(json["identity"][2]["deviation"], nullptr);
  EXPECT_EQ(json["conform"]["identity"]["deviation"], reason);

  const std::string html = html_report(acceptance);
  EXPECT_NE(html.find("class=\"deviates\">differs; declared: known &lt;difference&gt; (manual, page 3)"),
            std::string::npos);
  for (const char* red : {"class=\"failed\"", "class=\"differs\"", "text failed", "mark undecided"}) {
    EXPECT_EQ(html.find(red), std::string::npos) << red;
  }
  EXPECT_NE(comparison_text(acceptance, false).find("00010001h; EDS 00010000h; declared: " + reason),
            std::string::npos);
}

/// A number of [DeviceInfo] that no entry of the EDS has.
TEST(DeclaredDifferences, OfANumberThatTheDictionaryDoesNotShow) {
  std::string eds = base_eds();
  const std::size_t entry = eds.find("[1018sub3]");
  eds.resize(entry);
  Compared result = run(eds, newer_revision);
  std::erase_if(result.comparison.differences, [](const Difference& one) { return one.kind != Kind::value; });
  std::vector<conform::Deviation> deviations = {deviation_of("4.2", 0x1018, 3)};
  const conform::RunReport report = passed_run();
  const Diagnostics findings{};
  Acceptance acceptance{findings, result.eds->device, report, std::move(result.comparison)};
  EXPECT_EQ(acceptance.objections(),
            std::vector<std::string>{"revision number 00010001h differs from the EDS, 00010000h"});
  apply_deviations(deviations, acceptance.comparison);
  EXPECT_TRUE(acceptance.objections().empty());
}

// ---- the verdict ----

TEST(AcceptanceVerdict, SaysHowMuchOfTheTestHasRun) {
  Compared result = run(base_eds(), [](DictionaryPort&) {});
  const conform::RunReport report = passed_run();
  const Diagnostics findings{};
  const Acceptance acceptance{findings, result.eds->device, report, std::move(result.comparison)};
  const std::string expected = fmt::format("accepted (level read: 1 of {} cases run)", conform::all_cases().size());
  EXPECT_EQ(verdict_text(acceptance, false), expected + '\n');
  EXPECT_NE(html_report(acceptance).find(">" + expected + "<"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(json_report(acceptance))["accepted"], true);
}

TEST(AcceptanceVerdict, NamesTheProblemOfARunWithoutFailedCase) {
  Compared result = run(base_eds(), [](DictionaryPort&) {});
  conform::RunReport report = passed_run();
  report.unused_deviations = {"pump.json:4: case 8.4 passed: x"};
  const Diagnostics findings{};
  const Acceptance acceptance{findings, result.eds->device, report, std::move(result.comparison)};
  EXPECT_EQ(acceptance.objections(),
            std::vector<std::string>{"conformance test failed: unused deviation: pump.json:4: case 8.4 passed: x; none "
                                     "of 1 case failed; 1 passed"});
}

TEST(AcceptanceReports, NameTheOptionsAndTheDeviations) {
  Compared result = run(base_eds(), [](DictionaryPort&) {});
  conform::RunReport report = passed_run();
  const Diagnostics findings{};
  const Acceptance acceptance{findings, result.eds->device, report, std::move(result.comparison)};
  EXPECT_EQ(nlohmann::json::parse(json_report(acceptance))["options"], nullptr);
  report.options_file = {"pump.options.json", std::string(64, 'a')};
  report.deviations_file = {"pump.deviations.json", std::string(64, 'b')};
  const auto json = nlohmann::json::parse(json_report(acceptance));
  EXPECT_EQ(json["options"], (nlohmann::json{{"file", "pump.options.json"}, {"sha256", std::string(64, 'a')}}));
  EXPECT_EQ(json["deviations"]["sha256"], std::string(64, 'b'));
  const std::string html = html_report(acceptance);
  for (const std::string& text : {report.options_file.path, report.options_file.hash, report.deviations_file.hash}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace edsc::accept

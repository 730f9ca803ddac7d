/// Reports of a hand-made conformance run: their content, also with hostile bytes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "conform/deviations.hpp"
#include "conform/report/candump_log.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/report_facts.hpp"
#include "conform/report/sha256.hpp"
#include "conform/report/text_report.hpp"
#include "decode/log/log_line.hpp"
#include "support/device_from_text.hpp"
#include "text/utf8.hpp"

namespace edsc::conform {
namespace {

using ::edsc::DeviceFromText;

constexpr CaseRow read_row{"2.6",  "A missing object is refused", "CiA 301, 7.2.4.3.17", Level::read, Permission::none,
                           nullptr};
constexpr CaseRow guarding_row{
    "2.14", "100Ch is written in segments", "CiA 301, 7.2.4.3.3", Level::communication, Permission::none, nullptr};
constexpr CaseRow sync_row{
    "3.7",  "A TPDO of type 0 is sent after an event", "CiA 301, 7.5.2.37", Level::communication, Permission::none,
    nullptr};
constexpr CaseRow save_row{"8.4",  "Values are restored", "CiA 301, 7.5.2.14", Level::communication, Permission::store,
                           nullptr};
constexpr CaseRow outputs_row{"5.4",       "An emergency is sent", "CiA 301, 7.2.7",
                              Level::read, Permission::outputs,    nullptr};

const DeviceFromText& sheet() {
  static const DeviceFromText sheet{"[DeviceInfo]\nVendorName=Maker\nProductName=Pump\n" +
                                    var("1008", "Manufacturer device name", "0x0009", "const", "DefaultValue=Pump\n")};
  return sheet;
}

SeenFrame seen(std::uint64_t at, bool sent, std::uint32_t id, std::vector<std::uint8_t> data) {
  SeenFrame result;
  result.at = at;
  result.sent = sent;
  result.frame.id = id;
  result.frame.size = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, result.frame.data.begin());
  return result;
}

CaseResult result_of(const CaseRow& row, Verdict verdict, std::string reason = {}) {
  CaseResult result;
  result.row = &row;
  result.verdict = verdict;
  result.reason = std::move(reason);
  return result;
}

CaseResult failure(const CaseRow& row, std::string expected, std::string got) {
  CaseResult result = result_of(row, Verdict::failed);
  result.expected = std::move(expected);
  result.got = std::move(got);
  result.took = 1'204'000;
  result.lag = 120;
  result.frames = {seen(12'003'481, true, 0x605, {0x40, 0x04, 0x10, 0, 0, 0, 0, 0}),
                   seen(12'004'000, false, 0x585, {0x80, 0x04, 0x10, 0, 0x11, 0, 0x09, 0x06})};
  return result;
}

/// One case of each verdict.
RunReport every_verdict() {
  RunReport run;
  run.bus = "socketcan:can0";
  run.node = 5;
  run.sheet = "eds/pump.eds";
  run.sheet_hash = "ab12";
  run.product = "Pump";
  run.vendor = "Maker";
  run.read_identity = "vendor-ID 0000 0319h";
  run.level = Level::communication;
  run.permissions = Permission::store;
  run.seed = 7;
  run.version = "0.1.0";
  run.cases.push_back(result_of(save_row, Verdict::passed));
  run.cases.back().warnings = {"0800 0000h in place of 0601 0002h"};
  run.cases.push_back(failure(read_row, "0602 0000h, object does not exist", "0609 0011h, sub-index does not exist"));
  run.cases.push_back(result_of(guarding_row, Verdict::not_applicable, "100Ch:00 does not exist in the EDS"));
  run.cases.push_back(result_of(sync_row, Verdict::deviates));
  run.cases.back().deviation = "sent at every SYNC (manual, page 12)";
  run.cases.push_back(result_of(sync_row, Verdict::inconclusive, "needs a stimulus"));
  run.cases.push_back(result_of(outputs_row, Verdict::not_run, "needs --outputs"));
  return run;
}

/// Text that a hostile device or EDS may contain.
const std::string hostile =
    std::string{"<b>&\"'\x1B[31m\x07\x9B\xFF\r\n{{bus}} ]]> \xE2\x80\xAE \xEF\xBF\xBF"} + '\0' + "--></script>";

RunReport hostile_run() {
  RunReport run = every_verdict();
  for (std::string* text : {&run.bus, &run.sheet, &run.sheet_hash, &run.product, &run.vendor, &run.identity,
                            &run.read_identity, &run.lost}) {
    *text = hostile;
  }
  for (CaseResult& result : run.cases) {
    result.reason = result.expected = result.got = result.deviation = hostile;
    result.warnings = result.not_put_back = {hostile};
  }
  // An SDO download of these bytes that the server has accepted.
  run.cases.front().frames = {seen(1, true, 0x605, {0x23, 0x08, 0x10, 0, '<', 0x1B, '&', 0xFF}),
                              seen(2, false, 0x585, {0x60, 0x08, 0x10, 0, 0, 0, 0, 0})};
  run.unused_deviations = run.not_put_back = {hostile};
  return run;
}

/// Checks for control characters of a terminal, bytes that are not UTF-8, and characters that XML 1.0 forbids.
void expect_harmless(std::string_view text) {
  EXPECT_TRUE(is_utf8(text));
  EXPECT_EQ(text.find("\xE2\x80\xAE"), std::string_view::npos);
  EXPECT_EQ(text.find("\xEF\xBF\xBF"), std::string_view::npos);
  for (const char c : text) EXPECT_TRUE(static_cast<unsigned char>(c) >= ' ' || c == '\n') << static_cast<int>(c);
}

// ---- result of a run ----

TEST(ConformRun, PassesWithoutFailureAndProblem) {
  RunReport run = every_verdict();
  EXPECT_FALSE(run.passed());
  EXPECT_EQ(run.count(Verdict::failed), 1u);
  run.cases.erase(run.cases.begin() + 1);
  EXPECT_TRUE(run.passed());
  EXPECT_FALSE(RunReport{}.passed()) << "no case ran";
  for (auto spoil : {+[](RunReport& r) { r.unused_deviations.emplace_back("3.7"); },
                     +[](RunReport& r) { r.not_put_back.emplace_back("1017h:00"); },
                     +[](RunReport& r) { r.interrupted = true; }, +[](RunReport& r) { r.lost = "the bus is lost"; }}) {
    RunReport spoiled = run;
    spoil(spoiled);
    EXPECT_FALSE(spoiled.passed());
  }
}

TEST(ConformRun, NamesTheCommandThatRepeatsACase) {
  RunReport run = every_verdict();
  EXPECT_EQ(repeat_command(run, read_row),
            "edsc conform socketcan:can0 5 eds/pump.eds --level communication --store --only 2.6 --seed 7");
  EXPECT_EQ(repeat_command(run, outputs_row),
            "edsc conform socketcan:can0 5 eds/pump.eds --level communication --store --outputs --only 5.4 --seed 7");
  run.level = Level::all;
  EXPECT_EQ(repeat_command(run, save_row),
            "edsc conform socketcan:can0 5 eds/pump.eds --level all --only 8.4 --seed 7");
  run.level = Level::read;
  run.permissions = Permission::none;
  run.sheet = "my pump's.eds";
  EXPECT_EQ(repeat_command(run, read_row), R"(edsc conform socketcan:can0 5 'my pump'\''s.eds' --only 2.6 --seed 7)");
}

// ---- text ----

TEST(ConformText, ShowsOfAFailureAllThatIsNeededToRepeatIt) {
  const RunReport run = every_verdict();
  const TextReport report{run, sheet().device, false};
  EXPECT_EQ(
      report.of(run.cases[1]),
      "2.6    failed                A missing object is refused\n"
      "       clause        CiA 301, 7.2.4.3.17\n"
      "       expected      0602 0000h, object does not exist\n"
      "       got           0609 0011h, sub-index does not exist\n"
      "       frames        12.003481 TX 605 40 04 10 00 00 00 00 00 SDO >    node 5  read 1004h:00\n"
      "                     12.004000 RX 585 80 04 10 00 11 00 09 06 SDO <    node 5  abort 0609 0011h sub-index does "
      "not exist, read of 1004h:00, 0.519 ms\n"
      "       repeat with   edsc conform socketcan:can0 5 eds/pump.eds --level communication --store --only 2.6 "
      "--seed 7\n");
}

TEST(ConformReports, NameTheRuleThatReportsAFailureInTheEds) {
  RunReport run = every_verdict();
  run.cases[1].rule = "sync-missing";
  const std::string text = TextReport{run, sheet().device, false}.of(run.cases[1]);
  EXPECT_NE(text.find("       EDS           rule sync-missing of edsc check reports it\n"), std::string::npos) << text;
  for (const std::string& report : {html_report(run, sheet().device), junit_report(run, sheet().device)}) {
    EXPECT_NE(report.find("rule sync-missing of edsc check reports it"), std::string::npos);
  }
  EXPECT_EQ(nlohmann::json::parse(json_report(run, sheet().device))["cases"][1]["rule"], "sync-missing");
}

TEST(ConformText, HasALineForEachOtherCase) {
  const RunReport run = every_verdict();
  const TextReport report{run, sheet().device, false};
  EXPECT_EQ(report.of(run.cases[0]),
            "8.4    passed                Values are restored\n"
            "       warning       0800 0000h in place of 0601 0002h\n");
  EXPECT_EQ(report.of(run.cases[2]),
            "2.14   not applicable        100Ch is written in segments (100Ch:00 does not exist in the EDS)\n");
  EXPECT_EQ(report.of(run.cases[3]),
            "3.7    deviates as declared  A TPDO of type 0 is sent after an event\n"
            "       reason        sent at every SYNC (manual, page 12)\n");
}

TEST(ConformText, IsColouredOnlyWhenItIsAskedFor) {
  const RunReport run = every_verdict();
  const auto whole = [&](bool color) {
    const TextReport report{run, sheet().device, color};
    std::string text = report.head();
    for (const CaseResult& result : run.cases) text += report.of(result);
    return text + report.summary();
  };
  EXPECT_EQ(whole(false).find('\x1B'), std::string::npos);
  EXPECT_NE(whole(true).find("\x1b[32mpassed\x1b[0m"), std::string::npos);
}

TEST(ConformText, ShortensLongListsOfFrames) {
  RunReport run = every_verdict();
  CaseResult& failed = run.cases[1];
  failed.frames.assign(100, seen(5'000'000, false, 0x705, {0x05}));
  failed.frames.back() = seen(6'000'000, false, 0x705, {0x7F});
  const std::string text = TextReport{run, sheet().device, false}.of(failed);
  EXPECT_NE(text.find("frames        80 earlier frames not shown; --log writes all frames\n"), std::string::npos)
      << text;
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), 4 + 1 + TextReport::max_frames + 1);
  EXPECT_NE(text.find("6.000000 RX 705 7F"), std::string::npos) << text;
}

TEST(ConformText, SumsUpByArea) {
  RunReport run = every_verdict();
  run.cases.resize(3);
  run.unused_deviations = {"pump.json:4: case 8.4 passed: restored after a power cycle"};
  EXPECT_EQ((TextReport{run, sheet().device, false}.summary()),
            "\n"
            "area                                  cases  passed  failed  not applicable\n"
            "8      Stored parameters and CAN-IDs      1       1       0               0\n"
            "2      SDO                                2       0       1               1\n"
            "       all                                3       1       1               1\n"
            "\n"
            "       identity      vendor-ID 0000 0319h\n"
            "       test lag      0.1 ms at most\n"
            "       problem       unused deviation: pump.json:4: case 8.4 passed: restored after a power cycle\n"
            "failed: 1 of 3 cases failed; 1 passed, 1 not applicable\n");
}

TEST(ConformText, SaysWhyNoCaseRan) {
  RunReport run;
  run.lost = "node 5 does not answer";
  EXPECT_EQ((TextReport{run, sheet().device, false}.summary()),
            "\n"
            "       test lag      0.0 ms at most\n"
            "       problem       the run ended early: node 5 does not answer\n"
            "failed: no case ran\n");
}

TEST(ConformText, NamesWhatTheRunMayDo) {
  RunReport run = every_verdict();
  EXPECT_EQ(level_text(run), "level communication with store");
  run.permissions = Permission::store | Permission::outputs;
  EXPECT_EQ(level_text(run), "level communication with store and outputs");
  run.level = Level::all;
  EXPECT_EQ(level_text(run), "level all");
}

TEST(ConformText, ShowsHostileBytesWithoutEffect) {
  const RunReport run = hostile_run();
  const TextReport report{run, sheet().device, false};
  std::string text = report.head();
  for (const CaseResult& result : run.cases) text += report.of(result);
  expect_harmless(text + report.summary());
}

// ---- JSON ----

TEST(ConformJson, HoldsAllThatTheReportHolds) {
  const RunReport run = every_verdict();
  const auto report = nlohmann::json::parse(json_report(run, sheet().device));
  EXPECT_EQ(report["version"], 1);
  EXPECT_EQ(report["passed"], false);
  EXPECT_EQ(report["verdicts"]["failed"], 1);
  EXPECT_EQ(report["permissions"], nlohmann::json::array({"store"}));
  const auto& failed = report["cases"][1];
  EXPECT_EQ(failed["id"], "2.6");
  EXPECT_EQ(failed["area"], "2");
  EXPECT_EQ(failed["verdict"], "failed");
  EXPECT_EQ(failed["expected"], "0602 0000h, object does not exist");
  EXPECT_EQ(failed["reason"], nullptr);
  EXPECT_EQ(failed["took_us"], 1'204'000);
  EXPECT_EQ(failed["frames"][1]["data"], "8004100011000906");
  EXPECT_EQ(failed["frames"][1]["service"], "sdo");
  EXPECT_EQ(failed["frames"][1]["problem"], true);
  EXPECT_EQ(report["cases"][3]["deviation"], "sent at every SYNC (manual, page 12)");
}

TEST(ConformJson, EscapesHostileBytes) {
  const std::string text = json_report(hostile_run(), sheet().device);
  expect_harmless(text);
  EXPECT_TRUE(nlohmann::json::accept(text));
}

// ---- JUnit ----

struct Junit {
  explicit Junit(const std::string& text) { EXPECT_TRUE(document.load_string(text.c_str(), pugi::parse_full)) << text; }

  [[nodiscard]] pugi::xml_node test(std::string_view name) const {
    return document.find_node([&](const pugi::xml_node& node) {
      return std::string_view{node.name()} == "testcase" && node.attribute("name").value() == name;
    });
  }
  [[nodiscard]] pugi::xml_node suite(const char* name) const {
    return document.child("testsuites").find_child_by_attribute("testsuite", "name", name);
  }

  pugi::xml_document document;
};

TEST(ConformJunit, HasASuiteForEachArea) {
  const Junit junit{junit_report(every_verdict(), sheet().device)};
  const pugi::xml_node all = junit.document.child("testsuites");
  EXPECT_EQ(all.attribute("tests").as_int(), 6 + 3);
  EXPECT_EQ(all.attribute("failures").as_int(), 1);
  EXPECT_EQ(all.attribute("skipped").as_int(), 4);
  const pugi::xml_node sdo = junit.suite("2 SDO");
  EXPECT_EQ(sdo.attribute("tests").as_int(), 2);
  EXPECT_EQ(sdo.attribute("failures").as_int(), 1);
  EXPECT_EQ(sdo.attribute("skipped").as_int(), 1);
  EXPECT_EQ(std::string_view{sdo.attribute("time").value()}, "1.204000");
}

TEST(ConformJunit, SaysWhatFailedAndWhyOthersAreSkipped) {
  const Junit junit{junit_report(every_verdict(), sheet().device)};
  const pugi::xml_node failed = junit.test("2.6 A missing object is refused").child("failure");
  EXPECT_EQ(std::string_view{failed.attribute("message").value()},
            "expected 0602 0000h, object does not exist; got 0609 0011h, sub-index does not exist");
  EXPECT_NE(std::string_view{failed.text().get()}.find("12.004000 RX 585 80 04 10 00 11 00 09 06 SDO <"),
            std::string_view::npos);
  EXPECT_NE(std::string_view{failed.text().get()}.find("repeat with: edsc conform"), std::string_view::npos);
  const auto skipped = [&](const char* name) {
    return std::string{junit.test(name).child("skipped").attribute("message").value()};
  };
  EXPECT_EQ(skipped("2.14 100Ch is written in segments"), "not applicable: 100Ch:00 does not exist in the EDS");
  EXPECT_EQ(skipped("3.7 A TPDO of type 0 is sent after an event"),
            "deviates as declared: sent at every SYNC (manual, page 12)");
  EXPECT_EQ(skipped("5.4 An emergency is sent"), "not run: needs --outputs");
  const pugi::xml_node passed = junit.test("8.4 Values are restored");
  EXPECT_FALSE(passed.child("failure") || passed.child("skipped"));
  EXPECT_EQ(std::string_view{passed.child("system-out").text().get()}, "warning: 0800 0000h in place of 0601 0002h\n");
}

TEST(ConformJunit, FailsWhereTheRunAsAWholeDoes) {
  RunReport run = every_verdict();
  EXPECT_EQ(Junit{junit_report(run, sheet().device)}.suite("run").attribute("failures").as_int(), 0);
  run.unused_deviations = {"case 8.4 passed"};
  run.lost = "node 5 does not answer";
  const Junit junit{junit_report(run, sheet().device)};
  EXPECT_EQ(junit.suite("run").attribute("failures").as_int(), 2);
  EXPECT_EQ(std::string_view{junit.test("the run is complete").child("failure").attribute("message").value()},
            "node 5 does not answer");
}

TEST(ConformJunit, EscapesHostileBytes) {
  const std::string text = junit_report(hostile_run(), sheet().device);
  expect_harmless(text);
  EXPECT_EQ(text.find("&#"), std::string::npos)
      << "a character that XML 1.0 does not allow stays one when it is escaped";
  const Junit junit{text};
  EXPECT_EQ(
      std::string{junit.test("2.14 100Ch is written in segments").child("skipped").attribute("message").value()}.substr(
          0, 31),
      "not applicable: <b>&\"'<U+001B>[");
}

// ---- HTML ----

TEST(ConformHtml, NeedsNoOtherFile) {
  const std::string text = html_report(every_verdict(), sheet().device);
  for (const char* request : {"http://", "https://", "src=", "url(", "@import", "<link", "{{"}) {
    EXPECT_EQ(text.find(request), std::string::npos) << request;
  }
  for (const char* part : {"<title>failed: Pump", "2.6", "object does not exist", "12.004000", "sent at every SYNC",
                           "prefers-color-scheme", "--only 2.6", "ab12", "vendor-ID 0000 0319h"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

TEST(ConformHtml, EscapesHostileBytes) {
  const std::string text = html_report(hostile_run(), sheet().device);
  expect_harmless(text);
  EXPECT_EQ(text.find("<b>"), std::string::npos);
  EXPECT_EQ(text.find("--></script>"), std::string::npos);
  EXPECT_NE(text.find("&lt;b&gt;&amp;&quot;&apos;&lt;U+001B&gt;[31m"), std::string::npos);
  EXPECT_NE(text.find("{{bus}}"), std::string::npos) << "values are not templates";
}

TEST(ConformHtml, ShortensLongListsOfFrames) {
  RunReport run = every_verdict();
  run.cases[1].frames.assign(max_html_frames + 1, seen(5'000'000, false, 0x705, {0x05}));
  EXPECT_NE(html_report(run, sheet().device).find("1 earlier frame not shown"), std::string::npos);
}

// ---- log ----

TEST(ConformLog, IsReadByTheDecoder) {
  RunReport run = every_verdict();
  SeenFrame remote = seen(13'000'000, true, 0x185, {});
  remote.frame.remote = true;
  remote.frame.size = 8;
  SeenFrame extended = seen(13'000'001, false, 0x1234567, {1});
  extended.frame.extended = true;
  run.cases[2].frames = {remote, extended};
  EXPECT_EQ(candump_log(run),
            "(12.003481) can0 605#4004100000000000\n"
            "(12.004000) can0 585#8004100011000906\n"
            "(13.000000) can0 185#R8\n"
            "(13.000001) can0 01234567#01\n");
  const LogLine line = parse_log_line("(13.000000) can0 185#R8");
  EXPECT_EQ(line.frame, remote.frame);
}

TEST(ConformLog, NamesAnInterfaceWhateverTheBusIs) {
  RunReport run = every_verdict();
  for (const auto& [bus, interface] :
       std::vector<std::pair<std::string, std::string>>{{"slcan:/dev/ttyACM0@500000", "ttyACM0"},
                                                        {"socketcand:[::1]:29536/vcan1", "vcan1"},
                                                        {hostile, "script>"},
                                                        {"socketcan:an interface", "can0"},
                                                        {"", "can0"}}) {
    run.bus = bus;
    EXPECT_NE(candump_log(run).find(" " + interface + " 605#"), std::string::npos) << bus;
  }
}

// ---- deviations ----

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
      {R"({"deviations": [{"case": "3.7", "reason": "x", "case": "3.6"}]})", "1:48: duplicate member case"},
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

// ---- SHA-256 ----

/// The examples of FIPS 180-4, and the empty message.
TEST(ConformSha256, IsThatOfFips180) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace edsc::conform

/// The result of a hand-made conformance run, and its report as text.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "conform/dut/abort_rule.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/report_facts.hpp"
#include "conform/report/text_report.hpp"
#include "report_runs.hpp"
#include "support/device_from_text.hpp"

namespace edsc::conform {
namespace {

// ---- abort codes ----

TEST(ConformAbortRule, AcceptsNoAbortWithCodeZero) {
  constexpr AbortRule rules[] = {abort_rule::no_object,  abort_rule::no_sub_index, abort_rule::read_only,
                                 abort_rule::write_only, abort_rule::command,      abort_rule::too_long,
                                 abort_rule::too_short,  abort_rule::too_high,     abort_rule::too_low,
                                 abort_rule::toggle_bit, abort_rule::block_size,   abort_rule::sequence_number,
                                 abort_rule::value,      abort_rule::state,        abort_rule::mapping_in_use,
                                 abort_rule::duplicate,  abort_rule::signature,    abort_rule::no_error};
  for (const AbortRule& rule : rules) {
    EXPECT_FALSE(rule.is_accepted(canopen::abort_code_from(0)));
    EXPECT_FALSE(rule.is_accepted(canopen::ok));
    EXPECT_TRUE(rule.is_accepted(rule.standard.front()));
  }
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
                     +[](RunReport& r) { r.not_restored.emplace_back("1017h:00"); },
                     +[](RunReport& r) { r.interrupted = true; }, +[](RunReport& r) { r.lost = "the bus is lost"; }}) {
    RunReport spoiled = run;
    spoil(spoiled);
    EXPECT_FALSE(spoiled.passed());
  }
}

// 8.4 fails because 3.7 does, 5.4 for a reason of its own.
inline constexpr CaseRow caused_row{
    "8.4", "Values are restored", "CiA 301, 7.5.2.14", Level::communication, Permission::store, nullptr, Condition{},
    "3.7"};

TEST(ConformRun, GroupsFailuresByTheirCause) {
  RunReport run;
  run.cases.push_back(failure(caused_row, "2000", "0"));
  run.cases.push_back(failure(sync_row, "a TPDO", "no frame"));
  run.cases.push_back(failure(outputs_row, "an EMCY", "none"));
  const std::vector<Cause> causes = run.causes();
  ASSERT_EQ(causes.size(), 2u);
  EXPECT_EQ(causes[0].text, "3.7 A TPDO of type 0 is sent after an event: no frame");
  EXPECT_EQ(case_ids(causes[0].cases), "8.4, 3.7");
  EXPECT_EQ(case_ids(causes[1].cases), "5.4");
  EXPECT_EQ(causes_sentence(run), "3 failed cases, 2 causes");
}

TEST(ConformRun, HasAFailureAsItsOwnCauseIfTheCauseHasPassed) {
  RunReport run;
  run.cases.push_back(failure(caused_row, "2000", "0"));
  run.cases.push_back(result_of(sync_row, Verdict::passed));
  ASSERT_EQ(run.causes().size(), 1u);
  EXPECT_EQ(run.causes()[0].text, "8.4 Values are restored: 0");
}

TEST(ConformRun, GroupsFailuresByTheRuleThatReportsThem) {
  RunReport run;
  run.cases.push_back(failure(sync_row, "1005h", "it does not exist in the EDS"));
  run.cases.push_back(failure(outputs_row, "1005h", "it does not exist in the EDS"));
  for (CaseResult& result : run.cases) result.rule = AnyRule{"pdo-sync"};
  ASSERT_EQ(run.causes().size(), 1u);
  EXPECT_EQ(run.causes()[0].cases.size(), 2u);
}

TEST(ConformRun, ReportsAConditionOnce) {
  RunReport run;
  for (const CaseRow* row : {&guarding_row, &sync_row, &save_row}) {
    run.cases.push_back(result_of(*row, Verdict::inconclusive, "no remote frame was answered"));
    run.cases.back().condition = Condition::remote_frames;
  }
  run.cases.back().reason = "another reason";
  const std::vector<MissingCondition> missing = run.missing_conditions();
  ASSERT_EQ(missing.size(), 2u);
  EXPECT_EQ(condition_text(missing[0]), "remote frames: no remote frame was answered");
  EXPECT_EQ(case_ids(missing[0].cases), "2.14, 3.7");
}

TEST(ConformCases, NameACaseAsTheirCause) {
  const std::vector<const CaseRow*> rows = all_cases();
  for (const CaseRow* row : rows) {
    if (row->cause.empty()) continue;
    EXPECT_NE(row->cause, row->id);
    EXPECT_TRUE(std::ranges::any_of(rows, [&](const CaseRow* other) { return other->id == row->cause; })) << row->id;
  }
}

TEST(ConformReports, HaveTheDateAndWhoTested) {
  RunReport run = every_verdict();
  run.title = "Pump of line 3";
  run.operator_name = "A. Tester";
  run.place = "hall 2";
  run.host = "bench-1";
  run.started = 1'000'000'000;  // 2001-09-09 01:46:40 UTC
  EXPECT_EQ(utc_text(run), "2001-09-09T01:46:40");
  const auto json = nlohmann::json::parse(json_report(run, sheet().device));
  EXPECT_EQ(json["started"], "2001-09-09T01:46:40Z");
  EXPECT_EQ(json["operator"], "A. Tester");
  const std::string junit = junit_report(run, sheet().device);
  EXPECT_NE(junit.find(R"(timestamp="2001-09-09T01:46:40" hostname="bench-1")"), std::string::npos) << junit;
  const std::string html = html_report(run, sheet().device);
  const std::string head = TextReport{run, sheet().device, false}.head();
  for (const std::string& text : {run.title, run.operator_name, run.place, local_time_text(run)}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
    EXPECT_NE(head.find(text), std::string::npos) << text;
  }
}

TEST(ConformReports, ShowBothRunsOfACaseWhoseVerdictChanges) {
  RunReport run = every_verdict();
  CaseResult& result = run.cases[4];
  result.first_run = FirstRun{"a TPDO", "no frame", {seen(11'000'000, true, 0x080, {})}};
  result.frames = {seen(14'000'000, true, 0x080, {})};
  const auto json = nlohmann::json::parse(json_report(run, sheet().device))["cases"][4];
  EXPECT_EQ(json["first_run"]["got"], "no frame");
  EXPECT_EQ(json["first_run"]["frames"].size(), 1u);
  EXPECT_EQ(json["frames"].size(), 1u);
  for (const std::string& report : {TextReport{run, sheet().device, false}.of(result), html_report(run, sheet().device),
                                    junit_report(run, sheet().device)}) {
    EXPECT_NE(report.find("expected a TPDO; got no frame"), std::string::npos) << report;
    EXPECT_NE(report.find("11.000000"), std::string::npos) << report;
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
  run.force = true;
  EXPECT_EQ(repeat_command(run, read_row), "edsc conform socketcan:can0 5 eds/pump.eds --force --only 2.6 --seed 7");
  run.force = false;
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
  run.cases[1].rule = AnyRule{"pdo-sync"};
  const std::string text = TextReport{run, sheet().device, false}.of(run.cases[1]);
  EXPECT_NE(text.find("       EDS           rule pdo-sync of edsc check reports it\n"), std::string::npos) << text;
  for (const std::string& report : {html_report(run, sheet().device), junit_report(run, sheet().device)}) {
    EXPECT_NE(report.find("rule pdo-sync of edsc check reports it"), std::string::npos);
  }
  EXPECT_EQ(nlohmann::json::parse(json_report(run, sheet().device))["cases"][1]["rule"], "pdo-sync");
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
            "       causes        1 failed case, 1 cause\n"
            "       cause         2.6 A missing object is refused: 0609 0011h, sub-index does not exist\n"
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
            "failed: the run ended early: node 5 does not answer; no case ran\n");
}

TEST(ConformText, NamesTheProblemOfARunWithoutFailedCase) {
  RunReport run = every_verdict();
  run.cases.erase(run.cases.begin() + 1);
  const std::string result =
      "none of 5 cases failed; 1 passed, 1 not applicable, 1 deviates as declared, 1 inconclusive, 1 not run";
  EXPECT_EQ(verdict_sentence(run), result);
  run.interrupted = true;
  EXPECT_EQ(verdict_sentence(run), "the run was interrupted; " + result);
  run.unused_deviations = {"pump.json:4: case 8.4 passed: x"};
  EXPECT_EQ(verdict_sentence(run), "unused deviation: pump.json:4: case 8.4 passed: x, and 1 other problem; " + result);
  const std::string summary = TextReport{run, sheet().device, false}.summary();
  EXPECT_TRUE(summary.ends_with("failed: " + verdict_sentence(run) + '\n')) << summary;
  EXPECT_NE(html_report(run, sheet().device).find(verdict_sentence(run)), std::string::npos);
}

TEST(ConformText, SaysHowMuchOfTheTestHasRun) {
  RunReport run = every_verdict();
  const std::size_t all = all_cases().size();
  EXPECT_EQ(coverage_text(run), "level communication with store: 4 of " + std::to_string(all) + " cases run")
      << "without the one that is not applicable, and the one that is not run";
  run.cases.clear();
  for (const CaseRow* row : all_cases()) run.cases.push_back(result_of(*row, Verdict::passed));
  EXPECT_EQ(coverage_text(run), "");
  run.cases.back().verdict = Verdict::not_applicable;
  EXPECT_EQ(coverage_text(run), "");
}

TEST(ConformReports, NameTheOptionsAndTheDeviations) {
  RunReport run = every_verdict();
  const std::string none = TextReport{run, sheet().device, false}.head();
  EXPECT_NE(none.find("       options       none\n       deviations    none\n"), std::string::npos) << none;
  EXPECT_EQ(nlohmann::json::parse(json_report(run, sheet().device))["options"], nullptr);
  run.options_file = {"pump.options.json", "cd34"};
  run.deviations_file = {"pump.deviations.json", "ef56"};
  const std::string head = TextReport{run, sheet().device, false}.head();
  EXPECT_NE(head.find("       options       pump.options.json\n       SHA-256       cd34\n"
                      "       deviations    pump.deviations.json\n       SHA-256       ef56\n"),
            std::string::npos)
      << head;
  const auto json = nlohmann::json::parse(json_report(run, sheet().device));
  EXPECT_EQ(json["options"], (nlohmann::json{{"file", "pump.options.json"}, {"sha256", "cd34"}}));
  EXPECT_EQ(json["deviations"]["file"], "pump.deviations.json");
  for (const std::string& report : {html_report(run, sheet().device), junit_report(run, sheet().device)}) {
    for (const char* text : {"pump.options.json", "cd34", "pump.deviations.json", "ef56"}) {
      EXPECT_NE(report.find(text), std::string::npos) << text;
    }
  }
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

}  // namespace
}  // namespace edsc::conform

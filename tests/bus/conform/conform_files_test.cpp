/// Reports of a hand-made conformance run in files: JSON, JUnit, HTML, and a log; SHA-256.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "conform/report/candump_log.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/report_facts.hpp"
#include "conform/report/sha256.hpp"
#include "decode/log/log_line.hpp"
#include "report_runs.hpp"
#include "support/device_from_text.hpp"

namespace edsc::conform {
namespace {

// ---- JSON ----

TEST(ConformJson, HoldsAllThatTheReportHolds) {
  const RunReport run = every_verdict();
  const auto report = nlohmann::json::parse(json_report(run, sheet().device));
  EXPECT_EQ(report["schema"], 2);
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

TEST(ConformJson, HasTheNamesOfTheTablesInItsSchema) {
  std::ifstream file{EDSC_SOURCE_DIR "/docs/schema/conform.schema.json"};
  const auto definitions = nlohmann::json::parse(file)["$defs"];
  const auto names_of = [](const auto& rows) {
    std::vector<std::string> names;
    for (const auto& row : rows) names.emplace_back(row.name);
    return names;
  };
  EXPECT_EQ(definitions["condition"]["enum"], nlohmann::json(names_of(conditions)));
  EXPECT_EQ(definitions["level"]["enum"], nlohmann::json(names_of(levels)));
  EXPECT_EQ(definitions["case"]["properties"]["verdict"]["enum"], nlohmann::json(names_of(verdicts)));
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
  run.frames.insert(run.frames.end(), {remote, extended});
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

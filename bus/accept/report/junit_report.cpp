#include "accept/report/junit_report.hpp"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "conform/report/decoded_frames.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/report_facts.hpp"
#include "diagnostics/place.hpp"
#include "text/printable.hpp"

namespace edsc::accept {
namespace {

constexpr std::size_t max_junit_frames = 100;

struct Test {
  std::string name;
  std::vector<std::string> failures;  ///< lines; empty: passed
  std::string skipped;                ///< the reason; empty: not skipped
  std::string message;                ///< of the failure
};

struct Suite {
  std::string name;
  std::string class_name;
  std::vector<Test> tests;
};

void set(pugi::xml_node node, const char* name, std::string_view text) {
  node.append_attribute(name) = printable(text).c_str();
}

Suite check_suite(const Acceptance& acceptance) {
  Test test{"the EDS has no errors", {}, {}, {}};
  for (const Diagnostic& finding : acceptance.findings.all()) {
    if (finding.severity != Severity::error) continue;
    const Place place = place_of(finding.position);
    test.failures.push_back(
        fmt::format("{}:{}:{}: {} [{}]", place.file, place.line, place.column, finding.message, finding.rule.text()));
  }
  if (!test.failures.empty()) test.message = test.failures.front();
  return {"edsc check", "accept.check", {std::move(test)}};
}

Suite identity_suite(const Acceptance& acceptance) {
  Suite suite{"identity", "accept.identity", {}};
  for (const IdentityRow& row : acceptance.identity()) {
    Test test{std::string{row.number->name}, {}, {}, {}};
    if (row.differs) {
      const std::string text = fmt::format("{:08X}h; EDS {:08X}h", *row.in_device, *row.in_eds);
      if (row.deviation.empty()) {
        test.message = text;
        test.failures.push_back(text);
      } else {
        test.skipped = fmt::format("{}; declared: {}", text, row.deviation);
      }
    } else if (!row.in_eds || !row.in_device) {
      test.skipped = row.in_eds ? "not read" : "not in the EDS";
    }
    suite.tests.push_back(std::move(test));
  }
  return suite;
}

void add_difference(Test& test, const Difference& difference, const Acceptance& acceptance) {
  const std::string line =
      fmt::format("{}: {}: {}: EDS {}; device {}", entry_label(difference.index, difference.sub_index),
                  row_of(difference.mark).text, row_of(difference.kind).text, difference.in_eds, difference.in_device);
  if (difference.is_declared()) {
    test.skipped = fmt::format("{}; declared: {}", line, difference.deviation);
    return;
  }
  if (test.message.empty()) test.message = line;
  test.failures.push_back(line);
  test.failures.push_back("reason: " + difference.reason);
  for (const Correction& correction : difference.corrections) {
    test.failures.push_back("EDS would be: " + correction_text(correction));
  }
  for (std::string& frame :
       conform::frame_lines(difference.frames, acceptance.run.node, acceptance.sheet, max_junit_frames)) {
    test.failures.push_back(std::move(frame));
  }
}

/// A test for each object, and one for the comparison as a whole.
Suite dictionary_suite(const Acceptance& acceptance) {
  Suite suite{"dictionary", "accept.dictionary", {}};
  const Comparison& comparison = acceptance.comparison;
  Test whole{"the comparison is complete", {}, {}, {}};
  if (!comparison.is_complete()) {
    whole.message = comparison.interrupted ? "interrupted" : comparison.lost;
    whole.failures.push_back(whole.message);
  }
  suite.tests.push_back(std::move(whole));
  std::optional<std::uint16_t> last;
  for (const ComparedEntry& entry : comparison.entries) {
    if (last == entry.index) continue;
    last = entry.index;
    const Object* const object = acceptance.sheet.find(entry.index);
    Test test{object == nullptr ? index_label(entry.index) : named(*object), {}, {}, {}};
    for (const Difference& difference : comparison.differences) {
      if (difference.index == entry.index) add_difference(test, difference, acceptance);
    }
    suite.tests.push_back(std::move(test));
  }
  return suite;
}

struct JUnitCounts {
  unsigned long long tests = 0, failures = 0, skipped = 0;
};

JUnitCounts add_suite(pugi::xml_node suites, pugi::xml_node before, const Suite& content,
                      const conform::RunReport& run) {
  JUnitCounts counts;
  pugi::xml_node suite = suites.insert_child_before("testsuite", before);
  set(suite, "name", content.name);
  if (run.started != 0) set(suite, "timestamp", conform::utc_text(run));
  if (!run.host.empty()) set(suite, "hostname", run.host);
  for (const Test& test : content.tests) {
    ++counts.tests;
    if (!test.failures.empty()) {
      ++counts.failures;
    } else if (!test.skipped.empty()) {
      ++counts.skipped;
    }
  }
  suite.append_attribute("tests") = counts.tests;
  suite.append_attribute("failures") = counts.failures;
  set(suite, "errors", "0");
  suite.append_attribute("skipped") = counts.skipped;
  set(suite, "time", "0.000000");
  for (const Test& test : content.tests) {
    pugi::xml_node node = suite.append_child("testcase");
    set(node, "classname", content.class_name);
    set(node, "name", test.name);
    set(node, "time", "0.000000");
    if (!test.failures.empty()) {
      pugi::xml_node failure = node.append_child("failure");
      set(failure, "message", test.message);
      std::string text;
      for (const std::string& line : test.failures) text += printable(line) + '\n';
      failure.append_child(pugi::node_pcdata).set_value(text.c_str());
    } else if (!test.skipped.empty()) {
      set(node.append_child("skipped"), "message", test.skipped);
    }
  }
  return counts;
}

}  // namespace

std::string junit_report(const Acceptance& acceptance) {
  pugi::xml_document document;
  document.load_string(conform::junit_report(acceptance.run, acceptance.sheet).c_str(),
                       pugi::parse_default | pugi::parse_declaration);
  pugi::xml_node suites = document.child("testsuites");
  suites.attribute("name") = "edsc accept";
  const pugi::xml_node first = suites.child("testsuite");
  const auto add = [&](const char* name, unsigned long long number) {
    suites.attribute(name) = suites.attribute(name).as_ullong() + number;
  };
  for (const Suite& suite : {check_suite(acceptance), identity_suite(acceptance), dictionary_suite(acceptance)}) {
    const JUnitCounts counts = add_suite(suites, first, suite, acceptance.run);
    add("tests", counts.tests);
    add("failures", counts.failures);
    add("skipped", counts.skipped);
  }
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(out).str();
}

}  // namespace edsc::accept

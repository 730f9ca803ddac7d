#include "diagnostics/consequences.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnostics/print.hpp"
#include "diagnostics/report_order.hpp"
#include "diagnostics/sarif.hpp"
#include "rules/cause_rows.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// A sheet with the objects 2000h in lines 1 to 9 and 2001h in lines 10 to 20.
class Consequences : public testing::Test {
 protected:
  void mark() { mark_consequences(diagnostics, {&file, {{1, 1, 0x2000, {}}, {10, 1, 0x2001, {}}}, {}}); }
  [[nodiscard]] std::string text(bool all = false) const {
    std::string out;
    print_text(out, diagnostics, {.of_check = true, .all = all});
    return out;
  }

  SourceFile file{"a.eds", std::string(40, '\n')};
  Diagnostics diagnostics;
};

TEST_F(Consequences, AreThoseOfOneObject) {
  diagnostics.warning("access-type", {&file, 3, 1}, "access");
  diagnostics.warning("never-writable", {&file, 4, 1}, "of this object");
  diagnostics.warning("never-writable", {&file, 12, 1}, "of another object");
  EXPECT_TRUE(needs_outline(diagnostics, file));
  mark();
  EXPECT_EQ(diagnostics.all()[1].follows_from, 0U);
  EXPECT_FALSE(diagnostics.all()[2].follows_from);
  EXPECT_EQ(count_causes(diagnostics), 2U);
}

TEST_F(Consequences, FollowOnlyIfAllTheirPlacesDo) {
  diagnostics.warning("access-type", {&file, 3, 1}, "access");
  diagnostics.warning("never-writable", {&file, 4, 1}, "one", {}, "same");
  diagnostics.warning("never-writable", {&file, 12, 1}, "other", {}, "same");
  mark();
  EXPECT_FALSE(diagnostics.all()[1].follows_from);
}

TEST_F(Consequences, FollowFromACauseWithSeveralPlaces) {
  diagnostics.warning("access-type", {&file, 3, 1}, "access", {}, "same");
  diagnostics.warning("access-type", {&file, 11, 1}, "access", {}, "same");
  diagnostics.warning("never-writable", {&file, 4, 1}, "one", {}, "same");
  diagnostics.warning("never-writable", {&file, 12, 1}, "other", {}, "same");
  mark();
  EXPECT_EQ(diagnostics.all()[1].follows_from, 0U);
}

TEST_F(Consequences, AreNeverMoreSevereThanTheirCause) {
  diagnostics.warning("cob-id-node-id", {&file, 3, 1}, "of one node");
  diagnostics.error("cob-id-restricted", {&file, 3, 1}, "restricted");
  mark();
  EXPECT_FALSE(diagnostics.all()[1].follows_from);
}

TEST_F(Consequences, OfTheFileDoNotNeedAnOutline) {
  diagnostics.error("shifted-data-types", {&file, 3, 1}, "shifted");
  diagnostics.error("number-range", {&file, 12, 1}, "too large");
  EXPECT_FALSE(needs_outline(diagnostics, file));
  mark_consequences(diagnostics, {&file, {}, {}});
  EXPECT_EQ(diagnostics.all()[1].follows_from, 0U);
}

TEST_F(Consequences, OfAConsequenceHaveItsCause) {
  diagnostics.error("shifted-data-types", {&file, 3, 1}, "shifted");
  diagnostics.error("data-type", {&file, 4, 1}, "type");
  diagnostics.warning("standard-sub-index-missing", {&file, 4, 1}, "missing");
  mark();
  EXPECT_EQ(diagnostics.all()[1].follows_from, 0U);
  EXPECT_EQ(diagnostics.all()[2].follows_from, 0U);
}

TEST_F(Consequences, OfAnotherFileStayAlone) {
  const SourceFile other{"b.eds", ""};
  diagnostics.error("shifted-data-types", {&file, 3, 1}, "shifted");
  diagnostics.error("number-range", {&other, 12, 1}, "too large");
  mark();
  EXPECT_FALSE(diagnostics.all()[1].follows_from);
}

TEST_F(Consequences, AreCountedInTheText) {
  diagnostics.warning("never-writable", {&file, 20, 1}, "z");
  diagnostics.error("number-range", {&file, 12, 1}, "too large");
  diagnostics.error("shifted-data-types", {&file, 13, 1}, "shifted");
  mark();
  EXPECT_EQ(text(),
            "a.eds:13:1: error: shifted [shifted-data-types]\n   13 | \n      | ^\n"
            "a.eds: note: 2 findings follow from this: 1 number-range, 1 never-writable (--all-findings lists them)\n"
            "a.eds: 1 cause, 2 errors, 1 warning; 2 stop generate\n");
  const std::string all = text(true);
  EXPECT_LT(all.find("[shifted-data-types]"), all.find("[number-range]"));
  EXPECT_LT(all.find("[number-range]"), all.find("[never-writable]"));
  EXPECT_EQ(all.find("follow from"), std::string::npos);
}

TEST_F(Consequences, AreCountedBeyondTheListedOnes) {
  diagnostics.error("shifted-data-types", {&file, 13, 1}, "shifted");
  for (std::size_t time = 0; time < Diagnostics::max_per_rule + 7; ++time) {
    diagnostics.error("number-range", {&file, 12, 1}, "too large");
  }
  mark();
  EXPECT_NE(text().find("57 findings follow from this: 57 number-range"), std::string::npos) << text();
  EXPECT_EQ(text().find("more of this kind"), std::string::npos) << text();
  EXPECT_EQ(count_causes(diagnostics), 1U);
}

TEST_F(Consequences, AreLinkedInJson) {
  diagnostics.warning("never-writable", {&file, 20, 1}, "z");
  diagnostics.error("shifted-data-types", {&file, 13, 1}, "shifted");
  mark();
  const nlohmann::json json = print_json(diagnostics);
  EXPECT_EQ(json["causes"], 1);
  EXPECT_EQ(json["warnings"], 1);
  EXPECT_FALSE(json["diagnostics"][0].contains("follows_from"));
  EXPECT_EQ(json["diagnostics"][1]["follows_from"], 0);
}

TEST_F(Consequences, AreLinkedInSarif) {
  diagnostics.warning("never-writable", {&file, 20, 1}, "z");
  diagnostics.error("shifted-data-types", {&file, 13, 1}, "shifted");
  mark();
  SarifLog sarif{"1", check_rules, [](const Rule&) { return std::string{}; }};
  sarif.add(diagnostics);
  const nlohmann::ordered_json document = sarif.document();
  const nlohmann::ordered_json& result = document["runs"][0]["results"][1];
  EXPECT_EQ(result["ruleId"], "never-writable");
  EXPECT_EQ(result["properties"]["followsFrom"], "shifted-data-types");
  EXPECT_EQ(result["relatedLocations"][0]["physicalLocation"]["region"]["startLine"], 13);
}

TEST(ReportOrder, IsByFileThenSeverityThenLine) {
  const SourceFile first{"a.eds", ""};
  const SourceFile second{"b.eds", ""};
  Diagnostics diagnostics;
  diagnostics.note("file-name", {&first, 9, 1}, "note");
  diagnostics.error("number-range", {&second, 1, 1}, "other file");
  diagnostics.warning("number-range", {&first, 7, 1}, "later");
  diagnostics.warning("sub-number", {&first, 2, 1}, "earlier");
  diagnostics.error("number-range", {&first, 30, 1}, "error");
  EXPECT_EQ(report_order(diagnostics), (std::vector<std::size_t>{4, 3, 2, 0, 1}));
}

/// A rule that follows from itself, or from two rules in a circle, would never be reported.
TEST(CauseRows, DoNotFormACircle) {
  for (const CauseRow& row : cause_rows()) {
    EXPECT_FALSE(row.consequences.empty()) << row.cause.text();
    for (const CauseRow& other : cause_rows()) {
      const bool forward = std::ranges::find(row.consequences, other.cause) != row.consequences.end();
      const bool back = std::ranges::find(other.consequences, row.cause) != other.consequences.end();
      EXPECT_FALSE(row.cause != other.cause && forward && back) << row.cause.text() << " " << other.cause.text();
    }
  }
}

}  // namespace
}  // namespace edsc

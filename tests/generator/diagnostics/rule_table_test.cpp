/// The rule table. RuleId checks at compile time that a finding has a rule of the table and one of its severities.
/// tests/generator/lint/rules_test.py shows that each rule has findings.
#include <gtest/gtest.h>

#include <set>
#include <string_view>
#include <type_traits>

#include "diagnostics/rule.hpp"

namespace edsc {
namespace {

TEST(RuleTable, HoldsEachIdOnceWithMeaningAndSource) {
  std::set<std::string_view> ids;
  for (const Rule& rule : all_rules()) {
    EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
    EXPECT_FALSE(rule.meaning.empty()) << rule.id;
    EXPECT_FALSE(rule.source.empty()) << rule.id;
    EXPECT_LE(rule.mildest, rule.severity) << rule.id;
  }
}

TEST(RuleTable, FindsARuleByItsId) {
  EXPECT_EQ(find_rule("pdo-size")->severity, Severity::error);
  EXPECT_EQ(find_rule("no-such-rule"), nullptr);
}

TEST(RuleTable, SaysWhichSeveritiesAFindingMayHave) {
  EXPECT_TRUE(find_rule("pdo-size")->allows(Severity::error));
  EXPECT_TRUE(find_rule("pdo-size")->allows(Severity::warning));
  EXPECT_FALSE(find_rule("pdo-size")->allows(Severity::note));
  EXPECT_FALSE(find_rule("file-name")->allows(Severity::warning));
}

/// A function that reports errors does not accept a rule that has only warnings.
TEST(RuleId, IsOfTheSeveritiesThatItsTypeNames) {
  using Either = RuleId<Severity::error, Severity::warning>;
  static_assert(std::is_convertible_v<Either, ErrorRule>);
  static_assert(std::is_convertible_v<Either, WarningRule>);
  static_assert(std::is_convertible_v<Either, AnyRule>);
  static_assert(!std::is_convertible_v<Either, NoteRule>);
  static_assert(!std::is_convertible_v<WarningRule, ErrorRule>);
  static_assert(!std::is_convertible_v<AnyRule, WarningRule>);
  static_assert(!std::is_convertible_v<std::string_view, WarningRule>);
}

}  // namespace
}  // namespace edsc

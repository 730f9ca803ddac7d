/// The rule tables of edsc check, audit and diff. RuleOf checks at compile time that a finding has a rule of its table
/// and one of the severities of the row. tests/generator/lint/rules_test.py shows that each rule of edsc check has
/// findings.
#include <gtest/gtest.h>

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "audit/audit_rules.hpp"
#include "compare/change_rules.hpp"
#include "rules/check_rules.hpp"
#include "rules/rule_examples.hpp"

namespace edsc {
namespace {

class RuleTable : public testing::TestWithParam<std::span<const Rule>> {};

TEST_P(RuleTable, HoldsEachIdOnceWithTitleAndSource) {
  std::set<std::string_view> ids;
  for (const Rule& rule : GetParam()) {
    EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
    EXPECT_FALSE(rule.title.empty()) << rule.id;
    EXPECT_FALSE(rule.source.empty()) << rule.id;
    EXPECT_LE(rule.mildest, rule.severity) << rule.id;
    EXPECT_EQ(rule.breaks.any() && rule.severity != Severity::error, false) << rule.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, RuleTable, testing::Values(check_rules, audit::audit_rules, change_rules));

/// Of the rules of edsc audit and edsc diff, none has an example yet.
TEST(RuleExamples, AreOfEachRuleOfCheck) {
  for (const Rule& rule : check_rules) EXPECT_FALSE(examples_of(RuleId{rule}).empty()) << rule.id;
  for (const Rule& rule : audit::audit_rules) EXPECT_TRUE(examples_of(RuleId{rule}).empty()) << rule.id;
  for (const Rule& rule : change_rules) EXPECT_TRUE(examples_of(RuleId{rule}).empty()) << rule.id;
}

TEST(RuleExamples, AreTheLinesOfTheirFiles) {
  const std::vector<RuleExample>& examples = examples_of(AnyRule{"xml-profile"});
  ASSERT_EQ(examples.size(), 1U);
  EXPECT_EQ(examples[0].wrong, (std::vector<std::string>{"<?xml version=\"1.0\"?>\n<html/>\n ^\n"}));
  EXPECT_EQ(examples[0].right, std::vector<std::string>{});
}

TEST(RuleId, IsFoundByItsText) {
  EXPECT_EQ(find_rule(check_rules, "pdo-size"), AnyRule{"pdo-size"});
  EXPECT_EQ(find_rule(check_rules, "no-such-rule"), std::nullopt);
  EXPECT_EQ(find_rule(change_rules, "pdo-size"), std::nullopt);
}

/// Two tables may have one text for different rules.
TEST(RuleId, OfAnotherTableIsAnotherRule) {
  EXPECT_EQ(AnyRule{"pdo-length"}.text(), audit::AuditRule{"pdo-length"}.text());
  EXPECT_NE(RuleId{AnyRule{"pdo-length"}}, RuleId{audit::AuditRule{"pdo-length"}});
}

TEST(RuleId, OfNoTableHasNoText) {
  EXPECT_EQ(RuleId{}.text(), "");
  EXPECT_FALSE(RuleId{}.row().is_fatal);
}

TEST(Rule, SaysWhichSeveritiesAFindingMayHave) {
  const Rule& rule = AnyRule{"pdo-size"}.row();
  EXPECT_TRUE(rule.allows(Severity::error));
  EXPECT_TRUE(rule.allows(Severity::warning));
  EXPECT_FALSE(rule.allows(Severity::note));
  EXPECT_FALSE(AnyRule{"file-name"}.row().allows(Severity::warning));
}

TEST(Rule, IsFatalIfNoDeviceCanBeResolved) {
  EXPECT_TRUE(AnyRule{"no-objects"}.row().is_fatal);
  EXPECT_FALSE(AnyRule{"pdo-size"}.row().is_fatal);
}

/// A function that reports errors does not accept a rule that has only warnings.
TEST(RuleOf, IsOfTheSeveritiesThatItsTypeNames) {
  using Either = CheckRule<Severity::error, Severity::warning>;
  static_assert(std::is_convertible_v<Either, ErrorRule>);
  static_assert(std::is_convertible_v<Either, WarningRule>);
  static_assert(std::is_convertible_v<Either, AnyRule>);
  static_assert(!std::is_convertible_v<Either, NoteRule>);
  static_assert(!std::is_convertible_v<WarningRule, ErrorRule>);
  static_assert(!std::is_convertible_v<AnyRule, WarningRule>);
  static_assert(!std::is_convertible_v<audit::AuditRule, AnyRule>);
  static_assert(!std::is_convertible_v<std::string_view, WarningRule>);
}

}  // namespace
}  // namespace edsc

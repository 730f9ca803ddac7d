/// The rule table against the sources: every id that the generator reports is in it, and every id in it is reported.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "rules/rule.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// How the sources name the rule that they report: the first argument of a reporting function, the rule of a PDO finding,
/// the rule of a count key, a constant.
const std::regex reported_ids{
    R"re((?:(?:error|warning|report|count)\s*\(\s*|return \{|report_broken\(pdo, \{|rule = |\},\s*)"([a-z][a-z0-9-]*)")re"};

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::set<std::string> reported_in_sources() {
  std::set<std::string> ids;
  for (const auto& file : fs::recursive_directory_iterator{fs::path{EDSC_SOURCE_DIR} / "generator"}) {
    const std::string extension = file.path().extension().string();
    if ((extension != ".cpp" && extension != ".hpp") || file.path().filename() == "rule.cpp") continue;
    const std::string text = text_of(file.path());
    for (std::sregex_iterator at{text.begin(), text.end(), reported_ids}; at != std::sregex_iterator{}; ++at) {
      ids.insert((*at)[1].str());
    }
  }
  return ids;
}

TEST(RuleTable, HoldsEveryRuleThatIsReported) {
  const std::set<std::string> reported = reported_in_sources();
  ASSERT_GT(reported.size(), 40U) << "the sources were not found, or are written in another way now";
  for (const std::string& id : reported) EXPECT_NE(find_rule(id), nullptr) << id;
}

TEST(RuleTable, HoldsNoRuleThatIsNeverReported) {
  const std::set<std::string> reported = reported_in_sources();
  for (const Rule& rule : all_rules()) EXPECT_TRUE(reported.contains(std::string{rule.id})) << rule.id;
}

TEST(RuleTable, HoldsEachIdOnceWithMeaningAndSource) {
  std::set<std::string_view> ids;
  for (const Rule& rule : all_rules()) {
    EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
    EXPECT_FALSE(rule.meaning.empty()) << rule.id;
    EXPECT_FALSE(rule.source.empty()) << rule.id;
  }
}

TEST(RuleTable, FindsARuleByItsId) {
  EXPECT_EQ(find_rule("pdo-size")->severity, Severity::error);
  EXPECT_EQ(find_rule("no-such-rule"), nullptr);
}

}  // namespace
}  // namespace edsc

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

/// How the sources name the rule that they report: the first argument of Diagnostics::error or warning, or a text of
/// words with hyphens that begins a list of arguments or of members.
const std::regex reported_ids{
    R"re((?:iagnostics_?\.(?:error|warning)\(\s*"([a-z0-9-]+)"|[({]"([a-z0-9]+(?:-[a-z0-9]+)+)",))re"};

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>{in}, {}};
}

/// The text of the generator's sources but for the table itself, and for `edsc lss`, whose services have such names.
std::string sources() {
  std::string all;
  for (const auto& file : fs::recursive_directory_iterator{fs::path{EDSC_SOURCE_DIR} / "generator"}) {
    const std::string extension = file.path().extension().string();
    if ((extension != ".cpp" && extension != ".hpp") || file.path().filename() == "rule.cpp" ||
        file.path().filename() == "lss.cpp") {
      continue;
    }
    all += text_of(file.path());
  }
  return all;
}

std::set<std::string> reported_in(const std::string& text) {
  std::set<std::string> ids;
  for (std::sregex_iterator at{text.begin(), text.end(), reported_ids}; at != std::sregex_iterator{}; ++at) {
    ids.insert((*at)[1].matched ? (*at)[1].str() : (*at)[2].str());
  }
  return ids;
}

TEST(RuleTable, HoldsEveryRuleThatIsReported) {
  const std::set<std::string> reported = reported_in(sources());
  ASSERT_GT(reported.size(), 40U) << "the sources were not found, or are written in another way now";
  for (const std::string& id : reported) EXPECT_NE(find_rule(id), nullptr) << id;
}

TEST(RuleTable, HoldsNoRuleThatIsNeverReported) {
  const std::string text = sources();
  for (const Rule& rule : all_rules()) {
    std::string literal{"\""};
    literal.append(rule.id).append("\"");
    EXPECT_NE(text.find(literal), std::string::npos) << rule.id;
  }
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

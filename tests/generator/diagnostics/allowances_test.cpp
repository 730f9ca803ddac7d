#include "diagnostics/allowances.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "eds/allow_comments.hpp"
#include "rules/check_rules.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// `line rule: reason, scope` of each comment.
std::vector<std::string> comments_of(const std::string& text) {
  const SourceFile source("a.eds", text);
  std::vector<std::string> rows;
  for (const AllowComment& one : find_allow_comments(source).comments) {
    std::string row = std::to_string(one.position.line) + ' ' + std::string{one.rule} + ": " + std::string{one.reason};
    if (!one.has_target) row += ", nothing";
    if (one.has_target && one.scope.kind == AllowanceScope::Kind::file) row += ", file";
    if (one.scope.kind == AllowanceScope::Kind::part) row += ", section " + std::to_string(one.scope.line);
    if (one.scope.kind == AllowanceScope::Kind::line) row += ", line " + std::to_string(one.scope.line);
    rows.push_back(row);
  }
  return rows;
}

using Rows = std::vector<std::string>;

TEST(AllowComments, ApplyToTheFileBeforeTheFirstSection) {
  EXPECT_EQ(comments_of("; edsc: allow a-b - why not\n[FileInfo]\nFileName=x\n"), (Rows{"1 a-b: why not, file"}));
}

TEST(AllowComments, ApplyToTheSectionOrLineThatFollows) {
  EXPECT_EQ(
      comments_of("[FileInfo]\n;edsc:allow a - b - c\n\n; some words\n[1000]\n# edsc: allow d - e\nDataType=7\nx=1\n"),
      (Rows{"2 a: b - c, section 5", "6 d: e, line 7"}));
  EXPECT_EQ(comments_of("[1000]\n; edsc: allow a - b\n; edsc: allow c - d\nDataType=7\n"),
            (Rows{"2 a: b, line 4", "3 c: d, line 4"}));
  EXPECT_EQ(comments_of("[FileInfo]\n[1000] ; edsc: allow a - b\nDataType=7\n"), (Rows{"2 a: b, section 2"}));
  EXPECT_EQ(comments_of("[1000] ; edsc: allow a - b; c ;edsc: allow d - e\nDataType=7\n"),
            (Rows{"1 a: b; c, section 1", "1 d: e, section 1"}));
}

TEST(AllowComments, WithoutALineThatFollows) {
  EXPECT_EQ(comments_of("[1000]\nDataType=7\n; edsc: allow a - b\n\n; end\n"), (Rows{"3 a: b, nothing"}));
}

TEST(AllowComments, OfAnotherForm) {
  EXPECT_EQ(
      comments_of(
          "; edsc: allow\n; edsc: deny a - b\n; edsc: allow a\n; edsc: allow a -\n; edsc: allow a b\n; edsc allow a - b\n"),
      (Rows{"1 : , file", "2 : , file", "3 a: , file", "4 a: , file", "5 a: , file"}));
}

class AllowancesOfASheet : public testing::Test {
 protected:
  void allow(AllowanceScope scope, AnyRule rule = "file-name") { allowances_.add({rule, "because", {}, false, scope}); }

  /// The lines at which a finding of the rule is allowed; 0 is the file as a whole.
  std::vector<std::uint32_t> allowed_lines(AnyRule rule = "file-name") {
    allowances_.set_outline(find_allow_comments(source_).outline);
    std::vector<std::uint32_t> lines;
    for (std::uint32_t line = 0; line <= source_.lines(); ++line) {
      if (allowances_.find(rule, {&source_, line, 2, 1})) lines.push_back(line);
    }
    return lines;
  }

  static AllowanceScope object(std::uint16_t index) {
    AllowanceScope scope;
    scope.kind = AllowanceScope::Kind::object;
    scope.index = index;
    return scope;
  }

  static AllowanceScope entry(std::uint16_t index, std::uint8_t sub_index) {
    AllowanceScope scope = object(index);
    scope.kind = AllowanceScope::Kind::entry;
    scope.sub_index = sub_index;
    return scope;
  }

  const SourceFile source_{"a.eds",
                           "[OptionalObjects]\nSupportedObjects=2\n1=0x1003\n2=0x2000\n"  // 1
                           "[1003]\nSubNumber=2\n"                                        // 5
                           "[1003sub0]\nDataType=5\n"                                     // 7
                           "[1003sub1]\nDataType=7\n"                                     // 9
                           "[1003Value]\nNrOfEntries=1\n1=5\n"                            // 11
                           "[2000]\nDataType=7\n"};                                       // 14
  Allowances allowances_;
};

TEST_F(AllowancesOfASheet, OfTheFile) {
  allow({});
  EXPECT_EQ(allowed_lines().size(), source_.lines() + 1U);
  EXPECT_TRUE(allowed_lines("file-date").empty());
}

TEST_F(AllowancesOfASheet, OfALineAndASection) {
  AllowanceScope scope;
  scope.kind = AllowanceScope::Kind::line;
  scope.line = 2;
  allow(scope);
  scope.kind = AllowanceScope::Kind::part;
  scope.line = 7;
  allow(scope);
  EXPECT_EQ(allowed_lines(), (std::vector<std::uint32_t>{2, 7, 8}));
}

TEST_F(AllowancesOfASheet, OfAnObject) {
  allow(object(0x1003));
  EXPECT_EQ(allowed_lines(), (std::vector<std::uint32_t>{3, 5, 6, 7, 8, 9, 10, 11, 12, 13}));
}

TEST_F(AllowancesOfASheet, OfAnEntry) {
  allow(entry(0x1003, 1));
  allow(entry(0x2000, 0));
  EXPECT_EQ(allowed_lines(), (std::vector<std::uint32_t>{9, 10, 13, 14, 15}));
}

TEST_F(AllowancesOfASheet, OfAnotherFileAreNone) {
  allow({});
  const SourceFile other("b.eds", "[1000]\n");
  allowances_.set_outline(find_allow_comments(source_).outline);
  EXPECT_EQ(allowances_.find(AnyRule{"file-name"}, {&other, 1, 1, 1}), std::nullopt);
}

}  // namespace
}  // namespace edsc

#include "conform/requirements.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "conform/case.hpp"

namespace edsc::conform {
namespace {

std::set<std::string> ids_of_cases() {
  std::set<std::string> ids;
  for (const CaseRow* row : all_cases()) ids.insert(std::string{row->id});
  return ids;
}

TEST(Requirements, NameCasesThatExist) {
  const std::set<std::string> ids = ids_of_cases();
  for (const RequirementRow& row : requirements()) {
    for (const std::string_view id : case_ids(row)) {
      EXPECT_TRUE(ids.contains(std::string{id})) << row.requirement << ": " << id;
    }
  }
}

TEST(Requirements, NameEachCase) {
  std::set<std::string> named;
  for (const RequirementRow& row : requirements()) {
    for (const std::string_view id : case_ids(row)) named.insert(std::string{id});
  }
  for (const std::string& id : ids_of_cases()) EXPECT_TRUE(named.contains(id)) << id;
}

TEST(Requirements, HaveACaseOrAReason) {
  std::set<std::string_view> sentences;
  for (const RequirementRow& row : requirements()) {
    EXPECT_FALSE(row.clause.empty()) << row.requirement;
    EXPECT_FALSE(row.cases.empty() && row.reason.empty()) << row.requirement;
    EXPECT_TRUE(sentences.insert(row.requirement).second) << row.requirement << ": twice";
  }
}

TEST(Requirements, AreServedByCaseIdsOneByOne) {
  EXPECT_EQ(case_ids({"", "", "2.1 2.13", ""}), (std::vector<std::string_view>{"2.1", "2.13"}));
  EXPECT_TRUE(case_ids({"", "", "", "reason"}).empty());
}

}  // namespace
}  // namespace edsc::conform

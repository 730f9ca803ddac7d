/// The table of what cases provoke.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "conform/case.hpp"
#include "conform/provocations.hpp"

namespace edsc::conform {
namespace {

TEST(Provocations, NameCasesThatExist) {
  for (const Provocation& row : provocations()) {
    std::istringstream ids{std::string{row.cases}};
    for (std::string id; ids >> id;) {
      const auto rows = all_cases();
      const bool exists = std::ranges::any_of(rows, [&](const CaseRow* one) { return one->id == id; });
      EXPECT_TRUE(exists || id == "start") << row.rule.text() << ": " << id;
    }
  }
}

TEST(Provocations, OfACase) {
  EXPECT_EQ(provoked_by("2.17"), (std::vector<std::string_view>{"sdo-abort", "sdo-toggle"}));
  EXPECT_EQ(provoked_by("2.1"), std::vector<std::string_view>{}) << "2.10 is another case";
  EXPECT_EQ(provoked_by("start"), std::vector<std::string_view>{"sdo-abort"});
}

}  // namespace
}  // namespace edsc::conform

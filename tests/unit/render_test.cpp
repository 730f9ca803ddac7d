#include "render/render.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace edsc {
namespace {

using nlohmann::ordered_json;

TEST(Render, FillsValuesUnescaped) {
  EXPECT_EQ(render("{{text}}|{{number}}", {{"text", "a < \"b\" & c"}, {"number", 42}}), "a < \"b\" & c|42");
}

TEST(Render, LeavesNothingOfALineThatHoldsASectionTagOnly) {
  const char* text =
      "begin\n"
      "{{#rows}}\n"
      "  {{text}},\n"
      "{{/rows}}\n"
      "end\n";
  EXPECT_EQ(render(text, {{"rows", {{{"text", "1"}}, {{"text", "2"}}}}}), "begin\n  1,\n  2,\nend\n");
  EXPECT_EQ(render(text, {{"rows", ordered_json::array()}}), "begin\nend\n");
}

TEST(Render, LeavesNothingOfAnIndentedSectionLine) {
  EXPECT_EQ(render("a\n    {{#on}}\nb\n    {{/on}}\nc\n", {{"on", true}}), "a\nb\nc\n");
  EXPECT_EQ(render("a\n    {{^on}}\nb\n    {{/on}}\nc\n", {{"on", true}}), "a\nc\n");
}

TEST(Render, KeepsTheLineOfASectionThatStandsInIt) {
  const char* text = "<{{#items}}{{separator}}{{name}}{{/items}}>\n";
  EXPECT_EQ(render(text, {{"items", {{{"separator", ""}, {"name", "a"}}, {{"separator", ", "}, {"name", "b"}}}}}),
            "<a, b>\n");
  EXPECT_EQ(render(text, {{"items", ordered_json::array()}}), "<>\n");
}

TEST(Render, KeepsALastLineWithoutItsEnd) {
  EXPECT_EQ(render("a\n{{#on}}\nb\n{{/on}}", {{"on", true}}), "a\nb\n");
  EXPECT_EQ(render("a", ordered_json::object()), "a");
  EXPECT_EQ(render("", ordered_json::object()), "");
}

TEST(Render, TakesNullAndFalseForNothing) {
  EXPECT_EQ(render("{{#a}}x{{/a}}{{^b}}y{{/b}}", {{"a", nullptr}, {"b", false}}), "y");
}

TEST(Render, DoesNotReadTagsInValues) { EXPECT_EQ(render("{{name}}", {{"name", "{{#x}}"}}), "{{#x}}"); }

TEST(Render, ThrowsWhenATemplateIsWrong) {
  EXPECT_THROW(static_cast<void>(render("{{#open}}\n", ordered_json::object())), std::runtime_error);
}

TEST(Render, HasATemplateForEachGeneratedHeader) {
  std::vector<std::string_view> names;
  for (const Template& one : built_in_templates()) names.push_back(one.file_name);
  EXPECT_EQ(names, (std::vector<std::string_view>{"dictionary.hpp", "pdo.hpp", "device.hpp", "description.hpp",
                                                  "stored_eds.hpp"}));
}

}  // namespace
}  // namespace edsc

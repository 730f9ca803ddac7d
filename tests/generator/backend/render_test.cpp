#include "backend/render.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "backend/cpp/cpp_view.hpp"
#include "support/device_from_text.hpp"

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

TEST(Render, ThrowsWhenTheViewDoesNotHaveAName) {
  const ordered_json view{{"name", "a"}, {"row", {{"text", "b"}}}};
  for (const char* text : {"{{nmae}}", "{{#nmae}}{{/nmae}}", "{{^nmae}}{{/nmae}}", "{{#row}}{{nmae}}{{/row}}"}) {
    try {
      static_cast<void>(render(text, view));
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "{{nmae}}: the view does not have this name");
    }
  }
  EXPECT_EQ(render("{{#row}}{{name}}{{text}}{{/row}}", view), "ab");
}

TEST(Render, ThrowsWhenATemplateIsWrong) {
  EXPECT_THROW(static_cast<void>(render("{{#open}}\n", ordered_json::object())), std::runtime_error);
}

TEST(Render, HasATemplateForEachGeneratedHeader) {
  std::string listed, built_in;
  for (const Template& one : built_in_templates()) built_in += fmt::format("{} ", one.file_name);
  std::ifstream list{EDSC_SOURCE_DIR "/cmake/EdscHeaders.cmake"};
  for (std::string line; std::getline(list, line);) {
    if (line.starts_with("set(")) listed += line.substr(line.find(' ') + 1, line.find(')') - line.find(' ') - 1) + " ";
  }
  EXPECT_EQ(built_in, listed);
  EXPECT_NE(listed.find("dictionary.hpp "), std::string::npos);
}

/// The names of the elements of an ARRAY `Gains` at 2000h; `other` is the name of a VAR at 2001h.
std::vector<std::string> element_names(const std::vector<std::string>& names, Options options = {},
                                       std::string_view other = "Other") {
  std::string text = group("2000", "Gains", "0x8", static_cast<int>(names.size()) + 1) +
                     var("2000sub0", "Count", "5", "const", "DefaultValue=" + std::to_string(names.size()) + "\n");
  for (std::size_t i = 0; i < names.size(); ++i) text += var("2000sub" + std::to_string(i + 1), names[i], "7");
  const DeviceFromText device{text + var("2001", other, "7"), std::move(options)};
  Diagnostics ignored;
  const ordered_json array = cpp_view(device.named(), device.options, ignored)["types"][0]["array"];
  std::vector<std::string> found;
  if (array["elements"].is_null()) return found;
  for (const ordered_json& row : array["elements"]["rows"]) {
    found.push_back(row["identifier"].get<std::string>() + " = " + array["elements"]["array"].get<std::string>() + "<" +
                    std::to_string(row["number"].get<int>()) + ">");
  }
  return found;
}

using Words = std::vector<std::string>;

TEST(ElementNames, AreThoseThatSayMoreThanANumber) {
  EXPECT_EQ(element_names({"P", "I", "D"}), (Words{"gains_p = gains<1>", "gains_i = gains<2>", "gains_d = gains<3>"}));
  EXPECT_EQ(element_names({"Gains 1", "Gains 2"}), Words{});
  EXPECT_EQ(element_names({"Gain1", "Gain2", "Gain of the filter"}), (Words{"gains_gain_of_the_filter = gains<3>"}));
  EXPECT_EQ(element_names({"Gains"}), Words{});
  EXPECT_EQ(element_names({"Gain 1"}), Words{});
  EXPECT_EQ(element_names({"P"}), (Words{"gains_p = gains<1>"}));
}

TEST(ElementNames, DoNotRepeatTheNameOfTheObject) {
  EXPECT_EQ(element_names({"Gains P", "Gains I"}), (Words{"gains_p = gains<1>", "gains_i = gains<2>"}));
  EXPECT_EQ(element_names({"Default", "Gainsay"}), (Words{"gains_default = gains<1>", "gains_gainsay = gains<2>"}));
}

TEST(ElementNames, GiveWayToObjects) {
  EXPECT_EQ(element_names({"P", "I"}, {}, "Gains P"), (Words{"gains_p_2000_01 = gains<1>", "gains_i = gains<2>"}));
}

TEST(ElementNames, AreThoseOfTheOptions) {
  Options options;
  options.names[{0x2000, 2}] = "integral";
  EXPECT_EQ(element_names({"Gain 1", "Gain 2"}, options), (Words{"gains_integral = gains<2>"}));
}

}  // namespace
}  // namespace edsc

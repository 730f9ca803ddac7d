#include "diagnostics/diagnostics.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "diagnostics/excerpt.hpp"
#include "diagnostics/place.hpp"
#include "diagnostics/print.hpp"
#include "diagnostics/quote.hpp"
#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

std::string printed(const Diagnostics& diagnostics) {
  std::string text;
  print_text(text, diagnostics, {});
  return text;
}

TEST(Diagnostics, CountErrorsAndWarnings) {
  const SourceFile file("a.eds", "x\n");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&file, 1, 1}, "first");
  diagnostics.warning("data-type", {&file, 1, 1}, "second");
  diagnostics.warning("data-type", {&file, 1, 1}, "third");
  EXPECT_EQ(diagnostics.errors(), 1U);
  EXPECT_EQ(diagnostics.warnings(), 2U);
  EXPECT_EQ(diagnostics.all().size(), 3U);
}

TEST(Diagnostics, DropSilencedRules) {
  Diagnostics diagnostics;
  diagnostics.silence(AnyRule{"number-range"});
  diagnostics.warning("data-type", {}, "kept");
  EXPECT_FALSE(diagnostics.any_silenced());
  diagnostics.warning("number-range", {}, "dropped");
  EXPECT_TRUE(diagnostics.any_silenced());
  ASSERT_EQ(diagnostics.all().size(), 1U);
  EXPECT_EQ(diagnostics.all().at(0).rule.text(), "data-type");
}

TEST(Diagnostics, DropSilencedErrorsForCheckOnly) {
  Diagnostics diagnostics;
  diagnostics.silence(AnyRule{"number-range"});
  diagnostics.error("number-range", {}, "kept");
  EXPECT_EQ(diagnostics.errors(), 1U);
  diagnostics.silence_errors();
  diagnostics.error("number-range", {}, "dropped");
  diagnostics.error("data-type", {}, "kept");
  EXPECT_EQ(diagnostics.errors(), 2U);
}

TEST(Diagnostics, SetAllowedFindingsAside) {
  const SourceFile file("a.eds", "x\n");
  Diagnostics diagnostics;
  diagnostics.set_outline({&file, {}, {}});
  diagnostics.allow({AnyRule{"number-range"}, "because", {&file, 1, 1}, true, {}});
  diagnostics.warning("number-range", {&file, 1, 1}, "expected");
  diagnostics.error("number-range", {&file, 1, 1}, "an error stays");
  EXPECT_EQ(diagnostics.suppressed_findings(), 1U);
  EXPECT_EQ(diagnostics.allowances()[0].findings, 1U);
  EXPECT_EQ(diagnostics.errors(), 1U);
  EXPECT_EQ(diagnostics.warnings(), 0U);
  EXPECT_TRUE(diagnostics.any_silenced());
}

TEST(Diagnostics, SayWhichSilencedRulesHaveFired) {
  Diagnostics diagnostics;
  diagnostics.silence(AnyRule{"number-range"});
  diagnostics.silence(AnyRule{"data-type"});
  diagnostics.warning("data-type", {}, "dropped");
  EXPECT_FALSE(diagnostics.has_silenced(AnyRule{"number-range"}));
  EXPECT_TRUE(diagnostics.has_silenced(AnyRule{"data-type"}));
}

TEST(Diagnostics, KeepGoingInOneFile) {
  const SourceFile foreign("a.eds", "x\n");
  const SourceFile own("a.options.json", "x\n");
  Diagnostics diagnostics;
  diagnostics.keep_going(&foreign);
  diagnostics.error("number-range", {&foreign, 1, 1}, "the maker's");
  EXPECT_EQ(diagnostics.warnings(), 1U);
  diagnostics.error("number-range", {&own, 1, 1}, "the user's");
  diagnostics.error("no-objects", {&foreign, 1, 1}, "nothing is left");
  EXPECT_EQ(diagnostics.errors(), 2U);
}

TEST(Diagnostics, CountWarningsAsErrorsWhenStrict) {
  Diagnostics diagnostics;
  diagnostics.warning("number-range", {}, "before");
  diagnostics.treat_warnings_as_errors();
  diagnostics.warning("number-range", {}, "after");
  EXPECT_EQ(diagnostics.warnings(), 1U);
  EXPECT_EQ(diagnostics.errors(), 1U);
  EXPECT_EQ(diagnostics.all().at(1).severity, Severity::error);
}

TEST(Diagnostics, ListTheFirstOfARuleAndCountTheRest) {
  const SourceFile file("a.eds", "x\n");
  const SourceFile other("b.eds", "x\n");
  Diagnostics diagnostics;
  for (int time = 0; time < 100'000; ++time) {
    diagnostics.warning("number-range", {&file, 1, 1}, "again");
  }
  diagnostics.warning("number-range", {&other, 1, 1}, "elsewhere");
  EXPECT_EQ(diagnostics.all().size(), Diagnostics::max_per_rule + 1);
  ASSERT_EQ(diagnostics.omitted().size(), 1U);
  EXPECT_EQ(diagnostics.omitted()[0].file, &file);
  EXPECT_EQ(diagnostics.omitted()[0].rule.text(), "number-range");
  EXPECT_EQ(diagnostics.omitted()[0].count, 100'000 - Diagnostics::max_per_rule);
  EXPECT_EQ(diagnostics.warnings(), 100'001U);
}

TEST(PrintText, ShowsTheLineAndUnderlinesThePlace) {
  const SourceFile file("eds/a.eds", "[1A00sub1]\nDefaultValue=0x60400010\n");
  Diagnostics diagnostics;
  diagnostics.error("pdo-direction", {&file, 2, 14, 10}, "TPDO 1 maps \"Controlword\"");
  EXPECT_EQ(printed(diagnostics),
            "eds/a.eds:2:14: error: TPDO 1 maps \"Controlword\" [pdo-direction]\n"
            "    2 | DefaultValue=0x60400010\n"
            "      |              ^~~~~~~~~~\n"
            "eds/a.eds: 1 error, 0 warnings\n");
}

TEST(PrintText, ShowsNotesLikewise) {
  const SourceFile file("a.eds", "[1000]\n[1000]\n");
  Diagnostics diagnostics;
  diagnostics.warning("duplicate-key", {&file, 2, 2, 4}, "second", {{{&file, 1, 2, 4}, "first"}});
  EXPECT_EQ(printed(diagnostics),
            "a.eds:2:2: warning: second [duplicate-key]\n"
            "    2 | [1000]\n"
            "      |  ^~~~\n"
            "a.eds:1:2: note: first\n"
            "    1 | [1000]\n"
            "      |  ^~~~\n"
            "a.eds: 0 errors, 1 warning\n");
}

TEST(PrintText, ShowsAWholeFileAsItsFirstLine) {
  const SourceFile file("a.eds", "");
  Diagnostics diagnostics;
  diagnostics.error("empty-file", {&file}, "nothing in it");
  EXPECT_EQ(printed(diagnostics),
            "a.eds:1:1: error: nothing in it [empty-file]\n"
            "a.eds: 1 error, 0 warnings\n");
}

TEST(PrintText, PutsTheSuppressedBehindTheirRule) {
  const SourceFile file("a.eds", "");
  Diagnostics diagnostics;
  for (std::size_t time = 0; time < Diagnostics::max_per_rule + 3; ++time) {
    diagnostics.warning("number-range", {&file}, "again");
  }
  diagnostics.error("data-type", {&file}, "last");
  const std::string text = printed(diagnostics);
  EXPECT_TRUE(
      text.ends_with("a.eds:1:1: warning: again [number-range]\n"
                     "a.eds: warning: 3 more of this kind [number-range]\n"
                     "a.eds: 1 error, 53 warnings\n"))
      << text;
}

/// 160 findings with one cause and one finding with another, in a file of 200 lines.
Diagnostics findings_of_one_cause(const SourceFile& file) {
  Diagnostics diagnostics;
  for (std::uint32_t line = 1; line <= 160; ++line) {
    diagnostics.error("number-range", {&file, line, 1}, "maps an rwr", {}, "rwr");
  }
  diagnostics.error("number-range", {&file, 170, 1}, "maps a const", {}, "const");
  return diagnostics;
}

TEST(Diagnostics, MakeOneOfTheFindingsOfOneCause) {
  const SourceFile file("a.eds", std::string(200, '\n'));
  const Diagnostics diagnostics = findings_of_one_cause(file);
  EXPECT_EQ(diagnostics.errors(), 2U);
  EXPECT_TRUE(diagnostics.omitted().empty());
  ASSERT_EQ(diagnostics.all().size(), 2U);
  const Diagnostic& first = diagnostics.all().front();
  EXPECT_EQ(first.position.line, 1U);
  EXPECT_EQ(first.places, 160U);
  ASSERT_EQ(first.notes.size(), 159U);
  EXPECT_EQ(first.notes.back().position.line, 160U);
  EXPECT_EQ(first.unnamed, 0U);
  EXPECT_EQ(diagnostics.all().back().places, 1U);
}

TEST(Diagnostics, StoreAThousandPlacesOfOneCause) {
  const SourceFile file("a.eds", std::string(2000, '\n'));
  Diagnostics diagnostics;
  for (std::uint32_t line = 1; line <= 1500; ++line) {
    diagnostics.error("number-range", {&file, line, 1}, "again", {}, "cause");
  }
  const Diagnostic& first = diagnostics.all().front();
  EXPECT_EQ(first.places, 1500U);
  EXPECT_EQ(first.notes.size(), 999U);
  EXPECT_EQ(first.unnamed, 500U);
}

TEST(Diagnostics, KeepTheCausesOfOtherFilesAndSeveritiesApart) {
  const SourceFile one("a.eds", "");
  const SourceFile two("b.eds", "");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&one}, "x", {}, "cause");
  diagnostics.error("number-range", {&two}, "x", {}, "cause");
  diagnostics.warning("number-range", {&one}, "x", {}, "cause");
  diagnostics.error("data-type", {&one}, "x", {}, "cause");
  EXPECT_EQ(diagnostics.all().size(), 4U);
}

TEST(Diagnostics, CountManyCausesOnce) {
  const SourceFile file("a.eds", "");
  Diagnostics diagnostics;
  for (int time = 0; time < 2; ++time) {
    for (std::size_t cause = 0; cause < Diagnostics::max_per_rule + 5; ++cause) {
      diagnostics.error("number-range", {&file}, "x", {}, std::to_string(cause));
    }
  }
  EXPECT_EQ(diagnostics.errors(), Diagnostics::max_per_rule + 5);
  EXPECT_EQ(diagnostics.all().size(), Diagnostics::max_per_rule);
}

TEST(PrintText, NamesTheFirstPlacesOfOneCause) {
  const SourceFile file("a.eds", std::string(200, '\n'));
  const std::string text = printed(findings_of_one_cause(file));
  EXPECT_NE(text.find("a.eds:1:1: error: maps an rwr [number-range]\n"), std::string::npos) << text;
  EXPECT_NE(text.find("a.eds:4:1: note: maps an rwr\n"), std::string::npos) << text;
  EXPECT_NE(text.find("a.eds: note: 156 more places with the same cause\n"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("a.eds: 2 errors, 0 warnings\n")) << text;
}

TEST(PrintText, NamesAllPlacesOnDemand) {
  const SourceFile file("a.eds", std::string(200, '\n'));
  std::string text;
  print_text(text, findings_of_one_cause(file), {.all = true});
  EXPECT_NE(text.find("a.eds:160:1: note: maps an rwr\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("more places"), std::string::npos) << text;
}

TEST(PrintJson, CountsThePlacesOfOneCause) {
  const SourceFile file("a.eds", std::string(200, '\n'));
  const nlohmann::json json = print_json(findings_of_one_cause(file));
  EXPECT_EQ(json["diagnostics"][0]["places"], 160);
  EXPECT_FALSE(json["diagnostics"][1].contains("places"));
}

TEST(PrintText, SumsEachFile) {
  const SourceFile one("a.eds", "");
  const SourceFile two("b.eds", "");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&one}, "x");
  diagnostics.warning("number-range", {&two}, "x");
  const std::string text = printed(diagnostics);
  EXPECT_TRUE(text.ends_with("a.eds: 1 error, 0 warnings\nb.eds: 0 errors, 1 warning\n")) << text;
}

TEST(PrintText, CountsColumnsInCodePoints) {
  const SourceFile file("a.eds", "Maß €=x\n");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&file, 1, 10, 1}, "here");
  EXPECT_TRUE(printed(diagnostics)
                  .starts_with("a.eds:1:7: error: here [number-range]\n"
                               "    1 | Maß €=x\n"
                               "      |       ^\n"))
      << printed(diagnostics);
}

TEST(PrintText, LetsNoControlCharacterThrough) {
  const SourceFile file("a\x1B.eds", "a\tb\x1B[31m\x7F\xC2\x9B\n");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&file, 1, 1, 1}, "it says \x1B[0m");
  EXPECT_EQ(printed(diagnostics),
            "a<U+001B>.eds:1:1: error: it says <U+001B>[0m [number-range]\n"
            "    1 | a b<U+001B>[31m<U+007F><U+009B>\n"
            "      | ^\n"
            "a<U+001B>.eds: 1 error, 0 warnings\n");
}

TEST(PrintText, PutsTheCaretBelowWhatIsShown) {
  const SourceFile file("a.eds", "a\u202E=\u009Bx\n");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&file, 1, 6, 3}, "here");
  EXPECT_TRUE(printed(diagnostics)
                  .starts_with("a.eds:1:4: error: here [number-range]\n"
                               "    1 | a<U+202E>=<U+009B>x\n"
                               "      |           ^~~~~~~~~\n"))
      << printed(diagnostics);
}

TEST(PrintText, ColoursOnDemand) {
  const SourceFile file("a.eds", "x\n");
  Diagnostics diagnostics;
  diagnostics.error("number-range", {&file, 1, 1}, "here");
  std::string text;
  print_text(text, diagnostics, {.colour = true});
  EXPECT_NE(text.find("\x1B[1;31merror:\x1B[0m here"), std::string::npos) << text;
}

TEST(Excerpt, ShowsAShortLineWhole) {
  const Excerpt shown = excerpt("ab=cd", {nullptr, 1, 4, 2});
  EXPECT_EQ(shown.text, "ab=cd");
  EXPECT_EQ(shown.caret, 3U);
  EXPECT_EQ(shown.caret_columns, 2U);
}

TEST(Excerpt, CutsALongLineAroundThePlace) {
  const std::string line(100'000'000, 'x');
  const Excerpt middle = excerpt(line, {nullptr, 1, 50'000'000, 1});
  EXPECT_EQ(middle.text.size(), Excerpt::max_columns);
  EXPECT_TRUE(middle.text.starts_with("...x"));
  EXPECT_TRUE(middle.text.ends_with("x..."));
  EXPECT_EQ(middle.caret, 60U);

  const Excerpt start = excerpt(line, {nullptr, 1, 1, 100'000'000});
  EXPECT_TRUE(start.text.starts_with("xxxx"));
  EXPECT_EQ(start.caret, 0U);
  EXPECT_LT(start.caret_columns, Excerpt::max_columns);

  const Excerpt end = excerpt(line, {nullptr, 1, 100'000'000, 1});
  EXPECT_TRUE(end.text.ends_with("xxxx"));
  EXPECT_LT(end.caret, Excerpt::max_columns);
}

TEST(Excerpt, KeepsThePlaceBehindTheEndOfTheLine) {
  const Excerpt shown = excerpt("ab=", {nullptr, 1, 9, 5});
  EXPECT_EQ(shown.caret, 3U);
  EXPECT_EQ(shown.caret_columns, 1U);
}

TEST(Quote, CutsALongTextBetweenCodePoints) {
  EXPECT_EQ(quote("1018"), "\"1018\"");
  EXPECT_EQ(quote(std::string(59, 'y') + "ä" + std::string(1000, 'z')), "\"" + std::string(59, 'y') + "...\"");
}

TEST(PlaceOf, IsAllZeroWithoutAFile) {
  const Place place = place_of({});
  EXPECT_EQ(place.file, "");
  EXPECT_EQ(place.line, 0U);
  EXPECT_EQ(place.column, 0U);
  EXPECT_EQ(place.length, 0U);
}

TEST(PrintJson, HasAStableShape) {
  const SourceFile file("a.eds", "[1000]\n[1000]\n");
  Diagnostics diagnostics;
  diagnostics.warning("duplicate-key", {&file, 2, 2, 4}, "second", {{{&file, 1, 2, 4}, "first"}});
  diagnostics.error("empty-file", {&file}, "whole");
  const nlohmann::json expected = nlohmann::json::parse(R"({
    "schema": 2,
    "diagnostics": [
      {"file": "a.eds", "line": 1, "column": 1, "length": 1, "severity": "error", "rule": "empty-file",
       "message": "whole", "notes": []},
      {"file": "a.eds", "line": 2, "column": 2, "length": 4, "severity": "warning", "rule": "duplicate-key",
       "message": "second", "notes": [{"file": "a.eds", "line": 1, "column": 2, "length": 4, "message": "first"}]}],
    "allowed_diagnostics": [],
    "suppressed": [],
    "causes": 2, "errors": 1,
    "warnings": 1, "notes": 0, "allowed": 0})");
  EXPECT_EQ(print_json(diagnostics), expected);
}

TEST(PrintJson, CountsTheSuppressed) {
  const SourceFile file("a.eds", "");
  Diagnostics diagnostics;
  for (std::size_t time = 0; time < Diagnostics::max_per_rule + 2; ++time) {
    diagnostics.warning("number-range", {&file}, "again");
  }
  const nlohmann::json json = print_json(diagnostics);
  EXPECT_EQ(json["diagnostics"].size(), Diagnostics::max_per_rule);
  EXPECT_EQ(json["suppressed"],
            nlohmann::json::parse(R"([{"file": "a.eds", "severity": "warning", "rule": "number-range", "count": 2}])"));
  EXPECT_EQ(json["warnings"], Diagnostics::max_per_rule + 2);
}

}  // namespace
}  // namespace edsc

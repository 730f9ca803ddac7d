#include "text/printable.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "text/utf8.hpp"

namespace edsc {
namespace {

std::string utf8(char32_t code_point) {
  std::string text;
  append_utf8(text, code_point);
  return text;
}

TEST(Printable, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(printable("a\x1B[31m\x7F"), "a<U+001B>[31m<U+007F>");
  EXPECT_EQ(printable(utf8(0x9B) + "31m"), "<U+009B>31m");
  EXPECT_EQ(printable(utf8(0x202E) + utf8(0xE0041)), "<U+202E><U+E0041>");
}

/// The Unicode Bidirectional Algorithm, 2: all explicit marks; The Unicode Standard, 23.1: all control codes.
TEST(Printable, LetsNoControlAndNoDirectionMarkThrough) {
  for (char32_t c = 0; c < 0x3000; ++c) {
    const bool is_control = c < 0x20 || (c >= 0x7F && c < 0xA0);
    const bool is_mark =
        c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
    EXPECT_TRUE(is_hidden(c) || !(is_control || is_mark)) << static_cast<unsigned>(c);
    EXPECT_EQ(printable(utf8(c)).find(utf8(c)) == std::string::npos, is_hidden(c)) << static_cast<unsigned>(c);
  }
}

TEST(Printable, ShowsBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("a\x9B"
                      "31m\xFF"),
            "a<9B>31m<FF>");
  EXPECT_EQ(printable("\xE2\x80"), "<E2><80>");
  EXPECT_EQ(printable("\xC0\x9B"), "<C0><9B>");
}

TEST(Printable, KeepsOtherText) {
  const std::string text = "Größe µm 速度 می\u200Cخواهم \u00A0 \U0001F600";
  EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable("a\tb\nc"), "a b c");
}

TEST(PrintableJson, IsTheSameValueWithoutHiddenCharacters) {
  std::string text = "\t\"\\ Größe";
  for (char32_t c = 0x7F; c < 0x3000; ++c) {
    if (is_hidden(c)) text += utf8(c);
  }
  text += utf8(0xE0041);
  const nlohmann::json value{{"text", text}, {text, 1}};
  const std::string json = json_text(value);
  EXPECT_EQ(nlohmann::json::parse(json), value);
  for (std::string_view rest = json; !rest.empty(); rest.remove_prefix(first_sequence(rest).length)) {
    EXPECT_TRUE(rest.front() == '\n' || first_sequence(rest).is_visible);
  }
  EXPECT_NE(json.find("\\uDB40\\uDC41"), std::string::npos) << "a surrogate pair";
}

}  // namespace
}  // namespace edsc

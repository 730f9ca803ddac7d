#include "text/printable.hpp"

#include <algorithm>
#include <iterator>

#include "text/utf8.hpp"

namespace edsc {
namespace {

struct CodePoints {
  char32_t first, last;
};

constexpr CodePoints hidden_code_points[] = {
    {0x0000, 0x001F},    // C0 controls
    {0x007F, 0x009F},    // DEL, C1 controls
    {0x061C, 0x061C},    // ARABIC LETTER MARK
    {0x180E, 0x180E},    // MONGOLIAN VOWEL SEPARATOR
    {0x200B, 0x200B},    // ZERO WIDTH SPACE
    {0x200E, 0x200F},    // LEFT-TO-RIGHT MARK, RIGHT-TO-LEFT MARK
    {0x2028, 0x202E},    // LINE SEPARATOR, PARAGRAPH SEPARATOR, embeddings and overrides
    {0x2060, 0x206F},    // invisible operators, isolates, deprecated format characters
    {0xFEFF, 0xFEFF},    // ZERO WIDTH NO-BREAK SPACE
    {0xFFF9, 0xFFFB},    // interlinear annotation
    {0xFFFE, 0xFFFF},    // noncharacters, which XML does not allow
    {0xE0001, 0xE0001},  // LANGUAGE TAG
    {0xE0020, 0xE007F},  // tags
};

bool is_white_space(char c) { return c == '\t' || c == '\n' || c == '\r'; }
bool is_plain(char c) { return c >= ' ' && c <= '~'; }

}  // namespace

bool is_hidden(char32_t code_point) {
  return std::ranges::any_of(hidden_code_points,
                             [&](const CodePoints& row) { return code_point >= row.first && code_point <= row.last; });
}

Sequence first_sequence(std::string_view text) {
  const std::size_t length = utf8_sequence_length(text);
  if (length == 0) return {1, false};
  return {length, !is_hidden(code_point_of(text.substr(0, length)))};
}

void append_printable(std::string& out, std::string_view text) {
  while (!text.empty()) {
    const auto plain = static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_plain) - text.begin());
    out += text.substr(0, plain);
    text.remove_prefix(plain);
    if (text.empty()) return;
    const auto [length, is_visible] = first_sequence(text);
    if (is_visible) {
      out += text.substr(0, length);
    } else if (is_white_space(text.front())) {
      out += ' ';
    } else if (length == 1 && static_cast<unsigned char>(text.front()) >= 0x80) {
      fmt::format_to(std::back_inserter(out), "<{:02X}>",
                     static_cast<unsigned>(static_cast<unsigned char>(text.front())));
    } else {
      fmt::format_to(std::back_inserter(out), "<U+{:04X}>",
                     static_cast<unsigned>(code_point_of(text.substr(0, length))));
    }
    text.remove_prefix(length);
  }
}

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  append_printable(out, text);
  return out;
}

std::string printable_json(std::string json) {
  // Strings in JSON contain no white space except blanks.
  const auto stays = [](char c) { return is_plain(c) || is_white_space(c); };
  if (std::ranges::all_of(json, stays)) return json;
  std::string out;
  out.reserve(json.size());
  for (std::string_view text = json; !text.empty();) {
    const auto [length, is_visible] = first_sequence(text);
    if (is_visible || stays(text.front())) {
      out += text.substr(0, length);
    } else {
      for (const char16_t unit : to_utf16(text.substr(0, length))) {
        fmt::format_to(std::back_inserter(out), "\\u{:04X}", static_cast<unsigned>(unit));
      }
    }
    text.remove_prefix(length);
  }
  return out;
}

}  // namespace edsc

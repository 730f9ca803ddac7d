#include "text/snake_case.hpp"

#include <algorithm>
#include <array>

#include "text/ascii.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

struct Spelling {
  char32_t code_point;
  std::string_view text;
};

constexpr std::array spellings = {
    Spelling{0x00B0, "deg"}, Spelling{0x00B2, "2"},  Spelling{0x00B3, "3"},   Spelling{0x00B5, "u"},
    Spelling{0x00C4, "Ae"},  Spelling{0x00D6, "Oe"}, Spelling{0x00DC, "Ue"},  Spelling{0x00DF, "ss"},
    Spelling{0x00E0, "a"},   Spelling{0x00E1, "a"},  Spelling{0x00E4, "ae"},  Spelling{0x00E8, "e"},
    Spelling{0x00E9, "e"},   Spelling{0x00EA, "e"},  Spelling{0x00F1, "n"},   Spelling{0x00F3, "o"},
    Spelling{0x00F6, "oe"},  Spelling{0x00FC, "ue"}, Spelling{0x03A9, "ohm"}, Spelling{0x03BC, "u"},
    Spelling{0x2126, "ohm"},
};

/// Keeps ASCII letters and digits, transliterates code points with a usual spelling, and replaces others by a blank.
std::string to_ascii(std::string_view name) {
  if (is_ascii(name)) return std::string{name};
  std::string out;
  for_each_code_point(name, [&](char32_t code_point) {
    const auto at = std::ranges::find(spellings, code_point, &Spelling::code_point);
    if (code_point < 0x80) {
      out += static_cast<char>(code_point);
    } else {
      out += at == spellings.end() ? " " : at->text;
    }
  });
  return out;
}

/// Whether a new word begins at `i`: after a lower-case letter or digit, or where the last capital of a run starts a
/// word (`RxPDOMapping`: rx, pdo, mapping).
bool word_begins(std::string_view text, std::size_t i) {
  if (i == 0 || !is_upper(text[i])) return false;
  if (is_lower(text[i - 1])) return true;
  if (is_upper(text[i - 1]) && i + 1 < text.size() && is_lower(text[i + 1])) {
    return i + 2 < text.size() && is_lower(text[i + 2]);  // `COBs`, `PDOs`: a plural, not a new word
  }
  return false;
}

}  // namespace

std::string to_snake_case(std::string_view name) {
  const std::string text = to_ascii(name);
  std::string out;
  out.reserve(text.size() + 4);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool letter = is_lower(text[i]) || is_upper(text[i]) || is_digit(text[i]);
    const bool gap = !letter || word_begins(text, i);
    if (gap && !out.empty() && out.back() != '_') out += '_';
    if (letter) out += to_lower(text[i]);
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (!out.empty() && is_digit(out.front())) out.insert(0, "n_");
  return out;
}

}  // namespace edsc

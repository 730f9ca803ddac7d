#include "text/snake_case.hpp"

#include <algorithm>
#include <array>

#include "text/ascii.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

struct Transliteration {
  char32_t code_point;
  std::string_view text;
};

constexpr std::array transliterations = {
    Transliteration{0x00B0, "deg"}, Transliteration{0x00B2, "2"},  Transliteration{0x00B3, "3"},
    Transliteration{0x00B5, "u"},   Transliteration{0x00C4, "Ae"}, Transliteration{0x00D6, "Oe"},
    Transliteration{0x00DC, "Ue"},  Transliteration{0x00DF, "ss"}, Transliteration{0x00E0, "a"},
    Transliteration{0x00E1, "a"},   Transliteration{0x00E4, "ae"}, Transliteration{0x00E8, "e"},
    Transliteration{0x00E9, "e"},   Transliteration{0x00EA, "e"},  Transliteration{0x00F1, "n"},
    Transliteration{0x00F3, "o"},   Transliteration{0x00F6, "oe"}, Transliteration{0x00FC, "ue"},
    Transliteration{0x03A9, "ohm"}, Transliteration{0x03BC, "u"},  Transliteration{0x2126, "ohm"},
};

/// Keeps ASCII letters and digits, replaces code points that have a transliteration, and replaces others by a blank.
std::string to_ascii(std::string_view name) {
  if (is_ascii(name)) return std::string{name};
  std::string out;
  for_each_code_point(name, [&](char32_t code_point) {
    const auto at = std::ranges::find(transliterations, code_point, &Transliteration::code_point);
    if (code_point < 0x80) {
      out += static_cast<char>(code_point);
    } else {
      out += at == transliterations.end() ? " " : at->text;
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

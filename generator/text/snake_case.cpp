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

/// Words of mixed case that are one word of an identifier. Longer ones first. The letter case of a name may differ, but
/// it is mixed: `CIA` needs no row.
// clang-format off
constexpr std::string_view mixed_words[] = {
    "CANopen", "EtherCAT", "CiA", "WiFi",
    "mAh", "kWh", "kHz", "mHz", "kPa", "kBit", "kBaud",
};
// clang-format on

/// Whether a new word begins at `i` by its letter case: after a lower-case letter or digit, or where the last capital
/// of a run starts a word (`RxPDOMapping`: rx, pdo, mapping).
bool changes_case(std::string_view text, std::size_t i) {
  if (i == 0 || !is_upper(text[i])) return false;
  if (is_lower(text[i - 1])) return true;
  if (is_upper(text[i - 1]) && i + 1 < text.size() && is_lower(text[i + 1])) {
    return i + 2 < text.size() && is_lower(text[i + 2]);  // `COBs`, `PDOs`: a plural, not a new word
  }
  return false;
}

/// The end of a word of mixed case that begins at `begin`, where a word begins; `begin` if there is none.
std::size_t end_of_mixed_word(std::string_view text, std::size_t begin) {
  const auto ends = [&](std::size_t end) { return end == text.size() || !is_letter(text[end]); };
  // A unit with a prefix: `mV`, `dB`, `pH`.
  if (begin + 1 < text.size() && is_lower(text[begin]) && is_upper(text[begin + 1]) && ends(begin + 2)) {
    return begin + 2;
  }
  for (const std::string_view word : mixed_words) {
    const std::string_view part = text.substr(begin, word.size());
    const std::size_t end = begin + part.size();
    const bool is_mixed = std::ranges::any_of(part, is_lower) && std::ranges::any_of(part, is_upper);
    if (is_mixed && std::ranges::equal(part, word, {}, to_lower, to_lower) && (ends(end) || is_upper(text[end])))
      return end;
  }
  return begin;
}

}  // namespace

std::string to_snake_case(std::string_view name) {
  const std::string text = to_ascii(name);
  std::string out;
  out.reserve(text.size() + 4);
  std::size_t end_of_word = 0;  // of a word of mixed case
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_part = is_letter(text[i]) || is_digit(text[i]);
    const bool is_start = i == 0 || !is_letter(text[i - 1]);
    const bool is_after = i == end_of_word && i != 0 && is_letter(text[i]);
    const bool begins = i >= end_of_word && (is_after || changes_case(text, i));
    if ((!is_part || begins) && !out.empty() && out.back() != '_') out += '_';
    if (is_start || begins) end_of_word = std::max(end_of_word, end_of_mixed_word(text, i));
    if (is_part) out += to_lower(text[i]);
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (!out.empty() && is_digit(out.front())) out.insert(0, "n_");
  return out;
}

}  // namespace edsc

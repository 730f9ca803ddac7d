#include "text/code_page.hpp"

#include <cstddef>

#include "text/ascii.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

/// Bytes 80h..FFh.
constexpr std::u32string_view cp437 =
    U"ÇüéâäàåçêëèïîìÄÅ"
    U"ÉæÆôöòûùÿÖÜ¢£¥₧ƒ"
    U"áíóúñÑªº¿⌐¬½¼¡«»"
    U"░▒▓│┤╡╢╖╕╣║╗╝╜╛┐"
    U"└┴┬├─┼╞╟╚╔╩╦╠═╬╧"
    U"╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀"
    U"αßΓπΣσµτΦΘΩδ∞φε∩"
    U"≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u00A0";
static_assert(cp437.size() == 128);

/// Bytes 80h..9Fh; from A0h on it is Latin 1.
constexpr std::u32string_view cp1252 =
    U"€\uFFFD‚ƒ„…†‡ˆ‰Š‹Œ\uFFFDŽ\uFFFD"
    U"\uFFFD‘’“”•–—˜™š›œ\uFFFDžŸ";
static_assert(cp1252.size() == 32);

/// The kinds of the bytes 80h..FFh: `u` an umlaut or sharp s, `U` a capital umlaut, `l` another letter (or the
/// apostrophe of 1252, which occurs between letters), `s` a sign, `b` a box drawing character, `-` undefined.
constexpr std::string_view cp437_kinds =
    "lullulllllllllUl"
    "llslullllUUsssss"
    "llllllssssssssss"
    "bbbbbbbbbbbbbbbb"
    "bbbbbbbbbbbbbbbb"
    "bbbbbbbbbbbbbbbb"
    "sussssssssssssss"
    "ssssssssssssssss";
constexpr std::string_view cp1252_kinds =
    "s-sssssssslsl-l-"
    "-slssssssslsl-ll"
    "ssssssssssssssss"
    "ssssssssssssssss"
    "llllUlllllllllll"
    "llllllUsllllUllu"
    "llllulllllllllll"
    "llllllusllllulll";
static_assert(cp437_kinds.size() == 128 && cp1252_kinds.size() == 128);

/// The position of a byte among ASCII letters.
enum class Place : std::size_t { inside_word, begins_word, ends_word, alone };

/// How likely a kind is at a place. Only the order that the sums give for real texts matters.
struct Likelihood {
  char kind;
  int at[4];  // in the order of Place
};

constexpr Likelihood likelihoods[] = {
    {'u', {3, 2, 2, 0}},  {'U', {3, 2, 0, 0}},    {'l', {2, 0, 0, 0}},
    {'s', {-1, 1, 1, 1}}, {'b', {-3, -2, -2, 1}}, {'-', {-5, -5, -5, -5}},
};

int likelihood(char kind, Place place) {
  for (const Likelihood& row : likelihoods) {
    if (row.kind == kind) {
      return row.at[static_cast<std::size_t>(place)];
    }
  }
  return 0;
}

Place place_of(std::string_view bytes, std::size_t at) {
  const bool letter_before = at > 0 && is_letter(bytes[at - 1]);
  const bool letter_after = at + 1 < bytes.size() && is_letter(bytes[at + 1]);
  if (letter_before) {
    return letter_after ? Place::inside_word : Place::ends_word;
  }
  return letter_after ? Place::begins_word : Place::alone;
}

template <typename ToCodePoint>
std::string convert(std::string_view bytes, ToCodePoint to_code_point) {
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 16);
  for (const char c : bytes) {
    append_utf8(text, to_code_point(static_cast<unsigned char>(c)));
  }
  return text;
}

}  // namespace

bool looks_like_cp437(std::string_view bytes) {
  long long balance = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const auto byte = static_cast<unsigned char>(bytes[at]);
    if (byte < 0x80) {
      continue;
    }
    const Place place = place_of(bytes, at);
    balance += likelihood(cp437_kinds[byte - 0x80U], place) - likelihood(cp1252_kinds[byte - 0x80U], place);
  }
  return balance > 0;
}

std::string from_cp437(std::string_view bytes) {
  return convert(bytes, [](unsigned char byte) { return byte < 0x80 ? char32_t{byte} : cp437[byte - 0x80U]; });
}

std::string from_cp1252(std::string_view bytes) {
  return convert(bytes, [](unsigned char byte) {
    const bool is_latin1 = byte < 0x80 || byte >= 0xA0;
    return is_latin1 ? char32_t{byte} : cp1252[byte - 0x80U];
  });
}

}  // namespace edsc

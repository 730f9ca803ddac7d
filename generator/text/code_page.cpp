#include "text/code_page.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "text/ascii.hpp"
#include "text/code_page_tables.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

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

constexpr std::size_t max_sequence = 4;

/// A character at the start of bytes; `length` is 0 if it is undefined.
struct DecodedCharacter {
  char32_t code_point = replacement_character;
  std::size_t length = 0;
};

const CodePageTable* table_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::cp1252: return &cp1252_table;
    case Encoding::cp437: return &cp437_table;
    case Encoding::cp850: return &cp850_table;
    case Encoding::cp1250: return &cp1250_table;
    case Encoding::cp1251: return &cp1251_table;
    case Encoding::shift_jis: return &shift_jis_table;
    case Encoding::gb18030: return &gb18030_table;
    case Encoding::big5: return &big5_table;
    case Encoding::cp949: return &cp949_table;
    case Encoding::ascii:
    case Encoding::utf8:
    case Encoding::utf16_le:
    case Encoding::utf16_be:
    case Encoding::unknown: break;
  }
  return nullptr;
}

constexpr unsigned first_lead_byte = 0x80;
constexpr unsigned first_trail_byte = 0x40;
constexpr unsigned trail_bytes = 0xFF - first_trail_byte;

DecodedCharacter decode_pair(const CodePageTable& table, unsigned lead, unsigned trail) {
  if (table.pairs.empty() || lead == 0xFF || trail < first_trail_byte || trail == 0xFF) return {};
  const char32_t code_point = table.pairs[(lead - first_lead_byte) * trail_bytes + trail - first_trail_byte];
  if (code_point != replacement_character) return {code_point, 2};
  const auto wide = std::ranges::find(table.wide, lead << 8U | trail, &WideCharacter::code);
  return wide != table.wide.end() ? DecodedCharacter{wide->code_point, 2} : DecodedCharacter{};
}

/// Four bytes of GB18030.
DecodedCharacter decode_four_bytes(std::string_view bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < max_sequence; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    const unsigned first = i % 2 == 0 ? 0x81 : 0x30;
    const unsigned count = i % 2 == 0 ? 126 : 10;
    if (byte < first || byte >= first + count) return {};
    number = number * count + (byte - first);
  }
  const auto after = std::ranges::upper_bound(gb18030_four_bytes, number, {}, &FourByteRun::first);
  if (after == gb18030_four_bytes.begin()) return {};
  const FourByteRun& run = *std::prev(after);
  return number - run.first < run.length ? DecodedCharacter{run.code_point + (number - run.first), max_sequence}
                                         : DecodedCharacter{};
}

/// The character that `bytes`, which are not empty, begin with.
DecodedCharacter decode_character(std::string_view bytes, Encoding encoding, const CodePageTable* table) {
  const auto byte = static_cast<unsigned char>(bytes[0]);
  if (byte < 0x80) return {byte, 1};
  if (encoding == Encoding::utf8) {
    const std::size_t length = utf8_sequence_length(bytes);
    return length == 0 ? DecodedCharacter{} : DecodedCharacter{code_point_of(bytes.substr(0, length)), length};
  }
  if (table == nullptr) return {};
  const char32_t single = table->singles[byte - 0x80U];
  if (single != replacement_character) return {single, 1};
  if (bytes.size() >= 2) {
    const DecodedCharacter pair = decode_pair(*table, byte, static_cast<unsigned char>(bytes[1]));
    if (pair.length != 0) return pair;
  }
  return encoding == Encoding::gb18030 && bytes.size() >= max_sequence ? decode_four_bytes(bytes) : DecodedCharacter{};
}

DecodedText decode_utf16(std::string_view bytes, ByteOrder order) {
  DecodedText decoded{from_utf16_bytes(bytes, order)};
  const std::size_t at = decoded.text.find("\uFFFD");
  if (at != std::string::npos) {
    decoded.undefined_text = at;
    decoded.undefined = 2 * to_utf16(std::string_view{decoded.text}.substr(0, at)).size();
  }
  return decoded;
}

constexpr Encoding encodings_of_several_bytes[] = {Encoding::shift_jis, Encoding::gb18030, Encoding::big5,
                                                   Encoding::cp949};

/// Whether a character of several bytes is none of one byte before an ASCII letter: `\xE9t` of a French word.
bool is_of_several_bytes(std::string_view bytes, std::size_t length, Encoding encoding) {
  if (length < 2) return false;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  return byte(1) >= 0x80 || (encoding == Encoding::shift_jis && byte(0) < 0xA0);
}

/// Whether the text is defined and has two characters of several bytes one after the other, as words of these languages
/// have. In words of western languages this is rare.
bool has_words_of_several_bytes(std::string_view bytes, Encoding encoding) {
  const CodePageTable* const table = table_of(encoding);
  bool after_such_character = false;
  bool found = false;
  while (!bytes.empty()) {
    const DecodedCharacter one = decode_character(bytes, encoding, table);
    if (one.length == 0) return false;
    const bool is_such_character = is_of_several_bytes(bytes, one.length, encoding);
    found = found || (after_such_character && is_such_character);
    after_such_character = is_such_character;
    bytes.remove_prefix(one.length);
  }
  return found;
}

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

}  // namespace

DecodedText decode_text(std::string_view bytes, Encoding encoding) {
  if (encoding == Encoding::utf16_le) return decode_utf16(bytes, ByteOrder::low_first);
  if (encoding == Encoding::utf16_be) return decode_utf16(bytes, ByteOrder::high_first);
  const CodePageTable* const table = table_of(encoding);
  DecodedText decoded;
  decoded.text.reserve(bytes.size() + bytes.size() / 16);
  for (std::size_t at = 0; at < bytes.size();) {
    const DecodedCharacter one = decode_character(bytes.substr(at), encoding, table);
    if (one.length == 0 && decoded.is_valid()) {
      decoded.undefined = at;
      decoded.undefined_text = decoded.text.size();
    }
    append_utf8(decoded.text, one.code_point);
    at += std::max<std::size_t>(one.length, 1);
  }
  return decoded;
}

Encoding detect_code_page(std::string_view bytes) {
  for (const Encoding one : encodings_of_several_bytes) {
    if (has_words_of_several_bytes(bytes, one)) return Encoding::unknown;
  }
  if (looks_like_cp437(bytes)) return Encoding::cp437;
  return decode_text(bytes, Encoding::cp1252).is_valid() ? Encoding::cp1252 : Encoding::unknown;
}

std::vector<Encoding> possible_encodings(std::string_view bytes) {
  std::vector<Encoding> possible;
  for (const Encoding one : encodings_of_several_bytes) {
    if (has_words_of_several_bytes(bytes, one)) possible.push_back(one);
  }
  if (!possible.empty()) return possible;
  constexpr Encoding of_one_byte[] = {Encoding::cp1252, Encoding::cp437, Encoding::cp1250, Encoding::cp1251};
  std::ranges::copy_if(of_one_byte, std::back_inserter(possible),
                       [&](Encoding one) { return decode_text(bytes, one).is_valid(); });
  return possible;
}

}  // namespace edsc

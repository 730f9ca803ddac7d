#include "text/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace edsc {
namespace {

/// The Unicode Standard, table 3-7: well-formed byte sequences. Bytes after the second are 80h..BFh.
struct LeadBytes {
  unsigned char first, last;
  unsigned char length;
  unsigned char second_first, second_last;
};

constexpr std::array<LeadBytes, 8> lead_bytes{{
    {0xC2, 0xDF, 2, 0x80, 0xBF},
    {0xE0, 0xE0, 3, 0xA0, 0xBF},
    {0xE1, 0xEC, 3, 0x80, 0xBF},
    {0xED, 0xED, 3, 0x80, 0x9F},
    {0xEE, 0xEF, 3, 0x80, 0xBF},
    {0xF0, 0xF0, 4, 0x90, 0xBF},
    {0xF1, 0xF3, 4, 0x80, 0xBF},
    {0xF4, 0xF4, 4, 0x80, 0x8F},
}};

/// The number of leading ASCII bytes in `text`, in steps of eight.
std::size_t skip_ascii_words(std::string_view text) {
  std::size_t at = 0;
  std::uint64_t word = 0;
  while (text.size() - at >= sizeof(word)) {
    std::memcpy(&word, text.data() + at, sizeof(word));
    if ((word & 0x8080808080808080U) != 0) {
      break;
    }
    at += sizeof(word);
  }
  return at;
}

}  // namespace

std::size_t utf8_sequence_length(std::string_view text) {
  if (text.empty()) {
    return 0;
  }
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  if (byte(0) < 0x80) {
    return 1;
  }
  for (const LeadBytes& lead : lead_bytes) {
    if (byte(0) < lead.first || byte(0) > lead.last) {
      continue;
    }
    if (text.size() < lead.length || byte(1) < lead.second_first || byte(1) > lead.second_last) {
      return 0;
    }
    const std::string_view rest = text.substr(2, std::size_t{lead.length} - 2);
    return std::all_of(rest.begin(), rest.end(), is_utf8_continuation) ? lead.length : 0;
  }
  return 0;
}

bool is_ascii(std::string_view text) {
  text.remove_prefix(skip_ascii_words(text));
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    text.remove_prefix(skip_ascii_words(text));
    if (text.empty()) {
      break;
    }
    const std::size_t length = utf8_sequence_length(text);
    if (length == 0) {
      return false;
    }
    text.remove_prefix(length);
  }
  return true;
}

char32_t code_point_of(std::string_view sequence) {
  constexpr char32_t lead_masks[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t code_point = static_cast<unsigned char>(sequence[0]) & lead_masks[sequence.size()];
  for (const char c : sequence.substr(1)) code_point = (code_point << 6U) | (static_cast<unsigned char>(c) & 0x3FU);
  return code_point;
}

void append_utf8(std::string& text, char32_t code_point) {
  if (code_point < 0x80) {
    text += static_cast<char>(code_point);
    return;
  }
  const unsigned more = code_point < 0x800 ? 1 : code_point < 0x10000 ? 2 : 3;  // bytes after the first
  constexpr char32_t lead_bits[] = {0, 0xC0, 0xE0, 0xF0};
  text += static_cast<char>(lead_bits[more] | (code_point >> (6 * more)));
  for (unsigned i = more; i-- > 0;) text += static_cast<char>(0x80U | ((code_point >> (6 * i)) & 0x3FU));
}

std::u16string to_utf16(std::string_view text) {
  std::u16string out;
  for_each_code_point(text, [&](char32_t code_point) {
    if (code_point >= 0x10000) {
      out += static_cast<char16_t>(0xD800 + ((code_point - 0x10000) >> 10U));
      out += static_cast<char16_t>(0xDC00 + ((code_point - 0x10000) & 0x3FFU));
    } else {
      out += static_cast<char16_t>(code_point);
    }
  });
  return out;
}

std::string to_utf16_bytes(std::string_view text) {
  std::string bytes;
  for (const char16_t unit : to_utf16(text)) {
    bytes += static_cast<char>(unit & 0xFF);
    bytes += static_cast<char>(unit >> 8);
  }
  return bytes;
}

std::string from_utf16_bytes(std::string_view bytes, ByteOrder order) {
  const std::size_t high = order == ByteOrder::high_first ? 0 : 1;  // position of the high byte in a pair
  const auto byte = [&](std::size_t at) { return static_cast<char32_t>(static_cast<unsigned char>(bytes[at])); };
  const auto unit = [&](std::size_t at) {
    return at + 1 < bytes.size() ? byte(at + high) << 8U | byte(at + 1 - high) : char32_t{0};
  };
  std::string text;
  text.reserve(bytes.size() / 2 + bytes.size() / 16);
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t code_point = unit(at);
    if ((code_point & 0xFC00) == 0xD800 && (unit(at + 2) & 0xFC00) == 0xDC00) {
      code_point = 0x10000 + ((code_point & 0x3FF) << 10U) + (unit(at + 2) & 0x3FF);
      at += 2;
    } else if ((code_point & 0xF800) == 0xD800) {
      code_point = replacement_character;
    }
    append_utf8(text, code_point);
  }
  if (bytes.size() % 2 != 0) append_utf8(text, replacement_character);
  return text;
}

std::size_t count_code_points(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_utf8_continuation(c); }));
}

}  // namespace edsc

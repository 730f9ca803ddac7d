#include "values/value_text.hpp"

#include <fmt/chrono.h>
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "eds/ini.hpp"
#include "text/ascii.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "text/utf8.hpp"
#include "values/append.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t milliseconds_per_day = 24 * 60 * 60 * 1000;
constexpr std::uint32_t time_mask = 0x0FFF'FFFF;  ///< 28 bits of milliseconds, 4 are reserved
constexpr std::size_t max_shown_bytes = 32;       ///< of a DOMAIN
constexpr std::chrono::sys_days time_epoch = std::chrono::year{1984} / 1 / 1;

std::uint64_t mask_of(unsigned bits) { return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1; }

std::int64_t sign_extended(std::uint64_t number, unsigned bits) {
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>(number << unused) >> unused;
}

std::uint64_t number_of(Bytes bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8 | bytes[i];
  return number;
}

std::vector<std::uint8_t> bytes_of(std::uint64_t number, unsigned bits) {
  std::vector<std::uint8_t> bytes;
  for (unsigned at = 0; at < bits; at += 8) bytes.push_back(static_cast<std::uint8_t>(number >> at));
  return bytes;
}

// Bytes to text

void append_clock(std::string& text, std::uint32_t milliseconds) {
  const std::uint32_t seconds = milliseconds / 1000;
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:02}:{:02}:{:02}.{:03}"), seconds / 3600, seconds / 60 % 60,
                 seconds % 60, milliseconds % 1000);
}

void append_hex_bytes(std::string& text, Bytes bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i > 0) text += ' ';
    append_hex_byte(text, bytes[i]);
  }
}

/// UTF-16, low byte first; half a surrogate pair and a last odd byte become U+FFFD.
std::string utf8_of(Bytes bytes) {
  std::string text;
  const auto unit = [&](std::size_t at) { return static_cast<char32_t>(bytes[at] | bytes[at + 1] << 8); };
  std::size_t at = 0;
  while (at + 1 < bytes.size()) {
    char32_t c = unit(at);
    at += 2;
    const bool high = c >= 0xD800 && c < 0xDC00;
    if (high && at + 1 < bytes.size() && unit(at) >= 0xDC00 && unit(at) < 0xE000) {
      c = 0x10000 + ((c - 0xD800) << 10) + (unit(at) - 0xDC00);
      at += 2;
    } else if (c >= 0xD800 && c < 0xE000) {
      c = replacement_character;
    }
    append_utf8(text, c);
  }
  if (at < bytes.size()) append_utf8(text, replacement_character);
  return text;
}

std::string_view without_trailing_zeros(std::string_view text) {
  while (text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

void append_string(std::string& text, DataType type, Bytes bytes) {
  if (type == DataType::octet_string) return append_hex_bytes(text, bytes);
  if (type == DataType::unicode_string) return append_quoted(text, without_trailing_zeros(utf8_of(bytes)));
  append_quoted(text, without_trailing_zeros({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

void append_domain(std::string& text, Bytes bytes) {
  append_hex_bytes(text, bytes.first(std::min(bytes.size(), max_shown_bytes)));
  if (bytes.size() > max_shown_bytes) text += " ...";
}

void append_unit(std::string& text, std::string_view unit) {
  if (unit.empty()) return;
  text += ' ';
  text += unit;
}

// Text to bytes

ParsedValue problem(std::string sentence) { return {{}, std::move(sentence)}; }

/// A number without its sign.
struct Magnitude {
  std::uint64_t number = 0;
  bool by_bits = false;  ///< 0x1F, 1Fh, 0b101
};

std::optional<Magnitude> parse_magnitude(std::string_view text) {
  Magnitude result;
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
  } else if (text.starts_with("0b") && !text.ends_with('h')) {
    base = 2;
    text.remove_prefix(2);
  } else if (text.ends_with('h') || text.ends_with('H')) {
    base = 16;
    text.remove_suffix(1);
  }
  result.by_bits = base != 10;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, result.number, base);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return result;
}

std::string range_of(const DataTypeRow& type) {
  if (type.kind == DataClass::signed_integer) {
    return fmt::format("{}..{}", sign_extended(std::uint64_t{1} << (type.bits - 1), type.bits),
                       mask_of(type.bits - 1U));
  }
  return fmt::format("0..{}", mask_of(type.bits));
}

ParsedValue parse_integer(const DataTypeRow& type, std::string_view text) {
  const std::string_view whole = text;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text = trim_left(text.substr(1));
  if (const std::size_t remark = text.find(" ("); remark != std::string_view::npos && text.ends_with(')')) {
    text = text.substr(0, remark);  // 567 (0237h)
  }
  const auto magnitude = parse_magnitude(text);
  if (!magnitude) {
    const bool digits = !text.empty() && std::ranges::all_of(text, is_digit);
    if (!digits) return problem(fmt::format("\"{}\" is not a number (such as 10, -10, 0x0A or 0Ah)", whole));
  }
  const bool is_signed = type.kind == DataClass::signed_integer;
  const std::uint64_t highest =
      mask_of(is_signed && !(magnitude && magnitude->by_bits && !negative) ? type.bits - 1U : type.bits);
  const std::uint64_t lowest = is_signed ? std::uint64_t{1} << (type.bits - 1) : 0;
  if (!magnitude || magnitude->number > (negative ? lowest : highest)) {
    return problem(fmt::format("{} does not fit into {} ({})", whole, type.name, range_of(type)));
  }
  return {bytes_of(negative ? ~magnitude->number + 1 : magnitude->number, type.bits), ""};
}

ParsedValue parse_boolean(std::string_view text) {
  if (text == "1" || equal_ignoring_case(text, "true")) return {{1}, ""};
  if (text == "0" || equal_ignoring_case(text, "false")) return {{0}, ""};
  return problem(fmt::format("\"{}\" is not a BOOLEAN; expected true, false, 1 or 0", text));
}

ParsedValue parse_real(const DataTypeRow& type, std::string_view text) {
  const std::string_view whole = text;
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  const bool out_of_range = parsed.ec == std::errc::result_out_of_range;
  if ((parsed.ec != std::errc{} && !out_of_range) || parsed.ptr != end) {
    return problem(fmt::format("\"{}\" is not a number (such as 2.5 or -1e3)", whole));
  }
  const bool too_high = type.bits == 32 && std::isfinite(number) && std::isinf(static_cast<float>(number));
  if (out_of_range || too_high) return problem(fmt::format("{} does not fit into {}", whole, type.name));
  if (type.bits == 64) return {bytes_of(std::bit_cast<std::uint64_t>(number), 64), ""};
  return {bytes_of(std::bit_cast<std::uint32_t>(static_cast<float>(number)), 32), ""};
}

/// A number, followed by a separator.
bool take_number(std::string_view& text, std::string_view separator, std::uint32_t& number) {
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (parsed.ec != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()));
  if (!text.starts_with(separator)) return false;
  text.remove_prefix(separator.size());
  return true;
}

/// `12:34:56` or `12:34:56.789`; nothing for more than a day.
std::optional<std::uint32_t> parse_clock(std::string_view text) {
  std::uint32_t hours = 0, minutes = 0, seconds = 0, milliseconds = 0;
  if (!take_number(text, ":", hours) || !take_number(text, ":", minutes) || !take_number(text, "", seconds)) return {};
  if (hours > 23 || minutes > 59 || seconds > 59) return std::nullopt;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    if (text.empty() || text.size() > 3) return std::nullopt;
    const std::size_t digits = text.size();
    if (!take_number(text, "", milliseconds)) return std::nullopt;
    for (std::size_t i = digits; i < 3; ++i) milliseconds *= 10;
  }
  if (!text.empty()) return std::nullopt;
  return (hours * 3600 + minutes * 60 + seconds) * 1000 + milliseconds;
}

std::optional<std::uint32_t> parse_date(std::string_view text) {
  std::uint32_t year = 0, month = 0, day = 0;
  if (!take_number(text, "-", year) || !take_number(text, "-", month) || !take_number(text, "", day)) return {};
  if (!text.empty() || year > 9999) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(year)}, std::chrono::month{month},
                                         std::chrono::day{day}};
  if (!date.ok()) return std::nullopt;
  const auto days = (std::chrono::sys_days{date} - time_epoch).count();
  if (days < 0 || days > 0xFFFF) return std::nullopt;
  return static_cast<std::uint32_t>(days);
}

ParsedValue parse_time(const DataTypeRow& type, std::string_view text) {
  const bool of_day = type.type == DataType::time_of_day;
  std::optional<std::uint32_t> days = 0;
  std::string_view clock = text;
  if (of_day) {
    const std::size_t blank = text.find_first_of(" T");
    days = parse_date(text.substr(0, blank));
    clock = blank == std::string_view::npos ? "00:00:00" : trim(text.substr(blank + 1));
  } else if (const std::size_t unit = text.find(" d"); unit != std::string_view::npos) {
    std::string_view number = text.substr(0, unit);
    std::uint32_t count = 0;
    days = take_number(number, "", count) && number.empty() && count <= 0xFFFF ? std::optional{count} : std::nullopt;
    clock = trim(text.substr(unit + 2));
    if (clock.empty()) clock = "00:00:00";
  }
  const auto milliseconds = parse_clock(clock);
  if (!days || !milliseconds) {
    return problem(fmt::format("\"{}\" is not a {} (such as {})", text, type.name,
                               of_day ? "2024-01-31 12:34:56.789, from 1984-01-01 to 2163-06-06" : "3 d 12:34:56.789"));
  }
  return {bytes_of(std::uint64_t{*days} << 32 | *milliseconds, 48), ""};
}

int hex_digit_value(char c) { return is_digit(c) ? c - '0' : is_hex_digit(c) ? to_lower(c) - 'a' + 10 : -1; }

ParsedValue parse_hex_bytes(const DataTypeRow& type, std::string_view text) {
  ParsedValue result;
  int high = -1;
  for (const char c : text.starts_with("0x") ? text.substr(2) : text) {
    if (is_blank(c) && high < 0) continue;
    const int digit = hex_digit_value(c);
    if (digit < 0)
      return problem(fmt::format("\"{}\" is not a valid {}; expected pairs of hexadecimal digits", text, type.name));
    if (high >= 0) result.bytes.push_back(static_cast<std::uint8_t>(high << 4 | digit));
    high = high < 0 ? digit : -1;
  }
  if (high >= 0) return problem(fmt::format("\"{}\" has an odd number of hexadecimal digits", text));
  return result;
}

/// The text between quotation marks with its escapes resolved.
std::string unquoted(std::string_view text) {
  if (text.size() < 2 || !text.starts_with('"') || !text.ends_with('"')) return std::string{text};
  text = text.substr(1, text.size() - 2);
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\\' || at + 1 >= text.size()) {
      out += text[at];
      continue;
    }
    const bool by_code =
        text[at + 1] == 'x' && at + 3 < text.size() && is_hex_digit(text[at + 2]) && is_hex_digit(text[at + 3]);
    out +=
        by_code ? static_cast<char>(hex_digit_value(text[at + 2]) << 4 | hex_digit_value(text[at + 3])) : text[at + 1];
    at += by_code ? 3 : 1;
  }
  return out;
}

ParsedValue parse_string(const DataTypeRow& type, std::string_view text) {
  if (type.type == DataType::octet_string) return parse_hex_bytes(type, trim(text));
  const std::string plain = unquoted(text);
  ParsedValue result;
  if (type.type == DataType::visible_string) {
    result.bytes.assign(plain.begin(), plain.end());
    return result;
  }
  if (!is_utf8(plain)) return problem("a UNICODE_STRING must be given in UTF-8");
  for (const char16_t unit : to_utf16(plain)) {
    result.bytes.push_back(static_cast<std::uint8_t>(unit & 0xFF));
    result.bytes.push_back(static_cast<std::uint8_t>(unit >> 8));
  }
  return result;
}

// Limits

/// A limit as text; with an unknown node-ID, as a formula.
std::string limit_text(const Value& limit, const DataTypeRow& type) {
  if (limit.plus_node_id) return fmt::format("$NODEID+0x{:X}", limit.bits);
  if (type.kind == DataClass::signed_integer) return fmt::format("{}", static_cast<std::int64_t>(limit.bits));
  std::string text;
  if (type.kind == DataClass::real || type.kind == DataClass::time) {
    append_number(text, type, limit.bits, type.bits);
  } else {
    append_decimal(text, limit.bits);
  }
  return text;
}

bool less(std::uint64_t a, std::uint64_t b, const DataTypeRow& type) {
  if (type.kind == DataClass::signed_integer) return sign_extended(a, type.bits) < sign_extended(b, type.bits);
  if (type.kind != DataClass::real) return a < b;
  if (type.bits == 64) return std::bit_cast<double>(a) < std::bit_cast<double>(b);
  const auto single = [](std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits)); };
  return single(a) < single(b);
}

/// Why a value is rejected; empty if it is valid. A limit with an unknown node-ID is not checked.
std::string limit_problem(const Entry& entry, std::uint64_t number, std::string_view text) {
  const auto beyond = [&](const std::optional<Value>& limit, bool high) {
    if (!limit || limit->plus_node_id) return false;
    return high ? less(limit->bits, number, *entry.type) : less(number, limit->bits, *entry.type);
  };
  for (const bool high : {false, true}) {
    const auto& limit = high ? entry.high_limit : entry.low_limit;
    if (!beyond(limit, high)) continue;
    return fmt::format("{} is {} the {} limit of {} \"{}\", {}", text, high ? "above" : "below", high ? "high" : "low",
                       entry_label(entry.index, entry.sub_index), entry.name, limit_text(*limit, *entry.type));
  }
  return "";
}

}  // namespace

void append_time_of_day(std::string& text, std::uint32_t days, std::uint32_t milliseconds) {
  const std::chrono::year_month_day date{time_epoch + std::chrono::days{days}};
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:04}-{:02}-{:02} "), static_cast<int>(date.year()),
                 static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  append_clock(text, milliseconds);
}

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (std::size_t at = 0; at < text.size();) {
    const auto c = static_cast<unsigned char>(text[at]);
    const auto [length, is_visible] = first_sequence(text.substr(at));
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (is_visible) {
      out += text.substr(at, length);
    } else {
      for (const char byte : text.substr(at, length)) {
        out += "\\x";
        append_hex_byte(out, static_cast<std::uint8_t>(byte));
      }
    }
    at += length;
  }
  out += '"';
}

void append_number(std::string& text, const DataTypeRow& type, std::uint64_t number, unsigned bits,
                   std::string_view unit) {
  number &= mask_of(bits);
  switch (type.kind) {
    case DataClass::boolean:
      text += number != 0 ? "true" : "false";
      if (number > 1) {
        text += " (";
        append_decimal(text, number);
        text += ')';
      }
      return;
    case DataClass::signed_integer:
      append_signed_decimal(text, bits == 0 ? 0 : sign_extended(number, bits));
      return append_unit(text, unit);
    case DataClass::unsigned_integer:
      append_decimal(text, number);
      if (!unit.empty()) return append_unit(text, unit);
      if (number >= 10) {
        text += " (";
        append_hex(text, number, (bits + 3) / 4);
        text += "h)";
      }
      return;
    case DataClass::real:
      if (bits == 32) {
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"),
                       std::bit_cast<float>(static_cast<std::uint32_t>(number)));
      } else if (bits == 64) {
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), std::bit_cast<double>(number));
      } else {
        break;
      }
      return append_unit(text, unit);
    case DataClass::time: {
      const auto days = static_cast<std::uint32_t>(number >> 32);
      const std::uint32_t milliseconds = static_cast<std::uint32_t>(number) & time_mask;
      if (type.type == DataType::time_of_day) return append_time_of_day(text, days, milliseconds);
      append_decimal(text, days + milliseconds / milliseconds_per_day);
      text += " d ";
      return append_clock(text, milliseconds % milliseconds_per_day);
    }
    case DataClass::string:
    case DataClass::domain: break;
  }
  append_hex(text, number, (bits + 3) / 4);
  text += 'h';
}

void append_value(std::string& text, const DataTypeRow& type, std::span<const std::uint8_t> bytes,
                  std::string_view unit) {
  if (type.kind == DataClass::string) return append_string(text, type.type, bytes);
  if (type.kind == DataClass::domain) return append_domain(text, bytes);
  if (bytes.empty()) {
    text += "nothing";
  } else if (bytes.size() > sizeof(std::uint64_t)) {
    append_domain(text, bytes);
  } else {
    append_number(text, type, number_of(bytes), static_cast<unsigned>(bytes.size()) * 8, unit);
  }
  const std::size_t expected = (type.bits + 7U) / 8U;
  if (bytes.size() == expected) return;
  fmt::format_to(std::back_inserter(text), " ({}, {} has {})", counted(bytes.size(), "byte"), type.name, expected);
}

std::string value_text(const DataTypeRow& type, std::span<const std::uint8_t> bytes) {
  std::string text;
  append_value(text, type, bytes);
  return text;
}

void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes) {
  constexpr std::uint16_t cycle_period = 0x1006, window_length = 0x1007;  // in us
  const bool communication =
      entry.index >= 0x1000 && entry.index < 0x2000 && entry.index != cycle_period && entry.index != window_length;
  if (!communication || entry.type->type != DataType::unsigned32 || bytes.size() != sizeof(std::uint32_t)) {
    return append_value(text, *entry.type, bytes, entry.unit);
  }
  append_hex(text, number_of(bytes), 8);
  text += 'h';
}

std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes) {
  std::string text;
  append_value(text, entry, bytes);
  return text;
}

std::string limits_text(const Entry& entry) {
  if (!entry.low_limit && !entry.high_limit) return "";
  std::string text;
  if (entry.low_limit) text += limit_text(*entry.low_limit, *entry.type);
  text += "..";
  if (entry.high_limit) text += limit_text(*entry.high_limit, *entry.type);
  append_unit(text, entry.unit);
  return text;
}

ParsedValue parse_value_text(const DataTypeRow& type, std::string_view text) {
  switch (type.kind) {
    case DataClass::boolean: return parse_boolean(trim(text));
    case DataClass::unsigned_integer:
    case DataClass::signed_integer: return parse_integer(type, trim(text));
    case DataClass::real: return parse_real(type, trim(text));
    case DataClass::string: return parse_string(type, text);
    case DataClass::time: return parse_time(type, trim(text));
    case DataClass::domain: return parse_hex_bytes(type, trim(text));
  }
  return problem("a value of unknown data type");
}

ParsedValue parse_value_text(const Entry& entry, std::string_view text) {
  const DataTypeRow& type = *entry.type;
  const bool number = type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer ||
                      type.kind == DataClass::real;
  if (!number) return parse_value_text(type, text);
  text = trim(text);
  const std::string_view unit = entry.unit;
  if (!unit.empty() && text.size() > unit.size() && text.ends_with(unit) &&
      text[text.size() - unit.size() - 1] == ' ') {
    text = trim_right(text.substr(0, text.size() - unit.size()));
  }
  ParsedValue result = parse_value_text(type, text);
  if (result.ok()) result.problem = limit_problem(entry, number_of(result.bytes), text);
  if (!result.ok()) result.bytes.clear();
  return result;
}

}  // namespace edsc

#include "values/parse_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "eds/ini.hpp"
#include "text/ascii.hpp"
#include "text/number_text.hpp"
#include "text/utf8.hpp"
#include "values/little_endian.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

ParsedValue problem(std::string sentence) { return {{}, std::move(sentence)}; }

ParsedValue value_of(std::uint64_t number, const DataTypeRow& type) {
  return {bytes_of(number, bytes_for(type.bits)), ""};
}

std::string range_of(const DataTypeRow& type) {
  if (type.kind == DataClass::signed_integer) {
    return fmt::format("{}..{}", sign_extended(std::uint64_t{1} << (type.bits - 1), type.bits),
                       low_bits(type.bits - 1U));
  }
  return fmt::format("0..{}", low_bits(type.bits));
}

ParsedValue parse_integer(const DataTypeRow& type, std::string_view text) {
  const std::string_view whole = text;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text = trim_left(text.substr(1));
  if (const std::size_t remark = text.find(" ("); remark != std::string_view::npos && text.ends_with(')')) {
    text = text.substr(0, remark);  // 567 (0237h)
  }
  const bool binary = text.starts_with("0b") && !text.ends_with('h');
  const Digits digits = binary ? Digits{text.substr(2), 2} : digits_of(text);
  const auto magnitude = parse_whole<std::uint64_t>(digits.text, digits.base);
  if (!magnitude) {
    const bool is_number = !text.empty() && std::ranges::all_of(text, is_digit);
    if (!is_number) return problem(fmt::format("\"{}\" is not a number (such as 10, -10, 0x0A or 0Ah)", whole));
  }
  const bool is_signed = type.kind == DataClass::signed_integer;
  const bool by_bits = digits.base != 10 && !negative;
  const std::uint64_t highest = low_bits(is_signed && !by_bits ? type.bits - 1U : type.bits);
  const std::uint64_t lowest = is_signed ? std::uint64_t{1} << (type.bits - 1) : 0;
  if (!magnitude || *magnitude > (negative ? lowest : highest)) {
    return problem(fmt::format("{} does not fit into {} ({})", whole, type.name, range_of(type)));
  }
  return value_of(negative ? ~*magnitude + 1 : *magnitude, type);
}

ParsedValue parse_boolean(std::string_view text) {
  if (text == "1" || equal_ignoring_case(text, "true")) return {{1}, ""};
  if (text == "0" || equal_ignoring_case(text, "false")) return {{0}, ""};
  return problem(fmt::format("\"{}\" is not a BOOLEAN; expected true, false, 1 or 0", text));
}

ParsedValue parse_float(const DataTypeRow& type, std::string_view text) {
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
  if (type.bits == 64) return value_of(std::bit_cast<std::uint64_t>(number), type);
  return value_of(std::bit_cast<std::uint32_t>(static_cast<float>(number)), type);
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
  return text.empty() ? days_of_date(year, month, day) : std::nullopt;
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
    days = parse_whole<std::uint32_t>(text.substr(0, unit));
    clock = trim(text.substr(unit + 2));
    if (clock.empty()) clock = "00:00:00";
  }
  const auto milliseconds = parse_clock(clock);
  if (!days || *days > 0xFFFF || !milliseconds) {
    return problem(fmt::format("\"{}\" is not a {} (such as {})", text, type.name,
                               of_day ? "2024-01-31 12:34:56.789, from 1984-01-01 to 2163-06-06" : "3 d 12:34:56.789"));
  }
  return value_of(std::uint64_t{*days} << 32 | *milliseconds, type);
}

/// The value of a hexadecimal digit; nothing for any other character.
std::optional<unsigned> hex_value(char c) { return parse_whole<unsigned>({&c, 1}, 16); }

ParsedValue parse_hex_bytes(const DataTypeRow& type, std::string_view text) {
  ParsedValue result;
  std::optional<unsigned> high;
  for (const char c : text.starts_with("0x") ? text.substr(2) : text) {
    if (is_blank(c) && !high) continue;
    const auto digit = hex_value(c);
    if (!digit) {
      return problem(fmt::format("\"{}\" is not a valid {}; expected pairs of hexadecimal digits", text, type.name));
    }
    if (high) result.bytes.push_back(static_cast<std::uint8_t>(*high << 4 | *digit));
    high = high ? std::nullopt : digit;
  }
  if (high) return problem(fmt::format("\"{}\" has an odd number of hexadecimal digits", text));
  return result;
}

/// The text between quotation marks with its escapes resolved.
std::string unquoted(std::string_view text) {
  if (text.size() < 2 || !text.starts_with('"') || !text.ends_with('"')) return std::string{text};
  text = text.substr(1, text.size() - 2);
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\\' || at + 1 == text.size()) {
      out += text[at];
      continue;
    }
    const std::string_view code = text.substr(at + 1, 3);
    const auto byte = code.size() == 3 && code[0] == 'x' ? parse_whole<std::uint8_t>(code.substr(1), 16) : std::nullopt;
    out += byte ? static_cast<char>(*byte) : code[0];
    at += byte ? 3 : 1;
  }
  return out;
}

ParsedValue parse_string(const DataTypeRow& type, std::string_view text) {
  if (type.type == DataType::octet_string) return parse_hex_bytes(type, trim(text));
  const std::string plain = unquoted(text);
  if (type.type == DataType::visible_string) return {{plain.begin(), plain.end()}, ""};
  if (!is_utf8(plain)) return problem("a UNICODE_STRING must be given in UTF-8");
  const std::string units = to_utf16_bytes(plain);
  return {{units.begin(), units.end()}, ""};
}

}  // namespace

std::optional<std::uint32_t> days_of_date(unsigned year, unsigned month, unsigned day) {
  if (year > 9999) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(year)}, std::chrono::month{month},
                                         std::chrono::day{day}};
  if (!date.ok()) return std::nullopt;
  const auto days = (std::chrono::sys_days{date} - time_epoch).count();
  return days >= 0 ? std::optional{static_cast<std::uint32_t>(days)} : std::nullopt;
}

ParsedValue parse_value_text(const DataTypeRow& type, std::string_view text) {
  switch (type.kind) {
    case DataClass::boolean: return parse_boolean(trim(text));
    case DataClass::unsigned_integer:
    case DataClass::signed_integer: return parse_integer(type, trim(text));
    case DataClass::real: return parse_float(type, trim(text));
    case DataClass::string: return parse_string(type, text);
    case DataClass::time: return parse_time(type, trim(text));
    case DataClass::domain: return parse_hex_bytes(type, trim(text));
  }
  return problem("a value of unknown data type");
}

}  // namespace edsc

#include "values/value_text.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <iterator>

#include "text/counted.hpp"
#include "text/printable.hpp"
#include "text/utf8.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t milliseconds_per_day = 24 * 60 * 60 * 1000;
constexpr std::uint32_t time_mask = 0x0FFF'FFFF;  ///< 28 bits of milliseconds, 4 are reserved
constexpr std::size_t max_shown_bytes = 32;       ///< of a DOMAIN

void append_clock(std::string& text, std::uint32_t milliseconds) {
  const std::uint32_t seconds = milliseconds / 1000;
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:02}:{:02}:{:02}.{:03}"), seconds / 3600, seconds / 60 % 60,
                 seconds % 60, milliseconds % 1000);
}

void append_time(std::string& text, DataType type, std::uint64_t number) {
  const auto days = static_cast<std::uint32_t>(number >> 32);
  const std::uint32_t milliseconds = static_cast<std::uint32_t>(number) & time_mask;
  if (type == DataType::time_of_day) {
    const std::chrono::year_month_day date{time_epoch + std::chrono::days{days}};
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:04}-{:02}-{:02} "), static_cast<int>(date.year()),
                   static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
    return append_clock(text, milliseconds);
  }
  append_decimal(text, days + milliseconds / milliseconds_per_day);
  text += " d ";
  append_clock(text, milliseconds % milliseconds_per_day);
}

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string_view without_trailing_zeros(std::string_view text) {
  while (text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

void append_string(std::string& text, DataType type, Bytes bytes) {
  if (type == DataType::octet_string) return append_hex_bytes(text, bytes);
  if (type == DataType::unicode_string) {
    return append_quoted(text, without_trailing_zeros(from_utf16_bytes(text_of(bytes), ByteOrder::low_first)));
  }
  append_quoted(text, without_trailing_zeros(text_of(bytes)));
}

void append_domain(std::string& text, Bytes bytes) {
  append_hex_bytes(text, bytes.first(std::min(bytes.size(), max_shown_bytes)));
  if (bytes.size() > max_shown_bytes) text += " ...";
}

}  // namespace

void append_unit(std::string& text, std::string_view unit) {
  if (unit.empty()) return;
  text += ' ';
  text += unit;
}

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (std::size_t at = 0; at < text.size();) {
    const auto [length, is_visible] = first_sequence(text.substr(at));
    const std::string_view sequence = text.substr(at, length);
    if (sequence == "\"" || sequence == "\\") out += '\\';
    if (is_visible) {
      out += sequence;
    } else {
      for (const char byte : sequence) {
        out += "\\x";
        append_hex(out, static_cast<std::uint8_t>(byte), 2);
      }
    }
    at += length;
  }
  out += '"';
}

void append_number(std::string& text, const DataTypeRow& type, std::uint64_t number, unsigned bits,
                   std::string_view unit) {
  number &= low_bits(bits);
  const unsigned digits = (bits + 3) / 4;
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
      append_decimal(text, bits == 0 ? 0 : sign_extended(number, bits));
      return append_unit(text, unit);
    case DataClass::unsigned_integer:
      append_decimal(text, number);
      if (!unit.empty()) return append_unit(text, unit);
      if (number >= 10) {
        text += " (";
        append_hex_number(text, number, digits);
        text += ")";
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
    case DataClass::time: return append_time(text, type.type, number);
    case DataClass::string:
    case DataClass::domain: break;
  }
  append_hex_number(text, number, digits);
}

void append_value(std::string& text, const DataTypeRow& type, Bytes bytes, std::string_view unit) {
  if (type.kind == DataClass::string) return append_string(text, type.type, bytes);
  if (type.kind == DataClass::domain) return append_domain(text, bytes);
  if (bytes.empty()) {
    text += "nothing";
  } else if (bytes.size() > sizeof(std::uint64_t)) {
    append_domain(text, bytes);
  } else {
    append_number(text, type, number_of(bytes), static_cast<unsigned>(bytes.size()) * 8, unit);
  }
  const std::size_t expected = bytes_for(type.bits);
  if (bytes.size() == expected) return;
  fmt::format_to(std::back_inserter(text), " ({}, {} has {})", counted(bytes.size(), "byte"), type.name, expected);
}

std::string value_text(const DataTypeRow& type, Bytes bytes) {
  std::string text;
  append_value(text, type, bytes);
  return text;
}

std::string written_value(const std::optional<Value>& value, const DataTypeRow& type) {
  if (!value) return "none";
  if (value->plus_node_id) return fmt::format("$NODEID+0x{:X}", value->bits);
  switch (type.kind) {
    case DataClass::string: return fmt::format("\"{}\"", value->bytes);
    case DataClass::real: return real_text(value->bits, type);
    case DataClass::signed_integer: return fmt::format("{}", static_cast<std::int64_t>(value->bits));
    case DataClass::boolean:
    case DataClass::unsigned_integer:
    case DataClass::time:
    case DataClass::domain: break;
  }
  return value->hexadecimal ? fmt::format("0x{:0{}X}", value->bits, (type.bits + 3) / 4)
                            : fmt::format("{}", value->bits);
}

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

}  // namespace edsc

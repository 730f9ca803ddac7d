#include "backend/cpp/cpp_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/cpp/placement.hpp"
#include "text/printable.hpp"
#include "text/utf8.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;

std::string real_literal(std::uint64_t bits, const canopen::DataTypeRow& row, std::string_view type,
                         std::string_view suffix) {
  const double value = real_of(bits, row);
  if (std::isnan(value)) return fmt::format("std::numeric_limits<{}>::quiet_NaN()", type);
  if (std::isinf(value)) {
    return fmt::format("{}std::numeric_limits<{}>::infinity()", value < 0 ? "-" : "", type);
  }
  std::string text = real_text(bits, row);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text.append(suffix);
}

std::string signed_literal(std::uint64_t bits) {
  const auto value = static_cast<std::int64_t>(bits);
  if (value == std::numeric_limits<std::int64_t>::min()) return "std::numeric_limits<std::int64_t>::min()";
  return fmt::format("{}", value);
}

std::string unsigned_literal(const Value& value, const canopen::DataTypeRow& type) {
  if (value.hexadecimal) return fmt::format("0x{:0{}X}", value.bits, type.bits / 4);
  return fmt::format("{}{}", value.bits, value.bits > 0x7FFF'FFFF'FFFF'FFFF ? "u" : "");
}

std::string byte_list(std::string_view bytes) {
  std::string out = "{";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    out += fmt::format("{}0x{:02X}", i == 0 ? "" : ", ", static_cast<unsigned char>(bytes[i]));
  }
  return out + "}";
}

/// Non-ASCII code units as \x escapes, each ending its literal so that a digit after it does not become part of it.
std::string utf16_string(std::string_view text) {
  std::string out = "u\"";
  for (const char16_t unit : to_utf16(text)) {
    if (unit >= 0x20 && unit < 0x7F && unit != u'"' && unit != u'\\' && unit != u'?') {
      out += static_cast<char>(unit);
    } else {
      out += fmt::format("\\x{:X}\" u\"", static_cast<unsigned>(unit));
    }
  }
  return out + "\"";
}

}  // namespace

std::string cpp_literal(const Value& value, const canopen::DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return value.bits != 0 ? "true" : "false";
    case DataClass::signed_integer: return signed_literal(value.bits);
    case DataClass::unsigned_integer: return unsigned_literal(value, type);
    case DataClass::real:
      return type.bits == 32 ? real_literal(value.bits, type, "float", "f")
                             : real_literal(value.bits, type, "double", "");
    case DataClass::time:
      return fmt::format("{{{}, {}}}", value.bits & 0x0FFF'FFFF, static_cast<std::uint16_t>(value.bits >> 32));
    case DataClass::string:
      if (type.type == DataType::octet_string) return byte_list(value.bytes);
      if (type.type == DataType::unicode_string) return utf16_string(value.bytes);
      return cpp_string(value.bytes);
    case DataClass::domain: break;
  }
  return "{}";
}

std::string cpp_initializer(const Entry& entry) {
  if (entry.default_value) {
    const std::string literal = cpp_literal(*entry.default_value, *entry.type);
    return entry.type->kind == DataClass::string && literal.front() != '{' ? "{" + literal + "}" : literal;
  }
  if (entry.type->kind == DataClass::boolean) return "false";
  return entry.type->bits == 0 || entry.type->kind == DataClass::time ? "{}" : "0";
}

std::string cpp_type(const Entry& entry, const Options& options) {
  if (entry.type->kind != DataClass::string) return std::string{entry.type->cpp_type};
  return fmt::format("{}<{}>", entry.type->cpp_type, string_bytes(entry, options));
}

std::string type_word(const canopen::DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return "boolean";
    case DataClass::signed_integer: return fmt::format("i{}", type.bits);
    case DataClass::unsigned_integer: return fmt::format("u{}", type.bits);
    case DataClass::real: return fmt::format("r{}", type.bits);
    case DataClass::time: return fmt::format("time{}", type.bits);
    case DataClass::string: return type.type == DataType::visible_string ? "visible_string" : "octet_string";
    case DataClass::domain: break;
  }
  return "domain";
}

std::string cpp_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte >= 0x7F) {
      out += fmt::format("\\{:03o}", byte);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string cpp_comment(std::string_view text) {
  constexpr std::string_view backslash_trigraph =
      "??"
      "/";
  std::string out = printable(text);
  std::ranges::replace(out, '\\', '/');
  for (std::size_t at = 0; (at = out.find(backslash_trigraph, at)) != std::string::npos;) {
    out.erase(at, backslash_trigraph.size());
    at -= std::min(at, backslash_trigraph.size());  // the rest may be another one
  }
  return out;
}

}  // namespace edsc

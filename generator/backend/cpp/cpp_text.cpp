#include "backend/cpp/cpp_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "text/printable.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;

template <class Real>
std::string real_literal(Real value, std::string_view type, std::string_view suffix) {
  if (std::isnan(value)) return fmt::format("std::numeric_limits<{}>::quiet_NaN()", type);
  if (std::isinf(value)) {
    return fmt::format("{}std::numeric_limits<{}>::infinity()", value < 0 ? "-" : "", type);
  }
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + std::string{suffix};
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
      if (type.bits == 32) {
        return real_literal(std::bit_cast<float>(static_cast<std::uint32_t>(value.bits)), "float", "f");
      }
      return real_literal(std::bit_cast<double>(value.bits), "double", "");
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

std::string cpp_initializer(const Value& value, const canopen::DataTypeRow& type) {
  const std::string literal = cpp_literal(value, type);
  return type.kind == DataClass::string && literal.front() != '{' ? "{" + literal + "}" : literal;
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

std::size_t wire_length(const Value& value, const canopen::DataTypeRow& type) {
  return type.type == DataType::unicode_string ? to_utf16(value.bytes).size() * 2 : value.bytes.size();
}

}  // namespace edsc

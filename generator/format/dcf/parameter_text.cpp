#include "format/dcf/parameter_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "format/spelling/number_spelling.hpp"
#include "text/ascii.hpp"
#include "text/utf8.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using Bytes = std::span<const std::uint8_t>;

/// Whether a text can be the value of a key unchanged.
std::optional<std::string> line_of(std::string text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  const bool printable = is_utf8(text) && std::none_of(text.begin(), text.end(), is_control);
  if (text.empty() || !printable || is_blank(text.front()) || is_blank(text.back())) return std::nullopt;
  return text;
}

std::optional<std::string> unicode_text(Bytes bytes) {
  if (bytes.size() % 2 != 0) return std::nullopt;
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto unit = static_cast<char32_t>(bytes[i] | bytes[i + 1] << 8);
    const bool surrogate = (unit & 0xF800) == 0xD800;
    if (surrogate) return std::nullopt;
    append_utf8(text, unit);
  }
  return line_of(std::move(text));
}

std::optional<std::string> string_text(const canopen::DataTypeRow& type, Bytes bytes) {
  if (type.type == DataType::octet_string) {
    return bytes.empty() ? std::nullopt : std::optional{hex_pairs(std::string{bytes.begin(), bytes.end()})};
  }
  if (type.type == DataType::unicode_string) return unicode_text(bytes);
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  return line_of({bytes.begin(), bytes.end()});
}

}  // namespace

std::optional<std::string> parameter_text(const Entry& entry, Bytes bytes) {
  const canopen::DataTypeRow& type = *entry.type;
  if (type.kind == DataClass::domain) return std::nullopt;
  if (type.kind == DataClass::string) return string_text(type, bytes);
  if (bytes.size() != (type.bits + 7U) / 8U) return std::nullopt;
  const std::uint64_t bits = number_of(bytes);
  const bool hexadecimal = !entry.default_value || entry.default_value->hexadecimal;
  switch (type.kind) {
    case DataClass::boolean: return std::string{bits != 0 ? "1" : "0"};
    case DataClass::real:
      if (std::isfinite(real_of(bits, type))) return real_text(bits, type);
      break;
    case DataClass::signed_integer: return fmt::format("{}", sign_extended(bits, type.bits));
    case DataClass::unsigned_integer:
      if (!hexadecimal) return fmt::format("{}", bits);
      break;
    case DataClass::time:
    case DataClass::string:
    case DataClass::domain: break;
  }
  return fmt::format("0x{:0{}X}", bits, hex_digits_of(type));
}

}  // namespace edsc

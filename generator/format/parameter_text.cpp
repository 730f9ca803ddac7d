#include "format/parameter_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "format/number_spelling.hpp"
#include "text/ascii.hpp"
#include "text/utf8.hpp"

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
    std::string digits;
    for (const std::uint8_t byte : bytes) digits += fmt::format("{:02X}", byte);
    return digits.empty() ? std::nullopt : std::optional{digits};
  }
  if (type.type == DataType::unicode_string) return unicode_text(bytes);
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  return line_of({bytes.begin(), bytes.end()});
}

std::string real_text(std::uint64_t bits, const canopen::DataTypeRow& type) {
  const bool single = type.bits == 32;
  const auto narrow = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  const auto wide = std::bit_cast<double>(bits);
  if (!std::isfinite(single ? static_cast<double>(narrow) : wide)) return fmt::format("0x{:0{}X}", bits, type.bits / 4);
  return single ? fmt::format("{}", narrow) : fmt::format("{}", wide);
}

}  // namespace

std::optional<std::string> parameter_text(const Entry& entry, Bytes bytes) {
  const canopen::DataTypeRow& type = *entry.type;
  if (type.kind == DataClass::domain) return std::nullopt;
  if (type.kind == DataClass::string) return string_text(type, bytes);
  if (bytes.size() != (type.bits + 7U) / 8U) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) bits = bits << 8 | bytes[i];
  const bool hexadecimal = !entry.default_value || entry.default_value->hexadecimal;
  switch (type.kind) {
    case DataClass::boolean: return std::string{bits != 0 ? "1" : "0"};
    case DataClass::real: return real_text(bits, type);
    case DataClass::signed_integer: {
      const unsigned unused = 64U - type.bits;
      return fmt::format("{}", static_cast<std::int64_t>(bits << unused) >> unused);
    }
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

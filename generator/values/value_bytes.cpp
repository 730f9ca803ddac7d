#include "values/value_bytes.hpp"

#include <fmt/format.h>

#include <bit>
#include <iterator>

#include "text/utf8.hpp"

namespace edsc {

void append_bytes(std::string& bytes, std::uint64_t number, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes += static_cast<char>(number >> (8 * i));
}

std::string bytes_of(const Value& value, const canopen::DataTypeRow& type) {
  if (type.type == canopen::DataType::unicode_string) return to_utf16_bytes(value.bytes);
  if (type.kind == canopen::DataClass::string) return value.bytes;
  std::string bytes;
  append_bytes(bytes, value.bits, (type.bits + 7U) / 8U);
  return bytes;
}

std::string hex_pairs(std::string_view bytes) {
  std::string digits;
  for (const char c : bytes) fmt::format_to(std::back_inserter(digits), "{:02X}", static_cast<unsigned char>(c));
  return digits;
}

double real_of(std::uint64_t bits, const canopen::DataTypeRow& type) {
  return type.bits == 32 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits)) : std::bit_cast<double>(bits);
}

std::string real_text(std::uint64_t bits, const canopen::DataTypeRow& type) {
  return type.bits == 32 ? fmt::format("{}", static_cast<float>(real_of(bits, type)))
                         : fmt::format("{}", real_of(bits, type));
}

}  // namespace edsc

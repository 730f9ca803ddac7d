/// Values as bytes of an SDO or PDO, and numbers as text.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "values/little_endian.hpp"
#include "values/value.hpp"

namespace edsc {

/// Appends a number with this many bytes to `bytes`.
void append_bytes(std::string& bytes, std::uint64_t number, unsigned count);

/// A value as SDO download data; a UNICODE_STRING in UTF-16.
[[nodiscard]] std::string bytes_of(const Value& value, const canopen::DataTypeRow& type);

/// Bytes as pairs of hexadecimal digits.
[[nodiscard]] std::string hex_pairs(std::string_view bytes);

/// The bits of a REAL32 or REAL64 as a number; exact, since a double holds each float.
[[nodiscard]] double real_of(std::uint64_t bits, const canopen::DataTypeRow& type);

/// The bits of a REAL32 or REAL64 as the shortest decimal number that has them.
[[nodiscard]] std::string real_text(std::uint64_t bits, const canopen::DataTypeRow& type);

}  // namespace edsc

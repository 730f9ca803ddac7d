/// The bytes of an SDO or PDO, low byte first, as text for people. `parse_value.hpp` reads the same text.
///
///   BOOLEAN                 true
///   UNSIGNED8..64           567 (0237h), with a unit 1500 rpm
///   INTEGER8..64, REAL      -12 inc, 2.5
///   VISIBLE_, UNICODE_STRING "CPC-TC1", non-printable characters as \x0D
///   OCTET_STRING, DOMAIN    DE AD BE EF
///   TIME_OF_DAY             2024-01-31 12:34:56.789
///   TIME_DIFFERENCE         3 d 12:34:56.789
#pragma once

#include <canopen/od/data_type.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "values/value.hpp"

namespace edsc {

/// The days of TIME_OF_DAY and 1020h count from here (CiA 301, 7.1.6.6).
inline constexpr std::chrono::sys_days time_epoch = std::chrono::year{1984} / 1 / 1;

/// A number in the low `bits` bits: for BOOLEAN, integers, REAL and times; for other types as hexadecimal digits.
void append_number(std::string& text, const canopen::DataTypeRow& type, std::uint64_t number, unsigned bits,
                   std::string_view unit = {});

/// A blank and the unit; nothing for an empty one.
void append_unit(std::string& text, std::string_view unit);

/// A value of any type. If the number of bytes does not match the type, shows the bytes with a remark. For a DOMAIN,
/// the first bytes and the length.
void append_value(std::string& text, const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes,
                  std::string_view unit = {});

/// `"a \"b\" \x0D"`: in quotation marks, non-printable characters as codes.
void append_quoted(std::string& out, std::string_view text);

/// The same as a separate string.
[[nodiscard]] std::string value_text(const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes);

/// A value of an EDS as it is written there, with strings in quotes; `none` without a value.
[[nodiscard]] std::string written_value(const std::optional<Value>& value, const canopen::DataTypeRow& type);

/// A limit; with an unknown node-ID, as a formula.
[[nodiscard]] std::string limit_text(const Value& limit, const canopen::DataTypeRow& type);

}  // namespace edsc

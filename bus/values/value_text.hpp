/// Converts values between text for people and the bytes of an SDO or PDO, low byte first.
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
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// The days of TIME_OF_DAY count from 1984-01-01 (CiA 301, 7.1.6.6): `2024-01-31 12:34:56.789`.
void append_time_of_day(std::string& text, std::uint32_t days, std::uint32_t milliseconds);

/// A number in the low `bits` bits: for BOOLEAN, integers, REAL and times; for other types as hexadecimal digits.
void append_number(std::string& text, const canopen::DataTypeRow& type, std::uint64_t number, unsigned bits,
                   std::string_view unit = {});

/// A value of any type. If the number of bytes does not match the type, shows the bytes with a remark. For a DOMAIN,
/// the first bytes and the length.
void append_value(std::string& text, const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes,
                  std::string_view unit = {});

/// With the unit of the entry. UNSIGNED32 values of communication parameters, such as COB-IDs and mappings, in
/// hexadecimal only.
void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes);

/// `"a \"b\" \x0D"`: in quotation marks, non-printable characters as codes.
void append_quoted(std::string& out, std::string_view text);

/// The same as a separate string.
[[nodiscard]] std::string value_text(const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes);
[[nodiscard]] std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes);

/// `0..3000 rpm`: the limits in the EDS; empty if it has none.
[[nodiscard]] std::string limits_text(const Entry& entry);

/// The value of a text, or an error message.
struct ParsedValue {
  std::vector<std::uint8_t> bytes;  ///< as transmitted
  std::string problem;              ///< empty on success

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Parses the output of `value_text()`, and 0x1F, 1Fh, 0b101 for integers. An INTEGER may be given by its bits: 0xFFFF
/// is -1 as INTEGER16. Quotation marks around a string are removed, and escapes in it are resolved; a string without
/// them is used unchanged. A DOMAIN is given as hexadecimal digits.
[[nodiscard]] ParsedValue parse_value_text(const canopen::DataTypeRow& type, std::string_view text);
/// Checks the limits of the entry; its unit may follow the number.
[[nodiscard]] ParsedValue parse_value_text(const Entry& entry, std::string_view text);

}  // namespace edsc

/// Values as people read and write them: the bytes of an SDO or PDO, low byte first, to text and back.
///
///   BOOLEAN                 true
///   UNSIGNED8..64           567 (0237h), with a unit 1500 rpm
///   INTEGER8..64, REAL      -12 inc, 2.5
///   VISIBLE_, UNICODE_STRING "CPC-TC1", what cannot be printed as \x0D
///   OCTET_STRING, DOMAIN    DE AD BE EF
///   TIME_OF_DAY             2024-01-31 12:34:56.789
///   TIME_DIFFERENCE         3 d 12:34:56.789
#pragma once

#include <canopen/data_type.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// The days of TIME_OF_DAY count from 1984-01-01 (CiA 301, 7.1.6.6): `2024-01-31 12:34:56.789`.
void append_time_of_day(std::string& text, std::uint32_t days, std::uint32_t milliseconds);

/// A number of at most 64 bits, whose `bits` low ones count: of BOOLEAN, integers, REAL and times, and of all else as
/// hexadecimal digits.
void append_number(std::string& text, const canopen::DataTypeRow& type, std::uint64_t number, unsigned bits,
                   std::string_view unit = {});

/// A value of any type. Bytes that are not as many as the type has are shown as what they are, with a remark. Of a
/// DOMAIN the first bytes and the length.
void append_value(std::string& text, const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes,
                  std::string_view unit = {});

/// With the entry's unit. The UNSIGNED32 of communication parameters are COB-IDs, mappings and their like: as
/// hexadecimal digits alone.
void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes);

/// `"a \"b\" \x0D"`: in quotation marks, what cannot be printed as its code.
void append_quoted(std::string& out, std::string_view text);

/// The same as a text of its own.
[[nodiscard]] std::string value_text(const canopen::DataTypeRow& type, std::span<const std::uint8_t> bytes);
[[nodiscard]] std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes);

/// `0..3000 rpm`: the limits of the data sheet, empty where it has none.
[[nodiscard]] std::string limits_text(const Entry& entry);

/// What a text stands for, or a sentence on what is wrong with it.
struct ParsedValue {
  std::vector<std::uint8_t> bytes;  ///< as they go over the bus
  std::string problem;              ///< empty: all is well

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Takes what `value_text()` prints, and 0x1F, 1Fh, 0b101 for integers. An INTEGER may be given by its bits: 0xFFFF is
/// -1 of INTEGER16. Quotation marks around a string are cut, and escapes inside of them are taken; without them a
/// string is taken as it stands. A DOMAIN is given as hexadecimal digits.
[[nodiscard]] ParsedValue parse_value_text(const canopen::DataTypeRow& type, std::string_view text);
/// The entry's limits count, and its unit may stand behind the number.
[[nodiscard]] ParsedValue parse_value_text(const Entry& entry, std::string_view text);

}  // namespace edsc

/// Text of people as the bytes of an SDO: reads the output of `value_text.hpp`.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

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

/// The days from 1984-01-01, as in TIME_OF_DAY and 1020h; nothing for an invalid date, or one before.
[[nodiscard]] std::optional<std::uint32_t> days_of_date(unsigned year, unsigned month, unsigned day);

}  // namespace edsc

/// The values of messages as numbers, for programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "decode/message.hpp"

namespace edsc {

using ValueNumber = std::variant<bool, std::uint64_t, std::int64_t, float, double>;

/// Nothing for a value that is not a BOOLEAN, an integer or a REAL, for a REAL of another length than that of its type,
/// and for a value of unknown type.
[[nodiscard]] std::optional<ValueNumber> plain_number(const MessageValue& value);

/// The physical value of a number with a quantity; nothing for other values, and for one that is not finite.
[[nodiscard]] std::optional<double> physical_number(const MessageValue& value);

/// A finite number, physical if the value has a quantity; 0 and 1 for a BOOLEAN.
[[nodiscard]] std::optional<double> finite_number_of(const MessageValue& value);

/// The value of an integer; nothing for other types.
[[nodiscard]] std::optional<std::int64_t> integer_of(const MessageValue& value);

/// `true`, `-12`, `2.5`, `nan`
void append_number(std::string& out, const ValueNumber& number);

}  // namespace edsc

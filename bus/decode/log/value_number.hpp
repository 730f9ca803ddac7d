/// The values of messages as numbers, for programs.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "decode/message.hpp"

namespace edsc {

using ValueNumber = std::variant<bool, std::uint64_t, std::int64_t, float, double>;

/// Nothing for a value that is not a BOOLEAN, an integer or a REAL, for a REAL of another length than that of its type,
/// and for a value of unknown type.
[[nodiscard]] std::optional<ValueNumber> plain_number(const MessageValue& value);

/// A finite number, or 0 and 1 for a BOOLEAN.
[[nodiscard]] std::optional<double> finite_number_of(const MessageValue& value);

/// `true`, `-12`, `2.5`, `nan`
void append_number(std::string& out, const ValueNumber& number);

}  // namespace edsc

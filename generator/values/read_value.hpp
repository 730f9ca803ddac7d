/// Parses the values of an EDS: numbers, node-ID formulas, strings (CiA 306-1, 4.6.2.3).
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "values/value.hpp"

namespace edsc {

/// Parses DefaultValue or ParameterValue of an entry of this type. Returns nothing for a missing or empty field, and
/// for an invalid one, which is reported. With a node-ID, formulas become numbers.
[[nodiscard]] std::optional<Value> parse_value(const Field& field, const canopen::DataTypeRow& type,
                                               std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

/// The same for a value of a network file, which is made for edsc: a decimal number outside the range of the type is an
/// error. In an EDS it is read as two's complement.
[[nodiscard]] std::optional<Value> parse_exact_value(const Field& field, const canopen::DataTypeRow& type,
                                                     std::uint8_t node_id, Diagnostics& diagnostics);

enum class Limit : std::uint8_t { low, high };

/// The same for LowLimit or HighLimit. A limit outside the range of the type has no effect and is ignored, with a
/// warning.
[[nodiscard]] std::optional<Value> parse_limit(const Field& field, Limit which, const canopen::DataTypeRow& type,
                                               std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

/// Whether `a` is less than `b`; both are the bits of values of this type.
[[nodiscard]] bool is_less(const canopen::DataTypeRow& type, std::uint64_t a, std::uint64_t b);

}  // namespace edsc

/// Values as an EDS spells them: numbers, node-ID formulas, strings (CiA 306-1, 4.6.2.3).
#pragma once

#include <canopen/data_type.hpp>
#include <cstdint>
#include <optional>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The value of DefaultValue or ParameterValue for an entry of this type. Nothing when the field is
/// missing or empty, or when it cannot be read, which is then reported. With a node-ID, formulas become numbers.
[[nodiscard]] std::optional<Value> parse_value(const Field& field, const canopen::DataTypeRow& type,
                                               std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

enum class Limit : std::uint8_t { low, high };

/// The same for LowLimit or HighLimit. One that lies beyond the type's own range limits nothing: it is left out, with a
/// warning.
[[nodiscard]] std::optional<Value> parse_limit(const Field& field, Limit which, const canopen::DataTypeRow& type,
                                               std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

/// Whether `a` is less than `b`, both the bits of values of this type.
[[nodiscard]] bool is_less(const canopen::DataTypeRow& type, std::uint64_t a, std::uint64_t b);

}  // namespace edsc

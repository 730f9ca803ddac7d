/// What a DCF configures: the entries with a ParameterValue, as SDO downloads carry them.
#pragma once

#include <string>
#include <vector>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct ConfiguredValue {
  const Entry* entry = nullptr;
  std::string data;      ///< low byte first
  bool differs = false;  ///< from the default
  Position position;     ///< the value
};

/// The writable entries that have a ParameterValue, ascending; without DOMAINs. `device` is that of `sheet`, with the
/// node-ID. A formula without node-ID, and a value that cannot be read, is reported; what the report is about is left
/// out.
[[nodiscard]] std::vector<ConfiguredValue> configured_values(const DataSheet& sheet, const Device& device,
                                                             Diagnostics& diagnostics);

/// A value as an SDO download carries it.
[[nodiscard]] std::string data_of(const Value& value, const canopen::DataTypeRow& type);

/// A number of so many bytes behind `bytes`, low byte first.
void append_bytes(std::string& bytes, std::uint64_t number, unsigned count);

}  // namespace edsc

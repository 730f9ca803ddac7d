/// A file whose data types are all counted from another number than those of CiA 301.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The number that the data types of a file are too high, or too low: those of nearly all objects of CiA 301 differ by
/// it from the standard. Nothing if the types are right, or wrong in another way.
struct ShiftedTypes {
  int difference = 0;
  std::size_t count = 0;  ///< number of entries that show it
  Position first;         ///< the DataType of the first one
};

[[nodiscard]] std::optional<ShiftedTypes> find_shifted_types(const DataSheet& sheet);

/// Reports it as an error.
void report_shifted_types(const DataSheet& sheet, Diagnostics& diagnostics);

}  // namespace edsc

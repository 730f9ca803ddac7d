/// The words of `edsc object`: objects, ranges, data types and values.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "change/new_objects.hpp"

namespace edsc {

/// `2000h`, `2000h-20FFh`, `2010h:01`, `2010h:01-08`.
struct ObjectRange {
  std::uint16_t first = 0, last = 0;
  std::optional<std::uint8_t> first_sub, last_sub;
};
[[nodiscard]] std::optional<ObjectRange> read_object_range(std::string_view word);

/// `6000h[4]`: an index, and the number of elements of an ARRAY; 1 without it.
struct CountedIndex {
  std::uint16_t index = 0;
  std::uint8_t elements = 1;
};
[[nodiscard]] std::optional<CountedIndex> read_counted_index(std::string_view word);

/// `UNSIGNED16`, `u16`, `UNSIGNED16[8]`.
struct CountedType {
  const canopen::DataTypeRow* type = nullptr;
  std::optional<std::uint8_t> elements;
};
[[nodiscard]] std::optional<CountedType> read_counted_type(std::string_view word);

/// `Speed:UNSIGNED16:rw=3000,Current:UNSIGNED16:rw=500`: the sub-indices of a RECORD. Nothing for another text.
[[nodiscard]] std::optional<std::vector<NewValue>> read_record(std::string_view text);

/// `0.1 degC` or `degC`: the factor, which may be empty, and the unit.
struct FactorAndUnit {
  std::string factor, unit;
};
[[nodiscard]] FactorAndUnit read_unit(std::string_view text);

[[nodiscard]] bool is_access_text(std::string_view text);

}  // namespace edsc

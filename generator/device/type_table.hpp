/// What DataType stands for: basic types, complex ones of CiA 301, and the data sheet's own.
#pragma once

#include <canopen/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Indices below this describe data types, not values.
inline constexpr std::uint16_t first_communication_index = 0x1000;

/// A basic type, and the limits that a type of the data sheet's own puts on it.
struct ValueType {
  const canopen::DataTypeRow* row = nullptr;
  const Value* low_limit = nullptr;
  const Value* high_limit = nullptr;
  std::uint32_t octets = 0;  ///< of a string: the length that its DEFTYPE states, in bytes; 0 where none does
};

class TypeTable {
 public:
  TypeTable(const DataSheet& sheet, std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

  /// The type of one value; `row` is null where there is none.
  [[nodiscard]] ValueType find(std::uint64_t code) const;

  /// The type that a RECORD of complex type `code` has at a sub-index; `row` is null where none is known.
  [[nodiscard]] ValueType find_member(std::uint64_t code, std::uint8_t sub_index) const;

  /// PDO parameters, SDO parameter, identity and their like (CiA 301, 7.4.7, table 44), or a DEFSTRUCT of the data
  /// sheet.
  [[nodiscard]] bool is_complex(std::uint64_t code) const;

  [[nodiscard]] const std::vector<TypeDefinition>& definitions() const { return definitions_; }

 private:
  [[nodiscard]] const TypeDefinition* definition(std::uint64_t code) const;

  std::vector<TypeDefinition> definitions_;  ///< ascending by index
};

}  // namespace edsc

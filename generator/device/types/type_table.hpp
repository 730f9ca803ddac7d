/// The data types that DataType can name: basic and complex types of CiA 301, and those that the EDS defines.
#pragma once

#include <canopen/od/data_type.hpp>
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

/// A basic type, with the limits of a type that the EDS defines.
struct ValueType {
  const canopen::DataTypeRow* row = nullptr;
  const Value* low_limit = nullptr;
  const Value* high_limit = nullptr;
  std::uint32_t octets = 0;  ///< of a string: the length stated by its DEFTYPE, in bytes; 0 if none
};

class TypeTable {
 public:
  TypeTable(const DataSheet& sheet, std::optional<std::uint8_t> node_id, Diagnostics& diagnostics);

  /// The type of one value; `row` is null if unknown.
  [[nodiscard]] ValueType find(std::uint64_t code) const;

  /// The type of a sub-index of a RECORD of complex type `code`; `row` is null if unknown.
  [[nodiscard]] ValueType find_member(std::uint64_t code, std::uint8_t sub_index) const;

  /// PDO parameters, SDO parameter, identity and so on (CiA 301, 7.4.7, table 44), or a DEFSTRUCT of the EDS.
  [[nodiscard]] bool is_complex(std::uint64_t code) const;

  [[nodiscard]] const std::vector<TypeDefinition>& definitions() const { return definitions_; }

 private:
  [[nodiscard]] const TypeDefinition* definition(std::uint64_t code) const;

  std::vector<TypeDefinition> definitions_;  ///< ascending by index
};

}  // namespace edsc

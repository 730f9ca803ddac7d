/// Resolves a section of the data sheet to an entry of the dictionary: type, access, mapping, values.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/device.hpp"
#include "device/types/type_table.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct EntryPlace {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  bool in_object_with_sub_indices = false;
  std::optional<std::uint64_t> record_type = std::nullopt;  ///< DataType of its RECORD
};

class EntryResolver {
 public:
  EntryResolver(const TypeTable& types, bool is_dcf, std::optional<std::uint8_t> node_id, Diagnostics& diagnostics)
      : types_{types}, is_dcf_{is_dcf}, node_id_{node_id}, diagnostics_{diagnostics} {}

  /// Returns nothing if the entry has no type, which is reported.
  [[nodiscard]] std::optional<Entry> resolve(const EntryDescription& description, const EntryPlace& place,
                                             std::string_view name);

  [[nodiscard]] std::uint32_t obj_flags(const EntryDescription& description);

 private:
  void check_sub_object_type(const EntryDescription& description);
  /// Returns nothing for an entry that is ignored; no row for an unknown type.
  std::optional<ValueType> data_type(const EntryDescription& description, const EntryPlace& place);
  std::optional<ValueType> missing_data_type(const EntryDescription& description, const EntryPlace& place);
  /// The type that the service of a communication parameter needs; nothing if the entry may have its type.
  std::optional<ValueType> type_of_service(const EntryDescription& description, const EntryPlace& place,
                                           const ValueType& found);
  canopen::Access access(const EntryDescription& description, const EntryPlace& place);
  bool pdo_mapping(const EntryDescription& description);
  void resolve_default(const EntryDescription& description, Entry& entry);
  void resolve_limits(const EntryDescription& description, const ValueType& type, Entry& entry);
  void drop_limit_formula(std::optional<Value>& limit);
  void resolve_files(const EntryDescription& description, Entry& entry);

  const TypeTable& types_;
  bool is_dcf_;
  std::optional<std::uint8_t> node_id_;
  Diagnostics& diagnostics_;
};

}  // namespace edsc

/// Resolves the sections of one index to an object with its entries; unfolds compact forms.
#pragma once

#include <cstdint>
#include <optional>

#include "device/device.hpp"
#include "device/objects/entry_resolver.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Sub-index 0, a constant, of an object without one in the EDS.
[[nodiscard]] Entry count_entry(std::uint16_t index, std::uint8_t highest, const Position& position);

class ObjectResolver {
 public:
  ObjectResolver(EntryResolver& entries, bool is_dcf, Diagnostics& diagnostics)
      : entries_{entries}, is_dcf_{is_dcf}, diagnostics_{diagnostics} {}

  /// Returns nothing if no entry remains, which is reported.
  [[nodiscard]] std::optional<Object> resolve(const ObjectDescription& description);

 private:
  ObjectType object_type(const ObjectDescription& description);
  void report_stray_sub_objects(const ObjectDescription& description, ObjectType type);
  void resolve_sub_objects(const ObjectDescription& description, Object& object);
  void resolve_sub_object(const SubObjectDescription& sub, const ObjectDescription& description, Object& object);
  void resolve_links(const ObjectDescription& description, Object& object);
  void check_sub_number(const ObjectDescription& description);
  void check_sub_indices(const ObjectDescription& description);
  void supply_sub_index_0(const ObjectDescription& description, Object& object);

  EntryResolver& entries_;
  bool is_dcf_;
  Diagnostics& diagnostics_;
};

}  // namespace edsc

#include "backend/json/replaced_default.hpp"

#include "values/read_value.hpp"

namespace edsc {

std::optional<ReplacedDefault> replaced_default(const Entry& entry, const DataSheet& sheet,
                                                const ObjectDescription& object, const Device& device) {
  const bool has_sub_indices = device.find(entry.index)->has_sub_indices();
  const ValueFields fields = sheet.values_of(object, entry.sub_index, has_sub_indices);
  // A value in the section of a compact form is not that of one element.
  const bool is_common = has_sub_indices && fields.parameter_value == &object.parameter_value;
  if (is_common || fields.parameter_value == nullptr || !fields.parameter_value->present ||
      fields.parameter_value->empty()) {
    return std::nullopt;
  }
  if (!entry.default_value || !entry.default_value->clause.empty()) return std::nullopt;
  Diagnostics ignored;
  return ReplacedDefault{parse_value(*fields.default_value, *entry.type, device.node_id, ignored)};
}

}  // namespace edsc

#include "format/dcf/configured_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "eds/number.hpp"
#include "values/read_value.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

class Configuration {
 public:
  Configuration(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics)
      : sheet_(sheet), device_(device), diagnostics_(diagnostics) {}

  std::vector<ConfiguredValue> collect() {
    for (const Object& object : device_.objects) {
      const ObjectDescription* const description = sheet_.find(object.index);
      for (const Entry& entry : object.entries) {
        if (description != nullptr && canopen::writable(entry.access)) add(entry, *description);
      }
    }
    return std::move(values_);
  }

 private:
  void add(const Entry& entry, const ObjectDescription& object) {
    if (entry.type->kind == canopen::DataClass::domain) return;
    const ValueFields fields = sheet_.values_of(object, entry.sub_index, device_.find(entry.index)->has_sub_indices());
    if (fields.parameter_value == nullptr || strip_inline_comment(fields.parameter_value->text).empty()) return;
    if (entry.default_value && !entry.default_value->clause.empty()) {
      diagnostics_.note("implied-default", fields.parameter_value->position,
                        fmt::format("{} is not configured: CiA 301, {}, requires another value",
                                    entry_label(entry.index, entry.sub_index), entry.default_value->clause));
      return;
    }
    auto configured = data(*fields.parameter_value, entry, diagnostics_);
    if (!configured) return;
    Diagnostics ignored;
    const bool differs = configured != data(*fields.default_value, entry, ignored);
    values_.push_back({&entry, std::move(*configured), differs, fields.parameter_value->position});
  }

  [[nodiscard]] std::optional<std::string> data(const Field& field, const Entry& entry,
                                                Diagnostics& diagnostics) const {
    const auto value = parse_value(field, *entry.type, device_.node_id, diagnostics);
    if (!value) return std::nullopt;
    if (value->plus_node_id) {
      diagnostics.error(
          "node-id", field.position,
          fmt::format("{} depends on the node-ID, which is not known", entry_label(entry.index, entry.sub_index)));
      return std::nullopt;
    }
    return bytes_of(*value, *entry.type);
  }

  const DataSheet& sheet_;
  const Device& device_;
  Diagnostics& diagnostics_;
  std::vector<ConfiguredValue> values_;
};

}  // namespace

std::vector<ConfiguredValue> configured_values(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics) {
  return Configuration(sheet, device, diagnostics).collect();
}

}  // namespace edsc

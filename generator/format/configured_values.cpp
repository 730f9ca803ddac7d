#include "format/configured_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/value.hpp"
#include "eds/number.hpp"
#include "format/section_order.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;

class Configuration {
 public:
  Configuration(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics)
      : sheet_(sheet), device_(device), diagnostics_(diagnostics) {}

  std::vector<ConfiguredValue> collect() {
    for (const Object& object : device_.objects) {
      const ObjectDescription* const description = find_object(sheet_, object.index);
      for (const Entry& entry : object.entries) {
        if (description != nullptr && canopen::writable(entry.access)) add(entry, *description);
      }
    }
    return std::move(values_);
  }

 private:
  /// The two fields of an entry; null if missing.
  struct Fields {
    const Field* default_value = nullptr;
    const Field* parameter_value = nullptr;
  };

  static Fields fields_of(const EntryDescription& description) {
    return {&description.default_value, &description.parameter_value};
  }

  /// The values of a compact form are ParameterValues in a DCF, and default values in an EDS.
  [[nodiscard]] Fields fields_of(const Entry& entry, const ObjectDescription& object) const {
    const auto sub = std::ranges::find(object.sub_objects, entry.sub_index, &SubObjectDescription::sub_index);
    if (sub != object.sub_objects.end()) return fields_of(*sub);
    const Object* const resolved = device_.find(entry.index);
    if (!resolved->has_sub_indices()) return fields_of(object);
    if (entry.sub_index == 0) return {};
    Fields fields = fields_of(object);
    const auto value = std::ranges::find(object.compact_values, entry.sub_index, &NumberedField::number);
    if (value != object.compact_values.end()) {
      (sheet_.is_dcf ? fields.parameter_value : fields.default_value) = &value->field;
    }
    return fields;
  }

  void add(const Entry& entry, const ObjectDescription& object) {
    if (entry.type->kind == DataClass::domain) return;
    const Fields fields = fields_of(entry, object);
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
    return data_of(*value, *entry.type);
  }

  const DataSheet& sheet_;
  const Device& device_;
  Diagnostics& diagnostics_;
  std::vector<ConfiguredValue> values_;
};

}  // namespace

std::string data_of(const Value& value, const canopen::DataTypeRow& type) {
  std::string data;
  if (type.type == DataType::unicode_string) {
    for (const char16_t unit : to_utf16(value.bytes)) append_bytes(data, unit, 2);
  } else if (type.kind == DataClass::string) {
    data = value.bytes;
  } else {
    append_bytes(data, value.bits, (type.bits + 7U) / 8U);
  }
  return data;
}

std::vector<ConfiguredValue> configured_values(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics) {
  return Configuration(sheet, device, diagnostics).collect();
}

void append_bytes(std::string& bytes, std::uint64_t number, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes += static_cast<char>(number >> (8 * i));
}

}  // namespace edsc

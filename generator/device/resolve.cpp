#include "device/resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/complete_device.hpp"
#include "device/index_range.hpp"
#include "device/limits.hpp"
#include "device/meaning/resolve_meaning.hpp"
#include "device/objects/entry_resolver.hpp"
#include "device/objects/object_resolver.hpp"
#include "device/objects/resolve_modules.hpp"
#include "device/pdo/resolve_pdos.hpp"
#include "device/resolve_information.hpp"
#include "device/stored_eds.hpp"
#include "device/types/shifted_types.hpp"
#include "device/types/type_table.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

class Resolver {
 public:
  Resolver(const DataSheet& sheet, const Options& options, const std::optional<std::uint8_t>& node_id,
           Diagnostics& diagnostics)
      : sheet_{sheet}, options_{options}, node_id_{node_id}, diagnostics_{diagnostics} {}

  Device resolve() {
    device_.source = sheet_.source;
    device_.node_id = node_id_ ? node_id_ : commissioned_node_id();
    device_.information = resolve_information(sheet_, options_, diagnostics_);
    resolve_identity();
    for (const NumberedField& dummy : sheet_.dummy_usage) {
      if (number_of(dummy.field).value_or(0) != 0) {
        device_.dummies.push_back(static_cast<std::uint16_t>(dummy.number));
      }
    }
    report_shifted_types(sheet_, diagnostics_);
    resolve_objects();
    complete_device(device_, options_, diagnostics_);
    check_option_keys();
    apply_names();
    resolve_meaning(device_, options_, diagnostics_);
    resolve_pdos(device_, options_);
    mark_broken_pdos(device_, options_, diagnostics_);
    resolve_stored_eds(device_, options_, diagnostics_);
    check_settable_mappings();
    return std::move(device_);
  }

 private:
  /// NodeID of a DCF; 0 and 255 mean none.
  std::optional<std::uint8_t> commissioned_node_id() {
    const Field& field = sheet_.commissioning.node_id;
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) return std::nullopt;
    const auto number = parse_unsigned(text);
    if (number && *number >= 1 && *number <= 127) return static_cast<std::uint8_t>(*number);
    if (!number || (*number != 0 && *number != 255)) {
      diagnostics_.error("node-id", field.position, fmt::format("NodeID {} is not in 1..127", quote(text)));
    }
    return std::nullopt;
  }

  void resolve_identity() {
    const DeviceInfo& info = sheet_.device_info;
    device_.vendor_name = info.vendor_name.text;
    device_.product_name = info.product_name.text;
    device_.vendor_number = read_number(info.vendor_number, "device-info", diagnostics_).value_or(0);
    device_.product_number = read_number(info.product_number, "device-info", diagnostics_).value_or(0);
    device_.revision_number = read_number(info.revision_number, "device-info", diagnostics_).value_or(0);
  }

  void resolve_objects() {
    const TypeTable types{sheet_, device_.node_id, diagnostics_};
    EntryResolver entries{types, sheet_.is_dcf, device_.node_id, diagnostics_};
    ObjectResolver objects{entries, sheet_.is_dcf, diagnostics_};
    device_.objects.reserve(sheet_.objects.size());
    for (const ObjectDescription& description : sheet_.objects) {
      if (description.index < first_communication_index) continue;
      auto object = objects.resolve(description);
      if (!object) continue;
      device_.objects.push_back(std::move(*object));
      if (!has_room(description)) break;
    }
    device_.types = types.definitions();
    add_modules(sheet_.modules, objects, entries, device_, diagnostics_);
    add_compact_pdos(sheet_.device_info, device_, diagnostics_);
  }

  /// Whether more objects may follow.
  bool has_room(const ObjectDescription& last) {
    entries_ += device_.objects.back().entries.size();
    if (entries_ <= max_entries) return true;
    diagnostics_.error("dictionary-size", last.position,
                       fmt::format("a device can have at most {} entries; everything after {} is ignored", max_entries,
                                   index_label(last.index)));
    return false;
  }

  /// Options must refer to existing entries.
  void check_option_keys() {
    const auto check = [&](const EntryKey& key, std::string_view option) {
      if (device_.find(key.first, key.second) != nullptr) return;
      diagnostics_.error(
          "options", Position{sheet_.source},
          fmt::format("option {} names {}, which is not in the EDS", option, entry_label(key.first, key.second)));
    };
    for (const auto& [key, name] : options_.names) check(key, "names");
    for (const auto& [key, capacity] : options_.string_capacity) check(key, "string_capacity");
    for (const EntryKey& key : options_.settable) check(key, "settable");
    for (const EntryAddress& entry : options_.no_event) {
      if (entry.sub_index) {
        check({entry.index, *entry.sub_index}, "pdo.no_event");
      } else {
        check_object(entry.index, "pdo.no_event");
      }
    }
    const auto check_stored = [&](const EntryAddress& entry, std::string_view option) {
      entry.sub_index ? check({entry.index, *entry.sub_index}, option) : check_object(entry.index, option);
    };
    for (const auto& [entry, sub_index] : options_.stored_by) check_stored(entry, "storage.sub_indices");
    for (const std::uint16_t index : options_.static_mapping.parameters) check_object(index, "pdo.static_mapping");
  }

  /// The names that the options give, for the texts of all commands. Sub-index 0 is the object.
  void apply_names() {
    const auto rename = [](auto& named, const std::string& name) {
      if (named.name != name) named.replaced_name = std::exchange(named.name, name);
    };
    for (const auto& [key, name] : options_.names) {
      const auto object = std::ranges::lower_bound(device_.objects, key.first, {}, &Object::index);
      if (object == device_.objects.end() || object->index != key.first) continue;
      if (key.second == 0) rename(*object, name);
      if (key.second == 0 && object->has_sub_indices()) continue;
      const auto entry = std::ranges::find(object->entries, key.second, &Entry::sub_index);
      if (entry != object->entries.end()) rename(*entry, name);
    }
  }

  void check_object(std::uint16_t index, std::string_view option) {
    if (device_.find(index) != nullptr) return;
    diagnostics_.error("options", Position{sheet_.source},
                       fmt::format("option {} names {}, which is not in the EDS", option, index_label(index)));
  }

  /// A mapping parameter is completely in RAM, or not at all.
  void check_settable_mappings() {
    for (const EntryKey& key : options_.settable) {
      if (!contains(mapping_parameters, key.first)) continue;
      const auto pdo = std::ranges::find_if(
          device_.pdos, [&](const Pdo& one) { return one.mapping != nullptr && one.mapping->index == key.first; });
      if (pdo == device_.pdos.end() || pdo->dynamic) continue;
      diagnostics_.error("options", Position{sheet_.source},
                         fmt::format("option settable names {}, but the mapping of {} is static: all of {} must be "
                                     "writable or settable",
                                     entry_label(key.first, key.second), pdo_label(*pdo), index_label(key.first)));
    }
  }

  const DataSheet& sheet_;
  const Options& options_;
  const std::optional<std::uint8_t>& node_id_;
  Diagnostics& diagnostics_;
  Device device_;
  std::size_t entries_ = 0;
};

}  // namespace

Device resolve_device(const DataSheet& sheet, const Options& options, const std::optional<std::uint8_t>& node_id,
                      Diagnostics& diagnostics) {
  return Resolver{sheet, options, node_id, diagnostics}.resolve();
}

}  // namespace edsc

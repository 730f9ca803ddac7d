#include "configure/saved_dcf.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "device/index_range.hpp"
#include "device/resolve.hpp"
#include "eds/ini.hpp"
#include "format/canonical_form.hpp"
#include "format/dcf/configured_values.hpp"
#include "format/dcf/parameter_text.hpp"
#include "format/section_order.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

/// The bytes of a value as a DCF holds them: a VISIBLE_STRING without trailing 00h.
std::string bytes_in_dcf(const Entry& entry, const std::vector<std::uint8_t>& bytes) {
  std::string value{bytes.begin(), bytes.end()};
  if (entry.type->type == canopen::DataType::visible_string) {
    while (value.ends_with('\0')) value.pop_back();
  }
  return value;
}

/// Whether the value is the default value of the EDS for this node.
bool is_default(const Entry& entry, const std::vector<std::uint8_t>& bytes) {
  return entry.default_value && bytes_in_dcf(entry, bytes) == bytes_of(*entry.default_value, *entry.type);
}

/// Whether the element of a compact form does not have its own section.
bool is_compact(const DataSheet& sheet, const LiveEntry& entry) {
  const ObjectDescription* object = sheet.find(entry.index);
  if (object == nullptr || entry.sub_index == 0 || !object->compact_sub_obj.present) return false;
  return std::ranges::find(object->sub_objects, entry.sub_index, &SubObjectDescription::sub_index) ==
         object->sub_objects.end();
}

/// Chooses the values that differ from the EDS.
class Choice {
 public:
  explicit Choice(const SavedDcfInput& input) {
    note_parameter_values(input);
    for (const ReadValue& value : input.found.values) {
      const std::uint16_t index = value.entry.index;
      const bool belongs_together = contains(mapping_parameters, index) || is_compact(input.sheet, value.entry);
      if (belongs_together && !has_default(value)) whole_.insert(index);
    }
  }

  [[nodiscard]] bool takes(const ReadValue& value) const {
    return whole_.contains(value.entry.index) || !has_default(value);
  }

 private:
  /// With a DCF, the default values of the device are the ParameterValues.
  void note_parameter_values(const SavedDcfInput& input) {
    if (!input.sheet.is_dcf) return;
    Diagnostics ignored;
    for (const ConfiguredValue& value : configured_values(input.sheet, input.device, ignored)) {
      if (value.differs) not_default_.insert(value.entry);
    }
  }

  [[nodiscard]] bool has_default(const ReadValue& value) const {
    return !not_default_.contains(value.entry.entry) && is_default(*value.entry.entry, value.bytes);
  }

  std::set<const Entry*> not_default_;
  std::set<std::uint16_t> whole_;  ///< objects with all values saved: mappings and compact forms
};

void report_not_expressible(const ReadValue& value, SavedDcf& saved) {
  saved.missing.push_back({value.entry, "a DCF cannot hold the value " + value_of(value.entry, value.bytes)});
}

void choose_values(const SavedDcfInput& input, SavedDcf& saved) {
  const Choice choice{input};
  for (const ReadValue& value : input.found.values) {
    const Entry& entry = *value.entry.entry;
    const bool by_clause = entry.default_value && !entry.default_value->clause.empty();
    if (!(input.all && !by_clause) && !choice.takes(value)) continue;
    if (auto text = parameter_text(entry, value.bytes)) {
      saved.values[&entry] = std::move(*text);
    } else if (!value.bytes.empty() || entry.type->bits != 0) {
      report_not_expressible(value, saved);
    }
  }
}

/// The entries whose ParameterValue in the source is ignored: those that are read, and 1020h, which would have the date
/// of the source.
std::set<const Entry*> known_entries(const Device& device) {
  std::set<const Entry*> known;
  for (const LiveEntry& entry : configuration_entries(device)) known.insert(entry.entry);
  if (const Object* const date = device.find(0x1020)) {
    for (const Entry& entry : date->entries) known.insert(&entry);
  }
  return known;
}

std::string dcf_text(const SavedDcfInput& input, const ParameterValues& values) {
  Diagnostics ignored;
  const IniFile ini = parse_ini(input.source, ignored);
  Document document = canonical_form(ini, input.sheet, input.device);
  make_dcf(document, input.sheet, input.device, {values, known_entries(input.device)}, input.bit_rate);
  return to_text(document);
}

/// The values that a reader of the DCF gets, by address.
std::map<std::pair<std::uint16_t, std::uint8_t>, std::string> values_in(const std::string& text, std::uint8_t node) {
  Diagnostics ignored;
  const SourceFile source{"saved.dcf", text};
  const IniFile ini = parse_ini(source, ignored);
  const DataSheet sheet = read_data_sheet(ini, ignored);
  const Device device = resolve_device(sheet, {}, node, ignored);
  std::map<std::pair<std::uint16_t, std::uint8_t>, std::string> values;
  for (ConfiguredValue& value : configured_values(sheet, device, ignored)) {
    values[{value.entry->index, value.entry->sub_index}] = std::move(value.data);
  }
  return values;
}

/// Writes the DCF, reads it back, and writes it again without the values that it does not preserve.
void make_text(const SavedDcfInput& input, SavedDcf& saved) {
  saved.text = dcf_text(input, saved.values);
  const auto held = values_in(saved.text, input.node);
  bool complete = true;
  for (const ReadValue& value : input.found.values) {
    const auto chosen = saved.values.find(value.entry.entry);
    if (chosen == saved.values.end()) continue;
    const auto read = held.find({value.entry.index, value.entry.sub_index});
    if (read != held.end() && read->second == bytes_in_dcf(*value.entry.entry, value.bytes)) continue;
    report_not_expressible(value, saved);
    saved.values.erase(chosen);
    complete = false;
  }
  if (!complete) saved.text = dcf_text(input, saved.values);
}

}  // namespace

SavedDcf make_saved_dcf(const SavedDcfInput& input) {
  SavedDcf saved;
  for (const UnreadValue& unread : input.found.unread) {
    saved.missing.push_back({unread.entry, failure_text(unread.outcome)});
  }
  choose_values(input, saved);
  make_text(input, saved);
  return saved;
}

}  // namespace edsc

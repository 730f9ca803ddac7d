#include "format/dcf/make_dcf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "device/index_range.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "format/dcf/configured_values.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"
#include "format/spelling/spell_section.hpp"
#include "values/read_value.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

DocumentEntry* find_entry(DocumentSection& section, std::string_view key) {
  const auto at = std::ranges::find(section.entries, key, &DocumentEntry::key);
  return at != section.entries.end() ? &*at : nullptr;
}

/// Sets the value of a key; a new key is inserted at its place in CiA 306.
void set(DocumentSection& section, std::string_view key, std::string value) {
  if (DocumentEntry* const entry = find_entry(section, key)) {
    entry->value = std::move(value);
    return;
  }
  const std::uint64_t order = spell_key(section.kind, key).order;
  const auto place = std::ranges::find_if(
      section.entries, [&](const DocumentEntry& entry) { return spell_key(section.kind, entry.key).order > order; });
  section.entries.insert(place, {{}, std::string{key}, std::move(value)});
}

/// Removes a key; its comments move to the next key, or to the section.
void remove(DocumentSection& section, std::string_view key) {
  DocumentEntry* const entry = find_entry(section, key);
  if (entry == nullptr) return;
  const auto at = section.entries.begin() + (entry - section.entries.data());
  append(std::next(at) != section.entries.end() ? std::next(at)->remarks : section.remarks, entry->remarks);
  section.entries.erase(at);
}

class DcfMaker {
 public:
  DcfMaker(Document& document, const DataSheet& sheet, const Device& device, DcfValues values)
      : document_(document), sheet_(sheet), device_(device), values_(values) {
    if (values == DcfValues::different) compare_with_defaults();
  }

  DcfMaker(Document& document, const DataSheet& sheet, const Device& device, const GivenValues& given,
           std::optional<unsigned> bit_rate)
      : document_(document),
        sheet_(sheet),
        device_(device),
        values_(DcfValues::all),
        given_(&given),
        bit_rate_(bit_rate) {}

  void make() {
    commission();
    if (given_ != nullptr) write_compact_values();
    drop_commands();
    for (DocumentSection& section : document_.sections) {
      if (section.kind.kind == SectionKind::file_info && !sheet_.is_dcf) set_last_eds(section);
      if (section.kind.kind == SectionKind::object) configure_object(section);
      if (section.kind.kind == SectionKind::sub_object) configure(section, section.kind.sub_index);
      if (section.kind.kind == SectionKind::compact_values) configure_compact_values(section);
    }
  }

 private:
  /// Removes the values of commands, which a tool that loads the DCF would send.
  void drop_commands() {
    for (DocumentSection& section : document_.sections) {
      if (is_command(section)) remove(section, "ParameterValue");
    }
    std::erase_if(document_.sections, [](const DocumentSection& section) {
      return section.kind.kind == SectionKind::compact_values && is_command(section);
    });
  }

  static bool is_command(const DocumentSection& section) {
    constexpr SectionKind kinds[] = {SectionKind::object, SectionKind::sub_object, SectionKind::compact_values};
    return std::ranges::find(kinds, section.kind.kind) != std::end(kinds) &&
           contains(command_objects, section.kind.index);
  }

  void commission() {
    DocumentSection& section = commissioning_section();
    set(section, "NodeID", fmt::format("{}", device_.node_id.value_or(0)));
    constexpr std::pair<std::string_view, std::string_view> defaults[] = {
        {"NodeName", ""}, {"NetNumber", "0"}, {"NetworkName", ""}, {"CANopenManager", "0"}};
    for (const auto& [key, value] : defaults) {
      if (find_entry(section, key) == nullptr) set(section, key, std::string{value});
    }
    const std::string rate = bit_rate_ ? fmt::format("{}", *bit_rate_) : only_baud_rate();
    if ((bit_rate_ || find_entry(section, "Baudrate") == nullptr) && !rate.empty()) set(section, "Baudrate", rate);
  }

  DocumentSection& commissioning_section() {
    constexpr SectionKind kind = SectionKind::device_commissioning;
    for (DocumentSection& section : document_.sections) {
      if (section.kind.kind == kind) return section;
    }
    const auto place = std::ranges::find_if(document_.sections, [](const DocumentSection& section) {
      return place_of_section(section.kind.kind) > place_of_section(kind);
    });
    if (place == document_.sections.begin()) give_up_first_place(document_);
    DocumentSection added;
    added.kind.kind = kind;
    added.title = spell_section_name(added.kind);
    return *document_.sections.insert(place, std::move(added));
  }

  /// The bit rate of a device that supports only one; unknown if it supports several.
  [[nodiscard]] std::string only_baud_rate() const {
    std::string only;
    for (const DeviceInfo::BaudRate& rate : sheet_.device_info.baud_rates) {
      if (number_of(rate.field).value_or(0) == 0) continue;
      if (!only.empty()) return {};
      only = fmt::format("{}", rate.kbit_per_second);
    }
    return only;
  }

  void set_last_eds(DocumentSection& file_info) {
    const DocumentEntry* const name = find_entry(file_info, "FileName");
    if (name != nullptr) set(file_info, "LastEDS", std::string{name->value});
  }

  /// The section of a compact form describes many entries and cannot have a value for one.
  void configure_object(DocumentSection& section) {
    const Object* const object = device_.find(section.kind.index);
    if (object == nullptr || object->has_sub_indices()) {
      drop_meaningless_value(section);
      return;
    }
    configure(section, 0);
  }

  /// Finds the ParameterValues of a DCF that equal the default values, and the mapping parameters in which one does
  /// not, since their number and entries belong together.
  void compare_with_defaults() {
    if (!sheet_.is_dcf) return;
    Diagnostics ignored;
    const auto configured = configured_values(sheet_, device_, ignored);
    for (const ConfiguredValue& value : configured) {
      const bool mapping = (value.entry->index & 0xFE00) == 0x1600 || (value.entry->index & 0xFE00) == 0x1A00;
      if (!value.differs) defaults_.insert(value.entry);
      if (value.differs && mapping) whole_.insert(value.entry->index);
    }
  }

  /// Whether the entry has a ParameterValue in the DCF, given whether it has one in the file.
  [[nodiscard]] bool is_wanted(const Entry& entry, bool has_value) const {
    if (values_ == DcfValues::all || whole_.contains(entry.index)) return true;
    return has_value && !defaults_.contains(&entry);
  }

  /// A ParameterValue has no meaning in an EDS, but would have in the DCF.
  void drop_meaningless_value(DocumentSection& section) {
    if (!sheet_.is_dcf) remove(section, "ParameterValue");
  }

  /// The elements of compact forms have their values in one section for each object.
  void write_compact_values() {
    std::map<std::uint16_t, std::vector<DocumentEntry>> compact;
    for (const auto& [entry, text] : given_->values) {
      const ObjectDescription* const object = sheet_.find(entry->index);
      if (object == nullptr || !is_element(*object, entry->sub_index)) continue;
      compact[entry->index].push_back({{}, fmt::format("{}", entry->sub_index), text});
    }
    for (auto& [index, values] : compact) {
      std::ranges::sort(values, {}, [](const DocumentEntry& value) { return std::stoul(value.key); });
      values.insert(values.begin(), {{}, "NrOfEntries", fmt::format("{}", values.size())});
      compact_values_section(index).entries = std::move(values);
    }
  }

  /// Whether a sub-index does not have its own section.
  static bool is_element(const ObjectDescription& object, std::uint8_t sub_index) {
    return sub_index != 0 && object.compact_sub_obj.present && object.find(sub_index) == nullptr;
  }

  DocumentSection& compact_values_section(std::uint16_t index) {
    auto place = document_.sections.begin();
    for (auto at = document_.sections.begin(); at != document_.sections.end(); ++at) {
      constexpr SectionKind kinds[] = {SectionKind::object, SectionKind::sub_object, SectionKind::compact_names};
      if (at->kind.index != index) continue;
      if (at->kind.kind == SectionKind::compact_values) return *at;
      if (std::ranges::find(kinds, at->kind.kind) != std::end(kinds)) place = std::next(at);
    }
    DocumentSection added;
    added.kind.kind = SectionKind::compact_values;
    added.kind.index = index;
    added.title = spell_section_name(added.kind);
    return *document_.sections.insert(place, std::move(added));
  }

  /// The canonical spelling depends on the DataType in the file; the device can have another type, that of CiA 301.
  void set_parameter_value(DocumentSection& section, std::string text) {
    set(section, "ParameterValue", std::move(text));
    spell_section(section, sheet_, device_);
  }

  void configure_as_given(DocumentSection& section, std::uint8_t sub_index) {
    const Entry* const entry = device_.find(section.kind.index, sub_index);
    const auto given = given_->values.find(entry);
    if (given != given_->values.end()) return set_parameter_value(section, given->second);
    if (!sheet_.is_dcf || given_->known.contains(entry)) remove(section, "ParameterValue");
  }

  void configure(DocumentSection& section, std::uint8_t sub_index) {
    if (given_ != nullptr) return configure_as_given(section, sub_index);
    drop_meaningless_value(section);
    if (is_command(section)) return;
    const Entry* const entry = device_.find(section.kind.index, sub_index);
    if (entry == nullptr || !entry->default_value || !canopen::writable(entry->access)) return;
    if (!entry->default_value->clause.empty()) {
      // The device has the value of CiA 301; that of the file would be wrong.
      remove(section, "ParameterValue");
      return;
    }
    const DocumentEntry* source = find_entry(section, "ParameterValue");
    const bool has_value = source != nullptr && !source->value.empty();
    if (!is_wanted(*entry, has_value)) {
      remove(section, "ParameterValue");
      return;
    }
    if (!has_value) source = find_entry(section, "DefaultValue");
    if (source == nullptr || source->value.empty()) return;
    set_parameter_value(section, resolved(source->value, *entry));
  }

  void configure_compact_values(DocumentSection& section) {
    if (given_ != nullptr) return;
    for (DocumentEntry& value : section.entries) {
      const KeySpelling key = spell_key(section.kind, value.key);
      if (!key.is_known || key.value != ValueKind::typed || key.number > 0xFF) continue;
      const Entry* const entry = device_.find(section.kind.index, static_cast<std::uint8_t>(key.number));
      if (entry != nullptr && canopen::writable(entry->access)) value.value = resolved(value.value, *entry);
    }
  }

  /// A formula as its value for this node; other values unchanged.
  [[nodiscard]] std::string resolved(const std::string& value, const Entry& entry) const {
    if (value.find('$') == std::string::npos || entry.type->kind == canopen::DataClass::string) return value;
    Diagnostics ignored;
    const auto number = parse_value({value, {}, true}, *entry.type, device_.node_id, ignored);
    if (!number) return value;
    return fmt::format("0x{:0{}X}", number->bits & low_bits(entry.type->bits), hex_digits_of(*entry.type));
  }

  Document& document_;
  const DataSheet& sheet_;
  const Device& device_;
  DcfValues values_;
  const GivenValues* given_ = nullptr;  ///< the ParameterValues; null: from the file and `values_`
  std::optional<unsigned> bit_rate_;
  std::set<const Entry*> defaults_;  ///< with a ParameterValue that equals the default value
  std::set<std::uint16_t> whole_;    ///< mapping parameters of which all entries get a ParameterValue
};

}  // namespace

void make_dcf(Document& document, const DataSheet& sheet, const Device& device, DcfValues values) {
  DcfMaker(document, sheet, device, values).make();
}

void make_dcf(Document& document, const DataSheet& sheet, const Device& device, const GivenValues& given,
              std::optional<unsigned> bit_rate) {
  DcfMaker(document, sheet, device, given, bit_rate).make();
}

}  // namespace edsc

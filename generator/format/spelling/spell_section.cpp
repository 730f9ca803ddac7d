#include "format/spelling/spell_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "eds/number.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"

namespace edsc {
namespace {

struct SpelledEntry {
  KeySpelling key;
  DocumentEntry entry;
};

class SectionSpeller {
 public:
  SectionSpeller(DocumentSection& section, const DataSheet& sheet, const Device& device)
      : section_(section), sheet_(sheet), device_(device) {}

  void spell() {
    section_.title = spell_section_name(section_.kind);
    for (DocumentEntry& entry : section_.entries) take(std::move(entry));
    for (SpelledEntry& entry : entries_) spell_entry(entry);
    std::ranges::stable_sort(entries_, {}, [](const SpelledEntry& entry) { return entry.key.order; });
    section_.entries.clear();
    for (SpelledEntry& entry : entries_) section_.entries.push_back(std::move(entry.entry));
  }

 private:
  void take(DocumentEntry entry) {
    KeySpelling key = spell_key(section_.kind, entry.key);
    if (key.is_known) {
      const auto [first, is_new] = first_.try_emplace(key.identity, entries_.size());
      if (!is_new) {
        append(entries_[first->second].entry.remarks, entry.remarks);
        return;
      }
    }
    numbered_ += key.is_numbered ? 1 : 0;
    entry.key = key.name;
    entries_.push_back({std::move(key), std::move(entry)});
  }

  void spell_entry(SpelledEntry& spelled) {
    DocumentEntry& entry = spelled.entry;
    const ValueSpelling value = spell(spelled.key, entry.value);
    if (!value.remark.empty()) entry.remarks.push_back(remark_line(value.remark));
    entry.value = value.text;
  }

  [[nodiscard]] ValueSpelling spell(const KeySpelling& key, const std::string& value) const {
    switch (key.value) {
      case ValueKind::text: break;
      case ValueKind::access: return spell_access(value);
      case ValueKind::index_range: return spell_index_range(value, key.hex_digits);
      case ValueKind::module_count: return spell_module_count(value);
      case ValueKind::count: return {fmt::format("{}", numbered_), inline_comment(value)};
      case ValueKind::parts: return {fmt::format("{}", count_parts()), inline_comment(value)};
      case ValueKind::number:
        if (key.name == "SubNumber") return sub_number(value);
        return spell_number(value, key.hex_digits);
      case ValueKind::typed:
        if (const canopen::DataTypeRow* const type = type_of(key)) return spell_value(value, *type);
        break;
    }
    return {value, {}};
  }

  /// The tools, modules or segments that the file describes.
  [[nodiscard]] std::size_t count_parts() const {
    switch (section_.kind.kind) {
      case SectionKind::tools: return sheet_.tools.size();
      case SectionKind::dynamic_channels: return sheet_.dynamic_channels.segments.size();
      default: return sheet_.modules.supported.size();
    }
  }

  /// The object to which the section belongs, of the device or of a module; null if there is none.
  [[nodiscard]] const ObjectDescription* described_object() const {
    const SectionName& name = section_.kind;
    if (!is_in_module()) return sheet_.find(name.index);
    const auto& modules = sheet_.modules.supported;
    const auto module = std::ranges::lower_bound(modules, name.number, {}, &ModuleDescription::number);
    if (module == modules.end() || module->number != name.number) return nullptr;
    const auto object = std::ranges::lower_bound(module->objects, name.index, {}, &ObjectDescription::index);
    return object != module->objects.end() && object->index == name.index ? &*object : nullptr;
  }

  /// The number of described sub-objects, in the base of the old number, which remains for a compact form.
  [[nodiscard]] ValueSpelling sub_number(const std::string& value) const {
    ValueSpelling spelling = spell_number(value, 1);
    const ObjectDescription* const object = described_object();
    if (object == nullptr || number_of(object->compact_sub_obj).value_or(0) > 0) {
      return spelling;
    }
    const bool is_hexadecimal = spelling.text.starts_with("0x");
    const std::size_t count = object->sub_objects.size();
    spelling.text = is_hexadecimal ? fmt::format("0x{:X}", count) : fmt::format("{}", count);
    return spelling;
  }

  /// Whether the section describes a module, whose objects a device has only if the module is connected.
  [[nodiscard]] bool is_in_module() const { return is_module_section(section_.kind.kind); }

  /// The type of an entry's values; null if unknown: the values are then unchanged.
  [[nodiscard]] const canopen::DataTypeRow* type_of(const KeySpelling& key) const {
    const SectionName& name = section_.kind;
    if (is_in_module()) {
      const canopen::DataTypeRow* const own = own_type();
      return own != nullptr || name.kind == SectionKind::module_sub_extension ? own : type_in_module();
    }
    if (name.kind == SectionKind::compact_values) {
      return key.number <= 0xFF ? type_in_device(static_cast<std::uint8_t>(key.number)) : nullptr;
    }
    if (const canopen::DataTypeRow* const own = own_type()) return own;
    if (name.kind == SectionKind::sub_object) return type_in_device(name.sub_index);
    const Object* const object = device_.find(name.index);
    return object != nullptr && !object->has_sub_indices() ? type_in_device(0) : nullptr;
  }

  /// The basic type that the object of a module states for its sub-objects and for the elements of a compact form.
  [[nodiscard]] const canopen::DataTypeRow* type_in_module() const {
    const ObjectDescription* const object = described_object();
    return object != nullptr ? basic_type(object->data_type.text) : nullptr;
  }

  [[nodiscard]] static const canopen::DataTypeRow* basic_type(std::string_view text) {
    const auto code = parse_unsigned(strip_inline_comment(text));
    return code && *code <= 0xFFFF ? canopen::find_data_type(static_cast<std::uint32_t>(*code)) : nullptr;
  }

  /// The type of DataType in the section, if it is a basic type.
  [[nodiscard]] const canopen::DataTypeRow* own_type() const {
    for (const SpelledEntry& entry : entries_) {
      if (entry.key.name != "DataType") continue;
      return basic_type(entry.entry.value);
    }
    return nullptr;
  }

  [[nodiscard]] const canopen::DataTypeRow* type_in_device(std::uint8_t sub_index) const {
    const Entry* const entry = device_.find(section_.kind.index, sub_index);
    return entry != nullptr ? entry->type : nullptr;
  }

  DocumentSection& section_;
  const DataSheet& sheet_;
  const Device& device_;
  std::vector<SpelledEntry> entries_;
  std::unordered_map<std::uint64_t, std::size_t> first_;  ///< entry by the identity of its key
  std::size_t numbered_ = 0;                              ///< entries with a number for a key
};

bool is_spelled(SectionKind kind) {
  return is_known(kind) && !is_object_list(kind);  // the lists are rewritten
}

}  // namespace

void spell_section(DocumentSection& section, const DataSheet& sheet, const Device& device) {
  if (is_spelled(section.kind.kind)) SectionSpeller(section, sheet, device).spell();
}

}  // namespace edsc

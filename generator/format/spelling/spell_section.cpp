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
    section_.title = spell_title(section_.kind, section_.title);
    for (DocumentEntry& entry : section_.entries) take(std::move(entry));
    for (SpelledEntry& entry : entries_) spell_entry(entry);
    std::ranges::stable_sort(entries_, {}, [](const SpelledEntry& entry) { return entry.key.order; });
    section_.entries.clear();
    for (SpelledEntry& entry : entries_) section_.entries.push_back(std::move(entry.entry));
  }

 private:
  void take(DocumentEntry entry) {
    KeySpelling key = spell_key(section_.kind.kind, entry.key);
    if (key.is_known) {
      const auto [first, is_new] = first_.try_emplace(key.order, entries_.size());
      if (!is_new) {
        append(entries_[first->second].entry.remarks, entry.remarks);
        return;
      }
    }
    numbered_ += key.number != 0 || key.name == "0" ? 1 : 0;
    entry.key = key.name;
    entries_.push_back({std::move(key), std::move(entry)});
  }

  void spell_entry(SpelledEntry& spelled) {
    DocumentEntry& entry = spelled.entry;
    const Spelling value = spell(spelled.key, entry.value);
    if (!value.remark.empty()) entry.remarks.push_back(remark_line(value.remark));
    entry.value = value.text;
  }

  [[nodiscard]] Spelling spell(const KeySpelling& key, const std::string& value) const {
    switch (key.value) {
      case ValueKind::text: break;
      case ValueKind::access: return spell_access(value);
      case ValueKind::count: return {fmt::format("{}", numbered_), {}};
      case ValueKind::number:
        if (key.name == "SubNumber") return sub_number(value);
        return spell_number(value, key.hex_digits);
      case ValueKind::typed:
        if (const canopen::DataTypeRow* const type = type_of(key)) return spell_value(value, *type);
        break;
    }
    return {value, {}};
  }

  /// The number of described sub-objects, in the base of the old number, which remains for a compact form.
  [[nodiscard]] Spelling sub_number(const std::string& value) const {
    Spelling spelling = spell_number(value, 1);
    const ObjectDescription* const object = sheet_.find(section_.kind.index);
    if (object == nullptr || number_of(object->compact_sub_obj).value_or(0) > 0) {
      return spelling;
    }
    const bool is_hexadecimal = spelling.text.starts_with("0x");
    const std::size_t count = object->sub_objects.size();
    spelling.text = is_hexadecimal ? fmt::format("0x{:X}", count) : fmt::format("{}", count);
    return spelling;
  }

  /// The type of an entry's values; null if unknown: the values are then unchanged.
  [[nodiscard]] const canopen::DataTypeRow* type_of(const KeySpelling& key) const {
    const SectionName& name = section_.kind;
    if (name.kind == SectionKind::compact_values) {
      return key.number <= 0xFF ? type_in_device(static_cast<std::uint8_t>(key.number)) : nullptr;
    }
    if (const canopen::DataTypeRow* const own = own_type()) return own;
    if (name.kind == SectionKind::sub_object) return type_in_device(name.sub_index);
    const Object* const object = device_.find(name.index);
    return object != nullptr && !object->has_sub_indices() ? type_in_device(0) : nullptr;
  }

  /// The type of DataType in the section, if it is a basic type.
  [[nodiscard]] const canopen::DataTypeRow* own_type() const {
    for (const SpelledEntry& entry : entries_) {
      if (entry.key.name != "DataType") continue;
      const auto code = parse_unsigned(strip_inline_comment(entry.entry.value));
      return code && *code <= 0xFFFF ? canopen::find_data_type(static_cast<std::uint32_t>(*code)) : nullptr;
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
  std::unordered_map<std::uint32_t, std::size_t> first_;  ///< entry by the order of its key
  std::size_t numbered_ = 0;                              ///< entries with a number for a key
};

bool is_spelled(SectionKind kind) {
  return kind <= SectionKind::object_links && !is_object_list(kind);  // the lists are rewritten
}

}  // namespace

void spell_section(DocumentSection& section, const DataSheet& sheet, const Device& device) {
  if (is_spelled(section.kind.kind)) SectionSpeller(section, sheet, device).spell();
}

}  // namespace edsc

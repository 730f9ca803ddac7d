/// The parts of a value that its meaning names: the name of an enumeration, the names of masked values, the fields.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/meaning/meaning.hpp"
#include "device/meaning/physical.hpp"

namespace edsc {

/// A part of a value of a word: a masked value, or a field.
struct ValuePart {
  const MaskedGroup* group = nullptr;   ///< null for a field
  const MaskedValue* masked = nullptr;  ///< null for a field
  const BitField* field = nullptr;      ///< null for a masked value
  std::int64_t number = 0;              ///< in the field
  const NamedValue* named = nullptr;    ///< the name of the number; null without one

  [[nodiscard]] std::string_view name() const { return field != nullptr ? field->name : group->name; }
};

/// The type of the number in a field: UNSIGNED64, or INTEGER64 for a signed one.
[[nodiscard]] const canopen::DataTypeRow& type_of(const BitField& field);

/// Calls `visit(ValuePart)` for each part of a value: the masked value of each group that has one, then the fields in
/// the order of their bits, then those of the case. `other` is the value of the object on which the case depends;
/// nothing if it is unknown. Reserved bits are not visited.
template <class Visit>
void for_each_part(const Meaning& meaning, std::uint64_t raw, std::optional<std::int64_t> other, Visit&& visit) {
  for (const MaskedGroup& group : meaning.masked) {
    if (const MaskedValue* const found = group.find(raw)) {
      ValuePart part;
      part.group = &group;
      part.masked = found;
      visit(part);
    }
  }
  const auto visit_fields = [&](const std::vector<BitField>& fields) {
    for (const BitField& field : fields) {
      if (field.is_reserved()) continue;
      ValuePart part;
      part.field = &field;
      part.number = field.of(raw);
      if (field.values) part.named = field.values->find(part.number);
      visit(part);
    }
  };
  visit_fields(meaning.fields);
  const FieldCase* const one = other ? meaning.find_case(*other) : nullptr;
  if (one != nullptr) visit_fields(one->fields);
}

/// Appends a part: `operation_enabled`, `remote`, `gear=3`. Numbers of 8 and more bits are hexadecimal: `can_id=181h`.
void append_part(std::string& text, const ValuePart& part);

/// Appends the parts of a word, separated by `, `: `operation_enabled, remote, gear=3`. Left out are flags that are
/// not set or whose bits a masked value has, and numbers that the hexadecimal digits of the word show.
void append_parts(std::string& text, const Meaning& meaning, std::uint64_t raw,
                  std::optional<std::int64_t> other = std::nullopt);

/// The raw number of a text such as `operation_enabled, remote, gear=3`, separated by commas or `|`: names of masked
/// values, of flags, and of fields with their values. Bits that are not named are 0. A field of a case can have the
/// name of its case before it: `profile_position.halt`. A name of both a masked value and a
/// flag is the masked value at the start of the text, and otherwise the flag. Fails for an unknown name, for two names
/// that need other values of one bit, and for a flag that is a part of such a masked value.
[[nodiscard]] RawNumber parse_parts(const Meaning& meaning, std::string_view text);

}  // namespace edsc

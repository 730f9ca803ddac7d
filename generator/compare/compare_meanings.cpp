#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/compare_parts.hpp"
#include "device/meaning/raw_unit.hpp"

namespace edsc {
namespace {

/// Where a part of a meaning is written; that of a profile has the place of the entry.
Position place_of_part(const MeaningText& part, const Entry& entry) {
  const bool is_in_file = part.source != MeaningSource::profile && part.position.file != nullptr;
  return is_in_file ? part.position : entry.position;
}

/// Bits of a word with a name: a field, or a masked value.
struct NamedBits {
  const BitField* field = nullptr;  ///< null for a masked value
  std::string scope;                ///< the mode or group; empty for the fields of each value
  std::string bits;                 ///< `4..7`, `mask 6Fh, value 27h`
  Position position;
};

std::string bits_of(const BitField& field) {
  const std::string range = field.bits == 1 ? fmt::format("{}", field.first_bit)
                                            : fmt::format("{}..{}", field.first_bit, field.first_bit + field.bits - 1);
  return field.is_signed ? range + " signed" : range;
}

std::string name_of_case(const FieldCase& one) {
  return one.name.empty() ? fmt::format("{}", fmt::join(one.values, ",")) : one.name;
}

/// All named bits of a meaning, by `halt`, `profile_position.new_set_point` or `state=fault`.
std::map<std::string, NamedBits> named_bits(const Meaning& meaning, const Entry& entry) {
  std::map<std::string, NamedBits> found;
  const auto add = [&](const std::string& scope, const std::vector<BitField>& fields) {
    for (const BitField& field : fields) {
      if (field.is_reserved()) continue;
      const std::string name = scope.empty() ? field.name : scope + "." + field.name;
      found[name] = {&field, scope, bits_of(field), place_of_part(field, entry)};
    }
  };
  add("", meaning.fields);
  for (const FieldCase& one : meaning.cases) add(name_of_case(one), one.fields);
  for (const MaskedGroup& group : meaning.masked) {
    for (const MaskedValue& one : group.values) {
      const std::string bits = fmt::format("mask {:X}h, value {:X}h", one.mask, one.value);
      found[group.name + "=" + one.name] = {nullptr, group.name, bits, place_of_part(one, entry)};
    }
  }
  return found;
}

/// The parts from sources that are compared.
Meaning compared_parts(Meaning meaning, const ComparedSources& sources) {
  const auto is_left_out = [&](const MeaningText& part) { return !sources.has(part.source); };
  if (meaning.quantity && is_left_out(*meaning.quantity)) meaning.quantity.reset();
  if (meaning.values && std::ranges::all_of(meaning.values->values, is_left_out)) meaning.values.reset();
  std::erase_if(meaning.fields, is_left_out);
  std::erase_if(meaning.cases, is_left_out);
  std::erase_if(meaning.masked,
                [&](const MaskedGroup& group) { return std::ranges::all_of(group.values, is_left_out); });
  if (meaning.cases.empty()) meaning.depends_on.reset();
  return meaning;
}

/// Whether any part of the device's meanings is from the options.
bool has_options(const Device& device) {
  const auto is_of_options = [](const MeaningText& part) { return part.source == MeaningSource::options; };
  const auto any = [&](const auto& parts) { return std::ranges::any_of(parts, is_of_options); };
  const auto has_any = [&](const Meaning& meaning) {
    return (meaning.quantity && is_of_options(*meaning.quantity)) || (meaning.values && any(meaning.values->values)) ||
           any(meaning.fields) || any(meaning.cases) ||
           std::ranges::any_of(meaning.masked, [&](const MaskedGroup& group) { return any(group.values); });
  };
  return any(device.error_codes) || std::ranges::any_of(device.objects, [&](const Object& object) {
           return std::ranges::any_of(object.entries,
                                      [&](const Entry& entry) { return entry.meaning && has_any(*entry.meaning); });
         });
}

class MeaningComparison {
 public:
  MeaningComparison(const Entry& before, const Entry& after, bool in_pdo, Changes& changes)
      : before_{before}, after_{after}, in_pdo_{in_pdo}, changes_{changes} {}

  void compare(const ComparedSources& sources) {
    const auto of = [&](const Entry& entry) {
      return entry.meaning ? compared_parts(*entry.meaning, sources) : Meaning{};
    };
    const Meaning a = of(before_), b = of(after_);
    const auto is_left_out = [&](const Entry& entry) {
      return entry.meaning && entry.meaning->quantity && !sources.has(entry.meaning->quantity->source);
    };
    // Options that are ignored may replace the keys of the EDS, which the other version shows.
    if (!is_left_out(before_) && !is_left_out(after_)) compare_quantities("", a.quantity, b.quantity);
    compare_values("", a.values, b.values);
    compare_bits(a, b);
    compare_modes(a, b);
  }

 private:
  Change& add(ChangeRule rule, const Position& old_position, const Position& new_position, std::string old_value,
              std::string new_value) {
    Change& change =
        changes_.add(rule, entry_label(after_.index, after_.sub_index), after_.name, old_position, new_position);
    change.old_value = std::move(old_value);
    change.new_value = std::move(new_value);
    if (in_pdo_ && change.breaks.master) change.breaks.pdo = true;
    return change;
  }

  /// `field` is empty for the value of the entry, otherwise `gear: `.
  void compare_quantities(const std::string& field, const std::optional<Quantity>& a,
                          const std::optional<Quantity>& b) {
    const std::string old_text = a ? raw_unit_text(*a) : "", new_text = b ? raw_unit_text(*b) : "";
    if (old_text.empty() && new_text.empty()) return;
    const Position old_place = a ? place_of_part(*a, before_) : before_.position;
    const Position new_place = b ? place_of_part(*b, after_) : after_.position;
    if (old_text.empty()) {
      add("quantity-added", old_place, new_place, "", field + new_text);
    } else if (new_text.empty()) {
      add("quantity-removed", old_place, new_place, field + old_text, "");
    } else if (!has_same_raw_numbers(*a, *b)) {
      add("quantity-changed", old_place, new_place, field + old_text, new_text);
    } else if (a->unit != b->unit) {
      add("quantity-spelled", old_place, new_place, field + old_text, new_text);
    }
  }

  void compare_values(const std::string& field, const std::optional<Enumeration>& a,
                      const std::optional<Enumeration>& b) {
    static const Enumeration none;
    const Enumeration& old_values = a ? *a : none;
    const Enumeration& new_values = b ? *b : none;
    const auto text = [&](const NamedValue& one) { return fmt::format("{}{} {}", field, one.value, one.name); };
    for (const NamedValue& one : old_values.values) {
      const Position place = place_of_part(one, before_);
      const NamedValue* const of_name = new_values.find(one.name);
      const NamedValue* const of_number = new_values.find(one.value);
      if (of_name != nullptr) {
        if (of_name->value != one.value) {
          add("value-changed", place, place_of_part(*of_name, after_), text(one), text(*of_name));
        }
      } else if (of_number != nullptr && old_values.find(of_number->name) == nullptr) {
        add("value-renamed", place, place_of_part(*of_number, after_), text(one), text(*of_number));
      } else {
        const bool is_rejected = new_values.closed && of_number == nullptr;
        Change& change = add("value-removed", place, after_.position, text(one), "");
        change.breaks.master = is_rejected;
        change.breaks.pdo = is_rejected && in_pdo_;
      }
    }
    for (const NamedValue& one : new_values.values) {
      const NamedValue* const of_number = old_values.find(one.value);
      const bool is_renamed = of_number != nullptr && new_values.find(of_number->name) == nullptr;
      if (old_values.find(one.name) != nullptr || is_renamed) continue;
      add("value-added", before_.position, place_of_part(one, after_), "", text(one));
    }
    if (old_values.closed == new_values.closed) return;
    const Position old_place = place_of_part(old_values, before_), new_place = place_of_part(new_values, after_);
    add(new_values.closed ? ChangeRule{"values-closed"} : ChangeRule{"values-opened"}, old_place, new_place, field, "");
  }

  void compare_bits(const Meaning& a, const Meaning& b) {
    const auto old_bits = named_bits(a, before_), new_bits = named_bits(b, after_);
    const auto find_unnamed = [](const NamedBits& bits, const auto& in, const auto& other) {
      return std::ranges::find_if(in, [&](const auto& one) {
        return one.second.bits == bits.bits && one.second.scope == bits.scope && !other.contains(one.first);
      });
    };
    const auto text = [](const auto& one) { return fmt::format("{} (bits {})", one.first, one.second.bits); };
    for (const auto& one : old_bits) {
      const auto& [name, bits] = one;
      if (const auto same = new_bits.find(name); same != new_bits.end()) {
        if (bits.bits != same->second.bits) {
          add("field-moved", bits.position, same->second.position, text(one), text(*same));
        } else {
          compare_fields(name, bits, same->second);
        }
      } else if (const auto renamed = find_unnamed(bits, new_bits, old_bits); renamed != new_bits.end()) {
        add("field-renamed", bits.position, renamed->second.position, text(one), text(*renamed));
      } else {
        add("field-removed", bits.position, after_.position, text(one), "");
      }
    }
    for (const auto& one : new_bits) {
      if (old_bits.contains(one.first) || find_unnamed(one.second, old_bits, new_bits) != old_bits.end()) continue;
      add("field-added", before_.position, one.second.position, "", text(one));
    }
  }

  void compare_fields(const std::string& name, const NamedBits& a, const NamedBits& b) {
    if (a.field == nullptr || b.field == nullptr) return;
    compare_quantities(name + ": ", a.field->quantity, b.field->quantity);
    compare_values(name + ": ", a.field->values, b.field->values);
  }

  void compare_modes(const Meaning& a, const Meaning& b) {
    if (a.depends_on && b.depends_on && a.depends_on != b.depends_on) {
      const auto label = [](const EntryKey& key) { return entry_label(key.first, key.second); };
      add("mode-object", place_of_part(a, before_), place_of_part(b, after_), label(*a.depends_on),
          label(*b.depends_on));
    }
    for (const FieldCase& one : a.cases) {
      const auto same = std::ranges::find_if(
          b.cases, [&](const FieldCase& other) { return name_of_case(other) == name_of_case(one); });
      if (same == b.cases.end() || same->values == one.values) continue;
      add("mode-values", place_of_part(one, before_), place_of_part(*same, after_),
          fmt::format("{} {}", one.name, fmt::join(one.values, ", ")),
          fmt::format("{}", fmt::join(same->values, ", ")));
    }
  }

  const Entry& before_;
  const Entry& after_;
  bool in_pdo_;
  Changes& changes_;
};

}  // namespace

ComparedSources compared_sources(const Device& before, const Device& after) {
  const auto profile = [](const Device& device) {
    const Entry* const type = device.find(0x1000, 0);
    return type != nullptr && type->default_value ? type->default_value->bits & 0xFFFF : 0;
  };
  const bool have_options = has_options(before) && has_options(after);
  return {have_options, have_options && profile(before) == profile(after)};
}

void compare_meanings(const Entry& before, const Entry& after, const MeaningContext& context, Changes& changes) {
  if (before.type != after.type || before.meaning == after.meaning) return;
  MeaningComparison{before, after, context.in_pdo, changes}.compare(context.sources);
}

void compare_error_codes(const Device& before, const Device& after, const ComparedSources& sources, Changes& changes) {
  const auto find = [](const Device& device, std::uint16_t code) -> const ErrorCodeName* {
    const auto at = std::ranges::find(device.error_codes, code, &ErrorCodeName::code);
    return at == device.error_codes.end() ? nullptr : &*at;
  };
  const auto place = [](const ErrorCodeName* code, const Device& device) {
    const bool is_in_file = code != nullptr && code->source != MeaningSource::profile && code->position.file != nullptr;
    return is_in_file ? code->position : Position{device.source};
  };
  const auto add = [&](ChangeRule rule, const ErrorCodeName* a, const ErrorCodeName* b) {
    Change& change = changes.add(rule, fmt::format("EMCY {:04X}h", (a != nullptr ? a : b)->code), "", place(a, before),
                                 place(b, after));
    if (a != nullptr) change.old_value = fmt::format("\"{}\"", a->text);
    if (b != nullptr) change.new_value = fmt::format("\"{}\"", b->text);
  };
  const auto is_compared = [&](const ErrorCodeName& one) { return sources.has(one.source); };
  for (const ErrorCodeName& one : before.error_codes) {
    if (!is_compared(one)) continue;
    const ErrorCodeName* const other = find(after, one.code);
    if (other != nullptr && !is_compared(*other)) continue;
    if (other == nullptr) {
      add("error-code-removed", &one, nullptr);
    } else if (other->text != one.text) {
      add("error-code-text", &one, other);
    }
  }
  for (const ErrorCodeName& one : after.error_codes) {
    if (is_compared(one) && find(before, one.code) == nullptr) add("error-code-added", nullptr, &one);
  }
}

}  // namespace edsc

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "diagnostics/quote.hpp"
#include "lint/rule_groups.hpp"
#include "text/counted.hpp"
#include "values/little_endian.hpp"
#include "values/read_value.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;

bool is_integer(const DataTypeRow& type) {
  return type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer;
}

std::string bits_text(const BitField& field) {
  if (field.bits == 1) return fmt::format("bit {}", field.first_bit);
  return fmt::format("bits {}..{}", field.first_bit, field.first_bit + field.bits - 1);
}

std::string field_text(const BitField& field) {
  return field.is_reserved() ? fmt::format("reserved {}", bits_text(field))
                             : fmt::format("{} {}", bits_text(field), quote(field.name));
}

/// Checks what the options and the EDS state about one entry. What a profile states and does not fit is not applied.
class MeaningCheck {
 public:
  MeaningCheck(const RuleContext& context, const Entry& entry)
      : context_{context}, entry_{entry}, meaning_{*entry.meaning}, label_{entry_label(entry.index, entry.sub_index)} {}

  void run() const {
    check_fields(meaning_.fields, {});
    for (const FieldCase& one : meaning_.cases) check_fields(one.fields, meaning_.fields);
    for (const MaskedGroup& group : meaning_.masked) check_masked(group);
    if (meaning_.quantity) check_quantity(*meaning_.quantity);
    if (meaning_.values) check_values(*meaning_.values);
  }

 private:
  [[nodiscard]] static bool is_stated(const MeaningText& text) { return text.source != MeaningSource::profile; }
  void report(AnyRule rule, const MeaningText& at, std::string message) const {
    context_.report(rule, at.position, std::move(message));
  }

  void check_fields(const std::vector<BitField>& fields, const std::vector<BitField>& before) const {
    std::set<std::string_view> names;
    std::uint64_t taken = 0;
    for (const BitField& field : before) {
      taken |= field.mask();
      names.insert(field.name);
    }
    for (const BitField& field : fields) {
      if (is_stated(field)) check_field(field, taken, names);
      taken |= field.mask();
      if (!field.is_reserved()) names.insert(field.name);
    }
  }

  void check_field(const BitField& field, std::uint64_t taken, const std::set<std::string_view>& names) const {
    const DataTypeRow& type = *entry_.type;
    if (!is_integer(type)) {
      return report("meaning-bits", field,
                    fmt::format("{} cannot have {}: its type is {}", label_, field_text(field), type.name));
    }
    if (field.first_bit + field.bits > type.bits) {
      report("meaning-bits", field,
             fmt::format("{} of {} is outside {}, which has {} bits", field_text(field), label_, type.name, type.bits));
    }
    if ((field.mask() & taken) != 0) {
      report("meaning-bits", field, fmt::format("{} of {} overlaps another field", field_text(field), label_));
    }
    if (!field.is_reserved() && names.contains(field.name)) {
      report("meaning-bits", field, fmt::format("{} has two fields {}", label_, quote(field.name)));
    }
    if (field.quantity) check_quantity(*field.quantity);
    if (!field.values) return;
    for (const NamedValue& one : field.values->values) {
      if (field.of(static_cast<std::uint64_t>(one.value) << field.first_bit) == one.value) continue;
      report("meaning-value", one,
             fmt::format("{} = {} does not fit into {} of {}", quote(one.name), one.value, field_text(field), label_));
    }
  }

  void check_masked(const MaskedGroup& group) const {
    const DataTypeRow& type = *entry_.type;
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      const MaskedValue& one = group.values[i];
      if (!is_stated(one)) continue;
      if (!is_integer(type) || (one.mask & ~low_bits(type.bits)) != 0) {
        report("meaning-bits", one,
               fmt::format("the mask {:X}h of {} is outside {}", one.mask, quote(one.name), type.name));
      }
      for (std::size_t j = 0; j < i; ++j) {
        const MaskedValue& other = group.values[j];
        if (((one.value ^ other.value) & one.mask & other.mask) != 0) continue;
        report("meaning-bits", one,
               fmt::format("one value of {} can be {} and {}", label_, quote(other.name), quote(one.name)));
        break;
      }
    }
  }

  void check_quantity(const Quantity& quantity) const {
    if (!is_stated(quantity)) return;
    if (quantity.scale == Rational{0}) {
      report("meaning-scale", quantity, fmt::format("the scale of {} is 0", label_));
    }
    if (quantity.source == MeaningSource::options && !quantity.symbol.empty() && quantity.unit == nullptr) {
      report("meaning-unit", quantity,
             fmt::format("{} is not a unit that edsc knows; values of {} are shown with it, but not converted",
                         quote(quantity.symbol), label_));
    }
  }

  void check_values(const Enumeration& values) const {
    const DataTypeRow& type = *entry_.type;
    for (const NamedValue& one : values.values) {
      if (is_stated(one)) check_value(one);
    }
    if (!values.closed || !entry_.default_value || entry_.default_value->plus_node_id || !is_integer(type)) return;
    if (values.find(integer_of(entry_.default_value->bits)) != nullptr) return;
    context_.report("meaning-default", entry_.default_value->position,
                    fmt::format("{} is the {} of {}, but not one of its named values, and others are rejected",
                                integer_of(entry_.default_value->bits), context_.value_word(entry_), named(entry_)));
  }

  void check_value(const NamedValue& one) const {
    const DataTypeRow& type = *entry_.type;
    const auto bits = static_cast<std::uint64_t>(one.value);
    if (!is_integer(type) || integer_of(bits & low_bits(type.bits)) != one.value) {
      return report(
          "meaning-value", one,
          fmt::format("{} = {} is not a value of {}, which is {}", quote(one.name), one.value, label_, type.name));
    }
    const auto& low = entry_.low_limit;
    const auto& high = entry_.high_limit;
    const bool is_below = low && !low->plus_node_id && is_less(type, bits, low->bits);
    const bool is_above = high && !high->plus_node_id && is_less(type, high->bits, bits);
    if (!is_below && !is_above) return;
    context_.diagnostics.warning("meaning-value", one.position,
                                 fmt::format("{} = {} is {} the {} limit of {}", quote(one.name), one.value,
                                             is_below ? "below" : "above", is_below ? "low" : "high", label_));
  }

  [[nodiscard]] std::int64_t integer_of(std::uint64_t bits) const {
    const bool is_signed = entry_.type->kind == DataClass::signed_integer;
    return is_signed ? sign_extended(bits, entry_.type->bits) : static_cast<std::int64_t>(bits);
  }

  const RuleContext& context_;
  const Entry& entry_;
  const Meaning& meaning_;
  std::string label_;
};

/// Units of the EDS that edsc does not know: one finding for each.
class UnknownUnits {
 public:
  void add(const Entry& entry) {
    if (!entry.meaning || !entry.meaning->quantity) return;
    const Quantity& quantity = *entry.meaning->quantity;
    if (quantity.source != MeaningSource::eds || quantity.symbol.empty() || quantity.unit != nullptr) return;
    const auto at = std::ranges::find(units_, quantity.symbol, &Unit::symbol);
    if (at == units_.end()) {
      units_.push_back({quantity.symbol, quantity.position, entry_label(entry.index, entry.sub_index), 1});
    } else {
      ++at->count;
    }
  }

  void report(const RuleContext& context) const {
    for (const Unit& unit : units_) {
      std::string others =
          unit.count == 1 ? "" : fmt::format(" and {}", counted(unit.count - 1, "other entry", "other entries"));
      context.diagnostics.note(
          "meaning-unit", unit.position,
          fmt::format("{} of {}{} is not a unit that edsc knows; values are shown with it, but not "
                      "converted",
                      quote(unit.symbol), unit.first, others));
    }
  }

 private:
  struct Unit {
    std::string symbol;
    Position position;
    std::string first;
    std::size_t count;
  };
  std::vector<Unit> units_;
};

}  // namespace

void check_meanings(const RuleContext& context) {
  std::set<const Meaning*> checked;  // elements of an array share one
  UnknownUnits unknown;
  for (const Object& object : context.device.objects) {
    for (const Entry& entry : object.entries) {
      unknown.add(entry);
      if (entry.meaning && checked.insert(entry.meaning.get()).second) MeaningCheck{context, entry}.run();
    }
  }
  unknown.report(context);
}

}  // namespace edsc

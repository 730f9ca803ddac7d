#include "device/meaning/value_parts.hpp"

#include <fmt/format.h>

#include <optional>

#include "text/ascii.hpp"
#include "text/suggestion.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/parse_value.hpp"

namespace edsc {
namespace {

/// Bits that a name sets, and their value.
struct SetBits {
  std::uint64_t mask = 0, value = 0;
  bool is_also_field = false;  ///< the name of a masked value is that of a field, too
};

RawNumber failed(std::string problem) { return {0, std::move(problem)}; }

/// The number of a text in a field: a name, a physical value or a number.
RawNumber field_number(const BitField& field, std::string_view text) {
  if (field.values) {
    if (const NamedValue* const named = field.values->find(text)) {
      return {static_cast<std::uint64_t>(named->value), ""};
    }
  }
  const canopen::DataTypeRow& type = type_of(field);
  if (field.quantity) {
    if (const auto physical = split_physical(text)) return raw_number(*field.quantity, type, *physical);
  }
  const ParsedValue number = parse_value_text(type, text);
  if (!number.ok()) return failed(fmt::format("{} of {}", number.problem, field.name));
  return {number_of(number.bytes), ""};
}

/// Finds names in the masked values and fields of a meaning.
class PartNames {
 public:
  explicit PartNames(const Meaning& meaning) : meaning_{meaning} {}

  /// The bits of `remote`, `gear=3` or `profile_position.halt`; or a problem. A name of both a masked value and a
  /// field, such as `quick_stop`, is the masked value at the start of a list, and otherwise the field.
  [[nodiscard]] std::string find(std::string_view text, bool is_first, SetBits& bits) const {
    const std::size_t equals = text.find('=');
    const std::string_view name = trim(text.substr(0, equals));
    const auto value = equals == std::string_view::npos ? std::nullopt : std::optional{trim(text.substr(equals + 1))};
    const BitField* const field = find_field(name);
    for (const MaskedGroup& group : meaning_.masked) {
      for (const MaskedValue& one : group.values) {
        const bool is_this = value ? name == group.name && *value == one.name : name == one.name;
        const bool is_field_too = is_this && !value && field != nullptr && field->is_flag();
        if (!is_this || (is_field_too && !is_first)) continue;
        bits = {one.mask, one.value, is_field_too};
        return "";
      }
    }
    if (field == nullptr) return unknown(name);
    if (!value && !field->is_flag()) return fmt::format("{} needs a value, such as {}=1", name, name);
    const RawNumber number = value ? field_number(*field, *value) : RawNumber{1, ""};
    if (!number.ok()) return number.problem;
    bits = {field->mask(), number.bits << field->first_bit & field->mask(), false};
    if (field->of(bits.value) != static_cast<std::int64_t>(number.bits)) {
      return fmt::format("{} does not fit into {}, which has {} bit{}", *value, name, field->bits,
                         field->bits == 1 ? "" : "s");
    }
    return "";
  }

 private:
  [[nodiscard]] const BitField* find_field(std::string_view name) const {
    const auto find_in = [](const std::vector<BitField>& fields, std::string_view wanted) -> const BitField* {
      for (const BitField& field : fields) {
        if (!field.is_reserved() && field.name == wanted) return &field;
      }
      return nullptr;
    };
    if (const BitField* const field = find_in(meaning_.fields, name)) return field;
    const std::size_t dot = name.find('.');
    for (const FieldCase& one : meaning_.cases) {
      if (dot != std::string_view::npos && one.name != name.substr(0, dot)) continue;
      const auto* const field = find_in(one.fields, dot == std::string_view::npos ? name : name.substr(dot + 1));
      if (field != nullptr && is_same_in_all_cases(*field, dot == std::string_view::npos)) return field;
    }
    return nullptr;
  }

  /// Whether the name has the same bits in each case that has it. A name with its case before it is not ambiguous.
  [[nodiscard]] bool is_same_in_all_cases(const BitField& field, bool is_short) const {
    if (!is_short) return true;
    for (const FieldCase& one : meaning_.cases) {
      for (const BitField& other : one.fields) {
        if (other.name == field.name && other.mask() != field.mask()) return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::string unknown(std::string_view name) const {
    std::vector<std::string_view> names;
    for (const MaskedGroup& group : meaning_.masked) {
      for (const MaskedValue& one : group.values) names.push_back(one.name);
    }
    for (const BitField& field : meaning_.fields) {
      if (!field.is_reserved()) names.push_back(field.name);
    }
    return fmt::format("\"{}\" is not a field or value{}", name, did_you_mean(name, names));
  }

  const Meaning& meaning_;
};

/// Whether the hexadecimal digits of the word show the number of a field, such as the CAN-ID of a COB-ID.
bool is_seen_in_digits(const ValuePart& part) {
  const BitField& field = *part.field;
  return field.bits >= 8 && field.first_bit % 4 == 0 && part.named == nullptr && !field.quantity && !field.is_signed;
}

}  // namespace

const canopen::DataTypeRow& type_of(const BitField& field) {
  return *canopen::find_data_type(
      static_cast<std::uint32_t>(field.is_signed ? canopen::DataType::integer64 : canopen::DataType::unsigned64));
}

void append_part(std::string& text, const ValuePart& part) {
  if (part.masked != nullptr) {
    text += part.masked->name;
    return;
  }
  const BitField& field = *part.field;
  text += field.name;
  if (field.is_flag()) return;
  text += '=';
  if (part.named != nullptr) {
    text += part.named->name;
  } else if (field.quantity) {
    append_physical(text, *field.quantity, type_of(field), static_cast<std::uint64_t>(part.number), 64);
  } else if (field.bits >= 8 && !field.is_signed) {
    append_hex_number(text, static_cast<std::uint64_t>(part.number), (field.bits + 3U) / 4);
  } else {
    append_decimal(text, part.number);
  }
}

void append_parts(std::string& text, const Meaning& meaning, std::uint64_t raw, std::optional<std::int64_t> other) {
  std::string_view separator;
  std::uint64_t named_bits = 0;
  for_each_part(meaning, raw, other, [&](const ValuePart& part) {
    if (part.masked != nullptr) {
      named_bits |= part.masked->mask;
    } else if (part.field->is_flag() ? part.number == 0 || (part.field->mask() & named_bits) != 0
                                     : is_seen_in_digits(part)) {
      return;
    }
    text += separator;
    separator = ", ";
    append_part(text, part);
  });
}

RawNumber parse_parts(const Meaning& meaning, std::string_view text) {
  const PartNames names{meaning};
  SetBits all, first;
  std::string_view first_name;
  for (bool is_first = true;; is_first = false) {
    const std::size_t end = text.find_first_of(",|");
    const std::string_view name = trim(text.substr(0, end));
    SetBits bits;
    if (std::string problem = names.find(name, is_first, bits); !problem.empty()) return failed(std::move(problem));
    if (is_first) {
      first = bits;
      first_name = name;
    } else if (first.is_also_field && (bits.mask & first.mask) != 0) {
      return failed(fmt::format("{} is a value of bits {:X}h, which include {}; {}=1 is the bit alone", first_name,
                                first.mask, name, first_name));
    }
    if (((all.value ^ bits.value) & all.mask & bits.mask) != 0) {
      return failed(fmt::format("{} contradicts what is before it: both have bits {:X}h", name, all.mask & bits.mask));
    }
    all.mask |= bits.mask;
    all.value |= bits.value;
    if (end == std::string_view::npos) return {all.value, ""};
    text.remove_prefix(end + 1);
  }
}

}  // namespace edsc

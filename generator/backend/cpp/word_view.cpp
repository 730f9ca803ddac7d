#include "backend/cpp/word_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/identifiers.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

/// Whether a number can be in an integer of `bits` bits.
bool fits(std::int64_t value, unsigned bits, bool is_signed) {
  if (bits >= 64) return true;
  const std::int64_t limit = std::int64_t{1} << (is_signed ? bits - 1 : bits);
  return value < limit && value >= (is_signed ? -limit : 0);
}

/// `Bit 3`, `Bits 4..7`.
std::string bits_text(const BitField& field) {
  if (field.bits == 1) return fmt::format("Bit {}", field.first_bit);
  return fmt::format("Bits {}..{}", field.first_bit, field.first_bit + field.bits - 1);
}

/// The parts of a struct, with names that are unique in it.
class WordBuilder {
 public:
  WordBuilder(const Entry& entry, const std::string& identifier)
      : meaning_{*entry.meaning}, bits_{entry.type->bits}, number_{entry.type->cpp_type}, self_{identifier} {
    for (const char* name : {"raw", "raw_type", "all", "any", "is", "number_", "has_", "assign_", "part_", "word"}) {
      static_cast<void>(scope_.take(name, ""));
    }
    static_cast<void>(scope_.take(identifier, ""));
  }

  ordered_json build() {
    ordered_json fields = field_rows(meaning_.fields, scope_, "");
    ordered_json masked = masked_rows();
    ordered_json cases = case_rows();
    return json_object("self", self_, "number", number_, "enumerations", std::move(enumerations_), "fields",
                       std::move(fields), "masked", std::move(masked), "cases", std::move(cases));
  }

 private:
  /// As wide as the word.
  [[nodiscard]] std::string mask_text(std::uint64_t mask) const { return fmt::format("0x{:0{}X}", mask, bits_ / 4); }

  ordered_json field_rows(const std::vector<BitField>& fields, IdentifierScope& scope, std::string_view prefix) {
    ordered_json rows = json_array(fields.size());
    for (const BitField& field : fields) {
      const bool is_wide_signed = field.is_signed && field.bits > 32;
      if (field.is_reserved() || field.first_bit + field.bits > bits_ || is_wide_signed) continue;
      rows.push_back(field_row(field, scope.take(without_keyword(field.name), "_field"), prefix));
    }
    return rows;
  }

  /// The functions of a field; in a struct that refers to the word, the same for its member `word`.
  ordered_json field_row(const BitField& field, std::string identifier, std::string_view prefix) {
    const std::string low_mask = mask_text(field.mask() >> field.first_bit);
    if (field.is_flag()) {
      const std::string mask = mask_text(field.mask());
      return row(field, std::move(identifier), "bool", {"", fmt::format("has_({})", mask), ""}, "bool on",
                 fmt::format("assign_({}, on)", mask));
    }
    const std::string number = integer_type(field.bits, field.is_signed);
    Getter get;
    get.part = field.is_signed ? fmt::format("signed_part_({}, {})", field.first_bit, field.bits)
                               : fmt::format("part_({}, {})", field.first_bit, low_mask);
    std::string type = number;
    std::string argument = fmt::format("canopen::{}FieldNumber<{}>", field.is_signed ? "Signed" : "", field.bits);
    std::string value = "value.number";
    if (field.values) {
      type = argument = enumeration(field, prefix);
      value = "value";
    } else if (field.quantity && field.quantity->unit != nullptr) {
      type = quantity_type(number, *field.quantity);
      get = {fmt::format("{}{{canopen::raw(", type), get.part, ")}"};
      // A quantity has values that a field of another number of bits does not have.
      if (field.bits == 8 || field.bits == 16 || field.bits == 32 || field.bits == 64) {
        argument = type;
        value = "value.raw()";
      }
    }
    get.before += fmt::format("static_cast<{}>(", type.find('<') == std::string::npos ? type : number);
    get.after.insert(0, ")");
    return row(field, std::move(identifier), type, get, argument + " value",
               fmt::format("assign_part_({}, {}, static_cast<{}>({}))", field.first_bit, low_mask, number_, value));
  }

  /// An expression: the call of a member function of the word, and what is around it.
  struct Getter {
    std::string before, part, after;
  };

  static ordered_json row(const BitField& field, std::string identifier, const std::string& type, const Getter& get,
                          const std::string& argument, const std::string& set) {
    return json_object("identifier", std::move(identifier), "comment", bits_text(field) + comment_of(field) + ".",
                       "type", type, "argument", argument, "get", get.before + get.part + get.after, "get_of_word",
                       get.before + "word." + get.part + get.after, "set", set, "set_of_word", "word." + set);
  }

  /// Adds the enumeration of a field, and returns its name.
  std::string enumeration(const BitField& field, std::string_view prefix) {
    std::string name = scope_.take(fmt::format("{}{}_value", prefix, field.name), "_of_field");
    enumerations_.push_back(json_object("identifier", name, "number", integer_type(field.bits, field.is_signed),
                                        "comment", fmt::format("The values of {}.", field.name), "values",
                                        enumerator_rows(*field.values, field.bits, field.is_signed)));
    return name;
  }

  ordered_json masked_rows() {
    ordered_json rows = json_array(meaning_.masked.size());
    for (const MaskedGroup& group : meaning_.masked) {
      IdentifierScope scope;
      ordered_json values = json_array(group.values.size());
      for (const MaskedValue& one : group.values) {
        if (bits_ < 64 && ((one.mask | one.value) >> bits_) != 0) continue;
        values.push_back(json_object("identifier", scope.take(without_keyword(one.name), "_value"), "name", one.name,
                                     "mask", mask_text(one.mask), "value", mask_text(one.value), "comment",
                                     trailing(one)));
      }
      if (values.empty()) continue;
      rows.push_back(json_object("group", scope_.take(without_keyword(group.name), "_group"), "enumeration",
                                 scope_.take(group.name + "_value", "_of_group"), "number",
                                 values.size() > 0x100 ? "std::uint16_t" : "std::uint8_t", "values",
                                 std::move(values)));
    }
    return rows;
  }

  ordered_json case_rows() {
    ordered_json rows = json_array(meaning_.cases.size());
    for (const FieldCase& one : meaning_.cases) {
      const std::string of_case = name_of_case(one);
      std::string name = scope_.take(without_keyword(of_case), "_case");
      std::string view = scope_.take(of_case + "_fields", "_of_case");
      std::string reference = scope_.take(of_case + "_reference", "_of_case");
      IdentifierScope scope;
      for (const char* taken : {"raw", "raw_type", "all", "any", "word"}) static_cast<void>(scope.take(taken, ""));
      static_cast<void>(scope.take(view, ""));
      static_cast<void>(scope.take(reference, ""));
      ordered_json fields = field_rows(one.fields, scope, of_case + "_");
      if (fields.empty()) continue;
      std::string other;
      if (meaning_.depends_on) {
        other = fmt::format(" is {}", fmt::join(one.values, ", "));
        other = entry_label(meaning_.depends_on->first, meaning_.depends_on->second) + other;
      }
      rows.push_back(json_object("identifier", std::move(name), "view", std::move(view), "reference",
                                 std::move(reference), "comment",
                                 fmt::format("The fields for {}{}{}.", of_case, other.empty() ? "" : ": ", other),
                                 "fields", std::move(fields)));
    }
    return rows;
  }

  static std::string trailing(const MeaningText& text) {
    const std::string comment = comment_of(text);
    return comment.empty() ? "" : "  ///<" + comment.substr(1);
  }

  const Meaning& meaning_;
  unsigned bits_;
  std::string number_;
  std::string self_;
  IdentifierScope scope_;
  ordered_json enumerations_ = ordered_json::array();
};

}  // namespace

std::string integer_literal(std::int64_t value, bool is_signed) {
  if (!is_signed) {
    const auto number = static_cast<std::uint64_t>(value);
    return fmt::format("{}{}", number, number > 0x7FFF'FFFF'FFFF'FFFF ? "u" : "");
  }
  // The literal of the lowest number would be that of a positive one.
  if (value == std::numeric_limits<std::int64_t>::min()) return fmt::format("{} - 1", value + 1);
  return fmt::format("{}", value);
}

std::string integer_type(unsigned bits, bool is_signed) {
  const unsigned width = bits <= 8 ? 8 : bits <= 16 ? 16 : bits <= 32 ? 32 : 64;
  return fmt::format("std::{}int{}_t", is_signed ? "" : "u", width);
}

std::string quantity_type(std::string_view number, const Quantity& quantity) {
  const auto ratio = [](const Rational& value) {
    return value.is_integer() ? fmt::format("std::ratio<{}>", value.numerator())
                              : fmt::format("std::ratio<{}, {}>", value.numerator(), value.denominator());
  };
  std::string text = fmt::format("canopen::Quantity<{}, canopen::unit::{}", number, quantity.unit->name);
  if (!quantity.is_raw()) text += ", " + ratio(quantity.scale);
  if (quantity.offset != Rational{0}) text += ", " + ratio(quantity.offset);
  return text + ">";
}

ordered_json enumerator_rows(const Enumeration& values, unsigned bits, bool is_signed) {
  IdentifierScope scope;
  ordered_json rows = json_array(values.values.size());
  for (const NamedValue& one : values.values) {
    if (!fits(one.value, bits, is_signed)) continue;
    const std::string comment = comment_of(one);
    rows.push_back(json_object("identifier", scope.take(without_keyword(one.name), "_value"), "name", one.name, "value",
                               integer_literal(one.value, is_signed), "comment",
                               comment.empty() ? "" : "  ///<" + comment.substr(1)));
  }
  return rows;
}

std::string comment_of(const MeaningText& meaning) {
  std::string text;
  if (!meaning.text.empty()) text += ": " + cpp_comment(meaning.text);
  if (!meaning.place.empty()) text += (text.empty() ? ": " : "; ") + cpp_comment(meaning.place);
  return text;
}

std::string name_of_case(const FieldCase& one) {
  if (!one.name.empty()) return one.name;
  std::string name = fmt::format("case_{}", one.values.empty() ? 0 : one.values.front());
  std::ranges::replace(name, '-', '_');
  return name;
}

ordered_json word_view(const Entry& entry, const std::string& identifier) {
  return WordBuilder{entry, identifier}.build();
}

ordered_json enumeration_view(const Entry& entry) {
  const bool is_signed = entry.type->kind == canopen::DataClass::signed_integer;
  return json_object("number", entry.type->cpp_type, "values",
                     enumerator_rows(*entry.meaning->values, entry.type->bits, is_signed));
}

void add_names_of_values(ordered_json& rows, const std::string& identifier, const ordered_json& enumeration,
                         const ordered_json& word) {
  if (!enumeration.is_null()) {
    rows.push_back(json_object("type", identifier, "values", enumeration["values"]));
    return;
  }
  const auto add = [&](const ordered_json& name, const ordered_json& values) {
    rows.push_back(
        json_object("type", fmt::format("{}::{}", identifier, name.get_ref<const std::string&>()), "values", values));
  };
  for (const ordered_json& one : word["enumerations"]) add(one["identifier"], one["values"]);
  for (const ordered_json& one : word["masked"]) add(one["enumeration"], one["values"]);
}

}  // namespace edsc

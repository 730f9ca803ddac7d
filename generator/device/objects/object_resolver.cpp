#include "device/objects/object_resolver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <span>
#include <string>
#include <utility>

#include "device/index_range.hpp"
#include "device/objects/compact_sub_objects.hpp"
#include "device/objects/object_type_name.hpp"
#include "device/objects/standard_objects.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;

constexpr std::array object_types = {ObjectType::domain, ObjectType::deftype, ObjectType::defstruct,
                                     ObjectType::var,    ObjectType::array,   ObjectType::record};

/// The value of sub-index 0 that the EDS does not state: the highest sub-index, but 0 errors in the pre-defined error
/// field (CiA 301, 7.5.2.4), and the number of mapped objects in a mapping (7.5.2.36).
std::uint8_t implied_count(const Object& object) {
  constexpr std::uint16_t pre_defined_error_field = 0x1003;
  if (object.index == pre_defined_error_field) return 0;
  if (!contains(mapping_parameters, object.index)) return object.highest_sub_index();
  std::uint8_t count = 0;
  for (const Entry& entry : object.entries) {
    const bool is_next = entry.sub_index == count + 1;
    if (is_next && entry.default_value && entry.default_value->bits != 0) ++count;
  }
  return count;
}

/// The clause of CiA 301 that defines sub-index 0.
std::string_view implied_count_clause(std::uint16_t index) {
  if (index == 0x1003) return "7.5.2.4";
  if (!contains(mapping_parameters, index)) return "7.4.4";
  return index < 0x1A00 ? "7.5.2.36" : "7.5.2.38";
}

struct ObjectCode {
  std::string text;
  std::string reason;
};

/// The object code of an object of CiA 301 with sub-objects. That of another object may be ARRAY or RECORD.
std::optional<ObjectCode> standard_object_code(std::uint16_t index) {
  const StandardObject* const standard = find_standard_object(index);
  if (standard == nullptr || standard->type == ObjectType::var) return std::nullopt;
  return ObjectCode{fmt::format("0x{:X}", static_cast<unsigned>(standard->type)),
                    fmt::format("object code of {} (CiA 301, {})", index_label(index), standard->clause)};
}

/// Whether a VAR or DOMAIN with sub-objects is a value, and the index of the sub-objects is wrong: it has its own data
/// type, states no sub-objects, and sub-index 0 is missing.
bool describes_a_value(const ObjectDescription& description) {
  return description.find(0) == nullptr && !strip_inline_comment(description.data_type.text).empty() &&
         number_of(description.sub_number).value_or(0) == 0 && number_of(description.compact_sub_obj).value_or(0) == 0;
}

}  // namespace

Entry count_entry(std::uint16_t index, std::uint8_t highest, const Position& position) {
  Entry entry;
  entry.index = index;
  entry.name = "Highest sub-index supported";
  entry.type = canopen::find_data_type(static_cast<std::uint32_t>(DataType::unsigned8));
  entry.access = canopen::Access::constant;
  entry.position = entry.access_position = entry.mapping_position = position;
  entry.default_value = Value{.bits = highest, .position = position};
  return entry;
}

std::optional<Object> ObjectResolver::resolve(const ObjectDescription& description) {
  std::optional<Object> result{std::in_place};
  Object& object = *result;
  object.index = description.index;
  object.position = description.position;
  object.name = description.parameter_name.text;
  object.denotation = description.denotation.text;
  object.type = object_type(description);
  if (object.name.empty()) {
    diagnostics_.warning("parameter-name", description.position, "missing ParameterName", {}, "missing");
  }
  resolve_links(description, object);
  if (object.has_sub_indices()) {
    object.obj_flags = entries_.obj_flags(description);
    resolve_sub_objects(description, object);
  } else if (auto entry = entries_.resolve(description, {description.index, 0}, object.name)) {
    object.obj_flags = entry->obj_flags;
    object.entries.push_back(std::move(*entry));
  }
  if (object.entries.empty()) return std::nullopt;
  return result;
}

ObjectType ObjectResolver::object_type(const ObjectDescription& description) {
  const bool has_subs = !description.sub_objects.empty() || number_of(description.compact_sub_obj).value_or(0) > 0;
  const ObjectType fallback = has_subs ? ObjectType::record : ObjectType::var;
  const Field& field = description.object_type;
  const std::string_view text = strip_inline_comment(field.text);
  if (!field.present || text.empty()) {
    if (has_subs) {
      diagnostics_.warning("object-type", description.position,
                           "missing ObjectType of an object with sub-objects; assuming RECORD", {}, "missing");
      if (const auto code = standard_object_code(description.index)) {
        diagnostics_.offer_key("object-type", description.position, "ObjectType", code->text, code->reason);
      }
    }
    return fallback;
  }
  const auto named = object_type_named(text);
  if (named) report_object_type_name(*named, field, diagnostics_);
  const auto code = named ? static_cast<std::uint64_t>(*named) : parse_unsigned(text);
  const auto known =
      std::ranges::find_if(object_types, [&](ObjectType type) { return code == static_cast<std::uint64_t>(type); });
  if (known == object_types.end()) {
    diagnostics_.warning(
        "object-type", field.position,
        fmt::format("{} is not an object code of CiA 301; assuming {}", quote(text), to_string(fallback)), {},
        std::string{text});
    return fallback;
  }
  if (*known == ObjectType::deftype || *known == ObjectType::defstruct) {
    diagnostics_.warning(
        "object-type", field.position,
        fmt::format("a {} must have an index below 1000h; assuming {}", to_string(*known), to_string(fallback)), {},
        std::string{to_string(*known)});
    return fallback;
  }
  const bool is_simple = *known == ObjectType::var || *known == ObjectType::domain;
  if (!is_simple || !has_subs) return *known;
  if (describes_a_value(description)) {
    report_stray_sub_objects(description, *known);
    return *known;
  }
  diagnostics_.warning("object-type", field.position,
                       fmt::format("a {} cannot have sub-objects; assuming RECORD", to_string(*known)), {},
                       fmt::format("{} with sub-objects", to_string(*known)));
  if (const auto standard = standard_object_code(description.index)) {
    diagnostics_.offer_value("object-type", field.position, standard->text, standard->reason);
  }
  return ObjectType::record;
}

void ObjectResolver::report_stray_sub_objects(const ObjectDescription& description, ObjectType type) {
  for (const SubObjectDescription& sub : description.sub_objects) {
    diagnostics_.warning(
        "sub-object-without-object", sub.position,
        fmt::format("{} is a {} and cannot have sub-objects; {} {} is ignored", index_label(description.index),
                    to_string(type), entry_label(description.index, sub.sub_index), quote(sub.parameter_name.text)));
  }
}

void ObjectResolver::resolve_links(const ObjectDescription& description, Object& object) {
  for (const NumberedField& link : description.object_links) {
    const auto index = number_of(link.field);
    if (index && *index <= 0xFFFF) {
      object.links.push_back(static_cast<std::uint16_t>(*index));
    } else {
      diagnostics_.warning("object-links", link.field.position,
                           fmt::format("{} is not the index of an object", quote(link.field.text)));
    }
  }
}

void ObjectResolver::resolve_sub_objects(const ObjectDescription& description, Object& object) {
  if (has_compact_form(description)) {
    std::deque<std::string> texts;
    for (const SubObjectDescription& sub : unfold_sub_objects(description, is_dcf_, texts, diagnostics_)) {
      resolve_sub_object(sub, description, object);
    }
  } else {
    object.entries.reserve(description.sub_objects.size());
    for (const SubObjectDescription& sub : description.sub_objects) resolve_sub_object(sub, description, object);
  }
  if (object.entries.empty()) {
    diagnostics_.warning(
        "no-sub-objects", description.position,
        fmt::format("{} {} has no sub-objects and is ignored", to_string(object.type), index_label(object.index)));
    return;
  }
  check_sub_number(description);
  check_sub_indices(description);
  supply_sub_index_0(description, object);
}

void ObjectResolver::resolve_sub_object(const SubObjectDescription& sub, const ObjectDescription& description,
                                        Object& object) {
  const EntryPlace place{description.index, sub.sub_index, true, number_of(description.data_type)};
  if (auto entry = entries_.resolve(sub, place, sub.parameter_name.text)) object.entries.push_back(std::move(*entry));
}

void ObjectResolver::check_sub_number(const ObjectDescription& description) {
  const Field& field = description.sub_number;
  if (!field.present || number_of(description.compact_sub_obj).value_or(0) > 0) return;
  const std::size_t count = description.sub_objects.size();
  if (number_of(field) == count) return;
  const auto stated = number_of(field);
  const std::string cause = stated ? fmt::format("{:+}", static_cast<std::int64_t>(*stated - count)) : std::string{};
  diagnostics_.warning("sub-number", field.position,
                       fmt::format("SubNumber is {}, but {} described; using {}", strip_inline_comment(field.text),
                                   count == 1 ? "1 sub-object is" : fmt::format("{} sub-objects are", count), count),
                       {}, cause);
  diagnostics_.offer_value("sub-number", field.position, fmt::format("{}", count),
                           fmt::format("number of the sub-objects of {}", index_label(description.index)));
}

/// Sub-indices are hexadecimal (CiA 306-1, 4.6.2). The author may have counted in decimal if 10h follows 9h and no
/// sub-index of the object has a digit from A to F. It is certain if sub-index 0 states the highest one as a decimal
/// number.
void ObjectResolver::check_sub_indices(const ObjectDescription& description) {
  const SubObjectDescription* const written = description.find(0x10);
  const auto has_letter = [](const SubObjectDescription& one) {
    return (one.sub_index & 0x0FU) > 9 || (one.sub_index >> 4U) > 9;
  };
  if (written == nullptr || description.find(0x09) == nullptr) return;
  if (std::ranges::any_of(description.sub_objects, has_letter)) return;
  const std::string hexadecimal = "sub-indices are hexadecimal: this is 10h";
  const SubObjectDescription* const count = description.find(0);
  const unsigned highest = description.sub_objects.back().sub_index;
  const unsigned as_decimal = (highest >> 4U) * 10 + (highest & 0x0FU);
  if (count != nullptr && number_of(count->default_value) == as_decimal) {
    diagnostics_.error(
        "sub-index-base", written->position,
        fmt::format("{}; those of this object are decimal, for sub-index 0 is {}; the option sub_indices reads them so",
                    hexadecimal, as_decimal),
        {}, "decimal");
    diagnostics_.offer_value("sub-index-base", {description.position.file}, "decimal",
                             "sub-index 0 states the highest sub-index as a decimal number");
  } else {
    diagnostics_.warning("sub-index-base", written->position, hexadecimal + "; did you mean Ah, which is missing?", {},
                         "looks decimal");
  }
}

void ObjectResolver::supply_sub_index_0(const ObjectDescription& description, Object& object) {
  if (object.entries.front().sub_index != 0) {
    const std::uint8_t highest = object.highest_sub_index();
    diagnostics_.warning(
        "sub-index-0", description.position,
        fmt::format("{} has no sub-index 0; assuming one with the value {}", index_label(object.index), highest));
    object.entries.insert(object.entries.begin(), count_entry(description.index, highest, description.position));
    return;
  }
  Entry& first = object.entries.front();
  if (!first.default_value && first.type->kind == DataClass::unsigned_integer && object.entries.size() > 1) {
    first.default_value =
        Value{.bits = implied_count(object), .position = first.position, .clause = implied_count_clause(object.index)};
  }
}

}  // namespace edsc

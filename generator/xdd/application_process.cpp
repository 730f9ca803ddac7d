#include "xdd/application_process.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "xdd/attributes.hpp"

namespace edsc {
namespace {

/// The attribute `access` and the corresponding AccessType. An Input is a process input, for TPDOs.
struct AccessWord {
  std::string_view word;
  std::string_view access_type;
};

constexpr AccessWord access_words[] = {
    {"const", "const"},         {"read", "ro"}, {"write", "wo"}, {"readWrite", "rw"}, {"readWriteInput", "rwr"},
    {"readWriteOutput", "rww"},
};

/// The default of the schema.
constexpr std::string_view default_access_type = "ro";

/// Children of a parameter with one field each, whose value is the attribute `value`.
struct ValueElement {
  std::string_view name;
  Field EntryDescription::*field;
};

constexpr ValueElement value_elements[] = {
    {"defaultValue", &EntryDescription::default_value},
    {"actualValue", &EntryDescription::parameter_value},
};

/// Children of a parameter without effect on the dictionary: texts, behaviour of the application.
constexpr std::string_view silent_elements[] = {
    "description", "labelRef",           "descriptionRef", "substituteValue",
    "variableRef", "conditionalSupport", "dataTypeIDRef",  "allowedValues",
};

/// Property of CANopenEditor: the object is in the file, but not in the device.
constexpr std::string_view disabled_property = "CO_disabled";

/// Maximum length of a chain of derived types.
constexpr int longest_chain = 16;

bool is_array_or_struct(pugi::xml_node type) { return local_name(type) == "array" || local_name(type) == "struct"; }

/// The English label if there is one, otherwise the first.
pugi::xml_node find_label(pugi::xml_node element) {
  pugi::xml_node label;
  for_each_element(element, [&](pugi::xml_node child) {
    if (local_name(child) != "label") return;
    const bool is_english = std::string_view{find_attribute(child, "lang").value()}.starts_with("en");
    if (!label || (is_english && !std::string_view{find_attribute(label, "lang").value()}.starts_with("en"))) {
      label = child;
    }
  });
  return label;
}

/// A decimal as an integer and the number of its decimals; nothing for other texts.
struct DecimalNumber {
  std::int64_t digits = 0;
  unsigned decimals = 0;
};

std::optional<DecimalNumber> parse_decimal(std::string_view text) {
  DecimalNumber number;
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  bool has_point = false, has_digit = false;
  for (const char one : text) {
    if (one == '.' && !has_point) {
      has_point = true;
    } else if (one < '0' || one > '9' || __builtin_mul_overflow(number.digits, 10, &number.digits) ||
               __builtin_add_overflow(number.digits, one - '0', &number.digits)) {
      return std::nullopt;
    } else {
      has_digit = true;
      if (has_point) ++number.decimals;
    }
  }
  if (!has_digit) return std::nullopt;
  if (is_negative) number.digits = -number.digits;
  return number;
}

/// The exact product as a decimal; nothing if one of the texts is not a decimal, or has too many digits.
std::optional<std::string> product_of_decimals(std::string_view a, std::string_view b) {
  const auto one = parse_decimal(a), other = parse_decimal(b);
  std::int64_t digits = 0;
  if (!one || !other || __builtin_mul_overflow(one->digits, other->digits, &digits)) return std::nullopt;
  unsigned decimals = one->decimals + other->decimals;
  for (; decimals > 0 && digits % 10 == 0; --decimals) digits /= 10;
  std::string text = fmt::format(
      "{:0{}}", digits < 0 ? 0 - static_cast<std::uint64_t>(digits) : static_cast<std::uint64_t>(digits), decimals + 1);
  if (decimals > 0) text.insert(text.size() - decimals, ".");
  return (digits < 0 ? "-" : "") + text;
}

void set_if_missing(Field& field, const Field& value) {
  if (!field.present) field = value;
}

}  // namespace

ApplicationProcess::ApplicationProcess(XmlDocument& xml, pugi::xml_node element) : xml_{xml} {
  for_each_element(element, [&](pugi::xml_node list) {  // dataTypeList, templateList, parameterList, ...
    for_each_element(list, [&](pugi::xml_node item) {
      add(item);
      if (is_array_or_struct(item)) for_each_element(item, [&](pugi::xml_node member) { add(member); });
    });
  });
}

void ApplicationProcess::add(pugi::xml_node element) {
  const pugi::xml_attribute id = find_attribute(element, "uniqueID");
  if (!id) return;
  const auto [first, is_new] = by_unique_id_.try_emplace(id.value(), element);
  if (!is_new) report_second(xml_, id, xml_.position(first->second));
}

pugi::xml_node ApplicationProcess::find(std::string_view unique_id) const {
  const auto at = by_unique_id_.find(unique_id);
  return at == by_unique_id_.end() ? pugi::xml_node{} : at->second;
}

/// Resolves enums and derived types to their simple type, array or struct.
ResolvedType ApplicationProcess::resolve_type(pugi::xml_node element) const {
  ResolvedType result;
  pugi::xml_node enumeration;
  for (int length = 0; length < longest_chain && element; ++length) {
    pugi::xml_node next;
    if (!enumeration && local_name(element) == "enum") enumeration = element;
    for_each_element(element, [&](pugi::xml_node child) {
      if (const SimpleType* simple = find_simple_type(local_name(child))) {
        if (result.simple == nullptr) result = {simple, xml_.position(child), {}};
      } else if (local_name(child) == "dataTypeIDRef") {
        next = find(find_attribute(child, "uniqueIDRef").value());
      }
    });
    if (result.simple != nullptr) {
      result.enumeration = enumeration;
      return result;
    }
    if (is_array_or_struct(next)) return {nullptr, xml_.position(element), next};
    element = next;
  }
  return result;
}

/// The elements with a number in the attribute `value` and a label.
std::vector<ValueName> ApplicationProcess::names_in(pugi::xml_node list, std::string_view element) const {
  std::vector<ValueName> names;
  for_each_element(list, [&](pugi::xml_node child) {
    if (local_name(child) != element) return;
    const ValueName one{xml_.value(find_attribute(child, "value")), xml_.text(find_label(child))};
    if (!one.value.empty() && !one.name.empty()) names.push_back(one);
  });
  return names;
}

std::vector<ValueName> ApplicationProcess::value_names(const ResolvedType& type) const {
  return names_in(type.enumeration, "enumValue");
}

ResolvedType ApplicationProcess::member_type(pugi::xml_node array_or_struct, std::string_view name) const {
  if (local_name(array_or_struct) == "array") return resolve_type(array_or_struct);
  const pugi::xml_node member = array_or_struct.find_child([&](pugi::xml_node child) {
    return local_name(child) == "varDeclaration" && name == find_attribute(child, "name").value();
  });
  return resolve_type(member);
}

Parameter ApplicationProcess::read_parameter(pugi::xml_attribute reference) {
  Parameter parameter;
  if (!reference || std::string_view{reference.value()}.empty()) return parameter;
  const pugi::xml_node element = find(reference.value());
  if (!element) {
    xml_.diagnostics().warning(
        "xml-element", xml_.value(reference).position,
        fmt::format("no element of ApplicationProcess has the uniqueID {}", quote(reference.value())));
    return parameter;
  }
  read_part(element, parameter);
  if (const pugi::xml_attribute id = find_attribute(element, "templateIDRef")) read_part(find(id.value()), parameter);

  EntryDescription& entry = parameter.entry;
  if (local_name(element) == "parameter" && !entry.access_type.present) {
    entry.access_type = {default_access_type, xml_.position(element), false};
  }
  const bool has_value = entry.default_value.present || entry.parameter_value.present;
  if (parameter.type.simple != nullptr && parameter.type.simple->name == bit_string && !has_value) {
    parameter.type.simple = &domain_type();
  }
  if (parameter.type.simple != nullptr) {
    entry.data_type = {parameter.type.simple->data_type, parameter.type.position, true};
  }
  return parameter;
}

/// Reads a parameter or its template: fills in missing fields.
void ApplicationProcess::read_part(pugi::xml_node element, Parameter& parameter) {
  if (!element) return;
  read_access(element, parameter);
  if (parameter.type.simple == nullptr && !parameter.type.array_or_struct) parameter.type = resolve_type(element);
  if (parameter.entry.value_names.empty()) parameter.entry.value_names = value_names(parameter.type);
  set_if_missing(parameter.entry.parameter_name, xml_.text(find_label(element)));
  set_if_missing(parameter.entry.parameter_name, xml_.value(find_attribute(element, "name")));
  if (const pugi::xml_node allowed = find_child(element, "allowedValues")) read_allowed_values(allowed, parameter);
  if (const pugi::xml_node unit = find_child(element, "unit")) read_unit(element, unit, parameter.entry);
  for_each_element(element, [&](pugi::xml_node child) { read_child(child, parameter); });
}

/// The unit by its label, and the multiplier of the parameter or that of the unit. By CiA 311, the engineering value is
/// (value + offset) * multiplier; an EDS has value * Factor + Offset. Two multipliers are not read: CiA 311 does not
/// state how they are combined.
void ApplicationProcess::read_unit(pugi::xml_node element, pugi::xml_node unit, EntryDescription& entry) {
  if (entry.unit.present) return;
  const auto differs_from = [](const Field& field, double neutral) {
    const auto number = parse_real(trim(field.text));
    return !field.empty() && (!number || *number != neutral);
  };
  const Field of_unit = xml_.value(find_attribute(unit, "multiplier"));
  const Field of_parameter = xml_.value(find_attribute(element, "multiplier"));
  Field offset = xml_.value(find_attribute(element, "offset"));
  const bool is_of_parameter = differs_from(of_parameter, 1), has_offset = differs_from(offset, 0);
  if (is_of_parameter && differs_from(of_unit, 1)) {
    xml_.note_once("xml-element", "unit", xml_.position(unit),
                   "a unit with two multipliers is not read, here and elsewhere");
    return;
  }
  const Field& multiplier = is_of_parameter ? of_parameter : of_unit;
  if (has_offset && differs_from(multiplier, 1)) {
    const auto product = product_of_decimals(trim(offset.text), trim(multiplier.text));
    if (!product) {
      xml_.note_once("xml-element", "offset", offset.position,
                     "a unit whose offset times multiplier is not a decimal is not read, here and elsewhere");
      return;
    }
    offset.text = xml_.keep(*product);
  }
  entry.unit = xml_.text(find_label(unit));
  if (!entry.unit.present) return;
  entry.factor = multiplier;
  if (has_offset) entry.offset = offset;
}

void ApplicationProcess::read_access(pugi::xml_node element, Parameter& parameter) {
  const Field word = xml_.value(find_attribute(element, "access"));
  Field& access_type = parameter.entry.access_type;
  if (!word.present || access_type.present) return;
  access_type = word;
  for (const AccessWord& row : access_words) {
    if (equal_ignoring_case(row.word, word.text)) access_type.text = row.access_type;
  }
  if (equal_ignoring_case(word.text, "noAccess")) {
    access_type.text = default_access_type;
    xml_.diagnostics().warning("access-type", word.position, "CiA 306 cannot express noAccess; assuming ro");
  }
}

void ApplicationProcess::read_child(pugi::xml_node child, Parameter& parameter) {
  const std::string_view name = local_name(child);
  for (const ValueElement& row : value_elements) {
    if (name != row.name) continue;
    set_if_missing(parameter.entry.*row.field, xml_.value(find_attribute(child, "value")));
    return;
  }
  if (name == "unit") return;
  for (const std::string_view silent : silent_elements) {
    if (name != silent) continue;
    if (name != "dataTypeIDRef" && name != "allowedValues") note_silent(xml_, child);
    return;
  }
  if (name == "property") {
    read_property(child, parameter);
  } else if (name == "denotation") {
    set_if_missing(parameter.entry.denotation, xml_.text(find_label(child)));
  } else if (name != "label" && find_simple_type(name) == nullptr) {
    report_unknown_element(xml_, child);
  }
}

void ApplicationProcess::read_property(pugi::xml_node property, Parameter& parameter) {
  const std::string_view name = find_attribute(property, "name").value();
  if (name == disabled_property) {
    parameter.is_disabled = equal_ignoring_case(find_attribute(property, "value").value(), "true");
    return;
  }
  xml_.note_once("xml-element", "property " + std::string{name}, xml_.position(property),
                 fmt::format("property {} is tool-specific; ignored, here and elsewhere", quote(name)));
}

/// A single range becomes LowLimit and HighLimit. An EDS cannot express more.
void ApplicationProcess::read_allowed_values(pugi::xml_node element, Parameter& parameter) {
  if (const pugi::xml_attribute id = find_attribute(element, "templateIDRef")) {
    if (const pugi::xml_node found = find(id.value())) element = found;
  }
  if (parameter.entry.value_names.empty()) parameter.entry.value_names = names_in(element, "value");
  pugi::xml_node range;
  int others = 0;
  for_each_element(element, [&](pugi::xml_node child) {
    if (local_name(child) == "range" && !range) {
      range = child;
    } else if (local_name(child) == "range" || local_name(child) == "value") {
      ++others;
    }
  });
  if (others > 0) {
    xml_.diagnostics().warning(
        "xml-element", xml_.position(element),
        "allowedValues has more than one range, which limits cannot express; the limits are ignored");
  } else if (range) {
    read_range(range, parameter.entry);
  }
}

void ApplicationProcess::read_range(pugi::xml_node range, EntryDescription& entry) {
  set_if_missing(entry.low_limit, xml_.value(find_attribute(find_child(range, "minValue"), "value")));
  set_if_missing(entry.high_limit, xml_.value(find_attribute(find_child(range, "maxValue"), "value")));
}

}  // namespace edsc

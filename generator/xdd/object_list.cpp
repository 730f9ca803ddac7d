#include "xdd/object_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "xdd/attributes.hpp"

namespace edsc {
namespace {

using canopen::Mappable;

/// Attributes of CANopenObject and CANopenSubObject.
constexpr AttributeRow<EntryDescription> entry_rows[] = {
    {"index", nullptr, AttributeForm::text, true},
    {"subIndex", nullptr, AttributeForm::text, true},
    {"subNumber", nullptr, AttributeForm::text, true},
    {"uniqueIDRef", nullptr, AttributeForm::text, true},
    {"name", &EntryDescription::parameter_name},
    {"objectType", &EntryDescription::object_type, AttributeForm::decimal},
    {"dataType", &EntryDescription::data_type, AttributeForm::hexadecimal},
    {"accessType", &EntryDescription::access_type},
    {"PDOmapping", &EntryDescription::pdo_mapping},
    {"defaultValue", &EntryDescription::default_value},
    {"actualValue", &EntryDescription::parameter_value},
    {"lowLimit", &EntryDescription::low_limit},
    {"highLimit", &EntryDescription::high_limit},
    {"denotation", &EntryDescription::denotation},
    {"objFlags", &EntryDescription::obj_flags, AttributeForm::hexadecimal},
};

constexpr std::span<const AttributeRow<EntryDescription>> entry_attributes = entry_rows;

/// Attributes that the parameter of an object determines. Those of the object are used if the parameter does not have
/// them.
constexpr Field EntryDescription::*parameter_fields[] = {
    &EntryDescription::data_type,  &EntryDescription::access_type,   &EntryDescription::low_limit,
    &EntryDescription::high_limit, &EntryDescription::default_value, &EntryDescription::parameter_value,
    &EntryDescription::denotation, &EntryDescription::unit,          &EntryDescription::factor,
    &EntryDescription::offset,
};

/// Values that may be true or false for a BOOLEAN.
constexpr Field EntryDescription::*value_fields[] = {
    &EntryDescription::default_value,
    &EntryDescription::parameter_value,
};

/// PDOmapping, and the PDOs that it allows.
struct MappingWord {
  std::string_view word;
  Mappable mappable;
};

constexpr MappingWord mapping_words[] = {
    {"no", Mappable::no},     {"default", Mappable::both}, {"optional", Mappable::both},
    {"TPDO", Mappable::tpdo}, {"RPDO", Mappable::rpdo},
};

Mappable common(Mappable a, Mappable b) {
  return static_cast<Mappable>(static_cast<unsigned>(a) & static_cast<unsigned>(b));
}

/// An index or sub-index: hexadecimal digits, usually without 0x.
std::optional<std::uint16_t> read_hex(std::string_view text, std::size_t max_digits) {
  const bool has_prefix = starts_with_ignoring_case(text, "0x");
  return parse_hex(text.substr(has_prefix ? 2 : 0), max_digits);
}

using FirstPlaces = std::unordered_map<std::uint16_t, Position>;

SheetPart part_at(const XmlDocument& xml, pugi::xml_node element) {
  const Position position = xml.position(element);
  SheetPart part;
  part.line = position.line;
  part.column = position.column;
  return part;
}

/// The first element after the end of this one, or null.
pugi::xml_node next_element(pugi::xml_node element) {
  for (; element; element = element.parent()) {
    for (pugi::xml_node next = element.next_sibling(); next; next = next.next_sibling()) {
      if (next.type() == pugi::node_element) return next;
    }
  }
  return {};
}

class ObjectListReader {
 public:
  ObjectListReader(XmlDocument& xml, ApplicationProcess& process) : xml_{xml}, process_{process} {}

  std::vector<ObjectDescription> read(pugi::xml_node list) {
    std::vector<ObjectDescription> objects;
    for_each_element(list, [&](pugi::xml_node element) {
      if (local_name(element) == "CANopenObject") {
        read_object(element, objects);
      } else {
        report_unknown_element(xml_, element);
      }
    });
    std::ranges::sort(objects, {}, &ObjectDescription::index);
    return objects;
  }

 private:
  void read_object(pugi::xml_node element, std::vector<ObjectDescription>& objects) {
    const std::optional<std::uint16_t> index = read_number(element, "index", 4);
    if (!index || !is_first(element, *index, first_objects_)) return;
    first_sub_objects_.clear();
    ObjectDescription object;
    object.index = *index;
    const Parameter parameter = read_entry(element, object);
    finish(object);
    if (parameter.is_disabled) {
      xml_.diagnostics().note("xml-element", object.position,
                              fmt::format("{:04X}h is disabled by the property CO_disabled; ignored", *index), {},
                              "CO_disabled");
      return;
    }
    const Field sub_number = xml_.value(find_attribute(element, "subNumber"));
    object.sub_number = respell(xml_, sub_number, AttributeForm::decimal);
    read_sub_objects(element, parameter, object);
    report_complex_value(parameter, object);
    objects.push_back(std::move(object));
  }

  void read_sub_objects(pugi::xml_node element, const Parameter& of_object, ObjectDescription& object) {
    for_each_element(element, [&](pugi::xml_node child) {
      if (local_name(child) == "CANopenSubObject") {
        read_sub_object(child, of_object, object.sub_objects);
      } else {
        report_unknown_element(xml_, child);
      }
    });
    std::ranges::sort(object.sub_objects, {}, &SubObjectDescription::sub_index);
  }

  void read_sub_object(pugi::xml_node element, const Parameter& of_object, std::vector<SubObjectDescription>& list) {
    const std::optional<std::uint16_t> sub_index = read_number(element, "subIndex", 2);
    if (!sub_index || !is_first(element, *sub_index, first_sub_objects_)) return;
    SubObjectDescription sub_object;
    sub_object.sub_index = static_cast<std::uint8_t>(*sub_index);
    static_cast<void>(read_entry(element, sub_object));
    take_from_object(of_object, sub_object);
    finish(sub_object);
    list.push_back(sub_object);
  }

  std::optional<std::uint16_t> read_number(pugi::xml_node element, std::string_view name, std::size_t max_digits) {
    const Field field = xml_.value(find_attribute(element, name));
    const std::optional<std::uint16_t> number = read_hex(field.text, max_digits);
    if (!number) {
      xml_.diagnostics().error("number", field.present ? field.position : xml_.position(element),
                               fmt::format("{} {} is not a number of up to {} hexadecimal digits; this {} is ignored",
                                           name, quote(field.text), max_digits, local_name(element)));
    }
    return number;
  }

  /// Reads the attributes of the element, and its parameter.
  Parameter read_entry(pugi::xml_node element, EntryDescription& entry) {
    entry.position = xml_.position(element);
    place_attributes(entry_attributes, entry.position, entry);
    read_attributes(xml_, element, entry_attributes, entry);
    Parameter parameter = process_.read_parameter(find_attribute(element, "uniqueIDRef"));
    for (Field EntryDescription::*const field : parameter_fields) {
      if ((parameter.entry.*field).present) entry.*field = parameter.entry.*field;
    }
    entry.value_names = parameter.entry.value_names;
    take_if_missing(parameter.entry.access_type, entry.access_type);
    take_if_missing(parameter.entry.parameter_name, entry.parameter_name);
    return parameter;
  }

  static void take_if_missing(const Field& from, Field& to) {
    if (to.present || from.text.empty()) return;
    to = from;
    to.present = true;
  }

  /// A sub-object without a data type gets it from the array or struct of its object.
  void take_from_object(const Parameter& of_object, SubObjectDescription& sub_object) {
    const pugi::xml_node type = of_object.type.array_or_struct;
    const bool is_count_of_array = sub_object.sub_index == 0 && local_name(type) == "array";
    if (!type || sub_object.data_type.present || is_count_of_array) return;
    const ResolvedType member = process_.member_type(type, sub_object.parameter_name.text);
    if (member.simple == nullptr) return;
    sub_object.data_type = {member.simple->data_type, member.position, true};
    sub_object.value_names = process_.value_names(member);
    take_if_missing(of_object.entry.access_type, sub_object.access_type);
  }

  void report_complex_value(const Parameter& parameter, const ObjectDescription& object) {
    if (!parameter.type.array_or_struct || !object.sub_objects.empty() || object.data_type.present) return;
    xml_.diagnostics().warning("xml-element", object.position,
                               fmt::format("the parameter of {:04X}h is of the type {}; an object of this type needs "
                                           "sub-objects",
                                           object.index, local_name(parameter.type.array_or_struct)));
  }

  /// Converts values that depend on more than one attribute to EDS spelling.
  void finish(EntryDescription& entry) {
    map_to_access(entry);
    if (parse_unsigned(entry.data_type.text) != 1) return;
    for (Field EntryDescription::*const field : value_fields) {
      entry.*field = respell(xml_, entry.*field, AttributeForm::flag);
    }
  }

  /// CiA 306 can express "RPDO only" and "TPDO only" by the access type only: an rw object that PDOmapping allows for
  /// TPDOs only is rwr, for RPDOs only rww; the other access types imply one direction.
  void map_to_access(EntryDescription& entry) {
    Field& mapping = entry.pdo_mapping;
    for (const MappingWord& row : mapping_words) {
      if (mapping.present && equal_ignoring_case(row.word, mapping.text)) {
        const bool fits = restrict_access(row.mappable, entry.access_type);
        if (!fits) report_direction(entry);
        mapping.text = fits && row.mappable != Mappable::no ? "1" : "0";
        return;
      }
    }
  }

  /// Returns false if no direction remains.
  static bool restrict_access(Mappable mappable, Field& access_type) {
    for (const canopen::AccessRow& row : canopen::access_rows) {
      if (!equal_ignoring_case(row.name, access_type.text) || mappable == Mappable::no) continue;
      const Mappable by_access = canopen::mappable_by(row.access);
      const Mappable left = common(by_access, mappable);
      if (left == by_access) return true;
      if (left == Mappable::no) return false;
      access_type.text = left == Mappable::tpdo ? "rwr" : "rww";
      return true;
    }
    return true;
  }

  void report_direction(const EntryDescription& entry) {
    xml_.diagnostics().warning("pdo-mapping", entry.pdo_mapping.position,
                               fmt::format("PDOmapping is {}, but no such PDO can map an object with access {}; it "
                                           "is not PDO-mappable",
                                           entry.pdo_mapping.text, entry.access_type.text));
  }

  /// Of duplicate objects, or sub-objects of one object, the first is used.
  bool is_first(pugi::xml_node element, std::uint16_t number, FirstPlaces& first_places) {
    const auto [first, is_new] = first_places.try_emplace(number, xml_.position(element));
    if (is_new) return true;
    xml_.diagnostics().warning("duplicate-section", xml_.position(element),
                               fmt::format("duplicate {:X}h; using the first", number),
                               {{first->second, "the first one"}});
    return false;
  }

  XmlDocument& xml_;
  ApplicationProcess& process_;
  FirstPlaces first_objects_;
  FirstPlaces first_sub_objects_;  ///< of the current object
};

}  // namespace

std::vector<ObjectDescription> read_object_list(XmlDocument& xml, pugi::xml_node list, ApplicationProcess& process) {
  return ObjectListReader{xml, process}.read(list);
}

SheetOutline outline_of(const XmlDocument& xml, pugi::xml_node list) {
  SheetOutline outline{&xml.source(), {}, {}};
  for_each_element(list, [&](pugi::xml_node object) {
    SheetPart part = part_at(xml, object);
    part.index = read_hex(find_attribute(object, "index").value(), 4);
    if (part.index) part.sub_index = 0;
    outline.parts.push_back(part);
    for_each_element(object, [&](pugi::xml_node sub_object) {
      SheetPart sub_part = part_at(xml, sub_object);
      const auto sub_index = read_hex(find_attribute(sub_object, "subIndex").value(), 2);
      sub_part.index = part.index;
      if (sub_index) sub_part.sub_index = static_cast<std::uint8_t>(*sub_index);
      outline.parts.push_back(sub_part);
    });
  });
  if (const pugi::xml_node next = next_element(list)) outline.parts.push_back(part_at(xml, next));
  return outline;
}

}  // namespace edsc

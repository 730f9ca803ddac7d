/// Reading the attributes of an element into the members of a struct, by a table.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// Forms of values that differ between CiA 311 and CiA 306.
enum class AttributeForm : std::uint8_t {
  text,         ///< the same
  decimal,      ///< `04`, which is octal in CiA 306
  hexadecimal,  ///< `0007` for 0x0007
  identity,     ///< a vendor-ID: decimal, with 0x, or eight hexadecimal digits
  flag,         ///< `true` for 1
  baud_rate,    ///< `500 Kbps` for 500
  date,         ///< `2024-05-31` for 05-31-2024
  time,         ///< `14:05:00+02:00` for 02:05PM
};

/// The value in the form of CiA 306; an invalid value is unchanged, and reported later.
[[nodiscard]] Field respell(XmlDocument& xml, const Field& field, AttributeForm form);

/// An attribute and its destination; null for a known attribute without effect on the device.
template <typename Struct>
struct AttributeRow {
  std::string_view name;
  Field Struct::*field;
  AttributeForm form = AttributeForm::text;
  bool is_structure = false;  ///< describes the structure of the file, not the device
};

void report_unknown_attribute(XmlDocument& xml, pugi::xml_node element, pugi::xml_attribute attribute);
void report_unknown_element(XmlDocument& xml, pugi::xml_node element);
void report_second(XmlDocument& xml, pugi::xml_attribute attribute, const Position& first);

/// Notes an element or attribute that an EDS cannot express, unless it is empty or false.
void note_silent(XmlDocument& xml, pugi::xml_node element);
void note_silent(XmlDocument& xml, pugi::xml_node element, pugi::xml_attribute attribute);

/// Namespaces and schema locations, which are not attributes of CiA 311.
[[nodiscard]] bool is_of_xml_itself(pugi::xml_attribute attribute);

/// Sets the position of each field, in case it is missing.
template <typename Struct>
void place_attributes(std::span<const AttributeRow<Struct>> rows, const Position& position, Struct& target) {
  for (const AttributeRow<Struct>& row : rows) {
    if (row.field != nullptr) (target.*row.field).position = position;
  }
}

template <typename Struct>
void read_attributes(XmlDocument& xml, pugi::xml_node element, std::span<const AttributeRow<Struct>> rows,
                     Struct& target) {
  for (const pugi::xml_attribute attribute : element.attributes()) {
    if (is_of_xml_itself(attribute)) continue;
    const AttributeRow<Struct>* known = nullptr;
    for (const AttributeRow<Struct>& row : rows) {
      if (equal_ignoring_case(row.name, local_name(attribute))) known = &row;
    }
    if (known == nullptr) {
      report_unknown_attribute(xml, element, attribute);
    } else if (known->field == nullptr) {
      if (!known->is_structure) note_silent(xml, element, attribute);
    } else if ((target.*known->field).present) {
      report_second(xml, attribute, (target.*known->field).position);
    } else {
      target.*known->field = respell(xml, xml.value(attribute), known->form);
    }
  }
}

}  // namespace edsc

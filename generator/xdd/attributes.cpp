#include "xdd/attributes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "diagnostics/quote.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

bool are_digits(std::string_view text) { return !text.empty() && std::all_of(text.begin(), text.end(), is_digit); }
bool are_hex_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_hex_digit);
}

std::string_view without_leading_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

std::string_view decimal(std::string_view text) { return are_digits(text) ? without_leading_zeros(text) : text; }

std::string_view hexadecimal(XmlDocument& xml, std::string_view text) {
  return are_hex_digits(text) ? xml.keep(fmt::format("0x{}", text)) : text;
}

std::string_view identity(XmlDocument& xml, std::string_view text) {
  constexpr std::size_t digits_of_unsigned32 = 8;
  const bool is_hexadecimal = are_hex_digits(text) && (!are_digits(text) || text.size() == digits_of_unsigned32);
  return is_hexadecimal ? hexadecimal(xml, text) : decimal(text);
}

std::string_view flag(std::string_view text) {
  if (equal_ignoring_case(text, "true")) return "1";
  return equal_ignoring_case(text, "false") ? "0" : text;
}

std::string_view baud_rate(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const std::string_view number = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  const std::string_view unit = trim(text.substr(number.size()));
  return unit.empty() || equal_ignoring_case(unit, "Kbps") ? decimal(number) : text;
}

/// Whether a text matches `pattern`, in which `0` is any digit.
bool has_form(std::string_view text, std::string_view pattern) {
  return text.size() >= pattern.size() && std::equal(pattern.begin(), pattern.end(), text.begin(),
                                                     [](char p, char c) { return p == '0' ? is_digit(c) : p == c; });
}

std::string_view date(XmlDocument& xml, std::string_view text) {
  if (!has_form(text, "0000-00-00")) return text;
  return xml.keep(fmt::format("{}-{}", text.substr(5, 5), text.substr(0, 4)));
}

std::string_view time(XmlDocument& xml, std::string_view text) {
  if (!has_form(text, "00:00")) return text;
  const int hour = (text[0] - '0') * 10 + (text[1] - '0');
  return xml.keep(
      fmt::format("{:02}:{}{}", hour % 12 == 0 ? 12 : hour % 12, text.substr(3, 2), hour < 12 ? "AM" : "PM"));
}

std::string_view respelled(XmlDocument& xml, std::string_view text, AttributeForm form) {
  switch (form) {
    case AttributeForm::text: return text;
    case AttributeForm::decimal: return decimal(text);
    case AttributeForm::hexadecimal: return hexadecimal(xml, text);
    case AttributeForm::identity: return identity(xml, text);
    case AttributeForm::flag: return flag(text);
    case AttributeForm::baud_rate: return baud_rate(text);
    case AttributeForm::date: return date(xml, text);
    case AttributeForm::time: return time(xml, text);
  }
  return text;
}

std::string path_of(pugi::xml_node element) {
  return std::string{local_name(element.parent())} + "/" + std::string{local_name(element)};
}

}  // namespace

Field respell(XmlDocument& xml, const Field& field, AttributeForm form) {
  Field result = field;
  result.text = respelled(xml, field.text, form);
  return result;
}

void report_unknown_attribute(XmlDocument& xml, pugi::xml_node element, pugi::xml_attribute attribute) {
  xml.note_once("xml-element", std::string{local_name(element)} + "@" + attribute.name(), xml.position(attribute),
                fmt::format("unknown attribute {} of {}; ignored, here and elsewhere", quote(attribute.name()),
                            local_name(element)));
}

void report_unknown_element(XmlDocument& xml, pugi::xml_node element) {
  xml.note_once("xml-element", path_of(element), xml.position(element),
                fmt::format("{} in {} is not read, here and elsewhere", quote(local_name(element)),
                            local_name(element.parent())));
}

void note_silent(XmlDocument& xml, pugi::xml_node element) {
  const bool says_something =
      element.first_attribute() || !std::string_view{element.text().get()}.empty() ||
      element.find_child([](pugi::xml_node child) { return child.type() == pugi::node_element; });
  if (says_something) xml.note_not_in_eds(path_of(element), xml.position(element));
}

void note_silent(XmlDocument& xml, pugi::xml_node element, pugi::xml_attribute attribute) {
  const std::string_view value = attribute.value();
  if (value.empty() || value == "0" || equal_ignoring_case(value, "false")) return;
  xml.note_not_in_eds(fmt::format("the attribute {} of {}", local_name(attribute), local_name(element)),
                      xml.position(attribute));
}

void report_second(XmlDocument& xml, pugi::xml_attribute attribute, const Position& first) {
  xml.diagnostics().warning("duplicate-key", xml.position(attribute),
                            fmt::format("duplicate attribute {} in this element; using the first", attribute.name()),
                            {{first, "the first one"}});
}

bool is_of_xml_itself(pugi::xml_attribute attribute) {
  const std::string_view name = attribute.name();
  return name == "xmlns" || name.starts_with("xmlns:") || name.starts_with("xml:") || name.starts_with("xsi:") ||
         local_name(attribute) == "schemaLocation" || (name.find(':') != name.npos && local_name(attribute) == "type");
}

}  // namespace edsc

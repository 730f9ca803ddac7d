#include "xdd/xml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "diagnostics/place.hpp"
#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// Upper bound of elements and attributes, against hostile files that exhaust memory. A device with 10,000 entries has
/// about 300,000.
constexpr std::ptrdiff_t max_nodes = 8'000'000;

constexpr std::string_view xml_blanks = " \t\r\n";

std::string_view trim_xml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(xml_blanks);
  if (first == std::string_view::npos) return text.substr(0, 0);
  return text.substr(first, text.find_last_not_of(xml_blanks) - first + 1);
}

std::string_view without_prefix(std::string_view name) { return name.substr(name.rfind(':') + 1); }

/// XML 1.0, 2.2: no other control characters.
bool is_forbidden(char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r'; }

/// XML 1.0, 4.6: these need no declaration.
constexpr std::string_view predefined_entities[] = {"amp;", "lt;", "gt;", "apos;", "quot;", "#"};

bool uses_declared_entity(std::string_view text) {
  for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
    const std::string_view name = text.substr(at + 1);
    if (std::ranges::none_of(predefined_entities, [&](std::string_view known) { return name.starts_with(known); })) {
      return true;
    }
  }
  return false;
}

bool is_text(pugi::xml_node node) { return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata; }

}  // namespace

std::string_view local_name(pugi::xml_node element) { return without_prefix(element.name()); }
std::string_view local_name(pugi::xml_attribute attribute) { return without_prefix(attribute.name()); }

pugi::xml_node find_child(pugi::xml_node element, std::string_view name) {
  return element.find_child([&](pugi::xml_node child) {
    return child.type() == pugi::node_element && equal_ignoring_case(local_name(child), name);
  });
}

pugi::xml_attribute find_attribute(pugi::xml_node element, std::string_view name) {
  return element.find_attribute(
      [&](pugi::xml_attribute attribute) { return equal_ignoring_case(local_name(attribute), name); });
}

XmlDocument::XmlDocument(const SourceFile& source, Diagnostics& diagnostics)
    : source_{source}, diagnostics_{diagnostics} {
  if (report_unreadable_text()) return;
  buffer_ = source_.text();
  parse();
}

bool XmlDocument::report_unreadable_text() {
  const std::string_view text = source_.text();
  const auto control = std::find_if(text.begin(), text.end(), is_forbidden);
  if (control != text.end()) {
    diagnostics_.error("xml-syntax", position_at(source_, static_cast<std::size_t>(control - text.begin())),
                       "control character, which XML does not allow; nothing of this file is read");
    return true;
  }
  if (std::count_if(text.begin(), text.end(), [](char c) { return c == '<' || c == '='; }) > max_nodes) {
    diagnostics_.error("xml-syntax", {&source_},
                       fmt::format("more than {} elements and attributes; nothing of this file is read", max_nodes));
    return true;
  }
  return false;
}

/// The text is already UTF-8, regardless of the XML declaration.
void XmlDocument::parse() {
  const pugi::xml_parse_result result = document_.load_buffer_inplace(
      buffer_.data(), buffer_.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (result) {
    find_root();
    return;
  }
  std::string why = result.description();
  why[0] = to_lower(why[0]);
  diagnostics_.error("xml-syntax",
                     position_at(source_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
                     fmt::format("this is not well-formed XML: {}; nothing of this file is read", why));
}

void XmlDocument::find_root() {
  for (const pugi::xml_node node : document_.children()) {
    if (node.type() == pugi::node_doctype) {
      report_doctype(node);
    } else if (is_text(node)) {
      diagnostics_.warning("xml-syntax", {&source_}, "text outside of the root element is ignored");
    } else if (node.type() == pugi::node_element && root_) {
      diagnostics_.error("xml-syntax", position(node), "a second root element; ignored");
      return;
    } else if (node.type() == pugi::node_element) {
      root_ = node;
    }
  }
}

/// Harmless if the name of a DTD is all that it has: values are written in the file itself.
void XmlDocument::report_doctype(pugi::xml_node doctype) {
  constexpr const char* message =
      "the document type declaration is not read; entities that it defines are not replaced";
  const bool has_declarations = std::string_view{doctype.value()}.find('[') != std::string_view::npos;
  if (has_declarations || uses_declared_entity(source_.text())) {
    diagnostics_.warning("xml-element", {&source_}, message);
  } else {
    diagnostics_.note("xml-element", {&source_}, message);
  }
}

/// `part` comes from pugixml and points into the buffer, except for a missing name or value.
Position XmlDocument::position_of(std::string_view part) const {
  const std::less<> before;
  const char* const begin = buffer_.data();
  if (before(part.data(), begin) || before(begin + buffer_.size(), part.data())) return {&source_};
  return position_at(source_, static_cast<std::size_t>(part.data() - begin), part.size());
}

Position XmlDocument::position(pugi::xml_node element) const { return position_of(std::string_view{element.name()}); }

Position XmlDocument::position(pugi::xml_attribute attribute) const {
  return position_of(std::string_view{attribute.name()});
}

/// The same text in the source file if it occurs there unchanged, otherwise a copy.
std::string_view XmlDocument::stored(std::string_view part) {
  if (part.empty()) return {};
  const auto offset = static_cast<std::size_t>(part.data() - buffer_.data());
  const std::string_view in_source = source_.text().substr(offset, part.size());
  return in_source == part ? in_source : keep(std::string{part});
}

Field XmlDocument::value(pugi::xml_attribute attribute) {
  if (!attribute) return {};
  const std::string_view value = trim_xml(attribute.value());
  return {stored(value), position_of(value), true};
}

Field XmlDocument::text(pugi::xml_node element) {
  if (!element) return {};
  std::string_view whole;
  std::string joined;  // of the parts that comments and CDATA cut the text into
  for (const pugi::xml_node child : element.children()) {
    if (!is_text(child)) continue;
    if (!whole.empty() && joined.empty()) joined = whole;
    if (whole.empty()) whole = child.value();
    if (!joined.empty()) joined += child.value();
  }
  const std::string_view trimmed = trim_xml(whole);
  const Position place = trimmed.empty() ? position(element) : position_of(trimmed);
  if (joined.empty()) return {stored(trimmed), place, true};
  return {keep(std::string{trim_xml(joined)}), place, true};
}

std::string_view XmlDocument::keep(std::string text) { return texts_->emplace_back(std::move(text)); }

void XmlDocument::note_once(NoteRule rule, const std::string& what, const Position& position,
                            const std::string& message) {
  if (warned_.insert(what).second) diagnostics_.note(rule, position, message);
}

void XmlDocument::note_not_in_eds(std::string what, const Position& position) {
  if (noted_.insert(what).second) not_in_eds_.push_back({position, std::move(what)});
}

}  // namespace edsc

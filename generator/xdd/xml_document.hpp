/// A well-formed XML file with the positions of its elements and attributes.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "xdd/not_in_eds.hpp"

namespace edsc {

/// The name without namespace prefix: `DeviceIdentity` of `q1:DeviceIdentity`. Each file may use any or no prefix for
/// the namespace of CiA 311.
[[nodiscard]] std::string_view local_name(pugi::xml_node element);
[[nodiscard]] std::string_view local_name(pugi::xml_attribute attribute);

/// The first child element or the attribute of this local name, ignoring letter case, or null.
[[nodiscard]] pugi::xml_node find_child(pugi::xml_node element, std::string_view name);
[[nodiscard]] pugi::xml_attribute find_attribute(pugi::xml_node element, std::string_view name);

/// Calls a function for each child element.
template <typename Use>
void for_each_element(pugi::xml_node parent, Use use) {
  for (const pugi::xml_node child : parent.children()) {
    if (child.type() == pugi::node_element) use(child);
  }
}

class XmlDocument {
 public:
  /// Reports a file that is not well-formed; `root()` is then null.
  XmlDocument(const SourceFile& source, Diagnostics& diagnostics);

  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  [[nodiscard]] pugi::xml_node root() const { return root_; }
  [[nodiscard]] const SourceFile& source() const { return source_; }
  [[nodiscard]] Diagnostics& diagnostics() const { return diagnostics_; }

  /// The position of the element's name; of the file if the element is null.
  [[nodiscard]] Position position(pugi::xml_node element) const;
  [[nodiscard]] Position position(pugi::xml_attribute attribute) const;

  /// The value of an attribute, without blanks around it; not present if the attribute is null.
  [[nodiscard]] Field value(pugi::xml_attribute attribute);
  /// The text in an element, without blanks around it.
  [[nodiscard]] Field text(pugi::xml_node element);

  /// Stores a text that does not occur in the file.
  [[nodiscard]] std::string_view keep(std::string text);
  /// The texts stored by `keep`, and values with entities, to which the data sheet points.
  [[nodiscard]] std::shared_ptr<const std::deque<std::string>> kept_texts() const { return texts_; }

  /// Reports the first occurrence of something that may occur often; `what` identifies it.
  void note_once(NoteRule rule, const std::string& what, const Position& position, const std::string& message);

  /// Notes that an EDS cannot express an element or attribute, such as `DeviceIdentity/deviceFamily`; each name once.
  void note_not_in_eds(std::string what, const Position& position);
  [[nodiscard]] std::vector<NotInEds> take_not_in_eds() { return std::move(not_in_eds_); }

 private:
  void parse();
  void find_root();
  void report_doctype(pugi::xml_node doctype);
  [[nodiscard]] bool report_unreadable_text();
  [[nodiscard]] Position position_of(std::string_view part) const;
  [[nodiscard]] std::string_view stored(std::string_view part);

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::string buffer_;  ///< pugixml parses in place: names and values have the same offset as in the file
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::shared_ptr<std::deque<std::string>> texts_ = std::make_shared<std::deque<std::string>>();
  std::unordered_set<std::string> warned_;
  std::unordered_set<std::string> noted_;
  std::vector<NotInEds> not_in_eds_;
};

}  // namespace edsc

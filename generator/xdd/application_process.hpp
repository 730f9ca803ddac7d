/// ApplicationProcess: the parameters that objects refer to by uniqueIDRef, and their data types.
#pragma once

#include <string_view>
#include <unordered_map>

#include "eds/data_sheet.hpp"
#include "xdd/simple_type.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// What the type of a parameter, array or struct member comes to.
struct ResolvedType {
  const SimpleType* simple = nullptr;
  Position position;               ///< where it is named
  pugi::xml_node array_or_struct;  ///< null for a simple type
};

/// What a parameter says about the object that refers to it. Fields that it does not speak of are not present.
struct Parameter {
  EntryDescription entry;
  ResolvedType type;
  bool is_disabled = false;
};

class ApplicationProcess {
 public:
  /// `element` may be null.
  ApplicationProcess(XmlDocument& xml, pugi::xml_node element);

  /// Follows a uniqueIDRef; the parameter may leave things to its template. Nothing is present when `reference` names
  /// nothing, which is reported.
  [[nodiscard]] Parameter read_parameter(pugi::xml_attribute reference);

  /// The type of a sub-object that its object's array or struct describes: of an array the element's, of a struct that
  /// of the member with this name.
  [[nodiscard]] ResolvedType member_type(pugi::xml_node array_or_struct, std::string_view name) const;

 private:
  void add(pugi::xml_node element);
  [[nodiscard]] pugi::xml_node find(std::string_view unique_id) const;
  [[nodiscard]] ResolvedType resolve_type(pugi::xml_node element) const;
  void read_part(pugi::xml_node element, Parameter& parameter);
  void read_child(pugi::xml_node child, Parameter& parameter);
  void read_access(pugi::xml_node element, Parameter& parameter);
  void read_property(pugi::xml_node property, Parameter& parameter);
  void read_allowed_values(pugi::xml_node element, Parameter& parameter);
  void read_range(pugi::xml_node range, EntryDescription& entry);

  XmlDocument& xml_;
  std::unordered_map<std::string_view, pugi::xml_node> by_unique_id_;
};

}  // namespace edsc

/// ApplicationProcess: the parameters that objects refer to by uniqueIDRef, and their data types.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "eds/data_sheet.hpp"
#include "xdd/simple_type.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// The resolved type of a parameter, array or struct member.
struct ResolvedType {
  const SimpleType* simple = nullptr;
  Position position;                ///< of the reference
  pugi::xml_node array_or_struct;   ///< null for a simple type
  pugi::xml_node enumeration = {};  ///< null for another type
};

/// The properties of the object that refers to a parameter. Fields that the parameter does not define are not present.
struct Parameter {
  EntryDescription entry;
  ResolvedType type;
  bool is_disabled = false;
};

class ApplicationProcess {
 public:
  /// `element` may be null.
  ApplicationProcess(XmlDocument& xml, pugi::xml_node element);

  /// Resolves a uniqueIDRef, with the template of the parameter. If the reference is invalid, which is reported, no
  /// field is present.
  [[nodiscard]] Parameter read_parameter(pugi::xml_attribute reference);

  /// The type of a sub-object by the array or struct of its object: that of the array elements, or of the struct member
  /// with this name.
  [[nodiscard]] ResolvedType member_type(pugi::xml_node array_or_struct, std::string_view name) const;

  /// The names of values in an enumeration; empty for another type.
  [[nodiscard]] std::vector<ValueName> value_names(const ResolvedType& type) const;

 private:
  void add(pugi::xml_node element);
  [[nodiscard]] pugi::xml_node find(std::string_view unique_id) const;
  [[nodiscard]] ResolvedType resolve_type(pugi::xml_node element) const;
  void read_part(pugi::xml_node element, Parameter& parameter);
  void read_child(pugi::xml_node child, Parameter& parameter);
  void read_access(pugi::xml_node element, Parameter& parameter);
  void read_unit(pugi::xml_node element, pugi::xml_node unit, EntryDescription& entry);
  [[nodiscard]] std::vector<ValueName> names_in(pugi::xml_node list, std::string_view element) const;
  void read_property(pugi::xml_node property, Parameter& parameter);
  void read_allowed_values(pugi::xml_node element, Parameter& parameter);
  void read_range(pugi::xml_node range, EntryDescription& entry);

  XmlDocument& xml_;
  std::unordered_map<std::string_view, pugi::xml_node> by_unique_id_;
};

}  // namespace edsc

/// C++ names for a device, its objects and entries.
#pragma once

#include <string>
#include <string_view>

#include "backend/identifiers.hpp"

namespace edsc {

/// The type of an entry in the namespace of its device, in the two parts in which it is declared.
struct CppType {
  std::string object;  ///< `od::statusword`, `od::gains<1>` for an ARRAY of equal elements, `od::identity`
  std::string member;  ///< `::vendor_id`; empty if the object is the type of the entry

  [[nodiscard]] std::string text() const { return object + member; }
};

/// The names in generated code: the identifiers of the device, but reserved words have a trailing underscore.
class CppNames {
 public:
  /// `space`: the namespace of the device; that of the file name if it is empty.
  CppNames(const Device& device, const Options& options, std::string_view space = {});

  /// Those of the device without C++: for text, JSON and DBC.
  [[nodiscard]] const Identifiers& identifiers() const { return identifiers_; }
  [[nodiscard]] const std::string& space() const { return space_; }
  /// Unique in the device.
  [[nodiscard]] std::string of(const Object& object) const;
  /// Unique in the object; that of a VAR has the name of its object.
  [[nodiscard]] std::string of(const Entry& entry) const;
  [[nodiscard]] CppType type_of(const Object& object, const Entry& entry) const;

 private:
  Identifiers identifiers_;
  std::string space_;
};

/// A device and its names.
struct NamedDevice {
  const Device& device;
  const CppNames& names;

  [[nodiscard]] const Identifiers& identifiers() const { return names.identifiers(); }
};

}  // namespace edsc

/// The C++ types of entries with a meaning: enumerations, words of fields and quantities.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// The type of an entry in place of its raw number.
struct TypedValue {
  std::string type;                     ///< `meaning::statusword`, `canopen::Quantity<...>`
  const Enumeration* values = nullptr;  ///< of an enumeration
  std::vector<std::string> enumerators{};
  bool is_quantity = false;

  /// Whether the entry accepts only the named values.
  [[nodiscard]] bool is_closed() const { return values != nullptr && values->closed; }
};

/// Whether the entry of a device with typed values is an enumeration that accepts only the named values.
[[nodiscard]] bool is_closed_enumeration(const Entry& entry, const Options& options);

/// Those of a device. Without the option "typed_values", all values are raw numbers.
class TypedValues {
 public:
  TypedValues(const NamedDevice& named, const Options& options);

  /// Null for an entry whose values are raw numbers: without a meaning, with a unit that is not in the table, a
  /// BOOLEAN, a REAL, a string or a DOMAIN, and a signed integer with fields.
  [[nodiscard]] const TypedValue* find(const Entry& entry) const;

  /// Whether an entry has a type.
  [[nodiscard]] bool any() const { return !types_.empty(); }

  /// Whether all elements of an ARRAY of equal elements have one type, so that its template has it.
  [[nodiscard]] bool is_uniform(const Object& object) const;

  /// The definitions of the types; null if there are none.
  [[nodiscard]] const nlohmann::ordered_json& definitions() const { return definitions_; }
  /// The names of the values of each enumeration; null if there are none.
  [[nodiscard]] const nlohmann::ordered_json& names_of_values() const { return names_of_values_; }
  /// Whether types of a profile are among them.
  [[nodiscard]] bool uses_profile_types() const { return uses_profile_types_; }
  /// The objects with closed enumerations, as arguments of canopen::ObjectList; empty if there are none.
  [[nodiscard]] std::string closed_objects(const NamedDevice& named) const;

 private:
  void add(const NamedDevice& named, const Object& object, const Entry& entry, IdentifierScope& scope);

  [[nodiscard]] TypedValue type_of(const NamedDevice& named, const Object& object, const Entry& entry,
                                   IdentifierScope& scope);

  std::map<EntryKey, TypedValue> types_;
  std::map<std::pair<const Meaning*, const canopen::DataTypeRow*>, TypedValue> of_meanings_;
  std::map<std::string, std::string> defined_;  ///< names of types by what they contain
  nlohmann::ordered_json definitions_, names_of_values_;
  bool uses_profile_types_ = false;
};

}  // namespace edsc

/// Why an object cannot be in the mapping of a PDO.
#pragma once

#include <canopen/od/access.hpp>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <span>

#include "pdo/mapping.hpp"
#include "rules/check_rules.hpp"

namespace edsc {

enum class MappingFault : std::uint8_t {
  unknown_object,     ///< the entry does not exist
  not_mappable,       ///< PDOMapping is 0
  wrong_direction,    ///< AccessType does not allow the direction
  wrong_length,       ///< the length differs from the one of the object, or a string holds less
  variable_length,    ///< the data type does not have a length, or the length of a string is unknown
  part_of_a_byte,     ///< of a string
  dummy_in_tpdo,      ///< only RPDOs can map dummies
  dummy_not_allowed,  ///< [DummyUsage] does not list the type
  too_many_bits,      ///< of all objects
  too_many_objects,
};

/// The rule of a fault: an error, or a warning if the PDO is disabled by default.
using MappingRule = CheckRule<Severity::error, Severity::warning>;
[[nodiscard]] MappingRule rule_of(MappingFault fault);
[[nodiscard]] bool is_mapping_rule(RuleId rule);

/// What the EDS states about an object, as far as mappings need it.
struct MappableObject {
  const canopen::DataTypeRow* type = nullptr;
  canopen::Mappable mappable = canopen::Mappable::no;
  bool pdo_mapping = false;                    ///< PDOMapping
  std::optional<std::uint32_t> string_octets;  ///< of a string: the most bytes in a PDO; nothing if unknown
};

/// The PDOs of one direction.
[[nodiscard]] constexpr canopen::Mappable mappable_in(PdoDirection direction) {
  return direction == PdoDirection::receive ? canopen::Mappable::rpdo : canopen::Mappable::tpdo;
}

/// Whether a BOOLEAN is mapped as a byte, as it is usual in vendors' files.
[[nodiscard]] bool is_boolean_in_a_byte(const MappingValue& mapped, const canopen::DataTypeRow& type);

/// Returns the fault of one mapped object. `object`: null if it does not exist. `dummies`: the data types of
/// [DummyUsage].
[[nodiscard]] std::optional<MappingFault> fault_of(PdoDirection direction, const MappingValue& mapped,
                                                   const MappableObject* object,
                                                   std::span<const std::uint16_t> dummies);

}  // namespace edsc

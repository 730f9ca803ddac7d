#include "pdo/mapping_fault.hpp"

#include <algorithm>
#include <iterator>

namespace edsc {
namespace {

/// By MappingFault.
constexpr MappingRule rules[] = {
    "pdo-object",          "pdo-mappable", "pdo-direction", "pdo-length", "pdo-variable-length",
    "pdo-variable-length", "pdo-dummy",    "pdo-dummy",     "pdo-size",   "pdo-entries"};
static_assert(std::size(rules) == static_cast<std::size_t>(MappingFault::too_many_objects) + 1);

std::optional<MappingFault> fault_of_dummy(PdoDirection direction, const MappingValue& mapped,
                                           const canopen::DataTypeRow& type, std::span<const std::uint16_t> dummies) {
  if (direction == PdoDirection::transmit) return MappingFault::dummy_in_tpdo;
  if (std::ranges::find(dummies, mapped.index) == dummies.end()) return MappingFault::dummy_not_allowed;
  if (type.bits == 0) return MappingFault::variable_length;
  if (mapped.bits != type.bits) return MappingFault::wrong_length;
  return std::nullopt;
}

std::optional<MappingFault> fault_of_string(const MappingValue& mapped, const MappableObject& object) {
  if (!object.string_octets) return MappingFault::variable_length;
  if (mapped.bits % 8 != 0 || mapped.bits == 0) return MappingFault::part_of_a_byte;
  if (mapped.bits / 8U > *object.string_octets) return MappingFault::wrong_length;
  return std::nullopt;
}

}  // namespace

MappingRule rule_of(MappingFault fault) { return rules[static_cast<std::size_t>(fault)]; }

bool is_mapping_rule(RuleId rule) { return std::ranges::find(rules, rule) != std::end(rules); }

bool is_boolean_in_a_byte(const MappingValue& mapped, const canopen::DataTypeRow& type) {
  return type.kind == canopen::DataClass::boolean && mapped.bits == 8;
}

std::optional<MappingFault> fault_of(PdoDirection direction, const MappingValue& mapped, const MappableObject* object,
                                     std::span<const std::uint16_t> dummies) {
  if (const auto* const dummy = mapped.dummy_type()) return fault_of_dummy(direction, mapped, *dummy, dummies);
  if (object == nullptr) return MappingFault::unknown_object;
  if (!object->pdo_mapping) return MappingFault::not_mappable;
  if (!canopen::allows(object->mappable, mappable_in(direction))) return MappingFault::wrong_direction;
  if (object->type->kind == canopen::DataClass::string) return fault_of_string(mapped, *object);
  if (object->type->bits == 0) return MappingFault::variable_length;
  if (object->type->bits != mapped.bits && !is_boolean_in_a_byte(mapped, *object->type)) {
    return MappingFault::wrong_length;
  }
  return std::nullopt;
}

}  // namespace edsc

#include "network/configured_pdo.hpp"

#include <algorithm>

#include "device/pdo/pdo_defaults.hpp"

namespace edsc {
namespace {

/// Whether the value of an entry for which `is_wanted(index, sub_index)` is stated.
template <class Condition>
bool states(const NetworkNode& node, Condition is_wanted) {
  const bool is_set =
      std::ranges::any_of(node.settings, [&](const Setting& one) { return is_wanted(one.index, one.sub_index); });
  if (is_set || !node.loaded->sheet.is_dcf) return is_set;
  for (const ObjectDescription& object : node.loaded->sheet.objects) {
    for (const SubObjectDescription& sub_object : object.sub_objects) {
      if (!sub_object.parameter_value.empty() && is_wanted(object.index, sub_object.sub_index)) return true;
    }
  }
  return false;
}

bool is_cob_id(const Pdo& pdo, std::uint16_t index, std::uint8_t sub_index) {
  return index == pdo.communication->index && sub_index == 1;
}

}  // namespace

bool is_configured(const NetworkNode& node, const Pdo& pdo) {
  return states(node, [&](std::uint16_t index, std::uint8_t sub_index) {
    return index == pdo.mapping->index || is_cob_id(pdo, index, sub_index);
  });
}

bool is_as_in_eds(const NetworkNode& node, const Pdo& pdo) {
  return !states(node, [&](std::uint16_t index, std::uint8_t) {
    return index == pdo.communication->index || (pdo.mapping != nullptr && index == pdo.mapping->index);
  });
}

bool has_stated_can_id(const NetworkNode& node, const Pdo& pdo) {
  return on_by_default(pdo) &&
         states(node, [&](std::uint16_t index, std::uint8_t sub_index) { return is_cob_id(pdo, index, sub_index); });
}

}  // namespace edsc

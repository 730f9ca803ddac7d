#include "rules/pdo_defaults.hpp"

#include <canopen/cob_id.hpp>

namespace edsc {

std::optional<std::uint64_t> communication_default(const Pdo& pdo, std::uint8_t sub_index) {
  const Entry* entry = pdo.communication == nullptr ? nullptr : pdo.communication->find(sub_index);
  if (entry == nullptr || !entry->default_value) return std::nullopt;
  return entry->default_value->bits;
}

bool on_by_default(const Pdo& pdo) {
  const auto cob_id = communication_default(pdo, 1);
  return cob_id && canopen::CobId{static_cast<std::uint32_t>(*cob_id)}.valid();
}

}  // namespace edsc

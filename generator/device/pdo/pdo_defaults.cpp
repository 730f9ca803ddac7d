#include "device/pdo/pdo_defaults.hpp"

#include <canopen/can/cob_id.hpp>

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

std::optional<std::uint32_t> mapped_string_capacity(const Entry& entry, const Options& options) {
  if (entry.type->type == canopen::DataType::unicode_string) return std::nullopt;
  if (const auto at = options.string_capacity.find({entry.index, entry.sub_index});
      at != options.string_capacity.end()) {
    return at->second;
  }
  if (entry.octets != 0) return entry.octets;
  if (!entry.default_value || entry.default_value->bytes.empty()) return std::nullopt;
  return static_cast<std::uint32_t>(entry.default_value->bytes.size());
}

MappableObject mappable_object(const Entry& entry, const Options& options) {
  MappableObject object{entry.type, entry.mappable(), entry.pdo_mapping, {}};
  if (entry.type->kind == canopen::DataClass::string) object.string_octets = mapped_string_capacity(entry, options);
  return object;
}

}  // namespace edsc

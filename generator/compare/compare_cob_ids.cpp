#include "compare/compare_parts.hpp"

#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <cstdint>

#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::CobId;
using enum CobIdService;

constexpr std::uint32_t bit_31 = CobId::invalid_bit;
constexpr std::uint32_t bit_30 = CobId::no_rtr_bit;
constexpr std::uint32_t bit_29 = CobId::extended_bit;
constexpr std::uint32_t can_id_bits = 0x1FFF'FFFF;

/// A flag of the COB-IDs of a service, and the changes for setting and clearing it.
struct FlagRow {
  CobIdService service;
  std::uint32_t bit;
  ChangeRule when_set;
  ChangeRule when_cleared;
};

constexpr FlagRow flags[] = {
    {sync, bit_31, "cob-id-flag", "cob-id-flag"},       {sync, bit_30, "sync-started", "sync-stopped"},
    {time, bit_31, "time-consumed", "time-ignored"},    {time, bit_30, "time-started", "time-stopped"},
    {emcy, bit_30, "cob-id-flag", "cob-id-flag"},       {emcy_consumer, bit_30, "cob-id-flag", "cob-id-flag"},
    {sdo_server, bit_30, "sdo-dynamic", "sdo-dynamic"}, {sdo_client, bit_30, "sdo-dynamic", "sdo-dynamic"},
    {rpdo, bit_30, "cob-id-flag", "cob-id-flag"},       {tpdo, bit_30, "rtr-disabled", "rtr-enabled"},
};

bool is_pdo(CobIdService service) { return service == rpdo || service == tpdo; }
bool has_valid_bit(CobIdService service) { return service != sync && service != time; }

std::string can_id_text(const Value& cob_id) {
  const std::uint64_t can_id = cob_id.bits & can_id_bits;
  if (cob_id.plus_node_id) return fmt::format("$NODEID+0x{:X}", can_id);
  return (cob_id.bits & bit_29) != 0 ? fmt::format("0x{:08X}", can_id) : fmt::format("0x{:03X}", can_id);
}

class CobIdComparison {
 public:
  CobIdComparison(const Value& before, const Value& after, const canopen::DataTypeRow& type, CobIdService service)
      : before_{before}, after_{after}, type_{type}, service_{service} {}

  std::vector<CobIdChange> compare() {
    const bool existed = exists(before_);
    if (!is_pdo(service_) && existed != exists(after_)) {
      add(existed ? ChangeRule{"service-disabled"} : ChangeRule{"service-enabled"});
    } else if (!existed) {
      if (((before_.bits ^ after_.bits) & ~std::uint64_t{bit_31}) != 0 || before_.plus_node_id != after_.plus_node_id) {
        add("default-value");
      }
    } else {
      compare_can_ids();
      compare_flags();
    }
    return std::move(changes_);
  }

 private:
  [[nodiscard]] bool exists(const Value& cob_id) const {
    return !has_valid_bit(service_) || (cob_id.bits & bit_31) == 0;
  }

  void compare_can_ids() {
    const bool same_number = ((before_.bits ^ after_.bits) & can_id_bits) == 0;
    if (same_number && before_.plus_node_id == after_.plus_node_id) return;
    changes_.push_back({is_pdo(service_) ? ChangeRule{"pdo-cob-id"} : ChangeRule{"service-cob-id"},
                        can_id_text(before_), can_id_text(after_)});
  }

  void compare_flags() {
    const std::uint64_t changed = before_.bits ^ after_.bits;
    if ((changed & bit_29) != 0) add("frame-format");
    for (const FlagRow& row : flags) {
      if (row.service != service_ || (changed & row.bit) == 0) continue;
      add((after_.bits & row.bit) != 0 ? row.when_set : row.when_cleared);
    }
  }

  void add(ChangeRule rule) { changes_.push_back({rule, written_value(before_, type_), written_value(after_, type_)}); }

  const Value& before_;
  const Value& after_;
  const canopen::DataTypeRow& type_;
  CobIdService service_;
  std::vector<CobIdChange> changes_;
};

}  // namespace

std::vector<CobIdChange> compare_cob_ids(const std::optional<Value>& before, const std::optional<Value>& after,
                                         const canopen::DataTypeRow& type, CobIdService service) {
  if (before && after) return CobIdComparison{*before, *after, type, service}.compare();
  return {{is_pdo(service) ? ChangeRule{"pdo-cob-id"} : ChangeRule{"service-cob-id"}, written_value(before, type),
           written_value(after, type)}};
}

}  // namespace edsc

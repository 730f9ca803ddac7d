#include "rules/object_rules.hpp"

#include <fmt/format.h>

#include <bit>

namespace edsc {
namespace {

using canopen::DataClass;

/// CiA 301, 7.5.2: objects that every device has.
constexpr std::uint16_t mandatory_indices[] = {0x1000, 0x1001, 0x1018};

/// Whether `a` is below `b`, both values of `type`.
bool less(const canopen::DataTypeRow& type, std::uint64_t a, std::uint64_t b) {
  switch (type.kind) {
    case DataClass::signed_integer: return static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b);
    case DataClass::real:
      if (type.bits == 32) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(a)) < std::bit_cast<float>(static_cast<std::uint32_t>(b));
      }
      return std::bit_cast<double>(a) < std::bit_cast<double>(b);
    case DataClass::boolean:
    case DataClass::unsigned_integer:
    case DataClass::string:
    case DataClass::time:
    case DataClass::domain: break;
  }
  return a < b;
}

/// A limit that follows the node-ID is no constant: nobody can check it before the node-ID is known.
void drop_limit_formula(std::optional<Value>& limit, Diagnostics& diagnostics) {
  if (!limit || !limit->plus_node_id) return;
  diagnostics.warning("limit-formula", limit->position,
                      "a limit that follows the node-ID is not checked unless the node-ID is given");
  limit.reset();
}

void check_limits(Entry& entry, Diagnostics& diagnostics) {
  drop_limit_formula(entry.low_limit, diagnostics);
  drop_limit_formula(entry.high_limit, diagnostics);
  if (entry.low_limit && entry.high_limit && less(*entry.type, entry.high_limit->bits, entry.low_limit->bits)) {
    diagnostics.warning("limits-order", entry.low_limit->position, "LowLimit is above HighLimit; neither is checked");
    entry.low_limit.reset();
    entry.high_limit.reset();
  }
  if (!entry.default_value || entry.default_value->plus_node_id) return;
  const std::uint64_t value = entry.default_value->bits;
  const bool below = entry.low_limit && less(*entry.type, value, entry.low_limit->bits);
  const bool above = entry.high_limit && less(*entry.type, entry.high_limit->bits, value);
  if (below || above) {
    diagnostics.warning("default-outside-limits", entry.default_value->position,
                        fmt::format("the default of {} \"{}\" is {} its limit", entry_label(entry.index, entry.sub_index),
                                    entry.name, below ? "below" : "above"));
  }
}

}  // namespace

void check_objects(Device& device, Diagnostics& diagnostics) {
  for (const std::uint16_t index : mandatory_indices) {
    if (device.find(index) != nullptr) continue;
    diagnostics.warning("mandatory-object", Position{device.source},
                        fmt::format("{} is missing: every device has it", index_label(index)));
  }
  for (Object& object : device.objects) {
    for (Entry& entry : object.entries) check_limits(entry, diagnostics);
  }
}

}  // namespace edsc

#include "conform/cases/pdo/pdo_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <limits>
#include <utility>

#include "conform/cases/shared/entry_values.hpp"
#include "device/drive_modes.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "pdo/mapping_fault.hpp"

namespace edsc::conform {
namespace {

using canopen::DataClass;

/// The range of an integer: the lowest value, and the number of values above it.
struct Range {
  std::uint64_t low = 0;
  std::uint64_t span = 0;
};

/// A supported drive mode that is not the present one.
std::optional<std::uint64_t> other_mode(const std::vector<ModeRange>& modes, std::uint64_t present) {
  for (const ModeRange& range : modes) {
    for (std::int64_t mode{range.low}; mode <= std::int64_t{range.high}; ++mode) {
      if (mode != static_cast<std::int64_t>(present)) return static_cast<std::uint8_t>(mode);
    }
  }
  return std::nullopt;
}

Range range_of(const Dut& dut, const Entry& entry) {
  const unsigned bits = entry.type->bits;
  const bool is_signed = entry.type->kind == DataClass::signed_integer;
  const std::uint64_t top = low_bits(bits);
  std::uint64_t low = is_signed ? ~(top >> 1) : 0;
  std::uint64_t high = is_signed ? top >> 1 : top;
  if (entry.low_limit) low = conform::bits_of(dut, *entry.low_limit);
  if (entry.high_limit) high = conform::bits_of(dut, *entry.high_limit);
  return {low, high - low};
}

/// A value of a data type as `Value` holds it.
std::uint64_t extended(const Entry& entry, std::uint64_t value) {
  const bool is_signed = entry.type->kind == DataClass::signed_integer;
  return is_signed ? static_cast<std::uint64_t>(sign_extended(value, entry.type->bits)) : value;
}

}  // namespace

void fail_value(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, AnyRule rule,
                const std::string& expected, const std::string& got) {
  if (dut.default_of(index, sub_index).value_or(0) == value) dut.fail_by_sheet(rule, expected, got);
  dut.fail(expected, got);
}

std::optional<std::vector<MappingValue>> read_mapping(Dut& dut, std::uint16_t communication) {
  const std::uint16_t index = mapping_parameter_of(communication);
  std::vector<MappingValue> mapping;
  if (!dut.is_readable(index, 0)) return mapping;
  const std::uint64_t count = dut.read_number(index, 0);
  if (is_multiplexed(count)) return std::nullopt;
  for (std::uint64_t i = 1; i <= count; ++i) {
    const auto sub_index = static_cast<std::uint8_t>(i);
    const std::uint64_t value = dut.is_readable(index, sub_index) ? dut.read_number(index, sub_index) : 0;
    mapping.push_back(MappingValue::of(static_cast<std::uint32_t>(value)));
  }
  return mapping;
}

bool may_carry(PdoDirection direction, const Entry& entry) { return allows(entry.mappable(), mappable_in(direction)); }

std::optional<MappingProblem> problem_of(const Dut& dut, PdoDirection direction, const MappingValue& mapped) {
  const bool receives = direction == PdoDirection::receive;
  const std::string got = fmt::format("{:08X}h", mapped.value());
  if (mapped.is_empty()) return MappingProblem{"pdo-mapping-gap", "a mapped object, as sub-index 0 counts it", got};
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  std::optional<MappableObject> object;
  if (entry != nullptr) object = mappable_object(*entry, Options{});
  // The options of the device, which can state a length, are not known.
  if (object && !object->string_octets) object->string_octets = std::numeric_limits<std::uint32_t>::max();
  const auto fault = fault_of(direction, mapped, object ? &*object : nullptr, dut.sheet().dummies);
  if (!fault) return std::nullopt;
  const auto problem = [&](std::string expected, std::string found) {
    return MappingProblem{rule_of(*fault), std::move(expected), std::move(found)};
  };
  switch (*fault) {
    case MappingFault::dummy_in_tpdo:
    case MappingFault::dummy_not_allowed: return problem("an object, or in an RPDO a dummy of [DummyUsage]", got);
    case MappingFault::unknown_object: return problem("an object of the EDS", got);
    case MappingFault::not_mappable:
    case MappingFault::wrong_direction:
      return problem(receives ? "an object with PDOMapping=1 that is rw, rww or wo"
                              : "an object with PDOMapping=1 that is rw, rwr, ro or const",
                     fmt::format("{}, which is {} with PDOMapping={}", got, canopen::row_of(entry->access).name,
                                 entry->pdo_mapping ? 1 : 0));
    case MappingFault::variable_length: return problem("an object of a data type with a fixed length", got);
    case MappingFault::part_of_a_byte: return problem("a string of whole bytes", got);
    default: break;
  }
  const canopen::DataTypeRow& type = entry != nullptr ? *entry->type : *mapped.dummy_type();
  if (type.bits == 0) return problem("a string with at most its length in the EDS", got);
  return problem(fmt::format("{} with the {} bits of its data type", label(mapped.index, mapped.sub_index), type.bits),
                 got);
}

std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo, const std::vector<MappingValue>& mapping) {
  for (const MappingValue& mapped : mapping) {
    if (const auto problem = problem_of(dut, pdo.direction, mapped)) {
      return fmt::format("{} maps {}, which the EDS does not allow", pdo_label(pdo), problem->got);
    }
  }
  if (total_bits(mapping) > classical_can.bits()) {
    return fmt::format("{} maps more than {} bits", pdo_label(pdo), classical_can.bits());
  }
  return std::nullopt;
}

std::string objects_text(const std::vector<MappingValue>& mapping) {
  std::string text;
  for (const MappingValue& mapped : mapping) {
    if (!text.empty()) text += &mapped == &mapping.back() ? " and " : ", ";
    text += label(mapped.index, mapped.sub_index);
  }
  return text;
}

Image read_image(Dut& dut, const std::vector<MappingValue>& mapping) {
  Image image;
  for (const PlacedObject& mapped : placed(mapping)) {
    if (mapped.offset < classical_can.bits() && dut.is_readable(mapped.index, mapped.sub_index)) {
      const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
      if (outcome.done()) {
        image.bits |= (number_of(outcome.bytes) & low_bits(mapped.bits)) << mapped.offset;
        image.known |= low_bits(mapped.bits) << mapped.offset;
      }
    }
  }
  return image;
}

std::uint64_t live_bits(Dut& dut, const std::vector<MappingValue>& mapping) {
  constexpr unsigned reads = 14;
  constexpr Duration between = milliseconds{7};  // not a divisor of usual cycle times
  const Image first = read_image(dut, mapping);
  std::uint64_t changed = 0;
  for (unsigned i = 0; i < reads; ++i) {
    dut.pass_time(between);
    changed |= read_image(dut, mapping).bits ^ first.bits;
  }
  std::uint64_t live = 0;
  for (const PlacedObject& mapped : placed(mapping)) {
    if (mapped.offset >= classical_can.bits()) continue;
    const std::uint64_t mask = low_bits(mapped.bits) << mapped.offset;
    if ((changed & mask) != 0) live |= mask;
  }
  return live;
}

std::uint64_t pack(const std::vector<MappingValue>& mapping, std::span<const std::uint64_t> values) {
  std::uint64_t bits = 0;
  for (const PlacedObject& mapped : placed(mapping)) {
    if (mapped.offset >= classical_can.bits()) break;
    bits |= (values[mapped.position - 1U] & low_bits(mapped.bits)) << mapped.offset;
  }
  return bits;
}

std::uint64_t within_limits(const Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value) {
  const Entry* const entry = dut.entry(index, sub_index);
  if (entry == nullptr || entry->type == nullptr || entry->type->bits == 0) return value;
  const Range range = range_of(dut, *entry);
  const std::uint64_t extended_value = extended(*entry, value);
  if (extended_value - range.low <= range.span) return value;
  const bool is_below = static_cast<std::int64_t>(extended_value) < static_cast<std::int64_t>(range.low);
  return (is_below ? range.low : range.low + range.span) & low_bits(entry->type->bits);
}

std::optional<std::uint64_t> other_value(const Dut& dut, const MappingValue& mapped, std::uint64_t present,
                                         std::uint64_t salt) {
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (entry == nullptr || entry->type == nullptr || entry->type->bits != mapped.bits) return std::nullopt;
  const DataClass kind = entry->type->kind;
  if (kind == DataClass::boolean) return present == 0 ? 1 : 0;
  if (kind == DataClass::real && !entry->low_limit && !entry->high_limit) {
    constexpr std::uint64_t half32 = 0x3F00'0000, half64 = 0x3FE0'0000'0000'0000;  // 0.5
    const std::uint64_t half = mapped.bits == 32 ? half32 : half64;
    return present == half ? 0 : half;
  }
  if (kind != DataClass::unsigned_integer && kind != DataClass::signed_integer) return std::nullopt;
  if (const auto modes = accepted_modes(dut.sheet(), Options{}, *entry); !modes.empty()) {
    return other_mode(modes, extended(*entry, present));
  }
  const Range range = range_of(dut, *entry);
  if (range.span == 0) return std::nullopt;
  const std::uint64_t above = std::min(extended(*entry, present) - range.low, range.span);
  const std::uint64_t step = std::min(salt, range.span);
  const std::uint64_t other = above <= range.span - step ? above + step : above >= step ? above - step : 0;
  return (range.low + other) & low_bits(mapped.bits);
}

}  // namespace edsc::conform

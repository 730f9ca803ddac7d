#include "conform/cases/pdo/pdo_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <canopen/pdo/pdo_mapping.hpp>

#include "conform/cases/shared/entry_values.hpp"
#include "device/drive_modes.hpp"

namespace edsc::conform::pdo_area {
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
    for (int mode = range.low; mode <= range.high; ++mode) {
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

void fail_value(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, std::string_view rule,
                const std::string& expected, const std::string& got) {
  if (dut.default_of(index, sub_index).value_or(0) == value) dut.fail_by_sheet(rule, expected, got);
  dut.fail(expected, got);
}

Mapped mapped_of(std::uint64_t value) {
  return {static_cast<std::uint16_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value)};
}

std::uint16_t mapping_of(std::uint16_t communication) { return static_cast<std::uint16_t>(communication + 0x200); }

unsigned bits_of(const std::vector<Mapped>& mapping) {
  unsigned bits = 0;
  for (const Mapped& mapped : mapping) bits += mapped.bits;
  return bits;
}

std::optional<std::vector<Mapped>> read_mapping(Dut& dut, std::uint16_t communication) {
  const std::uint16_t index = mapping_of(communication);
  std::vector<Mapped> mapping;
  if (!dut.is_readable(index, 0)) return mapping;
  const std::uint64_t count = dut.read_number(index, 0);
  if (count >= canopen::source_multiplexed) return std::nullopt;
  for (std::uint64_t i = 1; i <= count; ++i) {
    const auto sub_index = static_cast<std::uint8_t>(i);
    mapping.push_back(dut.is_readable(index, sub_index) ? mapped_of(dut.read_number(index, sub_index)) : Mapped{});
  }
  return mapping;
}

bool may_carry(PdoDirection direction, const Entry& entry) {
  const bool receives = direction == PdoDirection::receive;
  return allows(entry.mappable(), receives ? canopen::Mappable::rpdo : canopen::Mappable::tpdo);
}

std::optional<MappingFault> fault_of(const Dut& dut, PdoDirection direction, const Mapped& mapped) {
  const bool receives = direction == PdoDirection::receive;
  const std::string got = fmt::format("{:08X}h", mapped.value());
  if (mapped.value() == 0) return MappingFault{"pdo-mapping-gap", "a mapped object, as sub-index 0 counts it", got};
  if (mapped.is_dummy()) {
    const bool in_use = std::ranges::find(dut.sheet().dummies, mapped.index) != dut.sheet().dummies.end();
    if (receives && in_use) return std::nullopt;
    return MappingFault{"pdo-dummy", "an object, or in an RPDO a dummy of [DummyUsage]", got};
  }
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (entry == nullptr) return MappingFault{"pdo-object", "an object of the EDS", got};
  if (!may_carry(direction, *entry)) {
    return MappingFault{entry->pdo_mapping ? "pdo-direction" : "pdo-mappable",
                        receives ? "an object with PDOMapping=1 that is rw, rww or wo"
                                 : "an object with PDOMapping=1 that is rw, rwr, ro or const",
                        fmt::format("{}, which is {} with PDOMapping={}", got, canopen::row_of(entry->access).name,
                                    entry->pdo_mapping ? 1 : 0)};
  }
  const bool is_boolean_byte = entry->type->kind == DataClass::boolean && mapped.bits == 8;
  if (entry->type->bits == 0 || entry->type->bits == mapped.bits || is_boolean_byte) return std::nullopt;
  return MappingFault{
      "pdo-length",
      fmt::format("{} with the {} bits of its data type", label(mapped.index, mapped.sub_index), entry->type->bits),
      got};
}

std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo, const std::vector<Mapped>& mapping) {
  for (const Mapped& mapped : mapping) {
    if (const auto fault = fault_of(dut, pdo.direction, mapped)) {
      return fmt::format("{} maps {}, which the EDS does not allow", pdo_label(pdo), fault->got);
    }
  }
  if (bits_of(mapping) > 64) return pdo_label(pdo) + " maps more than 64 bits";
  return std::nullopt;
}

std::string objects_text(const std::vector<Mapped>& mapping) {
  std::string text;
  for (const Mapped& mapped : mapping) {
    if (!text.empty()) text += &mapped == &mapping.back() ? " and " : ", ";
    text += label(mapped.index, mapped.sub_index);
  }
  return text;
}

Image read_image(Dut& dut, const std::vector<Mapped>& mapping) {
  Image image;
  unsigned at = 0;
  for (const Mapped& mapped : mapping) {
    if (at < 64 && dut.is_readable(mapped.index, mapped.sub_index)) {
      const SdoOutcome outcome = dut.upload(mapped.index, mapped.sub_index);
      if (outcome.done()) {
        image.bits |= (number_of(outcome.bytes) & low_bits(mapped.bits)) << at;
        image.known |= low_bits(mapped.bits) << at;
      }
    }
    at += mapped.bits;
  }
  return image;
}

std::uint64_t pack(const std::vector<Mapped>& mapping, std::span<const std::uint64_t> values) {
  std::uint64_t bits = 0;
  unsigned at = 0;
  for (std::size_t i = 0; i < mapping.size() && at < 64; at += mapping[i++].bits) {
    bits |= (values[i] & low_bits(mapping[i].bits)) << at;
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

std::optional<std::uint64_t> other_value(const Dut& dut, const Mapped& mapped, std::uint64_t present,
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

}  // namespace edsc::conform::pdo_area

#include "conform/cases/shared/entry_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <canopen/od/access.hpp>
#include <canopen/od/data_type.hpp>
#include <cmath>
#include <limits>

#include "configure/configuration_plan.hpp"
#include "text/utf8.hpp"
#include "values/read_value.hpp"

namespace edsc::conform {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

/// Parameters that do not depend on others (CiA 301, 7.5.2).
struct PlainParameter {
  std::uint16_t first, last;
  std::uint8_t first_sub_index, last_sub_index;
};

constexpr PlainParameter plain_parameters[] = {
    {0x100C, 0x100D, 0, 0},    // guard time, life time factor
    {0x1016, 0x1016, 1, 127},  // consumer heartbeat times
    {0x1017, 0x1017, 0, 0},    // producer heartbeat time
    {0x1029, 0x1029, 1, 254},  // error behavior
    {0x1400, 0x15FF, 2, 2},    // transmission type
    {0x1400, 0x15FF, 5, 5},    // event timer
    {0x1800, 0x19FF, 2, 2},    // transmission type
    {0x1800, 0x19FF, 5, 5},    // event timer
};

/// The next value of a REAL in the direction of `towards`; std::nullopt at the end of the type.
template <typename Real, typename Bits>
std::optional<std::uint64_t> next_real(std::uint64_t bits, Real towards) {
  const Real next = std::nextafter(std::bit_cast<Real>(static_cast<Bits>(bits)), towards);
  if (!std::isfinite(next)) return std::nullopt;
  return std::bit_cast<Bits>(next);
}

/// The bits of the maximum or minimum value of an integer type, sign-extended to 64 bits.
std::uint64_t greatest(const DataTypeRow& type) {
  const unsigned used = type.kind == DataClass::signed_integer ? type.bits - 1U : type.bits;
  return low_bits(used);
}
std::uint64_t least(const DataTypeRow& type) { return type.kind == DataClass::signed_integer ? ~greatest(type) : 0; }

std::optional<std::uint64_t> next_value(const DataTypeRow& type, std::uint64_t bits, bool up) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (type.type == DataType::real32)
    return next_real<float, std::uint32_t>(bits, static_cast<float>(up ? infinity : -infinity));
  if (type.type == DataType::real64) return next_real<double, std::uint64_t>(bits, up ? infinity : -infinity);
  if (bits == (up ? greatest(type) : least(type))) return std::nullopt;
  return up ? bits + 1 : bits - 1;
}

}  // namespace

std::uint32_t flags_of(const Device& sheet, const LiveEntry& entry) {
  const Object* object = sheet.find(entry.index);
  return (entry.entry == nullptr ? 0 : entry.entry->obj_flags) | (object == nullptr ? 0 : object->obj_flags);
}

bool is_communication(const LiveEntry& entry) { return entry.index >= 0x1000 && entry.index <= 0x1FFF; }
bool is_application(const LiveEntry& entry) { return entry.index >= 0x2000; }
bool is_domain(const LiveEntry& entry) { return entry.type != nullptr && entry.type->kind == DataClass::domain; }

bool is_number(const LiveEntry& entry) {
  if (entry.type == nullptr) return false;
  const DataClass kind = entry.type->kind;
  return kind == DataClass::unsigned_integer || kind == DataClass::signed_integer || kind == DataClass::real;
}

bool is_readable(const LiveEntry& entry) { return entry.entry != nullptr && canopen::readable(entry.entry->access); }
bool is_writable(const LiveEntry& entry) { return entry.entry != nullptr && canopen::writable(entry.entry->access); }

bool is_plain_parameter(const LiveEntry& entry) {
  if (!is_readable(entry) || !is_writable(entry) || !is_number(entry)) return false;
  return std::ranges::any_of(plain_parameters, [&](const PlainParameter& row) {
    return entry.index >= row.first && entry.index <= row.last && entry.sub_index >= row.first_sub_index &&
           entry.sub_index <= row.last_sub_index;
  });
}

bool is_application_parameter(const Device& sheet, const LiveEntry& entry) {
  if (!is_application(entry) || !is_readable(entry) || !is_writable(entry) || is_domain(entry)) return false;
  return (flags_of(sheet, entry) & (refuse_write_flag | refuse_read_flag)) == 0 && !sets_node_id_or_bit_rate(entry);
}

std::uint64_t bits_of(canopen::NodeId node, const Value& value) {
  return value.bits + (value.plus_node_id ? node.value() : 0U);
}

std::optional<Bytes> default_bytes(canopen::NodeId node, const Entry& entry) {
  if (entry.type == nullptr || entry.type->kind == DataClass::domain) return std::nullopt;
  if (!entry.default_value || !entry.default_value->clause.empty()) return std::nullopt;
  const Value& value = *entry.default_value;
  if (entry.type->type == DataType::unicode_string) {
    const std::string units = to_utf16_bytes(value.bytes);
    return Bytes(units.begin(), units.end());
  }
  if (entry.type->kind == DataClass::string) return Bytes(value.bytes.begin(), value.bytes.end());
  return edsc::bytes_of(bits_of(node, value), bytes_for(entry.type->bits));
}

std::optional<std::uint64_t> value_above_limit(const Dut& dut, const Entry& entry) {
  if (!entry.high_limit || entry.type == nullptr) return std::nullopt;
  return next_value(*entry.type, bits_of(dut, *entry.high_limit), true);
}

std::optional<std::uint64_t> value_below_limit(const Dut& dut, const Entry& entry) {
  if (!entry.low_limit || entry.type == nullptr) return std::nullopt;
  return next_value(*entry.type, bits_of(dut, *entry.low_limit), false);
}

LimitCheck check_limits(canopen::NodeId node, const Entry& entry, std::span<const std::uint8_t> bytes) {
  if (entry.type == nullptr || entry.type->bits == 0) return {};
  std::uint64_t value = number_of(bytes);
  if (entry.type->kind == DataClass::signed_integer) {
    value = static_cast<std::uint64_t>(sign_extended(value, entry.type->bits));
  }
  return {.too_low = entry.low_limit && is_less(*entry.type, value, bits_of(node, *entry.low_limit)),
          .too_high = entry.high_limit && is_less(*entry.type, bits_of(node, *entry.high_limit), value)};
}

bool is_within_limits(const Dut& dut, const Entry& entry, std::span<const std::uint8_t> bytes) {
  const LimitCheck check = check_limits(dut.node(), entry, bytes);
  return !check.too_low && !check.too_high;
}

bool depends_on_state(canopen::AbortCode code) {
  using canopen::AbortCode;
  constexpr std::array codes = {AbortCode::parameter_incompatible, AbortCode::internal_incompatibility,
                                AbortCode::maximum_less_than_minimum, AbortCode::local_control,
                                AbortCode::device_state};
  return std::ranges::find(codes, code) != codes.end();
}

}  // namespace edsc::conform

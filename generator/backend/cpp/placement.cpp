#include "backend/cpp/placement.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "backend/cpp/typed_values.hpp"
#include "device/drive_modes.hpp"
#include "device/index_range.hpp"
#include "device/stored_eds.hpp"
#include "device/uniform_array.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataClass;
using canopen::DataType;

/// Capacity of strings in RAM without a default value, unless the options set it.
constexpr std::uint32_t default_string_capacity = 16;

/// A string has its length before its bytes.
constexpr unsigned string_length_bytes = 2;

/// Of canopen::Domain with 32-bit pointers; for larger ones, the generated code computes the size itself.
constexpr std::size_t domain_size = 12;

/// Read-only objects of the communication profile that do not change at run time.
constexpr std::array constant_ranges = {
    IndexRange{0x1000, 0x1000}, IndexRange{0x1005, 0x100F}, IndexRange{0x1012, 0x1012}, IndexRange{0x1014, 0x1019},
    IndexRange{0x1200, 0x12FF}, IndexRange{0x1400, 0x15FF}, IndexRange{0x1800, 0x19FF},
};

/// Store and restore: a write is a command; a read returns the capabilities of the device.
constexpr std::array command_ranges = {IndexRange{0x1010, 0x1011}};

constexpr std::uint16_t pre_defined_error_field = 0x1003;

/// The place of a constant number: in its word, if it fits into 16 bits.
MemoryPlace place_of_number(DataClass kind, std::uint64_t bits, bool plus_node_id) {
  if (kind == DataClass::boolean) return MemoryPlace::immediate;
  if (kind == DataClass::unsigned_integer && bits <= 0xFFFF) {
    return plus_node_id ? MemoryPlace::immediate_plus_node_id : MemoryPlace::immediate;
  }
  const bool is_integer = kind == DataClass::unsigned_integer || kind == DataClass::signed_integer;
  if (is_integer && plus_node_id) return MemoryPlace::ram;
  const auto value = static_cast<std::int64_t>(bits);
  return kind == DataClass::signed_integer && value >= -0x8000 && value <= 0x7FFF ? MemoryPlace::immediate
                                                                                  : MemoryPlace::rom;
}

std::uint64_t default_bits(const Entry& entry) { return entry.default_value ? entry.default_value->bits : 0; }

/// Whether the limits of an integer reject any value of its type.
bool rejects_any(const Entry& entry) {
  if (entry.type->kind != DataClass::unsigned_integer && entry.type->kind != DataClass::signed_integer)
    return entry.low_limit || entry.high_limit;
  const std::uint64_t mask = low_bits(entry.type->bits);
  const auto differs = [mask](const std::optional<Value>& limit, std::uint64_t of_type) {
    return limit && ((limit->bits ^ of_type) & mask) != 0;
  };
  return differs(entry.low_limit, lowest(*entry.type)) || differs(entry.high_limit, highest(*entry.type));
}

}  // namespace

Placement::Placement(const Device& device, const Options& options)
    : device_{device}, options_{options}, settable_{options.settable} {
  std::ranges::sort(settable_);
  for (const Pdo& pdo : device.pdos) {
    if (!pdo.dynamic) continue;
    dynamic_mappings_.push_back(pdo.mapping->index);  // ascending: RPDOs come first
    has_dynamic_tpdo_ = has_dynamic_tpdo_ || pdo.direction == PdoDirection::transmit;
  }
  for (const Object& object : device.objects) {
    if (!is_static_mapping(object.index)) continue;
    for (const Entry& entry : object.entries) {
      const auto [at, is_new] = static_mapping_values_.try_emplace(entry.sub_index, default_bits(entry));
      if (!is_new && at->second != default_bits(entry)) at->second.reset();
    }
  }
}

bool Placement::is_static_mapping(std::uint16_t index) const {
  return contains(mapping_parameters, index) && !std::ranges::binary_search(dynamic_mappings_, index);
}

bool Placement::is_constant(const Object& object, const Entry& entry) const {
  if (contains(mapping_parameters, entry.index)) return is_static_mapping(entry.index);
  if (std::ranges::binary_search(settable_, EntryKey{entry.index, entry.sub_index})) return false;
  if (contains(command_ranges, entry.index)) return true;
  if (entry.index == store_format && options_.stored_eds != StoredEds::of_application) return true;
  if (entry.access == Access::constant) return true;
  if (entry.access != Access::ro) return false;
  if (object.has_sub_indices() && entry.sub_index == 0) return entry.index != pre_defined_error_field;
  return contains(constant_ranges, entry.index);
}

MemoryPlace Placement::place(const Object& object, const Entry& entry) const {
  if (!is_constant(object, entry) || entry.type->kind == DataClass::domain) return MemoryPlace::ram;
  const bool plus_node_id = entry.default_value && entry.default_value->plus_node_id;
  // All static mapping parameters of a device share one table of words: one that contains a value has it for all.
  const bool is_mapping = contains(mapping_parameters, entry.index);
  if (is_mapping && (plus_node_id || !static_mapping_values_.at(entry.sub_index))) return MemoryPlace::rom;
  if (needs_address(entry)) return plus_node_id ? MemoryPlace::ram : MemoryPlace::rom;
  return place_of_number(entry.type->kind, default_bits(entry), plus_node_id);
}

/// A TPDO with dynamic mapping reads its objects, including constants, from memory.
bool Placement::needs_address(const Entry& entry) const {
  return has_dynamic_tpdo_ && canopen::allows(entry.mappable(), canopen::Mappable::tpdo);
}

bool Placement::has_limits(const Object& object, const Entry& entry) const {
  if (entry.type->kind == DataClass::string) return place(object, entry) == MemoryPlace::ram;
  return canopen::writable(entry.access) && !contains(mapping_parameters, entry.index) && rejects_any(entry);
}

bool Placement::is_limited(const Object& object, const Entry& entry) const {
  if (has_limits(object, entry)) return true;
  if (!canopen::writable(entry.access)) return false;
  const auto is_closed = [&](const Entry& one) { return is_closed_enumeration(one, options_); };
  // Elements of an ARRAY share one word.
  const bool is_element = entry.sub_index != 0 && describes_uniform_array(object);
  return !accepted_modes(device_, options_, entry).empty() ||
         (is_element ? std::ranges::any_of(object.entries, is_closed) : is_closed(entry));
}

bool Placement::is_uniform_array(const Object& object) const {
  if (!describes_uniform_array(object)) return false;
  const MemoryPlace first = place(object, object.entries[1]);
  if (first != MemoryPlace::ram && first != MemoryPlace::rom) return false;
  const MemoryPlace count = place(object, object.entries[0]);
  // A record can have both.
  if (first == MemoryPlace::rom && (count == MemoryPlace::ram || count == MemoryPlace::rom)) return false;
  return std::ranges::all_of(object.entries.begin() + 1, object.entries.end(),
                             [&](const Entry& entry) { return place(object, entry) == first; });
}

std::uint64_t lowest(const canopen::DataTypeRow& type) {
  if (type.kind == DataClass::real) return type.bits == 32 ? 0xFF7F'FFFF : 0xFFEF'FFFF'FFFF'FFFF;
  return type.kind == DataClass::signed_integer ? ~low_bits(type.bits - 1U) : 0;
}
std::uint64_t highest(const canopen::DataTypeRow& type) {
  if (type.kind == DataClass::real) return type.bits == 32 ? 0x7F7F'FFFF : 0x7FEF'FFFF'FFFF'FFFF;
  return low_bits(type.bits - (type.kind == DataClass::signed_integer ? 1U : 0U));
}

bool is_zero(const Entry& entry) {
  if (!entry.default_value) return true;
  return entry.default_value->bits == 0 && entry.default_value->bytes.empty() && !entry.default_value->plus_node_id;
}

std::uint32_t string_capacity(const Entry& entry, const Options& options) {
  if (const auto at = options.string_capacity.find({entry.index, entry.sub_index});
      at != options.string_capacity.end()) {
    return at->second;
  }
  const std::size_t length = entry.default_value ? bytes_of(*entry.default_value, *entry.type).size() : 0;
  if (length > 0) return std::max(static_cast<std::uint32_t>(length), entry.octets);
  if (entry.octets != 0) return entry.octets;
  return entry.access == Access::constant ? 0 : default_string_capacity;
}

std::uint32_t string_bytes(const Entry& entry, const Options& options) {
  const bool terminated = options.zero_terminated_strings && entry.type->type == DataType::visible_string;
  return string_capacity(entry, options) + (terminated ? 1 : 0);
}

unsigned stride(const Entry& entry) { return entry.type->bits == 0 ? 8 : std::bit_ceil((entry.type->bits + 7U) / 8U); }

unsigned alignment_of(const Entry& entry) {
  if (entry.type->kind == DataClass::string) return string_length_bytes;
  return entry.type->kind == DataClass::time ? 4 : stride(entry);
}

std::size_t size_of(const Entry& entry, const Options& options) {
  if (entry.type->kind == DataClass::domain) return domain_size;
  if (entry.type->kind != DataClass::string) return stride(entry);
  return round_up(string_length_bytes + std::max(string_bytes(entry, options), 1U), string_length_bytes);
}

}  // namespace edsc

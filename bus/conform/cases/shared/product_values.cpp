#include "conform/cases/shared/product_values.hpp"

#include <algorithm>
#include <canopen/od/access.hpp>

#include "device/index_range.hpp"

namespace edsc::conform {
namespace {

using canopen::Access;

/// Read-only values of 1000h to 1FFFh that are the same in each device of the product.
struct ProductValue {
  IndexRange objects;
  std::uint8_t first_sub_index, last_sub_index;
};

constexpr ProductValue product_values[] = {
    {{0x1000, 0x1000}, 0, 0},    // device type
    {{0x1018, 0x1018}, 1, 3},    // vendor-ID, product code, revision number
    {{0x1200, 0x127F}, 0, 254},  // COB-IDs of SDO servers
    {{0x1400, 0x1BFF}, 0, 254},  // PDOs
};

bool is_serial_number(const LiveEntry& entry) { return entry.index == 0x1018 && entry.sub_index == 4; }

/// Sub-index 0 with the highest sub-index. In a list that the device fills, it has another default value.
bool is_highest_sub_index(const Device& sheet, const LiveEntry& entry) {
  const Object* object = sheet.find(entry.index);
  if (entry.sub_index != 0 || object == nullptr || !object->has_sub_indices()) return false;
  const auto& value = entry.entry->default_value;
  return value && entry.type->bits != 0 && (value->bits & low_bits(entry.type->bits)) == object->highest_sub_index();
}

}  // namespace

bool is_product_value(const Device& sheet, const LiveEntry& entry) {
  const Access access = entry.entry->access;
  if (is_serial_number(entry) || entry.index == error_history) return false;
  if (access == Access::constant) return true;
  if (access != Access::ro) return false;
  if (is_highest_sub_index(sheet, entry)) return true;
  return std::ranges::any_of(product_values, [&](const ProductValue& row) {
    return entry.index >= row.objects.first && entry.index <= row.objects.last &&
           entry.sub_index >= row.first_sub_index && entry.sub_index <= row.last_sub_index;
  });
}

Bytes trimmed(const LiveEntry& entry, Bytes bytes) {
  const auto is_fill = [](std::uint8_t byte) { return byte == 0 || byte == ' '; };
  if (entry.type->type == canopen::DataType::visible_string) {
    while (!bytes.empty() && is_fill(bytes.back())) bytes.pop_back();
  }
  return bytes;
}

bool may_have_no_value(const LiveEntry& entry) {
  return entry.type->bits == 0 || (entry.index == error_history && entry.sub_index != 0);
}

}  // namespace edsc::conform

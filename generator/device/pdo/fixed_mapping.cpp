#include "device/pdo/fixed_mapping.hpp"

#include "device/index_range.hpp"

namespace edsc {

bool is_of_fixed_mapping(const Device& device, const Entry& entry) {
  if (!contains(mapping_parameters, entry.index) || entry.sub_index == 0) return false;
  const Entry* const count = device.find(entry.index, 0);
  return count == nullptr || !canopen::writable(count->access);
}

}  // namespace edsc

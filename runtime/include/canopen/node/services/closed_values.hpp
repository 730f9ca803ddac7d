/// The closed enumerations of a node.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/closed_objects.hpp"

namespace canopen::service {

/// Rejects values that are not in the enumeration of an object: invalid_value.
template <class Device>
class ClosedValues : public ServiceDefaults<ClosedValues<Device>> {
 public:
  static constexpr bool exists = HasClosedObjects<Device>;

  static constexpr bool checks(std::uint16_t index, std::uint8_t sub_index) {
    return is_closed<Device>(index, sub_index);
  }
  template <class Host>
  static AbortCode check_write(Host&, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return check_closed<Device>(index, sub_index, bytes);
  }
};

}  // namespace canopen::service

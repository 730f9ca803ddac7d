/// The closed enumerations of a node.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/closed_objects.hpp"

namespace canopen::service {

/// Rejects values that are not in the enumeration of an object: invalid_value. The sheet of a node also has those of
/// the modes of operation of a drive.
template <class Device>
class ClosedValues : public ServiceDefaults<ClosedValues<Device>> {
 public:
  static constexpr bool exists = HasClosedObjects<Device> || has_sheet<Device>;

  static constexpr bool checks_application_objects = true;
  static constexpr bool checks([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index) {
    if constexpr (has_sheet<Device>) {
      return true;  // `check_write` decides
    } else {
      return is_closed<Device>(index, sub_index);
    }
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return with_sheet<Device>(
        host.store, [&](const auto&... of_node) { return check_closed<Device>(index, sub_index, bytes, of_node...); });
  }
};

}  // namespace canopen::service

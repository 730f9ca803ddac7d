/// The modes of operation of a drive in a node (CiA 402-2, 6060h and 6502h).
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/accepted_values.hpp"

namespace canopen::service {

/// Rejects values of 6060h, and of that of other axes, that are not supported drive modes: invalid_value. A device
/// without 6060h, or whose EDS does not list the modes, does not have it.
template <class Device>
class DriveModes : public ServiceDefaults<DriveModes<Device>> {
 public:
  static constexpr bool exists = !Device::dictionary.accepted.empty();

  static constexpr bool checks_application_objects = true;
  static constexpr bool checks([[maybe_unused]] std::uint16_t index, std::uint8_t) {
    if constexpr (exists) {
      if constexpr (has_one_axis<Device>) return index == Device::dictionary.accepted.front().index;
      for (const AcceptedRange& row : Device::dictionary.accepted) {
        if (row.index == index) return true;
      }
    }
    return false;
  }
  template <class Host>
  static AbortCode check_write(Host&, std::uint16_t index, std::uint8_t, std::span<std::uint8_t> bytes) {
    return accepts_mode<Device>(index, bytes[0]) ? ok : AbortCode::invalid_value;
  }
};

}  // namespace canopen::service

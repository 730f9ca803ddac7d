/// Error behaviour (1029h) in a node.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/nmt/error_behavior.hpp"
#include "canopen/node/service_set.hpp"

namespace canopen::service {

template <class Device>
class ErrorReaction : public ServiceDefaults<ErrorReaction<Device>> {
 public:
  static constexpr bool exists = Device::dictionary.takes_writes(0x1029, 0x1029);

  static constexpr bool checks(std::uint16_t index, std::uint8_t sub_index) {
    return index == 0x1029 && sub_index != 0;
  }
  template <class Host>
  static AbortCode check_write(Host&, std::uint16_t, std::uint8_t, std::span<std::uint8_t> bytes) {
    return check_error_behavior(bytes[0]);
  }
};

/// Handles a communication error that has been reported: sends the EMCY, then applies the reaction of 1029h:01.
template <class Host>
void communication_failed(Host& host) {
  host.serve();
  std::uint8_t behavior = 0;
  if constexpr (Host::Device::dictionary.has(0x1029, 1)) {
    behavior = static_cast<std::uint8_t>(host.store.template number<0x1029, 1>());
  }
  if (const NmtState next = state_after_error(host.state, behavior); next != host.state) host.enter(next);
}

/// Handles the loss of a monitored node or of the guarding master.
template <class Host>
void error_control_failed(Host& host) {
  host.report(ServiceError::error_control);
  communication_failed(host);
}

}  // namespace canopen::service

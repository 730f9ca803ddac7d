/// EMCY consumer (1028h) in a node.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/emcy/emcy_consumer.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"

namespace canopen::service {

template <class Device>
class EmergencyConsumer : public ServiceDefaults<EmergencyConsumer<Device>> {
  using Consumer = canopen::EmergencyConsumer<Device>;

 public:
  static constexpr bool exists = Consumer::exists;

  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return true;
  }
  template <class Host>
  static bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    const std::optional<ConsumedEmergency> emergency = Consumer::take(host.store.entries(), frame);
    if (!emergency) return false;
    if (serves_emcy(host.state)) host.handlers.template notify<function::OnEmergency>(host.node(), *emergency);
    return true;
  }
};

}  // namespace canopen::service

/// Boot-up message and heartbeat producer (1017h) in a node.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/nmt/heartbeat_producer.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen::service {

/// Returns 1017h; 0 if it does not exist.
template <class Device>
[[nodiscard]] Duration heartbeat_period([[maybe_unused]] const ObjectStore<Device>& store) {
  if constexpr (Device::dictionary.has(0x1017, 0)) {
    return from_milliseconds(static_cast<std::uint16_t>(store.template number<0x1017, 0>()));
  } else {
    return Duration{0};
  }
}

/// The boot-up message, which is also the first heartbeat: sent before all other messages of the node.
template <class Device>
class BootUp : public ServiceDefaults<BootUp<Device>> {
 public:
  /// Discards what is due.
  void reset() { producer_ = {}; }
  /// Makes the message due.
  void start() { producer_.boot_up(); }

  template <class Host>
  bool serve(Host& host) {
    return !producer_.boot_up_due() || send(host);
  }

  template <class Host>
  void keep_deadlines(Host& host) {
    if constexpr (Device::dictionary.has(0x1017, 0)) producer_.keep_deadline(host.now);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return producer_.boot_up_due() ? host.now : producer_.next_deadline();
  }

  /// Sends the boot-up message or a heartbeat, if it is due.
  template <class Host>
  [[nodiscard, gnu::noinline]] static bool send(Host& host) {
    HeartbeatProducer& producer = host.services.template get<BootUp>().producer_;
    return producer.serve(host.bus, host.node_id, host.state, heartbeat_period(host.store), host.now);
  }

  void set_period(Duration period, TimePoint now) { producer_.set_period(period, now); }

 private:
  HeartbeatProducer producer_{};
};

/// Heartbeats, less urgent than the responses of node guarding and SDO.
template <class Device>
class Heartbeat : public ServiceDefaults<Heartbeat<Device>> {
 public:
  static constexpr bool exists = Device::dictionary.has(0x1017, 0);

  template <class Host>
  static bool serve(Host& host) {
    return BootUp<Device>::send(host);
  }

  template <class Host>
  static void after_write(Host& host, std::uint16_t index, std::uint8_t) {
    if (index == 0x1017)
      host.services.template get<BootUp<Device>>().set_period(heartbeat_period(host.store), host.now);
  }
};

}  // namespace canopen::service

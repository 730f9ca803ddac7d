/// Node guarding and life guarding (100Ch, 100Dh) in a node.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/nmt/node_guarding.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/error_reaction.hpp"
#include "canopen/node/services/heartbeat.hpp"

namespace canopen::service {

/// Responds to guarding requests while 1017h is 0.
template <class Device>
class NodeGuarding : public ServiceDefaults<NodeGuarding<Device>> {
 public:
  static constexpr bool exists = Device::dictionary.has(0x100C, 0) && Device::dictionary.has(0x100D, 0);

  template <class Host>
  void reset_communication(Host&) {
    slave_.reset();
  }

  template <class Host>
  bool on_remote_frame(Host& host, const Frame& frame) {
    if (!is_guarding_request(frame, host.node_id)) return false;
    if constexpr (has_sheet<Device>) {
      const Dictionary& dictionary = host.store.entries().dictionary();
      if (!dictionary.has(0x100C, 0) || !dictionary.has(0x100D, 0)) return false;
    }
    if (heartbeat_period(host.store).count() != 0) return true;
    const bool was_lost = slave_.failed();
    slave_.on_request(guard_time(host), life_time_factor(host), host.now);
    if (was_lost) {
      host.end_if_gone(set_of(ServiceError::error_control));
      host.handlers.template notify<function::OnLifeGuarding>(host.node(), false);
    }
    host.attention = true;
    return true;
  }

  template <class Host>
  bool serve(Host& host) {
    return slave_.serve(host.bus, host.node_id, host.state);
  }

  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return slave_.has_answer() ? host.now : slave_.next_deadline();
  }

  ServiceErrors errors() const { return slave_.failed() ? set_of(ServiceError::error_control) : ServiceErrors{}; }

  /// A heartbeat ends guarding.
  template <class Host>
  void after_write(Host& host, std::uint16_t index, std::uint8_t) {
    if constexpr (Heartbeat<Device>::exists) {
      if (index == 0x1017 && heartbeat_period(host.store).count() != 0) slave_.reset();
    }
    if (index == 0x100C || index == 0x100D) {
      slave_.configure(guard_time(host), life_time_factor(host));
      host.end_if_gone(set_of(ServiceError::error_control));
    }
  }

  /// Returns true if the life time has just elapsed.
  template <class Host>
  [[nodiscard]] bool life_time_over(Host& host) {
    return slave_.on_time(guard_time(host), host.now);
  }

 private:
  template <class Host>
  [[nodiscard]] static std::uint16_t guard_time(Host& host) {
    return static_cast<std::uint16_t>(host.store.template number<0x100C, 0>());
  }
  template <class Host>
  [[nodiscard]] static std::uint8_t life_time_factor(Host& host) {
    return static_cast<std::uint8_t>(host.store.template number<0x100D, 0>());
  }

  NodeGuardingSlave slave_{};
};

/// Monitors the guarding requests, after the heartbeats of other nodes.
template <class Device>
class LifeGuarding : public ServiceDefaults<LifeGuarding<Device>> {
 public:
  static constexpr bool exists = NodeGuarding<Device>::exists;

  template <class Host>
  static void on_time(Host& host) {
    if (!host.services.template get<NodeGuarding<Device>>().life_time_over(host)) return;
    error_control_failed(host);
    host.handlers.template notify<function::OnLifeGuarding>(host.node(), true);
  }
};

}  // namespace canopen::service

/// Heartbeat consumer (1016h) in a node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/error_reaction.hpp"
#include "canopen/od/value_bits.hpp"

namespace canopen::service {

template <class Device>
class HeartbeatConsumer : public ServiceDefaults<HeartbeatConsumer<Device>> {
  static constexpr std::size_t count = consumer_heartbeat_times(Device::dictionary);

 public:
  static constexpr bool exists = count > 0;
  static constexpr bool has_fixed_can_id = true;

  template <class Host>
  void reset_communication(Host& host) {
    consumer_.configure(host.store.entries());
  }

  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    const std::optional<ErrorControlMessage> message = error_control_message(frame);
    if (!message) return false;
    consumer_.on_message(*message, host.now, Events<Host>{host});
    return true;
  }

  template <class Host>
  void on_time(Host& host) {
    consumer_.on_time(host.now, Events<Host>{host});
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host&) const {
    return consumer_.next_deadline();
  }

  ServiceErrors errors() const { return consumer_.any_lost() ? set_of(ServiceError::error_control) : ServiceErrors{}; }

  static constexpr bool checks(std::uint16_t index, std::uint8_t sub_index) {
    return index == 0x1016 && sub_index != 0;
  }
  template <class Host>
  AbortCode check_write(Host&, std::uint16_t, std::uint8_t sub_index, std::span<std::uint8_t> bytes) const {
    return consumer_.check(sub_index - 1u, ConsumerHeartbeatTime{number_in(bytes)});
  }
  template <class Host>
  void after_write(Host& host, std::uint16_t index, std::uint8_t sub_index) {
    if (!checks(index, sub_index)) return;
    consumer_.configure(sub_index - 1u, ConsumerHeartbeatTime{host.store.entries().number(index, sub_index)});
    host.end_if_gone(set_of(ServiceError::error_control));
  }

  /// Returns the last NMT state that a node reported; empty while it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state_of(NodeId other) const { return consumer_.state_of(other); }

 private:
  template <class Host>
  struct Events {
    Host& host;
    void happened(HeartbeatEvent event, NodeId other, NmtState state) const {
      if (event == HeartbeatEvent::lost) error_control_failed(host);
      if (event == HeartbeatEvent::back || event == HeartbeatEvent::boot_up)
        host.end_if_gone(set_of(ServiceError::error_control));
      host.handlers.template notify<function::OnHeartbeat>(host.node(), event, other, state);
    }
  };

  canopen::HeartbeatConsumer<count> consumer_{};
};

}  // namespace canopen::service

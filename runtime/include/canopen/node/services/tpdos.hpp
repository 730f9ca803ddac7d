/// TPDOs (1800h..1BFFh) in a node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "canopen/can/cob_id.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/sync.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/tpdo.hpp"

namespace canopen::service {

template <class Device>
class Tpdos : public ServiceDefaults<Tpdos<Device>> {
 public:
  static constexpr bool exists = TpdoService<Device>::count > 0;

  template <class Host>
  void on_state(Host& host, NmtState, NmtState state) {
    if (serves_pdo(state)) tpdos_.enter_operational(host.store, host.now);
  }

  template <class Host>
  bool on_remote_frame([[maybe_unused]] Host& host, [[maybe_unused]] const Frame& frame) {
    if constexpr (Device::options.tpdo_remote_frames) {
      if (!serves_pdo(host.state)) return false;
      tpdos_.on_remote(host.store.entries(), cob_id_of(frame));
      host.attention = true;
    }
    return true;
  }
  /// Sends the TPDOs of a SYNC with the present values, at once if nothing else is waiting.
  template <class Host>
  void on_sync(Host& host, canopen::Sync sync) {
    if (!serves_pdo(host.state)) return;
    if (!tpdos_.on_sync(host.store, host.bus, sync, host.may_send_at_once(), Refresh<Host>{host})) host.serve();
  }

  template <class Host>
  bool serve(Host& host) {
    if (sync_window_over(host)) tpdos_.miss_sync();
    return !serves_pdo(host.state) || tpdos_.serve(host.store, host.bus, host.now, Refresh<Host>{host});
  }
  template <class Host>
  void keep_deadlines(Host& host) {
    tpdos_.keep_deadlines(host.now);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return serves_pdo(host.state) ? tpdos_.next_deadline(host.now) : std::nullopt;
  }

  template <class Host>
  void after_operational_write(Host& host, std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    if (is_tpdo_communication(index) || (TpdoService<Device>::has_dynamic_mapping && is_tpdo_mapping(index)))
      tpdos_.parameter_changed(host.store, index, sub_index, host.now);
    if (new_value && !host.handler_calls.is_supplied(object_key(index, sub_index)))
      tpdos_.changed(host.store.entries(), index, sub_index);
  }
  template <DictionaryObject Object, class Host>
  bool on_new_value(Host& host) {
    if (host.handler_calls.is_supplied(object_key(Object::index, Object::sub_index))) return false;
    return tpdos_.template changed<Object>(host.store.entries());
  }

 private:
  /// Lets the application supply the values of a TPDO. An abort code leaves the value as it is. A new value does not
  /// send the other TPDOs with the object: they would let the application supply it again, and so on.
  template <class Host>
  struct Refresh {
    Host& host;
    void operator()([[maybe_unused]] std::size_t which) const {
      if constexpr (Host::Handlers::has_read_handlers) {
        TpdoService<Device>::for_each_object(which, host.store.entries(), [this](std::uint32_t key) {
          const auto call = host.handler_calls.call_for_tpdo(key);
          static_cast<void>(host.handlers.before_read(host.node(), key));
        });
      }
    }
  };

  TpdoService<Device> tpdos_{};
};

}  // namespace canopen::service

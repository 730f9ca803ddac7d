/// RPDOs (1400h..17FFh) in a node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/can/cob_id.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/received_value.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/drive_modes.hpp"
#include "canopen/node/services/sync.hpp"
#include "canopen/od/accepted_values.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/mpdo_service.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/rpdo.hpp"
#include "canopen/pdo/tpdo.hpp"

namespace canopen::service {

/// Errors of received PDOs: they end when no PDO has them any more.
inline constexpr ServiceErrors rpdo_errors =
    set_of(ServiceError::pdo_length) | set_of(ServiceError::rpdo_timeout) | set_of(ServiceError::mpdo_destination);

/// Whether an RPDO can map a mapping parameter.
[[nodiscard]] constexpr bool has_mappable_mapping(const Dictionary& dictionary) {
  bool any = false;
  dictionary.for_each_communication_entry([&](std::uint16_t index, std::uint8_t, entry::Word word) {
    any = any || ((is_rpdo_mapping(index) || is_tpdo_mapping(index)) && (word & entry::rpdo) != 0);
  });
  return any;
}

/// The functions of a node that RPDOs and MPDOs call.
template <class Host>
struct RpdoHooks {
  /// Whether mappings may change while an RPDO is applied: by a handler, or because the RPDO maps one of them.
  static constexpr bool may_change_mappings =
      Host::Handlers::has_access_handlers || has_mappable_mapping(Host::Device::dictionary);

  /// Offset in RAM of the mode of operation of a drive (6060h) if no function is called for it; a received value that
  /// equals the stored one is then ignored. Otherwise `no_offset`.
  static constexpr std::size_t no_offset = ~std::size_t{0};
  static constexpr std::size_t mode_offset = [] {
    using Device = typename Host::Device;
    if constexpr (DriveModes<Device>::exists) {
      const std::uint16_t index = Device::dictionary.accepted.front().index;
      const entry::Word word = Device::dictionary.find(index, 0);
      if (has_one_axis<Device> && !Host::Handlers::watches(object_key(index, 0)) &&
          entry::place_of(word) == entry::Place::ram)
        return std::size_t{entry::offset_of(word)};
    }
    return no_offset;
  }();

  Host& host;

  [[nodiscard]] auto entries() const { return host.store.entries(); }
  [[nodiscard]] TimePoint now() const { return host.now; }
  [[nodiscard]] bool operational() const { return serves_pdo(host.state); }
  [[nodiscard]] bool window_over() const { return sync_window_over(host); }
  template <DictionaryObject Object>
  void take(const typename Object::type& value) const {
    take_received<Object>(host, value);
  }
  void take(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) const {
    take_received(host, index, sub_index, bytes);
  }
  void happened(RpdoEvent event, std::uint16_t number) const {
    switch (event) {
      case RpdoEvent::taken: break;
      case RpdoEvent::too_short: host.report(ServiceError::pdo_length); break;
      case RpdoEvent::timeout: host.report(ServiceError::rpdo_timeout); break;
      case RpdoEvent::length_right:
      case RpdoEvent::in_time: host.end_if_gone(rpdo_errors); break;
    }
    host.handlers.template notify<function::OnRpdo>(host.node(), event, number);
  }
  void destination_missing(bool missing) const {
    missing ? host.report(ServiceError::mpdo_destination) : host.end_if_gone(rpdo_errors);
  }
};

template <class Device>
class Rpdos : public ServiceDefaults<Rpdos<Device>> {
 public:
  static constexpr bool exists = RpdoService<Device>::count > 0;

  template <class Host>
  void on_state(Host& host, NmtState, NmtState state) {
    if (!serves_pdo(state)) return;
    rpdos_.enter_operational(host.store.entries(), Watched<Host>{host});
    host.end_if_gone(rpdo_errors);
  }

  /// Handles a frame that is an RPDO with one of the CAN-IDs that the pre-defined connection set assigns to PDOs: this
  /// is the usual case. One with another CAN-ID is handled by `on_frame`, after the other services.
  template <class Host>
  bool on_frequent_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    if constexpr (MpdoService<Device>::exists) return false;
    if (!is_pdo_can_id(cob_id) || !serves_pdo(host.state)) return false;
    return rpdos_.on_frame(frame, cob_id, RpdoHooks<Host>{host});
  }
  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return MpdoService<Device>::exists;
  }
  /// An MPDO can have the same COB-ID.
  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    if (serves_pdo(host.state)) rpdos_.on_frame(frame, cob_id, RpdoHooks<Host>{host});
    return false;
  }
  template <class Host>
  void on_sync(Host& host, canopen::Sync) {
    rpdos_.on_sync(RpdoHooks<Host>{host});
  }

  template <class Host>
  void on_time(Host& host) {
    rpdos_.on_time(RpdoHooks<Host>{host});
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return serves_pdo(host.state) ? rpdos_.next_deadline() : std::nullopt;
  }

  ServiceErrors errors() const {
    const auto [too_short, timeout] = rpdos_.conditions();
    return static_cast<ServiceErrors>((too_short ? set_of(ServiceError::pdo_length) : 0) |
                                      (timeout ? set_of(ServiceError::rpdo_timeout) : 0));
  }

  template <class Host>
  void after_operational_write(Host& host, std::uint16_t index, std::uint8_t, bool) {
    if (TpdoService<Device>::has_dynamic_mapping && is_tpdo_mapping(index))
      rpdos_.watch_again(host.store.entries(), Watched<Host>{host});
    if (is_rpdo_communication(index) || (RpdoService<Device>::has_dynamic_mapping && is_rpdo_mapping(index))) {
      rpdos_.parameter_changed(host.store.entries(), index, Watched<Host>{host});
      host.end_if_gone(rpdo_errors);
    }
  }

 private:
  /// Whether a received value needs more than to be stored: it has limits or a different size in memory, a handler or a
  /// service needs it, or a TPDO maps it.
  template <class Host>
  struct Watched {
    Host& host;
    [[nodiscard]] bool operator()(MappedObject mapped) const {
      constexpr entry::Kinds kinds = EntryAccess<Device>::kinds;
      if (mapped.is_dummy()) return false;  // has already been marked
      const entry::Word word = host.store.entries().find(mapped.index(), mapped.sub_index());
      const std::uint8_t size = EntryAccess<Device>::bytes_of(word);
      if ((word & entry::limited) != 0 || (kinds.booleans && entry::is_boolean(word)) ||
          (kinds.padded && (size & (size - 1)) != 0))
        return true;
      if (is_communication_index(mapped.index()) || Host::Handlers::watches(mapped.key())) return true;
      if (MpdoService<Device>::sends_source && (word & entry::tpdo) != 0) return true;
      return TpdoService<Device>::carries(host.store.entries(), mapped.key());
    }
  };

  RpdoService<Device> rpdos_{};
};

}  // namespace canopen::service

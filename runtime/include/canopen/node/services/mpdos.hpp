/// Multiplex PDOs in a node, with their scanner and dispatching lists (1FA0h..1FFFh).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "canopen/node/service_set.hpp"
#include "canopen/node/services/rpdos.hpp"
#include "canopen/pdo/mpdo_check.hpp"
#include "canopen/pdo/mpdo_service.hpp"
#include "canopen/pdo/multiplexed_pdos.hpp"

namespace canopen::service {

template <class Device>
class Mpdos : public ServiceDefaults<Mpdos<Device>> {
  using Service = MpdoService<Device>;
  using Features = MpdoFeatures<Device>;

 public:
  static constexpr bool exists = Service::exists;

  template <class Host>
  void on_state(Host& host, NmtState, NmtState state) {
    if (!serves_pdo(state)) return;
    mpdos_.enter_operational();
    host.end_if_gone(rpdo_errors);
  }

  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return true;
  }
  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    if (serves_pdo(host.state)) mpdos_.on_frame(host.store.entries(), frame, host.node_id, RpdoHooks<Host>{host});
    return false;
  }
  template <class Host>
  bool serve(Host& host) {
    return !serves_pdo(host.state) || mpdos_.serve(host.store.entries(), host.node_id, host.bus, host.now);
  }
  template <class Host>
  void keep_deadlines(Host& host) {
    mpdos_.keep_deadlines(host.now);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return serves_pdo(host.state) ? mpdos_.next_deadline(host.now) : std::nullopt;
  }

  ServiceErrors errors() const {
    return static_cast<ServiceErrors>((mpdos_.too_short() ? set_of(ServiceError::pdo_length) : 0) |
                                      (mpdos_.destination_missing() ? set_of(ServiceError::mpdo_destination) : 0));
  }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return (Features::sends_source && Features::Scanned::contain(index)) ||
           (Features::receives && Features::Dispatched::contain(index));
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return MpdoCheck<Device>::check(host.store.entries(), index, sub_index, bytes);
  }
  template <class Host>
  void after_operational_write(Host& host, std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    if (new_value) mpdos_.changed(host.store.entries(), index, sub_index);
  }
  template <DictionaryObject Object, class Host>
  bool on_new_value(Host& host) {
    return mpdos_.changed(host.store.entries(), Object::index, Object::sub_index);
  }

  /// Queues a DAM-MPDO. Returns false if the node is not Operational or cannot send it.
  template <class Host>
  [[nodiscard]] bool put(Host& host, const MpdoDestination& to, std::uint32_t value) {
    if (!serves_pdo(host.state) || !mpdos_.put(host.store.entries(), to, value)) return false;
    host.attention = true;
    return true;
  }

 private:
  Service mpdos_{};
};

}  // namespace canopen::service

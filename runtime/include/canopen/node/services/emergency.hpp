/// EMCY producer (1014h, 1015h), error register and error history (1001h, 1003h) in a node.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "canopen/emcy/emcy_producer.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen::service {

template <class Device>
class Emergency : public ServiceDefaults<Emergency<Device>> {
  using Producer = EmergencyProducer<Device>;
  static constexpr bool has_writable_history = Device::dictionary.takes_writes(0x1003, 0x1003);

 public:
  template <class Host>
  void reset_communication(Host&) {
    producer_.reset();
  }
  template <class Host>
  void on_state([[maybe_unused]] Host& host, [[maybe_unused]] NmtState before, NmtState) {
    if (options_of<Device>(host.store).emcy_stopped_keeps_last) {
      if (before == NmtState::stopped) producer_.keep_last();
    }
  }

  template <class Host>
  void on_time(Host& host) {
    producer_.end_inhibit_time(host.now);
  }
  template <class Host>
  bool serve(Host& host) {
    return !serves_emcy(host.state) || producer_.serve(host.store, host.bus, host.now);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return producer_.next_deadline(host.now, serves_emcy(host.state));
  }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return (Producer::has_parameters && (index == 0x1014 || index == 0x1015)) ||
           (has_writable_history && index == 0x1003);
  }
  template <class Host>
  static AbortCode check_write([[maybe_unused]] Host& host, std::uint16_t index, std::uint8_t sub_index,
                               std::span<std::uint8_t> bytes) {
    if constexpr (has_writable_history) {
      if (index == 0x1003) return sub_index == 0 && bytes[0] != 0 ? not_cleared(host) : ok;
    }
    if constexpr (Producer::has_parameters) return Producer::check(host.store.entries(), index, bytes);
    return ok;
  }
  /// An element of the history without an error cannot be read, unless it is 0 by an option.
  template <class Host>
  static AbortCode before_read([[maybe_unused]] Host& host, [[maybe_unused]] std::uint16_t index,
                               [[maybe_unused]] std::uint8_t sub_index) {
    if constexpr (Device::dictionary.has(0x1003, 0)) {
      if (options_of<Device>(host.store).error_history_empty_is_zero) return ok;
      if (index == 0x1003 && sub_index > host.store.template number<0x1003, 0>()) return AbortCode::no_data;
    }
    return ok;
  }

  template <class Host>
  static void after_write([[maybe_unused]] Host& host, [[maybe_unused]] std::uint16_t index, std::uint8_t) {
    if constexpr (has_writable_history) {
      if (!options_of<Device>(host.store).error_history_empty_is_zero) return;
      if (index == 0x1003) Producer::clear_history(host.store);
    }
  }

  /// Sends the EMCY before a reset that has been commanded, if the device has one.
  template <class Host>
  void announce_reset(Host& host) const {
    if (serves_emcy(host.state)) producer_.announce_reset(host.store, host.bus);
  }

  /// Reports an error of the application.
  template <class Host>
  void report(Host& host, std::uint16_t code, ErrorRegister bits, const EmergencyInfo& info) {
    producer_.appeared(host.store, code, bits, info);
    host.attention = true;
    host.handlers.template notify<function::OnError>(host.node(), code);
  }
  /// Reports an error that a service has detected.
  template <class Host>
  [[gnu::noinline]] static void report(Host& host, ServiceError error) {
    host.services.template get<Emergency>().producer_.appeared(host.store, error);
    host.attention = true;
    host.handlers.template notify<function::OnError>(host.node(),
                                                     service_error_codes[static_cast<std::uint8_t>(error)]);
  }
  /// Ends an error of the application.
  template <class Host>
  void end(Host& host, ErrorRegister bits) {
    if (producer_.gone(host.store, bits)) host.attention = true;
  }
  template <class Host>
  void end(Host& host, ErrorRegister bits, const EmergencyInfo& remaining) {
    if (producer_.gone(host.store, bits, remaining)) host.attention = true;
  }
  /// Ends an error that a service has detected.
  template <class Host>
  void end(Host& host, ServiceError error) {
    if (producer_.gone(host.store, error)) host.attention = true;
  }
  /// Ends those of these errors that no service has any more.
  template <class Host>
  [[gnu::noinline]] static void end_if_gone(Host& host, ServiceErrors errors) {
    errors = static_cast<ServiceErrors>(errors & ~host.services.errors());
    for (std::uint8_t error = 0; errors != 0; ++error, errors >>= 1) {
      if ((errors & 1) != 0) host.end(static_cast<ServiceError>(error));
    }
  }
  template <class Host>
  void hold(Host& host, ErrorRegister bits) {
    producer_.hold(host.store, bits);
  }
  [[nodiscard]] std::uint16_t lost() const { return producer_.lost(); }

 private:
  template <class Host>
  [[nodiscard]] static AbortCode not_cleared([[maybe_unused]] Host& host) {
    return static_cast<AbortCode>(options_of<Device>(host.store).error_history_abort_code);
  }

  Producer producer_{};
};

}  // namespace canopen::service

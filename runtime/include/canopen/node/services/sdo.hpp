/// SDO servers (1200h..127Fh) in a node.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/optimization.hpp"
#include "canopen/base/result.hpp"
#include "canopen/node/received_value.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/tpdos.hpp"
#include "canopen/node/services/values.hpp"
#include "canopen/pdo/mpdo_service.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/sdo/sdo_servers.hpp"

namespace canopen::service {

/// The functions of a node that its servers call.
template <class Host, class... Parts>
struct SdoHooks {
  using Device = typename Host::Device;

  Host& host;
  bool new_value = true;  ///< the written value differs from the present one, and TPDOs may have to know

  [[nodiscard]] EntryAccess<Device> entries() { return host.entries(); }
  [[nodiscard]] AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) {
    if (const AbortCode code = host.before_read(index, sub_index); code != ok) return code;
    if constexpr (Host::Handlers::has_upload_handlers) {
      const std::uint32_t key = object_key(index, sub_index);
      return host.handler_calls().ask(0, [&] { return host.handlers().before_read(host.node(), key); });
    }
    return ok;
  }
  [[nodiscard]] AbortCode before_write(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    const AbortCode code = canopen::before_write(host, index, sub_index, bytes);
    if constexpr (StoredValues<Device, Parts...>::exists) {
      if (code == ok && !host.handler_calls().set_by_handler())
        StoredValues<Device, Parts...>::before_change(host, index, sub_index, bytes);
    }
    return code;
  }
  /// Whether a value must be written.
  [[nodiscard]] bool is_new(entry::Word word, std::span<const std::uint8_t> bytes) {
    if (host.handler_calls().set_by_handler()) {
      new_value = false;
      return false;
    }
    const bool mappable = (word & entry::tpdo) != 0;  // not a DOMAIN
    if constexpr (MpdoService<Device>::sends_source) {
      // Also of interest: a new value of a list of objects that are sent.
      if (mappable) new_value = !entries().holds(word, bytes);
    } else if constexpr (!prefers_size && Tpdos<Device>::exists && EntryAccess<Device>::has_plain_numbers) {
      new_value = mappable && entries().replace(word, bytes);
      return !mappable;
    } else if constexpr (Tpdos<Device>::exists) {
      new_value = mappable && !entries().holds(word, bytes);
    }
    return new_value || !mappable;
  }
  void after_write(std::uint16_t index, std::uint8_t sub_index) {
    host.after_write(index, sub_index, new_value);
    notify_written(host, index, sub_index);
  }
  [[nodiscard]] AbortCode command(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return host.command(index, sub_index, bytes);
  }

  /// Whether the request started to store parameters in steps.
  [[nodiscard]] bool started_command() requires(StoredValues<Device, Parts...>::is_stepped) {
    return host.template service<StoredValues<Device, Parts...>>().take_started();
  }

  // DOMAINs that the application streams
  using Streams = DomainHandlerSet<Parts...>;
  [[nodiscard]] bool streams_upload(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
    return Streams::streams_upload(object_key(index, sub_index));
  }
  [[nodiscard]] Result<std::uint32_t> read_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                                  std::span<std::uint8_t> bytes) requires(Streams::any) {
    const std::uint32_t key = object_key(index, sub_index);
    return host.handler_calls().ask(
        0, [&] { return Streams::read(host.handlers().all(), host.node(), key, offset, bytes); });
  }
  [[nodiscard]] bool streams_download(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
    return Streams::streams_download(object_key(index, sub_index));
  }
  [[nodiscard]] AbortCode write_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                       std::span<const std::uint8_t> bytes, bool last) requires(Streams::any) {
    const std::uint32_t key = object_key(index, sub_index);
    return host.handler_calls().ask(
        0, [&] { return Streams::write(host.handlers().all(), host.node(), key, offset, bytes, last); });
  }
};

template <class Device, class... Handlers>
class Sdo : public ServiceDefaults<Sdo<Device, Handlers...>> {
  template <class Host>
  using Hooks = SdoHooks<Host, Handlers...>;
  static constexpr bool has_writable_parameters =
      Device::dictionary.takes_writes(sdo_server_parameter, last_sdo_server_parameter);

 public:
  static constexpr bool has_fixed_can_id = true;

  template <class Host>
  void on_state(Host&, NmtState, NmtState state) {
    if (!serves_sdo(state)) servers_.reset();
  }

  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return SdoServers<Device>::count > 1;
  }
  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    if (!serves_sdo(host.state()) || !servers_.on_frame(host.store(), frame, Hooks<Host>{host}, host.now()))
      return false;
    // If nothing else is due, the response does not wait until all services have been asked what they have to send.
    if constexpr (!StoredValues<Device, Handlers...>::is_stepped) {
      if (host.may_send_at_once() && servers_.serve(host.store(), host.bus(), Hooks<Host>{host}, host.now()))
        return true;
    }
    host.attend();
    return true;
  }
  template <class Host>
  void on_time(Host& host) {
    servers_.on_time(host.now());
  }
  template <class Host>
  bool serve(Host& host) {
    if constexpr (StoredValues<Device, Handlers...>::is_stepped) {
      const auto result = host.template service<StoredValues<Device, Handlers...>>().take_result();
      if (result) servers_.command_ended(*result);
    }
    return servers_.serve(host.store(), host.bus(), Hooks<Host>{host}, host.now());
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return servers_.has_reply() ? host.now() : servers_.next_deadline();
  }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return has_writable_parameters && index >= sdo_server_parameter && index <= last_sdo_server_parameter;
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    return check_sdo_cob_id(host.entries(), index, sub_index, bytes);
  }

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_reply() const { return servers_.has_reply(); }
  /// Aborts a transfer of a DOMAIN that has been bound to other memory.
  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) { servers_.domain_rebound(index, sub_index); }

 private:
  SdoServers<Device> servers_{};
};

}  // namespace canopen::service

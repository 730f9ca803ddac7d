/// The SDO servers of a node, one for each of 1200h..127Fh (CiA 301, 7.5.2.33).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/node/handler_calls.hpp"
#include "canopen/node/received_value.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/tpdos.hpp"
#include "canopen/node/services/values.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/mpdo_service.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server.hpp"

namespace canopen {

inline constexpr std::uint16_t sdo_server_parameter = 0x1200;
inline constexpr std::uint16_t last_sdo_server_parameter = 0x127F;

namespace service {

/// The functions of a node that its servers call.
template <class Host, class... Parts>
struct SdoHooks {
  using Device = typename Host::Device;

  Host& host;

  [[nodiscard]] EntryAccess<Device> entries() const { return host.store.entries(); }
  [[nodiscard]] AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) const {
    if (const AbortCode code = host.services.before_read(host, index, sub_index); code != ok) return code;
    if constexpr (Host::Handlers::has_upload_handlers) {
      const std::uint32_t key = object_key(index, sub_index);
      const HandlerCall call{host.handler_calls};
      return host.handlers.before_read(host.node(), key);
    }
    return ok;
  }
  /// Writes a value that fits the entry, unless a check rejects it.
  [[nodiscard]] AbortCode write(std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                                std::span<std::uint8_t> bytes) const {
    // Without a call for most objects of a node without write handlers: saves 20 instructions of a Cortex-M0+, takes 28
    // bytes if RPDOs are mapped at run time.
    if (has_checks(host, index, sub_index)) {
      if (const AbortCode code = check_received(host, index, sub_index, bytes); code != ok) return code;
    }
    bool new_value = false;  // the written value differs from the present one, and TPDOs may have to know
    if (!host.handler_calls.set_by_handler()) {
      if constexpr (StoredValues<Device, Parts...>::exists)
        StoredValues<Device, Parts...>::before_change(host, index, sub_index, bytes);
      new_value = store(word, bytes);
    }
    host.after_write(index, sub_index, new_value);
    notify_written(host, index, sub_index);
    return ok;
  }
  /// The application has taken the bytes of a DOMAIN.
  void written(std::uint16_t index, std::uint8_t sub_index) const {
    host.after_write(index, sub_index, true);
    notify_written(host, index, sub_index);
  }
  [[nodiscard]] AbortCode command(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) const {
    return host.services.command(host, index, sub_index, bytes);
  }

  /// Whether the request started to store parameters in steps.
  [[nodiscard]] bool started_command() const requires(StoredValues<Device, Parts...>::is_stepped) {
    return host.services.template get<StoredValues<Device, Parts...>>().take_started();
  }

  // DOMAINs that the application streams
  using Streams = DomainHandlerSet<Parts...>;
  [[nodiscard]] bool streams_upload(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
    return Streams::streams_upload(object_key(index, sub_index));
  }
  [[nodiscard]] Result<std::uint32_t> read_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                                  std::span<std::uint8_t> bytes) const requires(Streams::any) {
    const std::uint32_t key = object_key(index, sub_index);
    const HandlerCall call{host.handler_calls};
    return Streams::read(host.handlers.all(), host.node(), key, offset, bytes);
  }
  [[nodiscard]] bool streams_download(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
    return Streams::streams_download(object_key(index, sub_index));
  }
  [[nodiscard]] AbortCode write_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                       std::span<const std::uint8_t> bytes, bool last) const requires(Streams::any) {
    const std::uint32_t key = object_key(index, sub_index);
    const HandlerCall call{host.handler_calls};
    return Streams::write(host.handlers.all(), host.node(), key, offset, bytes, last);
  }

 private:
  /// Stores a value. Returns whether it differs from the one before, if TPDOs may have to know.
  [[nodiscard]] bool store(entry::Word word, std::span<const std::uint8_t> bytes) const {
    const EntryAccess<Device> entries = this->entries();
    if (EntryAccess<Device>::is_domain(word)) {
      // A handler may have taken the bytes, and bound the DOMAIN to other memory.
      if (entries.domain(word).data == bytes.data())
        entries.resize_domain(word, static_cast<std::uint32_t>(bytes.size()));
      return false;
    }
    const bool mappable = (word & entry::tpdo) != 0;
    bool new_value = true;
    if constexpr (MpdoService<Device>::sends_source) {
      // Also of interest: a new value of a list of objects that are sent.
      if (mappable) new_value = !entries.holds(word, bytes);
    } else if constexpr (!prefers_size && Tpdos<Device>::exists && EntryAccess<Device>::has_plain_numbers) {
      // Saves 5 instructions of a download on a Cortex-M4, takes 16 bytes of a Cortex-M0+.
      if (mappable) return entries.replace(word, bytes);
      new_value = false;
    } else if constexpr (Tpdos<Device>::exists) {
      new_value = mappable && !entries.holds(word, bytes);
    }
    if (new_value || !mappable) entries.write_value(word, bytes);
    return new_value;
  }
};

/// The first server always exists, with the COB-IDs of the pre-defined connection set: CiA 301 fixes those of 1200h.
/// Another one exists while both of its COB-IDs are usable; bit 30, "dynamically assigned", is ignored. Servers do not
/// share state; if one of them starts to write a DOMAIN, the others abort their transfers of it.
template <class Device, class... Handlers>
class Sdo : public ServiceDefaults<Sdo<Device, Handlers...>> {
  template <class Host>
  using Hooks = SdoHooks<Host, Handlers...>;
  using Store = ObjectStore<Device>;
  static constexpr bool has_writable_parameters =
      Device::dictionary.takes_writes(sdo_server_parameter, last_sdo_server_parameter);
  static constexpr bool is_stepped = StoredValues<Device, Handlers...>::is_stepped;

  /// The parameters of the servers.
  static constexpr std::size_t count = [] {
    std::size_t servers = 1;
    for (std::uint32_t index = sdo_server_parameter + 1; index <= last_sdo_server_parameter; ++index) {
      if (Device::dictionary.has(static_cast<std::uint16_t>(index), 1)) ++servers;
    }
    return servers;
  }();
  static constexpr std::array<std::uint16_t, count> indices = [] {
    std::array<std::uint16_t, count> rows{sdo_server_parameter};
    std::size_t at = 1;
    for (std::uint32_t index = sdo_server_parameter + 1; index <= last_sdo_server_parameter; ++index) {
      if (Device::dictionary.has(static_cast<std::uint16_t>(index), 1)) rows[at++] = static_cast<std::uint16_t>(index);
    }
    return rows;
  }();

 public:
  static constexpr bool has_fixed_can_id = true;

  template <class Host>
  void on_state(Host&, NmtState, NmtState state) {
    if (serves_sdo(state)) return;
    for (SdoServer<Device>& server : servers_) server.reset();
  }

  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return count > 1;
  }
  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    if (!serves_sdo(host.state) || !take(host, frame, cob_id)) return false;
    // If nothing else is due, the response does not wait until all services have been asked what they have to send.
    if (is_stepped || !host.may_send_at_once() || !send_replies(host)) host.attention = true;
    return true;
  }
  template <class Host>
  void on_time(Host& host) {
    for (SdoServer<Device>& server : servers_) server.on_time(host.now);
  }
  template <class Host>
  bool serve(Host& host) {
    if constexpr (is_stepped) {
      // A command has ended: the response that waits for it is sent.
      const auto result = host.services.template get<StoredValues<Device, Handlers...>>().take_result();
      if (result) {
        for (SdoServer<Device>& server : servers_) server.command_ended(*result);
      }
    }
    return send_replies(host);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    if (has_reply()) return host.now;
    std::optional<TimePoint> next;
    for (const SdoServer<Device>& server : servers_) {
      const std::optional<TimePoint> own = server.next_deadline();
      if (own && (!next || *own < *next)) next = own;
    }
    return next;
  }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return has_writable_parameters && index >= sdo_server_parameter && index <= last_sdo_server_parameter;
  }
  /// Checks a COB-ID of 1200h..127Fh. 0609 0030h: its CAN-ID changes while the channel is valid, or is a restricted
  /// one; or a different value for 1200h, which is fixed.
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    if (sub_index != request_sub_index && sub_index != response_sub_index) return ok;
    EntryAccess<Device> entries = host.store.entries();
    const CobId before{entries.number(entries.find(index, sub_index))};
    if constexpr (Device::dictionary.takes_writes(sdo_server_parameter, sdo_server_parameter)) {
      if (index == sdo_server_parameter) return before.value() == number_in(bytes) ? ok : AbortCode::invalid_value;
    }
    return may_change(before, CobId{number_in(bytes)}, true) ? ok : AbortCode::invalid_value;
  }

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_reply() const {
    for (const SdoServer<Device>& server : servers_) {
      if (server.has_reply()) return true;
    }
    return false;
  }
  /// Aborts a transfer of a DOMAIN that has been bound to other memory.
  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) {
    for (SdoServer<Device>& server : servers_) server.domain_rebound(index, sub_index);
  }

 private:
  static constexpr std::uint8_t request_sub_index = 1;
  static constexpr std::uint8_t response_sub_index = 2;

  /// Returns a COB-ID in the format of `cob_id_of`; `invalid_bit` if this server does not have a usable one.
  [[nodiscard]] static std::uint32_t cob_id_of_server(std::size_t i, std::uint8_t sub_index, Store& store) {
    if (i == 0) {
      const std::uint32_t base =
          sub_index == request_sub_index ? function_code::sdo_request : function_code::sdo_response;
      return base + store.node_id().value();
    }
    const entry::Word word = store.entries().find(indices[i], sub_index);
    const std::uint32_t cob_id = word > Dictionary::no_sub_index ? store.entries().number(word) : CobId::invalid_bit;
    return is_usable(cob_id) ? cob_id & CobId::identifier : CobId::invalid_bit;
  }

  /// Accepts a request to one of the servers; returns false if it is none. One whose length is not eight bytes is
  /// ignored.
  template <class Host>
  [[nodiscard]] bool take(Host& host, const Frame& frame, std::uint32_t cob_id) {
    Store& store = host.store;
    for (std::size_t i = 0; i < count; ++i) {
      if (cob_id_of_server(i, request_sub_index, store) != cob_id) continue;
      if (i != 0 && cob_id_of_server(i, response_sub_index, store) == CobId::invalid_bit) continue;
      if (frame.size != 8) return true;
      if constexpr (count > 1) {
        if (!servers_[i].takes_segments()) take_domain_from_others(store, i, frame.data);
      }
      if constexpr (is_stepped) servers_[i].discard_held_reply();
      Hooks<Host> hooks{host};
      servers_[i].on_request(frame.data, hooks, host.now);
      if constexpr (is_stepped) {
        if (hooks.started_command()) servers_[i].hold_reply();
      }
      return true;
    }
    return false;
  }

  /// Sends pending responses. Returns false if the bus had no room; they remain pending.
  template <class Host>
  [[nodiscard]] bool send_replies(Host& host) {
    for (std::size_t i = 0; i < count; ++i) {
      while (servers_[i].has_reply()) {
        const std::uint32_t cob_id = cob_id_of_server(i, response_sub_index, host.store);
        const bool gone = i != 0 && cob_id == CobId::invalid_bit;  // since the request
        if (!gone && !send_data(host.bus, cob_id, 8, servers_[i].reply().data())) return false;
        servers_[i].reply_sent(Hooks<Host>{host}, host.now);
        if constexpr (!Device::options.sdo_block_transfer) break;  // only a block upload has the next response already
      }
    }
    return true;
  }

  void take_domain_from_others(Store& store, std::size_t server, const sdo::Data& request) {
    const sdo::ClientCommand command = sdo::client_command(request[0]);
    if (command != sdo::ClientCommand::initiate_download && command != sdo::ClientCommand::block_download) return;
    const std::uint16_t index = sdo::index_of(request);
    const entry::Word word = store.entries().find(index, request[3]);
    if (word <= Dictionary::no_sub_index || !entry::is_domain(word)) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (i != server) servers_[i].domain_rebound(index, request[3]);
    }
  }

  std::array<SdoServer<Device>, count> servers_{};
};

}  // namespace service
}  // namespace canopen

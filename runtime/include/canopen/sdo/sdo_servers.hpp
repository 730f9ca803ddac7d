/// The SDO servers of a device, one for each of 1200h..127Fh (CiA 301, 7.5.2.33).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server.hpp"

namespace canopen {

inline constexpr std::uint16_t sdo_server_parameter = 0x1200;
inline constexpr std::uint16_t last_sdo_server_parameter = 0x127F;

/// The first server always exists, with the COB-IDs of the pre-defined connection set: CiA 301 fixes those of 1200h.
/// Another one exists while both of its COB-IDs are usable; bit 30, "dynamically assigned", is ignored. Servers do not
/// share state; a DOMAIN that one of them starts to write is no longer transferred by the others.
template <class Device>
class SdoServers {
 public:
  static constexpr std::size_t count = [] {
    std::size_t servers = 1;
    for (std::uint32_t index = sdo_server_parameter + 1; index <= last_sdo_server_parameter; ++index) {
      if (Device::dictionary.has(static_cast<std::uint16_t>(index), 1)) ++servers;
    }
    return servers;
  }();

  /// Accepts a frame that is a request to one of the servers; returns false if it is not. A request whose length is not
  /// eight bytes is ignored.
  template <class Hooks>
  bool on_frame(ObjectStore<Device>& store, const Frame& frame, Hooks&& hooks, TimePoint now) {
    const std::uint32_t cob_id = cob_id_of(frame);
    for (std::size_t i = 0; i < count; ++i) {
      if (cob_id_of_server(i, request_sub_index, store) != cob_id) continue;
      if (i != 0 && cob_id_of_server(i, response_sub_index, store) == CobId::invalid_bit) continue;
      if (frame.size != 8) return true;
      if constexpr (count > 1) {
        if (!servers_[i].takes_segments()) take_domain_from_others(store, i, frame.data);
      }
      if constexpr (requires { hooks.started_command(); }) servers_[i].discard_held_reply();
      servers_[i].on_request(frame.data, hooks, now);
      if constexpr (requires { hooks.started_command(); }) {
        if (hooks.started_command()) servers_[i].hold_reply();
      }
      return true;
    }
    return false;
  }

  void on_time(TimePoint now) {
    for (SdoServer<Device>& server : servers_) server.on_time(now);
  }

  /// Sends pending responses. Returns false if the bus had no room; they remain pending.
  template <Bus BusType, class Hooks>
  [[nodiscard]] bool serve(ObjectStore<Device>& store, BusType& bus, Hooks&& hooks, TimePoint now) {
    for (std::size_t i = 0; i < count; ++i) {
      while (servers_[i].has_reply()) {
        const std::uint32_t cob_id = cob_id_of_server(i, response_sub_index, store);
        const bool gone = i != 0 && cob_id == CobId::invalid_bit;  // since the request
        if (!gone && !send_data(bus, cob_id, 8, servers_[i].reply().data())) return false;
        servers_[i].reply_sent(hooks, now);
      }
    }
    return true;
  }

  [[nodiscard]] bool has_reply() const {
    for (const SdoServer<Device>& server : servers_) {
      if (server.has_reply()) return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next;
    for (const SdoServer<Device>& server : servers_) {
      const std::optional<TimePoint> own = server.next_deadline();
      if (own && (!next || *own < *next)) next = own;
    }
    return next;
  }

  /// A command has ended: the response that waits for it is sent.
  void command_ended(AbortCode code) {
    for (SdoServer<Device>& server : servers_) server.command_ended(code);
  }

  void reset() {
    for (SdoServer<Device>& server : servers_) server.reset();
  }

  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) {
    for (SdoServer<Device>& server : servers_) server.domain_rebound(index, sub_index);
  }

 private:
  static constexpr std::uint8_t request_sub_index = 1;
  static constexpr std::uint8_t response_sub_index = 2;

  static constexpr std::array<std::uint16_t, count> indices = [] {
    std::array<std::uint16_t, count> rows{sdo_server_parameter};
    std::size_t at = 1;
    for (std::uint32_t index = sdo_server_parameter + 1; index <= last_sdo_server_parameter; ++index) {
      if (Device::dictionary.has(static_cast<std::uint16_t>(index), 1)) rows[at++] = static_cast<std::uint16_t>(index);
    }
    return rows;
  }();

  /// Returns a COB-ID in the format of `cob_id_of`; `invalid_bit` if this server does not have a usable one.
  [[nodiscard]] static std::uint32_t cob_id_of_server(std::size_t i, std::uint8_t sub_index,
                                                      ObjectStore<Device>& store) {
    if (i == 0) {
      const std::uint32_t base =
          sub_index == request_sub_index ? function_code::sdo_request : function_code::sdo_response;
      return base + store.node_id().value();
    }
    const entry::Word word = store.entries().find(indices[i], sub_index);
    const std::uint32_t cob_id = word > Dictionary::no_sub_index ? store.entries().number(word) : CobId::invalid_bit;
    return is_usable(cob_id) ? cob_id & CobId::identifier : CobId::invalid_bit;
  }

  void take_domain_from_others([[maybe_unused]] ObjectStore<Device>& store, std::size_t server,
                               const std::array<std::uint8_t, 8>& request) {
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

/// Checks whether these bytes may be written to a COB-ID of 1200h..127Fh. 0609 0030h: its CAN-ID changes while the
/// channel is valid, or is a restricted one; or a different value for 1200h, which is fixed.
template <class Device>
[[nodiscard]] AbortCode check_sdo_cob_id(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                         std::span<const std::uint8_t> bytes) {
  if (sub_index != 1 && sub_index != 2) return ok;
  const CobId before{entries.number(entries.find(index, sub_index))};
  if constexpr (Device::dictionary.takes_writes(sdo_server_parameter, sdo_server_parameter)) {
    if (index == sdo_server_parameter) return before.value() == number_in(bytes) ? ok : AbortCode::invalid_value;
  }
  return may_change(before, CobId{number_in(bytes)}, true) ? ok : AbortCode::invalid_value;
}

}  // namespace canopen

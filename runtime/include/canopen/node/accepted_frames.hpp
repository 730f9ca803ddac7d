/// The frames that a node processes, for the acceptance filters of a CAN controller or a socket. An image that does not
/// use this list does not contain any of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/lss/lss_protocol.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen {

template <class Device, class BusType, class... Handlers>
class Node;

/// All data or all remote frames with one CAN-ID.
struct AcceptedFrame {
  std::uint32_t id = 0;
  bool extended = false;
  bool remote = false;

  friend constexpr bool operator==(const AcceptedFrame&, const AcceptedFrame&) = default;
};

namespace accepted_detail {

enum class Source : std::uint8_t { sdo_request, sync, time, emergency, heartbeat, rpdo, tpdo };

/// An entry of the dictionary that determines which frames are accepted.
struct Entry {
  Source source;
  entry::Word word;
};

/// Objects that define received frames (CiA 301, 7.5.2), by index and sub-index.
struct Rule {
  std::uint16_t first;
  std::uint16_t last;
  std::uint8_t first_sub_index;
  std::uint8_t last_sub_index;
  Source source;
};
inline constexpr Rule rules[] = {
    {0x1005, 0x1005, 0, 0, Source::sync},        {0x1012, 0x1012, 0, 0, Source::time},
    {0x1016, 0x1016, 1, 127, Source::heartbeat}, {0x1028, 0x1028, 1, 127, Source::emergency},
    {0x1201, 0x127F, 1, 1, Source::sdo_request}, {0x1400, 0x15FF, 1, 1, Source::rpdo},
    {0x1800, 0x19FF, 1, 1, Source::tpdo},
};

template <class Visit>
constexpr void for_each_source(const Dictionary& dictionary, Visit&& visit) {
  dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
    for (const Rule& rule : rules) {
      const bool fits = index >= rule.first && index <= rule.last && sub_index >= rule.first_sub_index &&
                        sub_index <= rule.last_sub_index;
      if (fits && entry::wire_bytes(word) == sizeof(std::uint32_t)) visit(Entry{rule.source, word});
    }
  });
}

/// Calls `visit` with the frames that the value of such an entry selects, if any.
template <class Visit>
void accept(const DeviceOptions& options, Source source, std::uint32_t value, Visit&& visit) {
  const auto accepted = [&](std::uint32_t cob_id, bool remote) {
    visit(AcceptedFrame{CobId{cob_id & CobId::identifier}.can_id(), (cob_id & CobId::extended_bit) != 0, remote});
  };
  const auto frames = [&](std::uint32_t cob_id, bool remote) {
    const bool is_of_pdo = source == Source::rpdo || source == Source::tpdo;
    const bool is_allowed = is_of_pdo && is_in(options.pdo_allowed_can_ids, cob_id);
    if (is_allowed || is_usable(cob_id & CobId::identifier)) accepted(cob_id, remote);
  };
  const CobId cob_id{value};
  switch (source) {
    case Source::sync: return frames(value, false);
    case Source::time:
      if (!cob_id.valid()) frames(value, false);  // here bit 31 enables consuming TIME
      return;
    case Source::emergency:
    case Source::sdo_request:
    case Source::rpdo:
      if (cob_id.valid()) frames(value, false);
      return;
    case Source::tpdo:
      if (options.tpdo_remote_frames && cob_id.valid() && cob_id.rtr_allowed()) frames(value, true);
      return;
    case Source::heartbeat:
      if (const ConsumerHeartbeatTime time{value}; time.used()) {
        accepted(function_code::error_control + std::uint32_t{time.node_id().value()}, false);
      }
      return;
  }
}

template <class Device>
inline constexpr std::size_t source_count = [] {
  std::size_t count = 0;
  for_each_source(Device::dictionary, [&](const Entry&) { ++count; });
  return count;
}();

template <class Device>
inline constexpr std::array<Entry, source_count<Device>> sources = [] {
  std::array<Entry, source_count<Device>> rows{};
  std::size_t at = 0;
  for_each_source(Device::dictionary, [&](const Entry& row) { rows[at++] = row; });
  return rows;
}();

}  // namespace accepted_detail

/// Calls `visit(AcceptedFrame)` for all frames that this node does not ignore, some of them more than once, with
/// its present COB-IDs: they change with SDO writes, resets, LSS and the application. A node without node-ID
/// accepts only LSS.
template <class SomeNode, class Visit>
requires requires {
  typename SomeNode::DeviceType;
  SomeNode::has_lss;
}
void for_each_accepted_frame(SomeNode& node, Visit&& visit) {
  using Device = typename SomeNode::DeviceType;
  if constexpr (SomeNode::has_lss) {
    visit(AcceptedFrame{lss::request_id, false, false});
  }
  const NodeId node_id = node.node_id();
  if (!node_id.valid()) return;
  visit(AcceptedFrame{function_code::nmt, false, false});
  visit(AcceptedFrame{function_code::sdo_request + std::uint32_t{node_id.value()}, false, false});
  if constexpr (Device::dictionary.has(0x100C, 0) && Device::dictionary.has(0x100D, 0)) {
    visit(AcceptedFrame{function_code::error_control + std::uint32_t{node_id.value()}, false, true});
  }
  const EntryAccess entries = node.entries();
  for (const accepted_detail::Entry& row : accepted_detail::sources<Device>) {
    accepted_detail::accept(options_of<Device>(entries), row.source, entries.number(row.word), visit);
  }
}

/// Maximum number of frames for a node of this device.
template <class Device>
inline constexpr std::size_t max_accepted_frames = accepted_detail::source_count<Device> + 4;

}  // namespace canopen

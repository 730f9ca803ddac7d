/// Heartbeat consumer (CiA 301, 7.2.8.3.2.2): monitors the nodes in 1016h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Events of a monitored node.
enum class HeartbeatEvent : std::uint8_t {
  started,        ///< its first heartbeat: it is monitored from now on
  state_changed,  ///< a heartbeat contains a different NMT state than the previous one
  boot_up,        ///< its boot-up message
  lost,           ///< no heartbeat within its time: the heartbeat event of CiA 301, EMCY 8130h
  back,           ///< the first heartbeat after it was lost
};

/// An entry of 1016h (CiA 301, 7.5.2.19): node-ID in bits 23..16, time in ms in bits 15..0.
class ConsumerHeartbeatTime {
 public:
  constexpr ConsumerHeartbeatTime() = default;
  constexpr explicit ConsumerHeartbeatTime(std::uint32_t value) : value_{value} {}
  constexpr ConsumerHeartbeatTime(NodeId node_id, std::uint16_t milliseconds)
      : value_{(std::uint32_t{node_id.value()} << 16) | milliseconds} {}

  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
  [[nodiscard]] constexpr NodeId node_id() const { return NodeId{static_cast<std::uint8_t>(value_ >> 16)}; }
  [[nodiscard]] constexpr std::uint16_t milliseconds() const { return static_cast<std::uint16_t>(value_); }

  /// Whether it monitors a node: its time is not 0, and its node-ID is 1..127.
  [[nodiscard]] constexpr bool used() const { return milliseconds() != 0 && node_id().valid(); }

 private:
  std::uint32_t value_ = 0;
};

/// Returns how many nodes a device's 1016h can contain.
[[nodiscard]] constexpr std::size_t consumer_heartbeat_times(const Dictionary& dictionary) {
  std::size_t count = 0;
  while (count < 127 && dictionary.has(0x1016, static_cast<std::uint8_t>(count + 1))) ++count;
  return count;
}

/// Monitors up to `Count` nodes, with eight bytes of RAM for each. A node is monitored from its first heartbeat on; a
/// boot-up message alone does not start it, because a node sends one even if its heartbeat is off. While the node is
/// monitored, a boot-up message counts as a heartbeat.
///
/// Events are reported to the node: `host.happened(HeartbeatEvent, NodeId, NmtState)`, with the last reported state.
template <std::size_t Count>
class HeartbeatConsumer {
 public:
  /// Checks an entry, counted from 0, before it is written. 0604 0043h: another entry has the same node-ID.
  [[nodiscard]] AbortCode check(std::size_t entry, ConsumerHeartbeatTime time) const {
    if (!time.used()) return ok;
    for (std::size_t i = 0; i < Count; ++i) {
      if (i != entry && entries_[i].node_id == time.node_id().value()) return AbortCode::parameter_incompatible;
    }
    return ok;
  }

  /// Sets an entry, counted from 0: its node is unknown until its next heartbeat.
  void configure(std::size_t entry, ConsumerHeartbeatTime time) {
    entries_[entry] = Entry{};
    if (!time.used()) return;
    entries_[entry].node_id = time.node_id().value() & 0x7F;
    entries_[entry].milliseconds = time.milliseconds();
  }

  /// Sets all entries from 1016h. Stored values can contain a node twice, which a write cannot (7.5.2.19: 0604 0043h).
  /// The later entry is then ignored as long as the earlier one monitors the node, as if its write had been rejected:
  /// one bad entry must not stop the monitoring of all nodes, and an SDO upload shows the master what is stored.
  template <class Device>
  void configure(EntryAccess<Device> entries) {
    for (std::size_t i = 0; i < Count; ++i) {
      const entry::Word word = entries.find(0x1016, static_cast<std::uint8_t>(i + 1));
      if constexpr (has_sheet<Device>) {
        if (word <= Dictionary::no_sub_index) {
          configure(i, ConsumerHeartbeatTime{0});
          continue;
        }
      }
      configure(i, ConsumerHeartbeatTime{entries.number(word)});
    }
  }

  /// Processes a message of any node. Guarding responses with bit 7 set are not heartbeats.
  template <class Host>
  void on_message(const ErrorControlMessage& message, TimePoint now, Host&& host) {
    if (message.toggle) return;
    Entry* const entry = find(message.node_id);
    if (entry == nullptr) return;
    const std::optional<HeartbeatEvent> event = event_of(*entry, message.state);
    if (event != HeartbeatEvent::boot_up || entry->watched()) {
      entry->last = LastState{message.state};
      entry->lost = false;
      entry->deadline = now + from_milliseconds(entry->milliseconds);
    }
    if (event) host.happened(*event, message.node_id, message.state);
  }

  /// Reports nodes whose time has elapsed.
  template <class Host>
  void on_time(TimePoint now, Host&& host) {
    for (Entry& entry : entries_) {
      if (!entry.watched() || now < entry.deadline) continue;
      entry.lost = true;
      host.happened(HeartbeatEvent::lost, NodeId{entry.node_id}, entry.last.state());
    }
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next;
    for (const Entry& entry : entries_) {
      if (entry.watched() && (!next || entry.deadline < *next)) next = entry.deadline;
    }
    return next;
  }

  /// Whether any node is lost and has not come back.
  [[nodiscard]] bool any_lost() const {
    for (const Entry& entry : entries_) {
      if (entry.lost) return true;
    }
    return false;
  }

  /// Returns the last state that a monitored node reported; empty before its first heartbeat and while it is lost.
  [[nodiscard]] std::optional<NmtState> state_of(NodeId node_id) const {
    for (const Entry& entry : entries_) {
      if (entry.node_id == node_id.value() && entry.watched()) return entry.last.state();
    }
    return std::nullopt;
  }

 private:
  struct Entry {
    TimePoint deadline{};
    std::uint16_t milliseconds = 0;
    std::uint8_t node_id : 7 = 0;  ///< 0: not used
    bool lost : 1 = false;
    LastState last{};

    [[nodiscard]] bool watched() const { return !lost && last.known(); }
  };

  [[nodiscard]] Entry* find(NodeId node_id) {
    for (Entry& entry : entries_) {
      if (entry.node_id == node_id.value()) return &entry;
    }
    return nullptr;
  }

  [[nodiscard]] static std::optional<HeartbeatEvent> event_of(const Entry& entry, NmtState state) {
    if (state == NmtState::initialisation) return HeartbeatEvent::boot_up;
    if (!entry.last.known()) return HeartbeatEvent::started;
    if (entry.lost) return HeartbeatEvent::back;
    if (entry.last != LastState{state}) return HeartbeatEvent::state_changed;
    return std::nullopt;
  }

  std::array<Entry, Count> entries_{};
};

}  // namespace canopen

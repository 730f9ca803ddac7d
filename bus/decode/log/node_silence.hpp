/// When a node of a log is lost: it sends nothing for longer than its heartbeat or its event timers allow.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/message.hpp"

namespace edsc {

/// Follows the frames of all nodes. As for a heartbeat consumer (CiA 301, 7.2.8.2.2), the monitoring of a node begins
/// with its first heartbeat after a boot-up message; its time is the shortest one in 1016h of the given nodes,
/// otherwise twice 1017h. A node without a heartbeat is monitored from its first TPDO with an event timer on, until an
/// NMT command other than start; its time is twice the shortest event timer.
class NodeSilence {
 public:
  /// The devices whose 1016h states times.
  explicit NodeSilence(const std::vector<const Device*>& consumers);

  /// A frame at this time; `sender` is the model of the node of the message, null if it is not known. Returns when the
  /// node was lost before this frame; nothing if it was not.
  std::optional<std::int64_t> see(const Message& message, const NodeModel* sender, std::int64_t microseconds);

  /// When a node was lost before this time; nothing if it was not.
  [[nodiscard]] std::optional<std::int64_t> lost_at(std::uint8_t node_id, std::int64_t microseconds) const;

 private:
  static constexpr std::size_t node_ids = 128;

  struct Sender {
    std::int64_t last_us = 0;
    std::int64_t limit_us = 0;  ///< 0: not monitored
    bool has_heartbeat = false;
  };

  void begin_heartbeat(std::uint8_t node_id, const NodeModel* sender);
  void begin_event_timer(const Message& message, const NodeModel* sender);
  void end_event_timers(const Message& command);

  std::array<std::int64_t, node_ids> consumer_us_{};  ///< 0: no node states a time
  std::array<Sender, node_ids> senders_{};
};

}  // namespace edsc

/// Which nodes of a network are on a bus: those whose frames are received, or that answer a request.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace edsc {

struct Network;
struct NetworkNode;

enum class Presence : std::uint8_t { unknown, absent, present };

/// A node is present after a frame that only it transmits: error control, EMCY, SDO response or TPDO. It is absent
/// after a time without such a frame in which it also does not answer an SDO request. A request of another program is
/// as good as one of the watch: the watch does not disturb a transfer with a request of its own.
class PresenceWatch {
 public:
  /// A node in Stopped without heartbeat and guarding sends nothing: it counts as absent.
  PresenceWatch(canopen::Duration absent, canopen::TimePoint now) : absent_{absent}, start_{now} {}

  /// Adds a node. `cob_ids` are those that only this node transmits on, with bit 29 for an extended CAN-ID.
  /// `heartbeat`: 1017h; 0: none. Returns its place.
  std::size_t add(std::uint8_t node_id, std::set<std::uint32_t> cob_ids, canopen::Duration heartbeat);

  /// A frame of another program or device.
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now);

  /// Call at least every 100 ms. `send` transmits a request; false: the bus has no room for it now.
  void on_time(canopen::TimePoint now, const std::function<bool(const canopen::Frame&)>& send);

  [[nodiscard]] Presence presence(std::size_t place) const { return nodes_[place].presence; }

 private:
  struct Node {
    std::uint8_t node_id;
    std::set<std::uint32_t> cob_ids;
    canopen::Duration heartbeat;
    canopen::TimePoint heard;  ///< its last frame, or the start
    canopen::TimePoint asked;
    bool is_asked = false;  ///< since `heard`
    Presence presence = Presence::unknown;
  };

  [[nodiscard]] canopen::Duration quiet_time(const Node& node) const;

  canopen::Duration absent_;
  canopen::TimePoint start_;
  std::vector<Node> nodes_;
};

/// The COB-IDs of data frames that this node transmits, and no other node of the network.
[[nodiscard]] std::set<std::uint32_t> own_cob_ids(const Network& network, const NetworkNode& node);

}  // namespace edsc

/// Boot-up messages and SDO responses of all nodes, and NMT commands of others, while a command does something else.
#pragma once

#include <array>
#include <cstdint>

#include "online/live_bus.hpp"

namespace edsc {

/// During its lifetime, counts the frames that show that a node restarted, that two nodes have its node-ID, or that
/// there is another NMT master.
class BusWatch {
 public:
  explicit BusWatch(LiveBus& bus);
  ~BusWatch();
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// The number of boot-up messages with this node-ID so far.
  [[nodiscard]] unsigned boot_ups(std::uint8_t node_id) const { return counts_[node_id].boot_ups; }

  /// The number of NMT commands of other masters to this node or to all nodes so far.
  [[nodiscard]] unsigned foreign_commands(std::uint8_t node_id) const {
    return counts_[0].foreign_commands + counts_[node_id].foreign_commands;
  }

  /// Whether the default SDO of this node-ID sent more responses than it received requests since the first request,
  /// those of other clients included. This holds for segmented transfers only, in which the server responds once to
  /// each request but an abort.
  [[nodiscard]] bool has_extra_responses(std::uint8_t node_id) const {
    return counts_[node_id].responses > counts_[node_id].requests;
  }

 private:
  struct Counts {
    unsigned boot_ups = 0, requests = 0, responses = 0, foreign_commands = 0;
  };

  void count_command(const canopen::Frame& received);
  void count(const canopen::Frame& frame);

  LiveBus& bus_;
  std::array<Counts, 128> counts_{};  ///< by node-ID; 0 is an NMT command to all nodes
};

}  // namespace edsc

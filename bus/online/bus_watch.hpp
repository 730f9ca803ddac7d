/// Boot-up messages and SDO responses of all nodes, and NMT commands of others, while a command does something else.
#pragma once

#include <array>
#include <canopen/nmt_master/heartbeat_rate.hpp>
#include <canopen/nmt_master/response_count.hpp>
#include <cstdint>

#include "online/live_bus.hpp"

namespace edsc {

/// During its lifetime, counts the frames that show that a node restarted, that two nodes have its node-ID, or that
/// there is another NMT master.
class BusWatch {
 public:
  /// A request of which no response arrives for the time `forgotten_after` is no longer expected to be answered.
  explicit BusWatch(LiveBus& bus, canopen::Duration forgotten_after = canopen::longest_span);
  ~BusWatch();
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// The number of boot-up messages with this node-ID so far.
  [[nodiscard]] unsigned boot_ups(std::uint8_t node_id) const { return counts_[node_id].boot_ups; }

  /// The number of NMT commands of other masters to this node or to all nodes so far.
  [[nodiscard]] unsigned foreign_commands(std::uint8_t node_id) const {
    return counts_[0].foreign_commands + counts_[node_id].foreign_commands;
  }

  /// Whether the default SDO of this node-ID sent a response without a request since the first request, those of other
  /// clients included.
  [[nodiscard]] bool has_extra_responses(std::uint8_t node_id) const { return counts_[node_id].extra_responses; }

  /// Measures the rate of the heartbeats from the next one on. `producer_time` is 1017h in ms; 0: unknown.
  void measure_heartbeats(std::uint8_t node_id, std::uint16_t producer_time) {
    counts_[node_id].rate.begin(producer_time);
  }
  [[nodiscard]] const canopen::HeartbeatRate& heartbeat_rate(std::uint8_t node_id) const {
    return counts_[node_id].rate;
  }

 private:
  struct Counts {
    unsigned boot_ups = 0, foreign_commands = 0;
    bool is_asked = false, extra_responses = false;
    canopen::ResponseCount responses{};
    canopen::HeartbeatRate rate{};
  };

  void count_command(const canopen::Frame& received);
  void count(const canopen::Frame& frame, canopen::TimePoint now);

  LiveBus& bus_;
  canopen::Duration forgotten_after_;
  std::array<Counts, 128> counts_{};  ///< by node-ID; 0 is an NMT command to all nodes
};

}  // namespace edsc

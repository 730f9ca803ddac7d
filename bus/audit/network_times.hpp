/// Times of the messages of a network, as a log has them, beside the bounds that are computed from the network file.
#pragma once

#include <array>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "audit/audit_state.hpp"
#include "audit/spread.hpp"
#include "network/network.hpp"
#include "network/timing/timing.hpp"

namespace edsc::audit {

struct MeasuredMessage {
  TimedMessage computed;
  bool is_cyclic = false;  ///< its period is a longest distance, too
  std::uint64_t frames = 0;
  Spread distance = {};    ///< between two frames, without an NMT command or boot-up message in between
  Spread after_sync = {};  ///< of a synchronous PDO: from the last SYNC
  std::optional<std::int64_t> last_us = {};

  /// The longest response time that the log shows, in microseconds: of a synchronous PDO after SYNC, of a cyclic
  /// message how much it was late, with its own time on the bus. Empty if the log does not show one.
  [[nodiscard]] std::optional<double> response_us() const;
  /// Empty without a measured time or without a bound.
  [[nodiscard]] std::optional<bool> is_within_bound() const;
};

/// SDO responses of a node.
struct MeasuredServer {
  std::string name;
  std::uint8_t node_id = 0;
  std::int64_t timeout_us = 0;  ///< of the network file
  Spread response = {};         ///< from a request to its response
};

class NetworkTimes {
 public:
  /// The network must outlive this.
  explicit NetworkTimes(const Network& network);

  /// A frame whose message was decoded; times do not decrease.
  void see(const SeenMessage& seen);

  [[nodiscard]] const Network& network() const { return *network_; }
  [[nodiscard]] const std::vector<MeasuredMessage>& messages() const { return messages_; }
  [[nodiscard]] const std::vector<MeasuredServer>& servers() const { return servers_; }
  [[nodiscard]] const BusLoad& computed_load() const { return load_; }

 private:
  void see_sdo(const SeenMessage& seen);

  const Network* network_;
  std::vector<MeasuredMessage> messages_;
  std::vector<MeasuredServer> servers_;
  std::unordered_map<std::uint32_t, std::size_t> places_;  ///< in `messages_`, by COB-ID
  std::array<std::optional<std::int64_t>, 128> asked_us_;  ///< last request to the default SDO
  BusLoad load_;
  std::optional<std::uint32_t> sync_;  ///< its COB-ID
  std::optional<std::int64_t> sync_us_;
  std::int64_t changed_us_ = 0;  ///< last NMT command or boot-up message
};

}  // namespace edsc::audit

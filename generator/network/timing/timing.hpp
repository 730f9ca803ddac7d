/// Load and response times of a network: all frames that its nodes send, with their periods and deadlines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"
#include "network/timing/response_times.hpp"

namespace edsc {

/// A message of the network, and its worst-case response time.
struct TimedMessage {
  std::string name;  ///< `axis1 TPDO 2`
  Position position;
  FrameService service = FrameService::pdo;
  CanMessage message;
  bool is_synchronous = false;       ///< the response time counts from the moment when SYNC was due
  bool has_assumed_period = false;   ///< from `assume`, since neither inhibit time nor event timer states one
  bool may_be_sent_earlier = false;  ///< a PDO that events can cause at any time: it has no inhibit time
  ResponseTime response;
};

/// Highest load in percent without a warning, unless the network file states one.
inline constexpr unsigned default_max_load = 80;

struct NetworkTiming {
  std::vector<TimedMessage> messages;  ///< ascending by CAN-ID
  BusLoad load;
};

/// The longest time between two PDOs of an enabled TPDO: its SYNC cycles or its event timer. Nothing if only events,
/// requests or a SYNC that no node sends cause it.
[[nodiscard]] std::optional<Nanoseconds> longest_interval(const CobIdUse& tpdo, const std::vector<CobIdUse>& uses);

/// Computes load and response times. A PDO is as long as its mapping; RTR-only PDOs are ignored. One SDO request and
/// one response are counted for the whole network. Empty if the network does not have a valid bit rate.
[[nodiscard]] NetworkTiming network_timing(const Network& network, const std::vector<CobIdUse>& uses);

}  // namespace edsc

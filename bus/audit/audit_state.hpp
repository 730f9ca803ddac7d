/// What the checks of an audit share: limits, findings, and the nodes with their NMT state and values in force.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/can/frame.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <optional>
#include <vector>

#include "audit/findings.hpp"
#include "audit/incidents.hpp"
#include "audit/node_settings.hpp"
#include "decode/decoder.hpp"
#include "decode/message.hpp"

namespace edsc::audit {

struct Limits {
  unsigned tolerance = 10;  ///< of a time, in percent
  std::int64_t sdo_timeout_us = 1'000'000;
  std::uint32_t bit_rate = 0;  ///< in bit/s; 0: the load is not computed
  unsigned max_load = 80;      ///< in percent of the bit rate

  /// How much a time may differ from the nominal one. At least a millisecond, but at most half of the time: a frame
  /// waits for others on the bus, and devices count in milliseconds.
  [[nodiscard]] std::int64_t slack(std::int64_t us) const {
    constexpr std::int64_t tick = 1000;
    return std::max(us * static_cast<std::int64_t>(tolerance) / 100, std::min(us / 2, tick));
  }
};

/// The time that a node has to obey an NMT command, or to report an event: in between both states are right.
inline constexpr std::int64_t reaction_us = 100'000;
/// The time from a reset command to the boot-up message.
inline constexpr std::int64_t max_boot_us = 5'000'000;

/// A state that a command or a message has ended.
struct EndedState {
  std::optional<canopen::NmtState> state;  ///< empty if not known
  std::int64_t us = 0;
};

struct NodeState {
  const NodeModel* model = nullptr;  ///< null without an EDS
  NodeSettings settings;
  std::int64_t settings_since = 0;
  std::optional<Moment> first_seen;  ///< the first frame that the node sent

  std::optional<canopen::NmtState> state;  ///< empty if not known
  Moment state_since;
  bool may_boot = false;          ///< a reset command was sent that the node may have obeyed
  std::vector<EndedState> ended;  ///< since the last boot-up message, each state once, the last one at the end
  std::optional<std::int64_t> last_emcy_us;
  std::optional<std::int64_t> last_heartbeat_error_us;  ///< EMCY 8130h

  [[nodiscard]] bool is_operational() const { return state == canopen::NmtState::operational; }

  /// Whether the node may be in this state: it is not known, the right one, or commands have just ended it.
  [[nodiscard]] bool may_be(canopen::NmtState wanted, const Moment& now) const {
    if (!state || *state == wanted) return true;
    const auto fits = [&](const EndedState& one) { return one.state.value_or(wanted) == wanted; };
    if (!now.has_time) return ended.empty() || fits(ended.back());
    return std::ranges::any_of(ended,
                               [&](const EndedState& one) { return fits(one) && now.us - one.us < reaction_us; });
  }

  /// Since when the state and the settings have been as they are.
  [[nodiscard]] std::int64_t unchanged_since() const { return std::max(settings_since, state_since.us); }
};

/// A frame with its meaning; the state of the nodes is that before it.
struct SeenMessage {
  const canopen::Frame& frame;
  const Message& message;
  Moment at;
};

struct AuditState {
  static constexpr std::size_t node_ids = 128;

  Limits limits;
  Findings findings;
  Incidents incidents;
  std::array<NodeState, node_ids> nodes;
  std::vector<std::uint8_t> known;  ///< the node-IDs with an EDS
  std::int64_t times_since = 0;     ///< since when the times of the log are in order
  std::uint8_t nmt_master = 0;      ///< its node-ID, if it is given; 0: by 1F80h
  std::uint8_t lss_node_id = 0;     ///< that an LSS slave has last accepted; 0: none

  [[nodiscard]] NodeState& sender(const Message& message) { return nodes[message.node_id % node_ids]; }
};

/// `152.3 ms`
[[nodiscard]] std::string milliseconds(std::int64_t us);

}  // namespace edsc::audit

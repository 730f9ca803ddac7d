/// What a simulation has seen: the output of its program (canopen_sim/network_simulation/simulation_protocol.hpp).
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// Frames of one message; times in us.
struct SeenFrames {
  std::uint64_t count = 0;
  std::uint64_t worst_us = 0;  ///< longest response time, to the end of the intermission
  std::uint64_t at_us = 0;     ///< when this frame ended
};

/// Frames that are not among the messages with a bound.
struct OtherFrames {
  std::uint32_t can_id = 0;
  bool extended = false;
  bool remote = false;
  std::optional<std::size_t> node;  ///< the sender; none of SDO requests and NMT commands
  SeenFrames seen;
};

struct SimulationEvent {
  enum class Kind : std::uint8_t { emergency, heartbeat_lost, heartbeat_back, state };
  Kind kind = Kind::emergency;
  std::int64_t time_us = 0;     ///< from the start of the nodes; negative before
  std::size_t node = 0;         ///< place in Network::nodes
  unsigned code = 0;            ///< of an emergency
  unsigned error_register = 0;  ///< of an emergency
  unsigned other = 0;           ///< of a heartbeat: the node-ID
  canopen::NmtState state{};    ///< of a state
};

struct SimulatedNodeEnd {
  enum class Condition : std::uint8_t { off, running, lost, babbling };
  Condition condition = Condition::off;
  canopen::NmtState state{};
};

/// An entry of the DCF that a node has rejected.
struct RefusedEntry {
  std::size_t node = 0;
  unsigned index = 0;
  unsigned sub_index = 0;
  std::uint32_t abort_code = 0;
};

struct SimulationResult {
  std::vector<SeenFrames> messages;                   ///< in the order of NetworkTiming::messages
  std::vector<std::optional<std::uint64_t>> changes;  ///< events of event-driven PDOs, in the same order
  std::vector<OtherFrames> others;                    ///< by priority
  std::vector<SimulatedNodeEnd> nodes;                ///< in the order of Network::nodes
  std::vector<SimulationEvent> events;                ///< in the order of time
  std::vector<RefusedEntry> refused;
  std::uint64_t measured_us = 0;
  std::uint64_t busy_us = 0;
  std::uint64_t busiest_us = 0;  ///< of the second with the highest load
  std::uint64_t frames = 0;
  std::uint64_t errors = 0;
};

/// Reads the lines of the program, in pieces of any size.
class SimulationReader {
 public:
  SimulationReader(std::size_t nodes, std::size_t messages);

  /// `progress` gets the simulated time in us.
  void read(std::string_view piece, const std::function<void(std::uint64_t)>& progress);

  /// Whether the last line was read, and no line was malformed.
  [[nodiscard]] bool is_complete() const { return ended_ && malformed_.empty(); }
  /// The first malformed line, if any.
  [[nodiscard]] const std::string& malformed() const { return malformed_; }
  [[nodiscard]] SimulationResult& result() { return result_; }

 private:
  bool read_line(std::string_view line, const std::function<void(std::uint64_t)>& progress);

  std::string pending_;
  std::string malformed_;
  bool greeted_ = false;
  bool ended_ = false;
  SimulationResult result_;
};

}  // namespace edsc

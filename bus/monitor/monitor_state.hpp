/// The observed state of a bus: nodes, PDOs, and rates.
#pragma once

#include <array>
#include <canopen/can/frame.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "decode/message.hpp"

namespace edsc {

/// The rate of an event, counted over the last whole second, or over the whole time if shorter.
class Rate {
 public:
  void count(std::uint64_t amount = 1) { total_ += amount; }
  /// Call once a second.
  void take(double seconds) {
    per_second_ = seconds > 0 ? static_cast<double>(total_ - taken_) / seconds : 0;
    taken_ = total_;
  }
  /// The rate over the whole time.
  void take_all(double seconds) {
    taken_ = 0;
    take(seconds);
  }
  [[nodiscard]] std::uint64_t total() const { return total_; }
  [[nodiscard]] double per_second() const { return per_second_; }

 private:
  std::uint64_t total_ = 0;
  std::uint64_t taken_ = 0;
  double per_second_ = 0;
};

struct MonitoredNode {
  std::string name;                          ///< from the EDS
  bool is_simulated = false;                 ///< by this program
  std::optional<canopen::NmtState> state;    ///< reported by error control
  std::optional<canopen::NmtState> assumed;  ///< from later NMT commands and TPDOs, if not `state`
  std::optional<std::int64_t> heard_us;      ///< its last error control message
  std::int64_t interval_us = 0;              ///< between its last two heartbeats; 0: unknown
  std::uint64_t heartbeats = 0;
  std::uint64_t emergencies = 0;
  std::string emergency;  ///< the last EMCY as text
  std::uint16_t error_code = 0;
  std::int64_t emergency_us = 0;

  /// No heartbeat for twice the previous interval plus a tenth of a second.
  [[nodiscard]] bool is_late(std::int64_t now_us) const {
    return heard_us && interval_us != 0 && now_us - *heard_us > 2 * interval_us + 100'000;
  }
};

/// The value of a known object in a PDO.
struct MonitoredValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string name;
  std::string text;  ///< with its unit and names
  std::string unit;
  std::optional<double> number;  ///< of a BOOLEAN, an integer or a finite REAL; the physical value if it has a unit
};

struct MonitoredPdo {
  std::string text;  ///< the values by name
  std::vector<MonitoredValue> values;
  canopen::Frame frame;    ///< the last one
  std::int64_t at_us = 0;  ///< its time
  Rate frames;
};

class MonitorState {
 public:
  struct PdoKey {
    std::uint8_t node_id;
    bool transmitted;
    std::uint16_t number;
    friend auto operator<=>(const PdoKey&, const PdoKey&) = default;
  };

  void set_name(std::uint8_t node_id, std::string name) { node_of(node_id).name = std::move(name); }
  void set_simulated(std::uint8_t node_id, bool is_simulated) { node_of(node_id).is_simulated = is_simulated; }

  /// Returns true for new information. Heartbeats of the same state, PDOs with the same octets and mapping, SYNC and
  /// TIME are not new.
  bool add(const canopen::Frame& frame, const Message& message, std::int64_t now_us);

  /// Call regularly: updates the rates once a second.
  void pass(std::int64_t now_us);
  /// Computes the rates over the whole time.
  void end(std::int64_t now_us);

  [[nodiscard]] const std::map<std::uint8_t, MonitoredNode>& nodes() const { return nodes_; }
  [[nodiscard]] const std::map<PdoKey, MonitoredPdo>& pdos() const { return pdos_; }
  /// By COB-ID; the first 4096, since noise on a bus may have any.
  [[nodiscard]] const std::map<std::uint32_t, Rate>& others() const { return others_; }
  [[nodiscard]] const Rate& frames() const { return frames_; }
  [[nodiscard]] const Rate& bits() const { return bits_; }
  [[nodiscard]] std::int64_t start_us() const { return start_us_; }

  /// The start of counting the rates.
  void start(std::int64_t now_us) { start_us_ = tick_us_ = now_us; }

 private:
  MonitoredNode& node_of(std::uint8_t node_id);
  void add_command(const canopen::Frame& frame);
  void assume(std::uint8_t node_id, std::optional<canopen::NmtState> state);
  bool add_state(const Message& message, std::int64_t now_us);
  bool add_pdo(const canopen::Frame& frame, const Message& message, std::int64_t now_us);
  template <class Update>
  void update_rates(Update update);

  std::map<std::uint8_t, MonitoredNode> nodes_;
  std::array<std::optional<canopen::NmtState>, 128> commanded_;  ///< after the last NMT command, by node-ID
  std::map<PdoKey, MonitoredPdo> pdos_;
  std::map<std::uint32_t, Rate> others_;
  Rate frames_, bits_;
  std::int64_t start_us_ = 0, tick_us_ = 0;
};

}  // namespace edsc

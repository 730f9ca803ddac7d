/// What has been seen on a bus: nodes, PDOs, and how much goes on.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "decode/message.hpp"

namespace edsc {

/// How often something comes: counted over the last whole second, or over all the time while that is shorter.
class Rate {
 public:
  void count(std::uint64_t amount = 1) { total_ += amount; }
  /// To be called once a second.
  void take(double seconds);
  [[nodiscard]] std::uint64_t total() const { return total_; }
  [[nodiscard]] double per_second() const { return per_second_; }

 private:
  std::uint64_t total_ = 0;
  std::uint64_t taken_ = 0;
  double per_second_ = 0;
};

struct MonitoredNode {
  std::string name;                      ///< of the data sheet
  std::string state;                     ///< as error control has told it; empty: it has not
  std::string assumed;                   ///< from later NMT commands and TPDOs; empty: nothing contradicts `state`
  std::optional<std::int64_t> heard_us;  ///< its last error control message
  std::int64_t interval_us = 0;          ///< between its last two heartbeats; 0: not known
  std::uint64_t heartbeats = 0;
  std::uint64_t emergencies = 0;
  std::string emergency;  ///< the last one in words
  std::uint16_t error_code = 0;
  std::int64_t emergency_us = 0;

  /// No heartbeat for twice the time that it took before, and a tenth of a second.
  [[nodiscard]] bool is_late(std::int64_t now_us) const {
    return heard_us && interval_us != 0 && now_us - *heard_us > 2 * interval_us + 100'000;
  }
};

struct MonitoredPdo {
  std::string text;                                         ///< the values by name
  std::vector<std::pair<std::string, std::string>> values;  ///< name and value of each known object
  std::int64_t seen_us = 0;
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

  /// True: something is new; heartbeats, PDOs, SYNC and TIME that tell the same as before are not.
  bool add(const canopen::Frame& frame, const Message& message, std::int64_t now_us);

  /// To be called now and then: takes the rates once a second.
  void pass(std::int64_t now_us);
  /// Takes the rates over all that has been seen in this time.
  void end(std::int64_t now_us);

  [[nodiscard]] const std::map<std::uint8_t, MonitoredNode>& nodes() const { return nodes_; }
  [[nodiscard]] const std::map<PdoKey, MonitoredPdo>& pdos() const { return pdos_; }
  [[nodiscard]] const std::map<std::uint32_t, Rate>& others() const { return others_; }  ///< by COB-ID
  [[nodiscard]] const Rate& frames() const { return frames_; }
  [[nodiscard]] const Rate& bits() const { return bits_; }
  [[nodiscard]] std::int64_t start_us() const { return start_us_.value_or(0); }

  /// When the rates begin to be counted.
  void start(std::int64_t now_us) { start_us_ = tick_us_ = now_us; }

 private:
  MonitoredNode& node_of(std::uint8_t node_id);
  void add_command(const canopen::Frame& frame);
  void assume(std::uint8_t node_id, std::string_view state);
  bool add_state(const Message& message, std::int64_t now_us);
  bool add_pdo(const Message& message, std::int64_t now_us);
  void take_rates(double seconds);

  std::map<std::uint8_t, MonitoredNode> nodes_;
  std::array<std::string, 128> commanded_;  ///< where the last NMT command leads to, by node-ID
  std::map<PdoKey, MonitoredPdo> pdos_;
  std::map<std::uint32_t, Rate> others_;
  Rate frames_, bits_;
  std::string sync_, time_;
  std::optional<std::int64_t> start_us_;
  std::int64_t tick_us_ = 0;
};

}  // namespace edsc

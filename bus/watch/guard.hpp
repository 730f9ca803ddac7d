/// Compares the frames of a bus with a network file, and raises an alarm for what the file does not allow. Live frames
/// and those of a log raise the same alarms: the guard has no clock but the times that it is given.
#pragma once

#include <array>
#include <canopen/can/frame.hpp>
#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "decode/sdo_follower.hpp"
#include "watch/alarm.hpp"
#include "watch/allowed_traffic.hpp"
#include "watch/frame_rate.hpp"

namespace edsc::watch {

struct GuardSettings {
  /// Entries that the application of the master writes: node-ID, index, sub-index.
  std::set<std::tuple<std::uint8_t, std::uint16_t, std::uint8_t>> allowed_writes;
};

class Guard {
 public:
  using Sink = std::function<void(Alarm&&)>;

  /// The network must outlive the guard. `sink` gets each alarm.
  Guard(const Network& network, GuardSettings settings, Sink sink);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// A frame was received. Times are microseconds since any origin, and do not decrease.
  void see(const canopen::Frame& frame, std::int64_t us);
  /// No frame was received until this time.
  void pass(std::int64_t us);
  /// Ends the watch at the time of the last frame.
  void finish() { flush_missing(now_us_); }

 private:
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  struct NodeState {
    const NetworkNode* node = nullptr;
    NodeTimes times;
    bool starts_itself = false;  ///< 1F80h
    bool is_seen = false;        ///< it has sent a boot-up message or heartbeat
    bool is_missing = false;
    bool has_booted = false;             ///< a boot-up message was the first message
    std::optional<bool> is_operational;  ///< empty: not known
    std::int64_t state_us = 0;           ///< since when
    std::int64_t heard_us = 0;           ///< last boot-up message, heartbeat or response
    std::int64_t booted_us = -never;     ///< last boot-up message
    std::int64_t reset_us = -never;      ///< last reset command
    std::int64_t restarted_us = -never;  ///< last restart without a command
    std::int64_t due_us = never;         ///< when it is missing
    bool is_current = false;             ///< 1020h was read as configured since the boot-up
    FrameRate heartbeats;
    SdoFollower sdo;
  };

  struct FrameState {
    std::int64_t last_us = -never;
    std::int64_t due_us = never;  ///< when it is missing
    bool is_late = false;         ///< it is missing unless its node is
    std::optional<int> credit;    ///< of a synchronous PDO: SYNC cycles that still allow one; empty before a SYNC
    std::uint32_t silent_syncs = 0;
    FrameRate rate;
  };

  /// What has been found missing while no frame was received.
  struct Missing {
    Alarm alarm;
    std::uint8_t node_id = 0;
  };

  void raise(AlarmId id, const NodeState* node, std::string text, const canopen::Frame* frame = nullptr,
             std::uint32_t detail = 0);
  [[nodiscard]] NodeState* state_of(std::uint8_t node_id);

  // Time
  void check_due(std::int64_t us);
  void find_next_due();
  void pass_due_frame(std::size_t at);
  void report_late(const NodeState& node);
  void report_late_frame(const NodeState& node, std::size_t at);
  void miss(Missing missing);
  void flush_missing(std::int64_t us);
  void end_silence();

  // Frames
  void count_load(const canopen::Frame& frame);
  void see_unknown(const canopen::Frame& frame);
  void see_nmt(const canopen::Frame& frame);
  void see_error_control(const canopen::Frame& frame, NodeState& node);
  void see_boot_up(const canopen::Frame& frame, NodeState& node);
  void see_sync(const canopen::Frame& frame, const AllowedFrame& allowed, FrameState& state);
  void see_pdo(const canopen::Frame& frame, const AllowedFrame& allowed, FrameState& state);
  void see_sdo(const canopen::Frame& frame, const AllowedFrame& allowed);
  void see_write(const canopen::Frame& frame, NodeState& node, const Message& message,
                 std::span<const std::uint8_t> value);
  void check_read(const canopen::Frame& frame, NodeState& node, const Message& message,
                  std::span<const std::uint8_t> value);
  void check_written(const canopen::Frame& frame, NodeState& node, const Message& message,
                     std::span<const std::uint8_t> value);

  // NMT
  [[nodiscard]] bool is_of_master(canopen::NmtCommand command, std::uint8_t node_id);
  [[nodiscard]] bool may_reset(NodeState& node);
  void apply(canopen::NmtCommand command, NodeState& node, bool is_foreign);
  void set_operational(NodeState& node, std::optional<bool> is_operational);
  void miss_node(NodeState& node);

  AllowedTraffic allowed_;
  GuardSettings settings_;
  Sink sink_;
  std::vector<NodeState> nodes_;
  std::array<std::int16_t, 128> places_of_nodes_{};
  std::vector<FrameState> frames_;  ///< as those of `allowed_`
  NodeState* master_ = nullptr;
  std::vector<Missing> missing_;
  Message message_;
  bool has_begun_ = false;
  bool is_silent_ = false;
  std::int64_t now_us_ = 0;
  std::int64_t last_frame_us_ = 0;
  std::int64_t gap_us_ = -never;  ///< end of the last gap without any frame
  std::int64_t next_due_us_ = never;
  std::uint64_t bits_ = 0, max_bits_ = 0;  ///< of the present second, and its limit; 0: none
  std::int64_t second_ = 0;
};

}  // namespace edsc::watch

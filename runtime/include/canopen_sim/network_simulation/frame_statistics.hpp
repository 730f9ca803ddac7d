/// Counts, response times and load of the frames on a VirtualBus. Host side.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "canopen/can/arbitration.hpp"
#include "canopen_sim/network_simulation/network_plan.hpp"
#include "canopen_sim/virtual_bus.hpp"

namespace canopen::network_simulation {

/// Times in us.
struct FrameRow {
  Frame frame;  ///< the first one
  const VirtualBus::Endpoint* sender = nullptr;
  bool is_synchronous = false;
  std::uint64_t count = 0;
  std::uint64_t worst = 0;  ///< longest response time, to the end of the intermission
  std::uint64_t at = 0;     ///< when the frame with this response time ended
};

/// Counts from `begin` on; a frame that was queued earlier counts for the load alone.
class FrameStatistics {
 public:
  explicit FrameStatistics(const NetworkPlan& plan) : sync_can_id_{plan.sync_can_id} {
    for (const PlannedMessage& one : plan.messages) {
      FrameRow& row = rows_[arbitration_value({.id = one.can_id, .extended = one.extended, .remote = one.remote})];
      row.is_synchronous = one.is_synchronous;
    }
  }

  void begin(std::uint64_t now) { begin_ = now; }

  void add(const VirtualBus::Transmission& one) {
    if (one.ended <= begin_) return;
    add_busy(one);
    if (one.is_destroyed) {
      ++errors_;
      return;
    }
    const bool is_sync = one.frame.id == sync_can_id_ && !one.frame.extended;
    if (is_sync) syncs_[next_sync_++ % syncs_.size()] = {one.sender, one.queued, one.ended};
    if (one.queued < begin_) return;
    ++frames_;
    FrameRow& row = rows_[arbitration_value(one.frame)];
    if (row.count++ == 0) {
      row.frame = one.frame;
      row.sender = one.sender;
    }
    const std::uint64_t event = row.is_synchronous ? sync_before(one) : one.queued;
    if (one.ended - event <= row.worst) return;
    row.worst = one.ended - event;
    row.at = one.ended;
  }

  /// The row of a message; empty if it was not sent.
  [[nodiscard]] const FrameRow* find(const PlannedMessage& one) const {
    const auto at = rows_.find(arbitration_value({.id = one.can_id, .extended = one.extended, .remote = one.remote}));
    return at == rows_.end() || at->second.count == 0 ? nullptr : &at->second;
  }

  /// All rows, by priority.
  [[nodiscard]] std::map<std::uint64_t, FrameRow> sorted() const { return {rows_.begin(), rows_.end()}; }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t errors() const { return errors_; }
  /// Time in which the bus was not idle, error frames included.
  [[nodiscard]] std::uint64_t busy() const { return busy_; }
  /// The same in the second with the highest load.
  [[nodiscard]] std::uint64_t busiest_second() const { return std::max(busiest_, in_second_); }

 private:
  struct SyncTimes {
    const VirtualBus::Endpoint* sender = nullptr;
    std::uint64_t queued = 0;
    std::uint64_t ended = 0;
  };

  void add_busy(const VirtualBus::Transmission& one) {
    const std::uint64_t time = one.ended - std::max(one.started, begin_);
    busy_ += time;
    const std::uint64_t second = (one.ended - begin_) / 1'000'000;
    if (second != second_) {
      busiest_ = std::max(busiest_, in_second_);
      in_second_ = 0;
      second_ = second;
    }
    in_second_ += time;
  }

  /// When the SYNC that caused this frame had been queued: the last one that the sender had received, or had queued
  /// itself.
  [[nodiscard]] std::uint64_t sync_before(const VirtualBus::Transmission& one) const {
    for (std::size_t back = 1; back <= std::min(next_sync_, syncs_.size()); ++back) {
      const SyncTimes& sync = syncs_[(next_sync_ - back) % syncs_.size()];
      if ((sync.sender == one.sender ? sync.queued : sync.ended) <= one.queued) return sync.queued;
    }
    return one.queued;
  }

  std::uint32_t sync_can_id_;
  std::uint64_t begin_ = UINT64_MAX;
  std::unordered_map<std::uint64_t, FrameRow> rows_;
  std::array<SyncTimes, 16> syncs_{};
  std::size_t next_sync_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t errors_ = 0;
  std::uint64_t busy_ = 0;
  std::uint64_t busiest_ = 0;
  std::uint64_t second_ = 0;
  std::uint64_t in_second_ = 0;
};

}  // namespace canopen::network_simulation

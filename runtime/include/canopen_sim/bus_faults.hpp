/// Frames that a VirtualBus loses, repeats, delays and reorders on the way to one endpoint. Host side.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen_sim/virtual_bus.hpp"

namespace canopen {

/// Probability of each fault, 0..1.
struct BusFaultRates {
  double lost = 0;
  double repeated = 0;
  double delayed = 0;
  Duration longest_delay = std::chrono::milliseconds{2};
  /// Frames that are not delayed overtake those that are, and repetitions arrive later. If false, frames keep their
  /// order and are repeated at once, as on CAN.
  bool overtaking = false;
};

/// Inserts faults between the bus and an endpoint whose callbacks are set. It must live as long as the bus. The same
/// seed results in the same faults.
class BusFaults {
 public:
  BusFaults(VirtualBus::Endpoint& endpoint, BusFaultRates fault_rates, std::uint32_t seed)
      : rates{fault_rates},
        on_frame_{std::move(endpoint.on_frame)},
        on_time_{std::move(endpoint.on_time)},
        next_deadline_{std::move(endpoint.next_deadline)},
        random_{seed} {
    endpoint.on_frame = [this](const Frame& frame, TimePoint now) { take(frame, now); };
    endpoint.on_time = [this](TimePoint now) { on_time(now); };
    endpoint.next_deadline = [this] { return next_deadline(); };
  }
  BusFaults(const BusFaults&) = delete;
  BusFaults& operator=(const BusFaults&) = delete;

  /// Rates from now on.
  BusFaultRates rates;

 private:
  struct Held {
    TimePoint due;
    Frame frame;
  };

  void take(const Frame& frame, TimePoint now) {
    if (happens(rates.lost)) return;
    hand_on(frame, now, happens(rates.delayed));
    if (happens(rates.repeated)) hand_on(frame, now, rates.overtaking);
  }

  void hand_on(const Frame& frame, TimePoint now, bool late) {
    const bool waits = !rates.overtaking && !held_.empty();
    if (!late && !waits) return on_frame_(frame, now);
    TimePoint due = now + Duration{late ? random_() % (rates.longest_delay.count() + 1) : 0};
    if (waits) due = std::max(due, held_.back().due);
    const auto later = [](TimePoint time, const Held& held) { return time < held.due; };
    held_.insert(std::upper_bound(held_.begin(), held_.end(), due, later), {due, frame});
  }

  void on_time(TimePoint now) {
    while (!held_.empty() && held_.front().due <= now) {
      const Frame frame = held_.front().frame;
      held_.erase(held_.begin());
      on_frame_(frame, now);
    }
    if (on_time_) on_time_(now);
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next = next_deadline_ ? next_deadline_() : std::nullopt;
    if (!held_.empty() && (!next || held_.front().due < *next)) next = held_.front().due;
    return next;
  }

  [[nodiscard]] bool happens(double rate) { return std::uniform_real_distribution<>{}(random_) < rate; }

  std::function<void(const Frame&, TimePoint)> on_frame_;
  std::function<void(TimePoint)> on_time_;
  std::function<std::optional<TimePoint>()> next_deadline_;
  std::vector<Held> held_;  ///< by the time at which they are passed on
  std::mt19937 random_;
};

}  // namespace canopen

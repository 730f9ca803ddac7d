/// A CAN bus inside a process, with a time of its own: for tests, simulations and demonstrations. Host side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "canopen/arbitration.hpp"
#include "canopen/frame.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// Bits of a frame on the wire without stuff bits, from start of frame to the end of the intermission (ISO 11898-1).
[[nodiscard]] constexpr std::uint32_t bits_on_wire(const Frame& frame) {
  const std::uint32_t data = frame.remote ? 0u : 8u * frame.size;
  return (frame.extended ? 67u : 47u) + data;
}

/// Endpoints are attached to it; each frame that one sends comes to all others, lowest CAN-ID first among those that
/// wait. With a bit rate a frame takes its time on the wire; without one it takes none. Frames sent while others are
/// delivered wait their turn: there is no recursion.
class VirtualBus {
 public:
  /// One participant: a Bus for what it sends. It lives as long as the bus and does not move.
  class Endpoint {
   public:
    /// Takes a frame into the endpoint's queue; false when `queue_limit` frames wait already.
    bool send(const Frame& frame) {
      if (waiting_.size() >= queue_limit) return false;
      waiting_.push_back(frame);
      return true;
    }

    /// Called with each frame that another endpoint has sent.
    std::function<void(const Frame&, TimePoint now)> on_frame;
    /// Called when the time has come that `next_deadline` told.
    std::function<void(TimePoint now)> on_time;
    std::function<std::optional<TimePoint>()> next_deadline;
    /// Frames that may wait for the wire.
    std::size_t queue_limit = 16;

   private:
    friend class VirtualBus;
    std::deque<Frame> waiting_;
  };

  /// Called with each frame when it has passed the wire.
  using Listener = std::function<void(const Frame&, TimePoint now)>;

  VirtualBus() = default;
  /// Bits per second; 0: frames take no time.
  explicit VirtualBus(std::uint32_t bit_rate) : bit_rate_{bit_rate} {}
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  [[nodiscard]] Endpoint& attach() { return *endpoints_.emplace_back(std::make_unique<Endpoint>()); }

  /// Connects a node, built on this endpoint, with the frames and the time of the bus.
  template <class Node>
  static void connect(Endpoint& endpoint, Node& node) {
    endpoint.on_frame = [&node](const Frame& frame, TimePoint now) { node.on_frame(frame, now); };
    endpoint.on_time = [&node](TimePoint now) { node.on_time(now); };
    endpoint.next_deadline = [&node] { return node.next_deadline(); };
  }

  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  [[nodiscard]] TimePoint now() const { return now_; }

  /// How long this frame occupies the wire.
  [[nodiscard]] Duration duration_of(const Frame& frame) const {
    if (bit_rate_ == 0) return Duration{0};
    return Duration{static_cast<std::uint32_t>(std::uint64_t{bits_on_wire(frame)} * 1'000'000 / bit_rate_)};
  }

  /// Lets this time pass: frames and deadlines in their order, also those at the very end.
  void run_for(Duration span) {
    const TimePoint end = now_ + span;
    while (step(end)) {
    }
    now_ = end;
  }

  /// Delivers all frames that wait, and those that they cause, without waiting for deadlines. Gives up after
  /// `most` frames, as two endpoints may answer each other for ever; says how many there were.
  std::size_t settle(std::size_t most = 10'000) {
    std::size_t frames = 0;
    for (; frames < most; ++frames) {
      serve_deadlines();
      if (!begin_frame()) break;
      now_ = std::max(now_, wire_free_);
      end_frame();
    }
    return frames;
  }

 private:
  struct OnWire {
    Endpoint* sender;
    Frame frame;
  };

  /// Does what is next until `end`; false when nothing is.
  bool step(TimePoint end) {
    serve_deadlines();
    (void)begin_frame();
    std::optional<TimePoint> next = earliest_deadline();
    if (on_wire_ && (!next || wire_free_ <= *next)) next = wire_free_;
    if (!next || *next > end) return false;
    now_ = std::max(now_, *next);
    if (on_wire_ && wire_free_ <= now_) end_frame();
    return true;
  }

  void serve_deadlines() {
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
      Endpoint& endpoint = *endpoints_[i];
      if (!endpoint.next_deadline || !endpoint.on_time) continue;
      if (const auto deadline = endpoint.next_deadline(); deadline && *deadline <= now_) endpoint.on_time(now_);
    }
  }

  /// Of those to come: an endpoint that wants to be called again at once has to let time pass.
  [[nodiscard]] std::optional<TimePoint> earliest_deadline() const {
    std::optional<TimePoint> earliest;
    for (const auto& endpoint : endpoints_) {
      if (!endpoint->next_deadline) continue;
      const auto deadline = endpoint->next_deadline();
      if (deadline && *deadline > now_ && (!earliest || *deadline < *earliest)) earliest = deadline;
    }
    return earliest;
  }

  /// Arbitration: the frame with the lowest CAN-ID takes the wire if it is free.
  bool begin_frame() {
    if (on_wire_) return true;
    Endpoint* winner = nullptr;
    for (const auto& endpoint : endpoints_) {
      if (endpoint->waiting_.empty()) continue;
      if (winner == nullptr ||
          arbitration_value(endpoint->waiting_.front()) < arbitration_value(winner->waiting_.front())) {
        winner = endpoint.get();
      }
    }
    if (winner == nullptr) return false;
    on_wire_ = OnWire{winner, winner->waiting_.front()};
    winner->waiting_.pop_front();
    wire_free_ = now_ + duration_of(on_wire_->frame);
    return true;
  }

  void end_frame() {
    const OnWire done = *std::exchange(on_wire_, std::nullopt);
    for (const Listener& listener : listeners_) listener(done.frame, now_);
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
      Endpoint& endpoint = *endpoints_[i];
      if (&endpoint != done.sender && endpoint.on_frame) endpoint.on_frame(done.frame, now_);
    }
  }

  std::vector<std::unique_ptr<Endpoint>> endpoints_;
  std::vector<Listener> listeners_;
  std::optional<OnWire> on_wire_;
  TimePoint wire_free_{};
  TimePoint now_{};
  std::uint32_t bit_rate_ = 0;
};

}  // namespace canopen

/// A CAN bus inside a process, with a time of its own: for tests, simulations and demonstrations. Host side.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "canopen/arbitration.hpp"
#include "canopen/frame.hpp"
#include "canopen/port/key_tree.hpp"
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
///
/// The bus asks an endpoint for its deadline when it may have changed: at the beginning of `run_for` and `settle`, after
/// a frame has passed the wire, and after `on_time` or `send` of this endpoint. So an application may do with its
/// nodes what it likes between two calls of `run_for`, and in everything that a frame causes. Only `on_time` of one
/// endpoint that changes the node of another has to say so: `Endpoint::deadline_changed()`.
class VirtualBus {
 public:
  /// One participant: a Bus for what it sends. It lives as long as the bus and does not move.
  class Endpoint {
   public:
    /// Takes a frame into the endpoint's queue; false when `queue_limit` frames wait already.
    bool send(const Frame& frame) {
      if (waiting_.size() >= queue_limit) return false;
      waiting_.push_back(frame);
      if (waiting_.size() == 1) bus_.waits(*this);
      deadline_changed();
      return true;
    }

    /// Discards the frames that wait and the one on the wire, as a device that loses its power does.
    void discard() {
      waiting_.clear();
      bus_.waits(*this);
      if (bus_.on_wire_ && bus_.on_wire_->sender == this) bus_.on_wire_.reset();
      deadline_changed();
    }

    /// Has the bus ask for the deadline again. Needed in one case only: `on_time` of another endpoint has changed it.
    void deadline_changed() {
      if (!std::exchange(outdated_, true)) bus_.outdated_.push_back(place_);
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
    Endpoint(VirtualBus& bus, std::size_t place) : bus_{bus}, place_{place} {}

    VirtualBus& bus_;
    std::size_t place_;
    bool outdated_ = false;  ///< the bus does not know the deadline
    std::deque<Frame> waiting_;
  };

  /// Called with each frame when it has passed the wire.
  using Listener = std::function<void(const Frame&, TimePoint now)>;

  VirtualBus() = default;
  /// Bits per second; 0: frames take no time.
  explicit VirtualBus(std::uint32_t bit_rate) : bit_rate_{bit_rate} {}
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  [[nodiscard]] Endpoint& attach() {
    const std::size_t place = endpoints_.size();
    waiting_.resize(place + 1);
    deadlines_.resize(place + 1);
    Endpoint& endpoint = *endpoints_.emplace_back(new Endpoint{*this, place});
    endpoint.deadline_changed();
    return endpoint;
  }

  /// Connects a node, built on this endpoint, with the frames and the time of the bus.
  template <class Node>
  static void connect(Endpoint& endpoint, Node& node) {
    endpoint.on_frame = [&node](const Frame& frame, TimePoint now) { node.on_frame(frame, now); };
    endpoint.on_time = [&node](TimePoint now) { node.on_time(now); };
    endpoint.next_deadline = [&node] { return node.next_deadline(); };
  }

  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  [[nodiscard]] TimePoint now() const { return TimePoint{Duration{static_cast<std::uint32_t>(now_)}}; }

  /// Microseconds since the bus was made. Does not wrap.
  [[nodiscard]] std::uint64_t elapsed() const { return now_ - start_; }

  /// How long this frame occupies the wire.
  [[nodiscard]] Duration duration_of(const Frame& frame) const {
    if (bit_rate_ == 0) return Duration{0};
    return Duration{static_cast<std::uint32_t>(std::uint64_t{bits_on_wire(frame)} * 1'000'000 / bit_rate_)};
  }

  /// Lets this time pass: frames and deadlines in their order, also those at the very end.
  void run_for(Duration span) {
    const Time end = now_ + span.count();
    all_deadlines_changed();
    while (step(end)) {
    }
    now_ = std::max(now_, end);
  }

  /// Lets time pass as `run_for` does, at most until `done()` is true after a frame or a deadline: then time stands at that
  /// moment.
  template <std::predicate Done>
  void run_until(Done done, Duration span) {
    const Time end = now_ + span.count();
    all_deadlines_changed();
    while (!done()) {
      if (step(end)) continue;
      now_ = std::max(now_, end);
      return;
    }
  }

  /// Delivers all frames that wait, and those that they cause, without waiting for deadlines. Gives up after
  /// `most` frames, as two endpoints may answer each other for ever; says how many there were.
  std::size_t settle(std::size_t most = 10'000) {
    all_deadlines_changed();
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
  /// Microseconds, beginning where a moment before the first one is not negative. The low 32 bits are the TimePoint.
  using Time = KeyTree::Key;

  struct OnWire {
    Endpoint* sender;
    Frame frame;
  };

  /// Does what is next until `end`; false when nothing is.
  bool step(Time end) {
    serve_deadlines();
    (void)begin_frame();
    Time next = deadlines_.least();
    if (on_wire_) next = std::min(next, wire_free_);
    if (next > end) return false;
    now_ = std::max(now_, next);
    if (on_wire_ && wire_free_ <= now_) end_frame();
    return true;
  }

  /// Calls each endpoint whose time has come once. One that wants to be called again at once has to let time pass: it is
  /// asked again in the next step.
  void serve_deadlines() {
    ask_for_deadlines();
    for (std::size_t i = 0; (i = deadlines_.first_up_to(now_, i)) != KeyTree::no_place; ++i) {
      Endpoint& endpoint = *endpoints_[i];
      if (endpoint.on_time) endpoint.on_time(now());
      endpoint.deadline_changed();
      ask_for_deadlines();
    }
    for (std::size_t i = 0; (i = deadlines_.first_up_to(now_, i)) != KeyTree::no_place; ++i) {
      deadlines_.set(i, KeyTree::none);
      endpoints_[i]->deadline_changed();
    }
  }

  void ask_for_deadlines() {
    while (!outdated_.empty()) {
      Endpoint& endpoint = *endpoints_[outdated_.back()];
      outdated_.pop_back();
      endpoint.outdated_ = false;
      const auto deadline = endpoint.next_deadline ? endpoint.next_deadline() : std::nullopt;
      deadlines_.set(endpoint.place_, deadline ? time_of(*deadline) : KeyTree::none);
    }
  }

  void all_deadlines_changed() {
    for (const auto& endpoint : endpoints_) endpoint->deadline_changed();
  }

  /// Of a moment less than half of what a TimePoint counts away from now.
  [[nodiscard]] Time time_of(TimePoint moment) const {
    const auto ahead = static_cast<std::int32_t>((moment - now()).count());
    return now_ + static_cast<Time>(std::int64_t{ahead});
  }

  /// The endpoint's first waiting frame has become another one.
  void waits(const Endpoint& endpoint) {
    const bool any = !endpoint.waiting_.empty();
    waiting_.set(endpoint.place_, any ? arbitration_value(endpoint.waiting_.front()) : KeyTree::none);
  }

  /// Arbitration: the frame with the lowest CAN-ID takes the wire if it is free.
  bool begin_frame() {
    if (on_wire_) return true;
    if (waiting_.least() == KeyTree::none) return false;
    Endpoint& winner = *endpoints_[waiting_.first_up_to(waiting_.least())];
    on_wire_ = OnWire{&winner, winner.waiting_.front()};
    winner.waiting_.pop_front();
    waits(winner);
    winner.deadline_changed();  // it has room again
    wire_free_ = now_ + duration_of(on_wire_->frame).count();
    return true;
  }

  void end_frame() {
    const OnWire done = *std::exchange(on_wire_, std::nullopt);
    for (const Listener& listener : listeners_) listener(done.frame, now());
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
      Endpoint& endpoint = *endpoints_[i];
      if (&endpoint != done.sender && endpoint.on_frame) endpoint.on_frame(done.frame, now());
    }
    all_deadlines_changed();
  }

  std::vector<std::unique_ptr<Endpoint>> endpoints_;
  std::vector<Listener> listeners_;
  KeyTree waiting_;                    ///< what arbitration compares of each endpoint's first frame
  KeyTree deadlines_;                  ///< a Time for each endpoint, except for those in `outdated_`
  std::vector<std::size_t> outdated_;  ///< places of endpoints that have to be asked
  std::optional<OnWire> on_wire_;
  static constexpr Time start_ = Time{1} << 32;
  Time now_ = start_;
  Time wire_free_ = now_;
  std::uint32_t bit_rate_ = 0;
};

}  // namespace canopen

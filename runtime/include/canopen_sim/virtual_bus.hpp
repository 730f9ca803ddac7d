/// A CAN bus within a process, with its own time: for tests, simulations and demonstrations. Host side.
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

#include "canopen/base/clock.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/can/arbitration.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/frame_length.hpp"
#include "canopen/node/accepted_frames.hpp"
#include "canopen_sim/virtual/acceptance_table.hpp"
#include "canopen_sim/virtual/key_tree.hpp"

namespace canopen {

namespace virtual_bus_detail {

/// Whether a node of this type reports each use to its bus, and nothing else can change its deadline.
template <class NodeType>
struct Reports {
  static constexpr bool use = false;
};
template <class Device, class BusType, class... Handlers>
struct Reports<Node<Device, BusType, Handlers...>> {
  static constexpr bool use = true;
};

template <class NodeType>
consteval bool can_be_watched() {
  // A node for size may act later if it does not get a frame: node/idle_time.hpp.
  if constexpr (Reports<NodeType>::use) return !prefers_size && !NodeType::has_outer_deadlines();
  return false;
}

}  // namespace virtual_bus_detail

/// How a VirtualBus treats frames.
enum class WireModel : std::uint8_t {
  /// Frames have no stuff bits, and an endpoint sends its frames in their order.
  plain,
  /// Frames have the stuff bits of their contents, and an endpoint sends the waiting frame of highest priority first;
  /// those of one CAN-ID keep their order.
  exact,
};

/// A bus with endpoints: each frame that one sends is received by all others, lowest CAN-ID first among those that
/// wait. With a bit rate, a frame takes its time on the wire; without one it takes none. Frames sent while others are
/// delivered wait for their turn: there is no recursion.
///
/// The bus reads the deadline of an endpoint when it may have changed: at the beginning of `run_for` and `settle`,
/// after a frame has been transmitted, and after `on_time` or `send` of this endpoint. An application may therefore use
/// its nodes freely between two calls of `run_for`, and in all callbacks of a frame. Only if `on_time` of one endpoint
/// changes the node of another, `Endpoint::deadline_changed()` must be called.
///
/// A `Node` on its endpoint, connected by `connect`, reports each use to the bus: it gets only the frames that it
/// accepts, and its deadline is read again only if it may have changed. It is then in the state that it would have if
/// it had ignored the other frames. All other endpoints get each frame, and have their deadline read after each: those
/// with callbacks of their own or another class of node, and a node with a mailbox or a storage that is written in
/// steps, or whose `values()` or `entries()` the application has used. With many of them,
/// `assume_independent_endpoints()` makes a frame cost the time of its receivers alone.
class VirtualBus {
 public:
  class Endpoint;

  /// A callback of an endpoint. It is replaced by assignment, and read as a std::function.
  template <class Signature>
  class Callback {
   public:
    Callback(const Callback&) = delete;
    Callback& operator=(const Callback&) = delete;

    template <class Function = std::function<Signature>>
    requires std::constructible_from<std::function<Signature>, Function> Callback& operator=(Function&& function) {
      endpoint_.no_longer_watched();
      function_ = std::forward<Function>(function);
      endpoint_.bus_.update_acceptance(endpoint_);
      return *this;
    }

    [[nodiscard]] explicit operator bool() const { return static_cast<bool>(function_); }
    // NOLINTNEXTLINE(google-explicit-constructor): a callback can be kept and set again as a function
    operator std::function<Signature>() const { return function_; }

   private:
    friend class VirtualBus;
    friend class Endpoint;
    explicit Callback(Endpoint& endpoint) : endpoint_{endpoint} {}

    Endpoint& endpoint_;
    std::function<Signature> function_;
  };

  /// One participant: a Bus for the frames it sends. It lives as long as the bus and does not move.
  class Endpoint {
   public:
    /// Appends a frame to the endpoint's queue; false if `queue_limit` frames are already waiting.
    bool send(const Frame& frame) {
      if (waiting_.size() >= queue_limit) {
        if (is_watched_) bus_.attend(*this);
        return false;
      }
      const auto at = bus_.model_ == WireModel::plain ? waiting_.end() : after_more_dominant(frame);
      const bool is_first = at == waiting_.begin();
      waiting_.insert(at, Waiting{frame, bus_.elapsed()});
      if (is_first) bus_.waits(*this);
      deadline_changed();
      return true;
    }

    /// Returns the number of frames that wait for the wire.
    [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

    /// Whether the endpoint gets all frames, and its deadline is read after each of them.
    [[nodiscard]] bool gets_all_frames() const { return bus_.is_polled(*this); }

    /// Discards the waiting frames and the one on the wire, like a device that loses power.
    void discard() {
      waiting_.clear();
      bus_.waits(*this);
      if (bus_.on_wire_ && bus_.on_wire_->sender == this) bus_.on_wire_.reset();
      deadline_changed();
    }

    /// Makes the bus read deadline and accepted frames again. Only needed if `on_time` of another endpoint has changed
    /// them, or any callback of another endpoint after `assume_independent_endpoints()`.
    void deadline_changed() {
      if (!std::exchange(outdated_, true)) bus_.outdated_.push_back(place_);
    }

    /// Called with each frame that another endpoint has sent.
    Callback<void(const Frame&, TimePoint now)> on_frame{*this};
    /// Called when the time returned by `next_deadline` has come.
    Callback<void(TimePoint now)> on_time{*this};
    Callback<std::optional<TimePoint>()> next_deadline{*this};
    /// Appends the frames that `on_frame` does not ignore. Used for a node that `connect` has connected, and after
    /// `assume_independent_endpoints()`; an endpoint without this function receives all frames.
    Callback<void(std::vector<AcceptedFrame>&)> accepted_frames{*this};
    /// Maximum number of frames that wait for the wire.
    std::size_t queue_limit = 16;

    // ---- called by the node of this endpoint ----

    /// The application uses the node. Moves `of_node`, the time of its last call, to that of a later frame that the
    /// node ignores and did not get; returns whether there is one.
    bool node_is_used(TimePoint& of_node) {
      if ((!is_watched_ && !missed_) || questions_ != 0) return false;
      if (is_watched_ && calls_ == 0) bus_.attend(*this);
      const std::optional<TimePoint> missed = missed_frame();
      node_is_up_to_date();
      if (missed) of_node = *missed;
      return missed.has_value();
    }

    /// The node is called with its time.
    void node_is_called() {
      if (!is_watched_ && !missed_) return;
      if (is_watched_ && calls_ == 0) bus_.attend(*this);
      node_is_up_to_date();
    }

    /// The application can change values of the node from now on without a report.
    void node_is_exposed() {
      if (is_watched_ && questions_ == 0) no_longer_watched();
    }

    /// Returns the time of the last frame that the node ignores, or `of_node` if the node has been called since.
    [[nodiscard]] TimePoint time_of_node(TimePoint of_node) {
      reports_ = true;
      return missed_frame().value_or(of_node);
    }

   private:
    friend class VirtualBus;
    struct Waiting {
      Frame frame;
      std::uint64_t since;  ///< of `elapsed()`
    };

    Endpoint(VirtualBus& bus, std::size_t place) : bus_{bus}, place_{place} {}

    [[nodiscard]] std::deque<Waiting>::iterator after_more_dominant(const Frame& frame) {
      const auto is_before = [](std::uint64_t priority, const Waiting& one) {
        return priority < arbitration_value(one.frame);
      };
      return std::upper_bound(waiting_.begin(), waiting_.end(), arbitration_value(frame), is_before);
    }

    /// Makes a destroyed frame the next one again, after those that are more dominant by now.
    void repeat(const Waiting& destroyed) {
      const auto is_before = [](const Waiting& one, std::uint64_t priority) {
        return arbitration_value(one.frame) < priority;
      };
      const auto at = bus_.model_ == WireModel::plain ? waiting_.begin()
                                                      : std::lower_bound(waiting_.begin(), waiting_.end(),
                                                                         arbitration_value(destroyed.frame), is_before);
      waiting_.insert(at, destroyed);
      bus_.waits(*this);
    }

    /// Counts a call while it lasts.
    struct Count {
      explicit Count(unsigned& calls) : count{calls} { ++count; }
      Count(const Count&) = delete;
      Count& operator=(const Count&) = delete;
      ~Count() { --count; }
      unsigned& count;
    };

    /// Calls a callback, after which the bus reads the deadline again in any case.
    template <class Call>
    void call(Call&& call) {
      if (is_attended_) bus_.end_attention(*this);
      node_is_up_to_date();
      const Count count{calls_};
      call();
    }

    /// Returns whether a node of this endpoint has reported a use, once.
    [[nodiscard]] bool take_report() { return std::exchange(reports_, false); }

    void watch() {
      is_watched_ = true;
      node_is_up_to_date();
      bus_.watching_changed(*this);
      bus_.attend(*this);
    }
    void no_longer_watched() {
      if (!is_watched_) return;
      missed_ = missed_frame();
      is_watched_ = false;
      bus_.watching_changed(*this);
    }

    /// Returns the time of the last frame since the last call of the node. The node ignores this frame.
    [[nodiscard]] std::optional<TimePoint> missed_frame() const {
      if (!is_watched_) return missed_;
      const Passed& last = bus_.passed_to(*this).of_others(*this);
      return last.number > called_ ? std::optional{last.time} : std::nullopt;
    }
    void node_is_up_to_date() {
      called_ = bus_.passed_to(*this).last.number;
      missed_.reset();
    }

    VirtualBus& bus_;
    std::size_t place_;
    bool outdated_ = false;            ///< the bus must read the deadline again
    bool is_watched_ = false;          ///< the node reports each use
    bool is_attended_ = false;         ///< since a use, the bus has not called the node
    bool is_listed_ = false;           ///< in `used_`
    bool reports_ = false;             ///< the node has reported a use
    unsigned questions_ = 0;           ///< by the bus, for accepted frames
    unsigned calls_ = 0;               ///< by the bus, present ones
    std::uint64_t called_ = 0;         ///< number of the last frame before the last call of the node
    std::optional<TimePoint> missed_;  ///< when the endpoint was no longer watched
    std::deque<Waiting> waiting_;
  };

  /// A frame that was on the wire. Times are those of `elapsed()`.
  struct Transmission {
    Frame frame;
    const Endpoint* sender;
    std::uint64_t queued;   ///< when the sender queued it
    std::uint64_t started;  ///< of the present attempt
    std::uint64_t ended;    ///< of the intermission, or of the error frame
    bool is_destroyed;      ///< by an error: it is sent again
  };
  using Observer = std::function<void(const Transmission&)>;

  /// Called with each frame after its transmission.
  using Listener = std::function<void(const Frame&, TimePoint now)>;

  VirtualBus() = default;
  /// Bit rate in bit/s; 0: frames take no time.
  explicit VirtualBus(std::uint32_t bit_rate, WireModel model = WireModel::plain)
      : bit_rate_{bit_rate}, model_{model} {}
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  [[nodiscard]] Endpoint& attach() {
    const std::size_t place = endpoints_.size();
    waiting_.resize(place + 1);
    deadlines_.resize(place + 1);
    acceptance_.resize(place + 1);
    Endpoint& endpoint = *endpoints_.emplace_back(new Endpoint{*this, place});
    watching_changed(endpoint);
    endpoint.deadline_changed();
    return endpoint;
  }

  /// Connects a node, constructed with this endpoint, to the frames and the time of the bus.
  template <class NodeType>
  static void connect(Endpoint& endpoint, NodeType& node) {
    endpoint.on_frame = [&node](const Frame& frame, TimePoint now) { node.on_frame(frame, now); };
    endpoint.on_time = [&node](TimePoint now) { node.on_time(now); };
    endpoint.next_deadline = [&node] { return node.next_deadline(); };
    if constexpr (requires { for_each_accepted_frame(node, [](const AcceptedFrame&) {}); }) {
      endpoint.accepted_frames = [&node](std::vector<AcceptedFrame>& frames) {
        for_each_accepted_frame(node, [&frames](const AcceptedFrame& frame) { frames.push_back(frame); });
      };
    }
    if constexpr (virtual_bus_detail::can_be_watched<NodeType>()) {
      static_cast<void>(endpoint.take_report());
      static_cast<void>(node.now());
      if (endpoint.take_report()) endpoint.watch();  // otherwise, the node has another bus
    }
  }

  /// For large networks of nodes that do not report their use: declares that the callbacks of an endpoint, with the
  /// handlers of its node, use no other endpoint's node, and that listeners use none; where they do,
  /// `Endpoint::deadline_changed()` must be called. A frame is then passed only to the endpoints that accept it, and
  /// only their deadlines are read again. The frames on the bus and their times are the same.
  void assume_independent_endpoints() {
    independent_ = true;
    for (const auto& endpoint : endpoints_) {
      watching_changed(*endpoint);
      endpoint->deadline_changed();
    }
  }

  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  /// Calls `observer` when the wire becomes free, before the frame is received. It must not use the bus.
  void observe(Observer observer) { observer_ = std::move(observer); }

  /// Destroys the frame on the wire each time this interval has elapsed. An error costs `bits_of_error` and the frame,
  /// which is sent again; on an idle bus it has no effect. Interval 0: no further errors. Needs a bit rate.
  void make_errors(Duration interval) {
    error_interval_ = interval.count();
    next_error_ = now_ + error_interval_;
  }

  /// The longest time from an error to the next start of frame in bits (Davis and others, 2007, section 3.7).
  static constexpr std::uint32_t bits_of_error = 31;

  [[nodiscard]] TimePoint now() const { return TimePoint{Duration{static_cast<std::uint32_t>(now_)}}; }

  /// Returns the microseconds since the bus was created. Does not wrap.
  [[nodiscard]] std::uint64_t elapsed() const { return now_ - start_; }

  /// Returns how long this frame occupies the wire.
  [[nodiscard]] Duration duration_of(const Frame& frame) const {
    if (bit_rate_ == 0) return Duration{0};
    return duration_of(model_ == WireModel::plain ? bits_on_wire(frame) : stuffed_bits_on_wire(frame));
  }

  /// Lets this time pass: frames and deadlines in their order, including those at its end.
  void run_for(Duration span) {
    const Time end = now_ + span.count();
    begin_run();
    while (step(end)) {
    }
    now_ = std::max(now_, end);
  }

  /// Lets time pass like `run_for`, but stops when `done()` is true after a frame or a deadline.
  template <std::predicate Done>
  void run_until(Done done, Duration span) {
    const Time end = now_ + span.count();
    begin_run();
    while (!done()) {
      if (step(end)) continue;
      now_ = std::max(now_, end);
      return;
    }
  }

  /// Delivers all waiting frames, and those that they cause, without waiting for deadlines. Stops after `most` frames,
  /// because two endpoints may respond to each other indefinitely; returns their number.
  std::size_t settle(std::size_t most = 10'000) {
    begin_run();
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
  /// Microseconds, with an offset so that earlier times are not negative. The low 32 bits are the TimePoint.
  using Time = KeyTree::Key;

  /// A frame that has been passed to the endpoints.
  struct Passed {
    std::uint64_t number = 0;  ///< 1, 2, 3, ...
    TimePoint time{};
    const Endpoint* sender = nullptr;
  };
  /// The last frame, and the last one of another sender.
  struct PassedFrames {
    void add(const Endpoint* sender, TimePoint time) {
      if (sender != last.sender) before_sender = last;
      last = {last.number + 1, time, sender};
    }
    /// Returns the last frame that an endpoint has not sent itself.
    [[nodiscard]] const Passed& of_others(const Endpoint& endpoint) const {
      return last.sender != &endpoint ? last : before_sender;
    }
    Passed last;
    Passed before_sender;
  };

  struct OnWire {
    Endpoint* sender;
    Endpoint::Waiting waiting;
    std::uint64_t started;
    bool is_destroyed = false;
  };

  [[nodiscard]] Duration duration_of(std::uint32_t bits) const {
    return Duration{static_cast<std::uint32_t>(std::uint64_t{bits} * 1'000'000 / bit_rate_)};
  }

  /// Executes the next event until `end`; false if there is none.
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

  /// Calls each endpoint whose time has come once. One that wants to be called again at once is called in the
  /// next step.
  void serve_deadlines() {
    ask_for_deadlines();
    for (std::size_t i = 0; (i = deadlines_.first_up_to(now_, i)) != KeyTree::no_place; ++i) {
      Endpoint& endpoint = *endpoints_[i];
      if (endpoint.on_time) endpoint.call([&] { endpoint.on_time.function_(now()); });
      endpoint.deadline_changed();
      ask_for_deadlines();
    }
    for (std::size_t i = 0; (i = deadlines_.first_up_to(now_, i)) != KeyTree::no_place; ++i) {
      deadlines_.set(i, KeyTree::none);
      if (endpoints_[i]->is_watched_) attend(*endpoints_[i]);
      endpoints_[i]->deadline_changed();
    }
  }

  void ask_for_deadlines() {
    while (!outdated_.empty()) {
      Endpoint& endpoint = *endpoints_[outdated_.back()];
      outdated_.pop_back();
      endpoint.outdated_ = false;
      const auto deadline = endpoint.next_deadline ? endpoint.next_deadline.function_() : std::nullopt;
      deadlines_.set(endpoint.place_, deadline ? time_of(*deadline) : KeyTree::none);
      if (!is_polled(endpoint)) ask_for_accepted_frames(endpoint);
    }
  }

  void ask_for_accepted_frames(Endpoint& endpoint) {
    if (!endpoint.accepted_frames) return;  // it receives all of them
    accepted_.clear();
    {
      const Endpoint::Count question{endpoint.questions_};
      endpoint.accepted_frames.function_(accepted_);
    }
    acceptance_.accept(endpoint.place_, accepted_);
  }

  /// Whether an endpoint gets all frames and is asked for its deadline after each of them.
  [[nodiscard]] bool is_polled(const Endpoint& endpoint) const { return !independent_ && !endpoint.is_watched_; }

  void update_acceptance(const Endpoint& endpoint) {
    const bool has_list = !is_polled(endpoint) && endpoint.accepted_frames;
    acceptance_.accept_all(endpoint.place_, !has_list || endpoint.is_attended_);
  }

  void watching_changed(Endpoint& endpoint) {
    std::erase(polled_, endpoint.place_);
    if (is_polled(endpoint)) polled_.push_back(endpoint.place_);
    update_acceptance(endpoint);
  }

  /// The application has used the node of an endpoint: the node gets the next frame, and its deadline is read again
  /// when the application's turn has ended.
  void attend(Endpoint& endpoint) {
    if (!std::exchange(endpoint.is_listed_, true)) used_.push_back(endpoint.place_);
    endpoint.is_attended_ = true;
    update_acceptance(endpoint);
  }
  void end_attention(Endpoint& endpoint) {
    endpoint.is_attended_ = false;
    update_acceptance(endpoint);
  }

  /// The application may have used nodes.
  void deadlines_may_have_changed() {
    for (const std::size_t place : used_) {
      endpoints_[place]->is_listed_ = false;
      endpoints_[place]->deadline_changed();
    }
    used_.clear();
    for (const std::size_t place : polled_) endpoints_[place]->deadline_changed();
  }
  void begin_run() {
    deadlines_may_have_changed();
    if (!independent_) return;
    for (const auto& endpoint : endpoints_) endpoint->deadline_changed();
  }

  /// Returns the frames that an endpoint would have got if it accepted all.
  [[nodiscard]] const PassedFrames& passed_to(const Endpoint& endpoint) const {
    return endpoint.place_ <= passed_up_to_ ? passed_ : passed_before_;
  }

  /// Converts a time that is less than half the range of TimePoint away from now.
  [[nodiscard]] Time time_of(TimePoint moment) const {
    const auto ahead = static_cast<std::int32_t>((moment - now()).count());
    return now_ + static_cast<Time>(std::int64_t{ahead});
  }

  /// Updates arbitration after a change of the endpoint's first waiting frame.
  void waits(const Endpoint& endpoint) {
    const bool any = !endpoint.waiting_.empty();
    waiting_.set(endpoint.place_, any ? arbitration_value(endpoint.waiting_.front().frame) : KeyTree::none);
  }

  /// Starts the frame that wins arbitration, if the wire is free.
  bool begin_frame() {
    if (on_wire_) return true;
    if (waiting_.least() == KeyTree::none) return false;
    Endpoint& winner = *endpoints_[waiting_.first_up_to(waiting_.least())];
    on_wire_ = OnWire{&winner, winner.waiting_.front(), elapsed()};
    winner.waiting_.pop_front();
    waits(winner);
    winner.deadline_changed();  // it has room again
    wire_free_ = now_ + duration_of(on_wire_->waiting.frame).count();
    if (error_interval_ != 0) meet_error();
    return true;
  }

  /// Ends the frame on the wire with an error frame if the next error is due before its end.
  void meet_error() {
    if (next_error_ < now_)
      next_error_ += (now_ - next_error_ + error_interval_ - 1) / error_interval_ * error_interval_;
    if (next_error_ >= wire_free_) return;
    on_wire_->is_destroyed = true;
    wire_free_ = next_error_ + duration_of(bits_of_error).count();
    next_error_ += error_interval_;
  }

  void end_frame() {
    const OnWire done = *std::exchange(on_wire_, std::nullopt);
    if (observer_) {
      observer_({done.waiting.frame, done.sender, done.waiting.since, done.started, elapsed(), done.is_destroyed});
    }
    if (done.is_destroyed) return done.sender->repeat(done.waiting);
    for (const Listener& listener : listeners_) listener(done.waiting.frame, now());
    if (independent_) ask_for_deadlines();  // a listener may have changed which frames are accepted
    pass(done);
    deadlines_may_have_changed();
    done.sender->deadline_changed();
  }

  void pass(const OnWire& done) {
    const bool to_all = now_ - passed_to_all_ >= longest_pause;
    if (to_all) passed_to_all_ = now_;
    passed_before_ = passed_;
    passed_.add(done.sender, now());
    const auto next_after = [&](std::size_t place) {
      if (!to_all) return acceptance_.first_receiver(done.waiting.frame, place);
      return place < endpoints_.size() ? place : AcceptanceTable::no_place;
    };
    for (std::size_t i = 0; (i = next_after(i)) != AcceptanceTable::no_place; ++i) {
      Endpoint& endpoint = *endpoints_[i];
      passed_up_to_ = i;
      if (&endpoint != done.sender && endpoint.on_frame) {
        endpoint.call([&] { endpoint.on_frame.function_(done.waiting.frame, now()); });
      }
      endpoint.deadline_changed();
    }
    passed_up_to_ = AcceptanceTable::no_place;
  }

  std::vector<std::unique_ptr<Endpoint>> endpoints_;
  std::vector<Listener> listeners_;
  KeyTree waiting_;                    ///< arbitration value of each endpoint's first frame
  KeyTree deadlines_;                  ///< a Time for each endpoint, except those in `outdated_`
  std::vector<std::size_t> outdated_;  ///< positions of endpoints whose deadline must be read
  std::optional<OnWire> on_wire_;
  std::vector<std::size_t> polled_;  ///< endpoints that get all frames
  std::vector<std::size_t> used_;    ///< endpoints whose nodes the application has used
  PassedFrames passed_;
  PassedFrames passed_before_;  ///< without the frame that is being passed
  std::size_t passed_up_to_ = AcceptanceTable::no_place;
  AcceptanceTable acceptance_;           ///< of endpoints with a list, except those in `outdated_`
  std::vector<AcceptedFrame> accepted_;  ///< of the endpoint that is being asked
  bool independent_ = false;
  static constexpr Time start_ = Time{1} << 32;
  /// A node compares times that are less than 35 minutes apart: each one gets a frame in a quarter of an hour.
  static constexpr Time longest_pause = 900'000'000;
  Time now_ = start_;
  Time passed_to_all_ = start_;  ///< when all endpoints have received a frame
  Time wire_free_ = now_;
  std::uint32_t bit_rate_ = 0;
  WireModel model_ = WireModel::plain;
  Observer observer_;
  Time error_interval_ = 0;  ///< 0: there are no errors
  Time next_error_ = 0;
};

}  // namespace canopen

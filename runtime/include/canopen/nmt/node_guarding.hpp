/// Node guarding and life guarding (CiA 301, 7.2.8.3.2.1): the guarded node, and the NMT master that guards it.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Whether a frame is a guarding request for this node: a remote frame with CAN-ID 700h + node-ID, of any length.
[[nodiscard]] constexpr bool is_guarding_request(const Frame& frame, NodeId node_id) {
  return frame.remote && !frame.extended && frame.id == function_code::error_control + std::uint32_t{node_id.value()};
}

/// The slave's side: responds to requests with state and toggle bit, and monitors them. The first one starts life
/// guarding; if none is received for the guard time 100Ch times the life time factor 100Dh, both not 0, a life guarding
/// event occurs: EMCY 8130h. It ends with the next request.
///
/// A node uses either guarding or heartbeat: while 1017h is not 0, requests are not passed to this class or answered.
class NodeGuardingSlave {
 public:
  /// Resets the state, after a reset of communication or when 1017h enables the heartbeat: nothing is sent or
  /// monitored, the toggle bit is 0.
  void reset() { *this = NodeGuardingSlave{}; }

  /// Processes a request. `serve` sends the response; requests that are received before it is sent share it.
  void on_request(std::uint16_t guard_time, std::uint8_t life_time_factor, TimePoint now) {
    answer_due_ = true;
    failed_ = false;
    left_ = guard_time != 0 ? life_time_factor : std::uint8_t{0};
    deadline_ = now + from_milliseconds(guard_time);
  }

  /// Handles a write to 100Ch or 100Dh. If either is 0, life guarding and its event end; other values are used from the
  /// next request or guard time on.
  void configure(std::uint16_t guard_time, std::uint8_t life_time_factor) {
    if (guard_time != 0 && life_time_factor != 0) return;
    left_ = 0;
    failed_ = false;
  }

  /// Sends the response if one is due. Returns false if the bus had no room; it remains due.
  template <Bus BusType>
  bool serve(BusType& bus, NodeId node_id, NmtState state) {
    if (!answer_due_) return true;
    Frame frame{};
    frame.id = function_code::error_control + std::uint32_t{node_id.value()};
    frame.size = 1;
    frame.data[0] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(state) | (toggle_ ? 0x80 : 0));
    if (!bus.send(frame)) return false;
    answer_due_ = false;
    toggle_ = !toggle_;
    return true;
  }

  /// Returns true if the life time has just elapsed. It is counted in guard times, because it may be too long for
  /// `TimePoint`.
  [[nodiscard]] bool on_time(std::uint16_t guard_time, TimePoint now) {
    while (left_ != 0 && now >= deadline_) {
      deadline_ = deadline_ + from_milliseconds(guard_time);
      if (--left_ == 0) failed_ = true;
      if (failed_) return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return left_ != 0 ? std::optional{deadline_} : std::nullopt;
  }

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_answer() const { return answer_due_; }

  /// Whether the life time has elapsed and no request has been received since.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  TimePoint deadline_{};   ///< end of the present guard time
  std::uint8_t left_ = 0;  ///< remaining guard times of the life time, including the present one; 0: not monitored
  bool toggle_ = false;
  bool answer_due_ = false;
  bool failed_ = false;
};

/// Events of a guarded node.
enum class GuardingEvent : std::uint8_t {
  started,           ///< its first response
  state_changed,     ///< a response contains a different NMT state than the previous one
  boot_up,           ///< its boot-up message
  toggle_error,      ///< a response with the same toggle bit as the previous one; it is ignored
  unexpected_state,  ///< node guarding event: the state is not the one that the master has commanded
  lost,              ///< node guarding event: no response within the life time
  back,              ///< the first response after it was lost
};

/// The master's side, for one node: sends a request every guard time. The node is lost if it does not respond to
/// `life_time_factor` consecutive requests, which is the life time after the first of them; requests continue. A factor
/// of 0 counts as 1.
///
/// Events are reported to the master: `host.happened(GuardingEvent, NodeId, NmtState)`, with the last reported state.
class NodeGuardingMaster {
 public:
  /// Starts guarding: the first request is due at once. The guard time is in ms, 1..65535.
  void start(NodeId node_id, std::uint16_t guard_time, std::uint8_t life_time_factor, TimePoint now) {
    *this = NodeGuardingMaster{};
    node_id_ = node_id;
    guard_time_ = guard_time;
    life_time_factor_ = life_time_factor != 0 ? life_time_factor : std::uint8_t{1};
    running_ = true;
    due_ = now;
  }

  /// Stops sending requests.
  void stop() { running_ = false; }

  /// Sets the state that the node has been commanded to enter: responses to later requests are compared with it.
  void expect(NmtState state) {
    expected_ = LastState{state};
    comparable_ = false;
    unexpected_ = false;
  }

  /// Processes a message of any node.
  template <class Host>
  void on_message(const ErrorControlMessage& message, Host&& host) {
    if (!running_ || message.node_id != node_id_) return;
    if (message.state == NmtState::initialisation) return booted(host);
    if (toggle_known_ && message.toggle != toggle_) return tell(GuardingEvent::toggle_error, host);
    toggle_known_ = true;
    toggle_ = !message.toggle;
    awaiting_ = false;
    missed_ = 0;
    take_state(message.state, host);
  }

  /// Reports a request without a response, and sends the next one, if it is due. Returns false if the bus had no room;
  /// it remains due.
  template <Bus BusType, class Host>
  bool serve(BusType& bus, TimePoint now, Host&& host) {
    if (!running_ || now < due_) return true;
    if (awaiting_) miss(host);
    if (!running_) return true;  // the host may have stopped guarding a lost node
    Frame frame{};
    frame.id = function_code::error_control + std::uint32_t{node_id_.value()};
    frame.size = 1;
    frame.remote = true;
    if (!bus.send(frame)) return false;
    awaiting_ = true;
    comparable_ = true;
    due_ = due_ + from_milliseconds(guard_time_);
    if (now >= due_) due_ = now + from_milliseconds(guard_time_);  // called so late that whole guard times are missing
    return true;
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return running_ ? std::optional{due_} : std::nullopt; }

  /// Returns the last state that the node reported; empty before its first response and while it is lost.
  [[nodiscard]] std::optional<NmtState> state() const {
    if (!running_ || lost_ || !last_.known()) return std::nullopt;
    return last_.state();
  }

 private:
  template <class Host>
  void tell(GuardingEvent event, Host&& host) const {
    host.happened(event, node_id_, last_.state());
  }

  /// Handles the boot-up message. The toggle bit starts with 0 again (CiA 301: it is reset with the communication).
  template <class Host>
  void booted(Host&& host) {
    toggle_known_ = true;
    toggle_ = false;
    last_ = LastState{NmtState::initialisation};
    expected_ = LastState{};
    tell(GuardingEvent::boot_up, host);
  }

  template <class Host>
  void take_state(NmtState state, Host&& host) {
    const LastState before = last_;
    last_ = LastState{state};
    if (lost_) {
      lost_ = false;
      tell(GuardingEvent::back, host);
    } else if (!before.known()) {
      tell(GuardingEvent::started, host);
    } else if (before != last_) {
      tell(GuardingEvent::state_changed, host);
    }
    const bool unexpected = expected_.known() && comparable_ && last_ != expected_;
    if (unexpected && !unexpected_) tell(GuardingEvent::unexpected_state, host);
    unexpected_ = unexpected;
  }

  template <class Host>
  void miss(Host&& host) {
    awaiting_ = false;
    if (lost_ || ++missed_ < life_time_factor_) return;
    lost_ = true;
    toggle_known_ = false;
    tell(GuardingEvent::lost, host);
  }

  TimePoint due_{};  ///< when the next request is sent
  std::uint16_t guard_time_ = 0;
  NodeId node_id_{};
  std::uint8_t life_time_factor_ = 0;
  std::uint8_t missed_ = 0;  ///< requests without a response since the last response
  LastState last_{};
  LastState expected_{};
  bool running_ = false;
  bool awaiting_ = false;
  bool toggle_ = false;  ///< expected in the next response
  bool toggle_known_ = false;
  bool comparable_ = false;  ///< the present request was sent after the command
  bool unexpected_ = false;
  bool lost_ = false;
};

}  // namespace canopen

/// Error control of the slaves of an NMT master, by heartbeat or node guarding (CiA 301, 7.2.8.2.2; CiA 302-2).
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt/node_guarding.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master_event.hpp"

namespace canopen {

/// Monitors up to `Count` slaves: those with a heartbeat time by heartbeat, others with a guard time by guarding. The
/// entry of a slave in the network list is passed to the calls that need it. Events go to a function
/// `happened(NmtMasterEvent, NodeId, NmtState)` of the listener.
template <std::size_t Count>
class SlaveErrorControl {
 public:
  /// Returns the last state of a slave; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state_of(std::size_t i, const NmtSlave& slave) const {
    return slave.beats() ? heartbeats_.state_of(slave.node_id) : guards_[i].state();
  }

  /// Monitors the slave from its next heartbeat on.
  void watch_heartbeat(std::size_t i, const NmtSlave& slave) {
    heartbeats_.configure(i, ConsumerHeartbeatTime{slave.node_id, slave.heartbeat_time});
  }

  /// Starts to send guarding requests; to a slave without guarding times only to learn its state.
  void start_guarding(std::size_t i, const NmtSlave& slave, TimePoint now) {
    constexpr std::uint16_t inquiry_time = 100;  // ms
    constexpr std::uint8_t inquiries = 3;
    if (slave.guarded()) return guards_[i].start(slave.node_id, slave.guard_time(), slave.life_time_factor(), now);
    guards_[i].start(slave.node_id, inquiry_time, inquiries, now);
  }
  void stop_guarding(std::size_t i) { guards_[i].stop(); }

  /// Stops monitoring a slave that is being reset or booted. One that is lost is still reported when it comes back.
  void stop(std::size_t i, const NmtSlave& slave) {
    guards_[i].stop();
    commanded_[i] = LastState{};
    if (heartbeats_.state_of(slave.node_id)) watch_heartbeat(i, slave);
  }

  /// Expects the state of a slave that it enters with a command.
  void expect_after(NmtCommand command, std::size_t i) {
    switch (command) {
      case NmtCommand::start: return expect(i, NmtState::operational);
      case NmtCommand::stop: return expect(i, NmtState::stopped);
      case NmtCommand::enter_pre_operational: return expect(i, NmtState::pre_operational);
      case NmtCommand::reset_node:
      case NmtCommand::reset_communication: commanded_[i] = LastState{}; return;
    }
  }

  /// Processes a message of a slave.
  template <class Listener>
  void on_message(const ErrorControlMessage& message, std::size_t i, TimePoint now, Listener&& listener) {
    heartbeats_.on_message(message, now, Watch<Listener>{listener, commanded_[i]});
    guards_[i].on_message(message, Watch<Listener>{listener});
  }

  /// Reports lost heartbeats.
  template <class Listener>
  void on_time(TimePoint now, Listener&& listener) {
    heartbeats_.on_time(now, Watch<Listener>{listener});
  }

  /// Sends the guarding request to a slave when it is due, and reports missing responses.
  template <Bus BusType, class Listener>
  void serve(BusType& bus, std::size_t i, TimePoint now, Listener&& listener) {
    (void)guards_[i].serve(bus, now, Watch<Listener>{listener});
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_heartbeat() const { return heartbeats_.next_deadline(); }
  /// Returns when `serve` is next due for a slave.
  [[nodiscard]] std::optional<TimePoint> next_guarding(std::size_t i) const { return guards_[i].next_deadline(); }

 private:
  /// Forwards the events of heartbeats and guarding. Boot-up messages are reported by the master, monitored or not.
  template <class Listener>
  struct Watch {
    Listener& listener;
    LastState commanded{};  ///< unknown if there was no command since the boot-up

    void happened(HeartbeatEvent event, NodeId node_id, NmtState state) {
      switch (event) {
        case HeartbeatEvent::boot_up: return;
        case HeartbeatEvent::started: return listener.happened(NmtMasterEvent::state_changed, node_id, state);
        case HeartbeatEvent::state_changed:
          listener.happened(NmtMasterEvent::state_changed, node_id, state);
          if (!commanded.known() || commanded.state() == state) return;
          return listener.happened(NmtMasterEvent::unexpected_state, node_id, state);
        case HeartbeatEvent::back: return listener.happened(NmtMasterEvent::back, node_id, state);
        case HeartbeatEvent::lost: return listener.happened(NmtMasterEvent::lost, node_id, state);
      }
    }

    void happened(GuardingEvent event, NodeId node_id, NmtState state) {
      switch (event) {
        case GuardingEvent::boot_up: return;
        case GuardingEvent::started:
        case GuardingEvent::state_changed: return listener.happened(NmtMasterEvent::state_changed, node_id, state);
        case GuardingEvent::toggle_error: return listener.happened(NmtMasterEvent::toggle_error, node_id, state);
        case GuardingEvent::unexpected_state:
          return listener.happened(NmtMasterEvent::unexpected_state, node_id, state);
        case GuardingEvent::back: return listener.happened(NmtMasterEvent::back, node_id, state);
        case GuardingEvent::lost: return listener.happened(NmtMasterEvent::lost, node_id, state);
      }
    }
  };

  void expect(std::size_t i, NmtState state) {
    guards_[i].expect(state);
    commanded_[i] = LastState{state};
  }

  std::array<NodeGuardingMaster, Count> guards_{};
  std::array<LastState, Count> commanded_{};
  HeartbeatConsumer<Count> heartbeats_{};
};

}  // namespace canopen

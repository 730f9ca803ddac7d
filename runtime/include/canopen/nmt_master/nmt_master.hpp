/// NMT master: commands, boot-up of a list of slaves, and their error control (CiA 301, 7.2.8; CiA 302-2).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt/node_guarding.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/identity_check.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master_event.hpp"
#include "canopen/sdo/sdo_client.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// Boots up to `Count` slaves and monitors them (CiA 302-2, boot NMT slave). Each slave is reset. After its boot-up
/// message, or after a second because the message may have been missed, it is
///   1. identified by SDO; a wrong identity ends the boot-up until the next boot-up message,
///   2. configured: its concise DCF (1F22h) is written, then the application configures it,
///   3. given its heartbeat time: if the list has one, 1017h is read, and written if it is 0 or too long,
///   4. monitored by heartbeat or guarding, and
///   5. started.
/// A slave that does not respond is tried again every second, after a command to enter Pre-operational, because SDO is
/// not available in Stopped. A slave with `keep_alive` that is already Operational is not reset or configured;
/// detecting this requires heartbeat or guarding. The network is started when all mandatory slaves have booted; later
/// slaves are booted when they appear.
///
/// The master and the application share the SDO of a slave: `request` appends a transfer to the queue of its node,
/// which the boot-up uses as well. Up to `Clients` nodes are served at the same time; up to `Requests` requests of the
/// application may wait. The boot-up message of a slave ends all requests to it with 0800 0022h.
///
/// Functions of the application that the master calls (`Host`):
///   happened(NmtMasterEvent, NodeId, NmtState)   with the last reported state
///   configure(NodeId)                            optional: configure the slave now, with any number of requests, then
///                                                call `configured`; called again after the next boot-up of the slave
///   booted(NodeId, BootResult)                   how a boot-up ended; no_response: the slave is tried again. A Host
///                                                may accept a BootStatus instead
///   network_started()                            unless 1F80h forbids it, the master's own device may be started now
///   boot_time_elapsed()                          a mandatory slave is missing; the master keeps waiting for it
template <Bus B, std::size_t Count, class Host, std::size_t Requests = 4, std::size_t Clients = (Count < 4 ? Count : 4)>
class NmtMaster {
 public:
  /// Manages the first `Count` of `slaves`, which must outlive the master. Bit 0 of 1F81h must be set in the slaves
  /// that are to be booted.
  constexpr NmtMaster(B& can_bus, std::span<const NmtSlave> slaves, NmtStartUp start_up, SdoClientOptions options,
                      Host host)
      : bus_{can_bus},
        slaves_{slaves.first(std::min(slaves.size(), Count))},
        start_up_{start_up},
        host_{std::move(host)},
        sdo_{can_bus, options} {}
  constexpr NmtMaster(B& can_bus, std::span<const NmtSlave> slaves, NmtStartUp start_up, Duration sdo_timeout,
                      Host host)
      : NmtMaster{can_bus, slaves, start_up, SdoClientOptions{.timeout = sdo_timeout}, std::move(host)} {}
  NmtMaster(const NmtMaster&) = delete;
  NmtMaster& operator=(const NmtMaster&) = delete;

  /// Starts the boot-up: resets the communication of all nodes, or of each slave that is not to be kept alive.
  void start(TimePoint now) {
    now_ = now;
    const bool reset_each = std::ranges::any_of(slaves_, [](const NmtSlave& slave) {
      return slave.has(slave_assignment::listed) && slave.has(slave_assignment::keep_alive);
    });
    begin(reset_each ? std::nullopt : std::optional{NmtCommand::reset_communication});
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (!reset_each || !slaves_[i].has(slave_assignment::listed)) continue;
      if (slaves_[i].has(slave_assignment::keep_alive)) {
        identify(i);
      } else {
        entries_[i].command = NmtCommand::reset_communication;
        entries_[i].was_reset = true;
      }
    }
    serve();
  }

  /// Resets the communication of one slave and boots it again, for instance after a failure.
  void boot(NodeId node_id, TimePoint now) {
    now_ = now;
    if (const std::optional<std::size_t> i = find(node_id)) reset(*i, NmtCommand::reset_communication);
    serve();
  }

  /// Reports that the application has configured a slave, after `configure` of the host: `ok`, or the abort code. Has
  /// no effect if the slave has been lost, reset or booted up in the meantime.
  void configured(NodeId node_id, AbortCode result, TimePoint now) {
    now_ = now;
    const std::optional<std::size_t> i = find(node_id);
    if (!i || entries_[*i].step != Step::configuring) return;
    if (result == AbortCode::timeout) {
      retry(*i, {BootStatus::no_response, result});
    } else if (result != ok) {
      finish(*i, {BootStatus::configuration, result});
    } else {
      prepare_heartbeat(*i);
    }
    serve();
  }

  /// Appends a transfer of the application to the queue of a node, listed or not. Its memory is used until `done`
  /// has been called, which happens with 0800 0022h if a slave of the list boots up. 060A 0023h: `Requests` are
  /// already waiting.
  Result<void> request(NodeId node_id, const SdoRequest& what, TimePoint now) {
    if (sdo_.waiting(this) >= Requests) return AbortCode::no_resource;
    return sdo_.submit(node_id, what, now);
  }

  /// Sends a command to one node, or to all nodes with node-ID 0. Returns false if the bus had no room; it is not sent.
  [[nodiscard]] bool command(NmtCommand command, NodeId node_id) {
    if (!bus_.send(nmt_frame(command, node_id))) return false;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (node_id.value() == 0 || slaves_[i].node_id == node_id) expect_after(command, i);
    }
    return true;
  }

  /// Processes a frame from the bus.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    sdo_.on_frame(frame, now);
    if (const std::optional<ErrorControlMessage> message = error_control_message(frame)) on_message(*message);
    serve();
  }

  /// Processes elapsed time. Call it at `next_deadline()` and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    sdo_.on_time(now);
    heartbeats_.on_time(now, Watch{*this});
    if (booting_ && !network_started_ && boot_time_runs_ && now >= boot_deadline_) {
      boot_time_runs_ = false;
      host_.boot_time_elapsed();
    }
    serve();
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (all_command_) return now_;
    std::optional<TimePoint> next = heartbeats_.next_deadline();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    consider(sdo_.next_deadline(std::any_of(entries_.begin(), entries_.end(), wants_sdo)));
    if (booting_ && !network_started_ && boot_time_runs_) consider(boot_deadline_);
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (entries_[i].command) return now_;
      consider(guards_[i].next_deadline());
      if (entries_[i].step == Step::waiting || entries_[i].step == Step::starting_error_control) {
        consider(entries_[i].deadline);
      }
    }
    return next;
  }

  /// Whether all mandatory slaves have booted.
  [[nodiscard]] bool network_started() const { return network_started_; }

  /// Returns how the last boot-up of a slave ended; empty before that.
  [[nodiscard]] std::optional<BootStatus> status(NodeId node_id) const {
    const std::optional<std::size_t> i = find(node_id);
    return i ? entries_[*i].status : std::nullopt;
  }

  /// Returns the last state that a slave reported by heartbeat or guarding; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const {
    const std::optional<std::size_t> i = find(node_id);
    return i ? state_of(*i) : std::nullopt;
  }

  /// Whether a node, listed or not, has sent a boot-up message since the master was constructed.
  [[nodiscard]] bool has_booted(NodeId node_id) const {
    return (boot_ups_[node_id.value() / 32u] >> (node_id.value() % 32u) & 1u) != 0;
  }

 private:
  static constexpr Duration retry_time = std::chrono::seconds{1};
  static constexpr std::size_t checks = std::size(identity_checks);

  enum class Step : std::uint8_t {
    idle,                    ///< not started, or ended
    waiting,                 ///< for a boot-up message, or for the next attempt without one
    identifying,             ///< reading the number `check`, or about to read it
    downloading,             ///< writing the entry of the concise DCF at `position`
    configuring,             ///< by the application
    reading_heartbeat_time,  ///< of 1017h
    writing_heartbeat_time,
    starting_error_control,  ///< waiting for the first heartbeat or guarding response
  };

  struct Entry {
    TimePoint deadline{};
    std::array<std::uint8_t, 4> number{};  ///< read or written value
    std::uint32_t position = 0;            ///< of the entry of the concise DCF that is being written
    std::uint32_t left = 0;                ///< remaining entries of the concise DCF
    std::optional<NmtCommand> command{};   ///< waiting to be sent
    std::optional<BootStatus> status{};
    Step step = Step::idle;
    std::uint8_t check = 0;
    bool asked = false;      ///< a request of the master is in the queue
    bool dropped = false;    ///< its response will be ignored
    bool booted_up = false;  ///< its boot-up message has been received: it is served before slaves that do not respond
    bool silent = false;     ///< it has not responded
    bool was_reset = false;
    bool beats_in_time = false;  ///< 1017h is shorter than the consumer's time
    bool complete = false;       ///< has booted and is not lost
  };

  [[nodiscard]] static bool wants_sdo(const Entry& entry) {
    switch (entry.step) {
      case Step::identifying:
      case Step::downloading:
      case Step::reading_heartbeat_time:
      case Step::writing_heartbeat_time: return !entry.asked;
      case Step::idle:
      case Step::waiting:
      case Step::configuring:
      case Step::starting_error_control: return false;
    }
    return false;
  }

  /// Forwards the events of heartbeats and guarding.
  struct Watch {
    NmtMaster& master;

    void happened(HeartbeatEvent event, NodeId node_id, NmtState state) {
      switch (event) {
        case HeartbeatEvent::boot_up: return;  // reported for all nodes, monitored or not
        case HeartbeatEvent::started:
        case HeartbeatEvent::state_changed: return master.tell(NmtMasterEvent::state_changed, node_id, state);
        case HeartbeatEvent::back: return master.tell(NmtMasterEvent::back, node_id, state);
        case HeartbeatEvent::lost: return master.on_lost(node_id, state);
      }
    }

    void happened(GuardingEvent event, NodeId node_id, NmtState state) {
      switch (event) {
        case GuardingEvent::boot_up: return;
        case GuardingEvent::started:
        case GuardingEvent::state_changed: return master.tell(NmtMasterEvent::state_changed, node_id, state);
        case GuardingEvent::toggle_error: return master.tell(NmtMasterEvent::toggle_error, node_id, state);
        case GuardingEvent::unexpected_state: return master.tell(NmtMasterEvent::unexpected_state, node_id, state);
        case GuardingEvent::back: return master.tell(NmtMasterEvent::back, node_id, state);
        case GuardingEvent::lost: return master.on_lost(node_id, state);
      }
    }
  };

  void tell(NmtMasterEvent event, NodeId node_id, NmtState state) { host_.happened(event, node_id, state); }

  // The list

  [[nodiscard]] std::optional<std::size_t> find(NodeId node_id) const {
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (slaves_[i].node_id == node_id && slaves_[i].has(slave_assignment::listed)) return i;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool beats(std::size_t i) const { return slaves_[i].heartbeat_time != 0; }
  [[nodiscard]] bool is_guarded(std::size_t i) const { return !beats(i) && slaves_[i].guard_time() != 0; }

  [[nodiscard]] std::optional<NmtState> state_of(std::size_t i) const {
    return beats(i) ? heartbeats_.state_of(slaves_[i].node_id) : guards_[i].state();
  }

  /// Starts all slaves from the beginning, after a command to all nodes if there is one.
  void begin(std::optional<NmtCommand> to_all) {
    booting_ = true;
    network_started_ = false;
    all_command_ = to_all;
    boot_time_runs_ = start_up_.boot_time.count() != 0;
    boot_deadline_ = now_ + start_up_.boot_time;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      const bool asked = entries_[i].asked;
      entries_[i] = Entry{};
      entries_[i].asked = entries_[i].dropped = asked;
      entries_[i].was_reset = to_all.has_value();
      guards_[i].stop();
      if (!slaves_[i].has(slave_assignment::listed)) continue;
      watch_heartbeat(i);
      wait(i);
    }
    check_network();
  }

  // The boot-up steps of one slave

  void wait(std::size_t i) {
    entries_[i].step = Step::waiting;
    entries_[i].dropped = entries_[i].asked;
    entries_[i].deadline = now_ + retry_time;
  }

  /// Monitors the slave from its next heartbeat on.
  void watch_heartbeat(std::size_t i) {
    heartbeats_.configure(i, ConsumerHeartbeatTime{slaves_[i].node_id, slaves_[i].heartbeat_time});
  }

  /// Stops monitoring a slave that is being reset or booted. One that is lost is still reported when it comes back.
  void stop_watching(std::size_t i) {
    guards_[i].stop();
    if (heartbeats_.state_of(slaves_[i].node_id)) watch_heartbeat(i);
  }

  void reset(std::size_t i, NmtCommand command) {
    stop_watching(i);
    entries_[i].command = command;
    entries_[i].complete = false;
    entries_[i].was_reset = true;
    entries_[i].booted_up = false;
    wait(i);
  }

  void identify(std::size_t i) {
    guards_[i].stop();
    entries_[i].step = Step::identifying;
    entries_[i].dropped = entries_[i].asked;
    entries_[i].check = 0;
    entries_[i].complete = false;
  }

  /// Tries a slave again that has not responded; it may be in Stopped. A slave that may be kept alive gets no command.
  void ask_again(std::size_t i) {
    const bool may_be_operational = slaves_[i].has(slave_assignment::keep_alive) && !entries_[i].was_reset;
    if (entries_[i].silent && !may_be_operational && !entries_[i].command) {
      entries_[i].command = NmtCommand::enter_pre_operational;
    }
    identify(i);
  }

  /// Whether the slave may have been Operational since before the master's start; checked before anything is changed.
  [[nodiscard]] bool may_be_kept_alive(std::size_t i) const {
    return slaves_[i].has(slave_assignment::keep_alive) && !entries_[i].was_reset && !entries_[i].booted_up;
  }

  void configure(std::size_t i) {
    const std::span<const std::uint8_t> dcf = slaves_[i].concise_dcf;
    entries_[i].position = 4;
    entries_[i].left = dcf.empty() ? 0 : number_of(dcf.first(std::min<std::size_t>(dcf.size(), 4)));
    if (entries_[i].left == 0) return configure_by_host(i);
    entries_[i].step = Step::downloading;
    if (!dcf_data(i)) finish(i, {BootStatus::configuration, AbortCode::length_mismatch});
  }

  /// Returns the bytes of the present entry of the concise DCF; empty if the DCF is too short.
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> dcf_data(std::size_t i) const {
    constexpr std::size_t head = 7;
    const std::span<const std::uint8_t> dcf = slaves_[i].concise_dcf;
    const std::size_t at = entries_[i].position;
    if (dcf.size() < at || dcf.size() - at < head) return std::nullopt;
    const std::size_t size = number_of(dcf.subspan(at + 3, 4));
    if (dcf.size() - at - head < size) return std::nullopt;
    return dcf.subspan(at + head, size);
  }

  void dcf_entry_written(std::size_t i) {
    constexpr std::uint32_t head = 7;
    entries_[i].position += head + static_cast<std::uint32_t>(dcf_data(i)->size());
    if (--entries_[i].left == 0) return configure_by_host(i);
    if (!dcf_data(i)) finish(i, {BootStatus::configuration, AbortCode::length_mismatch});
  }

  void configure_by_host(std::size_t i) {
    if constexpr (requires { host_.configure(NodeId{}); }) {
      entries_[i].step = Step::configuring;
      host_.configure(slaves_[i].node_id);
    } else {
      prepare_heartbeat(i);
    }
  }

  void prepare_heartbeat(std::size_t i) {
    if (!beats(i)) return start_error_control(i);
    entries_[i].step = Step::reading_heartbeat_time;
  }

  /// Two heartbeats within the consumer time tolerate one that is late or lost.
  void heartbeat_time_read(std::size_t i, const SdoAnswer& answer) {
    const std::uint32_t consumer = slaves_[i].heartbeat_time;
    const std::uint32_t producer = number_of(answer.data.first(std::min<std::size_t>(answer.data.size(), 2)));
    const bool is_short_enough = producer != 0 && 3 * producer <= 2 * consumer;
    if (answer.result == ok && is_short_enough) return start_error_control(i);
    entries_[i].beats_in_time = answer.result == ok && producer != 0 && producer < consumer;
    const std::uint32_t wanted = std::max<std::uint32_t>(consumer / 2, 1);
    entries_[i].number = {static_cast<std::uint8_t>(wanted), static_cast<std::uint8_t>(wanted >> 8)};
    entries_[i].step = Step::writing_heartbeat_time;
  }

  /// Monitors the slave from its next heartbeat on, because it restarts its period. A slave that rejects the write may
  /// keep its own time if that is short enough.
  void heartbeat_time_written(std::size_t i, const SdoAnswer& answer) {
    if (answer.result == ok) {
      watch_heartbeat(i);
    } else if (!entries_[i].beats_in_time) {
      return finish(i, failure(i, BootStatus::no_heartbeat, answer));
    }
    start_error_control(i);
  }

  void start_error_control(std::size_t i) {
    entries_[i].step = Step::starting_error_control;
    entries_[i].deadline = now_ + from_milliseconds(slaves_[i].heartbeat_time);
    if (!is_guarded(i)) return;
    guards_[i].start(slaves_[i].node_id, slaves_[i].guard_time(), slaves_[i].life_time_factor(), now_);
    entries_[i].deadline = now_ + Duration{0x7FFF'FFFF};  // guarding reports a loss
  }

  /// Checks whether the slave has been heard, or its time has elapsed.
  void check_error_control(std::size_t i) {
    const std::optional<NmtState> state = state_of(i);
    const bool heard = state && *state != NmtState::initialisation;
    if (!heard && (beats(i) || is_guarded(i)) && now_ < entries_[i].deadline) return;
    if (may_be_kept_alive(i)) {
      if (heard && *state == NmtState::operational) return finish(i, BootStatus::was_operational);
      return reset(i, NmtCommand::reset_communication);
    }
    if (heard || (!beats(i) && !is_guarded(i))) return finish(i, BootStatus::booted);
    finish(i, beats(i) ? BootStatus::no_heartbeat : BootStatus::no_guarding);
  }

  void finish(std::size_t i, BootStatus status) { finish(i, BootResult{status}); }

  void finish(std::size_t i, const BootResult& result) {
    const BootStatus status = result.status;
    Entry& entry = entries_[i];
    entry.step = Step::idle;
    entry.status = status;
    entry.complete = status == BootStatus::booted || status == BootStatus::was_operational;
    if (!entry.complete) guards_[i].stop();
    host_.booted(slaves_[i].node_id, result);
    if (entry.complete && !slaves_[i].watched()) {
      tell(NmtMasterEvent::not_watched, slaves_[i].node_id, NmtState::initialisation);
    }
    const bool one_by_one = !start_up_.has(nmt_start_up::start_all) || network_started_;
    const bool may_start = slaves_[i].has(slave_assignment::boot) && !start_up_.has(nmt_start_up::no_slave_start);
    if (status == BootStatus::booted && may_start && one_by_one) entry.command = NmtCommand::start;
    check_network();
  }

  /// Whether a slave is in a step before error control.
  [[nodiscard]] bool is_being_booted(std::size_t i) const {
    return entries_[i].step >= Step::identifying && entries_[i].step < Step::starting_error_control;
  }

  /// Starts the network if no mandatory slave is missing.
  void check_network() {
    if (network_started_) return;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      const bool needed = slaves_[i].has(slave_assignment::listed) && slaves_[i].has(slave_assignment::mandatory);
      if (needed && !entries_[i].complete) return;
    }
    network_started_ = true;
    const bool start_all = start_up_.has(nmt_start_up::start_all) && !start_up_.has(nmt_start_up::no_slave_start);
    if (start_all && !all_command_) all_command_ = NmtCommand::start;
    host_.network_started();
  }

  // Messages of slaves

  void on_message(const ErrorControlMessage& message) {
    const bool boot_up = message.state == NmtState::initialisation && !message.toggle;
    if (boot_up) {
      boot_ups_[message.node_id.value() / 32u] |= std::uint32_t{1} << (message.node_id.value() % 32u);
      tell(NmtMasterEvent::boot_up, message.node_id, message.state);
    }
    const std::optional<std::size_t> i = find(message.node_id);
    if (!i) {
      if (boot_up) host_.booted(message.node_id, BootResult{BootStatus::not_listed});
      return;
    }
    heartbeats_.on_message(message, now_, Watch{*this});
    guards_[*i].on_message(message, Watch{*this});
    if (boot_up) return on_boot_up(*i);
    const bool is_silent = entries_[*i].step == Step::waiting || entries_[*i].step == Step::identifying;
    if (message.state == NmtState::stopped && is_silent && !entries_[*i].command) {
      reset(*i, NmtCommand::reset_communication);  // it has missed the reset: it does not respond to SDO in Stopped
    }
  }

  /// Boots a slave again that was already booted, if 1F81h says so.
  void on_boot_up(std::size_t i) {
    Entry& entry = entries_[i];
    if (entry.command == NmtCommand::start || entry.command == NmtCommand::enter_pre_operational) entry.command.reset();
    entry.booted_up = true;
    entry.silent = false;
    stop_watching(i);
    if (!booting_) return;
    if (entry.step != Step::idle || slaves_[i].has(slave_assignment::boot)) {
      identify(i);
    } else {
      entry.dropped = entry.asked;
      entry.complete = false;
    }
    sdo_.node_reset(slaves_[i].node_id,
                    now_);  // `done` of the application may call `configured`: of no effect any more
  }

  /// Handles the loss of a slave (CiA 302-2, error handling): all nodes are stopped or reset, or only the
  /// slave is reset.
  void on_lost(NodeId node_id, NmtState state) {
    const std::optional<std::size_t> i = find(node_id);
    if (i && is_being_booted(*i)) return watch_heartbeat(*i);  // its heartbeat has not been set up yet
    tell(NmtMasterEvent::lost, node_id, state);
    if (!i) return;
    if (entries_[*i].step == Step::starting_error_control) {
      guards_[*i].stop();
      entries_[*i].deadline = now_;
      return;
    }
    if (!entries_[*i].complete) return;
    const bool mandatory = slaves_[*i].has(slave_assignment::mandatory);
    entries_[*i].complete = false;
    if (mandatory && start_up_.has(nmt_start_up::stop_all)) {
      all_command_ = NmtCommand::stop;
    } else if (mandatory && start_up_.has(nmt_start_up::reset_all)) {
      begin(NmtCommand::reset_node);
    } else if (slaves_[*i].has(slave_assignment::boot)) {
      reset(*i, NmtCommand::reset_node);
    } else {
      entries_[*i].command = NmtCommand::reset_node;
    }
  }

  // SDO

  /// Queues a request for each slave that needs one, as soon as it can start, or only has to wait for requests of the
  /// application to its node: first slaves whose boot-up message has been received, and in rotation, so that slaves
  /// that do not respond do not occupy all clients.
  void serve_sdo() {
    const std::size_t first = next_;
    for (const bool booted_up : {true, false}) {
      for (std::size_t n = 0; n < slaves_.size(); ++n) {
        const std::size_t i = (first + n) % slaves_.size();
        if (!wants_sdo(entries_[i]) || entries_[i].booted_up != booted_up) continue;
        const NodeId node_id = slaves_[i].node_id;
        if (!sdo_.busy(node_id) && !sdo_.ready(node_id, now_)) continue;
        entries_[i].asked = static_cast<bool>(sdo_.submit(node_id, request_of(i), now_));
        next_ = i + 1;
      }
    }
  }

  [[nodiscard]] SdoRequest request_of(std::size_t i) {
    Entry& entry = entries_[i];
    SdoRequest request;
    request.done = [](void* context, NodeId node_id, const SdoAnswer& answer) {
      static_cast<NmtMaster*>(context)->on_answer(node_id, answer);
    };
    request.context = this;
    std::tie(request.index, request.sub_index) = entry_of(i);
    request.download = entry.step == Step::downloading || entry.step == Step::writing_heartbeat_time;
    if (entry.step == Step::downloading) {
      request.bytes = *dcf_data(i);
    } else if (request.download) {
      request.bytes = std::span{entry.number}.first(2);
    } else {
      request.memory = entry.number;
    }
    return request;
  }

  /// Returns the index and sub-index of the present request.
  [[nodiscard]] std::pair<std::uint16_t, std::uint8_t> entry_of(std::size_t i) const {
    if (entries_[i].step == Step::identifying) {
      const IdentityCheck& check = identity_checks[entries_[i].check];
      return {check.index, check.sub_index};
    }
    if (entries_[i].step != Step::downloading) return {0x1017, 0};
    const std::span<const std::uint8_t> entry = slaves_[i].concise_dcf.subspan(entries_[i].position, 3);
    return {static_cast<std::uint16_t>(number_of(entry.first(2))), entry[2]};
  }

  void on_answer(NodeId node_id, const SdoAnswer& answer) {
    const std::optional<std::size_t> found = find(node_id);
    if (!found) return;
    const std::size_t i = *found;
    entries_[i].asked = false;
    if (std::exchange(entries_[i].dropped, false)) return;
    if (answer.result == AbortCode::timeout) return on_no_response(i, answer);
    switch (entries_[i].step) {
      case Step::identifying: return identity_read(i, answer);
      case Step::downloading:
        if (answer.result != ok) return finish(i, failure(i, BootStatus::configuration, answer));
        return dcf_entry_written(i);
      case Step::reading_heartbeat_time: return heartbeat_time_read(i, answer);
      case Step::writing_heartbeat_time: return heartbeat_time_written(i, answer);
      case Step::idle:
      case Step::waiting:
      case Step::configuring:
      case Step::starting_error_control: return;
    }
  }

  /// Returns the result of a failed transfer of the master.
  [[nodiscard]] BootResult failure(std::size_t i, BootStatus status, const SdoAnswer& answer) const {
    const auto [index, sub_index] = entry_of(i);
    return {status, answer.result, index, sub_index};
  }

  void identity_read(std::size_t i, const SdoAnswer& answer) {
    Entry& entry = entries_[i];
    const IdentityCheck& check = identity_checks[entry.check];
    const bool answered = answer.result == ok;
    if (entry.check == 0 && !answered) return on_no_response(i, answer);
    const std::uint32_t expected = slaves_[i].*check.expected;
    if (expected != 0 && (!answered || number_of(answer.data) != expected)) {
      BootResult result = failure(i, check.failure, answer);
      result.expected = expected;
      result.seen = number_of(answer.data);
      return finish(i, result);
    }
    do {
      ++entry.check;
    } while (entry.check < checks && slaves_[i].*identity_checks[entry.check].expected == 0);
    if (entry.check < checks) return;
    entry.silent = false;
    if (may_be_kept_alive(i)) {
      start_error_control(i);
    } else {
      configure(i);
    }
  }

  void on_no_response(std::size_t i, const SdoAnswer& answer) { retry(i, failure(i, BootStatus::no_response, answer)); }

  /// Schedules the next attempt for a slave that does not respond.
  void retry(std::size_t i, const BootResult& result) {
    entries_[i].booted_up = false;
    entries_[i].silent = true;
    wait(i);
    if (entries_[i].status == BootStatus::no_response) return;
    entries_[i].status = BootStatus::no_response;
    host_.booted(slaves_[i].node_id, result);
  }

  [[nodiscard]] static std::uint32_t number_of(std::span<const std::uint8_t> bytes) {
    std::uint32_t number = 0;
    for (std::size_t i = bytes.size(); i > 0; --i) number = (number << 8) | bytes[i - 1];
    return number;
  }

  // Sending

  void serve() {
    send_commands();
    serve_sdo();
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (entries_[i].step == Step::waiting && now_ >= entries_[i].deadline) ask_again(i);
      (void)guards_[i].serve(bus_, now_, Watch{*this});
      if (entries_[i].step == Step::starting_error_control) check_error_control(i);
    }
    send_commands();
    serve_sdo();
  }

  /// Sends waiting commands; those for which the bus has no room keep waiting.
  void send_commands() {
    if (all_command_) {
      if (!command(*all_command_, NodeId{})) return;
      all_command_.reset();
    }
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (!entries_[i].command) continue;
      if (!command(*entries_[i].command, slaves_[i].node_id)) return;
      entries_[i].command.reset();
    }
  }

  void expect_after(NmtCommand command, std::size_t i) {
    switch (command) {
      case NmtCommand::start: return guards_[i].expect(NmtState::operational);
      case NmtCommand::stop: return guards_[i].expect(NmtState::stopped);
      case NmtCommand::enter_pre_operational: return guards_[i].expect(NmtState::pre_operational);
      case NmtCommand::reset_node:
      case NmtCommand::reset_communication: return;
    }
  }

  B& bus_;
  std::span<const NmtSlave> slaves_;
  NmtStartUp start_up_;
  [[no_unique_address]] Host host_;
  std::array<Entry, Count> entries_{};
  std::array<NodeGuardingMaster, Count> guards_{};
  HeartbeatConsumer<Count> heartbeats_{};
  SdoQueue<B, Clients, Count + Requests> sdo_;
  std::array<std::uint32_t, 4> boot_ups_{};  ///< one bit per node
  std::optional<NmtCommand> all_command_{};  ///< to all nodes, waiting to be sent
  std::size_t next_ = 0;                     ///< the slave whose turn is next
  TimePoint boot_deadline_{};
  TimePoint now_{};
  bool booting_ = false;  ///< `start` has been called
  bool network_started_ = false;
  bool boot_time_runs_ = false;
};

/// Returns a master of up to `Count` slaves:
///     auto master = canopen::make_nmt_master<8>(bus, slaves, start_up, 500ms, host);
template <std::size_t Count, Bus B, class Host>
[[nodiscard]] constexpr NmtMaster<B, Count, Host> make_nmt_master(B& bus, std::span<const NmtSlave> slaves,
                                                                  NmtStartUp start_up, Duration sdo_timeout,
                                                                  Host host) {
  return NmtMaster<B, Count, Host>{bus, slaves, start_up, sdo_timeout, std::move(host)};
}

}  // namespace canopen

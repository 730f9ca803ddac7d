/// NMT master: commands, and start-up of a network of slaves (CiA 301, 7.2.8; CiA 302-2, boot-up procedure).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master_event.hpp"
#include "canopen/nmt_master/slave_boot.hpp"
#include "canopen/nmt_master/slave_error_control.hpp"
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
        entries_[i].boot.set_reset(true);
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
    if (!i || entries_[*i].boot.step() != Step::configuring) return;
    if (result == AbortCode::timeout) {
      retry(*i, {BootStatus::no_response, result});
    } else if (result != ok) {
      finish(*i, {BootStatus::configuration, result});
    } else {
      proceed(*i, entries_[*i].boot.on_configured(slaves_[*i]));
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
      if (node_id.value() == 0 || slaves_[i].node_id == node_id) error_control_.expect_after(command, i);
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
    error_control_.on_time(now, Events{*this});
    if (booting_ && !network_started_ && boot_time_runs_ && now >= boot_deadline_) {
      boot_time_runs_ = false;
      host_.boot_time_elapsed();
    }
    serve();
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (all_command_) return now_;
    std::optional<TimePoint> next = error_control_.next_heartbeat();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    consider(
        sdo_.next_deadline(std::ranges::any_of(entries_, [](const Entry& entry) { return entry.boot.wants_sdo(); })));
    if (booting_ && !network_started_ && boot_time_runs_) consider(boot_deadline_);
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (entries_[i].command) return now_;
      consider(error_control_.next_guarding(i));
      if (entries_[i].boot.has_deadline()) consider(entries_[i].boot.deadline());
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
    return i ? error_control_.state_of(*i, slaves_[*i]) : std::nullopt;
  }

  /// Whether a node, listed or not, has sent a boot-up message since the master was constructed.
  [[nodiscard]] bool has_booted(NodeId node_id) const {
    return (boot_ups_[node_id.value() / 32u] >> (node_id.value() % 32u) & 1u) != 0;
  }

 private:
  static constexpr Duration retry_time = std::chrono::seconds{1};

  using Step = SlaveBoot::Step;

  struct Entry {
    SlaveBoot boot{};
    std::optional<NmtCommand> command{};  ///< waiting to be sent
    std::optional<BootStatus> status{};
    bool complete = false;  ///< has booted and is not lost
  };

  /// Receives the events of error control.
  struct Events {
    NmtMaster& master;
    void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
      if (event == NmtMasterEvent::lost) return master.on_lost(node_id, state);
      master.tell(event, node_id, state);
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

  /// Starts all slaves from the beginning, after a command to all nodes if there is one.
  void begin(std::optional<NmtCommand> to_all) {
    booting_ = true;
    network_started_ = false;
    all_command_ = to_all;
    boot_time_runs_ = start_up_.boot_time.count() != 0;
    boot_deadline_ = now_ + start_up_.boot_time;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      Entry& entry = entries_[i];
      entry.boot.restart();
      entry.boot.set_reset(to_all.has_value());
      entry.command.reset();
      entry.status.reset();
      entry.complete = false;
      error_control_.stop_guarding(i);
      if (!slaves_[i].has(slave_assignment::listed)) continue;
      error_control_.watch_heartbeat(i, slaves_[i]);
      wait(i);
    }
    check_network();
  }

  // The boot-up steps of one slave

  void wait(std::size_t i) { entries_[i].boot.wait(now_ + retry_time); }

  void reset(std::size_t i, NmtCommand command) {
    error_control_.stop(i, slaves_[i]);
    entries_[i].command = command;
    entries_[i].complete = false;
    entries_[i].boot.report_reset();
    wait(i);
  }

  void identify(std::size_t i) {
    error_control_.stop_guarding(i);
    entries_[i].boot.identify();
    entries_[i].complete = false;
  }

  /// Tries a slave again that has not responded.
  void ask_again(std::size_t i) {
    Entry& entry = entries_[i];
    if (entry.boot.may_be_stopped(slaves_[i]) && !entry.command) entry.command = NmtCommand::enter_pre_operational;
    identify(i);
  }

  /// Does what follows after a step of the boot-up.
  void proceed(std::size_t i, BootNext next, const BootResult& result = {}) {
    switch (next) {
      case BootNext::request: return;
      case BootNext::finish: return finish(i, result);
      case BootNext::retry: return retry(i, result);
      case BootNext::configure: return configure_by_host(i);
      case BootNext::watch: error_control_.watch_heartbeat(i, slaves_[i]); [[fallthrough]];
      case BootNext::error_control: return start_error_control(i);
    }
  }

  void configure_by_host(std::size_t i) {
    if constexpr (requires { host_.configure(NodeId{}); }) {
      entries_[i].boot.enter(Step::configuring);
      host_.configure(slaves_[i].node_id);
    } else {
      proceed(i, entries_[i].boot.on_configured(slaves_[i]));
    }
  }

  void start_error_control(std::size_t i) {
    SlaveBoot& boot = entries_[i].boot;
    boot.enter(Step::starting_error_control);
    boot.set_deadline(now_ + from_milliseconds(slaves_[i].heartbeat_time));
    if (!slaves_[i].guarded()) return;
    error_control_.start_guarding(i, slaves_[i], now_);
    boot.set_deadline(now_ + Duration{0x7FFF'FFFF});  // guarding reports a loss
  }

  /// Checks whether the slave has been heard, or its time has elapsed.
  void check_error_control(std::size_t i) {
    const std::optional<NmtState> state = error_control_.state_of(i, slaves_[i]);
    const bool heard = state && *state != NmtState::initialisation;
    const NmtSlave& slave = slaves_[i];
    if (!heard && slave.watched() && now_ < entries_[i].boot.deadline()) return;
    if (entries_[i].boot.may_be_kept_alive(slave)) {
      if (heard && *state == NmtState::operational) return finish(i, BootStatus::was_operational);
      return reset(i, NmtCommand::reset_communication);
    }
    if (heard || !slave.watched()) return finish(i, BootStatus::booted);
    finish(i, slave.beats() ? BootStatus::no_heartbeat : BootStatus::no_guarding);
  }

  /// Schedules the next attempt for a slave that does not respond.
  void retry(std::size_t i, const BootResult& result) {
    entries_[i].boot.report_silence();
    wait(i);
    if (entries_[i].status == BootStatus::no_response) return;
    entries_[i].status = BootStatus::no_response;
    host_.booted(slaves_[i].node_id, result);
  }

  void finish(std::size_t i, BootStatus status) { finish(i, BootResult{status}); }

  void finish(std::size_t i, const BootResult& result) {
    const BootStatus status = result.status;
    Entry& entry = entries_[i];
    entry.boot.enter(Step::idle);
    entry.status = status;
    entry.complete = status == BootStatus::booted || status == BootStatus::was_operational;
    if (!entry.complete) error_control_.stop_guarding(i);
    host_.booted(slaves_[i].node_id, result);
    if (entry.complete && !slaves_[i].watched()) {
      tell(NmtMasterEvent::not_watched, slaves_[i].node_id, NmtState::initialisation);
    }
    const bool one_by_one = !start_up_.has(nmt_start_up::start_all) || network_started_;
    const bool may_start = slaves_[i].has(slave_assignment::boot) && !start_up_.has(nmt_start_up::no_slave_start);
    if (status == BootStatus::booted && may_start && one_by_one) entry.command = NmtCommand::start;
    check_network();
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
    error_control_.on_message(message, *i, now_, Events{*this});
    if (boot_up) return on_boot_up(*i);
    const Step step = entries_[*i].boot.step();
    const bool is_silent = step == Step::waiting || step == Step::identifying;
    if (message.state == NmtState::stopped && is_silent && !entries_[*i].command) {
      reset(*i, NmtCommand::reset_communication);  // it has missed the reset: it does not respond to SDO in Stopped
    }
  }

  /// Boots a slave again that was already booted, if 1F81h says so.
  void on_boot_up(std::size_t i) {
    Entry& entry = entries_[i];
    if (entry.command == NmtCommand::start || entry.command == NmtCommand::enter_pre_operational) entry.command.reset();
    entry.boot.report_boot_up();
    error_control_.stop(i, slaves_[i]);
    if (!booting_) return;
    if (entry.boot.step() != Step::idle || slaves_[i].has(slave_assignment::boot)) {
      identify(i);
    } else {
      entry.boot.ignore_response();
      entry.complete = false;
    }
    // `done` of the application may call `configured`, which has no effect any more.
    sdo_.node_reset(slaves_[i].node_id, now_);
  }

  /// Handles the loss of a slave (CiA 302-2, error handling): all nodes are stopped or reset, or only the
  /// slave is reset.
  void on_lost(NodeId node_id, NmtState state) {
    const std::optional<std::size_t> i = find(node_id);
    if (i && entries_[*i].boot.is_before_error_control()) {
      return error_control_.watch_heartbeat(*i, slaves_[*i]);  // its heartbeat has not been set up yet
    }
    tell(NmtMasterEvent::lost, node_id, state);
    if (!i) return;
    if (entries_[*i].boot.step() == Step::starting_error_control) {
      error_control_.stop_guarding(*i);
      entries_[*i].boot.set_deadline(now_);
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
        SlaveBoot& boot = entries_[i].boot;
        if (!boot.wants_sdo() || boot.booted_up() != booted_up) continue;
        const NodeId node_id = slaves_[i].node_id;
        if (!sdo_.busy(node_id) && !sdo_.ready(node_id, now_)) continue;
        boot.set_asked(static_cast<bool>(sdo_.submit(node_id, request_of(i), now_)));
        next_ = i + 1;
      }
    }
  }

  [[nodiscard]] SdoRequest request_of(std::size_t i) {
    SdoRequest request = entries_[i].boot.request(slaves_[i]);
    request.done = [](void* context, NodeId node_id, const SdoAnswer& answer) {
      static_cast<NmtMaster*>(context)->on_answer(node_id, answer);
    };
    request.context = this;
    return request;
  }

  void on_answer(NodeId node_id, const SdoAnswer& answer) {
    const std::optional<std::size_t> i = find(node_id);
    if (!i) return;
    BootResult result;
    const BootNext next = entries_[*i].boot.on_answer(slaves_[*i], answer, result);
    proceed(*i, next, result);
  }

  // Sending

  void serve() {
    send_commands();
    serve_sdo();
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      const SlaveBoot& boot = entries_[i].boot;
      if (boot.step() == Step::waiting && now_ >= boot.deadline()) ask_again(i);
      error_control_.serve(bus_, i, now_, Events{*this});
      if (boot.step() == Step::starting_error_control) check_error_control(i);
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

  B& bus_;
  std::span<const NmtSlave> slaves_;
  NmtStartUp start_up_;
  [[no_unique_address]] Host host_;
  std::array<Entry, Count> entries_{};
  SlaveErrorControl<Count> error_control_{};
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

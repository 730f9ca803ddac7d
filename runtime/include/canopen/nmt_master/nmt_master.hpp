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
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master_event.hpp"
#include "canopen/nmt_master/slave_boot.hpp"
#include "canopen/nmt_master/slave_table.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// Boots up to `Count` slaves and monitors them (CiA 302-2, boot NMT slave). Each slave is reset. After its boot-up
/// message, or after a second because the message may have been missed, it is
///   1. identified by SDO; a wrong identity or software ends the boot-up until the next boot-up message,
///   2. configured: unless 1020h has the date and time of the list, its default values are restored if 1F81h says so
///      and its concise DCF (1F22h) is written; the values of the DCF are read back, and a slave with the date and time
///      of the list that has others is configured after all; then the application configures it,
///   3. given its heartbeat time: if the list has one, 1017h is read, and written if it is 0 or too long,
///   4. monitored by heartbeat or guarding; the rate of the heartbeats is measured if it is at most a second, and
///   5. started.
/// The boot-up is supervised: a second boot-up message, a response without a request, a value that is not read back,
/// and heartbeats at another rate or with different states (`is_disturbed`) are faults, and so is a restart in the
/// first ten seconds after the boot-up. They are reported, and the slave is reset and booted again, twice in a row;
/// then it is not started, and left in Pre-operational, until its next boot-up message or `boot`. The network does not
/// start without it if it is mandatory. A slave that does not respond is tried again every second, after a command to
/// enter Pre-operational, because SDO is not available in Stopped. A slave with `keep_alive` that is already
/// Operational is not reset or configured; one that does not report its state is left alone. The network is started
/// when all mandatory slaves have booted; later slaves are booted when they appear.
///
/// The master and the application share the SDO of a slave: `request` appends a transfer to the queue of its node,
/// which the boot-up uses as well. Up to `Clients` nodes are served at the same time; up to `Requests` requests of the
/// application may wait. The boot-up message of a slave ends all requests to it with 0800 0022h.
///
/// Functions of the application that the master calls (`Host`):
///   happened(NmtMasterEvent, NodeId, NmtState)   with the last reported state
///   configure(NodeId)                            optional: configure the slave now, with any number of requests, then
///                                                call `configured`; called again after the next boot-up of the slave
///   booted(NodeId, BootResult)                   how a boot-up ended; no_response: the slave is tried again, as after
///                                                a fault. A Host may accept a BootStatus instead
///   network_started()                            unless 1F80h forbids it, the master's own device may be started now
///   boot_time_elapsed()                          a mandatory slave is missing; the master keeps waiting for it
template <Bus BusType, std::size_t Count, class Host, std::size_t Requests = 4,
          std::size_t Clients = (Count < 4 ? Count : 4)>
class NmtMaster {
 public:
  /// Manages the first `Count` of `slaves`, which must outlive the master. Bit 0 of 1F81h must be set in the slaves
  /// that are to be booted.
  constexpr NmtMaster(BusType& can_bus, std::span<const NmtSlave> slaves, NmtStartUp start_up, SdoClientOptions options,
                      Host host)
      : bus_{can_bus},
        slaves_{slaves},
        start_up_{start_up},
        host_{std::move(host)},
        sdo_timeout_{options.timeout},
        sdo_{sdo_bus_, options} {}
  constexpr NmtMaster(BusType& can_bus, std::span<const NmtSlave> slaves, NmtStartUp start_up, Duration sdo_timeout,
                      Host host)
      : NmtMaster{can_bus, slaves, start_up, SdoClientOptions{.timeout = sdo_timeout}, std::move(host)} {}
  NmtMaster(const NmtMaster&) = delete;
  NmtMaster& operator=(const NmtMaster&) = delete;

  /// Starts the boot-up: resets the communication of all nodes, or of each slave that is not to be kept alive.
  void start(TimePoint now) {
    now_ = now;
    const bool reset_each = std::ranges::any_of(slaves_.list(), [](const NmtSlave& slave) {
      return slave.has(slave_assignment::listed) && slave.has(slave_assignment::keep_alive);
    });
    begin(reset_each ? std::nullopt : std::optional{NmtCommand::reset_communication});
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (!reset_each || !slaves_[i].has(slave_assignment::listed)) continue;
      if (slaves_[i].has(slave_assignment::keep_alive)) {
        slaves_.identify(i);
      } else {
        slaves_.command(i, NmtCommand::reset_communication);
        slaves_.boot(i).set_reset(true);
      }
    }
    serve();
  }

  /// Resets the communication of one slave and boots it again, for instance after a failure.
  void boot(NodeId node_id, TimePoint now) {
    now_ = now;
    if (const std::optional<std::size_t> i = slaves_.find(node_id)) {
      slaves_.boot(*i).forget_faults();
      slaves_.reset(*i, NmtCommand::reset_communication, now);
    }
    serve();
  }

  /// Reports that the application has configured a slave, after `configure` of the host: `ok`, or the abort code. Has
  /// no effect if the slave has been lost, reset or booted up in the meantime.
  void configured(NodeId node_id, AbortCode result, TimePoint now) {
    now_ = now;
    const std::optional<std::size_t> i = slaves_.find(node_id);
    if (!i || slaves_.boot(*i).step() != Step::configuring) return;
    if (result == AbortCode::timeout) {
      retry(*i, {BootStatus::no_response, result});
    } else if (result != ok) {
      finish(*i, {BootStatus::configuration, result});
    } else {
      proceed(*i, slaves_.boot(*i).on_configured(slaves_[*i]));
    }
    serve();
  }

  /// Appends a transfer of the application to the queue of a node, listed or not. Its memory is used until `done`
  /// has been called, which happens with 0800 0022h if a slave of the list boots up. 060A 0023h: `Requests` are
  /// already waiting.
  Result<void> request(NodeId node_id, const SdoRequest& what, TimePoint now) {
    if (sdo_.waiting(this) >= Requests) return AbortCode::no_resource;
    SdoRequest request = what;
    const std::optional<std::size_t> i = slaves_.find(node_id);
    if (i && request.timeout.count() == 0) request.timeout = sdo_timeout_of(*i);
    return sdo_.submit(node_id, request, now);
  }

  /// Sends a command to one node, or to all nodes with node-ID 0. Returns false if the bus had no room; it is not sent.
  [[nodiscard]] bool command(NmtCommand command, NodeId node_id) { return slaves_.send(bus_, command, node_id); }

  /// Processes a frame from the bus.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    supervise_sdo(frame);
    sdo_.on_frame(frame, now);
    if (const std::optional<ErrorControlMessage> message = error_control_message(frame)) on_message(*message);
    serve();
  }

  /// Processes elapsed time. Call it at `next_deadline()` and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    sdo_.on_time(now);
    slaves_.error_control().on_time(now, Events{*this});
    if (booting_ && !network_started_ && boot_time_runs_ && now >= boot_deadline_) {
      boot_time_runs_ = false;
      host_.boot_time_elapsed();
    }
    serve();
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (slaves_.has_command()) return now_;
    std::optional<TimePoint> next = slaves_.next_deadline();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    consider(sdo_.next_deadline(slaves_.wants_sdo()));
    if (booting_ && !network_started_ && boot_time_runs_) consider(boot_deadline_);
    return next;
  }

  /// Whether all mandatory slaves have booted.
  [[nodiscard]] bool network_started() const { return network_started_; }

  /// Returns how the last boot-up of a slave ended; empty before that.
  [[nodiscard]] std::optional<BootStatus> status(NodeId node_id) const {
    const std::optional<std::size_t> i = slaves_.find(node_id);
    return i ? slaves_.status(*i) : std::nullopt;
  }

  /// Returns the last state that a slave reported by heartbeat or guarding; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const {
    const std::optional<std::size_t> i = slaves_.find(node_id);
    return i ? slaves_.state(*i) : std::nullopt;
  }

  /// Whether 1020h of a slave had the date and time of the list at its boot-up: its configuration was not written.
  [[nodiscard]] bool configuration_is_current(NodeId node_id) const {
    const std::optional<std::size_t> i = slaves_.find(node_id);
    return i && slaves_.boot(*i).configuration_is_current();
  }

  /// Whether a node, listed or not, has sent a boot-up message since the master was constructed.
  [[nodiscard]] bool has_booted(NodeId node_id) const {
    return (boot_ups_[node_id.value() / 32u] >> (node_id.value() % 32u) & 1u) != 0;
  }

 private:
  using Step = SlaveBoot::Step;

  /// Receives the events of error control.
  struct Events {
    NmtMaster& master;
    void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
      if (event == NmtMasterEvent::lost) return master.on_lost(node_id, state);
      master.tell(event, node_id, state);
    }
  };

  /// The bus of the SDO clients, which counts their requests.
  struct SdoBus {
    NmtMaster& master;
    [[nodiscard]] bool send(const Frame& frame) {
      if (!master.bus_.send(frame)) return false;
      master.count_request(frame);
      return true;
    }
  };

  void tell(NmtMasterEvent event, NodeId node_id, NmtState state) { host_.happened(event, node_id, state); }

  // The network

  /// Starts all slaves from the beginning, after a command to all nodes if there is one.
  void begin(std::optional<NmtCommand> to_all) {
    booting_ = true;
    network_started_ = false;
    boot_time_runs_ = start_up_.boot_time.count() != 0;
    boot_deadline_ = now_ + start_up_.boot_time;
    slaves_.restart(to_all, now_);
    check_network();
  }

  // The boot-up steps of one slave

  /// Does what follows after a step of the boot-up.
  void proceed(std::size_t i, BootNext next, const BootResult& result = {}) {
    switch (next) {
      case BootNext::request: return;
      case BootNext::finish: return is_disturbed(result.status) ? disturb(i, result) : finish(i, result);
      case BootNext::retry: return retry(i, result);
      case BootNext::reset: return slaves_.reset_restored(i, now_);
      case BootNext::configure: return configure_by_host(i);
      case BootNext::watch: slaves_.error_control().watch_heartbeat(i, slaves_[i]); [[fallthrough]];
      case BootNext::error_control: return slaves_.start_error_control(i, now_);
    }
  }

  void configure_by_host(std::size_t i) {
    if constexpr (requires { host_.configure(NodeId{}); }) {
      slaves_.boot(i).enter(Step::configuring);
      host_.configure(slaves_[i].node_id);
    } else {
      proceed(i, slaves_.boot(i).on_configured(slaves_[i]));
    }
  }

  void retry(std::size_t i, const BootResult& result) {
    if (slaves_.retry(i, now_)) host_.booted(slaves_[i].node_id, result);
  }

  /// Boots a slave again after a fault of its boot-up, or leaves it in Pre-operational. One that may be Operational
  /// since before the start of the master, and is to be kept alive, does not get a command.
  void disturb(std::size_t i, const BootResult& result) {
    SlaveBoot& boot = slaves_.boot(i);
    const bool is_kept_alive = boot.may_be_kept_alive(slaves_[i]);
    if (!is_kept_alive && boot.may_boot_again()) {
      slaves_.reset_disturbed(i, result.status, now_);
      host_.booted(slaves_[i].node_id, result);
      return;
    }
    boot.ignore_response();
    if (!is_kept_alive) slaves_.command(i, NmtCommand::enter_pre_operational);
    finish(i, result);
  }

  void finish(std::size_t i, const BootResult& result) {
    slaves_.finish(i, result.status, now_);
    host_.booted(slaves_[i].node_id, result);
    if (slaves_.complete(i) && !slaves_[i].watched()) {
      tell(NmtMasterEvent::not_watched, slaves_[i].node_id, NmtState::initialisation);
    }
    const bool one_by_one = !start_up_.has(nmt_start_up::start_all) || network_started_;
    const bool may_start = slaves_[i].has(slave_assignment::boot) && !start_up_.has(nmt_start_up::no_slave_start);
    if (result.status == BootStatus::booted && may_start && one_by_one) slaves_.command(i, NmtCommand::start);
    check_network();
  }

  /// Starts the network if no mandatory slave is missing.
  void check_network() {
    if (network_started_ || !slaves_.mandatory_complete()) return;
    network_started_ = true;
    const bool start_all = start_up_.has(nmt_start_up::start_all) && !start_up_.has(nmt_start_up::no_slave_start);
    if (start_all && !slaves_.all_commanded()) start_complete_slaves();
    host_.network_started();
  }

  /// Starts all nodes with one command if no slave is being booted or has failed, otherwise each slave that has booted.
  void start_complete_slaves() {
    if (slaves_.all_complete()) return slaves_.command_all(NmtCommand::start);
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (slaves_.complete(i) && slaves_[i].has(slave_assignment::boot)) slaves_.command(i, NmtCommand::start);
    }
  }

  // Messages of slaves

  void on_message(const ErrorControlMessage& message) {
    const bool boot_up = message.state == NmtState::initialisation && !message.toggle;
    if (boot_up) {
      boot_ups_[message.node_id.value() / 32u] |= std::uint32_t{1} << (message.node_id.value() % 32u);
      tell(NmtMasterEvent::boot_up, message.node_id, message.state);
    }
    const std::optional<std::size_t> i = slaves_.find(message.node_id);
    if (!i) {
      if (boot_up) host_.booted(message.node_id, BootResult{BootStatus::not_listed});
      return;
    }
    slaves_.error_control().on_message(message, *i, now_, Events{*this});
    if (boot_up) return on_boot_up(*i);
    const Step step = slaves_.boot(*i).step();
    if (step == Step::starting_error_control && slaves_[*i].beats() && !message.toggle) {
      slaves_.boot(*i).report_heartbeat(message.state, now_);
    }
    const bool is_silent = step == Step::waiting || step == Step::identifying;
    if (message.state == NmtState::stopped && is_silent && !slaves_.commanded(*i)) {
      slaves_.reset(*i, NmtCommand::reset_communication,
                    now_);  // it has missed the reset: it does not respond to SDO in Stopped
    }
  }

  /// Boots a slave again that was already booted, if 1F81h says so.
  void on_boot_up(std::size_t i) {
    SlaveBoot& boot = slaves_.boot(i);
    const NodeId node_id = slaves_[i].node_id;
    const bool is_unexpected = slaves_.complete(i) && !boot.expects_boot_up();
    const bool is_restart = boot.is_restart();
    slaves_.discard_command(i);
    boot.report_boot_up();
    slaves_.error_control().stop(i, slaves_[i]);
    if (!booting_) return;
    if (is_unexpected && boot.has_run_long(now_)) boot.forget_faults();
    const bool may_boot = !(is_restart || is_unexpected) || boot.may_boot_again();
    if (may_boot && (boot.step() != Step::idle || slaves_[i].has(slave_assignment::boot))) {
      slaves_.identify(i);
    } else {
      boot.ignore_response();
      slaves_.set_incomplete(i);
    }
    if (is_unexpected) tell(NmtMasterEvent::restarted, node_id, NmtState::initialisation);
    if (!may_boot) {
      slaves_.command(i, NmtCommand::enter_pre_operational);
      finish(i, BootResult{BootStatus::restarted});
    } else if (is_restart) {
      slaves_.set_status(i, BootStatus::restarted);
      host_.booted(node_id, BootResult{BootStatus::restarted});
    }
    // `done` of the application may call `configured`, which has no effect any more.
    sdo_.node_reset(node_id, now_);
  }

  /// Handles the loss of a slave (CiA 302-2, error handling): all nodes are stopped or reset, or only the
  /// slave is reset.
  void on_lost(NodeId node_id, NmtState state) {
    const std::optional<std::size_t> i = slaves_.find(node_id);
    if (i && slaves_.boot(*i).is_before_error_control()) {
      return slaves_.error_control().watch_heartbeat(*i, slaves_[*i]);  // its heartbeat has not been set up yet
    }
    tell(NmtMasterEvent::lost, node_id, state);
    if (!i) return;
    if (slaves_.boot(*i).step() == Step::starting_error_control) {
      slaves_.error_control().stop_guarding(*i);
      slaves_.boot(*i).set_deadline(now_);
      return;
    }
    if (!slaves_.complete(*i)) return;
    const bool mandatory = slaves_[*i].has(slave_assignment::mandatory);
    slaves_.set_incomplete(*i);
    if (mandatory && start_up_.has(nmt_start_up::stop_all)) {
      slaves_.command_all(NmtCommand::stop);
    } else if (mandatory && start_up_.has(nmt_start_up::reset_all)) {
      begin(NmtCommand::reset_node);
    } else if (slaves_[*i].has(slave_assignment::boot)) {
      slaves_.reset(*i, NmtCommand::reset_node, now_);
    } else {
      slaves_.command(*i, NmtCommand::reset_node);
    }
  }

  // SDO

  [[nodiscard]] Duration sdo_timeout_of(std::size_t i) const {
    const std::uint16_t own = slaves_[i].sdo_timeout;
    return own != 0 ? from_milliseconds(own) : sdo_timeout_;
  }

  void count_request(const Frame& frame) {
    const std::optional<std::size_t> i = slaves_.find(NodeId{static_cast<std::uint8_t>(frame.id & 0x7F)});
    if (i) slaves_.responses(*i).on_request(frame.data, now_, sdo_timeout_of(*i) * 2u);
  }

  /// Counts the responses of a slave, and the requests of other clients if the bus passes them on.
  void supervise_sdo(const Frame& frame) {
    if (frame.extended || frame.remote || frame.size != 8) return;
    const std::uint32_t function = frame.id & ~0x7Fu;
    if (function == function_code::sdo_request) return count_request(frame);
    if (function != function_code::sdo_response) return;
    const std::optional<std::size_t> i = slaves_.find(NodeId{static_cast<std::uint8_t>(frame.id & 0x7F)});
    if (!i || !slaves_.responses(*i).on_response(frame.data) || !slaves_.boot(*i).is_supervised()) return;
    BootResult result{BootStatus::extra_response};
    if (sdo::has_multiplexer(frame.data)) {
      result.index = sdo::index_of(frame.data);
      result.sub_index = frame.data[3];
    }
    if (frame.data[0] == sdo::abort_command) result.abort_code = abort_code_from(sdo::word_of(frame.data));
    disturb(*i, result);
  }

  /// Queues a request for each slave that needs one, as soon as it can start, or only has to wait for requests of the
  /// application to its node: first slaves whose boot-up message has been received, and in rotation, so that slaves
  /// that do not respond do not occupy all clients.
  void serve_sdo() {
    const std::size_t first = next_;
    for (const bool booted_up : {true, false}) {
      for (std::size_t n = 0; n < slaves_.size(); ++n) {
        const std::size_t i = (first + n) % slaves_.size();
        SlaveBoot& boot = slaves_.boot(i);
        if (!boot.wants_sdo() || boot.booted_up() != booted_up) continue;
        const NodeId node_id = slaves_[i].node_id;
        if (!sdo_.busy(node_id) && !sdo_.ready(node_id, now_)) continue;
        boot.set_asked(static_cast<bool>(sdo_.submit(node_id, request_of(i), now_)));
        next_ = i + 1;
      }
    }
  }

  [[nodiscard]] SdoRequest request_of(std::size_t i) {
    SdoRequest request = slaves_.boot(i).request(slaves_[i]);
    request.done = [](void* context, NodeId node_id, const SdoAnswer& answer) {
      static_cast<NmtMaster*>(context)->on_answer(node_id, answer);
    };
    request.context = this;
    request.timeout = sdo_timeout_of(i);
    return request;
  }

  void on_answer(NodeId node_id, const SdoAnswer& answer) {
    const std::optional<std::size_t> i = slaves_.find(node_id);
    if (!i) return;
    BootResult result;
    const BootNext next = slaves_.boot(*i).on_answer(slaves_[*i], answer, result);
    proceed(*i, next, result);
  }

  // Sending

  void serve() {
    slaves_.send_commands(bus_);
    serve_sdo();
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      const SlaveBoot& boot = slaves_.boot(i);
      if (boot.step() == Step::waiting && now_ >= boot.deadline()) slaves_.ask_again(i);
      slaves_.error_control().serve(bus_, i, now_, Events{*this});
      if (boot.step() != Step::starting_error_control) continue;
      if (const std::optional<BootResult> end = slaves_.check_error_control(i, now_)) {
        proceed(i, BootNext::finish, *end);
      }
    }
    slaves_.send_commands(bus_);
    serve_sdo();
  }

  BusType& bus_;
  SlaveTable<Count> slaves_;
  NmtStartUp start_up_;
  [[no_unique_address]] Host host_;
  Duration sdo_timeout_;
  SdoBus sdo_bus_{*this};
  SdoQueue<SdoBus, Clients, Count + Requests> sdo_;
  std::array<std::uint32_t, 4> boot_ups_{};  ///< one bit per node
  std::size_t next_ = 0;                     ///< the slave whose turn is next
  TimePoint boot_deadline_{};
  TimePoint now_{};
  bool booting_ = false;  ///< `start` has been called
  bool network_started_ = false;
  bool boot_time_runs_ = false;
};

/// Returns a master of up to `Count` slaves:
///     auto master = canopen::make_nmt_master<8>(bus, slaves, start_up, 500ms, host);
template <std::size_t Count, Bus BusType, class Host>
[[nodiscard]] constexpr NmtMaster<BusType, Count, Host> make_nmt_master(BusType& bus, std::span<const NmtSlave> slaves,
                                                                        NmtStartUp start_up, Duration sdo_timeout,
                                                                        Host host) {
  return NmtMaster<BusType, Count, Host>{bus, slaves, start_up, sdo_timeout, std::move(host)};
}

}  // namespace canopen

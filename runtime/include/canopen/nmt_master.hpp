/// NMT master: commands, boot-up of a list of slaves, and the watch over them (CiA 301, 7.2.8; CiA 302-2).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "canopen/abort_code.hpp"
#include "canopen/boot_status.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/error_control.hpp"
#include "canopen/frame.hpp"
#include "canopen/heartbeat_consumer.hpp"
#include "canopen/network_list.hpp"
#include "canopen/nmt.hpp"
#include "canopen/node_guarding.hpp"
#include "canopen/node_id.hpp"
#include "canopen/sdo_client.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// A command to one node, or to all with node-ID 0.
[[nodiscard]] constexpr Frame nmt_frame(NmtCommand command, NodeId node_id) {
  Frame frame{};
  frame.id = function_code::nmt;
  frame.size = 2;
  frame.data[0] = static_cast<std::uint8_t>(command);
  frame.data[1] = node_id.value();
  return frame;
}

/// What the master sees of a slave.
enum class NmtMasterEvent : std::uint8_t {
  boot_up,           ///< its boot-up message
  state_changed,     ///< it tells a state for the first time, or another one than before
  unexpected_state,  ///< guarding: a state that it has not been commanded to
  toggle_error,      ///< guarding: an answer with the toggle bit of the one before
  lost,              ///< no heartbeat, or no answer to guarding, for its time
  back,              ///< the first one after that
};

/// One number of a slave's identity: where it is read, what it is compared with, how a difference is told.
struct IdentityCheck {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t NmtSlave::*expected;
  BootStatus failure;
};

/// In the order of the boot-up process. The first one is read in any case: it shows that the node is there.
inline constexpr IdentityCheck identity_checks[] = {
    {0x1000, 0, &NmtSlave::device_type, BootStatus::device_type},
    {0x1018, 1, &NmtSlave::vendor_id, BootStatus::vendor_id},
    {0x1018, 2, &NmtSlave::product_code, BootStatus::product_code},
    {0x1018, 3, &NmtSlave::revision_number, BootStatus::revision_number},
    {0x1018, 4, &NmtSlave::serial_number, BootStatus::serial_number},
};

/// Boots up to `Count` slaves and watches them. Each is reset, identified over SDO when its boot-up message has come
/// (or after a second, for a message that was missed), watched by heartbeat or guarding, and started. A slave that does
/// not answer is asked again every second. One with `keep_alive` that is found Operational is not reset; to find that
/// it needs a heartbeat or guarding. The network is started when all mandatory slaves have booted; slaves that come
/// later are booted as they come. A wrong identity ends the boot-up of a slave until its next boot-up message.
///
/// Slaves are identified one after the other through one `Client`, which is built from the bus, a node-ID and a
/// time-out and has upload, busy, result, data, on_frame, on_time and next_deadline as `SdoClient` has.
///
/// The application around it (`Host`) is told:
///   happened(NmtMasterEvent, NodeId, NmtState)   with the state last told
///   booted(NodeId, BootStatus)                   how a boot-up ended; no_response: the slave is asked again
///   network_started()                            unless 1F80h forbids it, the master's own device may be started now
///   boot_time_elapsed()                          a mandatory slave is missing; it is still waited for
template <Bus B, std::size_t Count, class Host, class Client = SdoClient<B>>
class NmtMaster {
 public:
  /// Of `slaves` the first `Count` are looked after; they must outlive the master. 1F81h bit 0 has to be set in those
  /// that are to be booted.
  constexpr NmtMaster(B& can_bus, std::span<const NmtSlave> slaves, NmtStartUp start_up, Duration sdo_timeout,
                      Host host)
      : bus_{can_bus},
        slaves_{slaves.first(std::min(slaves.size(), Count))},
        start_up_{start_up},
        sdo_timeout_{sdo_timeout},
        host_{std::move(host)} {}
  NmtMaster(const NmtMaster&) = delete;
  NmtMaster& operator=(const NmtMaster&) = delete;

  /// Begins the boot-up: resets the communication of all nodes, or of each slave that is not to be kept alive.
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
      }
    }
    serve();
  }

  /// Resets the communication of one slave and boots it again, after its failure for instance.
  void boot(NodeId node_id, TimePoint now) {
    now_ = now;
    if (const std::optional<std::size_t> i = find(node_id)) reset(*i, NmtCommand::reset_communication);
    serve();
  }

  /// Sends a command to one node, or to all with node-ID 0. False when the bus had no room: it is not sent.
  bool command(NmtCommand command, NodeId node_id) {
    if (!bus_.send(nmt_frame(command, node_id))) return false;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (node_id.value() == 0 || slaves_[i].node_id == node_id) expect_after(command, i);
    }
    return true;
  }

  /// Takes a frame from the bus.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    if (client_) client_->on_frame(frame, now);
    if (const std::optional<ErrorControlMessage> message = error_control_message(frame)) on_message(*message);
    serve();
  }

  /// Lets time pass. To be called at `next_deadline()` and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    if (client_) client_->on_time(now);
    heartbeats_.on_time(now, Watch{*this});
    if (booting_ && !network_started_ && boot_time_runs_ && now >= boot_deadline_) {
      boot_time_runs_ = false;
      host_.boot_time_elapsed();
    }
    serve();
  }

  /// When `on_time` has something to do next.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (all_command_) return now_;
    std::optional<TimePoint> next = heartbeats_.next_deadline();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    if (client_) consider(client_->next_deadline());
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

  /// How the last boot-up of a slave ended; nothing before that.
  [[nodiscard]] std::optional<BootStatus> status(NodeId node_id) const {
    const std::optional<std::size_t> i = find(node_id);
    return i ? entries_[*i].status : std::nullopt;
  }

  /// The state that a slave told last by heartbeat or guarding; nothing when it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const {
    const std::optional<std::size_t> i = find(node_id);
    return i ? state_of(*i) : std::nullopt;
  }

  /// Whether a node, listed or not, has sent a boot-up message since the master was built.
  [[nodiscard]] bool has_booted(NodeId node_id) const {
    return (boot_ups_[node_id.value() / 32u] >> (node_id.value() % 32u) & 1u) != 0;
  }

 private:
  static constexpr Duration retry_time = std::chrono::seconds{1};
  static constexpr std::size_t checks = std::size(identity_checks);
  static constexpr std::size_t nobody = Count;

  enum class Step : std::uint8_t {
    idle,                    ///< not begun, or ended
    waiting,                 ///< for a boot-up message, or to be asked without one
    identifying,             ///< `check` is the number that is read, or is next to be read
    starting_error_control,  ///< for the first heartbeat or answer
  };

  struct Entry {
    TimePoint deadline{};
    std::optional<NmtCommand> command{};  ///< waits to be sent
    std::optional<BootStatus> status{};
    Step step = Step::idle;
    std::uint8_t check = 0;
    bool booted_up = false;  ///< its boot-up message has come: it is asked before those that are silent
    bool was_reset = false;
    bool complete = false;  ///< has booted and is not lost
  };

  /// Hands the events of heartbeats and guarding on.
  struct Watch {
    NmtMaster& master;

    void happened(HeartbeatEvent event, NodeId node_id, NmtState state) {
      switch (event) {
        case HeartbeatEvent::boot_up: return;  // told for all nodes, watched or not
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

  /// All slaves from the start, after a command to all nodes where there is one.
  void begin(std::optional<NmtCommand> to_all) {
    booting_ = true;
    network_started_ = false;
    all_command_ = to_all;
    boot_time_runs_ = start_up_.boot_time.count() != 0;
    boot_deadline_ = now_ + start_up_.boot_time;
    release_client();
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      entries_[i] = Entry{};
      guards_[i].stop();
      if (!slaves_[i].has(slave_assignment::listed)) continue;
      const ConsumerHeartbeatTime time{slaves_[i].node_id, slaves_[i].heartbeat_time};
      heartbeats_.configure(i, time);
      wait(i);
    }
    check_network();
  }

  // The steps of one slave

  void wait(std::size_t i) {
    entries_[i].step = Step::waiting;
    entries_[i].deadline = now_ + retry_time;
  }

  void reset(std::size_t i, NmtCommand command) {
    if (active_ == i) release_client();
    guards_[i].stop();
    entries_[i].command = command;
    entries_[i].complete = false;
    entries_[i].was_reset = true;
    entries_[i].booted_up = false;
    wait(i);
  }

  void identify(std::size_t i) {
    if (active_ == i) release_client();
    guards_[i].stop();
    entries_[i].step = Step::identifying;
    entries_[i].check = 0;
    entries_[i].complete = false;
  }

  void start_error_control(std::size_t i) {
    entries_[i].step = Step::starting_error_control;
    entries_[i].deadline = now_ + from_milliseconds(slaves_[i].heartbeat_time);
    if (!is_guarded(i)) return;
    guards_[i].start(slaves_[i].node_id, slaves_[i].guard_time(), slaves_[i].life_time_factor(), now_);
    entries_[i].deadline = now_ + Duration{0x7FFF'FFFF};  // the guard tells
  }

  /// Looks whether a slave in this step is heard of, or its time is over.
  void check_error_control(std::size_t i) {
    const std::optional<NmtState> state = state_of(i);
    const bool heard = state && *state != NmtState::initialisation;
    if (!heard && (beats(i) || is_guarded(i)) && now_ < entries_[i].deadline) return;
    if (slaves_[i].has(slave_assignment::keep_alive) && !entries_[i].was_reset && !entries_[i].booted_up) {
      if (heard && *state == NmtState::operational) return finish(i, BootStatus::was_operational);
      return reset(i, NmtCommand::reset_communication);
    }
    if (heard || (!beats(i) && !is_guarded(i))) return finish(i, BootStatus::booted);
    finish(i, beats(i) ? BootStatus::no_heartbeat : BootStatus::no_guarding);
  }

  void finish(std::size_t i, BootStatus status) {
    Entry& entry = entries_[i];
    entry.step = Step::idle;
    entry.status = status;
    entry.complete = status == BootStatus::booted || status == BootStatus::was_operational;
    if (!entry.complete) guards_[i].stop();
    host_.booted(slaves_[i].node_id, status);
    const bool one_by_one = !start_up_.has(nmt_start_up::start_all) || network_started_;
    const bool may_start = slaves_[i].has(slave_assignment::boot) && !start_up_.has(nmt_start_up::no_slave_start);
    if (status == BootStatus::booted && may_start && one_by_one) entry.command = NmtCommand::start;
    check_network();
  }

  /// The network starts when no mandatory slave is missing.
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

  // What slaves tell

  void on_message(const ErrorControlMessage& message) {
    const bool boot_up = message.state == NmtState::initialisation && !message.toggle;
    if (boot_up) {
      boot_ups_[message.node_id.value() / 32u] |= std::uint32_t{1} << (message.node_id.value() % 32u);
      tell(NmtMasterEvent::boot_up, message.node_id, message.state);
    }
    const std::optional<std::size_t> i = find(message.node_id);
    if (!i) {
      if (boot_up) host_.booted(message.node_id, BootStatus::not_listed);
      return;
    }
    heartbeats_.on_message(message, now_, Watch{*this});
    guards_[*i].on_message(message, Watch{*this});
    if (boot_up) on_boot_up(*i);
  }

  /// A slave that was booted already is booted again where 1F81h says so.
  void on_boot_up(std::size_t i) {
    Entry& entry = entries_[i];
    if (entry.command == NmtCommand::start) entry.command.reset();
    entry.booted_up = true;
    if (!booting_) return;
    if (entry.step != Step::idle || slaves_[i].has(slave_assignment::boot)) {
      identify(i);
    } else {
      guards_[i].stop();
      entry.complete = false;
    }
  }

  /// A slave is lost (CiA 302-2, error handling): all nodes are stopped or reset, or the slave alone is reset.
  void on_lost(NodeId node_id, NmtState state) {
    tell(NmtMasterEvent::lost, node_id, state);
    const std::optional<std::size_t> i = find(node_id);
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

  // Identity

  void release_client() {
    client_.reset();
    active_ = nobody;
  }

  /// Asks one slave after the other: those whose boot-up message has come first.
  void serve_identity() {
    for (;;) {
      if (active_ == nobody) {
        const std::optional<std::size_t> i = next_to_identify();
        if (!i) return;
        active_ = *i;
        next_ = *i + 1;
        client_.emplace(bus_, slaves_[*i].node_id, sdo_timeout_);
        begin_check();
      }
      if (client_->busy()) return;
      take_answer();
    }
  }

  [[nodiscard]] std::optional<std::size_t> next_to_identify() const {
    std::optional<std::size_t> silent;
    for (std::size_t n = 0; n < slaves_.size(); ++n) {
      std::size_t i = next_ + n;
      if (i >= slaves_.size()) i -= slaves_.size();
      if (entries_[i].step != Step::identifying) continue;
      if (entries_[i].booted_up) return i;
      if (!silent) silent = i;
    }
    return silent;
  }

  void begin_check() {
    const IdentityCheck& check = identity_checks[entries_[active_].check];
    (void)client_->upload(check.index, check.sub_index, answer_, now_);
  }

  void take_answer() {
    const std::size_t i = active_;
    const IdentityCheck& check = identity_checks[entries_[i].check];
    const bool answered = client_->result() == ok;
    if (entries_[i].check == 0 && !answered) return on_no_response(i);
    const std::uint32_t expected = slaves_[i].*check.expected;
    if (expected != 0 && (!answered || number_of(client_->data()) != expected)) {
      release_client();
      return finish(i, check.failure);
    }
    do {
      ++entries_[i].check;
    } while (entries_[i].check < checks && slaves_[i].*identity_checks[entries_[i].check].expected == 0);
    if (entries_[i].check < checks) return begin_check();
    release_client();
    start_error_control(i);
  }

  void on_no_response(std::size_t i) {
    release_client();
    entries_[i].booted_up = false;
    wait(i);
    if (entries_[i].status == BootStatus::no_response) return;
    entries_[i].status = BootStatus::no_response;
    host_.booted(slaves_[i].node_id, BootStatus::no_response);
  }

  [[nodiscard]] static std::uint32_t number_of(std::span<const std::uint8_t> bytes) {
    std::uint32_t number = 0;
    for (std::size_t i = bytes.size(); i > 0; --i) number = (number << 8) | bytes[i - 1];
    return number;
  }

  // Sending

  void serve() {
    send_commands();
    serve_identity();
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (entries_[i].step == Step::waiting && now_ >= entries_[i].deadline) identify(i);
      (void)guards_[i].serve(bus_, now_, Watch{*this});
      if (entries_[i].step == Step::starting_error_control) check_error_control(i);
    }
    send_commands();
    serve_identity();
  }

  /// Sends the commands that wait; what finds no room stays.
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
  Duration sdo_timeout_;
  [[no_unique_address]] Host host_;
  std::array<Entry, Count> entries_{};
  std::array<NodeGuardingMaster, Count> guards_{};
  HeartbeatConsumer<Count> heartbeats_{};
  std::optional<Client> client_{};
  std::array<std::uint8_t, 4> answer_{};
  std::array<std::uint32_t, 4> boot_ups_{};  ///< a bit for each node
  std::size_t active_ = nobody;              ///< whom the client asks
  std::size_t next_ = 0;                     ///< whom it asks next, as far as that one is to be asked
  std::optional<NmtCommand> all_command_{};  ///< to all nodes: waits to be sent
  TimePoint boot_deadline_{};
  TimePoint now_{};
  bool booting_ = false;  ///< `start` has been called
  bool network_started_ = false;
  bool boot_time_runs_ = false;
};

/// A master of up to `Count` slaves:
///     auto master = canopen::make_nmt_master<8>(bus, slaves, start_up, 500ms, host);
template <std::size_t Count, Bus B, class Host>
[[nodiscard]] constexpr NmtMaster<B, Count, Host> make_nmt_master(B& bus, std::span<const NmtSlave> slaves,
                                                                  NmtStartUp start_up, Duration sdo_timeout,
                                                                  Host host) {
  return NmtMaster<B, Count, Host>{bus, slaves, start_up, sdo_timeout, std::move(host)};
}

}  // namespace canopen

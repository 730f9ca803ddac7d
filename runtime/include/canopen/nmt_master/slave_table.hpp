/// The slaves of an NMT master, each with its boot-up, its error control and the command that waits for the bus.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master_event.hpp"
#include "canopen/nmt_master/response_count.hpp"
#include "canopen/nmt_master/slave_boot.hpp"
#include "canopen/nmt_master/slave_error_control.hpp"

namespace canopen {

/// Knows what happens to a slave; the master knows what follows for the network and the application.
template <std::size_t Count>
class SlaveTable {
 public:
  using Step = SlaveBoot::Step;

  /// Has the first `Count` slaves of a list, which must outlive the table.
  constexpr explicit SlaveTable(std::span<const NmtSlave> list) : list_{list.first(std::min(list.size(), Count))} {}

  [[nodiscard]] std::size_t size() const { return list_.size(); }

  /// Returns the entry of a slave in the list.
  [[nodiscard]] const NmtSlave& operator[](std::size_t i) const { return list_[i]; }
  [[nodiscard]] std::span<const NmtSlave> list() const { return list_; }

  [[nodiscard]] std::optional<std::size_t> find(NodeId node_id) const {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i].node_id == node_id && list_[i].has(slave_assignment::listed)) return i;
    }
    return std::nullopt;
  }

  [[nodiscard]] SlaveBoot& boot(std::size_t i) { return entries_[i].boot; }
  [[nodiscard]] const SlaveBoot& boot(std::size_t i) const { return entries_[i].boot; }
  [[nodiscard]] ResponseCount& responses(std::size_t i) { return entries_[i].responses; }
  [[nodiscard]] SlaveErrorControl<Count>& error_control() { return error_control_; }
  [[nodiscard]] const SlaveErrorControl<Count>& error_control() const { return error_control_; }

  /// Returns how the last boot-up of a slave ended; empty before that.
  [[nodiscard]] std::optional<BootStatus> status(std::size_t i) const { return entries_[i].status; }
  void set_status(std::size_t i, BootStatus status) { entries_[i].status = status; }

  /// Returns the last state that a slave reported; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(std::size_t i) const { return error_control_.state_of(i, list_[i]); }

  /// Whether a slave has booted and is not lost.
  [[nodiscard]] bool complete(std::size_t i) const { return entries_[i].complete; }
  void set_incomplete(std::size_t i) { entries_[i].complete = false; }

  /// Whether all slaves are complete.
  [[nodiscard]] bool all_complete() const {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i].has(slave_assignment::listed) && !entries_[i].complete) return false;
    }
    return true;
  }

  /// Whether all mandatory slaves are complete.
  [[nodiscard]] bool mandatory_complete() const {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const bool needed = list_[i].has(slave_assignment::listed) && list_[i].has(slave_assignment::mandatory);
      if (needed && !entries_[i].complete) return false;
    }
    return true;
  }

  /// Whether the boot-up of any slave continues with a request.
  [[nodiscard]] bool wants_sdo() const {
    return std::ranges::any_of(entries_, [](const Entry& entry) { return entry.boot.wants_sdo(); });
  }

  // Boot-up

  /// Starts all slaves from the beginning, after a command to all nodes if there is one.
  void restart(std::optional<NmtCommand> to_all, TimePoint now) {
    to_all_ = to_all;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      Entry& entry = entries_[i];
      entry.boot.restart();
      entry.boot.set_reset(to_all.has_value());
      entry.command.reset();
      entry.status.reset();
      entry.complete = false;
      error_control_.stop_guarding(i);
      if (!list_[i].has(slave_assignment::listed)) continue;
      error_control_.watch_heartbeat(i, list_[i]);
      wait(i, now);
    }
  }

  /// Resets a slave and waits for its boot-up message.
  void reset(std::size_t i, NmtCommand command, TimePoint now) {
    error_control_.stop(i, list_[i]);
    entries_[i].command = command;
    entries_[i].complete = false;
    entries_[i].boot.report_reset();
    wait(i, now);
  }

  /// Resets a slave whose boot-up has ended with a fault, and waits for its boot-up message.
  void reset_disturbed(std::size_t i, BootStatus status, TimePoint now) {
    reset(i, NmtCommand::reset_communication, now);
    entries_[i].status = status;
  }

  /// Resets a slave whose default values have been restored; they take effect with the reset (CiA 301, 7.5.2.14).
  void reset_restored(std::size_t i, TimePoint now) {
    constexpr std::uint8_t communication_parameters = 2;
    const bool communication = list_[i].restored_parameters == communication_parameters;
    reset(i, communication ? NmtCommand::reset_communication : NmtCommand::reset_node, now);
    entries_[i].boot.report_restored();
  }

  void identify(std::size_t i) {
    error_control_.stop_guarding(i);
    entries_[i].boot.identify();
    entries_[i].complete = false;
  }

  /// Tries a slave again that has not responded.
  void ask_again(std::size_t i) {
    Entry& entry = entries_[i];
    if (entry.boot.may_be_stopped(list_[i]) && !entry.command) entry.command = NmtCommand::enter_pre_operational;
    identify(i);
  }

  /// Schedules the next attempt for a slave that does not respond; returns whether this is to be reported.
  [[nodiscard]] bool retry(std::size_t i, TimePoint now) {
    entries_[i].boot.report_silence();
    wait(i, now);
    if (entries_[i].status == BootStatus::no_response) return false;
    entries_[i].status = BootStatus::no_response;
    return true;
  }

  void start_error_control(std::size_t i, TimePoint now) {
    SlaveBoot& boot = entries_[i].boot;
    boot.start_error_control(now, now + from_milliseconds(list_[i].heartbeat_time));
    if (list_[i].beats() || !(list_[i].guarded() || boot.may_be_kept_alive(list_[i]))) return;
    error_control_.start_guarding(i, list_[i], now);
    boot.set_deadline(now + longest_span);  // guarding reports a loss
  }

  /// Checks whether the slave has been heard, or its time has elapsed. Returns how its boot-up ends; empty if it goes
  /// on.
  [[nodiscard]] std::optional<BootResult> check_error_control(std::size_t i, TimePoint now) {
    const NmtSlave& slave = list_[i];
    const std::optional<NmtState> heard_state = state(i);
    const bool heard = heard_state && *heard_state != NmtState::initialisation;
    const bool may_be_kept_alive = entries_[i].boot.may_be_kept_alive(slave);
    if (!heard && (slave.watched() || may_be_kept_alive) && now < entries_[i].boot.deadline()) return std::nullopt;
    if (may_be_kept_alive) {
      if (!heard) return BootResult{slave.beats() ? BootStatus::no_state : BootStatus::no_guarding};
      if (*heard_state == NmtState::operational) return BootResult{BootStatus::was_operational};
      reset(i, NmtCommand::reset_communication, now);
      return std::nullopt;
    }
    if (heard || !slave.watched()) return entries_[i].boot.check_error_control(slave, now);
    return BootResult{slave.beats() ? BootStatus::no_heartbeat : BootStatus::no_guarding};
  }

  /// Ends the boot-up of a slave.
  void finish(std::size_t i, BootStatus status, TimePoint now) {
    Entry& entry = entries_[i];
    entry.boot.end();
    entry.status = status;
    entry.complete = status == BootStatus::booted || status == BootStatus::was_operational;
    if (entry.complete) entry.boot.report_complete(now);
    if (!entry.complete || !list_[i].guarded()) error_control_.stop_guarding(i);
    if (status == BootStatus::was_operational) error_control_.expect_after(NmtCommand::start, i);
  }

  // Commands

  /// Sends a command to one node, or to all nodes with node-ID 0. Returns false if the bus had no room; it is not sent.
  template <Bus BusType>
  [[nodiscard]] bool send(BusType& bus, NmtCommand command, NodeId node_id) {
    if (!bus.send(nmt_frame(command, node_id))) return false;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (node_id.value() != 0 && list_[i].node_id != node_id) continue;
      error_control_.expect_after(command, i);
      entries_[i].boot.report_command();
      const bool resets = command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
      if (resets) entries_[i].boot.expect_boot_up();
    }
    return true;
  }

  /// Queues a command to all nodes, or to a slave. It replaces one that is waiting.
  void command_all(NmtCommand command) { to_all_ = command; }
  void command(std::size_t i, NmtCommand command) { entries_[i].command = command; }

  [[nodiscard]] bool all_commanded() const { return to_all_.has_value(); }
  [[nodiscard]] bool commanded(std::size_t i) const { return entries_[i].command.has_value(); }

  /// Discards a waiting command that a slave would get after a boot-up that has been overtaken by another one.
  void discard_command(std::size_t i) {
    std::optional<NmtCommand>& command = entries_[i].command;
    if (command == NmtCommand::start || command == NmtCommand::enter_pre_operational) command.reset();
  }

  /// Sends waiting commands; those for which the bus has no room keep waiting.
  template <Bus BusType>
  void send_commands(BusType& bus) {
    if (to_all_) {
      if (!send(bus, *to_all_, NodeId{})) return;
      to_all_.reset();
    }
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (!entries_[i].command) continue;
      if (!send(bus, *entries_[i].command, list_[i].node_id)) return;
      entries_[i].command.reset();
    }
  }

  /// Whether a command is waiting.
  [[nodiscard]] bool has_command() const {
    return to_all_ || std::ranges::any_of(entries_, [](const Entry& entry) { return entry.command.has_value(); });
  }

  /// Returns when the next slave is due, by guarding or because waiting for it ends.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next = error_control_.next_heartbeat();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    for (std::size_t i = 0; i < list_.size(); ++i) {
      consider(error_control_.next_guarding(i));
      if (entries_[i].boot.has_deadline()) consider(entries_[i].boot.deadline());
    }
    return next;
  }

 private:
  static constexpr Duration retry_time = std::chrono::seconds{1};

  struct Entry {
    SlaveBoot boot{};
    ResponseCount responses{};
    std::optional<NmtCommand> command{};  ///< waiting to be sent
    std::optional<BootStatus> status{};
    bool complete = false;
  };

  void wait(std::size_t i, TimePoint now) { entries_[i].boot.wait(now + retry_time); }

  std::span<const NmtSlave> list_;
  std::array<Entry, Count> entries_{};
  SlaveErrorControl<Count> error_control_{};
  std::optional<NmtCommand> to_all_{};
};

}  // namespace canopen

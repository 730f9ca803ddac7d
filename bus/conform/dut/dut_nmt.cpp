/// The NMT state of the device: commands, and what error control reports.
#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt_master/nmt_master.hpp>

#include "conform/dut/dut.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::uint16_t heartbeat_time = 0x1017, guard_time = 0x100C;
constexpr std::uint64_t watched_heartbeat_ms = 100;

/// The time that a device may need to follow an NMT command. CiA 301 does not specify a limit.
constexpr Duration to_follow = milliseconds{50};
/// The time that a device may need to start.
constexpr Duration to_start = milliseconds{5000};

}  // namespace

void Dut::nmt(NmtCommand command) {
  const bool resets = command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  if (resets) {
    remember_configuration();
    was_reset_ = true;
  }
  state_changed_ = true;
  send(canopen::nmt_frame(command, node()));
}

void Dut::reset(NmtCommand command) {
  nmt(command);
  const auto started = wait_for(boot_up(), to_start);
  expect(started.has_value(), "a boot-up message within " + milliseconds_text(to_start.count()), "none");
  pass_time(to_follow);
}

void Dut::enter(NmtState state) {
  switch (state) {
    case NmtState::operational: nmt(NmtCommand::start); break;
    case NmtState::stopped: nmt(NmtCommand::stop); break;
    case NmtState::pre_operational: nmt(NmtCommand::enter_pre_operational); break;
    case NmtState::initialisation: return reset(NmtCommand::reset_node);
  }
  pass_time(to_follow);
}

bool Dut::watch_state() {
  if (is_readable(heartbeat_time)) {
    const std::uint64_t period = read_number(heartbeat_time);
    if (period == 0 || period > watched_heartbeat_ms) {
      if (!is_writable(heartbeat_time)) return period != 0;
      write(heartbeat_time, 0, watched_heartbeat_ms);
    }
    guarded_ = false;
    return true;
  }
  guarded_ = has(guard_time);
  return guarded_;
}

std::optional<NmtState> Dut::state() {
  constexpr Duration several_heartbeats = milliseconds{5 * watched_heartbeat_ms};
  const Mark since = mark();
  if (guarded_) send_remote(0x700U + node().value(), 1);
  const auto seen = wait_for(heartbeat(), std::max(several_heartbeats, tolerance()), since);
  if (!seen) return std::nullopt;
  const auto message = canopen::error_control_message(seen->frame);
  if (!message) return std::nullopt;
  return message->state;
}

void Dut::expect_state(NmtState expected) {
  const auto found = state();
  expect(found == expected, fmt::format("an error control message with the state {}", canopen::to_text(expected)),
         found ? std::string{canopen::to_text(*found)} : "none");
}

}  // namespace edsc::conform

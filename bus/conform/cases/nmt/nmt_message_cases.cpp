/// NMT messages that do not concern the device, or that CiA 301 does not define (7.2.8.3.1), and the state after an
/// error of communication (7.5.2.32).
#include <fmt/format.h>

#include "conform/case.hpp"
#include "conform/cases/nmt/heartbeat_source.hpp"

namespace edsc::conform {
namespace {

constexpr std::uint8_t all_nodes = 0;

void need_error_control(Dut& dut) {
  if (!dut.watch_state()) {
    dut.inconclusive("the EDS has neither heartbeat nor node guarding: the device does not report its NMT state");
  }
}

/// The state in which a check begins. Other cases test that an NMT command leads to it.
void need_state(Dut& dut, NmtState state) {
  if (dut.state() == state) return;
  dut.inconclusive(Condition::state, fmt::format("the device is not in the state {}", to_text(state)));
}

/// The device is in the state, and does not restart, after these bytes with CAN-ID 0.
void expect_ignored(Dut& dut, NmtState state, const Bytes& message) {
  const Dut::Mark since = dut.mark();
  dut.send(0, message);
  dut.pass_time(milliseconds{50});
  const std::string what = fmt::format("the NMT message {}", hex_bytes(message));
  dut.expect(dut.received_since(since, dut.boot_up()).empty(), "no boot-up message after " + what, "one");
  const auto found = dut.state();
  dut.expect(found == state, fmt::format("the state {} after {}", to_text(state), what),
             found ? std::string{to_text(*found)} : "no error control message");
}

/// Runs a check in Operational and in Stopped.
template <class Check>
void in_two_states(Dut& dut, Check check) {
  dut.enter(NmtState::pre_operational);
  need_error_control(dut);
  for (const NmtState state : {NmtState::operational, NmtState::stopped}) {
    dut.enter(state);
    need_state(dut, state);
    check(state);
  }
}

constexpr std::uint8_t unknown_commands[] = {0, 3, 16, 127, 131, 255};

void unknown_command(Dut& dut) {
  const std::uint8_t node = dut.node().value();
  in_two_states(dut, [&](NmtState state) {
    for (const std::uint8_t command : unknown_commands) expect_ignored(dut, state, {command, node});
  });
}

constexpr NmtCommand every_command[] = {NmtCommand::start, NmtCommand::stop, NmtCommand::enter_pre_operational,
                                        NmtCommand::reset_node, NmtCommand::reset_communication};

void other_node(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const std::uint8_t other = free_node_id(dut).value();
  in_two_states(dut, [&](NmtState state) {
    for (const NmtCommand command : every_command) {
      expect_ignored(dut, state, {static_cast<std::uint8_t>(command), other});
    }
  });
}

/// A message without node-ID is not for this node.
void short_message(Dut& dut) {
  need_no_other_node(dut);
  in_two_states(dut, [&](NmtState state) {
    for (const NmtCommand command : every_command) expect_ignored(dut, state, {static_cast<std::uint8_t>(command)});
    expect_ignored(dut, state, {});
  });
}

void to_all_nodes(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  need_error_control(dut);
  for (const auto& [command, state] : {std::pair{NmtCommand::start, NmtState::operational},
                                       {NmtCommand::stop, NmtState::stopped},
                                       {NmtCommand::enter_pre_operational, NmtState::pre_operational}}) {
    dut.enter(state);
    need_state(dut, state);
    dut.enter(state == NmtState::pre_operational ? NmtState::operational : NmtState::pre_operational);
    dut.send(0, Bytes{static_cast<std::uint8_t>(command), all_nodes});
    dut.pass_time(milliseconds{50});
    dut.expect_state(state);
  }
}

// ---- the state after a heartbeat event ----

/// A row of 1029h:01: the state of an Operational device after an error of communication.
struct ErrorBehavior {
  std::uint8_t value;
  NmtState state;
};

constexpr ErrorBehavior error_behaviors[] = {
    {0, NmtState::pre_operational}, {1, NmtState::operational}, {2, NmtState::stopped}};

void expect_behavior(Dut& dut, const HeartbeatSource& source, const ErrorBehavior& row, const std::string& with) {
  constexpr Duration watched = milliseconds{200};
  dut.enter(NmtState::pre_operational);
  source.watch(watched);
  dut.enter(NmtState::operational);
  source.beat();
  need_state(dut, NmtState::operational);
  dut.pass_time(watched * 2);
  const auto found = dut.state();
  dut.expect(found == row.state, fmt::format("the state {} after a lost heartbeat {}", to_text(row.state), with),
             found ? std::string{to_text(*found)} : "no error control message");
  dut.enter(NmtState::pre_operational);
  source.beat();  // ends the event in most devices
  source.unwatch();
}

void behavior_after_error(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  const HeartbeatSource source{dut};
  need_error_control(dut);
  and_undo(
      [&] {
        if (!dut.has(error_behavior, 1)) {
          return expect_behavior(dut, source, error_behaviors[0], "without 1029h");
        }
        dut.need_writable(error_behavior, 1);
        for (const ErrorBehavior& row : error_behaviors) {
          const SdoOutcome outcome = dut.download(error_behavior, 1, row.value);
          if (!outcome.done()) {
            dut.expect_abort(outcome, abort_rule::value, fmt::format("{} to 1029h:01", row.value));
            continue;  // an optional value
          }
          expect_behavior(dut, source, row, fmt::format("with 1029h:01 = {}", row.value));
        }
      },
      [&] { end_errors(dut); });
}

constexpr CaseRow error_behavior_rows[] = {
    {"9.101", "After a lost heartbeat an Operational device enters the state of 1029h", "CiA 301, 7.5.2.32",
     Level::communication, Permission::none, behavior_after_error,
     Condition::error_free | Condition::punctual | Condition::alone, "7.106"},
};

constexpr CaseRow nmt_message_rows[] = {
    {"10.101", "An NMT message with an unknown command specifier is ignored", "CiA 301, 7.2.8.3.1",
     Level::communication, Permission::none, unknown_command, Condition::error_free},
    {"10.102", "An NMT message for another node is ignored", "CiA 301, 7.2.8.3.1", Level::communication,
     Permission::none, other_node, Condition::error_free | Condition::alone},
    {"10.103", "An NMT message without a node-ID is ignored", "CiA 301, 7.2.8.3.1", Level::communication,
     Permission::none, short_message, Condition::error_free | Condition::alone},
    {"10.104", "An NMT message with node-ID 0 is for each node", "CiA 301, 7.2.8.3.1", Level::communication,
     Permission::none, to_all_nodes, Condition::error_free | Condition::alone},
};

}  // namespace

std::span<const CaseRow> error_behavior_cases() { return error_behavior_rows; }
std::span<const CaseRow> nmt_message_cases() { return nmt_message_rows; }

}  // namespace edsc::conform

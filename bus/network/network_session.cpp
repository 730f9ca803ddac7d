#include "network/network_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt_master/nmt_master.hpp>
#include <utility>

#include "configure/configuration_report.hpp"
#include "network/node_configuration.hpp"
#include "online/scan.hpp"

namespace edsc {
namespace {

/// For the response of a second node with the node-ID, and for boot-up messages.
constexpr canopen::Duration settling_time = canopen::from_milliseconds(50);

constexpr std::uint16_t producer_heartbeat_time = 0x1017;

canopen::NodeId id_of(const LiveNode& live) { return canopen::NodeId{live.node->node_id}; }

/// The time after which no response to a request arrives any more.
canopen::Duration forgotten_after(const std::vector<LiveNode>& nodes, const SdoSettings& sdo) {
  unsigned longest_ms = sdo.timeout_ms;
  for (const LiveNode& live : nodes) longest_ms = std::max(longest_ms, live.sdo_timeout_ms.value_or(0));
  return canopen::Duration{2 * 1000 * longest_ms};
}

/// `at 2004h:00 Speed`: the place in the configuration, for a node that was lost.
std::string place_text(const ConfigurationResult& result) {
  return result.lost_at ? " at " + title(*result.lost_at) : std::string{};
}

}  // namespace

NetworkSession::NetworkSession(LiveBus& bus, std::vector<LiveNode>& nodes, SdoSettings sdo, NetworkHooks hooks)
    : bus_{bus}, nodes_{nodes}, hooks_{std::move(hooks)}, sdo_{sdo}, watch_{bus, forgotten_after(nodes, sdo)} {
  for (LiveNode& live : nodes_) {
    SdoSettings of_node = sdo;
    of_node.timeout_ms = live.sdo_timeout_ms.value_or(sdo.timeout_ms);
    live.access = std::make_unique<SdoAccess>(bus_, id_of(live), of_node);
  }
}

bool NetworkSession::identify(bool wakes) {
  for (LiveNode& live : nodes_) {
    hooks_.progress(live, "identified", 0, 1);
    identify(live, wakes);
  }
  bus_.listen(settling_time);
  check_extra_responses();
  return !has_problems();
}

void NetworkSession::identify(LiveNode& live, bool wakes) {
  SdoAccess& access = *live.access;
  SdoOutcome first = access.upload(0x1000, 0);
  if (first.end == SdoEnd::no_answer && wakes) {
    enter_pre_operational(bus_, id_of(live));
    first = access.upload(0x1000, 0);
  }
  live.answers = first.end != SdoEnd::no_answer;
  if (!live.answers) return add_problem(live, " does not answer");
  const auto [found, unanswered] = read_identity(access);
  live.identity = found;
  if (unanswered != nullptr) {
    return add_problem(live, fmt::format(" cannot be identified: {} {}: no answer",
                                         entry_label(unanswered->index, unanswered->sub_index), unanswered->name));
  }
  const Identity expected = expected_identity(*live.node);
  const IdentityMatch match = compare_identity(expected, live.identity);
  if (match == IdentityMatch::unknown && has_numbers(expected)) {
    add_problem(
        live, fmt::format(" cannot be identified: it reports none of the numbers that {} states", file_of(*live.node)));
  }
  if (match == IdentityMatch::major_revision || match == IdentityMatch::other) {
    live.problems.push_back({fmt::format("{} is not the device of {}: {}", label(*live.node), file_of(*live.node),
                                         identity_differences(expected, live.identity)),
                             place_of_difference(*live.node, expected, live.identity)});
  }
}

void NetworkSession::check_extra_responses() {
  for (LiveNode& live : nodes_) {
    if (!live.problems.empty() || !watch_.has_extra_responses(live.node->node_id)) continue;
    add_problem(live, ": " + extra_responses_text(live.node->node_id));
  }
}

/// Another master may have started a node that was not completely configured.
void NetworkSession::check_foreign_commands() {
  for (LiveNode& live : nodes_) {
    if (!live.succeeded() || watch_.foreign_commands(live.node->node_id) == live.foreign_commands) continue;
    add_problem(live, " received a command of another NMT master while it was configured");
  }
}

bool NetworkSession::compare() {
  for (LiveNode& live : nodes_) {
    if (live.problems.empty()) compare(live);
  }
  check_extra_responses();
  return !has_problems();
}

void NetworkSession::compare(LiveNode& live) {
  live.run = {};
  live.run.node = live.node->node_id;
  live.run.left_out = live.configuration.left_out;
  live.boot_ups = watch_.boot_ups(live.node->node_id);
  live.foreign_commands = watch_.foreign_commands(live.node->node_id);
  if (!choose_different(live.run, *live.access, live.configuration, false, hooks_for(live, "compared"))) {
    return add_problem(live, " no longer answers" + place_text(live.run.result));
  }
  live.run.steps = plan_configuration(live.run.values, &live.node->device());
  live.is_compared = true;
  hooks_.compared(live);
}

bool NetworkSession::apply(const ApplySettings& settings) {
  const bool writes = std::ranges::any_of(nodes_, [](const LiveNode& live) { return !live.run.steps.empty(); });
  if (writes) {
    for (const LiveNode& live : nodes_) enter_pre_operational(bus_, id_of(live));
  }
  configure_all(settings);
  bus_.listen(settling_time);
  check_restarts(settings);
  if (settings.store && (all_succeeded() || settings.on_error == OnError::keep_going)) store_all();
  if (all_succeeded()) {
    check_values();
    check_heartbeats();
  } else {
    check_presence();
  }
  bus_.listen(settling_time);
  check_restarts({});
  check_extra_responses();
  check_foreign_commands();
  if (!all_succeeded()) return false;
  if (settings.start) start_all();
  return true;
}

void NetworkSession::store_all() {
  for (LiveNode& live : nodes_) {
    if (!live.succeeded()) continue;
    hooks_.progress(live, "stored", 0, 1);
    const unsigned timeout_ms = live.sdo_timeout_ms.value_or(sdo_.timeout_ms);
    try {
      store_parameters(live.run, *live.access, timeout_ms);
    } catch (...) {
      add_problem(live, " may not have stored its parameters");
      throw;
    }
    live.access->set_timeout(timeout_ms);
  }
}

/// A node may have lost power since it was configured.
void NetworkSession::check_presence() {
  for (LiveNode& live : nodes_) {
    if (!live.succeeded()) continue;
    if (live.access->upload(0x1000, 0).end == SdoEnd::no_answer) add_problem(live, " no longer answers");
  }
}

/// A node may have lost power since it was configured, and its boot-up message may not have been received.
void NetworkSession::check_values() {
  for (LiveNode& live : nodes_) {
    ConfigurationRun again;
    if (!choose_different(again, *live.access, live.configuration, false, hooks_for(live, "checked"))) {
      add_problem(live, " no longer answers" + place_text(again.result));
      continue;
    }
    for (const ConfigurationChange& change : again.changes) {
      if (!change.before) continue;  // a write-only entry
      add_problem(live, fmt::format(" no longer has its configuration: {} is {}, expected {}",
                                    title(change.value.entry), found_text(change), wanted_text(change)));
    }
    if (live.access->upload(0x1000, 0).end == SdoEnd::no_answer) add_problem(live, " no longer answers");
  }
}

/// Two nodes with one node-ID send more heartbeats than one.
void NetworkSession::check_heartbeats() {
  for (const LiveNode& live : nodes_) {
    const SdoOutcome time = live.access->upload(producer_heartbeat_time, 0);
    const bool is_number = time.done() && time.bytes.size() >= sizeof(std::uint16_t);
    watch_.measure_heartbeats(live.node->node_id,
                              is_number ? static_cast<std::uint16_t>(time.bytes[0] | time.bytes[1] << 8) : 0);
  }
  const auto is_open = [&](const LiveNode& live) {
    const canopen::HeartbeatRate& rate = watch_.heartbeat_rate(live.node->node_id);
    return rate.is_measured() && (!rate.begun() || rate.verdict(bus_.now()) == canopen::HeartbeatRate::Verdict::open);
  };
  constexpr canopen::Duration longest = canopen::from_milliseconds(4000);
  const canopen::TimePoint end = bus_.now() + longest;
  while (bus_.now() < end && std::ranges::any_of(nodes_, is_open)) bus_.listen(canopen::from_milliseconds(10));
  for (LiveNode& live : nodes_) {
    const canopen::HeartbeatRate& rate = watch_.heartbeat_rate(live.node->node_id);
    if (rate.is_measured() && !rate.begun()) {
      add_problem(live, fmt::format(" does not send heartbeats, but 1017h is {} ms", rate.producer_time()));
      continue;
    }
    switch (rate.verdict(bus_.now())) {
      case canopen::HeartbeatRate::Verdict::open:
      case canopen::HeartbeatRate::Verdict::right: break;
      case canopen::HeartbeatRate::Verdict::wrong:
        add_problem(live, fmt::format(" does not send its heartbeats at the rate of 1017h: expected {} ms, seen {} ms",
                                      rate.producer_time(), rate.measured_time(bus_.now())));
        break;
      case canopen::HeartbeatRate::Verdict::states:
        add_problem(live, " sends heartbeats with different states; two nodes may have its node-ID");
        break;
    }
  }
}

void NetworkSession::start_all() {
  for (LiveNode& live : nodes_) {
    bus_.send_all(canopen::nmt_frame(canopen::NmtCommand::start, id_of(live)));
    live.started = true;
  }
}

void NetworkSession::configure_all(const ApplySettings& settings) {
  for (LiveNode& live : nodes_) {
    try {
      configure(live, settings);
    } catch (...) {
      add_problem(live, " is not completely configured");
      throw;
    }
    hooks_.configured(live);
    if (!live.succeeded() && settings.on_error != OnError::keep_going) return;
  }
}

void NetworkSession::configure(LiveNode& live, const ApplySettings& settings) {
  const unsigned most = settings.on_error == OnError::retry ? settings.retries + 1 : 1;
  do {
    live.problems.clear();
    ++live.attempts;
    if (live.attempts > 1) begin_again(live);
    if (live.problems.empty()) write(live);
  } while (!live.succeeded() && live.attempts < most);
}

/// The node may be another one by now.
void NetworkSession::begin_again(LiveNode& live) {
  enter_pre_operational(bus_, id_of(live));
  identify(live, false);
  if (live.problems.empty()) compare(live);
}

void NetworkSession::write(LiveNode& live) {
  ConfigurationRun& run = live.run;
  run.result = configure_node(*live.access, run.steps, hooks_for(live, "done"));
  if (run.result.done()) write_time(run, *live.access, live.configuration);
  if (has_restarted(live)) {
    add_problem(live, fmt::format(" restarted{} while it was configured: it may have lost what was written",
                                  place_text(run.result)));
  }
  check_extra_responses();
}

/// Nodes that restarted after they were configured are configured again, or have a problem.
void NetworkSession::check_restarts(const ApplySettings& settings) {
  for (LiveNode& live : nodes_) {
    if (!live.succeeded() || !has_restarted(live)) continue;
    if (settings.on_error == OnError::retry && live.attempts <= settings.retries) {
      configure(live, settings);
      hooks_.configured(live);
    } else {
      add_problem(live, " restarted after it was configured: it may have lost what was written");
    }
  }
}

/// A problem of the node as a whole; `text` follows its name.
void NetworkSession::add_problem(LiveNode& live, std::string_view text) {
  live.problems.push_back({label(*live.node).append(text), live.node->position});
}

bool NetworkSession::has_restarted(const LiveNode& live) const {
  return watch_.boot_ups(live.node->node_id) != live.boot_ups;
}

bool NetworkSession::has_problems() const {
  return std::ranges::any_of(nodes_, [](const LiveNode& live) { return !live.problems.empty(); });
}

bool NetworkSession::all_succeeded() const { return std::ranges::all_of(nodes_, &LiveNode::succeeded); }

ConfigurationHooks NetworkSession::hooks_for(const LiveNode& live, std::string_view doing) const {
  return {[this, &live, doing](std::size_t done, std::size_t of) { hooks_.progress(live, doing, done, of); },
          [this, &live] { return has_restarted(live); }};
}

}  // namespace edsc

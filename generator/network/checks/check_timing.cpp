#include <fmt/format.h>

#include <algorithm>

#include "network/checks/check_groups.hpp"
#include "network/checks/merged_note.hpp"
#include "network/timing/timing.hpp"

namespace edsc {
namespace {

std::string milliseconds_text(Nanoseconds time) {
  return fmt::format("{:.3f} ms", std::chrono::duration<double, std::milli>{time}.count());
}

void check_load(const NetworkContext& context, const BusLoad& load) {
  const NetworkDescription& description = context.network.description;
  const double percent = load.max * 100;
  const unsigned limit = description.max_load ? description.max_load->value : default_max_load;
  const std::string text = fmt::format("the bus load is up to {:.1f} % ({:.1f} % without stuff bits) at {} kbit/s",
                                       percent, load.min * 100, description.bit_rate->value);
  if (percent > 100) {
    context.diagnostics.error("network-load", description.bit_rate->position, text);
  } else if (percent > limit) {
    context.diagnostics.warning("network-load", description.bit_rate->position,
                                fmt::format("{}; the limit is {} %", text, limit));
  }
}

void check_response(const NetworkContext& context, const TimedMessage& one) {
  if (one.has_assumed_period || one.response.meets_deadline || !one.response.worst) return;
  const std::string can_id = can_id_text(one.message.can_id, one.message.extended);
  const std::string worst = milliseconds_text(*one.response.worst);
  const std::string deadline = milliseconds_text(deadline_of(one.message));
  if (one.is_synchronous) {
    context.diagnostics.error("network-sync-window", one.position,
                              fmt::format("{} ({}) may end {} after SYNC was due, outside the synchronous window or "
                                          "period of {}",
                                          one.name, can_id, worst, deadline));
  } else {
    context.diagnostics.error("network-response-time", one.position,
                              fmt::format("{} ({}) may end {} after its event, later than its deadline of {}", one.name,
                                          can_id, worst, deadline));
  }
}

}  // namespace

void check_timing(const NetworkContext& context) {
  const NetworkTiming timing = network_timing(context.network, context.uses);
  if (timing.messages.empty()) return;
  check_load(context, timing.load);
  MergedNote assumed;
  for (const TimedMessage& one : timing.messages) {
    check_response(context, one);
    if (one.service != FrameService::pdo || !one.may_be_sent_earlier) continue;
    assumed.add("network-event-rate", one.position,
                one.has_assumed_period
                    ? fmt::format("{} has neither inhibit time nor event timer; assuming {}", one.name,
                                  milliseconds_text(one.message.period))
                    : fmt::format("{} has no inhibit time: an event may send it before its event timer of {} ends",
                                  one.name, milliseconds_text(one.message.period)));
  }
  assumed.report(context.diagnostics);
}

}  // namespace edsc

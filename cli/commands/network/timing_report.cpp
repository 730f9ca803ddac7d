#include "commands/network/timing_report.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "text/counted.hpp"
#include "text/text_table.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

std::string milliseconds_text(Nanoseconds time) {
  return fmt::format("{:.3f}", static_cast<double>(time.count()) / 1e6);
}

Json microseconds_json(Nanoseconds time) { return static_cast<double>(time.count()) / 1e3; }

std::string bound_text(const ResponseTime& response) {
  if (response.worst) return milliseconds_text(*response.worst);
  return response.bound == ResponseBound::overload ? "overload" : "not found";
}

/// The message with the least time between its worst response and its deadline; null without a bound.
const TimedMessage* nearest_to_deadline(const NetworkTiming& timing) {
  const auto reserve = [](const TimedMessage& one) { return deadline_of(one.message) - *one.response.worst; };
  const TimedMessage* nearest = nullptr;
  for (const TimedMessage& one : timing.messages) {
    if (!one.response.worst || one.has_assumed_period) continue;
    if (nearest == nullptr || reserve(one) < reserve(*nearest)) nearest = &one;
  }
  return nearest;
}

Json message_json(const TimedMessage& one) {
  return {{"name", one.name},
          {"can_id", one.message.can_id},
          {"extended", one.message.extended},
          {"remote", one.message.remote},
          {"bytes", one.message.size},
          {"period_us", microseconds_json(one.message.period)},
          {"assumed_period", one.has_assumed_period},
          {"synchronous", one.is_synchronous},
          {"transmission_us", microseconds_json(one.response.transmission)},
          {"worst_us", one.response.worst ? microseconds_json(*one.response.worst) : Json(nullptr)},
          {"deadline_us", microseconds_json(deadline_of(one.message))},
          {"meets_deadline", one.response.meets_deadline}};
}

}  // namespace

TimingReport::TimingReport(const Network& network)
    : network_{network},
      uses_{cob_id_uses(network)},
      timing_{network_timing(network, uses_)},
      sync_{sync_timing(uses_, timing_)} {}

std::vector<std::string> TimingReport::summary() const {
  if (timing_.messages.empty()) return {};
  const unsigned bit_rate = network_.description.bit_rate->value;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("load of {} at {} kbit/s: {:.1f} to {:.1f} % (without and with all stuff bits)",
                              counted(network_.nodes.size(), "node"), bit_rate, timing_.load.min * 100,
                              timing_.load.max * 100));
  if (sync_ && sync_->pdos > 0) {
    lines.push_back(fmt::format(
        "SYNC cycle of {} ms: {} end {}; a rule of thumb gives a cycle of {} ms", milliseconds_text(sync_->period),
        counted(sync_->pdos, "synchronous PDO"),
        sync_->is_bounded ? fmt::format("after at most {} ms", milliseconds_text(sync_->last_end)) : "without a bound",
        milliseconds_text(rule_of_thumb_period(sync_->pdos, bit_rate))));
  }
  if (const TimedMessage* const nearest = nearest_to_deadline(timing_)) {
    lines.push_back(fmt::format("nearest to its deadline: {}, at most {} of {} ms", nearest->name,
                                milliseconds_text(*nearest->response.worst),
                                milliseconds_text(deadline_of(nearest->message))));
  }
  return lines;
}

std::vector<std::string> TimingReport::table() const {
  if (timing_.messages.empty()) return {};
  TextTable table;
  table.add({"CAN-ID", "message", "bytes", "period ms", "frame ms", "worst ms", "deadline ms", ""});
  for (const TimedMessage& one : timing_.messages) {
    table.add({can_id_text(one.message.can_id, one.message.extended), one.name,
               one.message.remote ? "remote" : std::to_string(one.message.size),
               milliseconds_text(one.message.period) + (one.has_assumed_period ? " assumed" : ""),
               milliseconds_text(one.response.transmission), bound_text(one.response),
               milliseconds_text(deadline_of(one.message)), one.response.meets_deadline ? "" : "missed"});
  }
  return table.lines();
}

Json TimingReport::json() const {
  Json messages = Json::array();
  for (const TimedMessage& one : timing_.messages) messages.push_back(message_json(one));
  Json sync = nullptr;
  if (sync_) {
    const Nanoseconds rule = rule_of_thumb_period(sync_->pdos, network_.description.bit_rate->value);
    sync = {{"period_us", microseconds_json(sync_->period)},
            {"window_us", microseconds_json(sync_->window)},
            {"pdos", sync_->pdos},
            {"worst_us", sync_->is_bounded ? microseconds_json(sync_->last_end) : Json(nullptr)},
            {"rule_of_thumb_us", microseconds_json(rule)}};
  }
  return {{"file", network_.source->name()},
          {"nodes", network_.nodes.size()},
          {"bit_rate", network_.description.bit_rate ? Json(network_.description.bit_rate->value) : Json(nullptr)},
          {"load_percent", {{"min", timing_.load.min * 100}, {"max", timing_.load.max * 100}}},
          {"sync", std::move(sync)},
          {"messages", std::move(messages)}};
}

}  // namespace edsc

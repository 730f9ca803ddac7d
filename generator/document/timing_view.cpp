#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "document/views.hpp"
#include "network/timing/sync_timing.hpp"
#include "network/timing/timing.hpp"
#include "text/counted.hpp"

namespace edsc::document {
namespace {

/// The drawing of the SYNC cycle in units of SVG.
constexpr double cycle_left = 190;
constexpr double cycle_width = 640;
constexpr std::size_t cycle_head = 26;
constexpr std::size_t cycle_row = 22;
constexpr std::size_t max_cycle_label = 27;

double milliseconds(Nanoseconds time) { return static_cast<double>(time.count()) / 1e6; }

std::string time_text(Nanoseconds time) { return fmt::format("{:.3f} ms", milliseconds(time)); }

std::string bound_text(const ResponseTime& response) {
  switch (response.bound) {
    case ResponseBound::found: return response.worst ? time_text(*response.worst) : "";
    case ResponseBound::overload: return "not bounded: overload";
    case ResponseBound::not_found: return "not found";
  }
  return "";
}

std::string percent(double part) { return fmt::format("{:.1f} %", part * 100); }

/// The part of the bus that a message needs, with the largest number of stuff bits.
std::string load_text(const TimedMessage& one) {
  if (one.message.period == Nanoseconds{}) return "";
  return percent(milliseconds(one.response.transmission) / milliseconds(one.message.period));
}

Json message_view(const TimedMessage& one) {
  return {{"can_id", can_id_text(one.message.can_id, one.message.extended)},
          {"message", one.name},
          {"data", one.message.remote ? std::string{"remote"} : fmt::format("{}", one.message.size)},
          {"period", time_text(one.message.period)},
          {"assumed", one.has_assumed_period},
          {"transmission", time_text(one.response.transmission)},
          {"load", load_text(one)},
          {"worst", bound_text(one.response)},
          {"deadline", time_text(deadline_of(one.message))},
          {"verdict", one.response.meets_deadline ? "yes" : "no"},
          {"class", one.response.meets_deadline ? "met" : "missed"}};
}

/// The cycle as a drawing: the frames after SYNC in the order of their priority, and the latest end of each.
class SyncCycle {
 public:
  SyncCycle(Nanoseconds period, Nanoseconds window, const NetworkTiming& timing)
      : period_{period}, window_{window}, timing_{timing} {}

  [[nodiscard]] Json drawing() const {
    Json rows = Json::array();
    Nanoseconds at{};
    std::string label = fmt::format("SYNC cycle of {}.", time_text(period_));
    for (const TimedMessage& one : timing_.messages) {
      if (one.service != FrameService::sync && !one.is_synchronous) continue;
      rows.push_back(row_view(one, at, rows.size()));
      label += fmt::format(" {}: worst response time {}.", one.name, bound_text(one.response));
      at += one.response.transmission;
    }
    const std::size_t height = cycle_head + rows.size() * cycle_row + 8;
    return {{"cycle_label", label},
            {"cycle_text", time_text(period_)},
            {"window_text", window_ == Nanoseconds{} ? Json(nullptr) : Json(time_text(window_))},
            {"cycle_width", static_cast<unsigned>(cycle_left + cycle_width + 20)},
            {"cycle_height", height},
            {"cycle_bottom", height - 4},
            {"marks", marks()},
            {"window_x", window_ == Nanoseconds{} ? Json(nullptr) : number(x_of(window_))},
            {"cycle_rows", std::move(rows)}};
  }

 private:
  [[nodiscard]] static Json number(double value) { return fmt::format("{:.1f}", value); }

  /// Times after the end of the cycle are at its end.
  [[nodiscard]] double x_of(Nanoseconds time) const {
    return cycle_left + cycle_width * std::min(1.0, milliseconds(time) / milliseconds(period_));
  }

  [[nodiscard]] Json marks() const {
    Json marks = Json::array();
    constexpr int parts = 4;
    for (int part = 0; part <= parts; ++part) {
      const Nanoseconds time = period_ * part / parts;
      marks.push_back({{"mark_x", number(x_of(time))}, {"mark_text", fmt::format("{} ms", milliseconds(time))}});
    }
    return marks;
  }

  [[nodiscard]] Json row_view(const TimedMessage& one, Nanoseconds at, std::size_t row) const {
    const double begin = x_of(at);
    const double end = x_of(at + one.response.transmission);
    const std::size_t top = cycle_head + row * cycle_row;
    const std::int64_t cycles = std::max<std::int64_t>(1, one.message.period / period_);
    const std::string name = cycles == 1 ? one.name : fmt::format("{}, every {}", one.name, cycles);
    return {{"cycle_name", shortened(name, max_cycle_label)},
            {"cycle_message", fmt::format("{}: {}", one.name, bound_text(one.response))},
            {"bar_x", number(begin)},
            {"bar_y", top + 4},
            {"bar_width", number(std::max(1.5, end - begin))},
            {"middle", top + 11},
            {"text_y", top + 15},
            {"bar_end", number(end)},
            {"worst_x", one.response.worst ? number(x_of(*one.response.worst)) : Json(nullptr)},
            {"worst_top", top + 6},
            {"worst_bottom", top + 16}};
  }

  Nanoseconds period_, window_;
  const NetworkTiming& timing_;
};

Json sync_view(const Network& network, const std::vector<CobIdUse>& uses, const NetworkTiming& timing) {
  const auto sync = sync_timing(uses, timing);
  if (!sync) return nullptr;
  Json view = SyncCycle{sync->period, sync->window, timing}.drawing();
  if (sync->pdos > 0) {
    view["rule_of_thumb"] = time_text(rule_of_thumb_period(sync->pdos, network.description.bit_rate->value));
    view["synchronous_pdos"] = counted(sync->pdos, "PDO");
  }
  return view;
}

}  // namespace

void add_timing(const Network& network, Json& view) {
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  const NetworkTiming timing = network_timing(network, uses);
  Json messages = Json::array();
  for (const TimedMessage& one : timing.messages) messages.push_back(message_view(one));
  view["sync"] = sync_view(network, uses, timing);
  view["has_messages"] = !messages.empty();
  const auto missed = static_cast<std::size_t>(
      std::ranges::count_if(timing.messages, [](const TimedMessage& one) { return !one.response.meets_deadline; }));
  view["deadlines_text"] = missed == 0 ? "all deadlines met" : counted(missed, "deadline") + " not met";
  view["deadlines_class"] = missed == 0 ? "met" : "missed";
  view["load_min"] = percent(timing.load.min);
  view["load_max"] = percent(timing.load.max);
  view["messages"] = std::move(messages);
}

Json cycle_drawing(const Network& network) {
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  return sync_view(network, uses, network_timing(network, uses));
}

}  // namespace edsc::document

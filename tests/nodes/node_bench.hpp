/// A runnable node on a bus that records, with its log.
#pragma once

#include <canopen/node_id.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/input_line.hpp"
#include "shared/surroundings.hpp"
#include "unit/bench.hpp"

namespace bench {

/// Switched on at time 0; its boot-up message has been taken away.
template <template <class Bus> class Application>
class NodeBench {
 public:
  explicit NodeBench(std::optional<canopen::NodeId> node_id = canopen::NodeId{5}, const std::string& store = {})
      : around{node_id, 0x15011234, store, [this](std::string_view line) { log.emplace_back(line); }} {
    power_on();
  }

  /// What it has sent by then.
  std::string power_on() {
    app.emplace(bus, around);
    app->start(now);
    return boot_up = bus.take();
  }
  std::string power_cycle() {
    app.reset();
    return power_on();
  }

  /// What it sends because of this frame.
  std::string ask(const std::string& request) {
    app->on_frame(frame(request), now);
    return bus.take();
  }
  /// What it sends because of this line; "?" when it knows none such.
  std::string input(std::string_view line) { return app->input(nodes::InputLine{line}, now) ? bus.take() : "?"; }

  /// What it sends while this time passes.
  std::string pass(canopen::Duration span) {
    const canopen::TimePoint end = now + span;
    while (const auto deadline = app->next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now) now = *deadline;
      app->on_time(now);
    }
    now = end;
    app->on_time(now);
    return bus.take();
  }

  /// Whether the log has this line, which is taken away with those before it.
  bool logged(std::string_view line) {
    for (std::size_t i = 0; i < log.size(); ++i) {
      if (log[i] != line) continue;
      log.erase(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return true;
    }
    return false;
  }

  RecordingBus bus;
  canopen::TimePoint now{};
  std::string boot_up;
  std::vector<std::string> log;
  nodes::Surroundings around;
  std::optional<Application<RecordingBus>> app;
};

}  // namespace bench

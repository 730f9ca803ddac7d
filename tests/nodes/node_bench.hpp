/// A runnable node on a bus that records frames, with its log.
#pragma once

#include <canopen/can/node_id.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/input_line.hpp"
#include "shared/surroundings.hpp"
#include "support/access_probe.hpp"
#include "support/bench.hpp"

namespace bench {

/// Switched on at time 0; the boot-up message has been removed.
template <template <class Bus> class Application>
class NodeBench {
 public:
  explicit NodeBench(std::optional<canopen::NodeId> node_id = canopen::NodeId{5}, const std::string& store = {})
      : around{node_id, 0x15011234, store, [this](std::string_view line) { log.emplace_back(line); }} {
    power_on();
  }

  /// Returns what it sends at power-on.
  std::string power_on() {
    const InApplication here;
    app.emplace(bus, around);
    app->start(now);
    return boot_up = bus.take();
  }
  std::string power_cycle() {
    app.reset();
    return power_on();
  }

  /// Returns what it sends in response to this frame.
  std::string ask(const std::string& request) {
    const InApplication here;
    app->on_frame(frame(request), now);
    return bus.take();
  }
  /// Returns what it sends in response to this line; "?" if it does not know the line.
  std::string input(std::string_view line) {
    const InApplication here;
    return app->input(nodes::InputLine{line}, now) ? bus.take() : "?";
  }

  /// Returns what it sends during this time.
  std::string pass(canopen::Duration span) {
    const InApplication here;
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

  /// Returns whether the log has this line; removes it and the lines before it.
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

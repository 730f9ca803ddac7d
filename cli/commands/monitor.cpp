#include <fmt/format.h>

#include <algorithm>

#include "commands/commands.hpp"
#include "decode/log/print_message.hpp"
#include "monitor/monitor_view.hpp"
#include "monitor/terminal.hpp"
#include "online/live_bus.hpp"
#include "server/listen_address.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/given_nodes.hpp"
#include "shared/live_options.hpp"
#include "shared/monitor_feed.hpp"
#include "shared/monitor_server.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc monitor socketcan:can0                                     a table of the nodes; q ends
  edsc monitor socketcan:can0 --node 5=drive.eds --node 3=io.eds  PDO values by name
  edsc monitor socketcan:can0 --node 5=drive.eds | tee log        a line for each change
  edsc monitor socketcan:can0 --once 10s --bit-rate 500           ten seconds, then one table with the bus load
  edsc monitor socketcan:can0 --once 10s --format json            for a program
  edsc monitor socketcan:can0 --node 5=drive.eds --web            values and plots in the browser)";

struct Settings : NodesSettings {
  std::string bus;
  std::optional<std::uint64_t> once_us;
  std::optional<unsigned> bit_rate;
  std::optional<ListenAddress> web;
  std::string format = "text";
  ColorOption color;
};

constexpr canopen::Duration between_pictures = canopen::from_milliseconds(100);

/// The bit rate of the command line, otherwise that of the network file.
std::optional<unsigned> bit_rate_of(const Settings& settings, const GivenNodes& nodes) {
  if (settings.bit_rate || !nodes.network) return settings.bit_rate;
  const WrittenNumber& of_network = nodes.network->network.description.bit_rate;
  return of_network ? std::optional<unsigned>{of_network->value} : std::nullopt;
}

/// Prints the events on the bus as text.
class Monitor {
 public:
  Monitor(LiveBus& bus, const Settings& settings, const GivenNodes& nodes)
      : bus_{bus}, feed_{nodes, bus.now()}, view_{settings.bus, bit_rate_of(settings, nodes), false} {}

  /// A table that is updated ten times a second, until q or Ctrl-C.
  int show_table(bool colour) {
    view_.colour = colour;
    Terminal terminal;
    while (!Interruption::noted() && terminal.key() != 'q') {
      take_frames(between_pictures, [](const Message&) {});
      terminal.draw(picture());
    }
    return exit_fine;
  }

  /// A line for each change, until Ctrl-C.
  int print_changes() {
    while (!Interruption::noted()) {
      take_frames(between_pictures, [this](const Message& message) {
        const std::string who = message.node_id == 0 ? "" : fmt::format("node {} ", message.node_id);
        print_visibly(stdout, "{:>12.6f}  {:<9} {}{}\n", static_cast<double>(feed_.now_us()) / 1e6,
                      service_label(message), who, message.text);
        flush_output();
      });
    }
    return exit_fine;
  }

  /// Serves a page that is updated ten times a second, until Ctrl-C.
  int show_in_browser(const ListenAddress& address) {
    MonitorServer server{address, view_.bus};
    while (!Interruption::noted()) {
      take_frames(between_pictures, [&](const Message& message) { server.add(message, feed_.now_us()); });
      server.publish(feed_.state(), view_.bit_rate, feed_.now_us());
    }
    return exit_fine;
  }

  /// The state after this time, or at Ctrl-C.
  int print_once(std::uint64_t span_us, const std::string& format) {
    const auto end_us = static_cast<std::int64_t>(span_us);
    while (!Interruption::noted() && feed_.now_us() < end_us) {
      const std::int64_t left = end_us - feed_.now_us();
      take_frames(std::min(between_pictures, canopen::Duration{static_cast<std::uint32_t>(left)}),
                  [](const Message&) {});
    }
    feed_.state().end(feed_.now_us());
    if (format == "json") {
      fmt::print("{}\n", json_text(monitor_json(feed_.state(), view_, feed_.now_us())));
    } else {
      for (const std::string& line : monitor_lines(feed_.state(), view_, feed_.now_us())) fmt::print("{}\n", line);
    }
    return exit_fine;
  }

 private:
  /// Receives frames for this time and prints new information.
  template <class OnNews>
  void take_frames(canopen::Duration span, OnNews on_news) {
    const canopen::TimePoint end = bus_.now() + span;
    for (canopen::TimePoint present = bus_.now(); present < end && !Interruption::noted(); present = bus_.now()) {
      const auto frame = bus_.receive(end - present);
      if (!frame) continue;
      if (const Message* const message = feed_.add(*frame, bus_.now())) on_news(*message);
    }
    feed_.pass(bus_.now());
  }

  [[nodiscard]] std::vector<std::string> picture() const {
    const Terminal::Size size = Terminal::size();
    std::vector<std::string> lines = monitor_lines(feed_.state(), view_, feed_.now_us());
    lines.front() += "  (q ends)";
    if (lines.size() > size.rows) {
      const std::size_t hidden = lines.size() - size.rows + 1;
      lines.resize(size.rows - 1);
      lines.push_back(fmt::format("... {}", counted(hidden, "more line")));
    }
    for (std::string& line : lines) line = cut_to_width(line, size.columns);
    return lines;
  }

  LiveBus& bus_;
  MonitorFeed feed_;
  MonitorView view_;
};

int run_monitor(const Settings& settings) {
  if (settings.format == "json" && !settings.once_us) throw_requires("--format json", "--once");
  const GivenNodes nodes = load_given_nodes(settings, settings.color);
  return with_bus(settings.bus, [&](LiveBus& bus) {
    Monitor monitor{bus, settings, nodes};
    if (settings.web) return monitor.show_in_browser(*settings.web);
    if (settings.once_us) return monitor.print_once(*settings.once_us, settings.format);
    return Terminal::is_there() ? monitor.show_table(settings.color.on(stdout)) : monitor.print_changes();
  });
}

}  // namespace

void add_monitor_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_monitor, exit_code);
  add_bus_argument(command, settings.bus);
  add_nodes_options(command, settings);
  command.add_duration("--once", 10'000, 86'400'000'000, [&settings](std::uint64_t us) { settings.once_us = us; });
  command
      .add_option("--bit-rate", settings.bit_rate,
                  "to compute the bus load, without stuff bits (default: that of the network file)")
      .range(5, 1000);
  add_web_option(command, settings.web).excludes("--once");
  add_format_option(command, settings.format);
  settings.color.add_to(command);
}

}  // namespace edsc

#include <fmt/format.h>

#include "commands/commands.hpp"
#include "network/network_report.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_network.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network verify socketcan:can0 plant.json                  what differs from the file; nothing is written
  edsc network verify socketcan:can0 plant.json --skip plc       except for one node
  edsc network verify socketcan:can0 plant.json --format json    for a program)";

int verify(LiveBus& bus, const LiveNetworkSettings& settings, LiveNetwork& network) {
  {
    ProgressLine progress;
    NetworkSession session{bus,
                           network.nodes,
                           settings.sdo,
                           {show_progress(progress, network.nodes), [](const LiveNode&) {}, [](const LiveNode&) {}}};
    session.identify(false);
    session.compare();
  }
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(verify_json(network.nodes)));
  } else {
    for (const LiveNode& live : network.nodes) {
      for (const std::string& line : verify_lines(live)) print_visibly(stdout, "{}\n", line);
    }
    print_visibly(stdout, "{}\n", verify_summary(network.nodes, settings.path));
  }
  report_identities(network.nodes);
  return std::ranges::all_of(network.nodes, is_same) ? exit_fine : exit_device_failed;
}

int run_verify(const LiveNetworkSettings& settings) {
  LiveNetwork network = load_live_network(settings);
  return with_bus(settings.bus, [&](LiveBus& bus) { return verify(bus, settings, network); });
}

}  // namespace

void add_network_verify_options(Command command, int& exit_code) {
  add_live_network_options(command, define_command(command, examples, run_verify, exit_code));
}

}  // namespace edsc

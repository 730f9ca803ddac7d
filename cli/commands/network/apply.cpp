#include <fmt/format.h>

#include "commands/commands.hpp"
#include "configure/configuration_report.hpp"
#include "network/network_report.hpp"
#include "network/node_configuration.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_network.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network verify socketcan:can0 plant.json                     what would be written
  edsc network apply socketcan:can0 plant.json                      write what differs, read it back
  edsc network apply socketcan:can0 plant.json --store --start      store the parameters, then start all nodes
  edsc network apply socketcan:can0 plant.json --on-error retry     configure a failed node again, up to three times)";

struct Settings : LiveNetworkSettings {
  ApplySettings apply;
  std::string on_error = "abort";
};

OnError on_error_of(const Settings& settings) {
  if (settings.on_error == "continue") return OnError::keep_going;
  return settings.on_error == "retry" ? OnError::retry : OnError::abort;
}

void print_differences(const LiveNode& live) {
  for (const ConfigurationChange& change : live.run.changes) {
    print_visibly(stdout, "{}: {}\n", label(*live.node), change_text(change));
  }
  for (const ConfigurationChange& change : live.run.withheld) {
    print_to_stderr("edsc: {}: not written, the node's own node-ID or bit rate: {}\n", label(*live.node),
                    withheld_text(live.run, change));
  }
  std::fflush(stdout);
}

void print_result(const LiveNode& live, bool text) {
  for (const ConfigurationFailure& failure : live.run.result.failures) {
    print_to_stderr("{}\n", failure_text(failure, label(*live.node) + ": "));
  }
  if (text) print_visibly(stdout, "{}: {}\n", live.node->name, summary_text(live.run));
  std::fflush(stdout);
}

void print_problems(const std::vector<LiveNode>& nodes) {
  for (const LiveNode& live : nodes) {
    for (const NodeProblem& problem : live.problems) print_to_stderr("{}\n", problem_text(problem));
    for (const std::string& problem : live.run.problems) {
      print_to_stderr("{}\n", problem_text({label(*live.node) + ": " + problem, live.node->position}));
    }
  }
}

/// What was reached, also if the bus is lost or the command is interrupted.
void report(const Settings& settings, const LiveNetwork& network, bool writes) {
  print_problems(network.nodes);
  report_identities(network.nodes);
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(apply_json(network.nodes)));
  } else if (writes) {
    print_visibly(stdout, "{}\n", apply_summary(network.nodes));
  } else {
    print_to_stderr("edsc: nothing written\n");
  }
  std::fflush(stdout);
}

NetworkHooks hooks_with(ProgressLine& progress, const LiveNetwork& network, bool text) {
  NetworkHooks hooks;
  hooks.progress = show_progress(progress, network.nodes);
  hooks.compared = [&progress, text](const LiveNode& live) {
    progress.hide();
    if (text) print_differences(live);
  };
  hooks.configured = [&progress, text](const LiveNode& live) {
    progress.hide();
    print_result(live, text);
  };
  return hooks;
}

int apply(LiveBus& bus, const Settings& settings, LiveNetwork& network) {
  ApplySettings apply = settings.apply;
  apply.on_error = on_error_of(settings);
  bool writes = false;
  bool succeeded = false;
  try {
    ProgressLine progress;
    NetworkSession session{bus, network.nodes, settings.sdo, hooks_with(progress, network, settings.format == "text")};
    writes = session.identify(true) && session.compare();
    if (writes) succeeded = session.apply(apply);
  } catch (...) {
    report(settings, network, writes);
    throw;
  }
  report(settings, network, writes);
  return succeeded ? exit_fine : exit_device_failed;
}

int run_apply(const Settings& settings) {
  LiveNetwork network = load_live_network(settings);
  return with_bus(settings.bus, [&](LiveBus& bus) { return apply(bus, settings, network); });
}

}  // namespace

void add_network_apply_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_apply, exit_code);
  add_live_network_options(command, settings);
  command.add_flag("--store", settings.apply.store, "after success (1010h)");
  command.add_flag("--start", settings.apply.start, "all nodes, if all were configured");
  add_choice(command, "--on-error", settings.on_error, {"abort", "continue", "retry"});
  command.add_option("--retries", settings.apply.retries, "with --on-error retry").range(1, 100).show_default();
}

}  // namespace edsc

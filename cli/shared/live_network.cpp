#include "shared/live_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "network/checks/check_network.hpp"
#include "network/network_report.hpp"
#include "network/node_configuration.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

void end_if_errors(const Diagnostics& diagnostics, const LoadedNetwork& loaded) {
  if (diagnostics.errors() == 0) return;
  Diagnostics errors;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error) errors.report(one);
  }
  print_findings(errors, ColorOption{});
  throw Exit{loaded.unreadable ? exit_wrong_usage : exit_input_has_errors};
}

bool is_skipped(const LiveNetworkSettings& settings, const NetworkNode& node) {
  return std::ranges::find(settings.skip, node.name) != settings.skip.end();
}

}  // namespace

void add_live_network_options(Command command, LiveNetworkSettings& settings) {
  add_bus_argument(command, settings.bus);
  command.add_option("FILE", settings.path, "network file (JSON)").required();
  command.add_option("--skip", settings.skip).one_value_each();
  add_format_option(command, settings.format);
  add_timeout_option(command, settings.sdo.timeout_ms);
}

LiveNetwork load_live_network(const LiveNetworkSettings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LiveNetwork live{load_network(settings.path, diagnostics), {}};
  const Network& network = live.loaded->network;
  if (!live.loaded->unreadable) check_network(network, diagnostics);
  const std::set<const Pdo*> linked = linked_pdos(network);
  for (const NetworkNode& node : network.nodes) {
    if (!node.has_file() || is_skipped(settings, node)) continue;
    LiveNode one;
    one.node = &node;
    one.sdo_timeout_ms = sdo_timeout_ms(network.description, *node.description);
    one.configuration = configuration_of(network, node, linked, diagnostics);
    live.nodes.push_back(std::move(one));
  }
  end_if_errors(diagnostics, *live.loaded);
  for (const std::string& name : settings.skip) {
    if (network.find(name) == nullptr) fail("--skip: " + network.unknown_node(name));
  }
  if (live.nodes.empty()) fail(settings.path + ": no node with an EDS or DCF is left");
  return live;
}

decltype(NetworkHooks::progress) show_progress(ProgressLine& line, const std::vector<LiveNode>& nodes) {
  return [&](const LiveNode& live, std::string_view doing, std::size_t done, std::size_t of) {
    if (!line.due()) return;
    line.show(fmt::format("{}, {} of {} nodes: {} of {} {}", label(*live.node), &live - nodes.data() + 1, nodes.size(),
                          done, of, doing));
  };
}

void report_identities(const std::vector<LiveNode>& nodes) {
  for (const LiveNode& live : nodes) {
    const std::string revision = other_minor_revision(live);
    if (!revision.empty()) print_to_stderr("edsc: {}: {}\n", label(*live.node), revision);
    const std::string numbers = identity_not_compared(live);
    if (!numbers.empty()) print_to_stderr("edsc: {}: not compared: {}\n", label(*live.node), numbers);
  }
}

}  // namespace edsc

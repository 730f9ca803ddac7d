#include <algorithm>
#include <utility>

#include "lint/rule_groups.hpp"
#include "network/checks/check_groups.hpp"

namespace edsc {
namespace {

/// Rules of a single device that also apply to the values of the network file. The other rules of these groups are
/// about the EDS alone, or a rule of the network reports the same.
constexpr AnyRule rules_of_values[] = {"heartbeat-consumer", "pdo-inhibit-time", "pdo-mapping-count",
                                       "pdo-mapping-gap",    "pdo-remote",       "pdo-sync",
                                       "pdo-sync-start",     "pdo-time-unused"};

/// The finding, at the first of its places that is in the network file; nothing if none is.
void report(const NetworkContext& context, const NetworkNode& node, Diagnostic finding) {
  const SourceFile* const network_file = context.network.source.get();
  if (finding.position.file != network_file) {
    const auto note = std::ranges::find(finding.notes, network_file, [](const Note& one) { return one.position.file; });
    if (note == finding.notes.end()) return;
    std::swap(finding.position, note->position);
    note->message = node.name;
  }
  finding.message = "node " + node.name + ": " + finding.message;
  finding.cause.clear();
  context.diagnostics.report(std::move(finding));
}

}  // namespace

void check_settings(const NetworkContext& context) {
  for (const NetworkNode& node : context.network.nodes) {
    if (node.settings.empty()) continue;
    Diagnostics of_node;
    const RuleContext rules{node.device(), node.loaded->sheet, node.loaded->options, of_node};
    check_communication_values(rules);
    check_pdo_communication(rules);
    check_pdo_mapping(rules);
    for (const Diagnostic& one : of_node.all()) {
      if (std::ranges::find(rules_of_values, one.rule) != std::end(rules_of_values)) report(context, node, one);
    }
  }
}

}  // namespace edsc

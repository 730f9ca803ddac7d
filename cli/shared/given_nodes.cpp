#include "shared/given_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "pdo/mapping_fault.hpp"
#include "shared/default_scales.hpp"
#include "shared/exit_code.hpp"
#include "shared/node_names.hpp"
#include "shared/parse_number.hpp"

namespace edsc {
namespace {

/// `5=drive.eds`, `axis1=drive.eds`, `axis1`, or `axis1.dcf` with its own node-ID.
struct NodeArgument {
  std::optional<std::uint8_t> node_id;
  std::string path;  ///< empty: the device of the network file
};

const NetworkNode* find_in(const LoadedNetwork* network, std::string_view name) {
  return network != nullptr ? network->network.find(name) : nullptr;
}

NodeArgument parse_node_argument(const std::string& text, const LoadedNetwork* network) {
  const std::size_t equals = text.find('=');
  const std::string node = text.substr(0, equals);
  const std::string path = equals == std::string::npos ? std::string{} : text.substr(equals + 1);
  if (const NetworkNode* const named = find_in(network, node)) return {named->node_id, path};
  const auto number = parse_number(node);
  if (!number || (equals == std::string::npos && network == nullptr)) return {std::nullopt, text};
  if (*number < 1 || *number > 127) fail(fmt::format("--node {}: a node-ID must be 1 to 127", text));
  return {static_cast<std::uint8_t>(*number), path};
}

/// Warnings and invalid mappings are for `edsc check`: a PDO is decoded as mapped.
void print_errors(const Diagnostics& diagnostics, const ColorOption& color) {
  Diagnostics errors;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error && !is_mapping_rule(one.rule)) errors.report(one);
  }
  print_findings(errors, color);
}

/// The device of a node. Errors in its EDS are printed; the rest is used.
std::unique_ptr<LoadedDevice> load_node(NodeArgument& argument, const ColorOption& color) {
  Diagnostics diagnostics;
  LoadSettings load;
  load.path = argument.path;
  load.node_id = argument.node_id;
  load.check = false;
  auto loaded = load_device(load, diagnostics);
  print_errors(diagnostics, color);
  if (loaded->unreadable || !loaded->device) {
    fail(fmt::format("--node: {} cannot be used; write ID=FILE, or with --network the name of a node", argument.path));
  }
  if (!argument.node_id) argument.node_id = loaded->device->node_id;
  if (!argument.node_id) {
    fail(fmt::format("--node {0}: the file does not state a node-ID; use --node 5={0}", argument.path));
  }
  return loaded;
}

void add_network(const std::string& path, const ColorOption& color, GivenNodes& nodes) {
  nodes.network = load_given_network(path, color);
  if (!nodes.network) return;
  for (const NetworkNode& node : nodes.network->network.nodes) {
    nodes.labels.set_name(node.node_id, node.name);
    std::map<std::uint8_t, GivenNode>& known = node.has_file() ? nodes.devices : nodes.masters;
    known.emplace(node.node_id,
                  GivenNode{node.named(), &node.loaded->options, node.loaded->options.inhibit_time_unit()});
  }
}

void add_node(const std::string& text, const ColorOption& color, GivenNodes& nodes) {
  NodeArgument argument = parse_node_argument(text, nodes.network.get());
  std::unique_ptr<LoadedDevice> loaded = argument.path.empty() ? nullptr : load_node(argument, color);
  const std::uint8_t node_id = *argument.node_id;
  if (!nodes.of_node_options.insert(node_id).second)
    fail(fmt::format("--node {}: node {} is given twice", text, node_id));
  if (!loaded) {
    if (nodes.devices.contains(node_id)) return;
    fail(fmt::format("--node {}: the network file does not state an EDS of node {}", text, node_id));
  }
  const auto& commissioning = loaded->device->information.commissioning;
  if (commissioning && nodes.labels.name(node_id).empty()) nodes.labels.set_name(node_id, commissioning->node_name);
  nodes.devices.erase(node_id);
  nodes.masters.erase(node_id);
  nodes.devices.emplace(node_id, GivenNode{loaded->named(), &loaded->options, loaded->options.inhibit_time_unit()});
  nodes.files.push_back(std::move(loaded));
}

void append_known(const std::map<std::uint8_t, GivenNode>& given, std::vector<KnownNode>& nodes) {
  for (const auto& [node_id, node] : given) nodes.push_back({node_id, &node.named.device, node.inhibit_time_unit});
}

}  // namespace

bool NodesSettings::describe_nodes() const { return !nodes.empty() || !network_or_default(network).empty(); }

void add_nodes_options(Command command, NodesSettings& settings) {
  command.add_option("--node", settings.nodes).one_value_each();
  add_network_option(command, settings.network);
}

std::vector<KnownNode> GivenNodes::known() const {
  std::vector<KnownNode> nodes;
  append_known(devices, nodes);
  return nodes;
}

std::vector<KnownNode> GivenNodes::known_with_masters() const {
  std::vector<KnownNode> nodes = known();
  append_known(masters, nodes);
  return nodes;
}

std::unique_ptr<LoadedNetwork> load_given_network(const std::string& path, const ColorOption& color) {
  if (path.empty()) return nullptr;
  static_cast<void>(named_nodes(path));  // ends the command if the network file has an error
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  auto network = load_network(path, diagnostics);
  print_errors(diagnostics, color);
  if (network->unreadable) fail(path + " cannot be used");
  return network;
}

GivenNodes load_given_nodes(const NodesSettings& settings, const ColorOption& color) {
  GivenNodes nodes;
  add_network(network_or_default(settings.network), color, nodes);
  for (const std::string& text : settings.nodes) add_node(text, color, nodes);
  for (const auto& [node_id, node] : nodes.devices) report_default_scales(node_id, node.named.device);
  return nodes;
}

}  // namespace edsc

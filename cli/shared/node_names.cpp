#include "shared/node_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "diagnostics/quote.hpp"
#include "load/load_device.hpp"
#include "network/network_description.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
#include "shared/parse_number.hpp"
#include "system/environment.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

std::string path_beside(const std::string& network, const WrittenText& file) {
  if (!file) return {};
  return join_path(from_native(to_native(network).parent_path()), file->value);
}

/// That of the network file, else that of the DCF.
std::optional<std::uint8_t> node_id_of(const NodeDescription& node, const std::string& sheet) {
  if (node.node_id) return static_cast<std::uint8_t>(node.node_id->value);
  if (!node.dcf) return std::nullopt;
  Diagnostics ignored;
  LoadSettings settings;
  settings.path = sheet;
  settings.check = false;
  const auto loaded = load_device(settings, ignored);
  return loaded->device ? loaded->device->node_id : std::nullopt;
}

std::optional<std::uint8_t> parse_node_id(const std::string& text) {
  const auto number = parse_number(text, 127);
  if (!number || *number == 0) return std::nullopt;
  return static_cast<std::uint8_t>(*number);
}

[[noreturn]] void throw_unknown_node(const std::string& argument, const std::string& text, const std::string& network,
                                     const std::vector<NamedNode>& nodes) {
  const std::string problem = quote(text) + " is not a node-ID from 1 to 127";
  if (network.empty()) {
    throw_invalid(argument, problem + "; the name of a node requires --network FILE or EDSC_NETWORK");
  }
  std::vector<std::string> names(nodes.size());
  std::ranges::transform(nodes, names.begin(), &NamedNode::name);
  throw_invalid(argument, fmt::format("{} and not a node of {}{}", problem, network, did_you_mean(text, names)));
}

}  // namespace

Option add_network_option(Command command, std::string& network) { return command.add_option("--network", network); }

std::string network_or_default(const std::string& network) {
  if (!network.empty()) return network;
  return environment_variable("EDSC_NETWORK").value_or("");
}

std::vector<NamedNode> named_nodes(const std::string& network) {
  if (network.empty()) return {};
  std::string problem;
  const std::unique_ptr<SourceFile> source = read_source_file(network, problem);
  if (!source) fail(problem);
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  const NetworkDescription description = read_network_file(*source, diagnostics);
  if (diagnostics.errors() > 0) {
    print_findings(diagnostics, ColorOption{});
    throw Exit{exit_wrong_usage};
  }
  std::vector<NamedNode> nodes;
  for (const NodeDescription& node : description.nodes) {
    const std::string sheet = path_beside(network, node.dcf ? node.dcf : node.eds);
    const auto node_id = node_id_of(node, sheet);
    if (node_id) nodes.push_back({node.name.value, *node_id, sheet, path_beside(network, node.options)});
  }
  return nodes;
}

NamedNode find_node(const std::string& argument, const std::string& text, const std::string& network,
                    bool wants_files) {
  const auto node_id = parse_node_id(text);
  if (node_id && !wants_files) return {{}, *node_id, {}, {}};
  const std::string path = network_or_default(network);
  const std::vector<NamedNode> nodes = named_nodes(path);
  const auto found = node_id ? std::ranges::find(nodes, *node_id, &NamedNode::node_id)
                             : std::ranges::find(nodes, text, &NamedNode::name);
  if (found != nodes.end()) return *found;
  if (!node_id) throw_unknown_node(argument, text, path, nodes);
  return {{}, *node_id, {}, {}};
}

std::uint8_t find_node_id(const std::string& argument, const std::string& text, const std::string& network) {
  return find_node(argument, text, network, false).node_id;
}

}  // namespace edsc

#include "network/generate/generate_network.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "backend/dbc/dbc.hpp"
#include "network/generate/device_headers.hpp"
#include "network/generate/lely.hpp"
#include "network/generate/network_dot.hpp"
#include "network/generate/node_dcf.hpp"
#include "network/generate/plant_header.hpp"
#include "system/path.hpp"
#include "text/snake_case.hpp"

namespace edsc {
namespace {

void add_input(std::vector<std::string>& inputs, const std::string& path) {
  if (std::ranges::find(inputs, path) == inputs.end()) inputs.push_back(path);
}

std::vector<std::string> inputs_of(const Network& network) {
  std::vector<std::string> inputs{network.source->name()};
  if (network.dbc_source) add_input(inputs, network.dbc_source->name());
  for (const NetworkNode& node : network.nodes) {
    if (!node.has_file()) continue;
    for (const std::string& name : input_files(*node.loaded)) add_input(inputs, name);
  }
  return inputs;
}

Dbc dbc_of(const Network& network) {
  std::vector<DbcNode> nodes;
  for (const NetworkNode& node : network.nodes) {
    const std::string name = to_snake_case(node.name);
    nodes.push_back({name.empty() ? "device" : name, &node.device(), &node.named().identifiers(), &node.signal_names});
  }
  return dbc_of(nodes);
}

void add_lely_files(GeneratedNetwork& generated, const Network& network, std::vector<LelyNode> nodes,
                    Diagnostics& diagnostics) {
  const NetworkNode* const master = network.master();
  if (master == nullptr) {
    diagnostics.error("network-file", Position{network.source.get()},
                      "the files for Lely need a node with \"master\": true");
    return;
  }
  LelyFiles lely = lely_files(network, *master, std::move(nodes));
  const auto dcf = std::ranges::find(generated.files, lely.master_dcf.path, &OutputFile::path);
  *dcf = std::move(lely.master_dcf);
  generated.files.push_back(std::move(lely.bus_yml));
  for (const std::string& note : lely.notes) generated.notes.push_back("not in bus.yml: " + note);
}

}  // namespace

GeneratedNetwork generate_network(const Network& network, Diagnostics& diagnostics, MasterProgram program) {
  GeneratedNetwork generated;
  PlantParts parts;
  std::vector<LelyNode> lely_nodes;
  for (const NetworkNode& node : network.nodes) {
    const std::string file = program == MasterProgram::lely ? lely_dcf_file(node) : node_file(node, "dcf");
    NodeDcf dcf = make_node_dcf(network, node, file, diagnostics);
    if (!node.has_file()) {
      generated.files.push_back({node_file(node, "eds"), std::string{node.loaded->source->text()}});
    }
    generated.files.push_back({file, std::move(dcf.text)});
    parts.concise_dcfs.push_back(dcf.concise);
    if (program == MasterProgram::lely) lely_nodes.push_back({&node, std::move(dcf.document), dcf.concise});
    generated.files.push_back({node_file(node, "cdcf"), std::move(dcf.concise)});
  }
  if (program == MasterProgram::lely) add_lely_files(generated, network, std::move(lely_nodes), diagnostics);
  const std::string name{stem_of(network.source->name())};
  Dbc dbc = dbc_of(network);
  generated.files.push_back({name + ".dbc", std::move(dbc.text)});
  generated.files.push_back({name + ".dot", network_dot(network)});
  const std::string plant = to_namespace(name);
  DeviceHeaders headers = device_headers(network, plant, diagnostics);
  parts.devices = std::move(headers.names);
  headers.files.push_back({plant + ".hpp", plant_header(network, plant, parts)});
  headers.files.push_back({"network-devices.hpp", devices_header(network, parts, headers.files)});
  std::ranges::move(headers.files, std::back_inserter(generated.files));
  generated.inputs = inputs_of(network);
  for (const std::string& note : dbc.notes) generated.notes.push_back("not in the DBC file: " + note);
  return generated;
}

}  // namespace edsc

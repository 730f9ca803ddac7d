#include "shared/node_names.hpp"

#include <cstdlib>

#include "diagnostics/diagnostics.hpp"
#include "network/network_description.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

std::string sheet_beside(const std::string& network, const NodeDescription& node) {
  const WrittenText& file = node.dcf ? node.dcf : node.eds;
  if (!file) return {};
  return join_path(from_native(to_native(network).parent_path()), file->value);
}

}  // namespace

std::string default_network() {
  const char* const path = std::getenv("EDSC_NETWORK");
  return path != nullptr ? path : "";
}

std::vector<NamedNode> named_nodes(const std::string& network) {
  if (network.empty()) return {};
  std::string problem;
  const std::unique_ptr<SourceFile> source = read_source_file(network, problem);
  if (!source) fail("network file " + problem);
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  const NetworkDescription description = read_network_file(*source, diagnostics);
  if (diagnostics.errors() > 0) {
    print_findings(diagnostics, ColorOption{});
    throw Exit{exit_wrong_usage};
  }
  std::vector<NamedNode> nodes;
  for (const NodeDescription& node : description.nodes) {
    if (!node.node_id) continue;
    nodes.push_back({node.name.value, static_cast<std::uint8_t>(node.node_id->value), sheet_beside(network, node)});
  }
  return nodes;
}

}  // namespace edsc

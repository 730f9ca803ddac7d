/// The nodes of a bus or log that the user describes: `--node ID=FILE` and `--network FILE`.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/log/print_message.hpp"
#include "load/load_device.hpp"
#include "network/network.hpp"
#include "shared/command_line.hpp"
#include "shared/common_options.hpp"

namespace edsc {

struct NodesSettings {
  std::vector<std::string> nodes;  ///< of --node
  std::string network;

  /// Whether a node is described, or may be by EDSC_NETWORK.
  [[nodiscard]] bool describe_nodes() const;
};

/// `--node` and `--network`
void add_nodes_options(Command command, NodesSettings& settings);

/// A device and its names. Those of a network file are as the network configures them.
struct GivenNode {
  NamedDevice named;
  const Options* options = nullptr;
  std::uint32_t inhibit_time_unit = 0;  ///< of its PDOs, in microseconds
};

struct GivenNodes {
  std::vector<std::unique_ptr<LoadedDevice>> files;  ///< of --node
  std::unique_ptr<LoadedNetwork> network;            ///< null without a network file
  std::map<std::uint8_t, GivenNode> devices;         ///< by node-ID
  std::map<std::uint8_t, GivenNode> masters;         ///< those without a file: the network generates their EDS
  std::set<std::uint8_t> of_node_options;            ///< the nodes that --node names
  NodeLabels labels;

  [[nodiscard]] std::vector<KnownNode> known() const;
  /// Also the masters without a file. Their PDOs are decoded as sent by them, with the objects of the generated EDS.
  [[nodiscard]] std::vector<KnownNode> known_with_masters() const;
};

/// A network file with its nodes as configured; null for an empty path. Errors are printed; ends the command if the
/// file cannot be used.
[[nodiscard]] std::unique_ptr<LoadedNetwork> load_given_network(const std::string& path, const ColorOption& color);

/// The nodes of the network file, then those of --node, which replace nodes of the network file. Errors in their EDS
/// are printed; ends the command if one cannot be used.
[[nodiscard]] GivenNodes load_given_nodes(const NodesSettings& settings, const ColorOption& color);

}  // namespace edsc

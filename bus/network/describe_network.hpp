/// Writes the network file of the nodes found on a bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "network/sheet_files.hpp"
#include "online/scan.hpp"

namespace edsc {

struct DescribeSettings {
  std::string folder;                             ///< of the network file; the paths of the files are relative to it
  std::optional<unsigned> bit_rate;               ///< kbit/s
  bool only_listened = false;                     ///< the nodes were not asked: what others did not read is not known
  std::map<std::uint8_t, std::string> remarks{};  ///< comments about nodes
  std::string guessed{};                          ///< JSON value of the member "guessed"; empty: none
};

struct DescribedNetwork {
  std::string text;                 ///< JSON with comments
  std::vector<std::string> notes;   ///< about nodes for which the choice of a file is not certain
  std::vector<std::string> errors;  ///< about nodes without a file, and about two nodes with one node-ID
  std::size_t nodes = 0;            ///< with a file
};

/// Each node gets the file that fits best, and the heartbeat time and serial number that it has. Nodes without a file
/// are comments.
[[nodiscard]] DescribedNetwork describe_network(const std::vector<FoundNode>& nodes,
                                                const std::vector<SheetFile>& sheets, const DescribeSettings& settings);

}  // namespace edsc

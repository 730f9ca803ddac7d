/// Common arguments of the commands at a live bus.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "online/scan.hpp"
#include "online/sdo_access.hpp"
#include "shared/command_line.hpp"
#include "shared/node_names.hpp"

namespace edsc {

/// What the commands for one node have in common.
struct NodeSettings {
  std::string bus;
  std::string written_node;  ///< NODE: a node-ID or a name
  std::string network;
  std::string sheet;          ///< EDS of the node; that of the network file if no other is given
  std::uint8_t node = 0;      ///< by resolve()
  std::string without_sheet;  ///< by resolve(): the name of a node for which the network file states no EDS
  SdoSettings sdo;

  /// Finds the node. Returns what the network file states about it, if the EDS is not given.
  NamedNode resolve();
};

/// `BUS`
Option add_bus_argument(Command command, std::string& bus);

/// `NODE`, as text for find_node().
Option add_node_argument(Command command, std::string& node, const std::string& detail = "");

/// `BUS NODE` and `--network`
std::vector<Option> add_node_arguments(Command command, NodeSettings& settings);

/// `--timeout MS`
Option add_timeout_option(Command command, unsigned& milliseconds);

/// `--step MS` of Fastscan
Option add_step_option(Command command, unsigned& milliseconds);

/// `--format text|json`
Option add_format_option(Command command, std::string& format);

/// `--type TYPE`
Option add_type_option(Command command, const canopen::DataTypeRow*& type);

/// Parses a number: 31, 0x1F or 1Fh. Nothing if it is invalid, or above `most`.
[[nodiscard]] std::optional<std::uint32_t> parse_count(const std::string& text, std::uint32_t most = 0xFFFF'FFFF);

/// Parses a node-ID, 1 to 127.
[[nodiscard]] std::optional<std::uint8_t> parse_node(const std::string& text);

/// A node-ID and its EDS.
struct NodeFile {
  std::uint8_t node_id = 0;
  std::string path;
};

/// Parses `5=drive.eds`.
[[nodiscard]] std::optional<NodeFile> parse_node_file(const std::string& text);

/// Parses `1..127`, `5` or `1,3,8..20`: ascending, each once. Empty if invalid.
[[nodiscard]] std::vector<std::uint8_t> parse_node_list(const std::string& text);

/// Which nodes are scanned, and how long.
struct ScanOptions {
  std::string nodes = "1..127";
  ScanSettings times;

  /// With the nodes.
  [[nodiscard]] ScanSettings parsed() const;
};

/// `--nodes`, `--timeout` and `--listen`.
void add_scanned_nodes(Command command, ScanOptions& options);

/// Adds an option or argument with such a number.
Option add_count_option(Command command, const std::string& name, std::optional<std::uint32_t>& number,
                        const std::string& detail = "");

}  // namespace edsc

/// A network: the nodes of a network file, each with its device as it will be configured.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "backend/dbc/read_dbc.hpp"
#include "device/device.hpp"
#include "device/value_overlay.hpp"
#include "load/load_device.hpp"
#include "network/network_description.hpp"

namespace edsc {

struct NetworkNode {
  std::string name;
  Position position;  ///< in the network file
  std::uint8_t node_id = 0;
  bool is_master = false;
  const NodeDescription* description = nullptr;
  const LoadedDevice* loaded = nullptr;            ///< of a master without a file: its generated EDS
  ValueOverlay settings;                           ///< in the order in which the network file implies and states them
  std::map<EntryKey, std::string> signal_names;    ///< of values in PDOs that differ from the names of their objects
  std::map<EntryKey, Quantity> signal_quantities;  ///< units that signals state
  std::unique_ptr<const Device> configured;        ///< with the settings and these units; null without both

  /// The device as it will be configured: the settings are its default values. A master without a file has no objects
  /// until it has its generated EDS.
  [[nodiscard]] const Device& device() const;
  [[nodiscard]] NamedDevice named() const { return {device(), *loaded->names}; }
  /// Whether the network file names an EDS or DCF.
  [[nodiscard]] bool has_file() const { return description->eds || description->dcf; }
};

struct Network {
  std::unique_ptr<SourceFile> source;
  std::unique_ptr<SourceFile> dbc_source;  ///< null without a DBC file
  std::vector<DbcFileMessage> dbc;
  NetworkDescription description;
  std::vector<std::unique_ptr<LoadedDevice>> files;  ///< of nodes, also those that could not be read
  std::vector<NetworkNode> nodes;                    ///< those whose device could be read, in the order of the file

  [[nodiscard]] const NetworkNode* find(std::string_view name) const;
  /// Whether the network file lists a node, even one without a device.
  [[nodiscard]] bool lists(std::string_view name) const;
  /// `unknown node "axsi1"; did you mean "axis1"?`
  [[nodiscard]] std::string unknown_node(std::string_view name) const;
  /// The NMT master; null if there is none.
  [[nodiscard]] const NetworkNode* master() const;
};

struct LoadedNetwork {
  Network network;
  bool unreadable = false;  ///< a file could not be read: wrong usage, not invalid input
};

/// Reads a network file and the EDS and DCF files that it names, assigns PDOs to its signals, and applies its settings.
/// Errors in the EDS files are reported; their warnings are not.
[[nodiscard]] std::unique_ptr<LoadedNetwork> load_network(const std::string& path, Diagnostics& diagnostics);
/// The same for a network file that was read. `read` reads the files that it names; empty: from the file system.
[[nodiscard]] std::unique_ptr<LoadedNetwork> load_network(std::unique_ptr<SourceFile> source, Diagnostics& diagnostics,
                                                          const ReadBase& read = {});

/// The default value of an entry as a number; nothing if the entry is missing or has none.
[[nodiscard]] std::optional<std::uint64_t> value_of(const Device& device, std::uint16_t index,
                                                    std::uint8_t sub_index = 0);

/// The position of the value of an entry, or of the whole file of the device.
[[nodiscard]] Position place_of_value(const Device& device, std::uint16_t index, std::uint8_t sub_index = 0);

}  // namespace edsc

/// Settings of a network file for a node: they become the default values of its device.
#pragma once

#include <cstdint>
#include <string>

#include "network/network.hpp"

namespace edsc {

/// Sets the default value of a writable entry, and records the setting. A missing entry, one that cannot be written,
/// and a value outside its limits are reported.
void set_number(NetworkNode& node, std::uint16_t index, std::uint8_t sub_index, std::uint64_t number,
                const Position& position, Diagnostics& diagnostics);

/// The settings of `sync`, for all nodes that have its objects.
void apply_sync(NetworkNode& node, const SyncDescription& sync, Diagnostics& diagnostics);

/// The settings of the node itself: `heartbeat_ms`, `set`. Two values of one entry are reported.
void apply_node_members(NetworkNode& node, const SourceFile& network_file, Diagnostics& diagnostics);

/// `master_timeout_ms`: the entry of 1016h for the master, else the first free one.
void apply_master_timeout(NetworkNode& node, const Network& network, Diagnostics& diagnostics);

/// Makes the configured device of the settings. Reports mappings of the network file that the device does not allow.
void configure(NetworkNode& node, const SourceFile& network_file, Diagnostics& diagnostics);

}  // namespace edsc

/// The data sheet of a live node, and the entries that people name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "load/load_device.hpp"
#include "online/live_entry.hpp"

namespace edsc {

/// The device of a data sheet as this node. Errors do not matter but for what is left out: how many there are is printed.
/// Null when the file cannot be read as one; the reason is printed.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_live_device(const std::string& path, std::uint8_t node);

/// The entries that a text names: one, or all readable ones of an object with sub-indices. Without a device the text
/// is an address. What is wrong with it is the problem.
struct NamedEntries {
  std::vector<LiveEntry> entries;
  std::string problem;
};

[[nodiscard]] NamedEntries name_entries(const Device* device, const std::string& text);

/// The one entry that a text names.
[[nodiscard]] NamedEntries name_entry(const Device* device, const std::string& text);

/// Whether a node is the device of a file, as far as both state it.
struct NodeCheck {
  std::string problem;       ///< empty: nothing contradicts it
  std::string not_compared;  ///< `vendor-ID (not in drive.eds)`
};

[[nodiscard]] NodeCheck check_node(SdoAccess& node, const Device& device, const std::string& path);

/// Reports a block transfer that broke, after which segments were used.
void report_broken_block(const LiveEntry& entry, const SdoOutcome& outcome);

/// The bytes of a file; false when it cannot be read, with the reason.
[[nodiscard]] bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes, std::string& problem);

}  // namespace edsc

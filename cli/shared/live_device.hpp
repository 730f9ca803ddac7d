/// The EDS of a live node, and entries given by the user.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "load/load_device.hpp"
#include "online/live_entry.hpp"

namespace edsc {

/// Loads the device of an EDS for this node. What is wrong is left out, and the number of errors is printed. Null if
/// the file cannot be read as an EDS, with the reason printed.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_live_device(const std::string& path, std::uint8_t node);

/// Finds the entries that a text names: one, or all readable ones of an object with sub-indices. Without a device the
/// text must be an address. `problem` is an error message.
struct NamedEntries {
  std::vector<LiveEntry> entries;
  std::string problem;
};

[[nodiscard]] NamedEntries name_entries(const Device* device, const std::string& text);

/// Finds the entry that a text names.
[[nodiscard]] NamedEntries name_entry(const Device* device, const std::string& text);

/// The result of comparing the identity of a node with a file.
struct NodeCheck {
  std::string problem;       ///< empty: no contradiction
  std::string not_compared;  ///< `vendor-ID (not in drive.eds)`
};

[[nodiscard]] NodeCheck check_node(SdoAccess& node, const Device& device, const std::string& path);

/// Reports a failed block transfer that was followed by a segmented transfer.
void report_broken_block(const LiveEntry& entry, const SdoOutcome& outcome);

/// Reads the bytes of a file; returns false with the reason if it cannot be read.
[[nodiscard]] bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes, std::string& problem);

}  // namespace edsc

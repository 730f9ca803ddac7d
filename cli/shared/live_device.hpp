/// The EDS of a live node, and entries given by the user.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "load/load_device.hpp"
#include "online/live_entry.hpp"
#include "online/live_scales.hpp"

namespace edsc {

/// Loads the device of an EDS for this node. Invalid objects are skipped, and the number of errors is printed.
/// Ends the command if the file cannot be read as an EDS.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_live_device(const std::string& path, std::uint8_t node);

/// The device, if one was loaded.
[[nodiscard]] inline const Device* device_of(const std::unique_ptr<LoadedDevice>& loaded) {
  return loaded ? &*loaded->device : nullptr;
}

/// Finds the entries that a text names: one, or all readable ones of an object with sub-indices. Without a device the
/// text must be an address. Ends the command if it names none; `without_sheet` is the name of a node for which the
/// network file states no EDS.
[[nodiscard]] std::vector<LiveEntry> name_entries(const LoadedDevice* loaded, const std::string& text,
                                                  const std::string& without_sheet = {});

/// Finds the entry that a text names.
[[nodiscard]] LiveEntry name_entry(const LoadedDevice* loaded, const std::string& text,
                                   const std::string& without_sheet = {});

/// Compares the identity of a node with a file. Prints which numbers could not be compared; ends the command if others
/// differ, with a hint.
void check_node(SdoAccess& node, const Device& device, const std::string& path, std::string_view hint);

/// Reports that the identity or some of its numbers were not compared; nothing for an empty text.
void report_not_compared(const SdoAccess& node, const std::string& what);

/// Reports a failed block transfer that was followed by a segmented transfer.
void report_broken_block(const LiveEntry& entry, const SdoOutcome& outcome);

/// Reports values of the device that state a unit or scale and are not those of the EDS, each once, and one that could
/// not be read. Returns whether all could be read.
bool report_live_scales(LiveScales& scales);

/// Reads the bytes of a file; returns false with the reason if it cannot be read.
[[nodiscard]] bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes, std::string& problem);

}  // namespace edsc

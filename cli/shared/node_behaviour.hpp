/// What the nodes of `edsc node` and `edsc network run` do beyond the protocol: scripts and device profiles.
#pragma once

#include <cstdint>
#include <string>

#include "device/behaviour.hpp"
#include "device/device.hpp"
#include "lookup/find_entry.hpp"
#include "shared/common_options.hpp"

namespace edsc {

struct NodeBehaviour {
  BehaviourScript script;
  std::uint16_t profile = 0;  ///< the device profile that the node follows; 0: none
};

/// Reads the behaviour in a file. Prints the errors; returns false if it has one. `problem`: why it cannot be read.
[[nodiscard]] bool load_behaviour(const std::string& path, EntryFinder& names, const ColorOption& color,
                                  BehaviourScript& script, std::string& problem);

/// Adds a script. Ends the command if it has errors.
void add_script(NodeBehaviour& behaviour, const std::string& path, EntryFinder& names, const ColorOption& color);

/// Adds what the device profile in 1000h says. Returns false if there is nothing for this profile.
[[nodiscard]] bool add_device_profile(NodeBehaviour& behaviour, const Device& device, EntryFinder& names);

/// The low word of 1000h; 0 if it is not known.
[[nodiscard]] std::uint16_t device_profile(const Device& device);

}  // namespace edsc

/// The header of a network: its nodes, PDOs, links and signals as C++.
#pragma once

#include <string>
#include <vector>

#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// The parts of the header that are generated before it, each in the order of the nodes.
struct PlantParts {
  std::vector<std::string> devices;       ///< namespace and folder of the device's headers
  std::vector<std::string> concise_dcfs;  ///< bytes for 1F22h
};

/// Returns the text of `NAME.hpp`, with the namespace `name`. Without an NMT master, it does not have the description
/// for canopen::Plant.
[[nodiscard]] std::string plant_header(const Network& network, const std::string& name, const PlantParts& parts);

/// Returns the text of `network-devices.hpp`, which `NAME.hpp` includes: the headers of the devices, and a checksum of
/// all headers. Its name does not depend on the network and is not one of a namespace, so that a build can know it.
[[nodiscard]] std::string devices_header(const Network& network, const PlantParts& parts,
                                         const std::vector<OutputFile>& headers);

}  // namespace edsc

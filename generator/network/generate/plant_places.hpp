/// The lines of the network file and of the EDS files that a failed boot-up can contradict.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/network.hpp"

namespace edsc {

struct PlantPlaceRow {
  std::uint16_t index = 0;  ///< 0: the node itself
  std::uint8_t sub_index = 0;
  std::string file;  ///< the file name of the network file, or the path that it gives the file of a node
  std::uint32_t line = 0;
};

/// Returns the places of the node itself, of its identity, and of the entries of its concise DCF. A value that no file
/// states has none.
[[nodiscard]] std::vector<PlantPlaceRow> plant_places(const Network& network, const NetworkNode& node,
                                                      const std::string& concise_dcf);

}  // namespace edsc

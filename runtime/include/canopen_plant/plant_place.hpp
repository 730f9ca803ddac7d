/// Where the files of a network state what is compared with a node and written to it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt_master/boot_status.hpp"

namespace canopen {

/// A line of the network file or of the EDS of a node, which gives an entry its value.
struct PlantPlace {
  NodeId node_id;
  std::uint16_t index = 0;  ///< 0: the node itself, in the network file
  std::uint8_t sub_index = 0;
  std::string_view file;  ///< as the network file names it
  std::uint32_t line = 0;
};

/// Returns the line that a failed boot-up contradicts: of the entry, if the node refused it or has another value;
/// otherwise, such as for a node that does not answer, of the node itself. Null if there is none.
[[nodiscard]] constexpr const PlantPlace* find_place(std::span<const PlantPlace> places, NodeId node_id,
                                                     const BootResult& result) {
  constexpr std::uint16_t producer_heartbeat_time = 0x1017;
  const bool of_entry = result.status != BootStatus::extra_response &&
                        (result.status == BootStatus::configuration || result.abort_code == ok);
  const std::uint16_t index = result.status == BootStatus::no_heartbeat ? producer_heartbeat_time : result.index;
  const PlantPlace* of_node = nullptr;
  for (const PlantPlace& place : places) {
    if (place.node_id != node_id) continue;
    if (place.index == 0) of_node = &place;
    if (of_entry && index != 0 && place.index == index && place.sub_index == result.sub_index) return &place;
  }
  return of_node;
}

}  // namespace canopen

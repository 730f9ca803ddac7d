/// SDO transfers in the frames of a case: those that a failure is about.
#pragma once

#include <canopen/can/node_id.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conform/verdict.hpp"

namespace edsc::conform {

/// The positions of the frames of the last transfer of an entry through the default SDO; empty if there is none. Of a
/// long transfer the first two and the last two.
[[nodiscard]] std::vector<std::size_t> last_transfer(std::span<const SeenFrame> frames, canopen::NodeId node,
                                                     std::uint16_t index, std::uint8_t sub_index);

/// The writes among the transfers at these positions, which ascend, if the device has refused each of them. Empty if
/// one of the transfers is not a refused write.
[[nodiscard]] std::vector<RefusedWrite> refused_writes(std::span<const SeenFrame> frames, canopen::NodeId node,
                                                       std::span<const std::size_t> positions);

}  // namespace edsc::conform

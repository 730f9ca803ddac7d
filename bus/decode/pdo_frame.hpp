/// The contents of a PDO: the values of the mapped objects, or the one object of a multiplex PDO.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>

#include "decode/message.hpp"
#include "decode/node_model.hpp"

namespace edsc {

/// Also notes the values on which fields of other objects depend.
void append_pdo(const canopen::Frame& frame, const PdoLayout& pdo, NodeModel& node, Message& message);

/// The node whose object a multiplex PDO carries (CiA 301, 7.2.2.5).
struct MpdoAddress {
  bool destination = false;  ///< the node that receives the value, not the one that sends it
  std::uint8_t node_id = 0;  ///< 0: all nodes
};
[[nodiscard]] MpdoAddress mpdo_address_of(const canopen::Frame& frame);

/// `owner`: the node of the object; null if its EDS is not known.
void decode_mpdo(const canopen::Frame& frame, MpdoAddress address, const NodeModel* owner, Message& message);

}  // namespace edsc

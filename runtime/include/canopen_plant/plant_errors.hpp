/// The names of the error codes of nodes, for texts of EMCY messages on a host. A program that does not use them does
/// not contain them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "canopen/can/node_id.hpp"
#include "canopen/emcy/emcy_consumer.hpp"

namespace canopen {

/// A code as the manual of the device names it.
struct ErrorText {
  std::uint16_t code;
  std::string_view text;
};

/// The error codes of a node.
struct PlantErrors {
  NodeId node_id;
  std::span<const ErrorText> texts;
};

/// Returns the name that the device of the node gives to an error code, else the text of its class in CiA 301.
[[nodiscard]] constexpr std::string_view error_text(std::span<const PlantErrors> errors, NodeId node_id,
                                                    std::uint16_t code) {
  for (const PlantErrors& node : errors) {
    if (node.node_id != node_id) continue;
    for (const ErrorText& one : node.texts) {
      if (one.code == code) return one.text;
    }
  }
  return emergency_text(code);
}

}  // namespace canopen

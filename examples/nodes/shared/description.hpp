/// The description of a runnable node.
#pragma once

namespace nodes {

/// The texts of a node for `--help`.
struct Description {
  const char* program;  ///< its name
  const char* device;   ///< one line
  const char* node_id;  ///< the node-ID without --node-id
  const char* inputs;   ///< the lines that it accepts on standard input, each after two spaces
  int highest_node_id = 127;
};

}  // namespace nodes

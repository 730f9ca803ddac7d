/// What a runnable node says of itself.
#pragma once

namespace nodes {

/// What `--help` says of a node.
struct Description {
  const char* program;  ///< its name
  const char* device;   ///< one line
  const char* node_id;  ///< which one it has without --node-id
  const char* inputs;   ///< the lines that it takes on standard input, with two spaces before each
  int highest_node_id = 127;
};

}  // namespace nodes

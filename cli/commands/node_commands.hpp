/// Commands to the nodes of `edsc node` on standard input.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/behaving_node.hpp"
#include "lookup/find_entry.hpp"
#include "shared/common_options.hpp"

namespace edsc {

/// A node, and the names of the objects in its EDS.
struct CommandedNode {
  BehavingNode* node;
  EntryFinder* names;
};

/// Executes lines of standard input, and answers each with a line. The end of standard input does not end anything. A
/// process in the background does not read a terminal.
class NodeCommands {
 public:
  NodeCommands(std::vector<CommandedNode> nodes, const ColorOption& color);

  /// Executes the lines that can be read without waiting. Returns false after `quit`.
  [[nodiscard]] bool serve();
  /// Whether there may be more lines.
  [[nodiscard]] bool is_open() const { return open_; }

 private:
  void read_lines();
  /// Returns the answer to a line.
  [[nodiscard]] std::string execute(std::string_view line);
  [[nodiscard]] std::string execute(CommandedNode& node, std::string_view line);
  [[nodiscard]] std::string add_script(CommandedNode& node, const std::string& path) const;
  /// The node whose node-ID is before the colon of a line, which is removed.
  [[nodiscard]] CommandedNode* node_of(std::string_view& line, std::string& problem);

  std::vector<CommandedNode> nodes_;
  const ColorOption& color_;
  std::string text_;  ///< read, but not executed
  bool open_ = true;
  bool ended_ = false;
};

}  // namespace edsc

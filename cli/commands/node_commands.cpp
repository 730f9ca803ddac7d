#include "commands/node_commands.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <system_error>
#include <utility>

#include "device/behaviour_commands.hpp"
#include "shared/node_behaviour.hpp"
#include "shared/output.hpp"
#include "system/available_input.hpp"
#include "text/ascii.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr std::size_t longest_line = 65536;

std::string error_answer(const std::string& problem) { return "error: " + problem; }

}  // namespace

NodeCommands::NodeCommands(std::vector<CommandedNode> nodes, const ColorOption& color)
    : nodes_{std::move(nodes)}, color_{color} {}

bool NodeCommands::serve() {
  if (open_) read_lines();
  for (std::size_t end = 0; !ended_ && (end = text_.find('\n')) != std::string::npos;) {
    const std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    if (trim(line).empty()) continue;
    if (trim(line) == "help") {
      fmt::print("{}ok\n", commands_help());
    } else {
      print_visibly(stdout, "{}\n", execute(line));
    }
    flush_output();
  }
  return !ended_;
}

void NodeCommands::read_lines() {
  open_ = read_available_input(text_) == InputState::open;
  if (!open_) text_ += '\n';
  if (text_.size() > longest_line && text_.find('\n') == std::string::npos) text_ = "\n";
}

std::string NodeCommands::execute(std::string_view line) {
  const std::vector<std::string> words = command_words(line);
  if (words.size() == 1 && words[0] == "quit") {
    ended_ = true;
    return "ok";
  }
  std::string problem;
  CommandedNode* const node = node_of(line, problem);
  return node == nullptr ? error_answer(problem) : execute(*node, line);
}

CommandedNode* NodeCommands::node_of(std::string_view& line, std::string& problem) {
  line = trim(line);
  unsigned node_id = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), node_id);
  if (error != std::errc{} || end == line.data() + line.size() || *end != ':') {
    if (nodes_.size() == 1) return &nodes_.front();
    problem = "the node-ID is missing, as in 5: state";
    return nullptr;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  for (CommandedNode& one : nodes_) {
    if (one.node->node_id().value() == node_id) return &one;
  }
  problem = fmt::format("edsc node does not have a node {}", node_id);
  return nullptr;
}

std::string NodeCommands::execute(CommandedNode& node, std::string_view line) {
  const ParsedCommand command = parse_command(line, *node.names);
  if (!command.problem.empty()) return error_answer(command.problem);
  if (command.program_command == "script") return add_script(node, command.argument);
  if (!command.program_command.empty()) return error_answer(command.program_command + " does not have a node-ID");
  const CommandAnswer answer = command.action(node.node->behaviour());
  if (!answer.ok) return error_answer(answer.text);
  return answer.text.empty() ? "ok" : "ok " + answer.text;
}

std::string NodeCommands::add_script(CommandedNode& node, const std::string& path) const {
  BehaviourScript script;
  std::string problem;
  if (!load_behaviour(path, *node.names, color_, script, problem))
    return error_answer(problem.empty() ? path + " has errors" : problem);
  node.node->behaviour().add(script);
  return "ok";
}

}  // namespace edsc

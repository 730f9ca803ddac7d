#include "network/generate/network_dot.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/generate/plant_links.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

/// Text for a string in quotes.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string box(const Network& network, const NetworkNode& node) {
  std::string label = fmt::format("{}\\nnode-ID {}", escaped(node.name), node.node_id);
  if (node.is_master) label += "\\nNMT master";
  const WrittenText& producer = network.description.sync.producer;
  if (producer && producer->value == node.name) label += "\\nSYNC producer";
  return fmt::format("  \"{}\" [label=\"{}\"];\n", escaped(node.name), label);
}

/// `position_actual_value`, with a line for each object.
std::string objects(const NetworkNode& node, const Pdo& pdo) {
  std::string lines;
  for (const PdoEntry& mapped : pdo.entries) {
    if (mapped.object == nullptr) continue;
    const Object* const object = node.device().find(mapped.index);
    lines += "\\n" + escaped(object != nullptr && object->has_sub_indices()
                                 ? fmt::format("{} {}", object->name, mapped.object->name)
                                 : mapped.object->name);
  }
  return lines;
}

}  // namespace

std::string network_dot(const Network& network) {
  const std::string name{stem_of(network.source->name())};
  std::string text = fmt::format("digraph \"{}\" {{\n  rankdir=LR;\n  node [shape=box];\n", escaped(name));
  for (const NetworkNode& node : network.nodes) text += box(network, node);
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  for (const auto& [sender, receiver] : pdo_links(uses)) {
    text += fmt::format("  \"{}\" -> \"{}\" [label=\"{} to {}, {}{}\"];\n", escaped(sender->node->name),
                        escaped(receiver->node->name), pdo_label(*sender->pdo), pdo_label(*receiver->pdo),
                        can_id_text(sender->can_id, sender->extended), objects(*sender->node, *sender->pdo));
  }
  return text + "}\n";
}

}  // namespace edsc

#include "network/network.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnostics/quote.hpp"
#include "text/suggestion.hpp"

namespace edsc {

const NetworkNode* Network::find(std::string_view name) const {
  const auto at = std::ranges::find(nodes, name, &NetworkNode::name);
  return at == nodes.end() ? nullptr : &*at;
}

bool Network::lists(std::string_view name) const {
  return std::ranges::any_of(description.nodes, [&](const NodeDescription& one) { return one.name.value == name; });
}

std::string Network::unknown_node(std::string_view name) const {
  std::vector<std::string_view> names;
  for (const NetworkNode& node : nodes) names.push_back(node.name);
  return fmt::format("unknown node {}{}", quote(name), did_you_mean(name, names));
}

const NetworkNode* Network::master() const {
  const auto at = std::ranges::find(nodes, true, &NetworkNode::is_master);
  return at == nodes.end() ? nullptr : &*at;
}

const Device& NetworkNode::device() const {
  static const Device without_objects;
  if (configured) return *configured;
  return loaded != nullptr ? *loaded->device : without_objects;
}

std::optional<std::uint64_t> value_of(const Device& device, std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const entry = device.find(index, sub_index);
  return entry != nullptr && entry->default_value ? std::optional{entry->default_value->bits} : std::nullopt;
}

Position place_of_value(const Device& device, std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const entry = device.find(index, sub_index);
  return entry != nullptr ? default_place(*entry) : Position{device.source};
}

}  // namespace edsc

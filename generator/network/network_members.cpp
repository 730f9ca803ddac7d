#include "network/network_members.hpp"

namespace edsc {
namespace {

template <class Predicate>
std::vector<const Entry*> network_entries(const NetworkNode& node, Predicate predicate) {
  std::vector<const Entry*> entries;
  if (node.loaded == nullptr || !node.loaded->names) return entries;
  for (const Object& object : node.device().objects) {
    for (const Entry& entry : object.entries) {
      if (predicate(entry)) entries.push_back(&entry);
    }
  }
  return entries;
}

}  // namespace

NamedInNetwork named_in_network(std::span<const std::string> object, std::string_view member) {
  if (object.size() == 1 && object.front() == "sync" && member == "producer") return NamedInNetwork::nodes;
  if (object.size() != 2 || object.front() != "signals") return NamedInNetwork::nothing;
  if (member == "from") return NamedInNetwork::nodes;
  if (member == "object") return NamedInNetwork::entries;
  return member == "to" ? NamedInNetwork::receivers : NamedInNetwork::nothing;
}

std::vector<const Entry*> settable_entries(const NetworkNode& node) {
  return network_entries(node, [](const Entry& entry) { return canopen::writable(entry.access); });
}

std::vector<const Entry*> mappable_entries(const NetworkNode& node, canopen::Mappable direction) {
  if (!node.has_file()) return {};
  return network_entries(node, [&](const Entry& entry) { return canopen::allows(entry.mappable(), direction); });
}

bool is_network_text(std::string_view text) {
  const auto has = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  if (has("deviations.schema.json") || has("options.schema.json")) return false;
  return has("network.schema.json") || has("\"nodes\"");
}

}  // namespace edsc

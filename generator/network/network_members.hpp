/// What a network file can have at a place: the members of an object, and the names that a text can be.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "network/network.hpp"

namespace edsc {

/// Calls `visit` with the rows of the members that the object at a path has: `network_members` for the file,
/// `node_members` for `nodes`, `axis1`. Returns false, without a call, for another path.
template <class Visit>
bool visit_network_members(std::span<const std::string> path, Visit&& visit) {
  if (path.empty()) {
    visit(network_members);
  } else if (path.size() == 1 && path.front() == "sync") {
    visit(sync_members);
  } else if (path.size() == 1 && path.front() == "assume") {
    visit(assume_members);
  } else if (path.size() == 2 && path.front() == "nodes") {
    visit(node_members);
  } else if (path.size() == 2 && path.front() == "signals") {
    visit(signal_members);
  } else {
    return false;
  }
  return true;
}

/// Members of the file that are not rows of a table.
inline constexpr std::string_view network_objects[] = {"sync", "assume", "nodes", "signals"};

/// What the text of a member names.
enum class NamedInNetwork : std::uint8_t {
  nothing,
  nodes,
  entries,    ///< of the node that sends
  receivers,  ///< nodes, and `NODE.ENTRY`
};
[[nodiscard]] NamedInNetwork named_in_network(std::span<const std::string> object, std::string_view member);

/// The entries that `set` can have.
[[nodiscard]] std::vector<const Entry*> settable_entries(const NetworkNode& node);
/// The entries that PDOs of a direction can map; none of a master without a file.
[[nodiscard]] std::vector<const Entry*> mappable_entries(const NetworkNode& node, canopen::Mappable direction);

/// Whether the text of a JSON file is meant as a network file.
[[nodiscard]] bool is_network_text(std::string_view text);

}  // namespace edsc

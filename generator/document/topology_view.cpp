#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "compare/compare_parts.hpp"
#include "device/complete_device.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "document/views.hpp"
#include "network/cob_id_use.hpp"
#include "network/communication_objects.hpp"
#include "text/counted.hpp"

namespace edsc::document {
namespace {

/// The drawing in units of SVG: a column for each node, a row for each CAN-ID.
constexpr std::size_t label_width = 150;
constexpr std::size_t head_height = 52;
constexpr std::size_t row_height = 34;
constexpr std::size_t max_row_label = 21;  ///< characters before a row

/// The columns of the nodes share the width of a page, as far as names remain legible.
constexpr std::size_t columns_width = 1100;
constexpr std::size_t min_column_width = 84;
constexpr std::size_t max_column_width = 132;
constexpr std::size_t box_gap = 8;
constexpr std::size_t name_character_width = 7;  ///< of the names of nodes, on average

std::size_t column_width(const Network& network) {
  const std::size_t count = std::max<std::size_t>(network.nodes.size(), 1);
  return std::clamp(columns_width / count, min_column_width, max_column_width);
}

/// A CAN-ID, the node that sends it, and those that receive it.
struct Link {
  const CobIdUse* sender = nullptr;
  std::vector<const CobIdUse*> receivers;
};

bool is_drawn(FrameService service) { return service == FrameService::pdo || service == FrameService::sync; }

std::vector<Link> links_of(const std::vector<CobIdUse>& uses) {
  std::vector<Link> links;
  for (const CobIdUse& sender : uses) {
    if (!sender.transmits || !is_drawn(sender.service)) continue;
    Link link{&sender, {}};
    for (const CobIdUse& receiver : uses) {
      if (!receiver.transmits && receiver.node != sender.node && receiver.service == sender.service &&
          receiver.can_id == sender.can_id && receiver.extended == sender.extended) {
        link.receivers.push_back(&receiver);
      }
    }
    links.push_back(std::move(link));
  }
  std::ranges::stable_sort(links, {}, [](const Link& link) { return link.sender->can_id; });
  return links;
}

std::size_t row_y(std::size_t row) { return head_height + row * row_height + row_height / 2 + 6; }

/// `Statusword, Position actual value` of a PDO; `Read input: Input 0, Input 1` of entries of one object.
std::string contents_of(const CobIdUse& use) {
  std::string text;
  if (use.pdo == nullptr) return text;
  const Object* last = nullptr;
  for (const PdoEntry& mapped : use.pdo->entries) {
    if (mapped.object == nullptr) continue;
    const Object* const object = use.node->device().find(mapped.index);
    const bool is_sub = object != nullptr && object->has_sub_indices();
    text += text.empty() ? "" : ", ";
    text += is_sub && object != last ? fmt::format("{}: {}", object->name, mapped.object->name) : mapped.object->name;
    last = object;
  }
  return text;
}

/// The names of the mapped entries without those of their objects, for the drawing.
std::string entry_names_of(const CobIdUse& use) {
  std::string text;
  if (use.pdo == nullptr) return text;
  for (const PdoEntry& mapped : use.pdo->entries) {
    if (mapped.object != nullptr) text += (text.empty() ? "" : ", ") + mapped.object->name;
  }
  return text;
}

std::string pdo_transmission(const CobIdUse& use) {
  if (use.pdo == nullptr) return "";
  return transmission_text(
      communication_default(*use.pdo, transmission_type_sub_index).value_or(default_transmission_type));
}

class Topology {
 public:
  explicit Topology(const Network& network) : network_{network}, uses_{cob_id_uses(network)}, links_{links_of(uses_)} {
    std::ranges::copy_if(links_, std::back_inserter(drawn_), [](const Link& link) { return !link.receivers.empty(); });
  }

  void add(Json& view) const {
    Json links = Json::array();
    Json unreceived = Json::array();
    for (const Link& link : links_) (link.receivers.empty() ? unreceived : links).push_back(link_view(link));
    view["has_links"] = !links.empty();
    view["has_unreceived"] = !unreceived.empty();
    view["unreceived_text"] = counted(unreceived.size(), "message");
    view["links"] = std::move(links);
    view["unreceived"] = std::move(unreceived);
    view["topology"] = drawn_.empty() ? Json(nullptr) : drawing();
  }

  [[nodiscard]] Json drawing() const {
    Json nodes = Json::array();
    const std::size_t height = head_height + drawn_.size() * row_height + 12;
    for (const NetworkNode& node : network_.nodes) {
      const std::size_t x = column_x(&node);
      nodes.push_back({{"node_x", x},
                       {"box_x", x - box_width() / 2},
                       {"node_name", node.name},
                       {"node_short", shortened(node.name, box_width() / name_character_width)},
                       {"node_role", fmt::format("{} {}", node.is_master ? "master" : "node", node.node_id)}});
    }
    Json rows = Json::array();
    std::string label = "Message flow: sender, PDO, receivers.";
    for (std::size_t row = 0; row < drawn_.size(); ++row) {
      rows.push_back(row_view(drawn_[row], row));
      label += fmt::format(" {} to {}.", named(*drawn_[row].sender), receivers_text(drawn_[row]));
    }
    return {{"topology_label", label},   {"topology_width", label_width + network_.nodes.size() * column_},
            {"topology_height", height}, {"line_end", height - 6},
            {"box_width", box_width()},  {"nodes", std::move(nodes)},
            {"rows", std::move(rows)}};
  }

 private:
  [[nodiscard]] std::size_t column_x(const NetworkNode* node) const {
    const auto number = static_cast<std::size_t>(node - network_.nodes.data());
    return label_width + number * column_ + column_ / 2;
  }

  [[nodiscard]] std::size_t box_width() const { return column_ - box_gap; }

  [[nodiscard]] static std::string receivers_text(const Link& link) {
    std::string text;
    for (const CobIdUse* receiver : link.receivers) {
      text += (text.empty() ? "" : ", ") + (receiver->pdo != nullptr ? named(*receiver) : receiver->node->name);
    }
    return text;
  }

  [[nodiscard]] static Json link_view(const Link& link) {
    return {{"can_id", can_id_text(link.sender->can_id, link.sender->extended)},
            {"sender", named(*link.sender)},
            {"receivers", shown(receivers_text(link))},
            {"contents", contents_of(*link.sender)},
            {"transmission", pdo_transmission(*link.sender)}};
  }

  [[nodiscard]] Json row_view(const Link& link, std::size_t row) const {
    const std::size_t y = row_y(row);
    const std::size_t from = column_x(link.sender->node);
    Json arrows = Json::array();
    for (const CobIdUse* receiver : link.receivers) {
      const std::size_t to = column_x(receiver->node);
      const std::size_t back = to > from ? to - 9 : to + 9;
      arrows.push_back(
          {{"to", to}, {"shaft", back}, {"head", fmt::format("{},{} {},{} {},{}", to, y, back, y - 5, back, y + 5)}});
    }
    const std::string name = fmt::format("{} {}", can_id_text(link.sender->can_id, link.sender->extended),
                                         link.sender->pdo != nullptr ? pdo_label(*link.sender->pdo) : "SYNC");
    const std::string contents = entry_names_of(*link.sender);
    return {{"y", y},
            {"name_y", contents.empty() ? y + 4 : y - 1},
            {"contents_y", y + 12},
            {"row_name", shortened(name, max_row_label)},
            {"row_contents", shown(shortened(contents, max_row_label + 3))},
            {"tooltip", fmt::format("{}: {}", named(*link.sender), contents_of(*link.sender))},
            {"from", from},
            {"is_sync", link.sender->service == FrameService::sync},
            {"arrows", std::move(arrows)}};
  }

  const Network& network_;
  std::vector<CobIdUse> uses_;
  std::vector<Link> links_;
  std::vector<Link> drawn_;  ///< with receivers
  std::size_t column_ = column_width(network_);
};

}  // namespace

void add_topology(const Network& network, Json& view) { Topology{network}.add(view); }

Json topology_drawing(const Network& network) { return Topology{network}.drawing(); }

}  // namespace edsc::document

#include "lsp/network_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "lookup/find_entry.hpp"
#include "network/network_members.hpp"
#include "text/markdown.hpp"

namespace edsc::lsp {
namespace {

constexpr std::string_view element = "[]";

struct OpenLevel {
  bool is_array = false;
  bool has_name = false;  ///< of the member whose value follows
  std::string name;
};

/// The member of `path` in the table of its object: `nodes.axis1.eds`.
std::optional<std::string_view> meaning_of(const std::vector<std::string>& path, std::string_view name) {
  std::optional<std::string_view> meaning;
  visit_network_members(path, [&](const auto& rows) {
    for (const auto& row : rows) {
      if (row.name == name) meaning = row.meaning;
    }
  });
  return meaning;
}

template <class Rows>
void offer_members(const Rows& rows, std::vector<JsonOffer>& offers) {
  for (const auto& row : rows)
    offers.push_back({std::string{row.name}, std::string{row.meaning}, std::string{row.name}});
}

void offer_names(const JsonPlaceInText& place, const Network* network, std::vector<JsonOffer>& offers) {
  const std::vector<std::string>& path = place.path;
  visit_network_members(path, [&](const auto& rows) { offer_members(rows, offers); });
  if (path.empty()) {
    for (const std::string_view name : network_objects) offers.push_back({std::string{name}, "", std::string{name}});
  } else if (path.size() == 3 && path.front() == "nodes" && path.back() == "set" && network != nullptr) {
    const NetworkNode* const node = network->find(path[1]);
    if (node == nullptr) return;
    for (const Entry* entry : settable_entries(*node)) {
      offers.push_back(
          {node->named().identifiers().full(*entry), named(*entry), entry_label(entry->index, entry->sub_index)});
    }
  }
}

void offer_entries(const NetworkNode& node, canopen::Mappable direction, const std::string& prefix,
                   std::vector<JsonOffer>& offers) {
  for (const Entry* entry : mappable_entries(node, direction)) {
    const std::string name = prefix + node.named().identifiers().full(*entry);
    offers.push_back({name, named(*entry), name});
  }
}

/// The text of the member `from` of the signal around the cursor.
std::string sender_at(std::string_view document, const JsonPlaceInText& place) {
  const std::size_t open = document.rfind('{', place.begin);
  const std::size_t close = document.find('}', place.begin);
  if (open == std::string_view::npos) return {};
  std::string_view signal = document.substr(open, close == std::string_view::npos ? close : close - open);
  const std::size_t name = signal.find("\"from\"");
  if (name == std::string_view::npos) return {};
  signal.remove_prefix(name + std::string_view{"\"from\""}.size());
  const std::size_t begin = signal.find('"');
  const std::size_t end = begin == std::string_view::npos ? begin : signal.find('"', begin + 1);
  return end == std::string_view::npos ? std::string{} : std::string{signal.substr(begin + 1, end - begin - 1)};
}

void offer_values(const View& view, const JsonPlaceInText& place, const Network& network,
                  std::vector<JsonOffer>& offers) {
  const std::vector<std::string>& path = place.path;
  const auto offer_nodes = [&](const std::string& end) {
    for (const NodeDescription& node : network.description.nodes) {
      const NetworkNode* const known = network.find(node.name.value);
      offers.push_back(
          {node.name.value + end, known != nullptr ? known->device().product_name : "", node.name.value + end});
    }
  };
  const std::size_t members = !path.empty() && path.front() == "signals" ? 2 : 1;  // before the name of the member
  if (path.size() <= members) return;
  switch (named_in_network(std::span{path}.first(members), path[members])) {
    case NamedInNetwork::nothing: return;
    case NamedInNetwork::nodes: return offer_nodes("");
    case NamedInNetwork::entries: {
      const NetworkNode* const node = network.find(sender_at(view.analysis.own->text(), place));
      if (node != nullptr) offer_entries(*node, canopen::Mappable::tpdo, "", offers);
      return;
    }
    case NamedInNetwork::receivers:
      offer_nodes("");
      for (const NetworkNode& node : network.nodes) {
        offer_entries(node, canopen::Mappable::rpdo, node.name + ".", offers);
      }
  }
}

const Entry* entry_named(const NetworkNode& node, std::string_view name) {
  if (node.loaded == nullptr || !node.loaded->names) return nullptr;
  const FoundEntry found = find_one_entry(node.named(), name);
  return found.ok() ? found.entry : nullptr;
}

}  // namespace

JsonPlaceInText json_place(std::string_view text, std::size_t offset) {
  std::vector<OpenLevel> levels;
  JsonPlaceInText place;
  std::size_t at = 0;
  const auto skip_string = [&](std::size_t from) {
    std::size_t end = from;
    while (end < text.size() && text[end] != '"' && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
    return std::min(end, text.size());
  };
  while (at < offset && at < text.size()) {
    const char c = text[at];
    if (c == '"') {
      const std::size_t end = skip_string(at + 1);
      const bool is_name = !levels.empty() && !levels.back().is_array && !levels.back().has_name;
      if (end >= offset) {
        place.is_in_string = true;
        place.is_name = is_name;
        place.begin = at + 1;
        place.end = end;
        place.text = text.substr(at + 1, end - at - 1);
        break;
      }
      if (is_name) {
        levels.back().name = text.substr(at + 1, end - at - 1);
      }
      at = end + 1;
      continue;
    }
    if (c == '/' && text.substr(at).starts_with("//")) {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '{' || c == '[') levels.push_back({c == '[', false, {}});
    if ((c == '}' || c == ']') && !levels.empty()) levels.pop_back();
    if (c == ':' && !levels.empty()) levels.back().has_name = true;
    if (c == ',' && !levels.empty()) levels.back().has_name = false;
    ++at;
  }
  for (const OpenLevel& level : levels) {
    if (level.is_array) {
      place.path.emplace_back(element);
    } else if (level.has_name) {
      place.path.push_back(level.name);
    }
  }
  return place;
}

std::size_t offset_in(const View& view, const TextPosition& at) {
  const SourceFile& own = *view.analysis.own;
  if (at.line >= own.lines()) return own.text().size();
  const std::string_view line = own.line(at.line + 1);
  return static_cast<std::size_t>(line.data() - own.text().data()) + view.column_of(at) - 1;
}

const Network* network_of(const View& view) {
  const auto usable = [](const Analysis* analysis) {
    return analysis != nullptr && analysis->network && !analysis->network->network.nodes.empty();
  };
  if (usable(&view.analysis)) return &view.analysis.network->network;
  return usable(view.document.last_network.get()) ? &view.document.last_network->network->network : nullptr;
}

NetworkTarget network_target(const Network& network, const JsonPlaceInText& place, std::string_view document) {
  const std::vector<std::string>& path = place.path;
  if (path.empty() || !place.is_in_string) return {};
  if (path.front() == "nodes") {
    if (place.is_name && path.size() == 1) return {network.find(place.text), nullptr};
    const NetworkNode* const node = path.size() >= 2 ? network.find(path[1]) : nullptr;
    if (node == nullptr) return {};
    const bool is_setting = place.is_name && path.size() == 3 && path[2] == "set";
    return {node, is_setting ? entry_named(*node, place.text) : nullptr};
  }
  if (path.front() == "sync") return {network.find(place.text), nullptr};
  if (path.front() != "signals" || path.size() < 3 || place.is_name) return {};
  if (path[2] == "from") return {network.find(place.text), nullptr};
  const std::size_t dot = place.text.find('.');
  const NetworkNode* const by_prefix = network.find(std::string_view{place.text}.substr(0, dot));
  if (path[2] == "to" || (by_prefix != nullptr && dot != std::string::npos)) {
    if (by_prefix == nullptr || dot == std::string::npos) return {by_prefix, nullptr};
    return {by_prefix, entry_named(*by_prefix, std::string_view{place.text}.substr(dot + 1))};
  }
  const NetworkNode* const sender = network.find(sender_at(document, place));
  if (path[2] != "object" || sender == nullptr) return {};
  return {sender, entry_named(*sender, place.text)};
}

std::string describe_network_place(const View& view, const TextPosition& at) {
  const std::string_view text = view.analysis.own->text();
  const JsonPlaceInText place = json_place(text, offset_in(view, at));
  if (!place.is_in_string) return {};
  if (place.is_name) {
    if (const auto meaning = meaning_of(place.path, place.text)) {
      return fmt::format("**{}**: {}", markdown_text(place.text), *meaning);
    }
  }
  const Network* const network = network_of(view);
  if (network == nullptr) return {};
  const NetworkTarget target = network_target(*network, place, text);
  if (target.node == nullptr) return {};
  if (target.entry != nullptr) {
    return describe(*target.node->loaded, target.node->device(), {target.entry->index, target.entry->sub_index});
  }
  return fmt::format("**{}**: node {}, {}", markdown_text(target.node->name), unsigned{target.node->node_id},
                     markdown_text(target.node->device().product_name));
}

Json completion_items(const View& view, const TextPosition& at, const JsonPlaceInText& place,
                      std::vector<JsonOffer> offers) {
  Json items = Json::array();
  const std::uint32_t column = static_cast<std::uint32_t>(
      place.begin - static_cast<std::size_t>(view.line(at.line + 1).data() - view.analysis.own->text().data()) + 1);
  const TextRange range = range_in(*view.analysis.own, at.line + 1, column, place.end - place.begin, view.encoding);
  for (JsonOffer& offer : offers) {
    items.push_back({{"label", offer.label},
                     {"detail", std::move(offer.detail)},
                     {"filterText", std::move(offer.label)},
                     {"textEdit", {{"range", to_json(range)}, {"newText", std::move(offer.text)}}}});
  }
  return items;
}

Json network_completion(const View& view, const TextPosition& at) {
  const JsonPlaceInText place = json_place(view.analysis.own->text(), offset_in(view, at));
  if (!place.is_in_string) return Json::array();
  const Network* const network = network_of(view);
  std::vector<JsonOffer> offers;
  if (place.is_name) {
    offer_names(place, network, offers);
  } else if (network != nullptr) {
    offer_values(view, place, *network, offers);
  }
  return completion_items(view, at, place, std::move(offers));
}

}  // namespace edsc::lsp

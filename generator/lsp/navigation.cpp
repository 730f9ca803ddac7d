#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "change/sheet_text.hpp"
#include "diagnostics/place.hpp"
#include "lookup/find_entry.hpp"
#include "lsp/features.hpp"
#include "lsp/network_place.hpp"
#include "lsp/sheet_place.hpp"
#include "network/resolve_signals.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/overlay_keys.hpp"

namespace edsc::lsp {
namespace {

enum SymbolKinds { namespace_symbol = 3, class_symbol = 5, field_symbol = 8, event_symbol = 24 };

/// The section of an object or entry; of a VAR, that of its object. A position without a file if there is none.
Position declaration_of(const DataSheet& sheet, const EntryAddress& address) {
  const ObjectDescription* const object = sheet.find(address.index);
  if (object == nullptr) return {};
  const SubObjectDescription* const sub = address.sub_index ? object->find(*address.sub_index) : nullptr;
  return sub != nullptr ? sub->position : object->position;
}

Json location_of_file(const std::string& path) { return {{"uri", uri_of_file(path)}, {"range", to_json(TextRange{})}}; }

Json definition_in_network(const View& view, const TextPosition& at) {
  const Network* const network = network_of(view);
  if (network == nullptr) return nullptr;
  const JsonPlaceInText place = json_place(view.analysis.own->text(), offset_in(view, at));
  const bool names_file = !place.is_name && !place.path.empty() &&
                          (place.path.back() == "eds" || place.path.back() == "dcf" || place.path.back() == "options" ||
                           place.path.back() == "dbc");
  if (place.is_in_string && names_file) return location_of_file(path_beside(view.document.path, place.text));
  const NetworkTarget target = network_target(*network, place, view.analysis.own->text());
  if (target.node == nullptr) return nullptr;
  if (target.entry == nullptr) return location_of(target.node->position, view.encoding);
  return location_of(target.entry->position, view.encoding);
}

/// Places of an entry, or of all entries of an object.
class References {
 public:
  References(const View& view, const EntryAddress& target) : view_{view}, target_{target} {}

  Json run(bool with_declaration) {
    const LoadedDevice& loaded = *view_.analysis.loaded;
    if (with_declaration) add(declaration_of(loaded.sheet, target_));
    for (const ListedObject& listed : loaded.sheet.listed) {
      if (listed.index == target_.index) add(listed.position);
    }
    for (const Pdo& pdo : loaded.device->pdos) {
      for (const PdoEntry& mapped : pdo.entries) {
        if (is_target(mapped.index, mapped.sub_index)) add(mapped.place);
      }
    }
    for (auto& [uri, document] : view_.workspace.documents()) {
      if (document.kind != DocumentKind::network) continue;
      const Analysis& analysis = view_.workspace.analyse(document);
      if (analysis.network) add_network(analysis.network->network);
    }
    return std::move(locations_);
  }

 private:
  [[nodiscard]] bool is_target(std::uint16_t index, std::uint8_t sub_index) const {
    return index == target_.index && (!target_.sub_index || sub_index == *target_.sub_index);
  }

  void add(const Position& position) {
    Json location = location_of(position, view_.encoding);
    if (!location.is_null()) locations_.push_back(std::move(location));
  }

  [[nodiscard]] bool has_device(const NetworkNode& node) const {
    if (!node.has_file() || node.loaded == nullptr) return false;
    const std::vector<std::string> files = input_files(*node.loaded);
    return std::ranges::find(files, view_.document.path) != files.end();
  }

  void add_network(const Network& network) {
    Diagnostics ignored;
    for (const Signal& signal : resolve_signals(network, ignored)) {
      const auto is_here = [&](const SignalEnd& end) {
        return end.owner != nullptr && end.owner == end.node && end.entry != nullptr && has_device(*end.owner) &&
               is_target(end.entry->index, end.entry->sub_index);
      };
      if (is_here(signal.from))
        add(signal.description->object ? signal.description->object->position : signal.description->position);
      for (std::size_t i = 0; i < signal.to.size() && i < signal.description->to.size(); ++i) {
        if (is_here(signal.to[i])) add(signal.description->to[i].position);
      }
    }
    for (const NetworkNode& node : network.nodes) {
      if (!has_device(node)) continue;
      for (const WrittenValue& value : node.description->set) {
        const FoundEntry found = find_entry(node.named(), value.entry.value);
        if (found.entry != nullptr && is_target(found.entry->index, found.entry->sub_index)) add(value.entry.position);
      }
    }
  }

  const View& view_;
  EntryAddress target_;
  Json locations_ = Json::array();
};

std::string name_in(const IniSection& section) {
  const IniEntry* const name = section.find("ParameterName");
  return name == nullptr ? std::string{} : std::string{current_value(*name)};
}

Json symbol_of(const View& view, const IniSection& section, const std::string& label, int kind, std::uint32_t end) {
  const TextRange header =
      range_in(*view.analysis.own, section.line, section.column, section.name.size(), view.encoding);
  TextRange whole = range_in(*view.analysis.own, end, 1, view.line(end).size(), view.encoding);
  whole.start = {section.line - 1, 0};
  return {{"name", label.empty() ? "[]" : label},
          {"kind", kind},
          {"range", to_json(whole)},
          {"selectionRange", to_json(header)},
          {"children", Json::array()}};
}

Json network_symbols(const View& view) {
  Json symbols = Json::array();
  if (!view.analysis.network) return symbols;
  const NetworkDescription& description = view.analysis.network->network.description;
  const auto add = [&](const std::string& name, int kind, const Position& position) {
    const Json range = to_json(range_of(position, view.encoding));
    if (!name.empty()) symbols.push_back({{"name", name}, {"kind", kind}, {"range", range}, {"selectionRange", range}});
  };
  for (const NodeDescription& node : description.nodes) add(node.name.value, class_symbol, node.name.position);
  for (const SignalDescription& signal : description.signals) {
    if (signal.from && signal.object) {
      add(signal.from->value + "." + signal.object->value, event_symbol, signal.object->position);
    }
  }
  return symbols;
}

}  // namespace

Json definition(const View& view, const TextPosition& at) {
  if (view.document.kind == DocumentKind::network) return definition_in_network(view, at);
  if (!view.is_sheet() || !view.analysis.loaded) return nullptr;
  const SheetPlace place = place_in(view.analysis.ini, at.line + 1, view.column_of(at));
  if (place.entry != nullptr && place.is_in_value && equal_ignoring_case(place.section->name, overlay_section) &&
      equal_ignoring_case(place.entry->key, "Base")) {
    return location_of_file(path_beside(view.document.path, place.entry->value));
  }
  const auto target = target_of(place);
  return target ? location_of(declaration_of(view.analysis.loaded->sheet, *target), view.encoding) : Json(nullptr);
}

Json references(const View& view, const TextPosition& at, bool with_declaration) {
  if (!view.is_sheet() || view.analysis.device() == nullptr) return Json::array();
  const auto target = target_of(place_in(view.analysis.ini, at.line + 1, view.column_of(at)));
  return target ? References{view, *target}.run(with_declaration) : Json::array();
}

Json document_symbols(const View& view) {
  if (view.document.kind == DocumentKind::network) return network_symbols(view);
  Json symbols = Json::array();
  if (!view.is_sheet()) return symbols;
  const std::vector<IniSection>& sections = view.analysis.ini.sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const IniSection& section = sections[i];
    const std::uint32_t end = section.entries.empty() ? section.line : section.entries.back().line;
    const SectionName name = read_section_name(section.name, view.analysis.own->choices().sub_indices);
    const bool is_part = is_object_section(name.kind) && name.kind != SectionKind::object;
    std::string label{section.name};
    if (const std::string text = name_in(section); !text.empty()) label += " " + text;
    Json symbol = symbol_of(view, section, label,
                            is_part                            ? field_symbol
                            : name.kind == SectionKind::object ? class_symbol
                                                               : namespace_symbol,
                            end);
    const bool has_parent = is_part && !symbols.empty() && symbols.back().value("index", -1) == int{name.index};
    if (name.kind == SectionKind::object) symbol["index"] = name.index;
    if (has_parent) {
      symbols.back()["range"]["end"] = symbol["range"]["end"];
      symbols.back()["children"].push_back(std::move(symbol));
    } else {
      symbols.push_back(std::move(symbol));
    }
  }
  for (Json& symbol : symbols) symbol.erase("index");
  return symbols;
}

Json folding_ranges(const View& view) {
  Json ranges = Json::array();
  if (!view.is_sheet()) return ranges;
  for (const IniSection& section : view.analysis.ini.sections) {
    if (section.entries.empty()) continue;
    ranges.push_back({{"startLine", section.line - 1}, {"endLine", section.entries.back().line - 1}});
  }
  return ranges;
}

}  // namespace edsc::lsp

#include "network/generate/node_dcf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/index_range.hpp"
#include "device/resolve.hpp"
#include "eds/ini.hpp"
#include "format/canonical_form.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "format/dcf/configured_values.hpp"
#include "format/dcf/make_dcf.hpp"
#include "format/dcf/parameter_text.hpp"
#include "format/sheet_document.hpp"
#include "network/communication_objects.hpp"
#include "system/path.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

/// An EDS or DCF as text, read.
struct ReadSheet {
  ReadSheet(std::string name, std::string text, std::uint8_t node_id) : source{std::move(name), std::move(text)} {
    Diagnostics ignored;
    ini = parse_ini(source, ignored);
    sheet = read_data_sheet(ini, ignored);
    device = resolve_device(sheet, {}, node_id, ignored);
  }

  SourceFile source;
  IniFile ini;
  DataSheet sheet;
  Device device;
};

/// The file of the node as an EDS or DCF.
std::string sheet_text(const NetworkNode& node) {
  const LoadedDevice& loaded = *node.loaded;
  Diagnostics ignored;
  if (!parse_ini(*loaded.source, ignored).sections.empty()) return std::string{loaded.source->text()};
  return to_text(document_of(loaded.sheet, node_file(node, "dcf")));  // an XDD or XDC
}

void set_key(DocumentSection& section, std::string_view key, std::string value) {
  const auto at = std::ranges::find(section.entries, key, &DocumentEntry::key);
  if (at != section.entries.end()) {
    at->value = std::move(value);
  } else {
    section.entries.push_back({{}, std::string{key}, std::move(value)});
  }
}

/// A name as the value of a key: one line.
std::string line_of(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

class NodeDcfMaker {
 public:
  NodeDcfMaker(const Network& network, const NetworkNode& node, const std::string& file, Diagnostics& diagnostics)
      : network_{network},
        node_{node},
        file_{file},
        diagnostics_{diagnostics},
        sheet_{std::string{node.loaded->sheet.is_dcf ? "node.dcf" : "node.eds"}, sheet_text(node), node.node_id} {}

  NodeDcf make() {
    choose_values();
    Document document = canonical_form(sheet_.ini, sheet_.sheet, node_.device());
    make_dcf(document, sheet_.sheet, node_.device(), given_, bit_rate());
    for (DocumentSection& section : document.sections) complete(section);
    NodeDcf dcf;
    dcf.text = to_text(document);
    dcf.document = std::move(document);
    const ReadSheet read{file_, dcf.text, node_.node_id};
    check_values(read);
    Diagnostics ignored;
    dcf.concise = concise_dcf(read.sheet, read.device, ignored);
    return dcf;
  }

 private:
  /// Entries that get a ParameterValue: those that the DCF of the node configures, those that the network configures,
  /// and what belongs to these.
  void choose_values() {
    Diagnostics ignored;
    for (const ConfiguredValue& value : configured_values(sheet_.sheet, sheet_.device, ignored)) {
      if (!is_outdated(*value.entry)) choose(value.entry->index, value.entry->sub_index);
    }
    for (const Setting& setting : node_.settings) {
      const bool belongs_together = contains(mapping_parameters, setting.index) || is_compact(setting);
      if (belongs_together) choose_object(setting.index);
      choose(setting.index, setting.sub_index);
    }
    for (const Object& object : node_.device().objects) {
      for (const Entry& entry : object.entries) {
        if (is_outdated(entry)) given_.known.insert(&entry);
      }
    }
  }

  /// The date in 1020h of the DCF is not that of the configuration if the network changes it.
  [[nodiscard]] bool is_outdated(const Entry& entry) const {
    const bool by_clause = entry.default_value && !entry.default_value->clause.empty();
    return by_clause || (entry.index == communication::verify_configuration && !node_.settings.empty());
  }

  /// Whether an element of a compact form does not have its own section.
  [[nodiscard]] bool is_compact(const Setting& setting) const {
    const ObjectDescription* const object = sheet_.sheet.find(setting.index);
    return object != nullptr && object->compact_sub_obj.present && setting.sub_index != 0 &&
           object->find(setting.sub_index) == nullptr;
  }

  void choose_object(std::uint16_t index) {
    for (const Entry& entry : node_.device().find(index)->entries) {
      if (canopen::writable(entry.access)) choose(index, entry.sub_index);
    }
  }

  void choose(std::uint16_t index, std::uint8_t sub_index) {
    const Entry* const entry = node_.device().find(index, sub_index);
    if (entry == nullptr || !entry->default_value) return;
    const std::string bytes = bytes_of(*entry->default_value, *entry->type);
    const std::vector<std::uint8_t> data{bytes.begin(), bytes.end()};
    given_.known.insert(entry);
    if (auto text = parameter_text(*entry, data)) given_.values[entry] = *std::move(text);
  }

  [[nodiscard]] std::optional<unsigned> bit_rate() const {
    const WrittenNumber& written = network_.description.bit_rate;
    return written ? std::optional<unsigned>{written->value} : std::nullopt;
  }

  void complete(DocumentSection& section) const {
    switch (section.kind.kind) {
      case SectionKind::file_info: return set_key(section, "FileName", file_);
      case SectionKind::device_commissioning: return complete_commissioning(section);
      case SectionKind::sub_object: return add_download_file(section);
      default: return;
    }
  }

  void complete_commissioning(DocumentSection& section) const {
    set_key(section, "NodeName", line_of(node_.name));
    set_key(section, "NetworkName", line_of(std::string{stem_of(network_.source->name())}));
    set_key(section, "CANopenManager", node_.is_master ? "1" : "0");
    if (const WrittenNumber& serial = node_.description->serial_number) {
      set_key(section, "LSS_SerialNumber", fmt::format("{}", serial->value));
    }
  }

  /// 1F22h of a master: the concise DCF of the node with this sub-index.
  void add_download_file(DocumentSection& section) const {
    if (section.kind.index != communication::concise_dcf || !node_.is_master) return;
    const auto slave = std::ranges::find_if(network_.nodes, [&](const NetworkNode& one) {
      return &one != &node_ && one.node_id == section.kind.sub_index;
    });
    if (slave != network_.nodes.end()) set_key(section, "DownloadFile", node_file(*slave, "cdcf"));
  }

  /// Reports settings that a reader of the DCF does not get.
  void check_values(const ReadSheet& read) {
    Diagnostics ignored;
    std::map<EntryKey, std::string> held;
    for (ConfiguredValue& one : configured_values(read.sheet, read.device, ignored)) {
      held.emplace(EntryKey{one.entry->index, one.entry->sub_index}, std::move(one.data));
    }
    for (const Setting& setting : node_.settings) {
      const Entry& entry = *node_.device().find(setting.index, setting.sub_index);
      const auto value = held.find(EntryKey{entry.index, entry.sub_index});
      const bool is_held = value != held.end() && value->second == bytes_of(*entry.default_value, *entry.type);
      if (is_held || !canopen::writable(entry.access)) continue;
      diagnostics_.error("network-value", setting.value.position,
                         fmt::format("node {}: a DCF cannot hold this value of {}", node_.name, named(entry)));
    }
  }

  const Network& network_;
  const NetworkNode& node_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  ReadSheet sheet_;
  GivenValues given_;
};

}  // namespace

NodeDcf make_node_dcf(const Network& network, const NetworkNode& node, const std::string& file,
                      Diagnostics& diagnostics) {
  return NodeDcfMaker{network, node, file, diagnostics}.make();
}

std::string node_file(const NetworkNode& node, std::string_view extension) {
  std::string name = node.name;
  constexpr std::string_view reserved = "/\\:*?\"<>|";
  std::ranges::replace_if(
      name, [&](char c) { return static_cast<unsigned char>(c) < 0x20 || reserved.find(c) != std::string_view::npos; },
      '_');
  return fmt::format("{}.{}", name, extension);
}

}  // namespace edsc

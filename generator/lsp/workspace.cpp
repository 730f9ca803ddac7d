#include "lsp/workspace.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "device/options/options.hpp"
#include "diagnostics/place.hpp"
#include "load/sheet_extensions.hpp"
#include "network/checks/check_network.hpp"
#include "network/network_members.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"

namespace edsc::lsp {
namespace {

constexpr std::string_view options_end = ".options.json";

bool is_same_path(std::string_view a, std::string_view b) {
  return a == b || to_native(a).lexically_normal() == to_native(b).lexically_normal();
}

/// The file with this path among those of a device.
std::shared_ptr<const SourceFile> part_with(const LoadedDevice& loaded, const std::string& path) {
  for (const auto& part : loaded.parts) {
    if (is_same_path(part->name(), path)) return part;
  }
  return loaded.source && loaded.parts.empty() && is_same_path(loaded.source->name(), path) ? loaded.source : nullptr;
}

/// The EDS, DCF or overlay of `drive.options.json`; empty if there is none.
std::string device_beside(const std::string& path) {
  const std::string stem = path.substr(0, path.size() - options_end.size());
  for (const std::string_view extension : sheet_extensions) {
    std::string candidate = stem + std::string{extension};
    std::error_code error;
    if (std::filesystem::exists(to_native(candidate), error)) return candidate;
  }
  return {};
}

void add_inputs(const LoadedDevice& loaded, Analysis& analysis) {
  if (!loaded.source) return;
  std::ranges::move(input_files(loaded), std::back_inserter(analysis.inputs));
}

}  // namespace

DocumentKind kind_of(std::string_view path, std::string_view text) {
  if (ends_with_ignoring_case(path, ".overlay")) return DocumentKind::overlay;
  if (ends_with_ignoring_case(path, ".xdd") || ends_with_ignoring_case(path, ".xdc")) return DocumentKind::xml;
  if (ends_with_ignoring_case(path, options_end)) return DocumentKind::options;
  if (ends_with_ignoring_case(path, ".deviations.json")) return DocumentKind::deviations;
  if (!ends_with_ignoring_case(path, ".json")) return DocumentKind::device;
  if (text.find("deviations.schema.json") != std::string_view::npos) return DocumentKind::deviations;
  if (text.find("options.schema.json") != std::string_view::npos) return DocumentKind::options;
  return is_network_text(text) ? DocumentKind::network : DocumentKind::other;
}

void Workspace::open(const std::string& uri, std::int64_t version, std::string text) {
  Document& document = documents_[uri];
  document =
      Document{uri, path_of_uri(uri), version, DocumentKind::other, std::move(text), true, true, nullptr, nullptr};
  document.kind = kind_of(document.path, document.text);
  changed(document.path);
}

void Workspace::close(const std::string& uri) {
  const auto at = documents_.find(uri);
  if (at == documents_.end()) return;
  const std::string path = at->second.path;
  documents_.erase(at);
  changed(path);
}

Document* Workspace::find(std::string_view uri) {
  const auto at = documents_.find(uri);
  return at == documents_.end() ? nullptr : &at->second;
}

Document* Workspace::find_path(std::string_view path) {
  for (auto& [uri, document] : documents_) {
    if (is_same_path(document.path, path)) return &document;
  }
  return nullptr;
}

void Workspace::changed(const std::string& path) {
  for (auto& [uri, document] : documents_) {
    const auto reads = [&](const std::string& input) { return is_same_path(input, path); };
    // A file that is new may be the options file of any document, or a file that was missing.
    const bool knows = document.analysis && std::ranges::any_of(document.analysis->inputs, reads);
    if (knows || document.path == path || !document.analysis) document.is_dirty = document.is_unpublished = true;
  }
}

void Workspace::all_changed() {
  for (auto& [uri, document] : documents_) document.is_dirty = document.is_unpublished = true;
}

ReadBase Workspace::reader() {
  return [this](const std::string& path, const ReadingChoices& choices, std::string& error) {
    return read(path, choices, error);
  };
}

/// A text that is in an editor and on the disk is read from the disk: its bytes have findings too.
std::unique_ptr<SourceFile> Workspace::read(const std::string& path, const ReadingChoices& choices,
                                            std::string& error) {
  const Document* const document = find_path(path);
  std::string missing;
  auto on_disk = document == nullptr || document->path.find("://") == std::string::npos
                     ? read_source_file(path, document == nullptr ? error : missing, choices)
                     : nullptr;
  if (document == nullptr || (on_disk && on_disk->text() == document->text)) return on_disk;
  ReadingChoices of_text = choices;
  if (of_text.encoding) of_text.encoding = Encoding::utf8;  // the editor has decoded the bytes
  return std::make_unique<SourceFile>(from_native(to_native(path)), document->text, Packing::none, of_text);
}

void Workspace::analyse_device(Document& document, Analysis& analysis) {
  analysis.diagnostics.silence_errors();
  analysis.diagnostics.collect_remedies();
  LoadSettings settings;
  settings.path = document.path;
  settings.read = reader();
  analysis.loaded = load_device(settings, analysis.diagnostics);
  if (!analysis.loaded->unreadable) report_unused_allowances(*analysis.loaded, analysis.diagnostics);
  add_inputs(*analysis.loaded, analysis);
  analysis.own = part_with(*analysis.loaded, document.path);
}

/// With a device, the findings are those that the device has in its options file.
void Workspace::analyse_options(const Document& document, Analysis& analysis) {
  analysis.diagnostics.silence_errors();
  const std::string device = device_beside(document.path);
  if (device.empty()) {
    (void)read_options(*analysis.own, is_identifier, analysis.diagnostics);
    return;
  }
  LoadSettings settings;
  settings.path = device;
  settings.options_path = document.path;
  settings.read = reader();
  analysis.loaded = load_device(settings, analysis.diagnostics);
  if (!analysis.loaded->unreadable) report_unused_allowances(*analysis.loaded, analysis.diagnostics);
  add_inputs(*analysis.loaded, analysis);
}

void Workspace::analyse_network(const Document& document, Analysis& analysis) {
  analysis.diagnostics.silence_errors();
  analysis.network =
      load_network(std::make_unique<SourceFile>(document.path, document.text), analysis.diagnostics, reader());
  check_network(analysis.network->network, analysis.diagnostics);
  for (const auto& file : analysis.network->network.files) add_inputs(*file, analysis);
}

Analysis& Workspace::analyse(Document& document) {
  if (!document.is_dirty && document.analysis) return *document.analysis;
  auto analysis = std::make_unique<Analysis>();
  const bool is_sheet = document.kind == DocumentKind::device || document.kind == DocumentKind::overlay;
  if (is_sheet || document.kind == DocumentKind::xml) analyse_device(document, *analysis);
  if (!analysis->own) analysis->own = std::make_shared<SourceFile>(document.path, document.text);
  if (document.kind == DocumentKind::options) analyse_options(document, *analysis);
  if (document.kind == DocumentKind::network) analyse_network(document, *analysis);
  if (document.kind == DocumentKind::deviations && check_deviations_) {
    check_deviations_(*analysis->own, analysis->diagnostics);
  }
  Diagnostics ignored;
  if (is_sheet) analysis->ini = parse_ini(*analysis->own, ignored);
  const Analysis* const before = document.analysis.get();
  if (before != nullptr && before->network && !before->network->network.nodes.empty()) {
    document.last_network = std::move(document.analysis);
  }
  document.analysis = std::move(analysis);
  document.is_dirty = false;
  return *document.analysis;
}

Json location_of(const Position& position, PositionEncoding encoding) {
  const Position origin = origin_of(position);
  if (origin.file == nullptr) return nullptr;
  return {{"uri", uri_of_file(origin.file->name())}, {"range", to_json(range_of(origin, encoding))}};
}

}  // namespace edsc::lsp

#include "load/load_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "backend/cpp/identifier.hpp"
#include "device/pdo/locked_parameters.hpp"
#include "device/resolve.hpp"
#include "diagnostics/consequences.hpp"
#include "diagnostics/quote.hpp"
#include "eds/allow_comments.hpp"
#include "eds/ini.hpp"
#include "lint/allow_findings.hpp"
#include "lint/check_device.hpp"
#include "overlay/overlay_file.hpp"
#include "overlay/search_overlays.hpp"
#include "rules/check_rules.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// The options file of an EDS: `drive.options.json` beside `drive.eds`; of an overlay, else of its base.
std::string options_path_of(const LoadSettings& settings, const LoadedDevice& loaded) {
  if (!settings.options_path.empty()) return settings.options_path;
  std::vector<std::string> paths{settings.path};
  for (const auto& part : loaded.parts) paths.push_back(part->name());
  for (const std::string& path : paths) {
    const fs::path beside = to_native(path).replace_extension(".options.json");
    std::error_code error;
    if (fs::exists(beside, error)) return from_native(beside);
  }
  return "";
}

std::unique_ptr<SourceFile> read_or_report(const std::string& path, const ReadBase& read, const ReadingChoices& choices,
                                           LoadedDevice& loaded, Diagnostics& diagnostics) {
  std::string error;
  auto file = read ? read(path, choices, error) : read_source_file(path, error, choices);
  if (!file) {
    file = std::make_unique<SourceFile>(path, std::string{});
    diagnostics.error("unreadable-file", Position{file.get()}, error);
    loaded.unreadable = true;
  }
  return file;
}

/// An overlay and its bases; nothing for another file.
std::vector<std::shared_ptr<const SourceFile>> parts_of_overlay(const std::string& path) {
  std::error_code missing;
  if (!fs::is_regular_file(to_native(path), missing)) return {};
  std::string error;
  const std::shared_ptr<const SourceFile> file = read_source_file(path, error);
  if (!file || !is_overlay(*file)) return {};
  Diagnostics ignored;
  return compose_overlay(file, {}, ignored).parts;
}

void read_options_file(const std::string& path, const ReadBase& read, LoadedDevice& loaded, Diagnostics& diagnostics) {
  if (path.empty()) return;
  loaded.options_source = read_or_report(path, read, {}, loaded, diagnostics);
  if (loaded.unreadable) return;
  loaded.options = read_options(*loaded.options_source, is_identifier, diagnostics);
  silence_by_options(loaded.options, diagnostics);
}

/// Whether a choice other than the encoding is stated.
bool states_ini_choices(ReadingChoices choices) {
  choices.encoding.reset();
  return choices != ReadingChoices{};
}

/// The outline of the data sheet is complete if the sheet is an XDD, or has allowances.
void mark_consequences_in(const SourceFile& source, Diagnostics& diagnostics) {
  const bool has_outline = !diagnostics.outline().parts.empty() || !needs_outline(diagnostics, source);
  mark_consequences(diagnostics, has_outline ? diagnostics.outline() : find_allow_comments(source).outline);
}

}  // namespace

std::unique_ptr<LoadedDevice> load_device(const LoadSettings& settings, Diagnostics& diagnostics) {
  auto loaded = std::make_unique<LoadedDevice>();
  const std::string own_options = options_path_of(settings, *loaded);
  read_options_file(own_options, settings.read, *loaded, diagnostics);
  loaded->source = read_or_report(settings.path, settings.read, loaded->options.reading, *loaded, diagnostics);
  if (loaded->unreadable) return loaded;
  if (loaded->options.reading.encoding && is_overlay(*loaded->source)) {
    // The choice is for the base.
    loaded->source = read_or_report(settings.path, settings.read, {}, *loaded, diagnostics);
    if (loaded->unreadable) return loaded;
  }
  const std::shared_ptr<const SourceFile> given = loaded->source;
  const Diagnostics without_overlay = diagnostics;
  const auto apply = [&] {
    return apply_overlays(*loaded, {settings.read, settings.needs_reasons, loaded->options.reading}, diagnostics);
  };
  if (!apply()) return loaded;
  if (own_options.empty() && !loaded->parts.empty()) {
    const std::string of_base = options_path_of(settings, *loaded);
    Diagnostics of_options;
    LoadedDevice peek;
    read_options_file(of_base, settings.read, peek, of_options);
    if (peek.options.reading != ReadingChoices{}) {
      // The base is read again: findings of the first reading point to files that are gone then.
      diagnostics = without_overlay;
      loaded->source = given;
      loaded->options.reading = peek.options.reading;
      if (!apply()) return loaded;
    }
    read_options_file(of_base, settings.read, *loaded, diagnostics);
    if (loaded->unreadable) return loaded;
  }
  if (settings.keep_going) diagnostics.keep_going(loaded->source.get());
  if (settings.check && !settings.profile_path.empty()) {
    loaded->user_profile = std::make_unique<UserProfile>(read_user_profile(settings.profile_path, diagnostics));
    loaded->unreadable = !loaded->user_profile->is_readable;
  }
  if (settings.static_mapping) loaded->options.static_mapping.all = true;
  resolve_and_check(*loaded, settings, diagnostics);
  mark_consequences_in(*loaded->source, diagnostics);
  return loaded;
}

std::vector<std::string> input_files(const LoadedDevice& loaded) {
  std::vector<std::string> names;
  for (const auto& part : loaded.parts) names.push_back(part->name());
  if (names.empty()) names.push_back(loaded.source->name());
  if (loaded.options_source) names.push_back(loaded.options_source->name());
  return names;
}

bool apply_overlays(LoadedDevice& loaded, const ComposeSettings& settings, Diagnostics& diagnostics) {
  const bool is_named = is_overlay(*loaded.source);
  const std::vector<std::string> folders = is_named ? std::vector<std::string>{} : overlay_folders();
  if (!is_named && folders.empty()) return true;
  const std::shared_ptr<const SourceFile> file = loaded.source;
  ComposedOverlay composed;
  if (is_named) {
    composed = compose_overlay(file, settings, diagnostics);
  } else if (const auto overlay = find_overlay(folders, file, diagnostics)) {
    composed = compose_overlay(overlay, file, settings, diagnostics);
    print_to_stderr("edsc: {}: changed by {} of EDSC_OVERLAYS\n", file->name(), overlay->name());
  } else {
    return true;
  }
  loaded.parts = std::move(composed.parts);
  loaded.source = std::move(composed.text);
  if (loaded.source) return true;
  loaded.source = file;
  loaded.unreadable = composed.is_unreadable;
  return false;
}

ChoicesOfOptions choices_beside(const std::string& path, Diagnostics& diagnostics) {
  if (path == "-") return {};
  LoadSettings settings;
  settings.path = path;
  LoadedDevice loaded;
  std::string options = options_path_of(settings, loaded);
  if (options.empty()) {
    loaded.parts = parts_of_overlay(path);
    options = options_path_of(settings, loaded);
  }
  read_options_file(options, settings.read, loaded, diagnostics);
  return {std::move(loaded.options_source), loaded.options.reading};
}

Device device_for(const LoadedDevice& loaded, std::optional<std::uint8_t> node_id, bool keep_going) {
  Diagnostics reported;
  if (keep_going) reported.keep_going(loaded.source.get());
  return resolve_device(loaded.sheet, loaded.options, node_id, reported);
}

bool can_keep_going(const LoadedDevice& loaded, const Diagnostics& diagnostics) {
  const auto is_final = [&](const Diagnostic& one) {
    return one.severity == Severity::error && (one.position.file != loaded.source.get() || one.rule.row().is_fatal);
  };
  return loaded.device && std::ranges::none_of(diagnostics.all(), is_final);
}

void report_unused_allowances(const LoadedDevice& loaded, Diagnostics& diagnostics) {
  const auto report = [&](RuleId rule, const Position& position) {
    diagnostics.warning("allow-unused", position, fmt::format("no finding of {} matches", quote(rule.text())));
  };
  for (const SilencedRule& one : loaded.options.silence) {
    const auto rule = find_rule(check_rules, one.rule);
    if (rule && !diagnostics.has_silenced(*rule)) report(*rule, one.position);
  }
  const std::vector<Allowance> allowances = diagnostics.allowances();
  for (const Allowance& one : allowances) {
    if (one.findings == 0) report(one.rule, one.position);
  }
}

void read_sheet(LoadedDevice& loaded, Diagnostics& diagnostics) {
  allow_by_options(loaded.options, diagnostics);
  diagnostics.set_outline({loaded.source.get(), {}, {}});  // the parts of an XDD are known after reading it
  if (!is_xml(*loaded.source)) allow_by_comments(*loaded.source, loaded.options, diagnostics);
  for (const DeprecatedOption& one : loaded.options.deprecated) {
    diagnostics.warning("deprecated-option", one.position, one.message);
  }
  loaded.sheet = is_xml(*loaded.source) ? read_xdd(*loaded.source, diagnostics)
                                        : read_data_sheet(parse_ini(*loaded.source, diagnostics), diagnostics);
}

void resolve_sheet(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics) {
  if (loaded.sheet.objects.empty()) return;
  if (is_xml(*loaded.source) && loaded.options.stored_eds != StoredEds::of_application) {
    diagnostics.error("options", Position{loaded.source.get()},
                      "option stored_eds: 1021h holds an EDS, but this file is not an EDS");
  }
  if (is_xml(*loaded.source) && states_ini_choices(loaded.options.reading)) {
    diagnostics.error("options", Position{loaded.source.get()},
                      "options sub_indices and access_types are for an EDS or DCF; this file is XML");
  }
  loaded.device = resolve_device(loaded.sheet, loaded.options, settings.node_id, diagnostics);
  imply_options(*loaded.device, loaded.options, diagnostics);
  loaded.names.emplace(*loaded.device, loaded.options, settings.name);
  const MeaningProfile* const profile = loaded.user_profile ? &loaded.user_profile->profile : nullptr;
  if (settings.check) check_device(loaded.named(), loaded.sheet, loaded.options, diagnostics, profile);
}

void resolve_and_check(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics) {
  read_sheet(loaded, diagnostics);
  resolve_sheet(loaded, settings, diagnostics);
}

}  // namespace edsc

#include "commands/load_device.hpp"

#include <filesystem>

#include "device/resolve.hpp"
#include "rules/check_device.hpp"
#include "rules/rule.hpp"
#include "text/ini.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// The options file that goes with a data sheet: `drive.options.json` beside `drive.eds`.
std::string options_path_of(const LoadSettings& settings) {
  if (!settings.options_path.empty()) return settings.options_path;
  const fs::path beside = fs::path{settings.path}.replace_extension(".options.json");
  std::error_code error;
  return fs::is_regular_file(beside, error) ? beside.string() : "";
}

std::unique_ptr<SourceFile> read_or_report(const std::string& path, LoadedDevice& loaded, Diagnostics& diagnostics) {
  std::string error;
  auto file = read_source_file(path, error);
  if (!file) {
    file = std::make_unique<SourceFile>(path, std::string{});
    diagnostics.error("unreadable-file", Position{file.get()}, error);
    loaded.unreadable = true;
  }
  return file;
}

void read_options_file(const std::string& path, LoadedDevice& loaded, Diagnostics& diagnostics) {
  if (path.empty()) return;
  loaded.options_source = read_or_report(path, loaded, diagnostics);
  if (loaded.unreadable) return;
  loaded.options = read_options(*loaded.options_source, diagnostics);
  for (const std::string& rule : loaded.options.silence) {
    if (find_rule(rule) == nullptr) {
      diagnostics.error("options", Position{loaded.options_source.get()}, "silence: no rule is called \"" + rule + "\"");
    }
    diagnostics.silence(rule);
  }
}

}  // namespace

std::unique_ptr<LoadedDevice> load_device(const LoadSettings& settings, Diagnostics& diagnostics) {
  auto loaded = std::make_unique<LoadedDevice>();
  loaded->source = read_or_report(settings.path, *loaded, diagnostics);
  if (loaded->unreadable) return loaded;
  read_options_file(options_path_of(settings), *loaded, diagnostics);
  if (loaded->unreadable) return loaded;

  const IniFile ini = parse_ini(*loaded->source, diagnostics);
  if (ini.sections.empty()) return loaded;
  loaded->sheet = read_data_sheet(ini, diagnostics);
  if (loaded->sheet.objects.empty()) return loaded;
  loaded->device = resolve_device(loaded->sheet, loaded->options, {settings.name, settings.node_id}, diagnostics);
  check_device(*loaded->device, diagnostics);
  return loaded;
}

}  // namespace edsc

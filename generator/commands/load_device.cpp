#include "commands/load_device.hpp"

#include <filesystem>

#include "device/resolve.hpp"
#include "rules/check_device.hpp"
#include "diagnostics/rule.hpp"
#include "text/ini.hpp"
#include "xdd/read_xdd.hpp"

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
  if (settings.static_mapping) loaded->options.static_mapping.all = true;
  resolve_and_check(*loaded, settings, diagnostics);
  return loaded;
}

void resolve_and_check(LoadedDevice& loaded, const LoadSettings& settings, Diagnostics& diagnostics) {
  loaded.sheet = is_xml(*loaded.source) ? read_xdd(*loaded.source, diagnostics)
                                         : read_data_sheet(parse_ini(*loaded.source, diagnostics), diagnostics);
  if (loaded.sheet.objects.empty()) return;
  if (is_xml(*loaded.source) && loaded.options.stored_eds != StoredEds::of_application) {
    diagnostics.error("options", Position{loaded.source.get()}, "option stored_eds: 1021h holds an EDS, which this is not");
  }
  loaded.device = resolve_device(loaded.sheet, loaded.options, {settings.name, settings.node_id}, diagnostics);
  if (settings.check) check_device(*loaded.device, loaded.sheet, loaded.options, diagnostics);
}

}  // namespace edsc

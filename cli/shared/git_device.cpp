#include "shared/git_device.hpp"

#include <utility>

#include "backend/cpp/identifier.hpp"
#include "lint/allow_findings.hpp"
#include "system/path.hpp"

namespace edsc {

namespace {

/// A file of the revision that the device needs and that cannot be read.
void report_unreadable(const std::string& name, const std::string& error, LoadedDevice& loaded,
                       Diagnostics& diagnostics) {
  loaded.options_source = std::make_unique<SourceFile>(name, std::string{});
  diagnostics.error("unreadable-file", Position{loaded.options_source.get()}, error);
  loaded.unreadable = true;
}

}  // namespace

std::unique_ptr<LoadedDevice> load_git_device(GitFile committed, const std::string& revision,
                                              const LoadSettings& settings, Diagnostics& diagnostics) {
  auto loaded = std::make_unique<LoadedDevice>();
  loaded->source = std::move(committed.source);
  const std::string options_path = from_native(to_native(settings.path).replace_extension(".options.json"));
  GitFile options = read_git_file(revision, options_path);
  if (!options.source && !options.is_missing) {
    report_unreadable(revision + ":" + options_path, options.error, *loaded, diagnostics);
    return loaded;
  }
  loaded->options_source = std::move(options.source);
  if (loaded->options_source) loaded->options = read_options(*loaded->options_source, is_identifier, diagnostics);
  if (loaded->options.reading != ReadingChoices{}) {
    GitFile again = read_git_file(revision, settings.path, loaded->options.reading);
    if (!again.source) {
      report_unreadable(loaded->source->name(), again.error, *loaded, diagnostics);
      return loaded;
    }
    loaded->source = std::move(again.source);
  }
  const ReadBase read = [&revision](const std::string& path, const ReadingChoices& choices, std::string& error) {
    const std::string prefix = revision + ":";
    GitFile base = read_git_file(revision, path.starts_with(prefix) ? path.substr(prefix.size()) : path, choices);
    error = base.error;
    return std::move(base.source);
  };
  if (!apply_overlays(*loaded, {read, settings.needs_reasons, loaded->options.reading}, diagnostics)) return loaded;
  if (settings.keep_going) diagnostics.keep_going(loaded->source.get());
  silence_by_options(loaded->options, diagnostics);
  resolve_and_check(*loaded, settings, diagnostics);
  return loaded;
}

}  // namespace edsc

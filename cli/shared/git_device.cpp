#include "shared/git_device.hpp"

#include <utility>

#include "backend/cpp/identifier.hpp"
#include "system/path.hpp"

namespace edsc {

std::unique_ptr<LoadedDevice> load_git_device(GitFile committed, const std::string& revision,
                                              const LoadSettings& settings, Diagnostics& diagnostics) {
  auto loaded = std::make_unique<LoadedDevice>();
  const std::string options_path = from_native(to_native(settings.path).replace_extension(".options.json"));
  loaded->options_source = read_git_file(revision, options_path).source;
  if (loaded->options_source) loaded->options = read_options(*loaded->options_source, is_identifier, diagnostics);
  if (loaded->options.reading != ReadingChoices{}) {
    committed = read_git_file(revision, settings.path, loaded->options.reading);
  }
  loaded->source = std::move(committed.source);
  const ReadBase read = [&revision](const std::string& path, const ReadingChoices& choices, std::string& error) {
    const std::string prefix = revision + ":";
    GitFile base = read_git_file(revision, path.starts_with(prefix) ? path.substr(prefix.size()) : path, choices);
    error = base.error;
    return std::move(base.source);
  };
  if (!apply_overlays(*loaded, {read, settings.needs_reasons, loaded->options.reading}, diagnostics)) return loaded;
  if (settings.keep_going) diagnostics.keep_going(loaded->source.get());
  silence_by_options(*loaded, diagnostics);
  resolve_and_check(*loaded, settings, diagnostics);
  return loaded;
}

}  // namespace edsc

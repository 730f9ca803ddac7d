#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "compare/compare_devices.hpp"
#include "compare/compare_files.hpp"
#include "compare/print_changes.hpp"
#include "compare/stored_values.hpp"
#include "load/load_device.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/git_device.hpp"
#include "system/path.hpp"
#include "system/read_file.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc diff drive-1.0.eds drive-1.1.eds                  what changed and what it breaks; exit code 1 if anything breaks
  edsc diff drive-1.0.eds drive-1.1.eds --format json    the same for a program
  edsc diff drive.eds axis1.dcf --node-id 5              a DCF against its EDS, both as node 5
  edsc diff --against git:main drive.eds --format markdown    a comment for a pull request
  edsc diff --against git:HEAD --fail-on any eds/*.eds   exit code 1 if a device differs from its commit
  edsc diff drive-1.0.eds drive-1.1.eds --storage        what becomes of the parameters that a device has stored)";

struct Settings {
  std::vector<std::string> files;
  std::string against;
  std::string format = "text";
  std::string audience = "all";
  std::string fail_on = "breaking";
  std::optional<std::uint8_t> node_id;
  bool allow_new = false;
  bool keep_going = false;
  bool storage = false;
  ColorOption color;
};

/// Two versions of a device; `before` is null for a new file.
struct Pair {
  std::unique_ptr<LoadedDevice> before;
  std::unique_ptr<LoadedDevice> after;
  std::string path, revision;  ///< of a committed `before`: the new file and the git revision
  Changes changes;
  std::vector<StoredValueChange> stored_values;
};

/// The findings that leave a part of a device out of the comparison: errors, also as warnings by `--keep-going`.
Diagnostics errors_of(const Diagnostics& diagnostics) {
  Diagnostics errors;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error || one.rule.row().severity == Severity::error) errors.report(one);
  }
  return errors;
}

/// Null if the device cannot be compared; the errors are printed.
std::unique_ptr<LoadedDevice> reported(std::unique_ptr<LoadedDevice> loaded, const Diagnostics& diagnostics,
                                       const Settings& settings) {
  print_findings(errors_of(diagnostics), settings.color);
  return loaded->device && diagnostics.errors() == 0 ? std::move(loaded) : nullptr;
}

std::unique_ptr<LoadedDevice> load(const std::string& path, const Settings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings load{path, "", "", settings.node_id};
  load.keep_going = settings.keep_going;
  auto loaded = load_device(load, diagnostics);
  return reported(std::move(loaded), diagnostics, settings);
}

std::unique_ptr<LoadedDevice> load_committed(GitFile committed, const std::string& revision, const std::string& path,
                                             const Settings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings load{path, "", "", settings.node_id};
  load.keep_going = settings.keep_going;
  auto loaded = load_git_device(std::move(committed), revision, load, diagnostics);
  return reported(std::move(loaded), diagnostics, settings);
}

/// The pairs to compare; nothing if a file cannot be used, which is printed.
std::optional<std::vector<Pair>> load_pairs(const Settings& settings) {
  std::vector<Pair> pairs;
  if (settings.against.empty()) {
    Pair& pair = pairs.emplace_back();
    pair.before = load(settings.files.front(), settings);
    pair.after = load(settings.files.back(), settings);
    if (!pair.before || !pair.after) return std::nullopt;
    return pairs;
  }
  const std::string revision = settings.against.substr(git_prefix.size());
  bool failed = false;
  for (const std::string& path : expand_folders(settings.files)) {
    Pair pair;
    pair.path = path;
    pair.revision = revision;
    GitFile committed = read_git_file(revision, path);
    const bool is_new = committed.is_missing && settings.allow_new;
    if (committed.source) {
      pair.before = load_committed(std::move(committed), revision, path, settings);
    } else if (!is_new) {
      print_to_stderr("edsc: {}\n", committed.error);
    }
    pair.after = load(path, settings);
    failed = failed || !pair.after || (!pair.before && !is_new);
    pairs.push_back(std::move(pair));
  }
  return failed ? std::nullopt : std::optional{std::move(pairs)};
}

Audience audience_of(const Settings& settings) {
  if (settings.audience == "wire") return Audience::wire;
  return settings.audience == "source" ? Audience::source : Audience::all;
}

void print(Pair& pair, const Settings& settings) {
  if (settings.format != "markdown") return;
  const std::string& after = pair.after->source->name();
  fmt::print("{}", pair.before ? changes_as_markdown(pair.changes, pair.before->source->name(), after)
                               : new_file_as_markdown(after));
}

void check_files(const Settings& settings) {
  if (settings.against.empty() && settings.files.size() != 2) {
    throw_invalid("FILE", "expected two files, OLD and NEW; --against git:REF accepts any number");
  }
  if (settings.against.empty() && settings.allow_new) throw_requires("--allow-new", "--against");
}

/// Nothing if the file does not exist.
std::optional<std::string> read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  std::string bytes;
  const std::string problem = read_file(from_native(path), bytes);
  if (!problem.empty()) fail(fmt::format("cannot read {}: {}", from_native(path), problem));
  return bytes;
}

/// Reads a file that an EDS names, beside the EDS or in the git revision of the EDS.
std::optional<std::string> read_file_of(const Pair& pair, const Device& device, const std::string& name) {
  const bool is_committed = pair.before && &device == &*pair.before->device && !pair.revision.empty();
  const std::filesystem::path sheet = to_native(is_committed ? pair.path : device.source->name());
  const std::filesystem::path file = sheet.parent_path() / to_native(name);
  if (!is_committed) return read_bytes(file);
  GitBytes committed = read_git_bytes(pair.revision, from_native(file));
  if (!committed.bytes && !committed.is_missing) fail(committed.error);
  return std::move(committed.bytes);
}

void compare(Pair& pair) {
  if (!pair.before) return;
  pair.changes = compare_devices(pair.before->named(), pair.after->named());
  const auto read = [&](const Device& device, const std::string& name) { return read_file_of(pair, device, name); };
  compare_files(*pair.before->device, *pair.after->device, read, pair.changes);
  pair.stored_values =
      compare_stored_values({*pair.before->device, pair.before->options}, {*pair.after->device, pair.after->options});
  add_lost_values(pair.stored_values, pair.changes);
}

/// The fate of the stored values alone.
int diff_storage(const Settings& settings, std::vector<Pair>& pairs) {
  std::vector<StoredValueChange> all;
  for (Pair& pair : pairs) {
    compare(pair);
    std::ranges::move(pair.stored_values, std::back_inserter(all));
  }
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(stored_values_as_json(all)));
  } else {
    fmt::print("{}", settings.format == "text" ? stored_values_as_text(all) : stored_values_as_markdown(all));
  }
  const auto is_lost = [](const StoredValueChange& value) { return value.fate != StoredFate::kept; };
  const auto may_be_lost = [](const StoredValueChange& value) { return !value.why.empty(); };
  const bool fails = settings.fail_on == "any"        ? std::ranges::any_of(all, may_be_lost)
                     : settings.fail_on == "breaking" ? std::ranges::any_of(all, is_lost)
                                                      : false;
  return fails ? exit_input_has_errors : exit_fine;
}

int diff(const Settings& settings) {
  check_files(settings);
  auto pairs = load_pairs(settings);
  if (!pairs) return exit_wrong_usage;
  if (settings.storage) return diff_storage(settings, *pairs);
  Changes all;
  for (Pair& pair : *pairs) {
    compare(pair);
    pair.changes.keep(audience_of(settings));
    if (&pair != &pairs->front() && settings.format == "markdown") fmt::print("\n");
    print(pair, settings);
    all.append(std::move(pair.changes));
  }
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(changes_as_json(all)));
  } else if (settings.format == "text") {
    fmt::print("{}", changes_as_text(all, settings.color.on(stdout)));
  }
  const bool fails = settings.fail_on == "any"        ? !all.all().empty()
                     : settings.fail_on == "breaking" ? all.breaking() > 0
                                                      : false;
  return fails ? exit_input_has_errors : exit_fine;
}

}  // namespace

void add_diff_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, diff, exit_code);
  command
      .add_option("FILE", settings.files,
                  "OLD and NEW, each an EDS, DCF, XDD or XDC; with --against NEW files or folders")
      .required();
  command.add_option("--against", settings.against, "git:REF compares each FILE with the one of this git revision")
      .check([](const std::string& value) {
        return names_git_revision(value) ? std::string{} : fmt::format("expected git:REF, got {}", value);
      });
  command.add_flag("--allow-new", settings.allow_new);
  add_choice(command, "--format", settings.format, {"text", "json", "markdown"});
  add_choice(command, "--audience", settings.audience, {"all", "wire", "source"});
  add_choice(command, "--fail-on", settings.fail_on, {"breaking", "any", "never"});
  command.add_flag("--storage", settings.storage);
  add_node_id_option(command, settings.node_id);
  command.add_flag("--keep-going", settings.keep_going);
  settings.color.add_to(command);
}

}  // namespace edsc

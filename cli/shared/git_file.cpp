#include "shared/git_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "system/gzip.hpp"
#include "system/path.hpp"
#include "system/run_program.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// Runs git; nothing if it cannot be started.
std::optional<ProgramOutcome> run_git(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "git");
  return run_program(std::move(arguments));
}

/// A folder for `git -C`, and the path of the file relative to it. In a hook, GIT_DIR is relative to the folder chosen
/// by git.
std::pair<std::vector<std::string>, std::string> place_of(const std::string& path) {
  std::error_code error;
  if (std::getenv("GIT_DIR") != nullptr) {
    const fs::path relative = fs::relative(to_native(path), error);
    return {{}, "./" + (error ? path : from_native(relative))};
  }
  const std::string folder = from_native(to_native(path).parent_path());
  return {{"-C", folder.empty() ? "." : folder}, "./" + from_native(to_native(path).filename())};
}

std::string first_line(std::string_view text) { return std::string{text.substr(0, text.find('\n'))}; }

}  // namespace

GitFile read_git_file(const std::string& revision, const std::string& path, const ReadingChoices& choices) {
  const auto [folder, name] = place_of(path);
  const auto git = [&folder = folder](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), folder.begin(), folder.end());
    return run_git(std::move(arguments));
  };
  GitFile result;
  if (revision.empty() || revision.starts_with('-')) {
    result.error = fmt::format("\"{}\" is not a git revision", revision);
    return result;
  }
  auto shown = git({"show", "--no-textconv", revision + ":" + name, "--"});
  if (!shown) {
    result.error = "git cannot be started; is it installed and in PATH?";
    return result;
  }
  const auto succeeds = [&](std::vector<std::string> arguments) {
    const auto outcome = git(std::move(arguments));
    return outcome && outcome->exit_code == 0;
  };
  const std::string shown_name = revision + ":" + path;
  if (shown->exit_code != 0) {
    if (succeeds({"rev-parse", "--verify", "--quiet", revision + "^{tree}"})) {
      result.is_missing = true;
      result.error = fmt::format("{} is not in the git revision {}", path, revision);
    } else if (succeeds({"rev-parse", "--git-dir"})) {
      result.error = fmt::format("git does not know a revision {} in the repository of {}", revision, path);
    } else {
      result.error = fmt::format("cannot read {} with git: {}", shown_name, first_line(shown->errors));
    }
    return result;
  }
  std::string bytes = std::move(shown->output);
  std::string why = bytes.size() > SourceFile::max_bytes ? "too large" : "";
  const Packing packing = is_gzip(bytes) ? Packing::gzip : Packing::none;
  if (why.empty() && packing == Packing::gzip) {
    const std::string packed = std::move(bytes);
    why = gunzip(packed, SourceFile::max_unpacked_bytes, bytes);
  }
  if (why.empty()) {
    result.source = std::make_unique<SourceFile>(shown_name, std::move(bytes), packing, choices);
  } else {
    result.error = fmt::format("cannot read {}: {}", shown_name, why);
  }
  return result;
}

std::optional<std::string> read_git_bytes(const std::string& revision, const std::string& path) {
  if (revision.empty() || revision.starts_with('-')) return std::nullopt;
  auto [arguments, name] = place_of(path);
  arguments.insert(arguments.end(), {"show", "--no-textconv", revision + ":" + name, "--"});
  auto shown = run_git(std::move(arguments));
  return shown && shown->exit_code == 0 ? std::optional{std::move(shown->output)} : std::nullopt;
}

}  // namespace edsc

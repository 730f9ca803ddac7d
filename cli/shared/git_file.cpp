#include "shared/git_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "system/environment.hpp"
#include "system/gzip.hpp"
#include "system/path.hpp"
#include "system/run_program.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// What a repository of someone else must not make git do: fetch missing objects with a command of its configuration,
/// ask for a password, read a name as a pattern.
constexpr const char* git_environment[] = {"GIT_NO_LAZY_FETCH=1", "GIT_ALLOW_PROTOCOL=none", "GIT_TERMINAL_PROMPT=0",
                                           "GIT_OPTIONAL_LOCKS=0", "GIT_LITERAL_PATHSPECS=1"};
constexpr const char* git_words[] = {
    "git", "--no-pager", "-c", "core.fsmonitor=false", "-c", "core.hooksPath=/dev/null"};

/// Git in the folder of a file.
class Git {
 public:
  explicit Git(const std::string& path) : words_{std::begin(git_words), std::end(git_words)} {
    std::error_code error;
    if (environment_variable("GIT_DIR")) {  // in a hook, it is relative to the folder chosen by git
      const fs::path relative = fs::relative(to_native(path), error);
      name_ = "./" + (error ? path : from_native(relative));
      return;
    }
    fs::path folder = to_native(path).parent_path();
    fs::path name = to_native(path).filename();
    while (!folder.empty() && !fs::is_directory(folder, error) && folder.has_relative_path()) {
      name = folder.filename() / name;
      folder = folder.parent_path();
    }
    words_.insert(words_.end(), {"-C", folder.empty() ? "." : from_native(folder)});
    name_ = "./" + from_native(name);
  }

  /// The path of the file, relative to the folder in which git runs.
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Nothing if git cannot be started.
  [[nodiscard]] std::optional<ProgramOutcome> run(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = words_;
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(std::move(words), {}, {std::begin(git_environment), std::end(git_environment)});
  }

 private:
  std::vector<std::string> words_;
  std::string name_;
};

std::string first_line(std::string_view text) { return std::string{text.substr(0, text.find('\n'))}; }

GitBytes failure(std::string error) { return {std::nullopt, false, std::move(error)}; }

/// The object that a revision names: one hexadecimal number, not a range such as `A..B` or an exclusion such as `^A`.
bool is_object_name(std::string_view text) {
  return text.size() >= 40 &&
         std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

/// A line of `git ls-tree -z`: `MODE TYPE OBJECT<tab>NAME<nul>`.
struct TreeEntry {
  std::string_view mode, object;
};
TreeEntry tree_entry(std::string_view line) {
  const std::size_t type = line.find(' ');
  const std::size_t object = line.find(' ', type + 1);
  if (object == std::string_view::npos) return {};
  return {line.substr(0, type), line.substr(object + 1, line.find('\t') - object - 1)};
}

/// Why an entry of a tree does not have the bytes of a file; empty for a file.
std::string_view no_file_problem(std::string_view mode) {
  if (mode == "120000") return "is a symbolic link";
  if (mode == "160000") return "is a submodule";
  return mode == "040000" ? "is a folder" : "";
}

}  // namespace

GitBytes read_git_bytes(const std::string& revision, const std::string& path) {
  if (revision.empty() || revision.starts_with('-')) {
    return failure(fmt::format("\"{}\" is not a git revision", revision));
  }
  const Git git{path};
  const auto named = git.run({"rev-parse", "--verify", "--quiet", "--end-of-options", revision});
  if (!named) return failure("git cannot be started; is it installed and in PATH?");
  const std::string commit = first_line(named->output);
  if (named->exit_code != 0 || !is_object_name(commit)) {
    const auto repository = git.run({"rev-parse", "--git-dir"});
    if (!repository || repository->exit_code != 0) {
      return failure(fmt::format("cannot read {}:{} with git: {}", revision, path,
                                 repository ? first_line(repository->errors) : ""));
    }
    const std::string why = first_line(named->errors);
    return failure(fmt::format("\"{}\" is not a git revision of the repository of {}{}{}", revision, path,
                               why.empty() ? "" : ": ", why));
  }
  const auto listed = git.run({"ls-tree", "-z", commit, "--", git.name()});
  if (!listed || listed->exit_code != 0) {
    return failure(fmt::format("cannot read the tree of the git revision {}: {}", revision,
                               listed ? first_line(listed->errors) : ""));
  }
  if (listed->output.empty())
    return {std::nullopt, true, fmt::format("{} is not in the git revision {}", path, revision)};
  const TreeEntry entry = tree_entry(listed->output);
  if (const std::string_view problem = no_file_problem(entry.mode); !problem.empty()) {
    return failure(fmt::format("{} {} in the git revision {}", path, problem, revision));
  }
  auto shown = git.run({"cat-file", "blob", std::string{entry.object}});
  if (!shown || shown->exit_code != 0) {
    return failure(
        fmt::format("cannot read {}:{}: its blob is damaged, or missing as in a partial clone, for which "
                    "\"git cat-file blob {}\" fetches it: {}",
                    revision, path, entry.object, shown ? first_line(shown->errors) : ""));
  }
  return {std::move(shown->output), false, ""};
}

GitFile read_git_file(const std::string& revision, const std::string& path, const ReadingChoices& choices) {
  GitBytes committed = read_git_bytes(revision, path);
  GitFile result{nullptr, committed.is_missing, std::move(committed.error)};
  if (!committed.bytes) return result;
  const std::string shown_name = revision + ":" + path;
  std::string bytes = std::move(*committed.bytes);
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

}  // namespace edsc

#include "shared/git_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "text/gzip.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

/// Both ends of a pipe, closed at the end.
class Pipe {
 public:
  Pipe() { is_open_ = pipe2(ends_.data(), O_CLOEXEC) == 0; }
  ~Pipe() {
    if (!is_open_) return;
    close(ends_[0]);
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] bool is_open() const { return is_open_; }
  [[nodiscard]] int reading() const { return ends_[0]; }
  [[nodiscard]] int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
  bool is_open_ = false;
};

/// Reads the output of a program until its end.
void drain(const Pipe& output, const Pipe& errors, Outcome& outcome) {
  std::array<pollfd, 2> open{{{output.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
  std::array<std::string*, 2> texts{&outcome.output, &outcome.errors};
  std::array<char, 1U << 16U> buffer;
  for (int left = 2; left > 0;) {
    if (poll(open.data(), open.size(), -1) < 0 && errno != EINTR) return;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (open[i].fd < 0 || open[i].revents == 0) continue;
      const ssize_t count = read(open[i].fd, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count > 0 && texts[i]->size() <= SourceFile::max_bytes) {
        texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
      } else if (count <= 0) {
        open[i].fd = -1;
        --left;
      }
    }
  }
}

/// Runs git without a shell; nothing if it cannot be started.
std::optional<Outcome> run_git(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "git");
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  Pipe output;
  Pipe errors;
  if (!output.is_open() || !errors.is_open()) return std::nullopt;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.writing(), STDERR_FILENO);
  pid_t process = -1;
  const int failed = posix_spawnp(&process, "git", &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return std::nullopt;
  output.close_writing();
  errors.close_writing();
  Outcome outcome;
  drain(output, errors, outcome);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// A folder for `git -C`, and the path of the file relative to it. In a hook, GIT_DIR is relative to the folder chosen
/// by git.
std::pair<std::vector<std::string>, std::string> place_of(const std::string& path) {
  std::error_code error;
  if (std::getenv("GIT_DIR") != nullptr) {
    const fs::path relative = fs::relative(path, error);
    return {{}, "./" + (error ? path : relative.string())};
  }
  const fs::path folder = fs::path{path}.parent_path();
  return {{"-C", folder.empty() ? "." : folder.string()}, "./" + fs::path{path}.filename().string()};
}

std::string first_line(std::string_view text) { return std::string{text.substr(0, text.find('\n'))}; }

}  // namespace

GitFile read_git_file(const std::string& revision, const std::string& path) {
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
  if (why.empty() && is_gzip(bytes)) {
    const std::string packed = std::move(bytes);
    why = gunzip(packed, SourceFile::max_unpacked_bytes, bytes);
  }
  if (why.empty()) {
    result.source = std::make_unique<SourceFile>(shown_name, std::move(bytes));
  } else {
    result.error = fmt::format("cannot read {}: {}", shown_name, why);
  }
  return result;
}

}  // namespace edsc

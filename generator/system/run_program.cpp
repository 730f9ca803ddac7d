#include "system/run_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <utility>

namespace edsc {
namespace {

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
void drain(const Pipe& output, const Pipe& errors, ProgramOutcome& outcome,
           const std::function<void(std::string_view)>& on_output) {
  std::array<pollfd, 2> open{{{output.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
  std::array<std::string*, 2> texts{&outcome.output, &outcome.errors};
  std::array<char, 1U << 16U> buffer;
  for (int left = 2; left > 0;) {
    if (poll(open.data(), open.size(), -1) < 0 && errno != EINTR) return;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (open[i].fd < 0 || open[i].revents == 0) continue;
      const ssize_t count = read(open[i].fd, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count > 0 && i == 0 && on_output) {
        on_output({buffer.data(), static_cast<std::size_t>(count)});
      } else if (count > 0 && texts[i]->size() <= max_program_output_bytes) {
        texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
      } else if (count <= 0) {
        open[i].fd = -1;
        --left;
      }
    }
  }
}

/// Pointers to the texts, and a null pointer after them.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// `variables`, and those of this process that they do not replace.
std::vector<std::string> environment_with(std::vector<std::string> variables) {
  const std::size_t own = variables.size();
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    const std::string_view name = text.substr(0, text.find('=') + 1);
    const auto replaces = [&](const std::string& one) { return one.starts_with(name); };
    if (std::none_of(variables.begin(), variables.begin() + static_cast<std::ptrdiff_t>(own), replaces)) {
      variables.emplace_back(text);
    }
  }
  return variables;
}

}  // namespace

std::optional<ProgramOutcome> run_program(std::vector<std::string> words,
                                          const std::function<void(std::string_view)>& on_output,
                                          std::vector<std::string> variables) {
  const std::vector<char*> arguments = pointers_to(words);
  variables = environment_with(std::move(variables));
  const std::vector<char*> environment = pointers_to(variables);
  Pipe output;
  Pipe errors;
  if (!output.is_open() || !errors.is_open()) return std::nullopt;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.writing(), STDERR_FILENO);
  pid_t process = -1;
  const int failed = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return std::nullopt;
  output.close_writing();
  errors.close_writing();
  ProgramOutcome outcome;
  drain(output, errors, outcome, on_output);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

bool run_command_line(const std::string& line, const std::string& variable, const std::string& value) {
  ::setenv(variable.c_str(), value.c_str(), 1);
  return std::system(line.c_str()) == 0;  // NOLINT(cert-env33-c): the user's own command line
}

}  // namespace edsc

#include "system/standard_streams.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>

#include "system/write_all.hpp"

namespace edsc {

void prepare_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. Opened for the other direction, so that using it fails like a closed one.
    if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

bool is_terminal(std::FILE* stream) { return isatty(fileno(stream)) != 0; }

bool is_dumb_terminal() {
  const char* const kind = std::getenv("TERM");
  return kind != nullptr && std::string_view{kind} == "dumb";
}

void report_closed_pipes() { std::signal(SIGPIPE, SIG_IGN); }

void write_to_stderr(std::string_view text) {
  sigset_t of_pipe{}, before{}, pending{};
  sigemptyset(&of_pipe);
  sigaddset(&of_pipe, SIGPIPE);
  sigpending(&pending);
  pthread_sigmask(SIG_BLOCK, &of_pipe, &before);
  const bool is_new = write_all(STDERR_FILENO, text) == EPIPE && sigismember(&pending, SIGPIPE) == 0;
  constexpr timespec at_once{};
  if (is_new) static_cast<void>(sigtimedwait(&of_pipe, nullptr, &at_once));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

int write_unbuffered(std::FILE* stream, std::string_view text) { return write_all(fileno(stream), text); }

}  // namespace edsc

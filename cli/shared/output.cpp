#include "shared/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <system_error>
#include <utility>

#include "shared/exit_code.hpp"

namespace edsc {
namespace {

constexpr const char* problem = "cannot write to standard output";

bool flushed() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout;
}

}  // namespace

void occupy_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. Opened for the other direction, so that using it fails like a closed one.
    if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

bool finish_output(int error_number) {
  errno = error_number;
  if (flushed()) return true;
  fmt::print(stderr, "edsc: {}{}{}\n", problem, errno == 0 ? "" : ": ", errno == 0 ? "" : std::strerror(errno));
  return false;
}

void write_output(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
    throw std::system_error{errno, std::generic_category(), problem};
  }
}

void write_output(const std::string& path, std::string text, const std::vector<std::string>& inputs) {
  if (path.empty()) {
    write_output(text);
  } else {
    write_all_files({{path, std::move(text)}}, inputs);
  }
}

void write_all_files(const std::vector<OutputFile>& files, const std::vector<std::string>& inputs) {
  if (const std::string failure = write_files(files, inputs); !failure.empty()) fail(failure);
}

void flush_output() {
  if (!flushed()) throw std::system_error{errno, std::generic_category(), problem};
}

}  // namespace edsc

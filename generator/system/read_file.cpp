#include "system/read_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

namespace edsc {
namespace {

constexpr const char* too_large = "larger than 1 GiB";
constexpr std::size_t read_at_once = std::size_t{1} << 16;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

/// Whether the descriptor is of a pipe without a name in a file system: its writer is connected already.
bool is_unnamed_pipe(int descriptor) {
  std::array<char, 16> target{};
  const ssize_t length = ::readlink(fmt::format("/proc/self/fd/{}", descriptor).c_str(), target.data(), target.size());
  return length > 0 && std::string_view{target.data(), static_cast<std::size_t>(length)}.starts_with("pipe:");
}

/// Why an open descriptor is not input; empty if it is.
std::string kind_problem(int descriptor, InputKind kind) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return reason(errno);
  if (S_ISREG(status.st_mode)) return "";
  if (S_ISDIR(status.st_mode)) return reason(EISDIR);
  if (S_ISFIFO(status.st_mode)) {
    return kind == InputKind::stream || is_unnamed_pipe(descriptor) ? "" : "is a FIFO; expected a file";
  }
  if (kind == InputKind::stream && ::isatty(descriptor) != 0) return "";
  return "is a device; expected a file";
}

/// Reads to the end. `bytes` has the size of an estimate.
std::string read_all(int descriptor, std::string& bytes) {
  std::size_t size = 0;
  for (ssize_t count = 1; count > 0;) {
    bytes.resize(std::max(size + read_at_once, bytes.size()));
    do {
      count = ::read(descriptor, bytes.data() + size, bytes.size() - size);
    } while (count < 0 && errno == EINTR);
    if (count < 0) return reason(errno);
    size += static_cast<std::size_t>(count);
    if (size > max_file_bytes) return too_large;
  }
  bytes.resize(size);
  return "";
}

}  // namespace

canopen::Descriptor open_input(const std::string& path, InputKind kind, std::string& problem) {
  // A stream waits for its writer. O_NONBLOCK has no effect on a file; with it, a FIFO opens at once, to be rejected.
  const int waits = kind == InputKind::stream ? 0 : O_NONBLOCK;
  canopen::Descriptor opened{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | waits)};
  if (!opened) {
    problem = reason(errno);
    return opened;
  }
  problem = kind_problem(opened.number(), kind);
  if (!problem.empty()) return canopen::Descriptor{};
  if (waits != 0) ::fcntl(opened.number(), F_SETFL, ::fcntl(opened.number(), F_GETFL) & ~O_NONBLOCK);
  return opened;
}

std::string read_file(const std::string& path, std::string& bytes) {
  if (path == "-") return read_all(STDIN_FILENO, bytes);
  std::string problem;
  const canopen::Descriptor file = open_input(path, InputKind::file, problem);
  if (!problem.empty()) return problem;
  struct stat status {};
  if (::fstat(file.number(), &status) == 0 && S_ISREG(status.st_mode)) {
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size > max_file_bytes) return too_large;
    bytes.resize(size + read_at_once);
  }
  return read_all(file.number(), bytes);
}

}  // namespace edsc

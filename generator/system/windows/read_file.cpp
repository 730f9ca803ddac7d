#include "system/read_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <windows.h>

#include <io.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "system/path.hpp"

namespace edsc {
namespace {

constexpr const char* file_too_large = "larger than 1 GiB";
constexpr std::size_t bytes_at_once = std::size_t{1} << 20;

std::string text_of(int error_number) { return std::generic_category().message(error_number); }

HANDLE handle_of(int descriptor) { return reinterpret_cast<HANDLE>(_get_osfhandle(descriptor)); }

/// Why an open descriptor is not input; empty if it is.
std::string problem_of_kind(int descriptor, InputKind kind) {
  DWORD mode = 0;
  switch (GetFileType(handle_of(descriptor))) {
    case FILE_TYPE_DISK: return "";
    case FILE_TYPE_PIPE: return kind == InputKind::stream ? "" : "is a FIFO; expected a file";
    default: break;
  }
  const bool is_console = GetConsoleMode(handle_of(descriptor), &mode) != 0;
  return kind == InputKind::stream && is_console ? "" : "is a device; expected a file";
}

/// Reads to the end. `bytes` has the size of an estimate.
std::string read_to_end(int descriptor, std::string& bytes) {
  std::size_t size = 0;
  for (int count = 1; count > 0;) {
    bytes.resize(std::max(size + bytes_at_once, bytes.size()));
    count = ::_read(descriptor, bytes.data() + size, static_cast<unsigned>(bytes_at_once));
    if (count < 0) return text_of(errno);
    size += static_cast<std::size_t>(count);
    if (size > max_file_bytes) return file_too_large;
  }
  bytes.resize(size);
  return "";
}

}  // namespace

canopen::Descriptor open_input(const std::string& path, InputKind kind, std::string& problem) {
  const std::filesystem::path native = to_native(path);
  canopen::Descriptor opened{::_wopen(native.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT)};
  if (!opened) {
    const int error_number = errno;
    std::error_code error;
    problem = text_of(std::filesystem::is_directory(native, error) ? EISDIR : error_number);
    return opened;
  }
  problem = problem_of_kind(opened.number(), kind);
  if (!problem.empty()) return canopen::Descriptor{};
  return opened;
}

std::string read_file(const std::string& path, std::string& bytes) {
  if (path == "-") return read_to_end(STDIN_FILENO, bytes);
  std::string problem;
  const canopen::Descriptor file = open_input(path, InputKind::file, problem);
  if (!problem.empty()) return problem;
  LARGE_INTEGER size;
  if (GetFileSizeEx(handle_of(file.number()), &size) != 0) {
    if (static_cast<std::size_t>(size.QuadPart) > max_file_bytes) return file_too_large;
    bytes.resize(static_cast<std::size_t>(size.QuadPart) + bytes_at_once);
  }
  return read_to_end(file.number(), bytes);
}

}  // namespace edsc

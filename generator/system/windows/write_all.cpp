#include "system/write_all.hpp"

#include <windows.h>

#include <io.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace edsc {
namespace {

constexpr std::size_t write_at_once = std::size_t{1} << 20;

/// The error number of the last call of _write(), which is EINVAL after the reader of a pipe has closed it.
int write_error(int descriptor) {
  const int error = errno;
  const bool is_pipe = GetFileType(reinterpret_cast<HANDLE>(_get_osfhandle(descriptor))) == FILE_TYPE_PIPE;
  return is_pipe && error == EINVAL ? EPIPE : error;
}

}  // namespace

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto size = static_cast<unsigned>(std::min(bytes.size(), write_at_once));
    const int count = ::_write(descriptor, bytes.data(), size);
    if (count < 0) return write_error(descriptor);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace edsc

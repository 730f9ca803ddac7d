#include "system/write_all.hpp"

#include <io.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace edsc {
namespace {

constexpr std::size_t write_at_once = std::size_t{1} << 20;

}  // namespace

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto size = static_cast<unsigned>(std::min(bytes.size(), write_at_once));
    const int count = ::_write(descriptor, bytes.data(), size);
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace edsc

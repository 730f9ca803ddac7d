/// What the tests of buses over a stream have in common.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <canopen/can/frame.hpp>
#include <optional>
#include <string>

#include "support/bench.hpp"

namespace bench {

inline std::string text_of(const std::optional<canopen::Frame>& frame) { return frame ? text(*frame) : "none"; }

/// What can be read within 2 ms.
inline std::string read_some(int descriptor) {
  pollfd waiting{descriptor, POLLIN, 0};
  char bytes[256];
  if (::poll(&waiting, 1, 2) <= 0) return "";
  const ssize_t count = ::read(descriptor, bytes, sizeof bytes);
  return count > 0 ? std::string(bytes, static_cast<std::size_t>(count)) : "";
}

}  // namespace bench

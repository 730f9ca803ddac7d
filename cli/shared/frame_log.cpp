#include "shared/frame_log.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "server/candump_line.hpp"
#include "shared/exit_code.hpp"

namespace edsc {

FrameLog::FrameLog(const std::string& path, std::string interface) : interface_{std::move(interface)} {
  if (path.empty()) return;
  own_.reset(std::fopen(path.c_str(), "we"));
  if (!own_) fail(fmt::format("{}: {}", path, std::strerror(errno)));
  file_ = own_.get();
}

/// The time of day, never earlier than that of the previous frame.
bool FrameLog::write(const canopen::Frame& frame, canopen::TimePoint at, canopen::TimePoint now) {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  const std::int64_t present_us = std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
  last_us_ = std::max(last_us_, present_us - std::int64_t{(now - at).count()});
  const socketcand::TimeStamp stamp{static_cast<std::time_t>(last_us_ / 1'000'000),
                                    static_cast<std::int32_t>(last_us_ % 1'000'000)};
  const std::string line = candump_line(frame, interface_, stamp) + "\n";
  ++frames_;
  return std::fwrite(line.data(), 1, line.size(), file_) == line.size();
}

}  // namespace edsc

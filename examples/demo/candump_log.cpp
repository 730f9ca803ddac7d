#include "candump_log.hpp"

#include <fmt/format.h>

#include <utility>

namespace demo {

CandumpLog::~CandumpLog() {
  if (file_ != nullptr) std::fclose(file_);
}

bool CandumpLog::open(const std::string& path) {
  file_ = std::fopen(path.c_str(), "w");
  return file_ != nullptr;
}

void CandumpLog::write(const canopen::Frame& frame, canopen::TimePoint now) {
  if (file_ == nullptr) return;
  const auto microseconds = static_cast<std::uint64_t>(now.since_start().count());
  std::string data = frame.remote ? fmt::format("R{}", frame.size) : "";
  for (unsigned i = 0; i < frame.size && !frame.remote; ++i) data += fmt::format("{:02X}", frame.data[i]);
  fmt::print(file_, "({:010}.{:06}) demo {:0{}X}#{}\n", microseconds / 1'000'000, microseconds % 1'000'000, frame.id,
             frame.extended ? 8 : 3, data);
}

bool CandumpLog::close() {
  if (file_ == nullptr) return true;
  const bool written = std::ferror(file_) == 0;
  return std::fclose(std::exchange(file_, nullptr)) == 0 && written;
}

}  // namespace demo

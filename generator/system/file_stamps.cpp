#include "system/file_stamps.hpp"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

#include "system/path.hpp"

namespace edsc {

FileStamps::FileStamps(std::vector<std::string> paths) : paths_{std::move(paths)} {
  std::ranges::sort(paths_);
  paths_.erase(std::unique(paths_.begin(), paths_.end()), paths_.end());
  for (const std::string& path : paths_) stamps_.push_back(stamp_of(path));
}

bool FileStamps::has_changed() const {
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (stamp_of(paths_[i]) != stamps_[i]) return true;
  }
  return false;
}

std::optional<FileStamps::Stamp> FileStamps::stamp_of(const std::string& path) {
  const std::filesystem::path native = to_native(path);
  std::error_code error;
  const auto time = std::filesystem::last_write_time(native, error);
  if (error) return std::nullopt;
  const std::uintmax_t size = std::filesystem::file_size(native, error);
  return Stamp{time, error ? 0 : size};
}

}  // namespace edsc

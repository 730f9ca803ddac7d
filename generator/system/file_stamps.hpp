/// Whether files have changed since they were read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace edsc {

/// Time and size of files when it was made; a file can be missing.
class FileStamps {
 public:
  FileStamps() = default;
  explicit FileStamps(std::vector<std::string> paths);

  /// Whether a file has another time or size now, is new, or is missing now.
  [[nodiscard]] bool has_changed() const;

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  /// Nothing for a missing file.
  [[nodiscard]] static std::optional<Stamp> stamp_of(const std::string& path);

  std::vector<std::string> paths_;
  std::vector<std::optional<Stamp>> stamps_;
};

}  // namespace edsc

/// A folder for temporary files.
#pragma once

#include <string>

namespace edsc {

/// A new folder that only this user can read. It is removed at the end, with its files.
class TemporaryFolder {
 public:
  /// Its name begins with `prefix`. Throws std::system_error if it cannot be created.
  explicit TemporaryFolder(const std::string& prefix);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace edsc

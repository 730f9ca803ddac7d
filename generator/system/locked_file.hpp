/// A file of this user that one process at a time has open, such as a journal. POSIX.
#pragma once

#include <canopen/host/descriptor.hpp>
#include <string>
#include <string_view>

namespace edsc {

/// Created with mode 0600 if it is missing.
class LockedFile {
 public:
  LockedFile() = default;
  explicit LockedFile(const std::string& path);

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(file_); }
  /// Whether another process has the file.
  [[nodiscard]] bool is_taken() const { return is_taken_; }
  /// Why the file cannot be opened, or was not written; empty otherwise.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Writes at the end. The bytes are on the disk afterwards, unless there is a problem.
  void append(std::string_view bytes);
  void clear();
  void remove_if_empty();

 private:
  void note_error();

  std::string path_;
  canopen::Descriptor file_;
  std::string problem_;
  bool is_taken_ = false;
};

}  // namespace edsc

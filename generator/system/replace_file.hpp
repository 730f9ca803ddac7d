/// What an operating system offers to replace files. Functions that fail set errno.
#pragma once

#include <canopen/host/descriptor.hpp>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace edsc {

/// Two names of one file have the same identity.
struct FileIdentity {
  std::uint64_t volume = 0;
  std::uint64_t number = 0;
  friend auto operator<=>(const FileIdentity&, const FileIdentity&) = default;
};

struct FileState {
  FileIdentity identity;
  bool is_folder = false;
  bool is_stream = false;  ///< a device, FIFO or socket
};

/// Follows symlinks. Nothing if the file cannot be examined; errno is ENOENT if it does not exist.
[[nodiscard]] std::optional<FileState> state_of(const std::string& path);

/// What is written for a path.
struct FinalPlace {
  std::filesystem::path path;     ///< after resolving all symlinks
  std::optional<int> descriptor;  ///< of this process, if the path names one, such as /dev/stdout
};
[[nodiscard]] FinalPlace final_place(const std::filesystem::path& path);

/// Whether two names in one folder are names of the same file.
[[nodiscard]] bool is_same_name(const std::filesystem::path& one, const std::filesystem::path& other);

/// Opens a file to compare its content; nothing if it is a link or stream.
[[nodiscard]] canopen::Descriptor open_regular(const std::filesystem::path& path);

/// Opens a device, FIFO or socket for writing.
[[nodiscard]] canopen::Descriptor open_stream(const std::filesystem::path& path);

/// Creates a file for writing. Fails with EEXIST if the name exists, so that nobody else can have planted a file or
/// symlink with this name.
[[nodiscard]] canopen::Descriptor create_file(const std::filesystem::path& path);

/// Prepares the open file `replacement` to replace `path`: it gets its mode, and its owner where possible. Returns
/// false if the system does not allow to replace the file.
[[nodiscard]] bool adopt_attributes(int replacement, const std::filesystem::path& path);

/// Writes the content of an open file to the disk. Also true if the file system does not support that.
[[nodiscard]] bool write_to_disk(int descriptor);

/// Gives `path` the content of `replacement`, in one step. If there was a file, and both can be exchanged, its old
/// content is in `replacement` afterwards, otherwise `replacement` is emptied.
[[nodiscard]] bool replace_file(const std::filesystem::path& path, bool exists, std::filesystem::path& replacement);

/// A folder, and a lock against other processes that write several files into it.
class LockableFolder {
 public:
  explicit LockableFolder(const std::filesystem::path& path);

  /// False if the folder cannot be opened.
  [[nodiscard]] explicit operator bool() const { return handle_ != nullptr; }
  [[nodiscard]] const FileIdentity& identity() const { return identity_; }

  /// Waits for the lock, which ends with this object. Nothing happens where a file system has no locks.
  void lock() const;
  /// Writes the names of files to the disk.
  void write_to_disk() const;

 private:
  std::shared_ptr<void> handle_;  ///< of a type that the system has
  FileIdentity identity_;
};

}  // namespace edsc

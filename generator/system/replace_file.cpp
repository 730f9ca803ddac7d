#include "system/replace_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace edsc {
namespace {

namespace fs = std::filesystem;
using canopen::Descriptor;

constexpr mode_t permission_bits = 07777;
constexpr mode_t without_set_id = 0777;
constexpr int max_symlinks = 40;  ///< as on Linux

FileIdentity identity_of(const struct stat& status) { return {status.st_dev, status.st_ino}; }

/// The descriptor of this process that a path in /proc/self/fd names.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code error;
  if (!fs::equivalent(path.parent_path(), "/proc/self/fd", error)) return std::nullopt;
  const std::string name = path.filename().string();
  int number = 0;
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
  return problem == std::errc{} && end == name.data() + name.size() ? std::optional{number} : std::nullopt;
}

int number_of(const std::shared_ptr<void>& folder) { return static_cast<const Descriptor*>(folder.get())->number(); }

}  // namespace

std::optional<FileState> state_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  const bool is_folder = S_ISDIR(status.st_mode);
  return FileState{identity_of(status), is_folder, !is_folder && !S_ISREG(status.st_mode)};
}

FinalPlace final_place(const fs::path& path) {
  FinalPlace place{path, std::nullopt};
  for (int i = 0; i < max_symlinks; ++i) {
    if (place.descriptor = own_descriptor(place.path); place.descriptor) return place;
    std::error_code error;
    const fs::path next = fs::read_symlink(place.path, error);
    if (error) return place;
    place.path = place.path.parent_path() / next;
  }
  return place;
}

bool is_same_name(const fs::path& one, const fs::path& other) { return one == other; }

Descriptor open_regular(const fs::path& path) {
  Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  struct stat status {};
  if (!file || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) return Descriptor{};
  return file;
}

Descriptor open_stream(const fs::path& path) {
  return Descriptor{::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)};
}

Descriptor create_file(const fs::path& path) {
  return Descriptor{::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666)};
}

bool adopt_attributes(int replacement, const fs::path& path) {
  struct stat before {};
  if (::lstat(path.c_str(), &before) != 0) return true;
  mode_t mode = before.st_mode & permission_bits;
  if (::fchown(replacement, before.st_uid, before.st_gid) != 0) {
    mode &= without_set_id;  // set-ID bits of one user do not apply to another
    [[maybe_unused]] const int group_kept = ::fchown(replacement, static_cast<uid_t>(-1), before.st_gid);
  }
  static_cast<void>(::fchmod(replacement, mode));
  return true;
}

bool write_to_disk(int descriptor) { return ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOSYS; }

bool replace_file(const fs::path& path, bool exists, fs::path& replacement) {
  if (exists && ::renameat2(AT_FDCWD, replacement.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (::rename(replacement.c_str(), path.c_str()) != 0) return false;
  replacement.clear();
  return true;
}

LockableFolder::LockableFolder(const fs::path& path) {
  Descriptor folder{::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  struct stat status {};
  if (!folder || ::fstat(folder.number(), &status) != 0) return;
  identity_ = identity_of(status);
  handle_ = std::make_shared<Descriptor>(std::move(folder));
}

void LockableFolder::lock() const {
  while (::flock(number_of(handle_), LOCK_EX) != 0 && errno == EINTR) {
  }
}

void LockableFolder::write_to_disk() const { ::fsync(number_of(handle_)); }

}  // namespace edsc

#include "system/locked_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

namespace edsc {

LockedFile::LockedFile(const std::string& path) : path_{path} {
  constexpr mode_t of_owner = 0600;
  file_ = canopen::Descriptor{::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, of_owner)};
  if (!file_) {
    note_error();
  } else if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    is_taken_ = true;
    file_ = {};
  }
}

void LockedFile::append(std::string_view bytes) {
  if (!file_) return;
  problem_.clear();
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_.number(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return note_error();
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  if (::fdatasync(file_.number()) != 0) note_error();
}

void LockedFile::clear() {
  if (file_ && ::ftruncate(file_.number(), 0) != 0) note_error();
}

void LockedFile::remove_if_empty() {
  struct stat state {};
  if (file_ && ::fstat(file_.number(), &state) == 0 && state.st_size == 0) ::unlink(path_.c_str());
}

void LockedFile::note_error() { problem_ = path_ + ": " + std::generic_category().message(errno); }

}  // namespace edsc

#include "system/write_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <canopen/host/descriptor.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string_view>
#include <system_error>
#include <utility>

#include "system/path.hpp"
#include "system/write_all.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

constexpr mode_t permission_bits = 07777;
constexpr mode_t without_set_id = 0777;

std::string reason() { return std::strerror(errno); }

using canopen::Descriptor;

/// Some file systems report a full disk only at this point.
bool closed(Descriptor& descriptor) { return descriptor.close() == 0 || errno == EINTR; }

/// The descriptor of this process that a path in /proc/self/fd names.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code error;
  if (!fs::equivalent(path.parent_path(), "/proc/self/fd", error)) return std::nullopt;
  const std::string name = path.filename().string();
  int number = 0;
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
  return problem == std::errc{} && end == name.data() + name.size() ? std::optional{number} : std::nullopt;
}

/// One file to write.
class Target {
 public:
  explicit Target(const OutputFile& file) : file_{&file}, path_{to_native(file.path)} {}

  /// Follows symlinks and examines the target. Does not change anything.
  [[nodiscard]] std::string find() {
    struct stat status {};
    if (::stat(file_->path.c_str(), &status) == 0) {
      status_ = status;
    } else if (errno != ENOENT) {
      return problem();  // also for a symlink that the kernel does not follow, in a world-writable folder
    }
    follow_symlinks();
    if (path_.filename().empty() || (status_ && S_ISDIR(status_->st_mode))) return file_->path + ": is a folder";
    return "";
  }

  [[nodiscard]] bool is_stream() const { return descriptor_ || (status_ && !S_ISREG(status_->st_mode)); }

  /// The folder of the file, an absolute or relative path that is not empty.
  [[nodiscard]] fs::path folder() const { return path_.has_parent_path() ? path_.parent_path() : fs::path{"."}; }

  [[nodiscard]] std::string make_folder() const {
    std::error_code error;
    fs::create_directories(folder(), error);
    return error ? from_native(folder()) + ": " + error.message() : "";
  }

  /// The message if it is the file of `input`, also by a hard link or symlink.
  [[nodiscard]] std::string conflict_with(const std::string& input) const {
    struct stat other {};
    if (!status_ || ::stat(input.c_str(), &other) != 0) return "";
    const bool is_same = status_->st_dev == other.st_dev && status_->st_ino == other.st_ino;
    return is_same ? file_->path + ": is the same file as the input " + input : "";
  }

  /// The message if both would have the same name in the same folder.
  [[nodiscard]] std::string conflict_with(const Target& other) const {
    std::error_code error;
    const bool is_same = path_.filename() == other.path_.filename() && fs::equivalent(folder(), other.folder(), error);
    return is_same ? file_->path + ": is the same file as the output " + other.file_->path : "";
  }

  /// Whether the file already has its content, by its current state.
  [[nodiscard]] bool is_up_to_date() {
    struct stat status {};
    const Descriptor in{::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
    if (!in || ::fstat(in.number(), &status) != 0) return false;
    std::string_view content = file_->content;
    if (!S_ISREG(status.st_mode) || status.st_size != static_cast<off_t>(content.size())) return false;
    std::array<char, 1 << 16> found;
    while (!content.empty()) {
      const ssize_t count = ::read(in.number(), found.data(), std::min(content.size(), found.size()));
      if (count <= 0) return false;
      const auto size = static_cast<std::size_t>(count);
      if (content.substr(0, size) != std::string_view{found.data(), size}) return false;
      content.remove_prefix(size);
    }
    return true;
  }

  [[nodiscard]] std::string write_into_stream() const {
    Descriptor opened;
    if (descriptor_) {
      std::fflush(nullptr);
    } else {
      opened = Descriptor{::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)};
      if (!opened) return problem();
    }
    if (write_all(descriptor_.value_or(opened.number()), file_->content) != 0) return problem();
    return descriptor_ || closed(opened) ? "" : problem();
  }

  [[nodiscard]] std::string write_temporary() {
    Descriptor out = make_temporary();
    if (!out) return problem();
    struct stat before {};
    exists_ = ::lstat(path_.c_str(), &before) == 0;
    if (exists_) keep_owner_and_mode(out.number(), before);
    const bool written = write_all(out.number(), file_->content) == 0 && is_on_disk(out.number()) && closed(out);
    return written ? "" : problem();
  }

  /// Exchanges the new file and the old one, which is the temporary file from now on.
  [[nodiscard]] std::string replace() {
    const bool exchanged =
        exists_ && ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0;
    if (!exchanged) {
      if (::rename(temporary_.c_str(), path_.c_str()) != 0) return problem();
      temporary_.clear();
    }
    replaced_ = true;
    return "";
  }

  void undo() {
    if (!replaced_) return;
    if (!temporary_.empty()) {
      static_cast<void>(::rename(temporary_.c_str(), path_.c_str()));
      temporary_.clear();
    } else if (!exists_) {
      ::unlink(path_.c_str());
    }
  }

  void remove_temporary() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

 private:
  static constexpr int max_symlinks = 40;  ///< as on Linux
  static constexpr int max_names = 100;

  [[nodiscard]] std::string problem() const { return file_->path + ": " + reason(); }

  void follow_symlinks() {
    for (int i = 0; i < max_symlinks; ++i) {
      if (descriptor_ = own_descriptor(path_); descriptor_) return;
      std::error_code error;
      const fs::path next = fs::read_symlink(path_, error);
      if (error) return;
      path_ = path_.parent_path() / next;
    }
  }

  /// Creates a new file, so that nobody else can have planted a file or symlink with this name.
  Descriptor make_temporary() {
    std::random_device random;
    for (int i = 0; i < max_names; ++i) {
      const std::string path = from_native(folder() / fmt::format(".edsc-{:08x}{:08x}", random(), random()));
      Descriptor out{::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666)};
      if (out) temporary_ = path;
      if (out || errno != EEXIST) return out;
    }
    return Descriptor{};
  }

  static void keep_owner_and_mode(int descriptor, const struct stat& before) {
    mode_t mode = before.st_mode & permission_bits;
    if (::fchown(descriptor, before.st_uid, before.st_gid) != 0) {
      mode &= without_set_id;  // set-ID bits of one user do not apply to another
      [[maybe_unused]] const int group_kept = ::fchown(descriptor, static_cast<uid_t>(-1), before.st_gid);
    }
    static_cast<void>(::fchmod(descriptor, mode));
  }

  /// Also true if the file system does not support the query.
  static bool is_on_disk(int descriptor) { return ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOSYS; }

  const OutputFile* file_;
  fs::path path_;                      ///< after resolving all symlinks
  std::optional<struct stat> status_;  ///< of the original target
  std::optional<int> descriptor_;      ///< of this process
  std::string temporary_;
  bool exists_ = false;
  bool replaced_ = false;
};

/// The folders of the files, each once. Locks them against other processes that write several files into them.
class Folders {
 public:
  void open(const fs::path& path) {
    Descriptor folder{::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    struct stat status {};
    if (!folder || ::fstat(folder.number(), &status) != 0) return;
    Folder& found = folders_[{status.st_dev, status.st_ino}];
    ++found.files;
    if (!found.descriptor) found.descriptor = std::move(folder);
  }

  /// Locks in an order that is the same in all processes. File systems without locks are not locked.
  void lock() const {
    for (const auto& [id, folder] : folders_) {
      while (folder.files > 1 && ::flock(folder.descriptor.number(), LOCK_EX) != 0 && errno == EINTR) {
      }
    }
  }

  /// Includes the names of files.
  void write_to_disk() const {
    for (const auto& [id, folder] : folders_) ::fsync(folder.descriptor.number());
  }

 private:
  struct Folder {
    Descriptor descriptor;
    unsigned files = 0;
  };
  std::map<std::pair<dev_t, ino_t>, Folder> folders_;
};

/// The first problem that `action` reports for one of the targets.
template <class Action>
std::string for_each(std::vector<Target>& targets, Action action) {
  for (Target& target : targets) {
    if (std::string problem = action(target); !problem.empty()) return problem;
  }
  return "";
}

/// The first output that is an input, or another output.
std::string find_conflict(const std::vector<Target>& targets, const std::vector<std::string>& inputs) {
  for (auto target = targets.begin(); target != targets.end(); ++target) {
    for (const std::string& input : inputs) {
      if (std::string problem = target->conflict_with(input); !problem.empty()) return problem;
    }
    for (auto other = targets.begin(); other != target; ++other) {
      if (std::string problem = target->conflict_with(*other); !problem.empty()) return problem;
    }
  }
  return "";
}

std::string write_targets(std::vector<Target>& files, std::vector<Target>& streams) {
  std::string problem = for_each(files, [](Target& one) { return one.write_temporary(); });
  if (problem.empty()) problem = for_each(streams, [](Target& one) { return one.write_into_stream(); });
  if (problem.empty()) problem = for_each(files, [](Target& one) { return one.replace(); });
  if (!problem.empty()) std::for_each(files.rbegin(), files.rend(), [](Target& one) { one.undo(); });
  for (Target& one : files) one.remove_temporary();
  return problem;
}

}  // namespace

std::string write_files(const std::vector<OutputFile>& files, const std::vector<std::string>& inputs) {
  std::vector<Target> replaced, streams;
  for (const OutputFile& file : files) {
    Target target{file};
    if (std::string problem = target.find(); !problem.empty()) return problem;
    (target.is_stream() ? streams : replaced).push_back(std::move(target));
  }
  if (std::string problem = find_conflict(replaced, inputs); !problem.empty()) return problem;
  Folders folders;
  for (const Target& target : replaced) {
    if (std::string problem = target.make_folder(); !problem.empty()) return problem;
    folders.open(target.folder());
  }
  if (std::string problem = find_conflict(replaced, {}); !problem.empty()) return problem;
  folders.lock();
  std::erase_if(replaced, [](Target& target) { return target.is_up_to_date(); });
  const bool any_replaced = !replaced.empty();
  std::string problem = write_targets(replaced, streams);
  if (problem.empty() && any_replaced) folders.write_to_disk();
  return problem;
}

}  // namespace edsc

#include "system/write_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <canopen/host/descriptor.hpp>
#include <cerrno>
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
#include "system/replace_file.hpp"
#include "system/write_all.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;
using canopen::Descriptor;

std::string reason() { return std::strerror(errno); }

/// Some file systems report a full disk only at this point.
bool closed(Descriptor& descriptor) { return descriptor.close() == 0 || errno == EINTR; }

/// One file to write.
class Target {
 public:
  explicit Target(const OutputFile& file) : file_{&file}, place_{to_native(file.path), std::nullopt} {}

  /// Follows symlinks and examines the target. Does not change anything.
  [[nodiscard]] std::string find() {
    state_ = state_of(file_->path);
    if (!state_ && errno != ENOENT)
      return problem();  // also for a symlink that the kernel does not follow, in a
                         // world-writable folder
    place_ = final_place(place_.path);
    if (path().filename().empty() || (state_ && state_->is_folder)) return file_->path + ": is a folder";
    return "";
  }

  [[nodiscard]] bool is_stream() const { return place_.descriptor || (state_ && state_->is_stream); }

  /// The folder of the file, an absolute or relative path that is not empty.
  [[nodiscard]] fs::path folder() const { return path().has_parent_path() ? path().parent_path() : fs::path{"."}; }

  [[nodiscard]] std::string make_folder() const {
    std::error_code error;
    fs::create_directories(folder(), error);
    return error ? from_native(folder()) + ": " + error.default_error_condition().message() : "";
  }

  /// The message if it is the file of `input`, also by a hard link or symlink.
  [[nodiscard]] std::string conflict_with(const std::string& input) const {
    const std::optional<FileState> other = state_ ? state_of(input) : std::nullopt;
    const bool is_same = other && state_->identity == other->identity;
    return is_same ? file_->path + ": is the same file as the input " + input : "";
  }

  /// The message if both would have the same name in the same folder.
  [[nodiscard]] std::string conflict_with(const Target& other) const {
    std::error_code error;
    const bool is_same =
        is_same_name(path().filename(), other.path().filename()) && fs::equivalent(folder(), other.folder(), error);
    return is_same ? file_->path + ": is the same file as the output " + other.file_->path : "";
  }

  /// Whether the file already has its content, by its current state.
  [[nodiscard]] bool is_up_to_date() const {
    const Descriptor in = open_regular(path());
    if (!in) return false;
    std::string_view content = file_->content;
    std::array<char, 1 << 16> found;
    while (true) {
      const auto count = ::read(in.number(), found.data(), static_cast<unsigned>(found.size()));
      if (count <= 0) return count == 0 && content.empty();
      const std::string_view piece{found.data(), static_cast<std::size_t>(count)};
      if (!content.starts_with(piece)) return false;
      content.remove_prefix(piece.size());
    }
  }

  [[nodiscard]] std::string write_into_stream() const {
    Descriptor opened;
    if (place_.descriptor) {
      std::fflush(nullptr);
    } else {
      opened = open_stream(path());
      if (!opened) return problem();
    }
    if (write_all(place_.descriptor.value_or(opened.number()), file_->content) != 0) return problem();
    return place_.descriptor || closed(opened) ? "" : problem();
  }

  [[nodiscard]] std::string write_temporary() {
    Descriptor out = make_temporary();
    if (!out) return problem();
    std::error_code error;
    exists_ = fs::exists(fs::symlink_status(path(), error));
    const bool written = (!exists_ || adopt_attributes(out.number(), path())) &&
                         write_all(out.number(), file_->content) == 0 && write_to_disk(out.number()) && closed(out);
    return written ? "" : problem();
  }

  /// Exchanges the new file and the old one, which is the temporary file from now on.
  [[nodiscard]] std::string replace() {
    if (!replace_file(path(), exists_, temporary_)) return problem();
    replaced_ = true;
    return "";
  }

  void undo() {
    if (!replaced_) return;
    std::error_code error;
    if (!temporary_.empty()) {
      fs::rename(temporary_, path(), error);
      temporary_.clear();
    } else if (!exists_) {
      fs::remove(path(), error);
    }
  }

  void remove_temporary() const {
    std::error_code error;
    if (!temporary_.empty()) fs::remove(temporary_, error);
  }

 private:
  static constexpr int max_names = 100;

  [[nodiscard]] const fs::path& path() const { return place_.path; }
  [[nodiscard]] std::string problem() const { return file_->path + ": " + reason(); }

  Descriptor make_temporary() {
    std::random_device random;
    for (int i = 0; i < max_names; ++i) {
      const fs::path path = folder() / fmt::format(".edsc-{:08x}{:08x}", random(), random());
      Descriptor out = create_file(path);
      if (out) temporary_ = path;
      if (out || errno != EEXIST) return out;
    }
    return Descriptor{};
  }

  const OutputFile* file_;
  FinalPlace place_;
  std::optional<FileState> state_;  ///< of the original target
  fs::path temporary_;
  bool exists_ = false;
  bool replaced_ = false;
};

/// The folders of the files, each once. Locks them against other processes that write several files into them.
class Folders {
 public:
  void open(const fs::path& path) {
    LockableFolder folder{path};
    if (!folder) return;
    const FileIdentity identity = folder.identity();
    ++folders_.try_emplace(identity, Folder{std::move(folder)}).first->second.files;
  }

  /// Locks in an order that is the same in all processes.
  void lock() const {
    for (const auto& [identity, folder] : folders_) {
      if (folder.files > 1) folder.handle.lock();
    }
  }

  /// Includes the names of files.
  void write_to_disk() const {
    for (const auto& [identity, folder] : folders_) folder.handle.write_to_disk();
  }

 private:
  struct Folder {
    LockableFolder handle;
    unsigned files = 0;
  };
  std::map<FileIdentity, Folder> folders_;
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

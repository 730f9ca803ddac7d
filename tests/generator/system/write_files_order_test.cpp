/// After a power loss, a file has its old or its new content: the new content is on the disk before the file gets its
/// name. The functions of the C library are replaced for this program by those below, which record the calls.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "system/write_files.hpp"

namespace {

namespace fs = std::filesystem;

/// A call, and the size of the file at that moment; a folder has none.
struct DiskCall {
  std::string name;
  std::string path;
  std::uintmax_t size = 0;
};

/// Null if the calls of this thread are not recorded.
thread_local std::vector<DiskCall>* disk_calls = nullptr;

std::string path_of_descriptor(int descriptor) {
  std::error_code error;
  return fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error).string();
}

void record(std::string name, const std::string& path) {
  if (disk_calls == nullptr) return;
  std::error_code error;
  const bool is_file = fs::is_regular_file(path, error);
  disk_calls->push_back({std::move(name), path, is_file ? fs::file_size(path, error) : 0});
}

}  // namespace

extern "C" {

int fsync(int descriptor) {
  record("fsync", path_of_descriptor(descriptor));
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

int rename(const char* from, const char* to) noexcept {
  record("rename", from);
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0U));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  record("rename", from);
  return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
}

namespace edsc {
namespace {

TEST(WriteFilesOrder, PutsTheContentOnTheDiskBeforeTheName) {
  const fs::path folder = fs::path{testing::TempDir()} / "edsc_write_files_order";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string old = (folder / "old").string();
  std::ofstream{old} << "before";
  std::vector<DiskCall> calls;
  disk_calls = &calls;
  const std::string problem = write_files({{old, "after it"}, {(folder / "new").string(), "first"}});
  disk_calls = nullptr;
  ASSERT_EQ(problem, "");

  std::vector<std::string> synced;
  int renamed = 0;
  for (const DiskCall& call : calls) {
    if (call.name == "fsync") {
      EXPECT_FALSE(renamed == 1) << "a file is written after another one has its name";
      synced.push_back(call.path);
      continue;
    }
    ++renamed;
    EXPECT_EQ(call.size, renamed == 1 ? 8U : 5U);
    EXPECT_NE(std::ranges::find(synced, call.path), synced.end()) << call.path << " was not on the disk";
  }
  EXPECT_EQ(renamed, 2);
  ASSERT_FALSE(calls.empty());
  EXPECT_EQ(calls.back().name + " " + calls.back().path, "fsync " + fs::canonical(folder).string());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace edsc

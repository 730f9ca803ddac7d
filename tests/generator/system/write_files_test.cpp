#include "system/write_files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace edsc {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>{in}, {}};
}

class WriteFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path{testing::TempDir()} / (std::string{"edsc_"} + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }

  /// Paths of all files in the folder and its subfolders.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator{folder_}) {
      std::error_code error;
      if (entry.is_regular_file(error)) result.push_back(fs::relative(entry.path(), folder_).string());
    }
    std::ranges::sort(result);
    return result;
  }

  fs::path folder_;
};

using Names = std::vector<std::string>;

TEST_F(WriteFiles, MakesFoldersAndFiles) {
  EXPECT_EQ(write_files({{path("a/b/one.hpp"), "1"}, {path("two.hpp"), ""}}), "");
  EXPECT_EQ(content_of(path("a/b/one.hpp")), "1");
  EXPECT_EQ(files(), (Names{"a/b/one.hpp", "two.hpp"}));
}

TEST_F(WriteFiles, ReplacesTheContent) {
  EXPECT_EQ(write_files({{path("one.hpp"), "a longer text"}}), "");
  EXPECT_EQ(write_files({{path("one.hpp"), "short"}}), "");
  EXPECT_EQ(content_of(path("one.hpp")), "short");
  EXPECT_EQ(files(), Names{"one.hpp"});
}

TEST_F(WriteFiles, LeavesTheTimeStampOfAnUnchangedFile) {
  ASSERT_EQ(write_files({{path("same.hpp"), "same"}, {path("other.hpp"), "before"}}), "");
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours{1};
  fs::last_write_time(path("same.hpp"), old);
  fs::last_write_time(path("other.hpp"), old);
  EXPECT_EQ(write_files({{path("same.hpp"), "same"}, {path("other.hpp"), "behind"}}), "");
  EXPECT_EQ(fs::last_write_time(path("same.hpp")), old);
  EXPECT_NE(fs::last_write_time(path("other.hpp")), old);
}

TEST_F(WriteFiles, ChangesNothingWhenOneTargetIsAFolder) {
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}}), "");
  fs::create_directories(path("two.hpp"));
  const std::string problem =
      write_files({{path("one.hpp"), "after"}, {path("two.hpp"), "2"}, {path("three.hpp"), "3"}});
  EXPECT_NE(problem.find("two.hpp"), std::string::npos) << problem;
  EXPECT_EQ(content_of(path("one.hpp")), "before");
  EXPECT_EQ(files(), Names{"one.hpp"});
}

TEST_F(WriteFiles, ChangesNothingWhenOneFolderCannotBeMade) {
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}, {path("file"), "in the way"}}), "");
  const std::string problem = write_files({{path("one.hpp"), "after"}, {path("file/two.hpp"), "2"}});
  EXPECT_NE(problem.find("file"), std::string::npos) << problem;
  EXPECT_EQ(content_of(path("one.hpp")), "before");
  EXPECT_EQ(files(), (Names{"file", "one.hpp"}));
}

/// While this exists, no file of this process may exceed `bytes`: writing fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST_F(WriteFiles, ChangesNothingWhenTheDiskTakesNoMore) {
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}}), "");
  std::string problem;
  {
    const FileSizeLimit limit{100};
    problem = write_files({{path("one.hpp"), "after"}, {path("two.hpp"), std::string(1000, '2')}});
  }
  EXPECT_NE(problem.find("two.hpp"), std::string::npos) << problem;
  EXPECT_EQ(content_of(path("one.hpp")), "before");
  EXPECT_EQ(files(), Names{"one.hpp"});
}

TEST_F(WriteFiles, DoesNotFollowASymlinkWithTheNameOfATemporaryFile) {
  ASSERT_EQ(write_files({{path("victim"), "mine"}}), "");
  fs::create_symlink(path("victim"), path("one.hpp.edsc-tmp"));
  EXPECT_EQ(write_files({{path("one.hpp"), "1"}}), "");
  EXPECT_EQ(content_of(path("victim")), "mine");
  EXPECT_EQ(content_of(path("one.hpp")), "1");
}

TEST_F(WriteFiles, ReplacesTheTargetOfASymlinkAndKeepsTheSymlink) {
  fs::create_directory(path("real"));
  ASSERT_EQ(write_files({{path("real/one.hpp"), "before"}}), "");
  fs::create_symlink("real/one.hpp", path("near.hpp"));
  fs::create_symlink(path("near.hpp"), path("far.hpp"));
  EXPECT_EQ(write_files({{path("far.hpp"), "after"}}), "");
  EXPECT_TRUE(fs::is_symlink(path("far.hpp")));
  EXPECT_TRUE(fs::is_symlink(path("near.hpp")));
  EXPECT_EQ(content_of(path("real/one.hpp")), "after");
  EXPECT_EQ(files().size(), 3U) << "no temporary file is left";
}

TEST_F(WriteFiles, MakesTheMissingTargetOfASymlink) {
  fs::create_symlink("new.hpp", path("link.hpp"));
  EXPECT_EQ(write_files({{path("link.hpp"), "1"}}), "");
  EXPECT_TRUE(fs::is_symlink(path("link.hpp")));
  EXPECT_EQ(content_of(path("new.hpp")), "1");
}

TEST_F(WriteFiles, RefusesASymlinkThatLeadsToItselfOrToAFolder) {
  fs::create_symlink("loop.hpp", path("loop.hpp"));
  fs::create_symlink(".", path("folder.hpp"));
  for (const char* name : {"loop.hpp", "folder.hpp"}) {
    const std::string problem = write_files({{path("one.hpp"), "1"}, {path(name), "2"}});
    EXPECT_NE(problem.find(name), std::string::npos) << problem;
    EXPECT_EQ(files(), Names{});
  }
}

TEST_F(WriteFiles, RefusesAnOutputThatIsAnInputByAnyOfItsNames) {
  ASSERT_EQ(write_files({{path("input"), "mine"}}), "");
  fs::create_hard_link(path("input"), path("hard"));
  fs::create_symlink("hard", path("symbolic"));
  for (const char* name : {"input", "hard", "symbolic"}) {
    EXPECT_EQ(write_files({{path("one.hpp"), "1"}, {path(name), "2"}}, {path("missing"), path("input")}),
              path(name) + ": is the same file as the input " + path("input"));
    EXPECT_EQ(content_of(path("input")), "mine");
    EXPECT_FALSE(fs::exists(path("one.hpp")));
  }
}

TEST_F(WriteFiles, RefusesTwoOutputsThatAreOneFile) {
  fs::create_symlink("one.hpp", path("link.hpp"));
  for (const char* name : {"one.hpp", "./one.hpp", "link.hpp"}) {
    EXPECT_EQ(write_files({{path("one.hpp"), "1"}, {path(name), "2"}}),
              path(name) + ": is the same file as the output " + path("one.hpp"));
    EXPECT_EQ(files(), Names{});
  }
  EXPECT_NE(write_files({{path("new/one.hpp"), "1"}, {path("new/../new/one.hpp"), "2"}}), "");
  EXPECT_EQ(files(), Names{});
}

TEST_F(WriteFiles, SeparatesHardLinks) {
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}}), "");
  fs::create_hard_link(path("one.hpp"), path("two.hpp"));
  EXPECT_EQ(write_files({{path("one.hpp"), "1"}, {path("two.hpp"), "2"}}), "");
  EXPECT_EQ(content_of(path("one.hpp")), "1");
  EXPECT_EQ(content_of(path("two.hpp")), "2");
}

TEST_F(WriteFiles, KeepsTheModeOfAReplacedFile) {
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}}), "");
  const auto mode = fs::perms::owner_all | fs::perms::group_read;
  fs::permissions(path("one.hpp"), mode);
  EXPECT_EQ(write_files({{path("one.hpp"), "after"}}), "");
  EXPECT_EQ(fs::status(path("one.hpp")).permissions(), mode);
}

/// Calls `action` in a child process; returns its exit code.
template <class Action>
int in_a_process(Action action) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(action());
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(WriteFiles, DropsTheSetIdBitsOfAFileOfAnotherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED: this user may not become another one";
  constexpr uid_t nobody = 65534;
  constexpr auto rights = fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec;
  ASSERT_EQ(write_files({{path("tool"), "before"}}), "");
  fs::permissions(path("tool"), rights | fs::perms::set_uid | fs::perms::set_gid | fs::perms::sticky_bit);
  fs::permissions(folder_, fs::perms::all);
  EXPECT_EQ(in_a_process([&] {
              if (::chdir(folder_.c_str()) != 0 || ::setuid(nobody) != 0) return 2;
              return write_files({{"tool", "after"}}).empty() ? 0 : 1;
            }),
            0);
  EXPECT_EQ(content_of(path("tool")), "after");
  EXPECT_EQ(fs::status(path("tool")).permissions(), rights);
}

/// Whether the kernel lists somebody who waits for the lock of this file.
bool is_waited_for(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return false;
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    const std::string inode = ":" + std::to_string(status.st_ino) + " ";
    if (line.find("-> FLOCK") != std::string::npos && line.find(inode) != std::string::npos) return true;
  }
  return false;
}

TEST_F(WriteFiles, WaitsForAnotherProcessThatWritesSeveralFilesIntoTheFolder) {
  const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(folder, LOCK_EX), 0);
  EXPECT_EQ(write_files({{path("alone.hpp"), "0"}}), "") << "a single file is replaced in one step";
  std::atomic<bool> done = false;
  std::thread writer{[&] {
    EXPECT_EQ(write_files({{path("one.hpp"), "1"}, {path("two.hpp"), "2"}}), "");
    done = true;
  }};
  while (!done && !is_waited_for(folder_)) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  EXPECT_FALSE(done);
  ::close(folder);
  writer.join();
  EXPECT_EQ(files(), (Names{"alone.hpp", "one.hpp", "two.hpp"}));
}

TEST_F(WriteFiles, WritesIntoAFifo) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  std::string read;
  std::thread reader{[&] { read = content_of(path("fifo")); }};
  EXPECT_EQ(write_files({{path("fifo"), "through"}}), "");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(path("fifo")));
}

/// The descriptors of this process for a file.
std::vector<int> descriptors_of(const fs::path& path) {
  struct stat wanted {};
  ::stat(path.c_str(), &wanted);
  std::vector<int> result;
  for (const auto& entry : fs::directory_iterator{"/proc/self/fd"}) {
    struct stat found {};
    const bool is_same =
        ::stat(entry.path().c_str(), &found) == 0 && found.st_dev == wanted.st_dev && found.st_ino == wanted.st_ino;
    if (is_same) result.push_back(std::stoi(entry.path().filename()));
  }
  return result;
}

TEST_F(WriteFiles, OpensNoDescriptorThatAnotherProgramInherits) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  const std::string more_than_a_pipe_holds(1 << 20, 'x');
  std::thread writer{[&] { EXPECT_EQ(write_files({{path("fifo"), more_than_a_pipe_holds}}), ""); }};
  std::ifstream in(path("fifo"), std::ios::binary);
  EXPECT_EQ(in.get(), 'x');
  const std::vector<int> descriptors = descriptors_of(path("fifo"));
  EXPECT_EQ(descriptors.size(), 2U) << "the reader and the writer";
  for (const int descriptor : descriptors) {
    if ((::fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_WRONLY) continue;
    EXPECT_NE(::fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
  }
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>{in}, {}).size(), more_than_a_pipe_holds.size() - 1);
  writer.join();
}

TEST_F(WriteFiles, WritesIntoADevice) {
  constexpr unsigned memory_devices = 1, null_device = 3, full_device = 7;
  if (mknod(path("null").c_str(), S_IFCHR | 0600, makedev(memory_devices, null_device)) != 0) {
    GTEST_SKIP() << "SKIPPED: this user may not make devices";
  }
  ASSERT_EQ(mknod(path("full").c_str(), S_IFCHR | 0600, makedev(memory_devices, full_device)), 0);
  fs::create_symlink("null", path("link"));
  EXPECT_EQ(write_files({{path("null"), "nowhere"}, {path("link"), "nowhere"}}), "");
  EXPECT_TRUE(fs::is_character_file(path("null")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  const std::string problem = write_files({{path("one.hpp"), "1"}, {path("full"), "2"}});
  EXPECT_NE(problem.find("full"), std::string::npos) << problem;
  EXPECT_TRUE(fs::is_character_file(path("full")));
  EXPECT_FALSE(fs::exists(path("one.hpp"))) << "all files or none";
}

}  // namespace
}  // namespace edsc

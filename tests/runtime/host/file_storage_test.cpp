/// A file as the storage of a node: what another process reads from it, and what happens if it cannot be written.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <canopen/host/file_storage.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stored_device/device.hpp>

#include "support/bench.hpp"

namespace {

namespace fs = std::filesystem;
namespace od = stored_device::od;
using canopen::FileStorage;
using canopen::StorageState;

using Device = bench::Bench<stored_device::Device, canopen::StoredIn<FileStorage>>;

constexpr auto save_all = "605 23 10 10 01 73 61 76 65";
constexpr auto saved_all = "585 60 10 10 01 00 00 00 00";

class FileStorageTest : public testing::Test {
 protected:
  FileStorageTest() {
    std::string name = (fs::temp_directory_path() / "edsc_storage_XXXXXX").string();
    folder = ::mkdtemp(name.data());
    path = folder / "parameters";
  }
  ~FileStorageTest() override {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  /// The value that another node reads.
  [[nodiscard]] std::uint32_t stored_acceleration() const {
    FileStorage storage{path.string()};
    Device device{canopen::stored_in(storage)};
    return device.node.get<od::profile_acceleration>();
  }

  fs::path folder;
  fs::path path;
};

TEST_F(FileStorageTest, IsEmptyWithoutAFile) {
  FileStorage storage{path.string()};
  EXPECT_EQ(storage.open(), StorageState::empty);
  EXPECT_EQ(storage.size(), 0u);
  EXPECT_EQ(stored_acceleration(), 1000u);
}

TEST_F(FileStorageTest, KeepsTheValuesOfAnotherProcess) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    FileStorage storage{path.string()};
    Device device{canopen::stored_in(storage)};
    device.ask("605 23 83 60 00 D0 07 00 00");
    ::_exit(device.ask(save_all) == saved_all ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(stored_acceleration(), 2000u);
}

TEST_F(FileStorageTest, ReplacesTheFileAsAWhole) {
  FileStorage storage{path.string()};
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(device.ask(save_all), saved_all);
  const std::ifstream before{path, std::ios::binary};  // keeps the old file open
  device.ask("605 23 83 60 00 D0 07 00 00");
  EXPECT_EQ(device.ask(save_all), saved_all);
  EXPECT_EQ(stored_acceleration(), 2000u);
  std::ostringstream old_bytes;
  old_bytes << before.rdbuf();
  std::ofstream{folder / "old", std::ios::binary} << old_bytes.str();
  FileStorage old{(folder / "old").string()};
  EXPECT_EQ(old.open(), StorageState::whole) << "the old file was not written into";
  EXPECT_EQ(std::distance(fs::directory_iterator{folder}, {}), 2) << "nothing else is left";
}

TEST_F(FileStorageTest, KeepsTheOldFileWhenTheNewOneCannotBeWritten) {
  FileStorage storage{path.string()};
  Device device{canopen::stored_in(storage)};
  device.ask("605 23 83 60 00 D0 07 00 00");
  EXPECT_EQ(device.ask(save_all), saved_all);
  device.ask("605 23 83 60 00 01 00 00 00");
  fs::create_directory(path.string() + ".new");
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 00 00 06 06");
  EXPECT_EQ(storage.error(), std::errc::is_a_directory);
  EXPECT_EQ(stored_acceleration(), 2000u);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 2000u);
}

TEST_F(FileStorageTest, PassesOverANewFileThatWasNeverFinished) {
  FileStorage storage{path.string()};
  Device device{canopen::stored_in(storage)};
  device.ask("605 23 83 60 00 D0 07 00 00");
  EXPECT_EQ(device.ask(save_all), saved_all);
  std::ofstream{path.string() + ".new", std::ios::binary} << "EDSP";
  EXPECT_EQ(stored_acceleration(), 2000u);
  EXPECT_EQ(device.ask(save_all), saved_all);
  EXPECT_FALSE(fs::exists(path.string() + ".new"));
}

TEST_F(FileStorageTest, TellsThatTheFileIsDamaged) {
  {
    FileStorage storage{path.string()};
    Device device{canopen::stored_in(storage)};
    EXPECT_EQ(device.ask(save_all), saved_all);
  }
  for (const std::uintmax_t size : {fs::file_size(path) - 1, std::uintmax_t{5}, std::uintmax_t{0}}) {
    fs::resize_file(path, size);
    FileStorage storage{path.string()};
    EXPECT_EQ(storage.open(), StorageState::damaged) << size;
    EXPECT_EQ(storage.size(), 0u);
    EXPECT_FALSE(storage.error());
  }
}

TEST_F(FileStorageTest, TellsWhyTheFileCannotBeRead) {
  fs::create_directory(path);
  FileStorage storage{path.string()};
  EXPECT_EQ(storage.open(), StorageState::damaged);
  EXPECT_EQ(storage.error(), std::errc::is_a_directory);
}

}  // namespace

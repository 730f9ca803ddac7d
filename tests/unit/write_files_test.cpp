#include "render/write_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
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

  /// Paths of all files below the folder.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator{folder_}) {
      if (entry.is_regular_file()) result.push_back(fs::relative(entry.path(), folder_).string());
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

TEST_F(WriteFiles, ChangesNothingWhenTheDiskTakesNoMore) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  ASSERT_EQ(write_files({{path("one.hpp"), "before"}}), "");
  fs::create_symlink("/dev/full", path("two.hpp.edsc-tmp"));
  const std::string problem = write_files({{path("one.hpp"), "after"}, {path("two.hpp"), "2"}});
  EXPECT_NE(problem.find("two.hpp"), std::string::npos) << problem;
  EXPECT_EQ(content_of(path("one.hpp")), "before");
}

}  // namespace
}  // namespace edsc

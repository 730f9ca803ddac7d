#include "system/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace edsc {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsNewPrivateAndRemovedWithItsFiles) {
  fs::path path;
  {
    const TemporaryFolder one{"edsc-test-"};
    const TemporaryFolder other{"edsc-test-"};
    path = one.path();
    EXPECT_NE(one.path(), other.path());
    EXPECT_TRUE(path.filename().string().starts_with("edsc-test-"));
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
    fs::create_directory(path / "folder");
    std::ofstream{path / "folder" / "file"} << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace edsc

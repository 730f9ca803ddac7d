#include "system/find_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "system/temporary_folder.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> wanted{".eds", ".dcf"};

class FindFiles : public testing::Test {
 protected:
  void make(const std::string& name) const {
    const fs::path path = fs::path{folder_.path()} / name;
    fs::create_directories(path.parent_path());
    std::ofstream{path} << "text";
  }

  /// Relative to the folder.
  [[nodiscard]] std::vector<std::string> found(Subfolders subfolders = Subfolders::searched) const {
    std::vector<std::string> names;
    for (const std::string& path : find_files(folder_.path(), wanted, subfolders).paths) {
      names.push_back(fs::path{path}.lexically_relative(folder_.path()).generic_string());
    }
    return names;
  }

  TemporaryFolder folder_{"edsc-test-"};
};

TEST_F(FindFiles, OfAnExtensionInSubfoldersAscending) {
  for (const char* const name : {"b.EDS", "a/z.dcf", "a/b/c.eds", "a.txt", "eds", "c.eds.bak"}) make(name);
  EXPECT_EQ(found(), (std::vector<std::string>{"a/b/c.eds", "a/z.dcf", "b.EDS"}));
  EXPECT_EQ(found(Subfolders::left_out), (std::vector<std::string>{"b.EDS"}));
}

TEST_F(FindFiles, NotInHiddenFoldersNorThroughLinksToFolders) {
  for (const char* const name : {".git/a.eds", "real/b.eds", ".c.eds"}) make(name);
  fs::create_directory_symlink(folder_.path(), fs::path{folder_.path()} / "real" / "around");
  fs::create_symlink("b.eds", fs::path{folder_.path()} / "real" / "link.eds");
  fs::create_directory(fs::path{folder_.path()} / "folder.eds");
  EXPECT_EQ(found(), (std::vector<std::string>{".c.eds", "real/b.eds", "real/link.eds"}));
}

TEST_F(FindFiles, NamesFoldersThatCannotBeRead) {
  make("a.eds");
  EXPECT_EQ(find_files(folder_.path() + "/missing", wanted).problems,
            (std::vector<std::string>{folder_.path() + "/missing: No such file or directory"}));
  make("denied/b.eds");
  fs::permissions(folder_.path(), fs::perms{0755});
  fs::permissions(fs::path{folder_.path()} / "denied", fs::perms::none);
  constexpr uid_t nobody = 65534;
  const bool is_root = geteuid() == 0;  // who can read all folders
  if (is_root) ASSERT_EQ(seteuid(nobody), 0);
  const FoundFiles files = find_files(folder_.path(), wanted);
  if (is_root) ASSERT_EQ(seteuid(0), 0);
  fs::permissions(fs::path{folder_.path()} / "denied", fs::perms::owner_all);
  EXPECT_EQ(files.paths.size(), 1U);
  EXPECT_EQ(files.problems, (std::vector<std::string>{folder_.path() + "/denied: Permission denied"}));
}

}  // namespace
}  // namespace edsc

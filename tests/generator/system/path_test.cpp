#include "system/path.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "system/temporary_folder.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

struct Row {
  std::string_view path, name, stem;
};

TEST(Path, NameWithoutFoldersForBothSeparators) {
  const std::vector<Row> rows{
      {"drive.eds", "drive.eds", "drive"},
      {"machine/drive.eds", "drive.eds", "drive"},
      {"/machine/axis.1/drive.v2.eds", "drive.v2.eds", "drive.v2"},
      {R"(C:\Machine\drive.eds)", "drive.eds", "drive"},
      {R"(..\machine/axis\drive.eds)", "drive.eds", "drive"},
      {R"(\\server\share\drive.eds)", "drive.eds", "drive"},
      {"C:drive.eds", "drive.eds", "drive"},
      {"c:/drive.eds", "drive.eds", "drive"},
      {"HEAD:eds/drive.eds", "drive.eds", "drive"},
      {"HEAD:drive.eds", "HEAD:drive.eds", "HEAD:drive"},
      {"1:drive.eds", "1:drive.eds", "1:drive"},
      {"C:\\Anlage\\Ger\xC3\xA4te\\\xC3\x9C"
       "berwachung.eds",
       "\xC3\x9C"
       "berwachung.eds",
       "\xC3\x9C"
       "berwachung"},
      {"\xE8\xA1\xA8.eds", "\xE8\xA1\xA8.eds", "\xE8\xA1\xA8"},  // in Shift-JIS, its last byte is a backslash
      {"drive", "drive", "drive"},
      {"axis.1/drive", "drive", "drive"},
      {"drive.", "drive.", "drive"},
      {".eds", ".eds", ".eds"},
      {"..", "..", ".."},
      {".", ".", "."},
      {"machine/", "", ""},
      {"C:", "", ""},
      {"", "", ""},
      {"-", "-", "-"},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(file_name_of(row.path), row.name) << row.path;
    EXPECT_EQ(stem_of(row.path), row.stem) << row.path;
  }
}

TEST(Path, NameIsThatOfTheFileSystem) {
  for (const std::string path :
       {"a", "a/b.c", "/a/b.c.d", "a/", "/", "", ".", "..", ".a", ".a.b", "a.", "a..", "..a", "-"}) {
    EXPECT_EQ(file_name_of(path), fs::path{path}.filename().string()) << path;
    EXPECT_EQ(stem_of(path), fs::path{path}.stem().string()) << path;
  }
}

/// `path::u8string()` of Windows has backslashes.
TEST(Path, HasSlashesForEachSeparator) {
  EXPECT_EQ(with_slashes(u8"C:\\Anlage\\Ger\u00E4t.eds", '\\'), "C:/Anlage/Ger\xC3\xA4t.eds");
  EXPECT_EQ(with_slashes(u8"\\\\server\\share/drive.eds", '\\'), "//server/share/drive.eds");
  EXPECT_EQ(with_slashes(u8"machine/a\\b.eds", '/'), "machine/a\\b.eds") << "a name on Linux";
}

/// The examples of RFC 8089, appendices E.2 and E.3, and of RFC 3986.
TEST(Path, AsAUri) {
  EXPECT_EQ(uri_of_path("/path/to/a file.eds", '/'), "file:///path/to/a%20file.eds");
  EXPECT_EQ(uri_of_path("machine/Ger\xC3\xA4t#1.eds", '/'), "machine/Ger%C3%A4t%231.eds");
  EXPECT_EQ(uri_of_path("c:/path/to/file", '/'), "c%3A/path/to/file") << "a folder on Linux";
  EXPECT_EQ(uri_of_path("c:/path/to/file", '\\'), "file:///c:/path/to/file");
  EXPECT_EQ(uri_of_path("//host.example.com/Share/a b.txt", '\\'), "file://host.example.com/Share/a%20b.txt");
  EXPECT_EQ(uri_of_path("/path/to/file", '\\'), "file:///path/to/file");
  EXPECT_EQ(uri_of_path("machine/drive.eds", '\\'), "machine/drive.eds");
}

TEST(Path, KeepsItsTextFromAndToTheFileSystem) {
  const std::string texts[] = {
      "",       "a//b/./c/..",   "/a/", "-", "Ger\xC3\xA4t.eds", "\xE8\xA1\xA8/\xF0\x9F\x94\xA7.eds", "\xE4 not UTF-8",
      "a b\tc", "//server/share"};
  for (const std::string& text : texts) EXPECT_EQ(from_native(to_native(text)), text);
}

TEST(Path, OfAFileInUtf8) {
  const TemporaryFolder folder{"edsc-test-"};
  const std::string path = join_path(folder.path(), "\xC3\x9C.eds");
  std::ofstream{to_native(path)} << "text";
  EXPECT_TRUE(fs::exists(to_native(path)));
  const fs::directory_iterator first{to_native(folder.path())};
  EXPECT_EQ(from_native(first->path()), path);
}

TEST(Path, IsJoined) {
  EXPECT_EQ(join_path("machine", "drive.eds"), "machine/drive.eds");
  EXPECT_EQ(join_path("machine/", "drive.eds"), "machine/drive.eds");
  EXPECT_EQ(join_path("", "drive.eds"), "drive.eds");
  EXPECT_EQ(join_path("machine", "/drive.eds"), "/drive.eds");
  EXPECT_EQ(join_path("machine", "../drive.eds"), "machine/../drive.eds");
}

}  // namespace
}  // namespace edsc

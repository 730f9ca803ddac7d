#include "system/input_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "system/temporary_folder.hpp"

namespace edsc {
namespace {

TEST(InputFile, IsReadToItsEnd) {
  const TemporaryFolder folder{"edsc-test-"};
  const std::string path = folder.path() + "/input";
  std::ofstream{path} << "seven bytes";
  const InputFile file{path};
  ASSERT_EQ(file.error(), "");
  const WaitingSignals no_signals({}, WaitingSignals::Second::is_recorded);
  std::array<char, 7> some;
  EXPECT_EQ(file.read_some(some.data(), some.size(), no_signals), 7);
  EXPECT_EQ(std::string(some.data(), 7), "seven b");
  EXPECT_EQ(file.read_some(some.data(), some.size(), no_signals), 4);
  EXPECT_EQ(file.read_some(some.data(), some.size(), no_signals), 0);
}

TEST(InputFile, ReportsWhyItCannotBeOpened) {
  const TemporaryFolder folder{"edsc-test-"};
  EXPECT_EQ(InputFile{folder.path() + "/missing"}.error(), "No such file or directory");
  EXPECT_EQ(InputFile{folder.path()}.error(), "Is a directory");
  EXPECT_EQ(InputFile{"/dev/zero"}.error(), "is a device; expected a file");
}

}  // namespace
}  // namespace edsc

#include "system/gzip.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edsc {
namespace {

constexpr std::size_t most = 1'000'000;

std::string unpacked(std::string_view file) {
  std::string content;
  EXPECT_EQ(gunzip(file, most, content), "");
  return content;
}

TEST(Gzip, GivesBackWhatItPacks) {
  std::string text = "[FileInfo]\r\nFileName=drive.eds\r\n";
  EXPECT_EQ(unpacked(gzip(text)), text);
  EXPECT_EQ(unpacked(gzip("")), "");
  while (text.size() < 200'000) text += text;
  EXPECT_LT(gzip(text).size(), text.size() / 20);
  EXPECT_EQ(unpacked(gzip(text)), text);
}

TEST(Gzip, NamesNeitherTimeNorSystem) {
  const std::string file = gzip("text");
  EXPECT_TRUE(is_gzip(file));
  EXPECT_EQ(file.substr(3, 5), std::string(5, '\0'));
  EXPECT_EQ(file[9], '\xFF');
  EXPECT_FALSE(is_gzip("[FileInfo]"));
}

TEST(Gzip, RefusesAFileThatIsCutOffDamagedOrLonger) {
  const std::string file = gzip("[1000]\nParameterName=Device type\n");
  std::string content;
  for (std::size_t size = 2; size < file.size(); ++size) {
    EXPECT_EQ(gunzip(std::string_view{file}.substr(0, size), most, content), "not a complete gzip file") << size;
  }
  std::string damaged = file;
  damaged[file.size() - 6] ^= 1;
  EXPECT_EQ(gunzip(damaged, most, content), "not a complete gzip file");
  EXPECT_EQ(gunzip(file + "x", most, content), "not a complete gzip file");
}

TEST(Gzip, UnpacksNoMoreThanItMay) {
  const std::string file = gzip(std::string(2 * most, ' '));
  std::string content;
  const std::string problem = gunzip(file, most, content);
  EXPECT_TRUE(problem.starts_with("unpacks to more than 1000000 bytes; stopped at byte ")) << problem;
  EXPECT_TRUE(problem.ends_with(" of " + std::to_string(file.size()))) << problem;
  EXPECT_LT(content.size(), most + most / 2);
}

TEST(Gzip, RefusesWhatIsMadeToFillTheMemory) {
  const std::string file = gzip(std::string(20 * most, ' '));
  std::string content;
  const std::string problem = gunzip(file, 1000 * most, content);
  EXPECT_TRUE(problem.starts_with("unpacks to more than 200 times its size; stopped at byte ")) << problem;
  EXPECT_LT(content.size(), 2 * most);
}

TEST(Gzip, UnpacksAFileOfManyEqualObjects) {
  std::string text;
  for (int i = 0; text.size() < 3 * most; ++i) {
    text +=
        "[" + std::to_string(2000 + i) + "]\nParameterName=Object\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n\n";
  }
  std::string content;
  EXPECT_EQ(gunzip(gzip(text), 4 * most, content), "");
  EXPECT_EQ(content, text);
}

}  // namespace
}  // namespace edsc

#include "text/source_file.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "system/gzip.hpp"

namespace edsc {
namespace {

using std::string_literals::operator""s;

TEST(SourceFile, KeepsAsciiAsItIs) {
  const SourceFile file("a.eds", "[1000]\n");
  EXPECT_EQ(file.encoding(), Encoding::ascii);
  EXPECT_EQ(file.text(), "[1000]\n");
  EXPECT_EQ(file.name(), "a.eds");
}

TEST(SourceFile, TakesValidUtf8ForUtf8) {
  const SourceFile file("a.eds", "Maß €\n");
  EXPECT_EQ(file.encoding(), Encoding::utf8);
  EXPECT_EQ(file.text(), "Maß €\n");
}

TEST(SourceFile, DropsAUtf8ByteOrderMark) {
  const SourceFile file("a.eds", "\xEF\xBB\xBF[1000]\n");
  EXPECT_EQ(file.encoding(), Encoding::utf8);
  EXPECT_EQ(file.text(), "[1000]\n");
}

TEST(SourceFile, ReadsUtf16WithAByteOrderMark) {
  const SourceFile little("a.eds", "\xFF\xFE\x61\x00\xE4\x00\x3D\xD8\x00\xDE"s);
  EXPECT_EQ(little.encoding(), Encoding::utf16_le);
  EXPECT_EQ(little.text(), "aä😀");
  const SourceFile big("a.eds", "\xFE\xFF\x00\x61\x00\xE4\xD8\x3D\xDE\x00"s);
  EXPECT_EQ(big.encoding(), Encoding::utf16_be);
  EXPECT_EQ(big.text(), "aä😀");
}

TEST(SourceFile, KnowsUtf16ByItsNulBytes) {
  const SourceFile little("a.eds", "[\0A\0]\0"s);
  EXPECT_EQ(little.encoding(), Encoding::utf16_le);
  EXPECT_EQ(little.text(), "[A]");
  const SourceFile big("a.eds", "\0[\0A\0]"s);
  EXPECT_EQ(big.encoding(), Encoding::utf16_be);
  EXPECT_EQ(big.text(), "[A]");
}

TEST(SourceFile, ReplacesWhatUtf16DoesNotDefine) {
  EXPECT_EQ(SourceFile("a.eds", "\xFF\xFE\x3D\xD8\x61\x00"s).text(), "\uFFFDa");
  EXPECT_EQ(SourceFile("a.eds", "\xFF\xFE\x00\xDE\x61\x00"s).text(), "\uFFFDa");
  EXPECT_EQ(SourceFile("a.eds", "\xFF\xFE\x61\x00\x62"s).text(), "a\uFFFD");
}

TEST(SourceFile, LeavesSingleNulBytes) {
  const SourceFile file("a.eds", "ab\0c"s);
  EXPECT_EQ(file.encoding(), Encoding::ascii);
  EXPECT_EQ(file.text(), "ab\0c"s);
}

struct CodePageCase {
  const char* bytes;
  Encoding encoding;
  const char* text;
};

class CodePages : public testing::TestWithParam<CodePageCase> {};

TEST_P(CodePages, AreToldApartByTheLettersOfWords) {
  const SourceFile file("a.eds", GetParam().bytes);
  EXPECT_EQ(to_string(file.encoding()), to_string(GetParam().encoding));
  EXPECT_EQ(file.text(), GetParam().text);
}

INSTANTIATE_TEST_SUITE_P(Texts, CodePages,
                         testing::Values(CodePageCase{"W\x81rzburg", Encoding::cp437, "Würzburg"},
                                         CodePageCase{"L\x84nge", Encoding::cp437, "Länge"},
                                         CodePageCase{"Gr\x94\xE1"
                                                      "e",
                                                      Encoding::cp437, "Größe"},
                                         CodePageCase{"\x99l", Encoding::cp437, "Öl"},
                                         CodePageCase{"Temperatur [\xF8"
                                                      "C]",
                                                      Encoding::cp437, "Temperatur [°C]"},
                                         CodePageCase{";\xC4\xC4\xC4", Encoding::cp437, ";───"},
                                         CodePageCase{"L\xE4nge", Encoding::cp1252, "Länge"},
                                         CodePageCase{"Gr\xF6\xDF"
                                                      "e",
                                                      Encoding::cp1252, "Größe"},
                                         CodePageCase{"Temperature [\xB0"
                                                      "C]",
                                                      Encoding::cp1252, "Temperature [°C]"},
                                         CodePageCase{"acceleration [m/s\xB2]", Encoding::cp1252,
                                                      "acceleration [m/s²]"},
                                         CodePageCase{"the drive\x92s limit", Encoding::cp1252, "the drive’s limit"},
                                         CodePageCase{"\x93quoted\x94", Encoding::cp1252, "“quoted”"},
                                         CodePageCase{"Drive\x99", Encoding::cp1252, "Drive™"}));

TEST(SourceFile, DoesNotGuessUndefinedBytes) {
  const SourceFile file("a.eds", "Name=\x83\x82\x81\x5B\x83\x5E\nValue=1\n");
  EXPECT_EQ(file.encoding(), Encoding::unknown);
  EXPECT_TRUE(file.is_encoding_guessed());
  EXPECT_EQ(file.undefined_place(), 5U);
  EXPECT_EQ(file.line(2), "Value=1");
  EXPECT_EQ(undefined_bytes_text(file),
            "bytes 83h 82h 81h are not ASCII, and the encoding is not known; the text is valid Shift-JIS");
}

TEST(SourceFile, IsReadAsThePersonSays) {
  const SourceFile file("a.eds", "\x83\x82\x81\x5B\x83\x5E", Packing::none, {.encoding = Encoding::shift_jis});
  EXPECT_EQ(file.encoding(), Encoding::shift_jis);
  EXPECT_FALSE(file.is_encoding_guessed());
  EXPECT_EQ(file.text(), "モータ");
  EXPECT_TRUE(file.undefined_bytes().empty());
}

TEST(SourceFile, ReportsBytesThatTheChosenEncodingDoesNotDefine) {
  const SourceFile file("a.eds", "a\x81\x30", Packing::none, {.encoding = Encoding::cp1252});
  EXPECT_EQ(file.text(), "a\uFFFD0");
  EXPECT_EQ(undefined_bytes_text(file), "bytes 81h are not defined in CP1252; the text is valid CP437 and CP1251");
}

TEST(SourceFile, HasAByteOrderMarkThatIsStrongerThanAChoice) {
  const SourceFile file("a.eds", "\xEF\xBB\xBFä", Packing::none, {.encoding = Encoding::gb18030});
  EXPECT_EQ(file.encoding(), Encoding::utf8);
  EXPECT_EQ(file.text(), "ä");
}

TEST(SourceFile, KnowsAllLineEnds) {
  const SourceFile file("a.eds", "lf\ncr lf\r\ncr\r\rlast");
  ASSERT_EQ(file.lines(), 5U);
  EXPECT_EQ(file.line(1), "lf");
  EXPECT_EQ(file.line(2), "cr lf");
  EXPECT_EQ(file.line(3), "cr");
  EXPECT_EQ(file.line(4), "");
  EXPECT_EQ(file.line(5), "last");
}

TEST(SourceFile, CountsNoLineAfterTheLastLineEnd) {
  EXPECT_EQ(SourceFile("a.eds", "one\r\n").lines(), 1U);
  EXPECT_EQ(SourceFile("a.eds", "one\r\n\r\n").lines(), 2U);
  EXPECT_EQ(SourceFile("a.eds", "").lines(), 0U);
}

TEST(SourceFile, GivesAnEmptyLineWhereThereIsNone) {
  const SourceFile file("a.eds", "one\n");
  EXPECT_EQ(file.line(0), "");
  EXPECT_EQ(file.line(2), "");
}

class ReadSourceFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("edsc_source_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

TEST_F(ReadSourceFile, ReadsAllBytes) {
  const std::string content(200'000, 'x');
  std::ofstream(path("a.eds"), std::ios::binary) << content << "\r\nend";
  std::string error;
  const auto file = read_source_file(path("a.eds"), error);
  ASSERT_NE(file, nullptr) << error;
  EXPECT_EQ(file->text(), content + "\r\nend");
  EXPECT_EQ(file->name(), path("a.eds"));
}

TEST_F(ReadSourceFile, ReadsAnEmptyFile) {
  std::ofstream(path("a.eds"), std::ios::binary).flush();
  std::string error;
  const auto file = read_source_file(path("a.eds"), error);
  ASSERT_NE(file, nullptr) << error;
  EXPECT_EQ(file->text(), "");
}

TEST_F(ReadSourceFile, UnpacksAGzipFile) {
  std::ofstream(path("a.eds.gz"), std::ios::binary) << gzip("[1000]\r\n");
  std::string error;
  const auto file = read_source_file(path("a.eds.gz"), error);
  ASSERT_NE(file, nullptr) << error;
  EXPECT_EQ(file->text(), "[1000]\r\n");
  std::ofstream(path("cut.gz"), std::ios::binary) << gzip("[1000]\r\n").substr(0, 20);
  EXPECT_EQ(read_source_file(path("cut.gz"), error), nullptr);
  EXPECT_EQ(error, "cannot read " + path("cut.gz") + ": not a complete gzip file");
}

TEST_F(ReadSourceFile, SaysThatAFileIsMissing) {
  std::string error;
  EXPECT_EQ(read_source_file(path("none.eds"), error), nullptr);
  EXPECT_EQ(error, "cannot read " + path("none.eds") + ": No such file or directory");
}

TEST_F(ReadSourceFile, SaysThatAFolderIsNoFile) {
  std::string error;
  EXPECT_EQ(read_source_file(folder_.string(), error), nullptr);
  EXPECT_EQ(error, "cannot read " + folder_.string() + ": Is a directory");
}

TEST_F(ReadSourceFile, RefusesAFileOverOneGibibyte) {
  std::ofstream(path("large.eds"), std::ios::binary).flush();
  std::filesystem::resize_file(path("large.eds"), SourceFile::max_bytes + 1);  // sparse: takes no disk space
  std::string error;
  EXPECT_EQ(read_source_file(path("large.eds"), error), nullptr);
  EXPECT_EQ(error, "cannot read " + path("large.eds") + ": larger than 1 GiB");
}

}  // namespace
}  // namespace edsc

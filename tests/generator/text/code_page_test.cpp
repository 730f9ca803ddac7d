/// The code pages against iconv of this machine, for all bytes and code points.
#include "text/code_page.hpp"

#include <gtest/gtest.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "text/encoding.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

/// One text of the other implementation: all bytes at once, so that the two do not share how they split them.
std::string by_iconv(const char* encoding, std::string bytes) {
  const iconv_t handle = iconv_open("UTF-8", encoding);
  EXPECT_NE(reinterpret_cast<std::intptr_t>(handle), -1) << encoding;
  std::string text(bytes.size() * 4 + 16, '\0');
  char* from = bytes.data();
  std::size_t from_left = bytes.size();
  char* to = text.data();
  std::size_t to_left = text.size();
  const std::size_t result = iconv(handle, &from, &from_left, &to, &to_left);
  iconv(handle, nullptr, nullptr, &to, &to_left);
  iconv_close(handle);
  if (result == static_cast<std::size_t>(-1)) return {};
  text.resize(text.size() - to_left);
  return text;
}

/// All code points up to `last` that the encoding has, in its bytes.
std::string all_of(const char* encoding, char32_t last) {
  const iconv_t handle = iconv_open(encoding, "UTF-8");
  std::string bytes;
  for (char32_t one = 0x20; one <= last; ++one) {
    if (one >= 0xD800 && one <= 0xDFFF) continue;
    std::string text;
    append_utf8(text, one);
    std::array<char, 16> out{};
    char* from = text.data();
    std::size_t from_left = text.size();
    char* to = out.data();
    std::size_t to_left = out.size();
    iconv(handle, nullptr, nullptr, nullptr, nullptr);
    if (iconv(handle, &from, &from_left, &to, &to_left) == 0) bytes.append(out.data(), out.size() - to_left);
  }
  iconv_close(handle);
  return bytes;
}

struct NamedPage {
  Encoding encoding;
  const char* name;      ///< of iconv
  std::size_t at_least;  ///< bytes of all its code points
};

constexpr NamedPage named_pages[] = {
    {Encoding::cp1252, "CP1252", 200},       {Encoding::cp437, "CP437", 200},   {Encoding::cp850, "CP850", 200},
    {Encoding::cp1250, "CP1250", 200},       {Encoding::cp1251, "CP1251", 200}, {Encoding::shift_jis, "CP932", 14'000},
    {Encoding::gb18030, "GB18030", 200'000}, {Encoding::big5, "BIG5", 26'000},  {Encoding::cp949, "CP949", 30'000},
};

TEST(CodePage, DecodesEachCodePointOfItsEncodingAsIconv) {
  for (const NamedPage& page : named_pages) {
    const std::string bytes = all_of(page.name, 0x10FFFF);
    EXPECT_GT(bytes.size(), page.at_least) << page.name;
    const DecodedText decoded = decode_text(bytes, page.encoding);
    EXPECT_TRUE(decoded.is_valid()) << page.name;
    EXPECT_TRUE(decoded.text == by_iconv(page.name, bytes)) << page.name;
  }
}

/// Also the codes that iconv does not write, such as the second ones of IBM's characters in Shift-JIS.
TEST(CodePage, DecodesOneAndTwoBytesAsIconv) {
  for (const NamedPage& page : named_pages) {
    int valid = 0;
    for (unsigned first = 0x20; first <= 0xFF; ++first) {
      for (unsigned second = 0x20; second <= 0xFF; ++second) {
        const std::string bytes{static_cast<char>(first), static_cast<char>(second)};
        const DecodedText decoded = decode_text(bytes, page.encoding);
        const std::string expected = by_iconv(page.name, bytes);
        ASSERT_EQ(decoded.is_valid(), !expected.empty()) << page.name << " " << first << " " << second;
        if (!expected.empty()) {
          ASSERT_EQ(decoded.text, expected) << page.name << " " << first << " " << second;
        }
        valid += expected.empty() ? 0 : 1;
      }
    }
    EXPECT_GT(valid, 9'000) << page.name;
  }
}

TEST(CodePage, ReportsTheFirstUndefinedByte) {
  const DecodedText decoded = decode_text("a\xC3\xA4\x81\x30", Encoding::shift_jis);
  EXPECT_EQ(decoded.undefined, 3U);
  EXPECT_EQ(decoded.text, "aﾃ､\uFFFD0");
  EXPECT_EQ(decoded.undefined_text, std::string{"aﾃ､"}.size());
  EXPECT_EQ(decode_text("\xE4", Encoding::unknown).text, "\uFFFD");
  EXPECT_EQ(decode_text("\xE4", Encoding::utf8).undefined, 0U);
}

TEST(CodePage, DoesNotTakeAnAsianTextForAWesternOne) {
  struct Text {
    std::string_view bytes;
    Encoding encoding;
  };
  constexpr Text texts[] = {
      {"\xB5\xE7\xBB\xFA\xB5\xE7\xC1\xF7", Encoding::gb18030},            // motor current
      {"\x83\x82\x81\x5B\x83\x5E\x93\x64\x97\xAC", Encoding::shift_jis},  // the same in Japanese
      {"\xB9\x71\xB0\xCA\xBE\xF7", Encoding::big5},                       // motor in traditional Chinese
      {"\xB8\xF0\xC5\xCD \xC0\xFC\xB7\xF9", Encoding::cp949},             // in Korean
  };
  for (const Text& one : texts) {
    EXPECT_EQ(detect_code_page(one.bytes), Encoding::unknown) << to_string(one.encoding);
    const auto possible = possible_encodings(one.bytes);
    EXPECT_NE(std::find(possible.begin(), possible.end(), one.encoding), possible.end()) << to_string(one.encoding);
  }
}

TEST(Encoding, HasAliases) {
  EXPECT_EQ(find_encoding("shift_jis"), Encoding::shift_jis);
  EXPECT_EQ(find_encoding("SJIS"), Encoding::shift_jis);
  EXPECT_EQ(find_encoding("GBK"), Encoding::gb18030);
  EXPECT_EQ(find_encoding("Windows-1252"), Encoding::cp1252);
  EXPECT_EQ(find_encoding("utf8"), Encoding::utf8);
  EXPECT_EQ(find_encoding("ASCII"), std::nullopt);
  EXPECT_EQ(find_encoding(""), std::nullopt);
}

}  // namespace
}  // namespace edsc

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "text/counted.hpp"
#include "text/suggestion.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

TEST(Counted, PutsOneInTheSingular) {
  EXPECT_EQ(counted(0, "line"), "0 lines");
  EXPECT_EQ(counted(1U, "line"), "1 line");
  EXPECT_EQ(counted(std::uint64_t{2}, "line"), "2 lines");
  EXPECT_EQ(counted(1, "entry", "entries"), "1 entry");
  EXPECT_EQ(counted(2, "entry", "entries"), "2 entries");
}

constexpr std::array<std::string_view, 5> words{"check", "AccessType", "HighLimit", "LowLimit", "bus"};

TEST(Suggestion, IsTheWordWithTheFewestDifferences) {
  EXPECT_EQ(most_similar("chek", words), "check");
  EXPECT_EQ(most_similar("AccesType", words), "AccessType");
  EXPECT_EQ(most_similar("accestype", words), "AccessType") << "letter case is ignored";
  EXPECT_EQ(most_similar("AccesssTyp", words), "AccessType") << "one too many, one too few";
  EXPECT_EQ(most_similar("AcecssType", words), "AccessType") << "two swapped";
  EXPECT_EQ(most_similar("ub", words), "") << "two characters may be anything";
  EXPECT_EQ(most_similar("bis", words), "bus");
}

TEST(Suggestion, IsNothingForAnotherWord) {
  EXPECT_EQ(most_similar("", words), "");
  EXPECT_EQ(most_similar("Unit", words), "");
  EXPECT_EQ(most_similar("scan", words), "");
  EXPECT_EQ(most_similar(std::string(100'000, 'x'), words), "");
  EXPECT_EQ(did_you_mean("Unit", words), "");
  EXPECT_EQ(did_you_mean("chek", words), "; did you mean \"check\"?");
}

TEST(EditDistance, CountsCharactersThatDiffer) {
  EXPECT_EQ(edit_distance("speed", "speed", 2), 0U);
  EXPECT_EQ(edit_distance("Speed", "sped", 2), 1U);
  EXPECT_EQ(edit_distance("speed", "spede", 2), 1U) << "two characters swapped";
  EXPECT_EQ(edit_distance("speed", "torque", 2), 3U) << "more than 2";
  EXPECT_EQ(edit_distance("", "ab", 2), 2U);
}

TEST(Utf16, IsTheSameTextInBothDirections) {
  const std::string text = "a\u00B5\U0001F600";
  EXPECT_EQ(to_utf16_bytes(text), std::string("a\0\xB5\0\x3D\xD8\0\xDE", 8));
  EXPECT_EQ(from_utf16_bytes(to_utf16_bytes(text), ByteOrder::low_first), text);
  EXPECT_EQ(from_utf16_bytes(std::string("\0a", 2), ByteOrder::high_first), "a");
}

TEST(Utf16, OfHalfACharacterIsTheReplacementCharacter) {
  EXPECT_EQ(from_utf16_bytes(std::string("\x3D\xD8"
                                         "a\0",
                                         4),
                             ByteOrder::low_first),
            "\uFFFDa");
  EXPECT_EQ(from_utf16_bytes(std::string("a\0b", 3), ByteOrder::low_first), "a\uFFFD");
}

}  // namespace
}  // namespace edsc

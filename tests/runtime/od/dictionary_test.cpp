#include <gtest/gtest.h>
#include <canopen/od/dictionary.hpp>

#include <cstdint>
#include <sample/dictionary.hpp>
#include <set>
#include <vector>

namespace {

namespace entry = canopen::entry;
using canopen::Dictionary;

TEST(Dictionary, FindsVariablesArraysAndRecords) {
  EXPECT_EQ(entry::type_of(sample::dictionary.find(0x1000, 0)), entry::u32);
  EXPECT_EQ(entry::type_of(sample::dictionary.find(0x2013, 3)), entry::i16);
  EXPECT_EQ(entry::type_of(sample::dictionary.find(0x1800, 5)), entry::u16);
  EXPECT_EQ(entry::type_of(sample::dictionary.find(0x6083, 0)), entry::u32);
}

TEST(Dictionary, TellsAMissingObjectFromAMissingSubIndex) {
  EXPECT_EQ(sample::dictionary.find(0x0FFF, 0), Dictionary::no_object);
  EXPECT_EQ(sample::dictionary.find(0x1002, 0), Dictionary::no_object);
  EXPECT_EQ(sample::dictionary.find(0x6084, 0), Dictionary::no_object);
  EXPECT_EQ(sample::dictionary.find(0xFFFF, 0), Dictionary::no_object);
  EXPECT_EQ(sample::dictionary.find(0x1000, 1), Dictionary::no_sub_index);
  EXPECT_EQ(sample::dictionary.find(0x2013, 4), Dictionary::no_sub_index);
  EXPECT_EQ(sample::dictionary.find(0x1800, 4), Dictionary::no_sub_index);
  EXPECT_EQ(sample::dictionary.find(0x1800, 6), Dictionary::no_sub_index);
  EXPECT_EQ(sample::dictionary.find(0x1018, 255), Dictionary::no_sub_index);
}

TEST(Dictionary, TheElementsOfAnArrayStandOneBehindTheOther) {
  const auto first = entry::offset_of(sample::dictionary.find(0x2013, 1));
  EXPECT_EQ(entry::offset_of(sample::dictionary.find(0x2013, 2)), first + 2);
  EXPECT_EQ(entry::offset_of(sample::dictionary.find(0x2013, 3)), first + 4);
}

TEST(Dictionary, SubIndexZeroIsTheHighestSubIndex) {
  const entry::Word word = sample::dictionary.find(0x1018, 0);
  EXPECT_EQ(entry::place_of(word), entry::Place::immediate);
  EXPECT_EQ(entry::offset_of(word), 4);
}

TEST(Dictionary, KnowsTheRights) {
  EXPECT_EQ(sample::dictionary.find(0x2014, 0) & entry::readable, 0u);  // wo
  EXPECT_EQ(sample::dictionary.find(0x6041, 0) & entry::writable, 0u);  // ro
  EXPECT_NE(sample::dictionary.find(0x6040, 0) & entry::rpdo, 0u);
  EXPECT_NE(sample::dictionary.find(0x6041, 0) & entry::tpdo, 0u);
}

TEST(Dictionary, EveryEntryIsFoundWhereTheTablesHaveIt) {
  std::size_t found = 0;
  for (std::uint32_t index = 0; index <= 0xFFFF; ++index) {
    if (sample::dictionary.find_index(static_cast<std::uint16_t>(index)) != Dictionary::no_object) ++found;
  }
  EXPECT_EQ(found, sample::dictionary.entries.size());
}

/// The addresses in a range of indices at which an entry is found.
std::vector<std::uint32_t> found_in(std::uint32_t first, std::uint32_t last) {
  std::vector<std::uint32_t> keys;
  for (std::uint32_t key = first << 8; key <= (last << 8 | 0xFF); ++key) {
    if (sample::dictionary.has(static_cast<std::uint16_t>(key >> 8), static_cast<std::uint8_t>(key)))
      keys.push_back(key);
  }
  return keys;
}

TEST(Dictionary, VisitsTheCommunicationProfileOnly) {
  std::vector<std::uint32_t> visited;
  sample::dictionary.for_each_communication_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
    visited.push_back(canopen::object_key(index, sub_index));
    EXPECT_EQ(word, sample::dictionary.find(index, sub_index));
  });
  EXPECT_FALSE(visited.empty());
  EXPECT_EQ(visited, found_in(0, 0x1FFF));
}

TEST(Dictionary, AnyOfEntriesFindsEachEntry) {
  const std::vector<std::uint32_t> keys = found_in(0, 0xFFFF);
  EXPECT_FALSE(sample::dictionary.any_of_entries([](entry::Word) { return false; }));
  for (const std::uint32_t key : keys) {
    const entry::Word word =
        sample::dictionary.find(static_cast<std::uint16_t>(key >> 8), static_cast<std::uint8_t>(key));
    EXPECT_TRUE(sample::dictionary.any_of_entries([&](entry::Word other) { return other == word; })) << key;
  }
}

TEST(Dictionary, TheWordsOfTheTablesHaveTheTypesOfTheEntries) {
  const auto kind_of = [](entry::Word word) { return word & ~entry::offset_mask; };
  std::set<entry::Word> of_tables;
  sample::dictionary.for_each_word([&](entry::Word word) { of_tables.insert(kind_of(word)); });
  std::set<entry::Word> of_entries;
  for (const std::uint32_t key : found_in(0, 0xFFFF)) {
    of_entries.insert(
        kind_of(sample::dictionary.find(static_cast<std::uint16_t>(key >> 8), static_cast<std::uint8_t>(key))));
  }
  EXPECT_EQ(of_tables, of_entries);
}

TEST(Dictionary, RejectsRunsOutOfOrder) {
  static constexpr canopen::Run runs[] = {{0x2000, 0}, {0x1000, 1}, {0xFFFF, 2}};
  static constexpr entry::Word entries[] = {entry::immediate | entry::u8 | entry::ro,
                                            entry::immediate | entry::u8 | entry::ro};
  const Dictionary dictionary{.runs = runs,
                              .entries = entries,
                              .shapes = {},
                              .subs = {},
                              .limits = {},
                              .wide_limits = {},
                              .constants = nullptr};
  EXPECT_FALSE(dictionary.well_formed());
}

TEST(Dictionary, IsSearchedWhileTheProgramIsCompiled) {
  static_assert(sample::dictionary.has(0x1017, 0));
  static_assert(!sample::dictionary.has(0x1005, 0));
}

}  // namespace

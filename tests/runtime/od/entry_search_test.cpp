/// Each search at run time finds all entries of the tables and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen/od/entry_search.hpp>
#include <cstdint>
#include <sample/device.hpp>
#include <type_traits>

namespace {

using canopen::Dictionary;
using canopen::entry_search::ByHash;
using canopen::entry_search::ByRuns;

/// `Count` indices, at most `Spread` apart; with 1 they are contiguous.
template <std::size_t Count, std::uint32_t Spread>
struct Scattered {
  static constexpr std::array<std::uint16_t, Count> indices = [] {
    std::array<std::uint16_t, Count> made{};
    std::uint32_t random = 1;
    std::uint32_t index = 0x1000;
    for (std::uint16_t& next : made) {
      next = static_cast<std::uint16_t>(index);
      random = random * 1664525u + 1013904223u;
      index += 1 + (random >> 8) % Spread;
    }
    return made;
  }();

  static constexpr std::size_t run_count = [] {
    std::size_t runs = 1;
    for (std::size_t i = 1; i < Count; ++i) runs += indices[i] != indices[i - 1] + 1 ? 1 : 0;
    return runs;
  }();

  static constexpr std::array<canopen::Run, run_count + 1> runs = [] {
    std::array<canopen::Run, run_count + 1> made{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < Count; ++i) {
      if (i == 0 || indices[i] != indices[i - 1] + 1) made[at++] = {indices[i], static_cast<std::uint16_t>(i)};
    }
    made[at] = {0xFFFF, static_cast<std::uint16_t>(Count)};
    return made;
  }();

  static constexpr std::array<canopen::entry::Word, Count> entries = [] {
    std::array<canopen::entry::Word, Count> made{};
    canopen::entry::Word offset = 0;
    for (canopen::entry::Word& word : made)
      word = canopen::entry::ram | canopen::entry::u8 | canopen::entry::rw | offset++;
    return made;
  }();

  static constexpr Dictionary dictionary{.runs = runs,
                                         .entries = entries,
                                         .shapes = {},
                                         .subs = {},
                                         .limits = {},
                                         .wide_limits = {},
                                         .constants = nullptr};
  static_assert(dictionary.well_formed());
};

template <class Search, class Device>
void expect_all_found() {
  for (std::uint32_t index = 0; index <= 0xFFFF; ++index) {
    const auto narrow = static_cast<std::uint16_t>(index);
    ASSERT_EQ(Search::find(narrow), Device::dictionary.find_index(narrow)) << index;
  }
}

/// Checks each kind of search. A hash exists for each of these devices.
template <class Device>
void expect_found() {
  static_assert(ByHash<Device>::table.found);
  expect_all_found<ByRuns<Device>, Device>();
  expect_all_found<ByHash<Device>, Device>();
}

TEST(EntrySearch, FindsNeighbours) {
  expect_found<Scattered<1, 1>>();
  expect_found<Scattered<2, 1>>();
  expect_found<Scattered<64, 1>>();
  expect_found<Scattered<65, 1>>();
  expect_found<Scattered<220, 1>>();
}

TEST(EntrySearch, FindsScatteredIndices) {
  expect_found<Scattered<3, 200>>();
  expect_found<Scattered<17, 200>>();
  expect_found<Scattered<63, 200>>();
  expect_found<Scattered<100, 200>>();
  expect_found<Scattered<128, 200>>();
  expect_found<Scattered<129, 200>>();
  expect_found<Scattered<200, 200>>();
  expect_found<Scattered<220, 200>>();
}

TEST(EntrySearch, FindsIndicesInShortRuns) {
  expect_found<Scattered<30, 3>>();
  expect_found<Scattered<150, 3>>();
  expect_found<Scattered<220, 3>>();
}

TEST(EntrySearch, FindsManyIndices) {
  expect_found<Scattered<512, 40>>();
  expect_found<Scattered<1000, 1>>();
  expect_found<Scattered<1024, 40>>();
}

TEST(EntrySearch, FindsTheIndicesOfADataSheet) { expect_found<sample::Device>(); }

template <class Device, bool Fast>
constexpr bool hashed = std::is_same_v<canopen::EntrySearch<Device, Fast>, ByHash<Device>>;

TEST(EntrySearch, HashesWhereThatIsFasterOrSmaller) {
  EXPECT_TRUE((hashed<Scattered<100, 200>, true>));
  EXPECT_TRUE((hashed<Scattered<120, 200>, false>)) << "416 bytes of tables for a hash, 480 for runs";
  EXPECT_FALSE((hashed<Scattered<120, 3>, false>)) << "of neighbours there are fewer runs";
  EXPECT_FALSE((hashed<Scattered<200, 1>, true>)) << "a single run";
}

TEST(EntrySearch, LaysOutNoHashOfVeryManyIndices) {
  EXPECT_FALSE((hashed<Scattered<2000, 3>, true>));
  expect_all_found<canopen::EntrySearch<Scattered<2000, 3>>, Scattered<2000, 3>>();
}

}  // namespace

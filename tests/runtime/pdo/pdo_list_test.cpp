/// Lists of PDOs that are numbered from 1 without gaps, and others.
#include <gtest/gtest.h>
#include <canopen/pdo/pdo_list.hpp>

#include <cstdint>
#include <initializer_list>

namespace {

using canopen::number_of_pdo;
using canopen::NumberedPdo;
using canopen::PdoList;
using canopen::place_of_pdo;

struct Layout {};
using WithoutGaps = PdoList<NumberedPdo<1, Layout>, NumberedPdo<2, Layout>>;
using WithGaps = PdoList<NumberedPdo<2, Layout>, NumberedPdo<5, Layout>, NumberedPdo<512, Layout>>;

TEST(PdoList, FindsAPdoByTheIndexOfItsParameters) {
  for (const std::uint16_t first : std::initializer_list<std::uint16_t>{0x1400, 0x1600, 0x1800, 0x1A00}) {
    const auto index_of = [first](unsigned number) { return static_cast<std::uint16_t>(first + number - 1); };
    EXPECT_EQ(place_of_pdo<WithoutGaps>(index_of(1)), 0u);
    EXPECT_EQ(place_of_pdo<WithoutGaps>(index_of(2)), 1u);
    EXPECT_EQ(place_of_pdo<WithoutGaps>(index_of(3)), 2u) << "missing";
    EXPECT_EQ(place_of_pdo<WithGaps>(index_of(2)), 0u);
    EXPECT_EQ(place_of_pdo<WithGaps>(index_of(5)), 1u);
    EXPECT_EQ(place_of_pdo<WithGaps>(index_of(512)), 2u);
    EXPECT_EQ(place_of_pdo<WithGaps>(index_of(1)), 3u) << "missing";
    EXPECT_EQ(place_of_pdo<WithGaps>(index_of(3)), 3u) << "missing";
  }
}

TEST(PdoList, HasTheNumberOfEachPdo) {
  EXPECT_EQ(number_of_pdo<WithoutGaps>(1), 2);
  EXPECT_EQ(number_of_pdo<WithGaps>(0), 2);
  EXPECT_EQ(number_of_pdo<WithGaps>(2), 512);
}

}  // namespace

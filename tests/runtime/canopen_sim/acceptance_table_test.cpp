#include <gtest/gtest.h>
#include <canopen_sim/virtual/acceptance_table.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace {

using canopen::AcceptanceTable;
using canopen::AcceptedFrame;
using canopen::Frame;

TEST(AcceptanceTable, FindsTheReceiversThatALoopFinds) {
  std::mt19937 engine{1};
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  for (const std::size_t places : {1u, 63u, 64u, 65u, 127u}) {
    AcceptanceTable table;
    std::vector<std::vector<AcceptedFrame>> lists;
    std::vector<bool> accepts_all;
    const auto add_receivers = [&](std::size_t number) {
      table.resize(number);
      lists.resize(number);
      accepts_all.resize(number);
    };
    add_receivers((places + 1) / 2);
    const auto some_frame = [&] { return AcceptedFrame{random() % 4, random() % 8 == 0, random() % 2 == 0}; };
    for (int round = 0; round < 500; ++round) {
      if (round == 250) add_receivers(places);
      const std::size_t place = random() % lists.size();
      if (random() % 4 == 0) {
        accepts_all[place] = random() % 4 == 0;
        table.accept_all(place, accepts_all[place]);
      } else {
        lists[place].resize(random() % 4);
        for (AcceptedFrame& accepted : lists[place]) accepted = some_frame();
        table.accept(place, lists[place]);
      }
      const AcceptedFrame one = some_frame();
      const std::size_t from = random() % (lists.size() + 1);
      const auto is_accepted = [&](const AcceptedFrame& other) { return one.extended ? other.extended : one == other; };
      std::size_t expected = from;
      while (expected < lists.size() && !accepts_all[expected] &&
             std::none_of(lists[expected].begin(), lists[expected].end(), is_accepted))
        ++expected;
      if (expected == lists.size()) expected = AcceptanceTable::no_place;
      ASSERT_EQ(table.first_receiver(Frame{.id = one.id, .extended = one.extended, .remote = one.remote}, from),
                expected);
    }
  }
}

}  // namespace

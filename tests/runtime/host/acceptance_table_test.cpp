#include <gtest/gtest.h>
#include <canopen/host/virtual/acceptance_table.hpp>

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
    table.resize(places);
    std::vector<std::vector<AcceptedFrame>> lists(places);
    const auto some_frame = [&] { return AcceptedFrame{random() % 4, random() % 8 == 0, random() % 2 == 0}; };
    for (int round = 0; round < 500; ++round) {
      const std::size_t place = random() % places;
      lists[place].resize(random() % 4);
      for (AcceptedFrame& accepted : lists[place]) accepted = some_frame();
      const bool all = random() % 10 == 0;
      all ? table.accept_all(place) : table.accept(place, lists[place]);
      if (all) {
        lists[place] = {{0, true, false}};
        for (std::uint32_t id = 0; id < 4; ++id) {
          lists[place].push_back({id, false, false});
          lists[place].push_back({id, false, true});
        }
      }
      const AcceptedFrame one = some_frame();
      const std::size_t from = random() % (places + 1);
      std::size_t expected = from;
      const auto accepts = [&](const AcceptedFrame& other) { return one.extended ? other.extended : one == other; };
      while (expected < places && std::none_of(lists[expected].begin(), lists[expected].end(), accepts)) ++expected;
      if (expected == places) expected = AcceptanceTable::no_place;
      ASSERT_EQ(table.first_receiver(Frame{.id = one.id, .extended = one.extended, .remote = one.remote}, from),
                expected);
    }
  }
}

}  // namespace

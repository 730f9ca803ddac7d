/// Looks up entries by index and sub-index, in random order.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"

#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

struct Place {
  std::uint16_t index;
  std::uint8_t sub_index;
};
constexpr std::uint32_t places = 256;
Place some[places];
volatile std::uint32_t found;

using Entries = canopen::EntryAccess<device::Device>;

/// Selects entries with equal probability.
void choose() {
  std::uint32_t entries = 0;
  device::dictionary.for_each_entry([&](std::uint16_t, std::uint8_t, canopen::entry::Word) { ++entries; });
  std::uint32_t random = 1;
  for (Place& place : some) {
    random = random * 1664525u + 1013904223u;
    std::uint32_t left = (random >> 8) % entries;
    device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word) {
      if (left-- == 0) place = {index, sub_index};
    });
  }
}

}  // namespace

void program() {
  start_counter();
  choose();
  print_mean("look-up",
             [](std::uint32_t i) { found = Entries::find(some[i % places].index, some[i % places].sub_index); });
  end_program();
}

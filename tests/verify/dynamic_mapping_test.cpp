/// The generated device of dynamic_mapping.eds: its dynamic and static mappings, and its options.
#include <gtest/gtest.h>

#include <array>
#include <canopen/node.hpp>
#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <dynamic_mapping/device.hpp>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::NodeId;
using dynamic_mapping::Device;
namespace entry = canopen::entry;
namespace od = dynamic_mapping::od;

constexpr const canopen::Dictionary& dictionary = Device::dictionary;

constexpr entry::Place place(std::uint16_t index, std::uint8_t sub_index) {
  return entry::place_of(dictionary.find(index, sub_index));
}

constexpr const canopen::Shape& shape(std::uint16_t index) {
  return dictionary.shapes[entry::shape_of(dictionary.find_index(index))];
}

/// Sub-indices 0 and 1 are in RAM, each further entry 4 bytes after the one before it, all of them aligned.
constexpr bool is_dynamic(std::uint16_t index) {
  if (place(index, 0) != entry::Place::ram) return false;
  const std::uint16_t first = entry::offset_of(dictionary.find(index, 1));
  if (first % alignof(std::uint32_t) != 0) return false;
  for (std::uint8_t i = 1; i <= shape(index).highest; ++i) {
    const entry::Word word = dictionary.find(index, i);
    if (entry::place_of(word) != entry::Place::ram || entry::offset_of(word) != first + 4 * (i - 1)) return false;
  }
  return true;
}

constexpr bool is_static(std::uint16_t index) {
  for (std::uint8_t i = 0; i <= shape(index).highest; ++i) {
    const entry::Word word = dictionary.find(index, i);
    if (entry::place_of(word) == entry::Place::ram || (word & entry::writable) != 0) return false;
  }
  return true;
}

// 1600h, 1A00h, 1A01h: rw. 1A03h: an ARRAY. 1601h: ro. 1A02h: static by option.
static_assert(is_dynamic(0x1600) && is_dynamic(0x1A00) && is_dynamic(0x1A01) && is_dynamic(0x1A03));
static_assert(is_static(0x1601) && is_static(0x1A02));
static_assert(shape(0x1600).subs == shape(0x1A00).subs && shape(0x1600).subs == shape(0x1A01).subs);
static_assert(shape(0x1601).subs == shape(0x1A02).subs && shape(0x1601).subs != shape(0x1600).subs);

// PDOs that map no object are listed if their mapping can change.
static_assert(Device::Rpdos::count == 2 && Device::Tpdos::count == 4);
static_assert([] {
  std::size_t entries = 0;
  Device::Tpdos::for_each([&]<class Pdo, std::size_t>() { entries = 10 * entries + Pdo::entries; });
  return entries;
}() == 2011);

static_assert(!Device::triggers_event(0x2002, 0) && !Device::triggers_event(0x2003, 2));
static_assert(Device::triggers_event(0x2003, 1) && Device::triggers_event(0x2000, 0));
static_assert(Device::emergency_info(0x8130) == std::array<std::uint8_t, 5>{1, 2, 3, 4, 5});
static_assert(Device::emergency_info(0xFF00) == std::array<std::uint8_t, 5>{0, 0, 0, 0, 0xFF});
static_assert(Device::emergency_info(0x8110) == std::array<std::uint8_t, 5>{});

std::vector<std::uint8_t> read(canopen::ObjectStore<Device>& store, std::uint16_t index, std::uint8_t sub_index) {
  std::array<std::uint8_t, 8> scratch{};
  const auto bytes = store.entries().read(dictionary.find(index, sub_index), scratch);
  return {bytes.begin(), bytes.end()};
}

TEST(DynamicMapping, StartsAsTheDataSheetSaysAndDoesSoAgainAfterAReset) {
  canopen::ObjectStore<Device> store;
  for (int i = 0; i < 2; ++i) {
    store.reset_communication(NodeId{5});
    EXPECT_EQ(read(store, 0x1600, 0), (std::vector<std::uint8_t>{2}));
    EXPECT_EQ(read(store, 0x1600, 2), (std::vector<std::uint8_t>{0x10, 0x00, 0x01, 0x20}));
    EXPECT_EQ(read(store, 0x1A01, 0), (std::vector<std::uint8_t>{0}));
    EXPECT_EQ(read(store, 0x1A03, 1), (std::vector<std::uint8_t>{0x10, 0x00, 0x02, 0x20}));
    for (const std::uint16_t index : std::to_array<std::uint16_t>({0x1600, 0x1A00, 0x1A01, 0x1A03})) {
      store.entries().write(dictionary.find(index, 0), std::array<std::uint8_t, 1>{1});
      store.entries().write(dictionary.find(index, 1), std::array<std::uint8_t, 4>{0x08, 0x01, 0x03, 0x20});
      store.entries().write(dictionary.find(index, 2), std::array<std::uint8_t, 4>{0x08, 0x02, 0x03, 0x20});
    }
    EXPECT_EQ(read(store, 0x1A01, 1), (std::vector<std::uint8_t>{0x08, 0x01, 0x03, 0x20}));
    EXPECT_EQ(read(store, 0x1A01, 2), (std::vector<std::uint8_t>{0x08, 0x02, 0x03, 0x20}));
    EXPECT_EQ(read(store, 0x1A01, 3), (std::vector<std::uint8_t>{0, 0, 0, 0}));
  }
}

TEST(DynamicMapping, FindsEverythingThatATpdoMayMapInMemory) {
  for (const std::uint16_t index :
       std::to_array<std::uint16_t>({0x1000, 0x1001, 0x2001, 0x2002, 0x2003, 0x2004, 0x2005, 0x2006, 0x2007, 0x2009})) {
    const entry::Place where = place(index, 0);
    EXPECT_TRUE(where == entry::Place::ram || where == entry::Place::rom) << std::hex << index;
  }
  EXPECT_EQ(place(0x2008, 0), entry::Place::immediate);
  canopen::ObjectStore<Device> store;
  store.reset_application(NodeId{5});
  EXPECT_EQ(read(store, 0x2003, 0), (std::vector<std::uint8_t>{3}));
  EXPECT_EQ(read(store, 0x2003, 3), (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(read(store, 0x2005, 0), (std::vector<std::uint8_t>{0xD8, 0xFF}));
  EXPECT_EQ(read(store, 0x2006, 0), (std::vector<std::uint8_t>{1}));
  EXPECT_EQ(read(store, 0x2007, 0), (std::vector<std::uint8_t>{0x85, 0x01}));
  EXPECT_EQ(store.get<od::number_of_channels>(), 3);
  EXPECT_EQ(store.get<od::own_cob_id>(), 0x185);
}

TEST(StaticMapping, IsReadAndNotWritten) {
  bench::Bench<Device> device;
  EXPECT_EQ(device.ask("605 40 02 1A 00 00 00 00 00"), "585 4F 02 1A 00 01 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 1A 00 00 00 00 00"), "585 80 02 1A 00 02 00 01 06");
  EXPECT_EQ(device.ask("605 40 01 16 01 00 00 00 00"), "585 43 01 16 01 10 00 01 20");
  EXPECT_EQ(device.ask("605 23 01 16 01 00 00 00 00"), "585 80 01 16 01 02 00 01 06");
}

}  // namespace

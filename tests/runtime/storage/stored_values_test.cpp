/// Stored values are checked when they are loaded: a value that could not have been written over the bus is replaced by
/// the default, and EMCY 6300h reports it.
#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <cstring>
#include <every_service/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;
namespace od = every_service::od;
using Device = bench::Bench<every_service::Device, canopen::StoredIn<MemoryStorage>>;

constexpr auto save_all = "605 23 10 10 01 73 61 76 65";
constexpr auto saved_all = "585 60 10 10 01 00 00 00 00";
constexpr auto silent = "705 00";
constexpr auto reported = "705 00 | 085 00 63 01 00 00 00 00 00";

/// Returns what a device sends at power-on.
std::string power_on(MemoryStorage& storage) {
  bench::RecordingBus bus;
  bench::NodeOf<every_service::Device, bench::RecordingBus, canopen::StoredIn<MemoryStorage>> node{
      bus, canopen::NodeId{5}, canopen::stored_in(storage)};
  node.start(canopen::TimePoint{});
  node.on_time(canopen::TimePoint{});
  return bus.take();
}

/// Writes bytes to the memory of a value, as a memory fault or another firmware would.
void put(Device& device, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value) {
  const canopen::EntryAccess entries = device.node.entries();
  const canopen::entry::Word word = entries.find(index, sub_index);
  const std::size_t size = word > 1 && !canopen::entry::is_string(word) ? canopen::entry::wire_bytes(word) : 2;
  std::memcpy(entries.ram(word), &value, size);
}

struct Value {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint64_t value;
};

/// The image of a device that has stored these values.
MemoryStorage stored(std::initializer_list<Value> values) {
  MemoryStorage storage;
  Device device{canopen::stored_in(storage)};
  for (const Value& row : values) put(device, row.index, row.sub_index, row.value);
  EXPECT_EQ(device.ask(save_all), saved_all);
  return storage;
}

std::uint64_t value(Device& device, std::uint16_t index, std::uint8_t sub_index) {
  std::array<std::uint8_t, 8> scratch{};
  const canopen::EntryAccess entries = device.node.entries();
  const auto bytes = entries.read(entries.find(index, sub_index), scratch);
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), std::min<std::size_t>(bytes.size(), sizeof number));
  return number;
}

constexpr std::uint64_t minus_two = 0xC000'0000;  ///< as REAL32
constexpr std::uint64_t half = 0x3F00'0000;

TEST(StoredValues, ThatAreGoodAreTakenWithoutAWord) {
  MemoryStorage storage = stored({{0x200A, 0, half}, {0x2009, 3, 1}, {0x1014, 0, 0x0000'0090}, {0x1017, 0, 1000}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), silent);
  EXPECT_EQ(value(device, 0x200A, 0), half);
  EXPECT_EQ(value(device, 0x2009, 3), 1u);
  EXPECT_EQ(value(device, 0x1014, 0), 0x90u);
  EXPECT_EQ(value(device, 0x1017, 0), 1000u);
}

TEST(StoredValues, OutsideTheirLimitsLeaveTheDefault) {
  MemoryStorage storage = stored({{0x200A, 0, minus_two}, {0x1017, 0, 1000}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), reported);
  EXPECT_EQ(value(device, 0x200A, 0), 0u);
  EXPECT_EQ(value(device, 0x1017, 0), 1000u) << "the others are taken";
}

TEST(StoredValues, OfABooleanAre0Or1) {
  MemoryStorage storage = stored({{0x2009, 3, 2}, {0x2009, 4, 1}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), reported);
  EXPECT_EQ(value(device, 0x2009, 3), 0u);
  EXPECT_EQ(value(device, 0x2009, 4), 1u);
}

TEST(StoredValues, OfAStringHaveRoomInIt) {
  MemoryStorage storage = stored({{0x2006, 0, 17}, {0x200B, 0, 40}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), reported);
  EXPECT_EQ(device.node.get<od::text>().view(), "text");
  EXPECT_EQ(device.node.get<od::octets>().size, 40);
}

TEST(StoredCobIds, ThatAreRestrictedLeaveTheDefault) {
  struct Row {
    std::uint16_t index;
    std::uint8_t sub_index;
    std::uint32_t flags;
    std::uint32_t normal;
  };
  for (const Row& row : {Row{0x1005, 0, 0x4000'0000, 0x80}, Row{0x1012, 0, 0xC000'0000, 0x100}, Row{0x1014, 0, 0, 0x85},
                         Row{0x1201, 1, 0, 0x8000'0000}, Row{0x1201, 2, 0, 0x8000'0000}, Row{0x1400, 1, 0, 0x205},
                         Row{0x1800, 1, 0, 0x185}}) {
    for (const std::uint32_t can_id : {0x000u, 0x101u, 0x585u, 0x605u, 0x77Fu, 0x800u}) {
      MemoryStorage storage = stored({{row.index, row.sub_index, can_id | row.flags}});
      Device device{canopen::stored_in(storage)};
      EXPECT_EQ(power_on(storage), reported) << std::hex << row.index << " " << can_id;
      EXPECT_EQ(value(device, row.index, row.sub_index), row.normal) << std::hex << row.index << " " << can_id;
    }
  }
}

TEST(StoredCobIds, ThatAreNotValidMayBeAnything) {
  MemoryStorage storage = stored({{0x1400, 1, 0x8000'0000}, {0x1014, 0, 0x8000'0585}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), silent);
  EXPECT_EQ(value(device, 0x1400, 1), 0x8000'0000u);
}

// The rows are from CiA 301: 7.5.2.35 and 7.5.2.37 (transmission types; SYNC start value), 7.5.2.6, 7.5.2.22.
TEST(StoredServiceParameters, ThatCouldNotBeWrittenLeaveTheDefault) {
  for (const Value& row : {Value{0x1400, 2, 241}, Value{0x1400, 2, 252}, Value{0x1400, 2, 253}, Value{0x1800, 2, 241},
                           Value{0x1800, 2, 251}, Value{0x1800, 6, 241}, Value{0x1006, 0, 0x8000'0000},
                           Value{0x1019, 0, 1}, Value{0x1019, 0, 241}}) {
    canopen::MemoryStorage nothing;
    Device fresh{canopen::stored_in(nothing)};
    MemoryStorage storage = stored({row});
    Device device{canopen::stored_in(storage)};
    EXPECT_EQ(power_on(storage), reported) << std::hex << row.index << " " << row.value;
    EXPECT_EQ(value(device, row.index, row.sub_index), value(fresh, row.index, row.sub_index)) << std::hex << row.index;
  }
}

TEST(StoredServiceParameters, AtTheEdgesOfWhatCanBeWrittenAreTaken) {
  for (const Value& row : {Value{0x1400, 2, 240}, Value{0x1400, 2, 254}, Value{0x1800, 2, 240}, Value{0x1800, 2, 252},
                           Value{0x1800, 2, 253}, Value{0x1800, 6, 240}, Value{0x1006, 0, 0x7FFF'FFFF},
                           Value{0x1019, 0, 2}, Value{0x1019, 0, 240}}) {
    MemoryStorage storage = stored({row});
    Device device{canopen::stored_in(storage)};
    EXPECT_EQ(power_on(storage), silent) << std::hex << row.index << " " << row.value;
    EXPECT_EQ(value(device, row.index, row.sub_index), row.value) << std::hex << row.index;
  }
}

TEST(StoredMapping, OfWhatDoesNotExistLeavesTheDefault) {
  MemoryStorage storage = stored({{0x1A00, 2, 0x3000'0008}, {0x1A01, 0, 1}, {0x1017, 0, 1000}});
  Device device{canopen::stored_in(storage)};
  EXPECT_EQ(power_on(storage), reported);
  EXPECT_EQ(value(device, 0x1A00, 0), 4u);
  EXPECT_EQ(value(device, 0x1A00, 2), 0x2001'0010u);
  EXPECT_EQ(value(device, 0x1A01, 0), 1u) << "the other PDO keeps its own";
  EXPECT_EQ(value(device, 0x1017, 0), 1000u);
  EXPECT_EQ(device.ask(bench::start).find("185 "), 0u);
}

TEST(StoredMapping, OfMoreThanThereIsRoomForLeavesTheDefault) {
  for (const std::uint64_t count : {9u, 253u}) {
    MemoryStorage storage = stored({{0x1600, 0, count}});
    Device device{canopen::stored_in(storage)};
    EXPECT_EQ(power_on(storage), reported) << count;
    EXPECT_EQ(value(device, 0x1600, 0), 3u);
  }
}

}  // namespace

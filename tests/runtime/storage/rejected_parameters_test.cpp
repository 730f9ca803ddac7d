/// Stored parameters that are not used: of another dictionary, of other limits, or of a damaged storage.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen/host/memory_storage.hpp>
#include <every_service/device.hpp>
#include <longer_label/device.hpp>
#include <stored_device/device.hpp>

#include "parameter_storage_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;
using canopen::NodeId;
using storage_bench::change;
using storage_bench::defaults;
using storage_bench::powered;
using storage_bench::Ranges;
using storage_bench::ranges;
using storage_bench::save_all;
using storage_bench::saved_all;
namespace od = stored_device::od;

// Another dictionary, a damaged storage

TEST(StoreParameters, KeepsItsValuesInAnotherDictionary) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
  }
  auto device = powered<longer_label::Device>(storage);
  EXPECT_EQ(ranges(device), (Ranges{2048, 7, 8, 9})) << "a string of 2000h..5FFFh is longer";
  device.ask("605 23 10 10 03 73 61 76 65");
  EXPECT_EQ(ranges(powered<longer_label::Device>(storage)), (Ranges{2048, 7, 8, 9}));
  EXPECT_EQ(ranges(powered(storage)), (Ranges{2048, 7, 8, 9}));
}

TEST(StoreParameters, TellsThatStoredValuesAreLost) {
  MemoryStorage storage;
  storage.damaged = true;
  bench::RecordingBus bus;
  auto node = bench::make_node<stored_device::Device>(bus, NodeId{5}, canopen::stored_in(storage));
  node.start(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00 | 085 00 63 01 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(node.get<od::error_register>()), 0x01);
  node.on_frame(bench::frame(bench::reset_communication), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00 | 085 00 63 01 00 00 00 00 00") << "until the next power-on";
}

TEST(StoreParameters, ReadsARecordOfAnyType) {  // the sanitizers see what is written beyond the 8 bytes of a number
  for (unsigned type = 0; type <= 0xFF; ++type) {
    MemoryStorage storage;
    storage.image = {'P', 'a', 'r', 2, 0x00, 0x20, 0x00, static_cast<std::uint8_t>(type)};
    storage.image.resize(storage.image.size() + 300);
    const auto device = powered(storage);
    const bool is_gain = ranges(device) == Ranges{0, 0, 1000, 0};  // 2000h, whose stored value is 0
    EXPECT_TRUE(is_gain || ranges(device) == defaults) << type;
  }
}

TEST(StoreParameters, StartsWithDefaultsWhereTheStorageCannotBeRead) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
  }
  storage.fails_to_read = true;
  auto device = powered(storage);
  EXPECT_EQ(ranges(device), defaults);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0x01);
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 00 00 06 06");
}

// Values that were stored with other limits

/// The device with other limits of 6083h, which are 1 and 4294967295 in the EDS.
template <std::uint32_t Low, std::uint32_t High>
struct WithLimits : stored_device::Device {
  static constexpr auto limits = [] {
    std::array<canopen::Limits, std::size(stored_device::table::limits)> rows{};
    std::ranges::copy(stored_device::table::limits, rows.begin());
    for (canopen::Limits& row : rows) {
      if (row.key == canopen::object_key(0x6083, 0)) row = {row.key, Low, High};
    }
    return rows;
  }();
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = stored_device::dictionary;
    copy.limits = limits;
    return copy;
  }();
};

template <class Device>
std::string acceleration_after(MemoryStorage storage) {
  auto device = powered<Device>(storage);
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 64 00 00 00") << "it is in another section";
  return device.ask("605 40 83 60 00 00 00 00 00");
}

TEST(StoreParameters, TakesValuesThatFitTheNewLimits) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 23 83 60 00 D0 07 00 00");
    device.ask("605 2B 17 10 00 64 00 00 00");
    EXPECT_EQ(device.ask(save_all), saved_all);
  }
  const std::string stored = "585 43 83 60 00 D0 07 00 00";
  const std::string by_default = "585 43 83 60 00 E8 03 00 00";
  EXPECT_EQ((acceleration_after<WithLimits<1, 0xFFFF'FFFF>>(storage)), stored);
  EXPECT_EQ((acceleration_after<WithLimits<2, 0xFFFF'FFFF>>(storage)), stored);
  EXPECT_EQ((acceleration_after<WithLimits<1, 2000>>(storage)), stored);
  EXPECT_EQ((acceleration_after<WithLimits<2001, 0xFFFF'FFFF>>(storage)), by_default);
  EXPECT_EQ((acceleration_after<WithLimits<1, 1999>>(storage)), by_default);
}

// The signature of a section depends on each limit, also on those of more than 32 bits.
template <std::uint64_t Low, std::uint64_t High>
struct WithWideLimits : sample::Device {
  static constexpr canopen::WideLimits wide_limits[] = {{canopen::object_key(0x2007, 0x00), Low, High},
                                                        sample::table::wide_limits[1]};
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = sample::dictionary;
    copy.wide_limits = wide_limits;
    return copy;
  }();
};
template <class Device>
constexpr auto signatures = canopen::ParameterLayout<Device>::signatures;
constexpr std::uint64_t wide_low = sample::table::wide_limits[0].low;
constexpr std::uint64_t wide_high = sample::table::wide_limits[0].high;
static_assert(signatures<WithWideLimits<wide_low, wide_high>> == signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low + 1, wide_high>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low + (1ull << 32), wide_high>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low, wide_high + 1>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low, wide_high + (1ull << 32)>> != signatures<sample::Device>);

/// A device whose only node-ID-dependent default has 64 bits: 2008h.
struct WideFollower : sample::Device {
  static constexpr canopen::NodeIdRelative rows[] = {
      {canopen::entry::offset_of(sample::dictionary.find(0x2008, 0)), 8}};
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_communication() { return {}; }
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_application() { return rows; }
};

TEST(StoreParameters, LetsAValueOf64BitsFollowTheNodeId) {
  using Node = bench::NodeOf<WideFollower, bench::RecordingBus, canopen::StoredIn<MemoryStorage>>;
  constexpr std::uint64_t high_bit = 1ull << 32;
  for (const std::uint64_t value : {std::uint64_t{5}, high_bit + 5, std::uint64_t{6}}) {
    MemoryStorage storage;
    bench::RecordingBus bus;
    Node node{bus, NodeId{5}, canopen::stored_in(storage)};
    node.start({});
    EXPECT_EQ(node.get<sample::od::unsigned64_value>(), 5u) << "the default";
    node.set<sample::od::unsigned64_value>(value);
    EXPECT_EQ(node.save(), canopen::ok);
    Node same{bus, NodeId{5}, canopen::stored_in(storage)};
    same.start({});
    EXPECT_EQ(same.get<sample::od::unsigned64_value>(), value);
    Node other{bus, NodeId{9}, canopen::stored_in(storage)};
    other.start({});
    EXPECT_EQ(other.get<sample::od::unsigned64_value>(), value == 5 ? 9 : value);
  }
}

TEST(StoreParameters, GivesUpAnErrorBehaviourThatIsReserved) {
  MemoryStorage storage;
  const std::array<std::uint8_t, 1> reserved{3};
  {
    auto device = powered<every_service::Device>(storage);
    ASSERT_EQ(device.node.set(0x1029, 1, reserved), canopen::ok) << "the application may";
    ASSERT_EQ(device.node.save(), canopen::ok);
  }
  auto device = powered<every_service::Device>(storage);
  EXPECT_EQ(device.ask("605 40 29 10 01 00 00 00 00"), "585 4F 29 10 01 00 00 00 00") << "the default";
}

}  // namespace

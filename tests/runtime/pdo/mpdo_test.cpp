/// Multiplex PDOs: their lists, PDOs that SDO turns into MPDOs, and two nodes.
#include <gtest/gtest.h>

#include <array>
#include <canopen_sim/virtual_bus.hpp>
#include <mpdo_device/device.hpp>
#include <pdo_device/device.hpp>
#include <span>

#include "mpdo_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::NodeId;
using mpdo_bench::Bench;
using mpdo_bench::Running;
namespace od = mpdo_device::od;
using namespace std::chrono_literals;

// The lists: an array of up to 254 elements of 32 bits (1FA0h) or 64 bits (1FD0h), and a number of one byte (CiA 301,
// 7.5.2.41 and 7.5.2.42).

namespace entry = canopen::entry;

/// A device with a list of four elements.
template <std::uint16_t Index, entry::Word Count, entry::Word Element>
struct DeviceWithList {
  static constexpr canopen::Run runs[] = {{Index, 0}, {0xFFFF, 1}};
  static constexpr entry::Word entries[] = {entry::array | entry::shape(0)};
  static constexpr canopen::Shape shapes[] = {{.subs = 0, .highest = 4, .stride = 8}};
  static constexpr entry::Word subs[] = {entry::ram | entry::rw | Count, entry::ram | entry::rw | Element | 8};
  static constexpr canopen::Dictionary dictionary{.runs = runs,
                                                  .entries = entries,
                                                  .shapes = shapes,
                                                  .subs = subs,
                                                  .limits = {},
                                                  .wide_limits = {},
                                                  .constants = nullptr};
};
template <entry::Word Count, entry::Word Element, std::uint16_t Index = 0x1FA0>
constexpr std::uint8_t scanned =
    canopen::MpdoLists<DeviceWithList<Index, Count, Element>, canopen::ScannedObjects>::capacity(Index);
template <entry::Word Count, entry::Word Element, std::uint16_t Index = 0x1FD0>
constexpr std::uint8_t dispatched =
    canopen::MpdoLists<DeviceWithList<Index, Count, Element>, canopen::DispatchedObjects>::capacity(Index);

static_assert(scanned<entry::u8, entry::u32> == 4);
static_assert(scanned<entry::u16, entry::u32> == 0, "the number of elements has one byte");
static_assert(scanned<entry::u8, entry::u16> == 0 && scanned<entry::u8, entry::u64> == 0);
static_assert(dispatched<entry::u8, entry::u64> == 4);
static_assert(dispatched<entry::u32, entry::u64> == 0 && dispatched<entry::u8, entry::u32> == 0);

template <class Element>
using ListsOf = canopen::MpdoLists<DeviceWithList<0x1FA0, entry::u8, entry::u32>, Element>;
static_assert(ListsOf<canopen::ScannedObjects>::contain(0x1FA0) && ListsOf<canopen::ScannedObjects>::contain(0x1FCF));
static_assert(!ListsOf<canopen::ScannedObjects>::contain(0x1F9F) && !ListsOf<canopen::ScannedObjects>::contain(0x1FD0));
static_assert(ListsOf<canopen::DispatchedObjects>::contain(0x1FD0) &&
              ListsOf<canopen::DispatchedObjects>::contain(0x1FFF));
static_assert(!ListsOf<canopen::DispatchedObjects>::contain(0x1FCF) &&
              !ListsOf<canopen::DispatchedObjects>::contain(0x2000));

TEST(MpdoLists, OfTheirNumberOneByteIsLookedAt) {
  Bench device;
  // The bytes after this one would mean a block of 255 objects.
  const std::array<std::uint8_t, 4> memory{1, 0xFF, 0xFF, 0xFF};
  using Check = canopen::MpdoCheck<mpdo_device::Device>;
  EXPECT_EQ(Check::check(device.node.entries(), 0x1FA0, 0, std::span{memory}.first(1)), canopen::ok);
  EXPECT_EQ(Check::check(device.node.entries(), 0x1FD0, 0, std::span{memory}.first(1)), canopen::ok);
}

// PDOs that SDO turns into MPDOs

TEST(DynamicMpdo, ConsumesInEitherMode) {
  Running device;
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 60 02 16 00 00 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  device.ask("222 85 00 20 00 11 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x11);
  device.ask("605 23 02 14 01 22 02 00 80");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FE 00 00 00"), "585 60 02 16 00 00 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  device.ask("222 07 05 20 00 22 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x22);
}

TEST(DynamicMpdo, ProducesInDestinationAddressingMode) {
  Running device;
  device.ask("605 23 01 18 01 85 02 00 80");  // otherwise TPDO2 is the first DAM-TPDO
  EXPECT_EQ(device.ask("605 2F 02 1A 00 FF 00 00 00"), "585 60 02 1A 00 00 00 00 00");
  device.ask("605 23 02 18 01 33 03 00 00");
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 1));
  EXPECT_EQ(device.pass(0s), "333 86 00 20 00 01 00 00 00");
}

TEST(DynamicMpdo, RefusesASecondSamProducer) {
  Running device;
  EXPECT_EQ(device.ask("605 2F 02 1A 00 FE 00 00 00"), "585 80 02 1A 00 42 00 04 06");
}

TEST(DynamicMpdo, RefusesOtherTransmissionTypes) {
  Running device;
  device.ask("605 2F 02 14 02 01 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 80 02 16 00 42 00 04 06");
  device.ask("605 2F 02 14 02 FE 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 60 02 16 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 14 02 01 00 00 00"), "585 80 02 14 02 30 00 09 06");
}

TEST(DynamicMpdo, IsRefusedWithoutTheOption) {
  static_assert(!canopen::MpdoService<pdo_device::Device>::exists);
  static_assert(std::is_empty_v<canopen::MpdoService<pdo_device::Device>>);
  bench::Bench<pdo_device::Device> device;
  device.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(device.ask("605 2F 00 1A 00 FF 00 00 00").substr(0, 6), "585 80");
}

// Two nodes

/// Nodes 5 and 7 on a bus; all frames are recorded.
struct TwoNodes {
  TwoNodes() {
    canopen::VirtualBus::connect(first_end, first);
    canopen::VirtualBus::connect(second_end, second);
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) {
      log += (log.empty() ? "" : " | ") + bench::text(frame);
    });
    first.start(bus.now());
    second.start(bus.now());
    master.send(bench::frame("605 23 01 14 01 05 03 00 80"));
    master.send(bench::frame("605 23 00 14 01 05 02 00 80"));
    master.send(bench::frame("605 23 01 14 01 87 01 00 00"));  // RPDO2 of node 5 receives TPDO1 of node 7
    master.send(bench::frame("605 23 00 14 01 87 02 00 00"));  // and its RPDO1 receives TPDO2
    bus.run_for(1ms);
    master.send(bench::frame("000 01 00"));
    bus.run_for(1ms);
    log.clear();
  }

  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& master = bus.attach();
  canopen::VirtualBus::Endpoint& first_end = bus.attach();
  canopen::VirtualBus::Endpoint& second_end = bus.attach();
  canopen::Node<mpdo_device::Device, canopen::VirtualBus::Endpoint> first{first_end, NodeId{5}};
  canopen::Node<mpdo_device::Device, canopen::VirtualBus::Endpoint> second{second_end, NodeId{7}};
  std::string log;
};

TEST(TwoNodesWithMpdos, ExchangeAnObjectInSourceAddressingMode) {
  TwoNodes nodes;
  nodes.second.set<od::input>(0x1234);
  nodes.bus.run_for(1ms);
  // Node 5 writes 2004h of node 7 to its own 2001h and sends that.
  EXPECT_EQ(nodes.log, "187 07 04 20 00 34 12 00 00 | 185 05 01 20 00 34 12 00 00");
  EXPECT_EQ(nodes.first.get<od::word>(), 0x1234);
}

TEST(TwoNodesWithMpdos, ExchangeAnObjectInDestinationAddressingMode) {
  TwoNodes nodes;
  EXPECT_TRUE(nodes.second.send_mpdo({NodeId{5}, 0x2000, 0}, 0x5A));
  nodes.bus.run_for(1ms);
  EXPECT_EQ(nodes.log, "287 85 00 20 00 5A 00 00 00");
  EXPECT_EQ(nodes.first.get<od::byte>(), 0x5A);
}

}  // namespace

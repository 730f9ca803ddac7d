/// The parts of a node: in any order, default-constructed, omitted.
#include <gtest/gtest.h>

#include <array>
#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <cstdint>
#include <every_service/device.hpp>
#include <rk5c/device.hpp>
#include <string>
#include <type_traits>

#include "support/bench.hpp"

namespace {

using canopen::Composition;
using canopen::NodeId;
using canopen::without;
namespace od = every_service::od;
namespace part = canopen::part;

struct LssPort {
  canopen::LssError accept(NodeId) { return canopen::lss::success; }
  canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssError store(NodeId, canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssBitTiming bit_timing() { return {}; }
  void stop_communication() {}
  void start_communication(canopen::LssBitTiming) {}
};

/// Can be neither copied nor moved: it is constructed in the node.
struct Watch {
  Watch() = default;
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  void on_state(canopen::NmtState) { ++states; }
  int states = 0;
};

/// Sends a frame and returns the response.
template <class Node>
std::string answer(Node& node, bench::RecordingBus& bus, const char* request) {
  bus.take();
  node.on_frame(bench::frame(request), canopen::TimePoint{});
  return bus.take();
}

constexpr auto save = "605 23 10 10 01 73 61 76 65";

TEST(Composition, TakesTheValuesOfItsPartsInAnyOrder) {
  using Parts = Composition<rk5c::Device, Watch>;
  bench::RecordingBus bus;
  canopen::MemoryStorage storage;
  LssPort port;
  canopen::Node<Parts, bench::RecordingBus, canopen::StoredIn<canopen::MemoryStorage>,
                canopen::ConfiguredByLss<LssPort>>
      node{bus, NodeId{5}, canopen::configured_by_lss(port), canopen::stored_in(storage)};
  node.start(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(node.application<Watch>().states, 2) << "Initialisation, Pre-operational";
  EXPECT_EQ(answer(node, bus, "7E5 04 01 00 00 00 00 00 00"), "") << "switch state global";
  EXPECT_EQ(answer(node, bus, "7E5 5E 00 00 00 00 00 00 00"), "7E4 5E 05 00 00 00 00 00 00") << "inquire node-ID";
}

TEST(Composition, IsTheSameForNodeAndMakeNode) {
  using Parts = Composition<rk5c::Device, Watch>;
  bench::RecordingBus bus;
  canopen::MemoryStorage storage;
  LssPort port;
  auto node = canopen::make_node<Parts>(bus, NodeId{5}, canopen::stored_in(storage), canopen::configured_by_lss(port));
  static_assert(std::is_same_v<decltype(node),
                               canopen::Node<Parts, bench::RecordingBus, canopen::StoredIn<canopen::MemoryStorage>,
                                             canopen::ConfiguredByLss<LssPort>>>);
  node.start(canopen::TimePoint{});
  EXPECT_EQ(node.application<Watch>().states, 2);
}

TEST(Composition, WithoutStorageRejectsEveryWriteTo1010h) {
  using Parts = Composition<every_service::Device, without<part::lss, part::storage, od::file, od::stream>>;
  bench::RecordingBus bus;
  canopen::Node<Parts, bench::RecordingBus> node{bus, NodeId{5}};
  node.start(canopen::TimePoint{});
  EXPECT_EQ(answer(node, bus, save), "585 80 10 10 01 20 00 00 08") << "0800 0020h";
  EXPECT_EQ(answer(node, bus, "7E5 04 01 00 00 00 00 00 00"), "");
  EXPECT_EQ(answer(node, bus, "7E5 5E 00 00 00 00 00 00 00"), "") << "no LSS";
}

TEST(Composition, BindsTheMemoryOfADomain) {
  using Parts = Composition<every_service::Device, without<part::lss, part::storage, od::stream>>;
  bench::RecordingBus bus;
  std::array<std::uint8_t, 8> memory{1, 2, 3, 4};
  canopen::Node<Parts, bench::RecordingBus, canopen::BoundTo<od::file>> node{bus, NodeId{5},
                                                                             canopen::bound_to<od::file>(memory, 4)};
  node.start(canopen::TimePoint{});
  constexpr std::uint16_t index = od::file::index;
  const std::string object = {"0123456789ABCDEF"[(index >> 4) & 0xF], "0123456789ABCDEF"[index & 0xF], ' ',
                              "0123456789ABCDEF"[index >> 12], "0123456789ABCDEF"[(index >> 8) & 0xF]};
  const std::string request = "605 40 " + object + " 00 00 00 00 00";
  EXPECT_EQ(answer(node, bus, request.c_str()), "585 43 " + object + " 00 01 02 03 04") << "the value has 4 of 8 bytes";
}

TEST(Composition, HasTheLssOptionsOfItsDevice) {
  using canopen::lss_detail::options_of;
  static_assert(options_of<rk5c::Device, canopen::ConfiguredByLss<LssPort>> == rk5c::Device::lss_options);
  static_assert(rk5c::Device::lss_options != canopen::LssOptions{});
}

TEST(Composition, OmissionsTakeNoMemory) {
  using Parts = Composition<every_service::Device, without<part::lss, part::storage, od::file, od::stream>>;
  struct Nowhere {
    bool send(const canopen::Frame&) { return true; }
  };
  using Bound = canopen::Node<Composition<every_service::Device, canopen::BoundTo<od::file>,
                                          canopen::BoundTo<od::stream>, without<part::lss, part::storage>>,
                              Nowhere>;
  EXPECT_LT(sizeof(canopen::Node<Parts, Nowhere>), sizeof(Bound));
}

}  // namespace

/// The generated device of every_type.eds: limits, node-ID formulas and DOMAINs.
#include <gtest/gtest.h>

#include <array>
#include <canopen/node.hpp>
#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <every_type/device.hpp>
#include <limits>
#include <string>
#include <vector>

#include "every_type_bench.hpp"
#include "support/omitting.hpp"

namespace {

using canopen::AbortCode;
using canopen::NodeId;
using every_type_test::Device;
using every_type_test::hex;
using every_type_test::label;
using every_type_test::wire;
namespace od = every_type::od;
using Bytes = std::vector<std::uint8_t>;

// ---- limits ----

struct LimitRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::vector<Bytes> fine;
  std::vector<Bytes> too_low;
  std::vector<Bytes> too_high;
};

TEST(Limits, AreEnforced) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const LimitRow rows[] = {
      {0x2700, 0, {wire(0x100000000, 8), wire(-2, 8)}, {wire(0xFFFFFFFF, 8), wire(0, 8)}, {wire(-1, 8)}},
      {0x2701, 0, {wire(-INT64_MAX, 8), wire(0, 8), wire(5000000000, 8)}, {wire(INT64_MIN, 8)}, {wire(5000000001, 8)}},
      {0x2702, 0, {wire(-1.5F), wire(0.F), wire(-0.F), wire(2.5F)}, {wire(-1.6F)}, {wire(2.6F), wire(1e30F)}},
      {0x2703, 0, {wire(-1e100), wire(-1.0)}, {wire(-1e101), wire(-infinity)}, {wire(-0.9), wire(0.0), wire(infinity)}},
      {0x2704, 0, {wire(-3, 4), wire(INT32_MAX, 4)}, {wire(-4, 4), wire(INT32_MIN, 4)}, {}},
      {0x2705, 0, {wire(-10, 2), wire(INT16_MIN, 2)}, {}, {wire(-9, 2), wire(0, 2), wire(INT16_MAX, 2)}},
      {0x2706, 0, {wire(-5, 3), wire(70000, 3)}, {wire(-6, 3), wire(-8388608, 3)}, {wire(70001, 3)}},
      {0x2707, 0, {wire(1, 5), wire(0xFF00000000, 5)}, {wire(0, 5)}, {wire(0xFF00000001, 5)}},
      {0x2708, 0, {wire(-3, 7), wire(-1, 7)}, {wire(-4, 7)}, {wire(0, 7), wire(1, 7)}},
      {0x2709, 0, {wire(-128, 1), wire(127, 1)}, {}, {}},
      {0x270A, 1, {wire(-2, 1), wire(3, 1)}, {wire(-3, 1)}, {wire(4, 1)}},
      {0x270A, 3, {wire(-2, 1), wire(3, 1)}, {wire(-3, 1)}, {wire(4, 1)}},
      {0x270B, 1, {wire(1, 1), wire(3, 1)}, {wire(0, 1)}, {wire(4, 1)}},
      {0x270B, 2, {wire(0, 8), wire(0xFF00000000, 8)}, {}, {wire(0xFF00000001, 8), wire(-1, 8)}},
      {0x2404, 3, {wire(-10, 2), wire(10, 2)}, {wire(-11, 2)}, {wire(11, 2)}},
      {0x2002, 0, {wire(-100, 1), wire(100, 1)}, {wire(-101, 1)}, {wire(101, 1)}},
      {0x2005, 0, {wire(0x10, 1), wire(0xF0, 1)}, {wire(0xF, 1)}, {wire(0xF1, 1)}},
      {0x2007, 0, {wire(1, 4), wire(4000000000, 4)}, {wire(0, 4)}, {wire(4000000001, 4)}},
      {0x1003, 0, {wire(0, 1)}, {}, {wire(1, 1)}},
  };
  Device device;
  for (const LimitRow& row : rows) {
    const std::string where = label(row.index, row.sub_index);
    for (const Bytes& bytes : row.fine)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), canopen::ok) << where << " " << hex(bytes);
    for (const Bytes& bytes : row.too_low)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), AbortCode::value_too_low) << where << " " << hex(bytes);
    for (const Bytes& bytes : row.too_high)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), AbortCode::value_too_high) << where << " " << hex(bytes);
  }
}

TEST(Limits, RefuseWhatIsNoNumber) {
  Device device;
  EXPECT_EQ(device.check(0x2702, 0, wire(std::numeric_limits<float>::quiet_NaN())), AbortCode::invalid_value);
  EXPECT_EQ(device.check(0x2703, 0, wire(std::numeric_limits<double>::quiet_NaN())), AbortCode::invalid_value);
  EXPECT_EQ(device.check(0x2001, 0, {2}), AbortCode::invalid_value);
}

TEST(Limits, OfAStringAreItsCapacity) {
  Device device;
  EXPECT_EQ(device.check(0x2500, 0, Bytes(16, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2500, 0, Bytes(17, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2009, 0, Bytes(5, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2009, 0, Bytes(6, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2209, 3, Bytes(27, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2209, 3, Bytes(28, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2403, 2, Bytes(17, 'x')), AbortCode::length_too_high);
  static_assert(every_type::Device::longest_download == 27);
}

TEST(Limits, OfLengthAreThoseOfTheType) {
  Device device;
  EXPECT_EQ(device.check(0x2010, 0, wire(0, 2)), AbortCode::length_too_low);
  EXPECT_EQ(device.check(0x2010, 0, wire(0, 4)), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x200C, 0, Bytes(6, 0)), canopen::ok);
  EXPECT_EQ(device.check(0x200C, 0, Bytes(5, 0)), AbortCode::length_too_low);
}

// ---- node-ID formulas ----

TEST(NodeIdFormulas, FollowTheNodeId) {
  for (const unsigned node_id : {1u, 5u, 127u}) {
    Device device{static_cast<std::uint8_t>(node_id)};
    EXPECT_EQ(canopen::to_raw(device.store.get<od::cob_id_emcy>()), 0x80U + node_id);
    EXPECT_EQ(canopen::to_raw(device.store.get<od::rpdo_1_communication_parameter::cob_id>()), 0x200U + node_id);
    EXPECT_EQ(canopen::to_raw(device.store.get<od::tpdo_2_communication_parameter::cob_id>()), 0xC0000280U + node_id);
    EXPECT_EQ(canopen::to_raw(device.store.get<od::sdo_server_parameter::cob_id_client_to_server>()), 0x600U + node_id);
    EXPECT_EQ(canopen::to_raw(device.store.get<od::unsigned64_formula>()), 0x1000000000U + node_id);
    EXPECT_EQ(canopen::to_raw(device.store.get<od::constant_integer32_formula>()),
              10 + static_cast<std::int32_t>(node_id));
  }
}

struct SilentBus {
  static bool send(const canopen::Frame&) { return true; }
};

TEST(NodeIdFormulas, OfTheApplicationFollowTheNodeIdFromPowerOnOn) {
  SilentBus bus;
  auto node = bench::make_node<every_type::Device>(bus, NodeId{9});
  node.start(canopen::TimePoint{});
  EXPECT_EQ(canopen::to_raw(node.get<od::node_id_itself>()), 9);
  EXPECT_EQ(canopen::to_raw(node.get<od::integer16_formula>()), -256 + 9);
  EXPECT_EQ(canopen::to_raw(node.get<od::array_with_formulas<1>>()), 0x10U + 9);
  EXPECT_EQ(canopen::to_raw(node.get<od::array_with_formulas<2>>()), 0x20U);
  EXPECT_EQ(canopen::to_raw(node.get<od::record_with_formulas::word>()), 2 + 9);
}

// ---- domains ----

TEST(Domains, AreUnboundUntilTheApplicationSaysWhere) {
  Device device;
  std::array<std::uint8_t, 8> scratch{};
  const auto word = every_type::dictionary.find(0x200F, 0);
  EXPECT_EQ(device.store.entries().read(word, scratch).data(), nullptr);

  std::array<std::uint8_t, 4> memory{1, 2, 3, 4};
  device.store.values().application_cleared.domain_value = {memory.data(), 2, 4};
  EXPECT_EQ(hex(device.read(0x200F, 0)), "01 02");
  EXPECT_EQ(device.check(0x200F, 0, Bytes(4, 0)), canopen::ok);
  EXPECT_EQ(device.check(0x200F, 0, Bytes(5, 0)), AbortCode::length_too_high);
}

}  // namespace

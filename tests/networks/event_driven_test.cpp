/// The master of a network whose values are sent when they change.
#include <gtest/gtest.h>

#include <canopen/plant/plant.hpp>
#include <chrono>
#include <cstdint>
#include <event_driven.hpp>
#include <vector>

#include "plant_bench.hpp"

namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
namespace od = ezd_1136::od;

constexpr std::uint32_t can_id = event_driven::controller::Tpdo1::parameters.cob_id & 0x7FF;

template <class Bus>
struct Control {
  explicit Control(Bus& bus) : plant{bus} {}
  canopen::Plant<event_driven::Network, Bus> plant;
};

struct Line : plant_bench::PlantBench<Control> {
  Line() : PlantBench{500'000} {}
  plant_bench::LiveNode<ezd_1136::Device> axis{bus, 1};
};

TEST(EventDriven, AValueIsSentOnceWhenItChanges) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  bench.forget();
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.count(can_id), 1U);
  EXPECT_EQ(bench.last(can_id), (Bytes{0xE8, 0x03, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  EXPECT_EQ(bench.count(can_id), 1U);
}

/// The drive has lost the value with its RAM, and nobody sets it again.
TEST(EventDriven, AValueIsSentAgainToANodeThatHasBooted) {
  Line bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.control.plant.axis.target_position(canopen::raw(1000));
  bench.bus.run_for(1s);
  bench.axis.switch_off();
  bench.bus.run_for(1s);
  bench.forget();
  bench.axis.switch_on();
  ASSERT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 0);
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  EXPECT_EQ(canopen::to_raw(bench.axis.node().get(od::target_position{})), 1000);
  for (const canopen::Frame& frame : bench.frames) {
    if (frame.id == can_id) {
      EXPECT_EQ((Bytes{frame.data.begin(), frame.data.begin() + frame.size}), (Bytes{0xE8, 0x03, 0, 0, 0, 0, 0, 0}));
    }
  }
}

}  // namespace

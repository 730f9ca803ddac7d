/// Touch probes: 60B8h selects signal, edges and repetition; 60B9h and 60BAh to 60BDh show what happened.
#include <gtest/gtest.h>

#include "every_mode_bench.hpp"

namespace {

using namespace std::chrono_literals;
namespace od = every_mode::od;

struct TouchProbe : testing::Test, bench::EveryMode<> {
  void function(unsigned bits) { EXPECT_EQ(write(0x60B8, 0, bits, 2), 0u); }
  [[nodiscard]] unsigned state() { return get<od::touch_probe_status>(); }
  /// The shaft is at a position when the signal changes.
  void edge(unsigned probe, bool on, std::int32_t position) {
    axis().turn_to(position);
    axis().probe(probe, on);
    pass(2ms);
  }
};

TEST_F(TouchProbe, StoresThePositionOfTheFirstPositiveEdge) {
  function(0x0011);
  pass(2ms);
  EXPECT_EQ(state(), 0x0001u) << "enabled";
  edge(1, true, 100);
  EXPECT_EQ(state(), 0x0003u);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 100);
  edge(1, true, 200);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 100) << "single";
  edge(1, false, 300);
  EXPECT_EQ(state(), 0x0003u) << "the negative edge is not enabled";
  EXPECT_EQ(get<od::touch_probe_1_negative_edge>(), 0);
}

TEST_F(TouchProbe, StoresEachEdgeIfItIsContinuous) {
  function(0x0033);
  for (const std::int32_t position : {100, 200, 300}) {
    edge(1, true, position);
    edge(1, false, position + 10);
    EXPECT_EQ(state(), 0x0007u);
    EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), position);
    EXPECT_EQ(get<od::touch_probe_1_negative_edge>(), position + 10);
  }
}

TEST_F(TouchProbe, StartsAgainWhenItIsEnabledAgain) {
  function(0x0011);
  edge(1, true, 100);
  function(0x0000);
  pass(2ms);
  EXPECT_EQ(state(), 0u);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 100) << "the position remains";
  edge(1, true, 200);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 100) << "disabled";
  function(0x0011);
  pass(2ms);
  EXPECT_EQ(state(), 0x0001u) << "an edge from before is ignored";
  edge(1, true, 300);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 300);
}

TEST_F(TouchProbe, HasTwoProbesThatDoNotDisturbEachOther) {
  function(0x1121);  // probe 1 negative, probe 2 positive edge
  edge(1, false, 100);
  edge(2, true, 200);
  EXPECT_EQ(state(), 0x0305u);
  EXPECT_EQ(get<od::touch_probe_1_negative_edge>(), 100);
  EXPECT_EQ(get<od::touch_probe_2_positive_edge>(), 200);
  function(0x2121);  // probe 2 with another edge
  pass(2ms);
  EXPECT_EQ(state(), 0x0105u) << "probe 1 keeps its event";
  edge(2, false, 300);
  EXPECT_EQ(get<od::touch_probe_2_negative_edge>(), 300);
}

TEST_F(TouchProbe, UsesTheIndexPulse) {  // once for each 1000 increments
  EXPECT_EQ(write(0x60FF, 0, 10'000, 4), 0u);
  enable(canopen::cia402::mode::profile_velocity);
  function(0x0015);
  pass(500ms);
  EXPECT_EQ(state(), 0x0003u);
  EXPECT_NEAR(get<od::touch_probe_1_positive_edge>() % 1'000, 0, 12);
}

TEST_F(TouchProbe, TakesTheSourceFrom60D0h) {
  EXPECT_EQ(write(0x60D0, 1, 2, 2), 0u);
  function(0x0019);
  edge(1, true, 100);
  EXPECT_EQ(state(), 0x0001u);
  edge(2, true, 200);
  EXPECT_EQ(get<od::touch_probe_1_positive_edge>(), 200);
}

TEST_F(TouchProbe, IsOffAfterAReset) {
  function(0x0011);
  edge(1, true, 100);
  ask("000 81 05");
  pass(2ms);
  EXPECT_EQ(state(), 0u);
}

}  // namespace

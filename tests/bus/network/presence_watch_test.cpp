/// When a node is taken for present or absent: times, requests and frames.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "network/network.hpp"
#include "network/presence_watch.hpp"

namespace edsc {
namespace {

using canopen::Frame;
using canopen::TimePoint;

constexpr std::uint32_t extended_tpdo = 0x2000'0000 | 0x1234;

Frame frame_of(std::uint32_t id, std::uint8_t size = 1) {
  Frame frame;
  frame.id = id;
  frame.size = size;
  return frame;
}

/// Node 5 with an absence of one second.
class PresenceOfANode : public testing::Test {
 protected:
  static TimePoint at(unsigned milliseconds) { return TimePoint{canopen::from_milliseconds(milliseconds)}; }

  /// Runs until this time in steps of 50 ms; the times of the requests are appended.
  void run_until(unsigned end) {
    for (; now_ < end; now_ += 50) {
      watch_.on_time(at(now_), [this](const Frame& frame) {
        EXPECT_EQ(frame.id, 0x605U);
        EXPECT_EQ(frame.size, 8);
        EXPECT_EQ(frame.data, (std::array<std::uint8_t, 8>{0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
        if (is_full_) return false;
        asked_.push_back(now_);
        return true;
      });
    }
  }
  void receive(const Frame& frame) { watch_.on_frame(frame, at(now_)); }
  [[nodiscard]] Presence presence() const { return watch_.presence(0); }

  unsigned now_ = 0;
  bool is_full_ = false;
  std::vector<unsigned> asked_;
  PresenceWatch watch_{canopen::from_milliseconds(1000), TimePoint{}};
};

class QuietNode : public PresenceOfANode {
 protected:
  QuietNode() { watch_.add(5, {0x705, 0x585, 0x085, 0x185, extended_tpdo}, canopen::Duration{0}); }
};

TEST_F(QuietNode, IsAskedAfterHalfOfTheTimeAndThenAbsent) {
  run_until(1000);
  EXPECT_EQ(asked_, (std::vector<unsigned>{500}));
  EXPECT_EQ(presence(), Presence::unknown);
  run_until(1050);
  EXPECT_EQ(presence(), Presence::absent);
  run_until(5000);
  EXPECT_EQ(asked_.size(), 1U) << "an absent node is not asked again";
}

TEST_F(QuietNode, IsPresentAfterItsAnswer) {
  run_until(600);
  receive(frame_of(0x585, 8));
  EXPECT_EQ(presence(), Presence::present);
}

TEST_F(QuietNode, IsAskedAgainWheneverItHasBeenQuiet) {
  receive(frame_of(0x705));
  for (int i = 0; i < 5; ++i) {
    run_until(now_ + 1300);
    receive(frame_of(0x585, 8));
  }
  EXPECT_EQ(asked_.size(), 5U);
  EXPECT_EQ(presence(), Presence::present);
  run_until(now_ + 2000);
  EXPECT_EQ(presence(), Presence::present);
  run_until(now_ + 50);
  EXPECT_EQ(presence(), Presence::absent);
}

TEST_F(QuietNode, IsNotAskedWhileAnotherClientAsksIt) {
  receive(frame_of(0x705));
  run_until(900);
  receive(frame_of(0x605, 8));
  run_until(1900);
  EXPECT_EQ(presence(), Presence::present);
  run_until(1950);
  EXPECT_EQ(presence(), Presence::absent);
  EXPECT_TRUE(asked_.empty());
}

TEST_F(QuietNode, IsAskedWhenTheBusHasRoomAgain) {
  is_full_ = true;
  run_until(3000);
  EXPECT_EQ(presence(), Presence::unknown);
  is_full_ = false;
  run_until(3450);
  EXPECT_EQ(presence(), Presence::unknown);
  run_until(3550);
  EXPECT_EQ(presence(), Presence::absent);
}

TEST_F(QuietNode, EachOfItsFramesShowsIt) {
  for (const std::uint32_t id : {0x705U, 0x585U, 0x085U, 0x185U}) {
    run_until(now_ + 5000);
    ASSERT_EQ(presence(), Presence::absent);
    receive(frame_of(id));
    EXPECT_EQ(presence(), Presence::present) << id;
  }
  run_until(now_ + 5000);
  Frame extended = frame_of(0x1234);
  extended.extended = true;
  receive(extended);
  EXPECT_EQ(presence(), Presence::present);
}

TEST_F(QuietNode, FramesOfOthersDoNotShowIt) {
  run_until(2000);
  Frame guarding = frame_of(0x705), extended = frame_of(0x705);
  guarding.remote = true;
  extended.extended = true;
  for (const Frame& frame : {guarding, extended, frame_of(0x706), frame_of(0x605, 8), frame_of(0x205),
                             frame_of(0x000, 2), frame_of(0x080, 0)}) {
    receive(frame);
    EXPECT_EQ(presence(), Presence::absent) << frame.id;
  }
}

TEST_F(PresenceOfANode, ASlowHeartbeatIsWaitedFor) {
  watch_.add(5, {0x705}, canopen::from_milliseconds(3000));
  receive(frame_of(0x705));
  run_until(6000);
  EXPECT_TRUE(asked_.empty());
  run_until(7050);
  EXPECT_EQ(asked_, (std::vector<unsigned>{6000}));
  EXPECT_EQ(presence(), Presence::absent);
}

/// Against the CAN-IDs that the manuals of the modules state: TPDO 1 of an input module is 180h and the node-ID.
TEST(OwnCobIds, AreThoseThatNoOtherNodeTransmitsOn) {
  Diagnostics diagnostics;
  const auto loaded = load_network(std::string{EDSC_SOURCE_DIR} + "/examples/networks/four_modules.json", diagnostics);
  ASSERT_EQ(diagnostics.errors(), 0U);
  const Network& network = loaded->network;
  const std::set<std::uint32_t> inputs = own_cob_ids(network, *network.find("digital_inputs"));
  for (const std::uint32_t id : {0x082U, 0x182U, 0x582U, 0x702U}) EXPECT_TRUE(inputs.contains(id)) << id;
  for (const std::uint32_t id : {0x000U, 0x080U, 0x202U, 0x602U, 0x701U}) EXPECT_FALSE(inputs.contains(id)) << id;
}

}  // namespace
}  // namespace edsc

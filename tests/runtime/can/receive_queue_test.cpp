#include <gtest/gtest.h>

#include <canopen/can/receive_queue.hpp>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::Frame;

/// A frame with this number in its data.
Frame numbered(std::uint32_t number) {
  Frame made{.id = 0x181, .size = 4};
  for (unsigned i = 0; i < 4; ++i) made.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
  return made;
}

TEST(ReceiveQueue, KeepsTheOrderAndEveryByte) {
  canopen::ReceiveQueue<4> queue;
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.pop(), std::nullopt);
  const Frame frames[] = {frame("000 01 05"), frame("12345678 R 2"), frame("605 40 00 10 00 00 00 00 00"),
                          frame("080")};
  for (const Frame& one : frames) EXPECT_TRUE(queue.push(one));
  EXPECT_FALSE(queue.empty());
  for (const Frame& one : frames) EXPECT_EQ(queue.pop(), one);
  EXPECT_TRUE(queue.empty());
}

TEST(ReceiveQueue, CountsWhatHasNoRoomAndKeepsTheOlderFrames) {
  canopen::ReceiveQueue<2> queue;
  EXPECT_TRUE(queue.push(numbered(1)));
  EXPECT_TRUE(queue.push(numbered(2)));
  EXPECT_FALSE(queue.push(numbered(3)));
  EXPECT_FALSE(queue.push(numbered(4)));
  EXPECT_EQ(queue.take_overruns(), 2u);
  EXPECT_EQ(queue.take_overruns(), 0u);
  EXPECT_EQ(queue.pop(), numbered(1));
  EXPECT_TRUE(queue.push(numbered(5)));
  EXPECT_EQ(queue.pop(), numbered(2));
  EXPECT_EQ(queue.pop(), numbered(5));
}

TEST(ReceiveQueue, GoesOnWhenItsCountersWrap) {
  canopen::ReceiveQueue<8> queue;
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    ASSERT_TRUE(queue.push(numbered(i)));
    ASSERT_TRUE(queue.push(numbered(i + 1)));
    ASSERT_EQ(queue.pop(), numbered(i));
    ASSERT_EQ(queue.pop(), numbered(i + 1));
  }
  for (std::uint32_t i = 0; i < 8; ++i) ASSERT_TRUE(queue.push(numbered(i)));
  EXPECT_FALSE(queue.push(numbered(8)));
}

}  // namespace

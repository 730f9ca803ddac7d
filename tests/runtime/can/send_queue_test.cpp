#include <gtest/gtest.h>
#include <canopen/can/send_queue.hpp>

#include <string>

#include "support/bench.hpp"

namespace {

using Queue = canopen::SendQueue<4>;

std::string drain(Queue& queue) {
  std::string order;
  for (; !queue.empty(); queue.pop()) order += (order.empty() ? "" : " | ") + bench::text(queue.front());
  return order;
}

TEST(SendQueue, SendsTheLowestCanIdFirst) {
  Queue queue;
  for (const char* frame : {"705 05", "185 31 02", "585 60 40 60 00 00 00 00 00", "085 00 00 00 00 00 00 00 00"}) {
    EXPECT_TRUE(queue.push(bench::frame(frame)));
  }
  EXPECT_EQ(drain(queue), "085 00 00 00 00 00 00 00 00 | 185 31 02 | 585 60 40 60 00 00 00 00 00 | 705 05");
}

TEST(SendQueue, KeepsFramesOfOneCanIdInTheirOrder) {
  Queue queue;
  for (const char* frame : {"585 01", "185 AA", "585 02", "585 03"}) EXPECT_TRUE(queue.push(bench::frame(frame)));
  EXPECT_EQ(drain(queue), "185 AA | 585 01 | 585 02 | 585 03");
}

TEST(SendQueue, OrdersAsArbitrationDoes) {
  Queue queue;
  for (const char* frame : {"185 R 2", "06140000 01", "185 02", "184 03"}) EXPECT_TRUE(queue.push(bench::frame(frame)));
  EXPECT_EQ(drain(queue), "184 03 | 185 02 | 185 R 2 | 06140000 01");
}

TEST(SendQueue, TakesNoMoreThanItHolds) {
  Queue queue;
  for (const char* frame : {"001", "002", "003", "004"}) EXPECT_TRUE(queue.push(bench::frame(frame)));
  EXPECT_TRUE(queue.full());
  EXPECT_FALSE(queue.push(bench::frame("000")));
  queue.pop();
  EXPECT_TRUE(queue.push(bench::frame("000")));
  EXPECT_EQ(drain(queue), "000 | 002 | 003 | 004");
}

}  // namespace

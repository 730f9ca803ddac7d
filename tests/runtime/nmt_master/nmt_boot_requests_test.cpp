/// Requests of the application over the SDO that an NMT master uses for the boot-up, and slaves that reset meanwhile.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>

#include <array>
#include <string>
#include <vector>

#include "nmt_boot_bench.hpp"
#include "support/bench.hpp"

namespace {

using boot_bench::Desk;
using boot_bench::device_type;
using boot_bench::slave;
using boot_bench::Transfer;
using canopen::AbortCode;
using canopen::NodeId;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

// Two boot-up messages

TEST(NmtBoot, TheAnswerThatASecondBootUpLeavesOverIsNotTakenForAnother) {
  Desk desk{{slave(5)}};
  desk.start();
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 00 10 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 boot-up"}));
  desk.take(device_type);  // the response to the first request
  Transfer write;
  const std::array<std::uint8_t, 1> value{1};
  EXPECT_TRUE(desk.master.request(NodeId{5}, write.write(0x2000, 1, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2F 00 20 01 01 00 00 00");
  EXPECT_EQ(desk.take(device_type), "") << "to the second one";
  EXPECT_EQ(write.calls, 0);
  desk.take("585 60 00 20 01 00 00 00 00");
  EXPECT_EQ(write.result, canopen::ok);
}

TEST(NmtBoot, ABootUpEndsWhatWasRequestedBefore) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[3];
  for (Transfer& transfer : transfers) {
    EXPECT_TRUE(desk.master.request(NodeId{5}, transfer.read(0x2001, 0), desk.now));
  }
  desk.bus.take();
  EXPECT_EQ(desk.take("705 00"), "605 80 01 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  for (const Transfer& transfer : transfers) {
    EXPECT_EQ(transfer.calls, 1);
    EXPECT_EQ(transfer.result, AbortCode::device_state);
  }
}

// The queue

TEST(NmtBoot, TheApplicationAndTheMasterShareTheQueueOfANode) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[2];
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[0].read(0x2001, 0), desk.now));
  EXPECT_TRUE(desk.master.request(NodeId{6}, transfers[1].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 40 01 20 00 00 00 00 00 | 606 40 01 20 00 00 00 00 00") << "two nodes at once";
  EXPECT_EQ(desk.pass(99ms), "");
  EXPECT_EQ(desk.pass(1ms), "605 80 01 20 00 00 00 04 05 | 606 80 01 20 00 00 00 04 05");
  EXPECT_EQ(transfers[0].result, AbortCode::timeout);
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  Transfer next;
  EXPECT_TRUE(desk.master.request(NodeId{5}, next.read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.bus.take(), "") << "the master asks";
  EXPECT_EQ(desk.take(device_type), "605 40 01 20 00 00 00 00 00");
}

TEST(NmtBoot, ABootUpWaitsForTheTransfersOfTheApplication) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[2];
  desk.pass(990ms);
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[0].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.pass(10ms), "605 40 01 20 00 00 00 00 00");
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[1].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.take("585 4F 01 20 00 01 00 00 00"), "605 40 00 10 00 00 00 00 00") << "its turn, as it came before";
  EXPECT_EQ(desk.take(device_type), "605 40 01 20 00 00 00 00 00");
}

TEST(NmtBoot, RefusesMoreRequestsThanFit) {
  Desk desk{{slave(5), slave(6)}};
  desk.start();
  Transfer transfers[6];
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(desk.master.request(NodeId{9}, transfers[i].read(0x2001, 0), desk.now)) << i;
  EXPECT_EQ(desk.master.request(NodeId{9}, transfers[4].read(0x2001, 0), desk.now).abort_code(), AbortCode::no_resource)
      << "three wait";
  EXPECT_EQ(transfers[4].calls, 0);
  desk.bus.take();
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00") << "the master has its own places";
  desk.take("589 4F 01 20 00 01 00 00 00");
  EXPECT_EQ(transfers[0].result, canopen::ok);
  EXPECT_EQ(transfers[0].size, 1u);
  EXPECT_TRUE(desk.master.request(NodeId{9}, transfers[5].read(0x2001, 0), desk.now));
}

}  // namespace

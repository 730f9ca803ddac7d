/// Transfers that the application of an SDO client ends, and SDO channels with other CAN-IDs.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <array>
#include <cstdio>

#include "sdo_client_bench.hpp"
#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::TimePoint;
using client_bench::Client;
using namespace std::chrono_literals;

TEST(SdoClient, TellsTheServerThatTheApplicationEndsTheTransfer) {
  Client client;
  client.upload();
  client.client.cancel(AbortCode::general, client.now);
  EXPECT_EQ(client.take(), "80 12 20 00 00 00 00 08");
  EXPECT_EQ(client.client.result(), AbortCode::general);
  EXPECT_FALSE(client.client.busy());
}

/// A server that has lost the transfer, by its time-out or a reset, does not know the entry.
TEST(SdoClient, EndsWithAnAbortOfASegmentWithoutAnEntry) {
  Client client;
  client.upload();
  EXPECT_EQ(client.answer("80 00 00 00 01 00 04 05"), "") << "of a segment of an earlier transfer";
  EXPECT_EQ(client.answer("80 12 20 00 01 00 04 05"), "40 12 20 00 00 00 00 00");
  EXPECT_EQ(client.answer("41 12 20 00 0A 00 00 00"), "60 00 00 00 00 00 00 00");
  EXPECT_EQ(client.answer("80 00 00 00 01 00 04 05"), "");
  EXPECT_FALSE(client.client.busy());
  EXPECT_EQ(client.client.result(), AbortCode::command_specifier);
}

TEST(SdoClient, IsBusyUntilItsAbortIsSent) {
  Client client;
  client.upload();
  client.bus.room = 0;
  EXPECT_EQ(client.pass(100ms), "");
  EXPECT_TRUE(client.client.busy());
  EXPECT_FALSE(client.client.upload(0x2012, 0, client.memory, client.now));
  client.bus.room = 1;
  EXPECT_EQ(client.pass(1ms), "80 12 20 00 00 00 04 05");
  EXPECT_FALSE(client.client.busy());
}

TEST(SdoClient, DropsAnAbortThatFindsNoRoomForALongTime) {
  Client client;
  client.upload();
  client.bus.room = 0;
  client.pass(100ms);
  client.pass(99ms);
  EXPECT_TRUE(client.client.busy());
  client.pass(1ms);
  EXPECT_FALSE(client.client.busy());
  EXPECT_EQ(client.client.result(), AbortCode::timeout);
  EXPECT_EQ(client.client.next_deadline(), std::nullopt);
  client.bus.room = 1;
  EXPECT_EQ(client.pass(1ms), "");
  EXPECT_EQ(client.upload(), "A4 12 20 00 7F 04 00 00");
}

TEST(SdoClient, ReportsTheCodeOfAnAbortAsSent) {
  for (const std::uint32_t sent : {0x0000'0000u, 0x0800'0000u, 0x0000'0001u, 0xFFFF'FFFFu, 0x0602'0000u}) {
    Client client{{.timeout = 100ms}};
    client.upload();
    char abort[24];
    std::snprintf(abort, sizeof abort, "80 12 20 00 %02X %02X %02X %02X", sent & 0xFF, (sent >> 8) & 0xFF,
                  (sent >> 16) & 0xFF, sent >> 24);
    EXPECT_EQ(client.answer(abort), "");
    EXPECT_FALSE(client.client.busy());
    EXPECT_NE(client.client.result(), canopen::ok) << sent;
    EXPECT_EQ(code_in_frame(client.client.result()), sent);
  }
}

TEST(SdoClient, DoesNotTakeAnAbortWithCodeZeroForAnErrorOfAnotherKind) {
  Client client{{.timeout = 100ms}};
  client.upload();
  client.answer("80 12 20 00 00 00 00 00");
  EXPECT_EQ(to_text(client.client.result()), "not an abort code of CiA 301");
}

TEST(SdoClient, LateSegmentsOfABlockUploadBelongToNoOtherTransfer) {
  Client client;
  client.upload();
  client.answer("C2 12 20 00 0E 00 00 00");
  client.client.cancel(AbortCode::general, client.now);
  client.take();
  client.client.upload(0x1000, 0, client.memory, client.now);
  EXPECT_EQ(client.take(), "") << "a segment may look like any answer";
  EXPECT_EQ(client.answer("43 00 10 00 00 00 00 00"), "");  // segment 67
  EXPECT_TRUE(client.client.busy());
  EXPECT_EQ(client.pass(100ms), "A4 00 10 00 7F 04 00 00");
}

TEST(SdoClient, SpeaksToAServerOnOtherCanIds) {
  bench::RecordingBus bus;
  canopen::SdoClient client{bus, {canopen::CobId{0x6E1}, canopen::CobId{0x2000'1234}}};
  std::array<std::uint8_t, 4> memory{};
  client.upload(0x1000, 0, memory, TimePoint{});
  EXPECT_EQ(bus.take(), "6E1 40 00 10 00 00 00 00 00");
  client.on_frame(frame("234 43 00 10 00 91 01 0F 00"), TimePoint{});
  EXPECT_TRUE(client.busy());
  client.on_frame(frame("00001234 43 00 10 00 91 01 0F 00"), TimePoint{});
  EXPECT_EQ(client.result(), canopen::ok);
}

}  // namespace

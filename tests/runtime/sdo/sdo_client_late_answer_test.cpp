/// Late answers: SDO does not number transfers, so an answer is identified by its index and sub-index.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <array>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::NodeId;
using canopen::SdoClient;
using canopen::TimePoint;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(SdoClient, IgnoresAnAnswerForAnotherEntryWhateverItsCommand) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  const std::array<std::uint8_t, 1> value{7};
  client.download(0x2000, 1, value, TimePoint{});
  for (const char* stale : {"585 43 00 10 00 91 01 0F 00", "585 80 00 10 00 00 00 02 06", "585 41 08 10 00 0D 00 00 00",
                            "585 C6 12 20 00 0D 00 00 00", "585 A4 12 20 00 7F 00 00 00"}) {
    client.on_frame(frame(stale), TimePoint{});
    EXPECT_TRUE(client.busy()) << stale;
  }
  EXPECT_EQ(bus.take(), "605 2F 00 20 01 07 00 00 00");
  client.on_frame(frame("585 60 00 20 01 00 00 00 00"), TimePoint{});
  EXPECT_EQ(client.result(), canopen::ok);
}

TEST(SdoClient, IgnoresTheSegmentsOfAnEarlierTransferUntilItsOwnHasBegun) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  std::array<std::uint8_t, 32> memory{};
  client.upload(0x1008, 0, memory, TimePoint{});
  for (const char* stale :
       {"585 00 41 42 43 44 45 46 47", "585 10 41 42 43 44 45 46 47", "585 20 00 00 00 00 00 00 00",
        "585 A2 02 7F 00 00 00 00 00", "585 A1 00 00 00 00 00 00 00", "585 C1 00 00 00 00 00 00 00"}) {
    client.on_frame(frame(stale), TimePoint{});
    EXPECT_TRUE(client.busy()) << stale;
  }
  client.on_frame(frame("585 43 08 10 00 41 42 43 44"), TimePoint{});
  EXPECT_EQ(client.result(), canopen::ok);
  EXPECT_EQ(client.data().size(), 4u);
}

TEST(SdoClient, IgnoresAnInitiateAnswerForAnotherEntryAmongItsSegments) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  std::array<std::uint8_t, 32> memory{};
  client.upload(0x1008, 0, memory, TimePoint{});
  client.on_frame(frame("585 41 08 10 00 05 00 00 00"), TimePoint{});
  client.on_frame(frame("585 43 00 10 00 91 01 0F 00"), TimePoint{});
  client.on_frame(frame("585 05 41 42 43 44 45 00 00"), TimePoint{});
  EXPECT_EQ(client.result(), canopen::ok);
  EXPECT_EQ(client.data().size(), 5u);
}

/// A client whose read of 1000h has timed out.
struct Unanswered {
  Unanswered() {
    client.read<od::device_type>(TimePoint{});
    client.on_time(TimePoint{100ms});
    EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00 | 605 80 00 10 00 00 00 04 05");
    EXPECT_FALSE(client.busy());
  }
  bench::RecordingBus bus;
  SdoClient<bench::RecordingBus> client{bus, NodeId{5}, 100ms};
};

TEST(SdoClient, AsksForTheSameEntryAgainWhenTheLateAnswerHasCome) {
  Unanswered one;
  EXPECT_TRUE(one.client.read<od::device_type>(TimePoint{110ms}));
  EXPECT_TRUE(one.client.busy());
  EXPECT_EQ(one.bus.take(), "") << "the answer to come could not be told from that of the first request";
  EXPECT_EQ(one.client.next_deadline(), TimePoint{200ms});
  one.client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{120ms});
  EXPECT_EQ(one.bus.take(), "605 40 00 10 00 00 00 00 00");
  EXPECT_TRUE(one.client.busy());
  EXPECT_EQ(one.client.next_deadline(), TimePoint{220ms});
  one.client.on_frame(frame("585 43 00 10 00 02 00 00 00"), TimePoint{130ms});
  EXPECT_EQ(one.client.value<od::device_type>()->raw(), 2u);
}

TEST(SdoClient, AsksForTheSameEntryAgainWhenNoAnswerHasComeForAnotherTimeout) {
  Unanswered one;
  EXPECT_TRUE(one.client.read<od::device_type>(TimePoint{110ms}));
  one.client.on_time(TimePoint{199ms});
  EXPECT_EQ(one.bus.take(), "");
  one.client.on_time(TimePoint{200ms});
  EXPECT_EQ(one.bus.take(), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(one.client.next_deadline(), TimePoint{300ms});
}

TEST(SdoClient, DoesNotWaitWhenTheLateAnswerHasComeBefore) {
  Unanswered one;
  one.client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{105ms});
  EXPECT_TRUE(one.client.read<od::device_type>(TimePoint{110ms}));
  EXPECT_EQ(one.bus.take(), "605 40 00 10 00 00 00 00 00");
}

TEST(SdoClient, DoesNotWaitForAnotherEntry) {
  Unanswered one;
  EXPECT_TRUE(one.client.write<od::producer_heartbeat_time>(canopen::raw(50), TimePoint{110ms}));
  EXPECT_EQ(one.bus.take(), "605 2B 17 10 00 32 00 00 00");
  one.client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{111ms});
  one.client.on_frame(frame("585 60 17 10 00 00 00 00 00"), TimePoint{112ms});
  EXPECT_EQ(one.client.result(), canopen::ok);
  EXPECT_TRUE(one.client.read<od::device_type>(TimePoint{113ms}));
  EXPECT_EQ(one.bus.take(), "605 40 00 10 00 00 00 00 00") << "the late answer has come during the other transfer";
}

TEST(SdoClient, TheLateAbortOfASegmentIsNotThatOfTheNextTransfer) {
  bench::RecordingBus bus;
  SdoClient<bench::RecordingBus> client{bus, NodeId{5}, 100ms};
  std::array<std::uint8_t, 20> memory{};
  EXPECT_TRUE(client.upload(0x1008, 0, memory, TimePoint{0ms}));
  client.on_frame(frame("585 41 08 10 00 0A 00 00 00"), TimePoint{1ms});
  client.on_time(TimePoint{101ms});
  EXPECT_EQ(client.result(), AbortCode::timeout);
  EXPECT_EQ(bus.take(), "605 40 08 10 00 00 00 00 00 | 605 60 00 00 00 00 00 00 00 | 605 80 08 10 00 00 00 04 05");
  EXPECT_TRUE(client.upload(0x1008, 0, memory, TimePoint{102ms}));
  client.on_frame(frame("585 80 08 10 00 00 00 04 05"), TimePoint{103ms});  // the server's answer to the segment
  EXPECT_TRUE(client.busy());
  EXPECT_EQ(bus.take(), "605 40 08 10 00 00 00 00 00");
  client.on_frame(frame("585 4B 08 10 00 41 42 00 00"), TimePoint{104ms});
  EXPECT_EQ(client.result(), canopen::ok);
}

TEST(SdoClient, WaitsWhenSeveralRequestsAreNotAnswered) {
  Unanswered one;
  one.client.read<od::producer_heartbeat_time>(TimePoint{100ms});
  one.client.on_time(TimePoint{200ms});
  one.bus.take();
  one.client.read<od::device_type>(TimePoint{200ms});
  one.client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{210ms});
  EXPECT_EQ(one.bus.take(), "");
  one.bus.room = 0;
  one.client.on_time(TimePoint{300ms});
  EXPECT_EQ(one.client.next_deadline(), TimePoint{300ms}) << "it waits for room";
  one.bus.room = 1;
  one.client.on_time(TimePoint{310ms});
  EXPECT_EQ(one.bus.take(), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(one.client.next_deadline(), TimePoint{410ms});
}

TEST(SdoClient, TheLateRefusalOfAWriteIsNotThatOfTheNextOne) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.write<od::producer_heartbeat_time>(canopen::raw(50), TimePoint{});
  client.on_time(TimePoint{100ms});
  bus.take();
  client.write<od::producer_heartbeat_time>(canopen::raw(60), TimePoint{100ms});
  client.on_frame(frame("585 80 17 10 00 22 00 00 08"), TimePoint{110ms});
  EXPECT_TRUE(client.busy());
  EXPECT_EQ(bus.take(), "605 2B 17 10 00 3C 00 00 00");
  client.on_frame(frame("585 60 17 10 00 00 00 00 00"), TimePoint{120ms});
  EXPECT_EQ(client.result(), canopen::ok);
}

TEST(SdoClient, ATransferThatIsCancelledLeavesAnAnswerOverAsWell) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::device_type>(TimePoint{});
  client.cancel(AbortCode::general, TimePoint{10ms});
  EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00 | 605 80 00 10 00 00 00 00 08");
  client.read<od::device_type>(TimePoint{20ms});
  EXPECT_EQ(bus.take(), "");
  client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{30ms});
  EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00");
}

TEST(SdoClient, ATransferThatWaitsForItsTurnMayBeCancelled) {
  Unanswered one;
  one.client.read<od::device_type>(TimePoint{110ms});
  one.client.cancel(AbortCode::general, TimePoint{120ms});
  EXPECT_FALSE(one.client.busy());
  EXPECT_EQ(one.client.result(), AbortCode::general);
  EXPECT_EQ(one.bus.take(), "") << "the server knows nothing of it";
  EXPECT_FALSE(one.client.settled(TimePoint{199ms}));
  EXPECT_TRUE(one.client.settled(TimePoint{200ms}));
}

TEST(SdoClient, ANodeThatHasBootedUpIsAskedAtOnce) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::device_type>(TimePoint{});
  client.server_reset(TimePoint{10ms});
  EXPECT_FALSE(client.busy());
  EXPECT_EQ(client.result(), AbortCode::device_state);
  EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00 | 605 80 00 10 00 22 00 00 08");
  client.read<od::device_type>(TimePoint{20ms});
  EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00") << "what comes now was said after the reset";
  client.on_frame(frame("585 43 00 10 00 01 00 00 00"), TimePoint{21ms});
  EXPECT_EQ(client.value<od::device_type>()->raw(), 1u);
  client.read<od::device_type>(TimePoint{22ms});
  EXPECT_EQ(bus.take(), "") << "there may be a second answer";
}

}  // namespace

#include <gtest/gtest.h>
#include <canopen/port/virtual_bus.hpp>
#include <canopen/sdo_client.hpp>

#include <array>
#include <string>

#include "bench.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::NodeId;
using canopen::SdoClient;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = sample::od;
using namespace std::chrono_literals;

/// A client and the sample device with node-ID 5 on one bus.
struct Pair {
  Pair() {
    VirtualBus::connect(device_end, device);
    VirtualBus::connect(client_end, client);
    device.start(bus.now());
    bus.settle();
  }

  VirtualBus bus;
  VirtualBus::Endpoint& device_end = bus.attach();
  VirtualBus::Endpoint& client_end = bus.attach();
  canopen::Node<sample::Device, VirtualBus::Endpoint> device{device_end, NodeId{5}};
  SdoClient<VirtualBus::Endpoint> client{client_end, NodeId{5}, 100ms};
};

TEST(SdoClient, ReadsAndWritesObjectsByTheirType) {
  Pair pair;
  ASSERT_TRUE(pair.client.write<od::integer24_value>(-5, pair.bus.now()));
  pair.bus.settle();
  EXPECT_EQ(pair.client.result(), canopen::ok);
  EXPECT_EQ(pair.device.get<od::integer24_value>(), -5);
  ASSERT_TRUE(pair.client.read<od::integer24_value>(pair.bus.now()));
  pair.bus.settle();
  EXPECT_EQ(pair.client.value<od::integer24_value>(), -5);
}

TEST(SdoClient, ReadsAndWritesWideNumbersInSegments) {
  Pair pair;
  pair.client.write<od::integer64_value>(-123456789012, pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.device.get<od::integer64_value>(), -123456789012);
  pair.client.read<od::integer64_value>(pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.value<od::integer64_value>(), -123456789012);
}

TEST(SdoClient, UploadsAString) {
  Pair pair;
  std::array<std::uint8_t, 32> memory{};
  pair.client.upload(0x1008, 0, memory, pair.bus.now());
  pair.bus.settle();
  ASSERT_EQ(pair.client.result(), canopen::ok);
  const auto bytes = pair.client.data();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "Sample device");
}

TEST(SdoClient, DownloadsStringsOfAnyLength) {
  for (const std::string text : {"", "a", "abcd", "abcde", "1234567", "12345678", "1234567890123456"}) {
    Pair pair;
    const std::vector<std::uint8_t> bytes{text.begin(), text.end()};
    pair.client.download(0x200C, 0, bytes, pair.bus.now());
    pair.bus.settle();
    EXPECT_EQ(pair.client.result(), canopen::ok);
    EXPECT_EQ(pair.device.get<od::visible_string_value>().view(), text);
  }
}

TEST(SdoClient, HandsTheServersAbortCodeOn) {
  Pair pair;
  std::array<std::uint8_t, 8> memory{};
  pair.client.upload(0x5000, 0, memory, pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.result(), AbortCode::no_object);
  pair.client.write<od::integer8_value>(101, pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.result(), AbortCode::value_too_high);
}

TEST(SdoClient, AbortsAValueThatIsLongerThanItsMemory) {
  Pair pair;
  std::array<std::uint8_t, 5> memory{};
  pair.client.upload(0x1008, 0, memory, pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.result(), AbortCode::out_of_memory);
}

TEST(SdoClient, TakesOneTransferAtATime) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  EXPECT_TRUE(client.read<od::device_type>(TimePoint{}));
  EXPECT_FALSE(client.read<od::device_type>(TimePoint{}));
}

TEST(SdoClient, GivesUpAfterTheTimeoutAndTellsTheServer) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::device_type>(TimePoint{});
  EXPECT_EQ(bus.take(), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(client.next_deadline(), TimePoint{100ms});
  client.on_time(TimePoint{99ms});
  EXPECT_TRUE(client.busy());
  client.on_time(TimePoint{100ms});
  EXPECT_FALSE(client.busy());
  EXPECT_EQ(client.result(), AbortCode::timeout);
  EXPECT_EQ(bus.take(), "605 80 00 10 00 00 00 04 05");
}

TEST(SdoClient, AbortsASegmentWithTheWrongToggleBit) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  std::array<std::uint8_t, 32> memory{};
  client.upload(0x1008, 0, memory, TimePoint{});
  client.on_frame(frame("585 41 08 10 00 09 00 00 00"), TimePoint{});
  client.on_frame(frame("585 10 41 42 43 44 45 46 47"), TimePoint{});
  EXPECT_EQ(client.result(), AbortCode::toggle_bit);
  EXPECT_EQ(bus.take(), "605 40 08 10 00 00 00 00 00 | 605 60 00 00 00 00 00 00 00 | 605 80 08 10 00 00 00 03 05");
}

TEST(SdoClient, TakesAnAnswerWithoutASizeAsLongAsTheObject) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::producer_heartbeat_time>(TimePoint{});
  client.on_frame(frame("585 42 17 10 00 64 00 00 00"), TimePoint{});
  EXPECT_EQ(client.value<od::producer_heartbeat_time>(), 100);
}

TEST(SdoClient, IgnoresAnswersForOtherEntriesAndOtherNodes) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::producer_heartbeat_time>(TimePoint{});
  client.on_frame(frame("586 4B 17 10 00 64 00 00 00"), TimePoint{});
  client.on_frame(frame("585 4B 16 10 00 64 00 00 00"), TimePoint{});
  EXPECT_TRUE(client.busy());
}

}  // namespace

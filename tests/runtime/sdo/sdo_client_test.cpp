/// The SDO client: expedited and segmented transfers, errors of the server, and time-outs.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <array>
#include <string>
#include <vector>

#include "support/bench.hpp"

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
  bench::NodeOf<sample::Device, VirtualBus::Endpoint> device{device_end, NodeId{5}};
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

TEST(SdoClient, HasNoDataAfterADownload) {
  Pair pair;
  pair.client.read<od::integer24_value>(pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.data().size(), 3u);
  pair.client.write<od::integer64_value>(-123456789012, pair.bus.now());
  pair.bus.settle();
  EXPECT_EQ(pair.client.result(), canopen::ok);
  EXPECT_TRUE(pair.client.data().empty());
}

// CiA 301, 7.2.4.3.6: with s = 1 the answer contains the number of its valid bytes.
struct Expedited {
  explicit Expedited(const std::string& answer, std::size_t room) {
    client.upload(0x2000, 1, std::span{memory}.first(room), TimePoint{});
    bus.take();
    client.on_frame(frame("585 " + answer), TimePoint{});
  }
  bench::RecordingBus bus;
  SdoClient<bench::RecordingBus> client{bus, NodeId{5}};
  std::array<std::uint8_t, 8> memory{};
};

TEST(SdoClient, RefusesAnExpeditedAnswerThatIsLongerThanTheMemory) {
  const char* const answers[] = {"4F 00 20 01 AA 00 00 00", "4B 00 20 01 AA BB 00 00", "47 00 20 01 AA BB CC 00",
                                 "43 00 20 01 AA BB CC DD"};
  for (std::size_t size = 1; size <= 4; ++size) {
    for (std::size_t room = 1; room <= 5; ++room) {
      Expedited transfer{answers[size - 1], room};
      EXPECT_EQ(transfer.client.result(), size <= room ? canopen::ok : AbortCode::out_of_memory) << size << " " << room;
      EXPECT_EQ(transfer.bus.take(), size <= room ? "" : "605 80 00 20 01 05 00 04 05") << size << " " << room;
      EXPECT_EQ(transfer.client.data().size(), size <= room ? size : 0) << size << " " << room;
      EXPECT_TRUE(transfer.client.size_known());
    }
  }
}

TEST(SdoClient, CutsAnExpeditedAnswerWithoutASizeToTheMemory) {
  for (std::size_t room = 1; room <= 5; ++room) {
    Expedited transfer{"42 00 20 01 AA BB CC DD", room};
    EXPECT_EQ(transfer.client.result(), canopen::ok) << room;
    EXPECT_EQ(transfer.bus.take(), "");
    EXPECT_EQ(transfer.client.data().size(), room < 4 ? room : 4);
    EXPECT_EQ(transfer.memory[room], 0) << "nothing after the end of the memory";
    EXPECT_FALSE(transfer.client.size_known());
  }
}

TEST(SdoClient, GivesAllFourBytesOfAnExpeditedAnswerWithoutASizeToASink) {
  bench::RecordingBus bus;
  SdoClient<bench::RecordingBus> client{bus, NodeId{5}};
  std::vector<std::uint8_t> taken;
  auto sink = [&](std::uint32_t, std::span<const std::uint8_t> bytes, bool) {
    taken.assign(bytes.begin(), bytes.end());
    return canopen::ok;
  };
  client.upload(0x2000, 1, canopen::sink_of(sink), TimePoint{});
  client.on_frame(frame("585 42 00 20 01 AA BB CC DD"), TimePoint{});
  EXPECT_EQ(client.result(), canopen::ok);
  EXPECT_EQ(taken, (std::vector<std::uint8_t>{0xAA, 0xBB, 0xCC, 0xDD}));
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

/// The announced size limits what a server may send.
TEST(SdoClient, AbortsAServerThatSendsMoreThanItHasAnnounced) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  std::uint32_t taken = 0;
  auto take = [&](std::uint32_t, std::span<const std::uint8_t> bytes, bool) {
    taken += static_cast<std::uint32_t>(bytes.size());
    return canopen::ok;
  };
  client.upload(0x1008, 0, canopen::sink_of(take), TimePoint{});
  client.on_frame(frame("585 41 08 10 00 03 00 00 00"), TimePoint{});
  client.on_frame(frame("585 00 41 42 43 44 45 46 47"), TimePoint{});
  EXPECT_EQ(client.result(), AbortCode::length_too_high);
  EXPECT_EQ(bus.take(), "605 40 08 10 00 00 00 00 00 | 605 60 00 00 00 00 00 00 00 | 605 80 08 10 00 12 00 07 06");
  EXPECT_EQ(taken, 0u);
  EXPECT_FALSE(client.busy());
}

TEST(SdoClient, AbortsABlockUploadThatBringsMoreThanAnnounced) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, canopen::SdoClientOptions{.timeout = 100ms, .block_transfer = true}};
  auto take = [](std::uint32_t, std::span<const std::uint8_t>, bool) { return canopen::ok; };
  client.upload(0x1008, 0, canopen::sink_of(take), TimePoint{});
  client.on_frame(frame("585 C2 08 10 00 08 00 00 00"), TimePoint{});
  client.on_frame(frame("585 01 41 42 43 44 45 46 47"), TimePoint{});
  EXPECT_TRUE(client.busy());
  client.on_frame(frame("585 02 41 42 43 44 45 46 47"), TimePoint{});
  EXPECT_EQ(client.result(), AbortCode::length_too_high);
}

TEST(SdoClient, AbortsASegmentThatBringsNothingAndIsNotTheLast) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  auto take = [](std::uint32_t, std::span<const std::uint8_t>, bool) { return canopen::ok; };
  client.upload(0x1008, 0, canopen::sink_of(take), TimePoint{});
  client.on_frame(frame("585 40 08 10 00 00 00 00 00"), TimePoint{});
  client.on_frame(frame("585 0E 00 00 00 00 00 00 00"), TimePoint{});
  EXPECT_EQ(client.result(), AbortCode::length_too_low);
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
  EXPECT_EQ(client.value<od::producer_heartbeat_time>()->raw(), 100);
}

TEST(SdoClient, IgnoresAnswersForOtherEntriesAndOtherNodes) {
  bench::RecordingBus bus;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::producer_heartbeat_time>(TimePoint{});
  client.on_frame(frame("586 4B 17 10 00 64 00 00 00"), TimePoint{});
  client.on_frame(frame("585 4B 16 10 00 64 00 00 00"), TimePoint{});
  EXPECT_TRUE(client.busy());
}

TEST(SdoClient, GivesUpARequestThatTheBusNeverTakes) {
  bench::RecordingBus bus;
  bus.room = 0;
  SdoClient client{bus, NodeId{5}, 100ms};
  client.read<od::device_type>(TimePoint{});
  client.on_time(TimePoint{99ms});
  EXPECT_TRUE(client.busy());
  client.on_time(TimePoint{100ms});
  EXPECT_FALSE(client.busy());
  EXPECT_EQ(client.result(), AbortCode::timeout);
  bus.room = 10;
  client.on_time(TimePoint{101ms});
  EXPECT_EQ(bus.take(), "") << "the server knows nothing of it";
}

}  // namespace

/// The master of a host: which frames belong to which of its transfers.
#include <gtest/gtest.h>
#include <canopen/host/master.hpp>

#include <malloc.h>

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <sample/device.hpp>
#include <string>
#include <vector>

#include "support/bench.hpp"
#include "support/flooded_bus.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::Duration;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// A bus that a test scripts: the frames that wait to be received, and the response to each frame that is sent.
struct ScriptedBus {
  bool send(const Frame& sent) {
    const auto answer = answers.find(bench::text(sent));
    if (answer != answers.end()) waiting.push_back(frame(answer->second));
    return true;
  }
  std::optional<Frame> receive(Duration timeout) {
    if (waiting.empty()) {
      time = time + timeout;
      return std::nullopt;
    }
    const Frame next = waiting.front();
    waiting.pop_front();
    return next;
  }
  [[nodiscard]] TimePoint now() const { return time; }

  std::map<std::string, std::string> answers;
  std::deque<Frame> waiting;
  TimePoint time{};
};

TEST(Master, DoesNotTakeALateAnswerThatIsUnreadForThatOfItsNextRequest) {
  ScriptedBus bus;
  canopen::Master master{bus};
  const auto lost = master.upload(NodeId{5}, 0x2000, 0);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.abort_code(), AbortCode::timeout);
  bus.time = bus.time + 10s;
  bus.waiting.push_back(frame("585 4F 00 20 00 01 00 00 00"));
  bus.answers["605 40 00 20 00 00 00 00 00"] = "585 4F 00 20 00 02 00 00 00";
  const auto value = master.upload(NodeId{5}, 0x2000, 0);
  ASSERT_TRUE(value);
  EXPECT_EQ(*value, std::vector<std::uint8_t>{2});
  std::array<std::uint8_t, 8> memory{};
  bus.waiting.push_back(frame("585 4F 00 20 00 03 00 00 00"));
  EXPECT_EQ(master.read_number(NodeId{5}, 0x2000, 0, memory).data[0], 2);
  bus.waiting.push_back(frame("585 60 00 20 00 00 00 00 00"));
  bus.answers["605 2F 00 20 00 07 00 00 00"] = "585 80 00 20 00 31 00 09 06";
  const std::uint8_t seven = 7;
  EXPECT_EQ(master.download(NodeId{5}, 0x2000, 0, {&seven, 1}).abort_code(), AbortCode::value_too_high);
}

TEST(Master, ReadsAndWritesTypedObjectsWithoutWaiting) {
  namespace od = sample::od;
  ScriptedBus bus;
  canopen::Master master{bus};
  auto remote = master.remote<sample::Device>(NodeId{5});
  std::optional<canopen::Result<std::int16_t>> word;
  std::optional<canopen::Result<od::visible_string_value::type>> text;
  std::optional<canopen::Result<void>> written;

  bus.answers["605 40 02 20 00 00 00 00 00"] = "585 4B 02 20 00 34 12 00 00";
  EXPECT_TRUE(remote.read(od::integer16_value{}, [&](canopen::Result<std::int16_t> result) { word = result; }));
  EXPECT_FALSE(word);  // not before `poll`
  master.poll(1ms);
  ASSERT_TRUE(word && *word);
  EXPECT_EQ(**word, 0x1234);

  bus.answers["605 40 02 20 00 00 00 00 00"] = "585 4F 02 20 00 34 00 00 00";  // one byte
  EXPECT_TRUE(remote.read(od::integer16_value{}, [&](const auto& result) { word = result; }));
  master.poll(1ms);
  EXPECT_EQ(word->abort_code(), AbortCode::length_mismatch);

  bus.answers["605 2B 02 20 00 07 00 00 00"] = "585 60 02 20 00 00 00 00 00";
  EXPECT_TRUE(remote.write(od::integer16_value{}, 7, [&](canopen::Result<void> result) { written = result; }));
  EXPECT_FALSE(written);
  master.poll(1ms);
  EXPECT_TRUE(written && *written);

  bus.answers["605 40 0C 20 00 00 00 00 00"] = "585 43 0C 20 00 41 42 43 44";
  EXPECT_TRUE(remote.read(od::visible_string_value{}, [&](const auto& result) { text = result; }));
  master.poll(1ms);
  ASSERT_TRUE(text && *text);
  EXPECT_EQ((**text).view(), "ABCD");

  bus.answers.clear();
  EXPECT_TRUE(remote.read(od::integer16_value{}, [&](const auto& result) { word = result; }));
  EXPECT_TRUE(remote.write(od::integer16_value{}, 8, [&](canopen::Result<void> result) { written = result; }));
  for (int i = 0; i < 20; ++i) master.poll(100ms);
  EXPECT_EQ(word->abort_code(), AbortCode::timeout);
  EXPECT_EQ(written->abort_code(), AbortCode::timeout);

  const auto refused = remote.write(od::integer8_value{}, 101, [](canopen::Result<void>) { ADD_FAILURE(); });
  EXPECT_EQ(refused.abort_code(), AbortCode::value_too_high);
  master.poll(1s);
}

TEST(Master, StillTellsOfAFrameThatCameBeforeARequest) {
  ScriptedBus bus;
  canopen::Master master{bus};
  int emergencies = 0;
  master.on_emergency = [&](NodeId, const canopen::EmergencyMessage&) { ++emergencies; };
  bus.waiting.push_back(frame("085 10 81 11 00 00 00 00 00"));
  bus.answers["605 40 00 20 00 00 00 00 00"] = "585 4F 00 20 00 02 00 00 00";
  ASSERT_TRUE(master.upload(NodeId{5}, 0x2000, 0));
  master.poll(0us);
  EXPECT_EQ(emergencies, 1);
}

/// Bytes that the heap has given away.
std::size_t bytes_in_use() { return ::mallinfo2().uordblks; }

TEST(Master, KeepsNothingOfARejectedTransfer) {
  ScriptedBus bus;
  canopen::Master master{bus};
  canopen::Result<void> begun;
  while (begun) begun = master.begin_upload(NodeId{5}, 0x2000, 0, {});
  EXPECT_EQ(begun.abort_code(), AbortCode::no_resource);
  const std::vector<std::uint8_t> value(10'000);
  const std::size_t before = bytes_in_use();
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(master.download(NodeId{5}, 0x2000, 0, value).abort_code(), AbortCode::no_resource);
  }
  EXPECT_LT(bytes_in_use(), before + 10 * value.size());
}

TEST(Master, EndsATransferOnABusThatIsNeverSilent) {
  bench::expect_timeout_on_a_flooded_bus<canopen::Master<bench::FloodedBus>>();
}

TEST(Master, GoesOnWithASlaveThatDoesNotLetItsCobIdsBeRead) {
  ScriptedBus bus;
  std::vector<canopen::NmtSlave> slaves(1);
  slaves[0].node_id = NodeId{5};
  slaves[0].assignment =
      canopen::slave_assignment::listed | canopen::slave_assignment::boot | canopen::slave_assignment::mandatory;
  canopen::Master master{bus, slaves};
  bus.answers["605 40 00 10 00 00 00 00 00"] = "585 43 00 10 00 00 00 00 00";
  bus.answers["605 40 18 10 01 00 00 00 00"] = "585 43 18 10 01 00 00 00 00";
  bus.answers["605 23 00 18 01 81 01 00 80"] = "585 60 00 18 01 00 00 00 00";
  bus.answers["605 40 00 18 01 00 00 00 00"] = "585 80 00 18 01 22 00 00 08";
  const std::array<std::uint8_t, 4> off{0x81, 0x01, 0x00, 0x80};
  master.on_configure = [&](NodeId node_id) { return master.download(node_id, 0x1800, 1, off); };
  bool booted = false;
  master.on_booted = [&](NodeId, const canopen::BootResult& result) { booted = result == canopen::BootStatus::booted; };
  master.start();
  bus.waiting.push_back(frame("705 00"));
  for (int i = 0; i < 100 && !booted; ++i) master.poll(50ms);
  EXPECT_TRUE(booted);
}

}  // namespace

/// SDO transfers of every kind between a client and a node on a bus that loses, repeats, delays and reorders frames.
///
/// What is guaranteed if no frame of a transfer is left when the next one begins (SDO does not number transfers: a late
/// response to the same entry looks like one of the current transfer):
///   - expedited transfers and block transfers with CRC bring the right value or an abort, whatever happens;
///   - segmented transfers do so as long as frames keep their order, repeated or not. A segment that is repeated two
///     segments later has the toggle bit of the expected one, and CiA 301 has no means to detect it: it replaces the
///     expected segment if that is lost, or its response ends the transfer for a client whose last segment is rejected.
///     The server then receives nothing, or a value of the announced length, made of segments that were sent with these
///     toggle bits.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <canopen_sim/bus_faults.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <every_service/device.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::AbortCode;
using canopen::BusFaultRates;
using canopen::Duration;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = every_service::od;
using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

// Faults

/// Records what an endpoint receives, with the time in us.
struct Listener {
  Listener(BusFaultRates rates, std::uint32_t seed) {
    receiver.on_frame = [this](const Frame& got, TimePoint now) {
      lines.push_back(std::to_string(now.since_start().count()) + ": " + bench::text(got));
    };
    faults.emplace(receiver, rates, seed);
  }
  void send(int count) {
    for (int i = 0; i < count; ++i) {
      sender.send(Frame{.id = 0x100, .size = 1, .data = {static_cast<std::uint8_t>(i)}});
      bus.run_for(1ms);
    }
    bus.run_for(1s);
  }
  VirtualBus bus;
  VirtualBus::Endpoint& sender = bus.attach();
  VirtualBus::Endpoint& receiver = bus.attach();
  std::optional<canopen::BusFaults> faults;
  std::vector<std::string> lines;
};

TEST(BusFaults, LoseAndRepeatFrames) {
  Listener everything{{}, 1};
  everything.send(2);
  EXPECT_EQ(everything.lines, (std::vector<std::string>{"0: 100 00", "1000: 100 01"}));
  Listener nothing{{.lost = 1}, 1};
  nothing.send(2);
  EXPECT_TRUE(nothing.lines.empty());
  Listener twice{{.repeated = 1}, 1};
  twice.send(1);
  EXPECT_EQ(twice.lines, (std::vector<std::string>{"0: 100 00", "0: 100 00"}));
}

TEST(BusFaults, DelayedFramesKeepTheirOrderUnlessTheyMayBeOvertaken) {
  Listener ordered{{.delayed = 0.5, .longest_delay = 10ms}, 1};
  ordered.send(100);
  Listener overtaken{{.delayed = 0.5, .longest_delay = 10ms, .overtaking = true}, 1};
  overtaken.send(100);
  const auto by_data = [](const std::string& a, const std::string& b) {
    return a.substr(a.find(' ')) < b.substr(b.find(' '));
  };
  EXPECT_EQ(ordered.lines.size(), 100u);
  EXPECT_EQ(overtaken.lines.size(), 100u);
  EXPECT_TRUE(std::is_sorted(ordered.lines.begin(), ordered.lines.end(), by_data));
  EXPECT_FALSE(std::is_sorted(overtaken.lines.begin(), overtaken.lines.end(), by_data));
}

// Transfers

struct Device : every_service::Device {
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions with_timeout = every_service::Device::options;
    with_timeout.sdo_timeout = 100;
    return with_timeout;
  }();
};

constexpr Duration client_timeout = 50ms;
constexpr std::size_t largest_value = 500;

enum class Kind { expedited, segmented, block };

/// The object that a value of each kind is written to.
struct Target {
  Kind kind;
  std::uint16_t index;
  std::uint8_t sub_index;
  std::size_t smallest;
  std::size_t largest;
  bool block_transfer;
};
constexpr Target targets[] = {
    {Kind::expedited, od::positions<1>::index, 1, 4, 4, false},
    {Kind::segmented, od::octets::index, 0, 5, 40, false},
    {Kind::segmented, od::file::index, 0, 5, largest_value, false},
    {Kind::block, od::file::index, 0, 29, largest_value, true},
};

/// The memory of the DOMAIN of the node, and what a download has passed to its application.
struct Application {
  std::array<std::uint8_t, largest_value> memory{};
  Bytes taken;

  template <class Iterator>
  void take(Iterator begin, std::size_t size) {
    taken.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
  }
};

/// A client whose responses, and a server whose requests, are subject to faults.
class Client {
 public:
  Client(VirtualBus& bus, VirtualBus::Endpoint& server, BusFaultRates rates, std::uint32_t seed) : bus_{bus} {
    endpoint_.on_frame = [this](const Frame& got, TimePoint now) { sdo_->on_frame(got, now); };
    endpoint_.on_time = [this](TimePoint now) { sdo_->on_time(now); };
    endpoint_.next_deadline = [this] { return sdo_->next_deadline(); };
    to_client_.emplace(endpoint_, rates, seed);
    to_server_.emplace(server, rates, seed + 1);
  }

  /// Runs the transfer that `begin(client)` begins to its end. It never waits longer than the time-out.
  template <class Begin>
  AbortCode transfer(bool block_transfer, Begin begin) {
    sdo_.emplace(endpoint_, NodeId{5},
                 canopen::SdoClientOptions{.timeout = client_timeout, .block_transfer = block_transfer});
    EXPECT_TRUE(begin(*sdo_));
    const TimePoint latest = bus_.now() + Duration{60s};
    while (sdo_->busy() && bus_.now() < latest) {
      const auto deadline = sdo_->next_deadline();
      EXPECT_TRUE(deadline && *deadline <= bus_.now() + client_timeout);
      bus_.run_for(100us);
    }
    EXPECT_FALSE(sdo_->busy());
    return sdo_->result();
  }

  [[nodiscard]] Bytes data() const { return {sdo_->data().begin(), sdo_->data().end()}; }

  /// Runs until the server has given up an open transfer and no frame is pending.
  void drain() { bus_.run_for(200ms); }
  void end_faults() {
    to_client_->rates = {};
    to_server_->rates = {};
    drain();
  }

 private:
  VirtualBus& bus_;
  VirtualBus::Endpoint& endpoint_ = bus_.attach();
  std::optional<canopen::SdoClient<VirtualBus::Endpoint>> sdo_{std::in_place, endpoint_, NodeId{5}};
  std::optional<canopen::BusFaults> to_client_;
  std::optional<canopen::BusFaults> to_server_;
};

/// Returns whether a value consists of segments of another one with the same toggle bits, and has the same length.
bool made_of_segments(const Bytes& got, const Bytes& value) {
  constexpr std::size_t size = canopen::sdo::segment_bytes;
  if (got.size() != value.size()) return false;
  for (std::size_t at = 0; at < got.size(); at += size) {
    const std::size_t count = std::min(size, got.size() - at);
    bool found = false;
    for (std::size_t from = at % (2 * size); from + count <= value.size() && !found; from += 2 * size) {
      found = std::equal(&got[at], &got[at] + count, &value[from]);
    }
    if (!found) return false;
  }
  return true;
}

struct Count {
  int good = 0;
  int aborted = 0;
  int mixed = 0;  ///< segmented transfers with a wrong value, which they cannot detect
};

std::map<Kind, Count> run(std::uint32_t seed, BusFaultRates rates, int transfers) {
  VirtualBus bus{1'000'000};
  VirtualBus::Endpoint& endpoint = bus.attach();
  endpoint.queue_limit = 4;
  Application application;
  auto node = bench::make_node<Device>(
      endpoint, NodeId{5}, canopen::on_write<od::positions<1>>([&](std::int32_t value) {
        Bytes bytes(sizeof value);
        std::memcpy(bytes.data(), &value, sizeof value);
        application.taken = bytes;
      }),
      canopen::on_write<od::octets>(
          [&](const od::octets::type& value) { application.take(value.bytes.begin(), value.size); }),
      canopen::on_write<od::file>([&](canopen::Domain value) { application.take(value.data, value.size); }));
  VirtualBus::connect(endpoint, node);
  node.start(bus.now());
  bus.settle();
  Client client{bus, endpoint, rates, seed};
  std::mt19937 random{seed};
  std::map<Kind, Count> counts;

  for (int i = 0; i < transfers && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const Target& target = targets[random() % std::size(targets)];
    Bytes value(target.smallest + random() % (target.largest - target.smallest + 1));
    for (std::uint8_t& byte : value) byte = static_cast<std::uint8_t>(random());
    application.taken.clear();
    Bytes got;
    AbortCode code = canopen::ok;
    const bool download = random() % 2 == 0;
    if (download) {
      node.template bind<od::file>(application.memory);
      code = client.transfer(target.block_transfer,
                             [&](auto& sdo) { return sdo.download(target.index, target.sub_index, value, bus.now()); });
      got = application.taken;
      // A failed transfer has written nothing, or the whole value if the last response was lost.
      if (code != canopen::ok && !rates.overtaking) {
        EXPECT_TRUE(got.empty() || got == value);
      }
    } else {
      if (target.index == od::file::index) {
        std::copy(value.begin(), value.end(), application.memory.begin());
        node.template bind<od::file>(application.memory, value.size());
      } else {
        EXPECT_EQ(node.set(target.index, target.sub_index, value), canopen::ok);
      }
      Bytes memory(largest_value);
      code = client.transfer(target.block_transfer,
                             [&](auto& sdo) { return sdo.upload(target.index, target.sub_index, memory, bus.now()); });
      got = client.data();
    }
    Count& count = counts[target.kind];
    ++(code == canopen::ok ? count.good : count.aborted);
    if (code == canopen::ok && got != value) {
      ++count.mixed;
      EXPECT_TRUE(target.kind == Kind::segmented && rates.overtaking);
      EXPECT_TRUE((download && got.empty()) || made_of_segments(got, value));
    }
    client.drain();
  }

  // The server still serves requests.
  client.end_faults();
  Bytes memory(4);
  EXPECT_EQ(client.transfer(false, [&](auto& sdo) { return sdo.upload(0x1018, 4, memory, bus.now()); }), canopen::ok);
  EXPECT_EQ(client.data(), (Bytes{0x78, 0x56, 0x34, 0x12}));
  return counts;
}

constexpr int transfers_each = 10'000;

void expect_some_of_each(const std::map<Kind, Count>& counts) {
  for (const Kind kind : {Kind::expedited, Kind::segmented, Kind::block}) {
    EXPECT_GT(counts.at(kind).good, 0);
    EXPECT_GT(counts.at(kind).aborted, 0);
  }
}

TEST(NetworkFaults, EveryTransferSucceedsWithoutFaults) {
  for (const auto& [kind, count] : run(1, {}, 1000)) EXPECT_EQ(count.aborted, 0);
}

TEST(NetworkFaults, LossesAndRepetitionsOf1PercentBringNoWrongValue) {
  expect_some_of_each(run(2, {.lost = 0.01, .repeated = 0.01, .delayed = 0.01}, transfers_each));
}

TEST(NetworkFaults, LossesAndRepetitionsOf10PercentBringNoWrongValue) {
  expect_some_of_each(run(3, {.lost = 0.1, .repeated = 0.1, .delayed = 0.1}, transfers_each));
}

TEST(NetworkFaults, FramesInAnotherOrderBringNoWrongValueButInSegments) {
  for (const double rate : {0.01, 0.1}) {
    expect_some_of_each(
        run(4, {.lost = rate, .repeated = rate, .delayed = rate, .overtaking = true}, transfers_each / 2));
  }
}

// What the protocol cannot detect, frame by frame

TEST(NetworkFaults, ASegmentThatComesAgainTwoLaterTakesThePlaceOfALostOne) {
  bench::Bench<Device> device;
  EXPECT_EQ(device.ask("605 21 0B 20 00 18 00 00 00"), "585 60 0B 20 00 00 00 00 00");  // 24 bytes
  EXPECT_EQ(device.ask("605 00 41 41 41 41 41 41 41"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 10 42 42 42 42 42 42 42"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 00 41 41 41 41 41 41 41"), "585 20 00 00 00 00 00 00 00");  // repetition of the first one
  EXPECT_EQ(device.ask("605 19 44 44 44 00 00 00 00"), "585 30 00 00 00 00 00 00 00");  // the third one was lost
  const auto octets = device.node.get<od::octets>();
  EXPECT_EQ(octets.size, 24);
  EXPECT_EQ(octets.bytes[14], 0x41);
}

TEST(NetworkFaults, ASegmentThatComesAgainTwoLaterIsAnsweredInPlaceOfTheLastOne) {
  bench::Bench<Device> device;
  device.ask("605 21 0B 20 00 15 00 00 00");  // 21 bytes
  device.ask("605 00 41 41 41 41 41 41 41");
  device.ask("605 10 42 42 42 42 42 42 42");
  EXPECT_EQ(device.ask("605 00 41 41 41 41 41 41 41"), "585 20 00 00 00 00 00 00 00");  // repetition of the first one
  EXPECT_EQ(device.ask("605 01 43 43 43 43 43 43 43"), "585 80 0B 20 00 00 00 03 05");
  EXPECT_EQ(device.node.get<od::octets>().size, 3);
}

TEST(NetworkFaults, ASegmentThatComesAgainAtOnceEndsTheTransfer) {
  bench::Bench<Device> device;
  device.ask("605 21 0B 20 00 18 00 00 00");
  EXPECT_EQ(device.ask("605 00 41 41 41 41 41 41 41"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 00 41 41 41 41 41 41 41"), "585 80 0B 20 00 00 00 03 05");
  EXPECT_EQ(device.node.get<od::octets>().size, 3);
}

}  // namespace

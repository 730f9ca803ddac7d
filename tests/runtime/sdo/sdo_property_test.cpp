/// A client and a server on a wire that loses and repeats frames: each transfer ends on both sides, with the right
/// bytes or with an abort.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <algorithm>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "sdo_bench.hpp"

namespace {

using bench::SdoBench;
using canopen::AbortCode;
using canopen::Frame;
namespace od = sample::od;
using namespace std::chrono_literals;

constexpr std::uint32_t largest_value = 5000;

struct Blocks : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true, .sdo_timeout = 200};
};
struct NoBlocks : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_timeout = 200};
};

struct Faults {
  double lost;
  double repeated;
};

/// Both directions of the wire; the client's direction is full at times.
struct Wire {
  Wire(std::mt19937& random_numbers, Faults wire_faults) : random{random_numbers}, faults{wire_faults} {}

  bool send(const Frame& frame) {
    if (chance(0.1)) return false;
    put(requests, frame);
    return true;
  }
  void put(std::deque<Frame>& way, const Frame& frame) {
    if (chance(faults.lost)) return;
    way.push_back(frame);
    if (chance(faults.repeated)) way.push_back(frame);
  }
  bool chance(double probability) { return std::uniform_real_distribution<>{}(random) < probability; }

  std::mt19937& random;
  Faults faults;
  std::deque<Frame> requests;
  std::deque<Frame> responses;
};

template <class Device>
class Transfer {
 public:
  Transfer(std::mt19937& random, Faults faults, canopen::SdoClientOptions options)
      : wire{random, faults}, client{wire, canopen::NodeId{5}, options} {
    memory.resize(largest_value);
    value.resize(std::uniform_int_distribution<std::uint32_t>{0, 1}(random) == 0 ? below(random, 30)
                                                                                 : below(random, largest_value));
    for (std::uint8_t& byte : value) byte = static_cast<std::uint8_t>(random());
  }

  AbortCode upload() {
    std::copy(value.begin(), value.end(), memory.begin());
    device.template bind<od::parameter_file>(memory, value.size());
    received.resize(largest_value);
    client.upload(0x2012, 0, received, device.now);
    run();
    return client.result();
  }

  AbortCode download() {
    device.template bind<od::parameter_file>(memory, 1);
    client.download(0x2012, 0, value, device.now);
    run();
    return client.result();
  }

  [[nodiscard]] std::vector<std::uint8_t> data() const { return {client.data().begin(), client.data().end()}; }
  [[nodiscard]] std::vector<std::uint8_t> stored() {
    const canopen::Domain domain = device.store.template get<od::parameter_file>();
    return {domain.data, domain.data + domain.size};
  }

  Wire wire;
  SdoBench<Device> device;
  canopen::SdoClient<Wire> client;
  std::vector<std::uint8_t> memory;
  std::vector<std::uint8_t> value;
  std::vector<std::uint8_t> received;
  bool ended = false;

 private:
  static std::uint32_t below(std::mt19937& random, std::uint32_t limit) {
    return std::uniform_int_distribution<std::uint32_t>{0, limit}(random);
  }

  void run() {
    for (int steps = 0; steps < 200'000 && !ended; ++steps) {
      device.now = device.now + canopen::Duration{100us};
      if (!wire.requests.empty()) {
        device.server.on_request(wire.requests.front().data, device.hooks(), device.now);
        wire.requests.pop_front();
      }
      device.server.on_time(device.now);
      if (device.server.has_reply() && !wire.chance(0.1)) {
        wire.put(wire.responses, {.id = 0x585, .size = 8, .data = device.server.reply()});
        device.server.reply_sent(device.hooks(), device.now);
      }
      if (!wire.responses.empty()) {
        client.on_frame(wire.responses.front(), device.now);
        wire.responses.pop_front();
      }
      client.on_time(device.now);
      ended = !client.busy() && !device.server.next_deadline() && !device.server.has_reply() && wire.requests.empty() &&
              wire.responses.empty();
    }
  }
};

canopen::SdoClientOptions random_options(std::mt19937& random) {
  return {.timeout = 150ms,
          .block_transfer = random() % 4 != 0,
          .block_threshold = static_cast<std::uint8_t>(random() % 40),
          .block_size = static_cast<std::uint8_t>(random() % 8 == 0 ? 127 : random() % 20 + 1)};
}

struct Count {
  int good = 0;
  int aborted = 0;
};

template <class Device>
Count run(unsigned seed, int transfers, Faults faults) {
  std::mt19937 random{seed};
  Count count;
  for (int i = 0; i < transfers; ++i) {
    SCOPED_TRACE(i);
    Transfer<Device> transfer{random, faults, random_options(random)};
    const bool upload = random() % 2 == 0;
    const AbortCode code = upload ? transfer.upload() : transfer.download();
    EXPECT_TRUE(transfer.ended);
    if (code == canopen::ok) {
      EXPECT_EQ(upload ? transfer.data() : transfer.stored(), transfer.value);
      ++count.good;
    } else {
      // Nothing, the previous value, or the whole value if only the last answer was lost.
      const auto left = transfer.stored();
      EXPECT_TRUE(upload || left.size() <= 1 || left == transfer.value);
      ++count.aborted;
    }
    if (testing::Test::HasFailure()) break;
  }
  return count;
}

TEST(SdoProperty, EveryTransferSucceedsOnAGoodWire) {
  EXPECT_EQ(run<Blocks>(1, 400, {0, 0}).aborted, 0);
  EXPECT_EQ(run<NoBlocks>(2, 400, {0, 0}).aborted, 0);
}

TEST(SdoProperty, ATransferOverABadWireEndsWellOrWithAnAbort) {
  for (const Faults faults : {Faults{0.001, 0}, Faults{0, 0.001}, Faults{0.01, 0.01}, Faults{0.2, 0.1}}) {
    const Count blocks = run<Blocks>(3, 600, faults);
    const Count segments = run<NoBlocks>(4, 600, faults);
    EXPECT_GT(blocks.aborted, 0);
    EXPECT_GT(segments.aborted, 0);
    EXPECT_GT(blocks.good, 0);
    EXPECT_GT(segments.good, 0);
  }
}

TEST(SdoProperty, BlockTransferSurvivesWhatEndsASegmentedOne) {
  EXPECT_GT(run<Blocks>(5, 400, {0.002, 0}).good, run<NoBlocks>(5, 400, {0.002, 0}).good);
}

}  // namespace

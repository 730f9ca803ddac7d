/// The worst-case response times against a simulation of the bus.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "can_simulator.hpp"
#include "network/timing/response_times.hpp"

namespace edsc {
namespace {

using namespace std::chrono_literals;
using QueuedFrames = std::vector<std::vector<QueuedFrame>>;

struct RandomNetwork {
  std::vector<CanMessage> messages;
  BusTiming bus;
};

class RandomNetworks {
 public:
  explicit RandomNetworks(unsigned seed) : random_{seed} {}

  /// 2 to 40 messages with a load of 30 to 97 %. Some have 29-bit identifiers, some are remote frames, some share
  /// their CAN-ID with another one, and some have a jitter of up to two periods.
  RandomNetwork next() {
    constexpr std::array<std::uint32_t, 4> bit_rates{125'000, 250'000, 500'000, 1'000'000};
    RandomNetwork network{.messages = std::vector<CanMessage>(count(2, 40)),
                          .bus = {.bit_rate = bit_rates[count(0, 3)]}};
    std::vector<double> shares;
    for (CanMessage& message : network.messages) {
      message.extended = chance(4);
      message.remote = chance(16);
      message.size = static_cast<std::uint8_t>(number(0, 8));
      message.can_id = static_cast<std::uint32_t>(number(0, 0x7FF));
      if (message.extended) message.can_id = message.can_id << 18 | static_cast<std::uint32_t>(number(0, 0x3FFFF));
      shares.push_back(static_cast<double>(number(1, 100)));
    }
    if (chance(4)) network.messages[1].can_id = network.messages[0].can_id & 0x7FF;
    const double load = static_cast<double>(number(30, 97)) / 100;
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      CanMessage& message = network.messages[i];
      const double time_us = static_cast<double>(worst_bits(message)) * 1e6 / network.bus.bit_rate;
      message.period = std::chrono::microseconds{static_cast<std::int64_t>(time_us * sum / (shares[i] * load)) + 1};
      if (chance(2)) message.jitter = message.period * number(1, 100) / (chance(4) ? 50 : 200);
    }
    return network;
  }

  /// Events from a random time within the first period on, each with a random part of the jitter, queued in the order
  /// of the events.
  QueuedFrames frames(const RandomNetwork& network, std::int64_t end) {
    QueuedFrames frames;
    for (const CanMessage& message : network.messages) {
      std::vector<QueuedFrame>& row = frames.emplace_back();
      std::int64_t event = number(0, message.period.count());
      for (; event < end; event += message.period.count() + (chance(8) ? number(0, 100'000) : 0)) {
        const std::int64_t delay = chance(2) ? number(0, message.jitter.count()) : message.jitter.count();
        row.push_back({event, std::max(event + delay, row.empty() ? 0 : row.back().queued)});
      }
    }
    return frames;
  }

  bool chance(int one_of) { return number(1, one_of) == 1; }

 private:
  std::int64_t number(std::int64_t from, std::int64_t to) {
    return from + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(to - from + 1));
  }

  std::size_t count(std::int64_t from, std::int64_t to) { return static_cast<std::size_t>(number(from, to)); }

  std::mt19937_64 random_;
};

/// The time in which the messages of the network send about this number of frames.
std::int64_t time_of_frames(const RandomNetwork& network, double frames) {
  double rate = 0;
  for (const CanMessage& message : network.messages) rate += 1.0 / static_cast<double>(message.period.count());
  return static_cast<std::int64_t>(frames / rate);
}

void expect_within_bounds(const std::vector<ResponseTime>& bounds, const std::vector<std::int64_t>& seen) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!bounds[i].worst) continue;
    EXPECT_LE(seen[i], bounds[i].worst->count()) << "message " << i;
  }
}

TEST(ResponseBounds, AreNotExceededInRandomNetworks) {
  RandomNetworks random{2007};
  int checked = 0;
  for (int run = 0; run < 1'200; ++run) {
    SCOPED_TRACE(run);
    const RandomNetwork network = random.next();
    const auto bounds = response_times(network.messages, network.bus);
    ASSERT_EQ(bounds.size(), network.messages.size());
    CanSimulator simulator{network.messages, network.bus.bit_rate,
                           random.frames(network, time_of_frames(network, 400))};
    expect_within_bounds(bounds, simulator.run(0));
    if (std::ranges::all_of(bounds, [](const ResponseTime& bound) { return bound.worst.has_value(); })) ++checked;
  }
  EXPECT_GE(checked, 1'000);
}

TEST(ResponseBounds, AreNotExceededIfErrorsDestroyFrames) {
  RandomNetworks random{31};
  int checked = 0;
  for (unsigned run = 0; run < 400; ++run) {
    SCOPED_TRACE(run);
    RandomNetwork network = random.next();
    network.bus.error_interval = Nanoseconds{1'000'000'000'000 / network.bus.bit_rate};  // 1,000 bits
    const auto bounds = response_times(network.messages, network.bus);
    CanSimulator simulator{network.messages, network.bus.bit_rate,
                           random.frames(network, time_of_frames(network, 300))};
    simulator.make_errors(network.bus.error_interval->count(), run);
    expect_within_bounds(bounds, simulator.run(0));
    checked += static_cast<int>(std::ranges::count(bounds, ResponseBound::found, &ResponseTime::bound));
  }
  EXPECT_GE(checked, 4'000);
}

/// The worst case for one message: all frames that may delay it are queued a bit time after the start of the longest
/// frame of lower priority, the first ones with their whole jitter and the next ones without.
std::int64_t response_at_critical_instant(const RandomNetwork& network, std::size_t message,
                                          const ResponseTime& bound) {
  const std::string bits = arbitration_bits(network.messages[message]);
  // Of frames with the same bits, the simulator sends that of the first message: the examined one is the last.
  std::vector<CanMessage> messages;
  QueuedFrames frames;
  std::int64_t lower_bits = 0;
  const auto add = [&](const CanMessage& one) {
    messages.push_back(one);
    std::vector<QueuedFrame>& row = frames.emplace_back();
    for (std::int64_t event = -one.jitter.count(); event < bound.busy_period->count(); event += one.period.count()) {
      row.push_back({event, std::max<std::int64_t>(event, 0)});
    }
  };
  for (std::size_t i = 0; i < network.messages.size(); ++i) {
    const CanMessage& other = network.messages[i];
    if (arbitration_bits(other) > bits) lower_bits = std::max(lower_bits, worst_bits(other));
    if (arbitration_bits(other) <= bits && i != message) add(other);
  }
  add(network.messages[message]);
  const std::int64_t bit_time = 1'000'000'000 / network.bus.bit_rate;
  return CanSimulator{messages, network.bus.bit_rate, frames}
      .run(std::max<std::int64_t>(lower_bits - 1, 0) * bit_time)
      .back();
}

TEST(ResponseBounds, AreReachedAtTheCriticalInstant) {
  RandomNetworks random{35};
  std::vector<double> ratios;
  for (int run = 0; run < 300; ++run) {
    SCOPED_TRACE(run);
    const RandomNetwork network = random.next();
    const auto bounds = response_times(network.messages, network.bus);
    for (std::size_t i = 0; i < bounds.size(); i += 3) {
      if (!bounds[i].worst || bounds[i].instances > 100) continue;
      const std::int64_t seen = response_at_critical_instant(network, i, bounds[i]);
      ASSERT_LE(seen, bounds[i].worst->count()) << i;
      ratios.push_back(static_cast<double>(seen) / static_cast<double>(bounds[i].worst->count()));
    }
  }
  ASSERT_GE(ratios.size(), 1'000U);
  std::ranges::sort(ratios);
  RecordProperty("messages", static_cast<int>(ratios.size()));
  RecordProperty("lowest_per_mille", static_cast<int>(1000 * ratios.front()));
  RecordProperty("median_per_mille", static_cast<int>(1000 * ratios[ratios.size() / 2]));
  EXPECT_GE(ratios[ratios.size() / 2], 0.99);
  EXPECT_GE(ratios[ratios.size() / 10], 0.95);
}

/// All offsets of three messages with frames of 1 ms, in steps of 0.5 ms. The bound of the lowest priority, which no
/// frame blocks, is reached exactly.
TEST(ResponseBounds, AreTheLargestResponseTimesOfAllOffsets) {
  constexpr std::int64_t step = 500'000;
  for (std::int64_t a = 5; a <= 8; ++a) {
    for (std::int64_t b = 6; b <= 9; ++b) {
      for (std::int64_t c = 7; c <= 10; ++c) {
        SCOPED_TRACE(testing::Message() << a << ' ' << b << ' ' << c);
        const std::array<std::int64_t, 3> steps{a, b, c};
        RandomNetwork network{.messages = std::vector<CanMessage>(3), .bus = {.bit_rate = 125'000}};
        for (std::size_t i = 0; i < 3; ++i) {
          network.messages[i] = {
              .can_id = static_cast<std::uint32_t>(i), .size = 7, .period = Nanoseconds{steps[i] * step}};
        }
        const auto bounds = response_times(network.messages, network.bus);
        const std::int64_t end = 2 * std::lcm(std::lcm(a, b), c) * step;
        std::int64_t longest = 0;
        for (std::int64_t offset = 0; offset < a * b; ++offset) {
          const std::array<std::int64_t, 3> offsets{offset % a, offset / a, 0};
          QueuedFrames frames(3);
          for (std::size_t i = 0; i < 3; ++i) {
            for (std::int64_t time = offsets[i] * step; time < end; time += steps[i] * step) {
              frames[i].push_back({time, time});
            }
          }
          const auto seen = CanSimulator{network.messages, network.bus.bit_rate, frames}.run(0);
          expect_within_bounds(bounds, seen);
          longest = std::max(longest, seen[2]);
        }
        if (!bounds[2].worst) continue;
        EXPECT_EQ(longest, bounds[2].worst->count());
      }
    }
  }
}

}  // namespace
}  // namespace edsc

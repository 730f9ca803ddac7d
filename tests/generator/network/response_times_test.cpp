#include "network/timing/response_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace edsc {
namespace {

using namespace std::chrono_literals;

CanMessage periodic(std::uint32_t can_id, std::uint8_t size, Nanoseconds period, Nanoseconds deadline) {
  return {.can_id = can_id, .size = size, .period = period, .deadline = deadline};
}

/// Davis, Burns, Bril, Lukkien (2007), section 3.3: messages A, B and C with 7 data bytes at 125 kbit/s. The analysis
/// of 1994 found 3 ms for C; its second frame takes 3.5 ms and misses the deadline.
TEST(ResponseTimes, AreThoseOfThePublishedExample) {
  const std::array messages{periodic(1, 7, 2500us, 2500us), periodic(2, 7, 3500us, 3250us),
                            periodic(3, 7, 3500us, 3250us)};
  const auto results = response_times(messages, {.bit_rate = 125'000});
  ASSERT_EQ(results.size(), 3U);
  for (const ResponseTime& result : results) {
    EXPECT_EQ(result.transmission, 1ms);
    EXPECT_EQ(result.bound, ResponseBound::found);
  }
  EXPECT_EQ(results[0].worst, 2ms);
  EXPECT_EQ(results[0].blocking, 1ms);
  EXPECT_TRUE(results[0].meets_deadline);
  EXPECT_EQ(results[1].worst, 3ms);
  EXPECT_EQ(results[1].busy_period, 5ms);
  EXPECT_TRUE(results[1].meets_deadline);
  EXPECT_EQ(results[2].worst, 3500us);
  EXPECT_EQ(results[2].blocking, 0ms);
  EXPECT_EQ(results[2].busy_period, 7ms);
  EXPECT_EQ(results[2].instances, 2U);
  EXPECT_FALSE(results[2].meets_deadline);
  EXPECT_NEAR(bus_load(messages, {.bit_rate = 125'000}).max, 1 / 2.5 + 2 / 3.5, 1e-9);
}

/// I. Broster, A. Burns, G. Rodriguez-Navas: "Probabilistic analysis of CAN with faults" (2002), twelve messages at
/// 250 kbit/s. The times are those that the tests of SchedCAT (MPI-SWS) expect without faults. They do not include the
/// intermission of the message itself; the last message is blocked by one intermission.
TEST(ResponseTimes, AreThoseOfAnotherProgram) {
  struct Row {
    std::uint8_t size;
    Nanoseconds period;
    Nanoseconds expected;
  };
  constexpr std::array rows{Row{8, 10ms, 1028us}, Row{3, 14ms, 1368us},  Row{3, 20ms, 1708us}, Row{2, 15ms, 2008us},
                            Row{5, 20ms, 2428us}, Row{5, 40ms, 2848us},  Row{4, 15ms, 3228us}, Row{5, 50ms, 3648us},
                            Row{4, 20ms, 4028us}, Row{7, 100ms, 4448us}, Row{5, 50ms, 4708us}, Row{1, 100ms, 4720us}};
  std::vector<CanMessage> messages;
  for (const Row& row : rows) {
    messages.push_back(periodic(static_cast<std::uint32_t>(messages.size()), row.size, row.period, row.period));
  }
  const auto results = response_times(messages, {.bit_rate = 250'000});
  ASSERT_EQ(results.size(), rows.size());
  constexpr Nanoseconds intermission = 12us;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) EXPECT_EQ(results[i].worst, rows[i].expected + intermission) << i;
  EXPECT_EQ(results.back().worst, rows.back().expected);
}

/// The benchmark of the SAE as 17 messages at 125 kbit/s (K. Tindell, A. Burns, 1994), with other priorities. Expected
/// are the times of the sufficient test of the paper, by a Python program with fractions. There, a
/// message is blocked by the longest frame of lower or of its own priority: where the own frame is longer than all
/// lower ones, the time is an upper limit.
TEST(ResponseTimes, OfTheSaeBenchmarkAreThoseOfTheSufficientTest) {
  struct Row {
    std::uint8_t size;
    Nanoseconds period;
    Nanoseconds sufficient;
    bool own_is_longest = false;
  };
  constexpr std::array rows{Row{1, 100ms, 1440us},      Row{1, 5ms, 1960us},         Row{1, 10ms, 2480us},
                            Row{1, 5ms, 3000us},        Row{2, 5ms, 3600us},         Row{2, 5ms, 4200us},
                            Row{2, 5ms, 4800us},        Row{2, 10ms, 5400us},        Row{3, 10ms, 8920us},
                            Row{6, 10ms, 9840us, true}, Row{1, 1000ms, 10200us},     Row{1, 50ms, 19120us},
                            Row{1, 100ms, 19640us},     Row{1, 50ms, 20160us},       Row{1, 1000ms, 29080us},
                            Row{3, 1000ms, 29760us},    Row{4, 100ms, 30520us, true}};
  std::vector<CanMessage> messages;
  for (const Row& row : rows) {
    messages.push_back(periodic(static_cast<std::uint32_t>(messages.size()), row.size, row.period, row.period));
  }
  const auto results = response_times(messages, {.bit_rate = 125'000});
  ASSERT_EQ(results.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].own_is_longest) {
      EXPECT_LT(results[i].worst, rows[i].sufficient) << i;
    } else {
      EXPECT_EQ(results[i].worst, rows[i].sufficient) << i;
    }
  }
  EXPECT_NEAR(bus_load(messages, {.bit_rate = 125'000}).max, 0.88052, 1e-9);
}

TEST(ResponseTimes, OfOneMessageIsItsJitterAndItsFrame) {
  CanMessage only = periodic(0x181, 8, 10ms, 1270us);
  only.jitter = 1ms;
  const auto results = response_times(std::span{&only, 1}, {.bit_rate = 500'000});
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].worst, 1ms + 270us);  // 135 bits of 2 us
  EXPECT_EQ(results[0].busy_period, 270us);
  EXPECT_EQ(results[0].instances, 1U);
  EXPECT_TRUE(results[0].meets_deadline);
  only.deadline = 1270us - 1ns;
  EXPECT_FALSE(response_times(std::span{&only, 1}, {.bit_rate = 500'000})[0].meets_deadline);
}

TEST(ResponseTimes, OfFramesDelayedByMoreThanAPeriodCountTheFramesBefore) {
  // Three frames may be queued at once: events at 0, 1 and 2 ms, all in the buffer at 2 ms.
  CanMessage only = periodic(0x181, 8, 1ms, 10ms);
  only.jitter = 2ms;
  const auto results = response_times(std::span{&only, 1}, {.bit_rate = 500'000});
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].worst, 2270us);  // the first one; the others have waited for less of the jitter
  EXPECT_EQ(results[0].busy_period, 810us);
  EXPECT_EQ(results[0].instances, 3U);
}

/// An error costs 31 bits and the longest frame of this or higher priority: 62 + 270 us at 500 kbit/s.
TEST(ResponseTimes, IncludeErrors) {
  const std::array messages{periodic(1, 8, 10ms, 10ms), periodic(2, 0, 10ms, 10ms)};
  const BusTiming bus{.bit_rate = 500'000, .error_interval = 5ms};
  const auto results = response_times(messages, bus);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].worst, 110us + 270us + 332us);  // blocked by 55 bits
  EXPECT_EQ(results[1].worst, 270us + 110us + 332us);
  const auto frequent = response_times(messages, {.bit_rate = 500'000, .error_interval = 600us});
  EXPECT_EQ(frequent[0].worst, 110us + 270us + 2 * 332us);
  const auto too_frequent = response_times(messages, {.bit_rate = 500'000, .error_interval = 332us});
  EXPECT_EQ(too_frequent[0].bound, ResponseBound::overload);
}

TEST(ResponseTimes, HaveNoBoundOnAnOverloadedBus) {
  std::vector<CanMessage> messages;
  for (std::uint32_t id = 0; id < 4; ++id) messages.push_back(periodic(id, 8, 1ms, 1ms));  // 27 % each
  const auto results = response_times(messages, {.bit_rate = 500'000});
  ASSERT_EQ(results.size(), 4U);
  EXPECT_EQ(results[2].bound, ResponseBound::found);
  EXPECT_EQ(results[3].bound, ResponseBound::overload);
  EXPECT_EQ(results[3].worst, std::nullopt);
  EXPECT_FALSE(results[3].meets_deadline);
  EXPECT_GT(bus_load(messages, {.bit_rate = 500'000}).max, 1.0);
}

TEST(ResponseTimes, HaveNoBoundAtExactlyTheWholeBus) {
  const std::array messages{periodic(1, 7, 2ms, 2ms), periodic(2, 7, 2ms, 2ms)};  // 1 ms each
  const auto results = response_times(messages, {.bit_rate = 125'000});
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].worst, 2ms);
  EXPECT_EQ(results[1].bound, ResponseBound::overload);
}

TEST(ResponseTimes, AreNotFoundIfTheBusyPeriodIsTooLong) {
  // The load is less than 1 by 4e-9, and the queue after a jitter of a day becomes empty after years.
  std::array messages{periodic(1, 7, 2ms, 2ms), periodic(2, 7, 2ms + 16ns, 1s)};
  messages[1].jitter = 24h;
  const auto results = response_times(messages, {.bit_rate = 125'000});
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].bound, ResponseBound::found);
  EXPECT_EQ(results[1].bound, ResponseBound::not_found);
  EXPECT_EQ(results[1].worst, std::nullopt);
  EXPECT_EQ(results[1].busy_period, std::nullopt);
}

TEST(ResponseTimes, OfAMessageWithoutPeriodAndOfLowerPrioritiesHaveNoBound) {
  const std::array messages{periodic(3, 8, 10ms, 10ms), periodic(2, 8, 0ms, 10ms), periodic(1, 0, 10ms, 10ms)};
  const auto results = response_times(messages, {.bit_rate = 500'000});
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0].bound, ResponseBound::overload);
  EXPECT_EQ(results[1].bound, ResponseBound::overload);
  EXPECT_EQ(results[2].worst, 270us + 110us);  // it blocks for one frame
  EXPECT_NEAR(bus_load(messages, {.bit_rate = 500'000}).max, 0.038, 1e-9);
}

TEST(ResponseTimes, OfMessagesWithOneCobIdDelayEachOther) {
  const std::array messages{periodic(0x181, 8, 10ms, 10ms), periodic(0x181, 0, 10ms, 10ms), periodic(0x200, 1, 1s, 1s)};
  const auto results = response_times(messages, {.bit_rate = 500'000});
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0].blocking, 130us);
  EXPECT_EQ(results[0].worst, 130us + 110us + 270us);
  EXPECT_EQ(results[1].worst, 130us + 270us + 110us);
}

/// ISO 11898-1: the 11-bit frame wins by its dominant IDE and RTR, a data frame by its dominant RTR.
TEST(ResponseTimes, FollowTheArbitrationOfBothFormats) {
  struct Row {
    std::uint32_t can_id;
    bool extended;
    bool remote;
  };
  constexpr std::array<Row, 10> order{{{0x000, false, false},
                                       {0x000, false, true},
                                       {0x0000'0000, true, false},
                                       {0x0000'0000, true, true},
                                       {0x0000'0001, true, false},
                                       {0x001, false, false},
                                       {0x0007'FFFF, true, false},  // the first 11 bits are 001h
                                       {0x002, false, false},
                                       {0x0008'0000, true, false},  // the first 11 bits are 002h
                                       {0x7FF, false, true}}};
  std::vector<CanMessage> messages;
  for (const Row& row : order) {
    messages.push_back({.can_id = row.can_id, .extended = row.extended, .remote = row.remote, .size = 0, .period = 1s});
  }
  std::reverse(messages.begin(), messages.end());
  const auto results = response_times(messages, {.bit_rate = 1'000'000});
  ASSERT_EQ(results.size(), order.size());
  EXPECT_EQ(results[0].blocking, 0us);
  for (std::size_t i = 1; i < results.size(); ++i) EXPECT_GE(results[i].blocking, 55us) << i;
  for (std::size_t i = 1; i + 1 < results.size(); ++i) EXPECT_GT(results[i].worst, results[i + 1].worst) << i;
}

/// A SYNC of 1 ms jitter; two synchronous PDOs, which nodes queue up to 200 us after it.
TEST(ResponseTimes, OfSynchronousPdosAreComparedWithTheWindow) {
  CanMessage sync = periodic(0x080, 0, 10ms, 10ms);
  sync.jitter = 1ms;
  const BusTiming bus{.bit_rate = 500'000};
  std::vector<CanMessage> messages{sync, periodic(0x181, 8, 10ms, 2ms), periodic(0x182, 8, 10ms, 2ms)};
  const Nanoseconds sync_response = response_times(messages, bus)[0].worst.value();
  EXPECT_EQ(sync_response, 1ms + 270us + 110us);
  messages[1].jitter = messages[2].jitter = sync_response + 200us;
  const auto results = response_times(messages, bus);
  EXPECT_EQ(results[1].worst, 1580us + 270us + 110us + 270us);
  EXPECT_EQ(results[2].worst, 1580us + 110us + 270us + 270us);
  EXPECT_FALSE(results[2].meets_deadline);
}

TEST(ResponseTimes, AreNotComputedForInvalidValues) {
  const CanMessage good = periodic(0x7FF, 8, 24h, 1h);
  const BusTiming bus{.bit_rate = 1'000};
  EXPECT_EQ(response_times(std::span{&good, 1}, bus).size(), 1U);
  EXPECT_TRUE(response_times({}, bus).empty());

  const auto is_rejected = [&bus](const CanMessage& bad) {
    return !is_valid(bad) && response_times(std::span{&bad, 1}, bus).empty();
  };
  EXPECT_TRUE(is_rejected({.can_id = 0x800, .period = 1s}));
  EXPECT_TRUE(is_rejected({.can_id = 0x2000'0000, .extended = true, .period = 1s}));
  EXPECT_TRUE(is_rejected({.size = 9, .period = 1s}));
  EXPECT_TRUE(is_rejected({.period = -1ns}));
  EXPECT_TRUE(is_rejected({.period = 24h + 1ns}));
  EXPECT_TRUE(is_rejected({.period = 1s, .jitter = -1ns}));
  EXPECT_TRUE(is_rejected({.period = 1s, .jitter = 24h + 1ns}));

  EXPECT_FALSE(is_valid(BusTiming{.bit_rate = 0}));
  EXPECT_FALSE(is_valid(BusTiming{.bit_rate = 999}));
  EXPECT_TRUE(is_valid(BusTiming{.bit_rate = 1'000'000}));
  EXPECT_FALSE(is_valid(BusTiming{.bit_rate = 1'000'001}));
  EXPECT_FALSE(is_valid(BusTiming{.bit_rate = 500'000, .error_interval = 0ns}));
  EXPECT_TRUE(is_valid(BusTiming{.bit_rate = 500'000, .error_interval = 24h}));
  EXPECT_TRUE(response_times(std::span{&good, 1}, {.bit_rate = 0}).empty());
  EXPECT_EQ(bus_load(std::span{&good, 1}, {.bit_rate = 0}).max, 0);
  EXPECT_TRUE(response_times(std::vector<CanMessage>(max_message_count + 1, good), bus).empty());
}

/// Sums stay in 64 bits: with sanitizers, an overflow is an error.
TEST(ResponseTimes, OfLongPeriodsAndManyMessagesDoNotOverflow) {
  CanMessage slow = periodic(0, 8, 24h, 24h);
  slow.jitter = 24h;
  std::vector<CanMessage> messages(2'000, slow);
  for (std::uint32_t id = 0; CanMessage & one : messages) one.can_id = id++ & 0x7FF;
  const auto results = response_times(messages, {.bit_rate = 1'000});
  ASSERT_EQ(results.size(), messages.size());
  EXPECT_GT(results.back().worst, 24h + 135ms * 2'000);

  CanMessage shortest = periodic(0, 8, 1ns, 1ns);
  EXPECT_EQ(response_times(std::vector(16'384, shortest), {.bit_rate = 1'000})[0].bound, ResponseBound::overload);
}

}  // namespace
}  // namespace edsc

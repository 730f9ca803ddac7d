/// The services of the LSS master, frame by frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/lss/lss_master.hpp>
#include <deque>
#include <random>
#include <sstream>
#include <string>
#include <utility>

#include "lss_bench.hpp"

namespace {

using canopen::LssAddress;
using canopen::LssError;
using canopen::LssMaster;
using canopen::LssOutcome;
using canopen::LssState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// A master on a bus that records frames; the test acts as the slaves.
struct MasterBench {
  /// Returns what the master sends in response to this answer.
  std::string hear(const std::string& answer) {
    master.on_frame(bench::frame(answer), now);
    return bus.take();
  }

  /// Returns what it sends during this time.
  std::string pass(canopen::Duration span) {
    const TimePoint end = now + span;
    while (const auto deadline = master.next_deadline()) {
      if (*deadline > end) break;
      now = *deadline;
      master.on_time(now);
    }
    now = end;
    master.on_time(now);
    return bus.take();
  }

  bench::RecordingBus bus;
  LssMaster<bench::RecordingBus> master{bus};
  TimePoint now{};
};

TEST(LssMaster, SwitchesAllSlavesAndExpectsNoAnswer) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.switch_state_global(LssState::configuration, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 04 01 00 00 00 00 00 00");
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
  EXPECT_TRUE(bench.master.switch_state_global(LssState::waiting, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 04 00 00 00 00 00 00 00");
}

TEST(LssMaster, SelectsOneSlaveWithFourFrames) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.switch_state_selective(bench::rk5c_address, bench.now));
  EXPECT_EQ(bench.bus.take(),
            "7E5 40 93 00 00 00 00 00 00 | 7E5 41 52 4B 35 43 00 00 00 | 7E5 42 01 00 01 00 00 00 00 | "
            "7E5 43 34 12 01 15 00 00 00");
  EXPECT_TRUE(bench.master.busy());
  bench.hear("7E4 44 00 00 00 00 00 00 00");
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, ConfiguresANodeId) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.configure_node_id(NodeId{0x7E}, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 11 7E 00 00 00 00 00 00");
  bench.hear("7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, ConfiguresABitRate) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.configure_bit_timing({0, 2}, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 13 00 02 00 00 00 00 00");
  bench.hear("7E4 13 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, GivesTheErrorOfASlave) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.configure_node_id(NodeId{std::uint8_t{0x80}}, bench.now));
  bench.hear("7E4 11 01 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::refused);
  EXPECT_EQ(bench.master.error(), canopen::lss::node_id_out_of_range);
  EXPECT_TRUE(bench.master.configure_bit_timing({0, 5}, bench.now));
  bench.hear("7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::refused);
  EXPECT_EQ(bench.master.error(), canopen::lss::bit_timing_not_supported);
  EXPECT_TRUE(bench.master.store_configuration(bench.now));
  bench.hear("7E4 17 02 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::refused);
  EXPECT_EQ(bench.master.error(), canopen::lss::storage_access_error);
  EXPECT_TRUE(bench.master.store_configuration(bench.now));
  bench.hear("7E4 17 FF 2A 00 00 00 00 00");
  EXPECT_EQ(bench.master.error(), (LssError{canopen::lss::implementation_specific, 0x2A}));
}

TEST(LssMaster, IsBusyForBothDelaysOfASwitchOfTheBitRate) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.activate_bit_timing(300ms, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 15 2C 01 00 00 00 00 00");
  bench.pass(599ms);
  EXPECT_TRUE(bench.master.busy());
  EXPECT_FALSE(bench.master.switch_state_global(LssState::waiting, bench.now));
  bench.pass(1ms);
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, WaitsLongerForASlaveThatStores) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.store_configuration(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 17 00 00 00 00 00 00 00");
  bench.pass(999ms);
  EXPECT_TRUE(bench.master.busy());
  bench.hear("7E4 17 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, InquiresTheAddressAndTheNodeId) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.inquire_vendor_id(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 5A 00 00 00 00 00 00 00");
  bench.hear("7E4 5A 93 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
  EXPECT_EQ(bench.master.value(), 0x93u);
  EXPECT_TRUE(bench.master.inquire_product_code(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 5B 00 00 00 00 00 00 00");
  bench.hear("7E4 5B 52 4B 35 43 00 00 00");
  EXPECT_EQ(bench.master.value(), 0x4335'4B52u);
  EXPECT_TRUE(bench.master.inquire_revision_number(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 5C 00 00 00 00 00 00 00");
  bench.hear("7E4 5C 01 00 01 00 00 00 00");
  EXPECT_EQ(bench.master.value(), 0x0001'0001u);
  EXPECT_TRUE(bench.master.inquire_serial_number(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 5D 00 00 00 00 00 00 00");
  bench.hear("7E4 5D 34 12 01 15 00 00 00");
  EXPECT_EQ(bench.master.value(), 0x1501'1234u);
  EXPECT_TRUE(bench.master.inquire_node_id(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 5E 00 00 00 00 00 00 00");
  bench.hear("7E4 5E 7E 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.value(), 0x7Eu);
}

TEST(LssMaster, AsksForARangeWithSixFrames) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.identify_remote_slave(
      {0x93, 0x4335'4B52, 0x0001'0000, 0x0001'FFFF, 0x1501'0001, 0x1501'FFFF}, bench.now));
  EXPECT_EQ(bench.bus.take(),
            "7E5 46 93 00 00 00 00 00 00 | 7E5 47 52 4B 35 43 00 00 00 | 7E5 48 00 00 01 00 00 00 00 | "
            "7E5 49 FF FF 01 00 00 00 00 | 7E5 4A 01 00 01 15 00 00 00 | 7E5 4B FF FF 01 15 00 00 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");  // a second slave
  EXPECT_TRUE(bench.master.busy());
  bench.pass(100ms);
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, AsksForSlavesWithoutNodeId) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.identify_non_configured_remote_slave(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 4C 00 00 00 00 00 00 00");
  bench.hear("7E4 50 00 00 00 00 00 00 00");
  bench.pass(100ms);
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, EndsEachServiceWhenNoSlaveAnswers) {
  using Master = LssMaster<bench::RecordingBus>;
  struct Row {
    bool (*begin)(Master&, TimePoint);
    std::chrono::milliseconds timeout;
  };
  const Row rows[] = {
      {[](Master& m, TimePoint now) { return m.switch_state_selective({}, now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.configure_node_id(NodeId{1}, now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.configure_bit_timing({}, now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.store_configuration(now); }, 1000ms},
      {[](Master& m, TimePoint now) { return m.inquire_vendor_id(now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.inquire_product_code(now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.inquire_revision_number(now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.inquire_serial_number(now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.inquire_node_id(now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.identify_remote_slave({}, now); }, 100ms},
      {[](Master& m, TimePoint now) { return m.identify_non_configured_remote_slave(now); }, 100ms},
  };
  for (const Row& row : rows) {
    const auto number = &row - rows;
    MasterBench bench;
    EXPECT_TRUE(row.begin(bench.master, bench.now)) << number;
    EXPECT_FALSE(row.begin(bench.master, bench.now)) << number;
    EXPECT_EQ(bench.master.next_deadline(), TimePoint{row.timeout}) << number;
    bench.bus.take();
    EXPECT_EQ(bench.pass(row.timeout - 1us), "") << number;
    EXPECT_TRUE(bench.master.busy()) << number;
    EXPECT_EQ(bench.pass(1us), "") << number;
    EXPECT_FALSE(bench.master.busy()) << number;
    EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer) << number;
    EXPECT_FALSE(bench.master.next_deadline()) << number;
  }
}

TEST(LssMaster, IgnoresAnswersToOtherRequestsAndOtherFrames) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.inquire_vendor_id(bench.now));
  for (const char* frame : {"7E4 5B 93 00 00 00 00 00 00", "7E4 5A 93 00 00 00", "7E5 5A 93 00 00 00 00 00 00",
                            "000007E4 5A 93 00 00 00 00 00 00", "7E4 R 8", "7E4 00 00 00 00 00 00 00 00"}) {
    bench.hear(frame);
    EXPECT_TRUE(bench.master.busy()) << frame;
  }
  bench.hear("7E4 5A 93 00 00 00 00 00 00");
  EXPECT_FALSE(bench.master.busy());
  bench.hear("7E4 5A 94 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.value(), 0x93u);
}

TEST(LssMaster, GoesOnWithASequenceWhenTheBusHasRoomAgain) {
  MasterBench bench;
  bench.bus.room = 2;
  EXPECT_TRUE(bench.master.switch_state_selective(bench::rk5c_address, bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 40 93 00 00 00 00 00 00 | 7E5 41 52 4B 35 43 00 00 00");
  bench.hear("7E4 44 00 00 00 00 00 00 00");  // not the response that the master waits for
  EXPECT_TRUE(bench.master.busy());
  bench.bus.room = 10;
  EXPECT_EQ(bench.pass(50ms), "7E5 42 01 00 01 00 00 00 00 | 7E5 43 34 12 01 15 00 00 00");
  EXPECT_EQ(bench.master.next_deadline(), TimePoint{150ms});
  bench.hear("7E4 44 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
}

TEST(LssMaster, GivesUpWhenTheBusHasNoRoom) {
  MasterBench bench;
  bench.bus.room = 0;
  EXPECT_TRUE(bench.master.switch_state_global(LssState::configuration, bench.now));
  EXPECT_TRUE(bench.master.busy());
  bench.pass(100ms);
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer);
  bench.bus.room = 1;
  EXPECT_EQ(bench.pass(1s), "");
}

TEST(LssMaster, ScansBitByBit) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 51 00 00 00 00 80 00 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(200ms), "7E5 51 00 00 00 00 1F 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 00 1F 00 00");  // no response: it may be lost
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 80 1E 00 00");  // none again: bit 31 is 1
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 80 1D 00 00");
  for (int bit = 28; bit >= 0; --bit) bench.pass(40ms);
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FE FF FF BF 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FF FF FF BF 00 00 01");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 00 1F 01 01");
}

TEST(LssMaster, EndsAFastscanWhoseSlaveIsGone) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  bench.pass(200ms + 64 * 20ms + 20ms - 1us);  // the reset, 32 bits twice, and the complete number
  EXPECT_EQ(bench.pass(1us), "7E5 04 00 00 00 00 00 00 00 | 7E5 51 00 00 00 00 80 00 00") << "from the beginning";
  EXPECT_EQ(bench.pass(200ms), "7E5 51 00 00 00 00 80 00 00");
  bench.pass(200ms);
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer);
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 51 00 00 00 00 80 00 00");
}

TEST(LssMaster, AFastscanWithoutAnAnswerAsksTwice) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  EXPECT_FALSE(bench.master.fastscan(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 51 00 00 00 00 80 00 00");
  EXPECT_EQ(bench.pass(200ms), "7E5 51 00 00 00 00 80 00 00");
  EXPECT_EQ(bench.pass(200ms), "");
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer);
  EXPECT_FALSE(bench.master.next_deadline());
}

TEST(LssMaster, ChecksTheNumbersThatAreKnown) {
  MasterBench bench;
  EXPECT_FALSE(bench.master.fastscan(bench::rk5c_address, 5, bench.now));
  EXPECT_TRUE(bench.master.fastscan(bench::rk5c_address, 4, bench.now));
  std::string sent = bench.bus.take();
  for (int step = 0; step < 5; ++step) {
    bench.hear("7E4 4F 00 00 00 00 00 00 00");
    sent += " | " + bench.pass(step == 0 ? 200ms : 20ms);
  }
  EXPECT_EQ(sent,
            "7E5 51 00 00 00 00 80 00 00 | 7E5 51 93 00 00 00 00 00 01 | 7E5 51 52 4B 35 43 00 01 02 | "
            "7E5 51 01 00 01 00 00 02 03 | 7E5 51 34 12 01 15 00 03 00 | ");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
  EXPECT_EQ(bench.master.address(), bench::rk5c_address);
}

TEST(LssMaster, LooksForASlaveAboveAnAddress) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan_above({1, 2, 3, 0xFFFF'FFF5}, 3, bench.now));
  std::string sent = bench.bus.take();
  for (int step = 0; step < 4; ++step) {
    bench.hear("7E4 4F 00 00 00 00 00 00 00");
    sent += " | " + bench.pass(step == 0 ? 200ms : 20ms);
  }
  EXPECT_EQ(sent,
            "7E5 51 00 00 00 00 80 00 00 | 7E5 51 01 00 00 00 00 00 01 | 7E5 51 02 00 00 00 00 01 02 | "
            "7E5 51 03 00 00 00 00 02 03 | 7E5 51 F6 FF FF FF 01 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F6 FF FF FF 01 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F8 FF FF FF 03 03 03");  // no response: the next 0
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F8 FF FF FF 02 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F8 FF FF FF 02 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FC FF FF FF 01 03 03");  // no response: bit 2 is 1
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FC FF FF FF 00 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FC FF FF FF 00 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FD FF FF FF 00 03 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "");
  EXPECT_EQ(bench.master.outcome(), LssOutcome::done);
  EXPECT_EQ(bench.master.address(), (LssAddress{1, 2, 3, 0xFFFF'FFFD}));
}

TEST(LssMaster, FindsNothingAboveTheHighestAddress) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan_above({~0u, ~0u, ~0u, ~0u}, 0, bench.now));
  int steps = 0;
  while (bench.master.busy() && ++steps < 100) {
    bench.hear("7E4 4F 00 00 00 00 00 00 00");
    bench.pass(20ms);
  }
  EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer);
  EXPECT_LT(steps, 100);
}

// Slaves that respond late, and lost frames. The slave is written after CiA 305, figure "Fastscan".

struct SlowSlave {
  LssAddress address;
  std::deque<std::pair<TimePoint, int>> responses{};  ///< their times
  int position = 0;
  bool configuration = false;

  /// Returns whether it responds.
  bool on_request(const canopen::Frame& frame) {
    if (frame.data[0] == 0x04) configuration = frame.data[1] != 0;
    if (frame.data[0] != 0x51 || configuration) return false;
    const unsigned bit = frame.data[5], number = frame.data[6], next = frame.data[7];
    if (bit == 0x80) {
      position = 0;
      return true;
    }
    if (bit > 31 || static_cast<int>(number) != position) return false;
    const std::uint32_t own[] = {address.vendor_id, address.product_code, address.revision_number,
                                 address.serial_number};
    const std::uint32_t asked =
        static_cast<std::uint32_t>(frame.data[1]) | static_cast<std::uint32_t>(frame.data[2]) << 8 |
        static_cast<std::uint32_t>(frame.data[3]) << 16 | static_cast<std::uint32_t>(frame.data[4]) << 24;
    if ((own[number] >> bit) != (asked >> bit)) return false;
    if (bit == 0 && next < number) configuration = true;
    if (bit == 0) position = static_cast<int>(next);
    return true;
  }
};

/// Scans one slave whose response times and losses are those of `delay` (negative: lost).
template <class Delay>
LssOutcome scan_slow(const LssAddress& address, LssAddress& found, bool& selected, Delay delay) {
  MasterBench bench;
  SlowSlave slave{address};
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  const auto deliver = [&] {
    std::istringstream frames{bench.bus.take()};
    std::string line;
    while (std::getline(frames, line, '|')) {
      if (!slave.on_request(bench::frame(line))) continue;
      const int milliseconds = delay();
      if (milliseconds < 0) continue;
      TimePoint due = bench.now + std::chrono::milliseconds{milliseconds};
      if (!slave.responses.empty()) due = std::max(due, slave.responses.back().first);  // in order
      slave.responses.push_back({due, 0});
    }
  };
  deliver();
  for (int calls = 0; bench.master.busy() && calls < 2'000'000; ++calls) {
    bench.now = bench.now + 1ms;
    while (!slave.responses.empty() && slave.responses.front().first <= bench.now) {
      slave.responses.pop_front();
      bench.master.on_frame(bench::frame("7E4 4F 00 00 00 00 00 00 00"), bench.now);
    }
    if (bench.master.next_deadline() && *bench.master.next_deadline() <= bench.now) bench.master.on_time(bench.now);
    deliver();
  }
  found = bench.master.address();
  selected = slave.configuration;
  return bench.master.outcome();
}

TEST(LssMaster, FindsASlowSlave) {
  for (const int milliseconds : {0, 1, 15, 25, 40, 90, 150, 190}) {
    SCOPED_TRACE(milliseconds);
    LssAddress found;
    bool selected = false;
    EXPECT_EQ(scan_slow(bench::rk5c_address, found, selected, [&] { return milliseconds; }), LssOutcome::done);
    EXPECT_EQ(found, bench::rk5c_address);
    EXPECT_TRUE(selected);
  }
}

TEST(LssMaster, FindsASlaveWhoseResponseTimeVaries) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    LssAddress found;
    bool selected = false;
    const auto delay = [&] { return static_cast<int>(random() % 40); };
    EXPECT_EQ(scan_slow(bench::rk5c_address, found, selected, delay), LssOutcome::done);
    EXPECT_EQ(found, bench::rk5c_address);
    EXPECT_TRUE(selected);
  }
}

TEST(LssMaster, FindsASlaveOneOfWhoseResponsesIsLostOrVeryLate) {
  for (const int exception : {-1, 35, 60, 150}) {
    for (int which = 0; which < 80; which += 5) {
      SCOPED_TRACE(std::to_string(exception) + " " + std::to_string(which));
      LssAddress found;
      bool selected = false;
      int count = 0;
      const auto delay = [&] { return count++ == which ? exception : 2; };
      EXPECT_EQ(scan_slow(bench::rk5c_address, found, selected, delay), LssOutcome::done);
      EXPECT_EQ(found, bench::rk5c_address);
      EXPECT_TRUE(selected);
    }
  }
}

}  // namespace

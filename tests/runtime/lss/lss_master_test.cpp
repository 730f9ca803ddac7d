/// The services of the LSS master, frame by frame.
#include <gtest/gtest.h>

#include <canopen/lss/lss_master.hpp>
#include <string>

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
  EXPECT_TRUE(bench.master.configure_node_id(NodeId{0x80}, bench.now));
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
      {[](Master& m, TimePoint now) { return m.fastscan(now); }, 20ms},
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
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 00 1F 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 80 1E 00 00");  // no response: bit 31 is 1
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 80 1D 00 00");
  for (int bit = 28; bit >= 0; --bit) bench.pass(20ms);
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FF FF FF BF 00 00 01");
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 00 00 00 00 1F 01 01");
}

TEST(LssMaster, EndsAFastscanWhoseSlaveIsGone) {
  MasterBench bench;
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  bench.pass(34 * 20ms);  // the reset, 32 bits, and the complete number
  EXPECT_FALSE(bench.master.busy());
  EXPECT_EQ(bench.master.outcome(), LssOutcome::no_answer);
  EXPECT_TRUE(bench.master.fastscan(bench.now));
  EXPECT_EQ(bench.bus.take(), "7E5 51 00 00 00 00 80 00 00");
}

TEST(LssMaster, ChecksTheNumbersThatAreKnown) {
  MasterBench bench;
  EXPECT_FALSE(bench.master.fastscan(bench::rk5c_address, 5, bench.now));
  EXPECT_TRUE(bench.master.fastscan(bench::rk5c_address, 4, bench.now));
  std::string sent = bench.bus.take();
  for (int step = 0; step < 5; ++step) {
    bench.hear("7E4 4F 00 00 00 00 00 00 00");
    sent += " | " + bench.pass(20ms);
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
    sent += " | " + bench.pass(20ms);
  }
  EXPECT_EQ(sent,
            "7E5 51 00 00 00 00 80 00 00 | 7E5 51 01 00 00 00 00 00 01 | 7E5 51 02 00 00 00 00 01 02 | "
            "7E5 51 03 00 00 00 00 02 03 | 7E5 51 F6 FF FF FF 01 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F8 FF FF FF 03 03 03");  // no response: the next 0
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 F8 FF FF FF 02 03 03");
  EXPECT_EQ(bench.pass(20ms), "7E5 51 FC FF FF FF 01 03 03");  // no response: bit 2 is 1
  bench.hear("7E4 4F 00 00 00 00 00 00 00");
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

}  // namespace

/// Interpolated position (7) and cyclic synchronous position (8) with 60C2h: the axis is on the line between
/// set-points.
#include <gtest/gtest.h>

#include "every_mode_bench.hpp"

namespace {

using namespace std::chrono_literals;
namespace od = every_mode::od;
namespace mode = canopen::cia402::mode;

constexpr std::uint32_t device_state = 0x0800'0022;
constexpr unsigned interpolate = 0x1F;

struct InterpolatedPosition : testing::Test, bench::EveryMode<> {
  InterpolatedPosition() { enable(mode::interpolated_position); }
  std::uint32_t record(std::int32_t position) { return write(0x60C1, 1, position, 4); }
  /// RPDO 3 is synchronous: the record is applied with SYNC.
  void send(std::int32_t position) {
    canopen::Frame frame{.id = 0x405, .size = 4};
    for (unsigned i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(position >> (8 * i));
    drive.on_frame(frame, now);
  }
  [[nodiscard]] std::int32_t demand() { return axis().position_demand(); }
};

TEST_F(InterpolatedPosition, MovesOnTheLineBetweenTwoRecords) {  // 60C2h: 10 ms
  EXPECT_EQ(record(100), 0u);
  EXPECT_EQ(record(300), 0u);
  EXPECT_FALSE(bit(12));
  pass(50ms);
  EXPECT_EQ(demand(), 0) << "bit 4 is 0";
  control(interpolate);
  pass(1ms);
  EXPECT_TRUE(bit(12)) << "interpolation is active";
  EXPECT_FALSE(bit(10));
  for (int ms = 2; ms <= 20; ++ms) {
    pass(1ms);
    EXPECT_EQ(demand(), ms <= 10 ? 10 * ms : 100 + 20 * (ms - 10)) << ms;
  }
  pass(100ms);
  EXPECT_EQ(demand(), 300) << "the last one is held";
  EXPECT_TRUE(bit(10)) << "target reached";
}

TEST_F(InterpolatedPosition, KeepsAsManyRecordsAsItsBuffer) {  // 60C4h:02 = 4
  for (int i = 1; i <= 4; ++i) EXPECT_EQ(record(10 * i), 0u) << i;
  EXPECT_EQ(record(50), device_state) << "full";
  control(interpolate);
  pass(11ms);
  EXPECT_EQ(record(50), 0u) << "there is room again";
  pass(50ms);
  EXPECT_EQ(demand(), 50);
}

TEST_F(InterpolatedPosition, ClearsItsBuffer) {
  EXPECT_EQ(record(100), 0u);
  EXPECT_EQ(write(0x60C4, 6, 0, 1), 0u);
  EXPECT_EQ(record(200), device_state) << "disabled";
  control(interpolate);
  pass(2ms);
  EXPECT_EQ(write(0x60C4, 6, 1, 1), 0u);
  pass(50ms);
  EXPECT_EQ(demand(), 0);
  EXPECT_EQ(record(200), 0u);
  pass(20ms);
  EXPECT_EQ(demand(), 200);
}

TEST_F(InterpolatedPosition, TakesEqualRecordsOneByOne) {
  control(interpolate);
  for (const int position : {100, 100, 100, 200}) EXPECT_EQ(record(position), 0u);
  pass(30ms);
  EXPECT_EQ(demand(), 100);
  pass(10ms);
  EXPECT_EQ(demand(), 200);
}

TEST_F(InterpolatedPosition, BeginsAPeriodWithSync) {
  EXPECT_EQ(write(0x1006, 0, 10'000, 4), 0u);
  control(interpolate);
  for (int cycle = 1; cycle <= 20; ++cycle) {
    send(100 * cycle);
    ask("080");
    pass(5ms);
    EXPECT_EQ(demand(), 100 * cycle - 50) << cycle;
    pass(5ms);
    EXPECT_EQ(demand(), 100 * cycle) << cycle;
  }
  EXPECT_EQ(axis().velocity_demand(), 10'000);
  pass(20ms);
  EXPECT_EQ(demand(), 2'000) << "without SYNC, the position is held";
}

TEST_F(InterpolatedPosition, StaysOnTheLineIfSyncIsEarlyOrLate) {
  EXPECT_EQ(write(0x1006, 0, 10'000, 4), 0u);
  control(interpolate);
  std::int32_t before = 0;
  for (int cycle = 1; cycle <= 20; ++cycle) {
    send(100 * cycle);
    ask("080");
    pass(cycle % 2 == 0 ? 8ms : 12ms);
    EXPECT_GE(demand(), before) << cycle;
    EXPECT_LE(demand(), 100 * cycle) << cycle;
    before = demand();
  }
}

TEST_F(InterpolatedPosition, KeepsItsOwnTimeIfSyncIsNotItsPeriod) {
  control(interpolate);  // 1006h = 0
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(record(100 * i), 0u);
  for (int ms = 0; ms < 30; ++ms) {
    ask("080");
    pass(1ms);
  }
  EXPECT_EQ(demand(), 300);
}

TEST_F(InterpolatedPosition, EndsWithBit4AndInHalt) {
  control(interpolate);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(record(100 * i), 0u);
  pass(10ms);
  control(0x0F);
  pass(1ms);
  EXPECT_FALSE(bit(12));
  pass(50ms);
  EXPECT_EQ(demand(), 100);
  control(interpolate | 0x100);
  pass(50ms);
  EXPECT_FALSE(bit(12));
  EXPECT_EQ(demand(), 100);
}

TEST_F(InterpolatedPosition, KeepsToSoftwareLimits) {
  EXPECT_EQ(write(0x607D, 1, -150, 4), 0u);
  EXPECT_EQ(write(0x607D, 2, 150, 4), 0u);
  control(interpolate);
  for (const int position : {100, 200, -300}) EXPECT_EQ(record(position), 0u);
  pass(20ms);
  EXPECT_EQ(demand(), 150);
  EXPECT_TRUE(bit(11));
  pass(10ms);
  EXPECT_EQ(demand(), -150);
}

TEST_F(InterpolatedPosition, HasOtherUnitsOfTime) {
  EXPECT_EQ(write(0x60C2, 1, 200, 1), 0u);
  EXPECT_EQ(write(0x60C2, 2, -4, 1), 0u);  // 200 * 100 us
  control(interpolate);
  EXPECT_EQ(record(100), 0u);
  pass(10ms);
  EXPECT_EQ(demand(), 50);
}

TEST(CyclicPosition, IsOnTheWayToItsTargetDuringThePeriod) {
  bench::EveryMode<> drive;
  drive.enable(mode::cyclic_synchronous_position);
  EXPECT_EQ(drive.write(0x607A, 0, 100, 4), 0u);
  drive.pass(5ms);
  EXPECT_EQ(drive.axis().position_demand(), 50);
  drive.pass(5ms);
  EXPECT_EQ(drive.axis().position_demand(), 100);
  drive.pass(5ms);
  EXPECT_EQ(drive.axis().position(), 100);
}

}  // namespace

/// The master's side of a drive. Statuswords and controlwords: CiA 402-2, tables of the state machine
/// (7.2, 8.4.1, 8.4.2).
#include <gtest/gtest.h>
#include <canopen/profile/cia402_master.hpp>

#include "cia402_bench.hpp"

namespace {

using bench::DriveBench;
using canopen::cia402::DriveCommander;
using canopen::cia402::DriveTarget;
using canopen::cia402::State;
using canopen::cia402::state_of;
namespace controlword = canopen::cia402::controlword;
namespace od = cia402_drive::od;

TEST(DriveCommander, ReadsTheStateWhateverTheOtherBitsAre) {
  struct Row {
    std::uint16_t mask, value;  // of the table of the standard, "x" not in the mask
    State state;
  };
  constexpr Row rows[] = {
      {0x4F, 0x00, State::not_ready_to_switch_on}, {0x4F, 0x40, State::switch_on_disabled},
      {0x6F, 0x21, State::ready_to_switch_on},     {0x6F, 0x23, State::switched_on},
      {0x6F, 0x27, State::operation_enabled},      {0x6F, 0x07, State::quick_stop_active},
      {0x4F, 0x0F, State::fault_reaction_active},  {0x4F, 0x08, State::fault},
  };
  for (std::uint32_t word = 0; word <= 0xFFFF; ++word) {
    std::optional<State> expected;
    for (const Row& row : rows) {
      if ((word & row.mask) == row.value) expected = row.state;
    }
    ASSERT_EQ(state_of(static_cast<std::uint16_t>(word)), expected) << word;
  }
}

TEST(DriveCommander, EnablesStepByStep) {
  DriveCommander axis;
  EXPECT_EQ(axis.next(0x0250), 0x00) << "nothing is wanted";
  axis.enable();
  EXPECT_EQ(axis.next(0x0200), 0x00) << "not ready to switch on";
  EXPECT_EQ(axis.next(0x0250), 0x06);
  EXPECT_EQ(axis.next(0x0231), 0x07);
  EXPECT_EQ(axis.next(0x0233), 0x0F);
  EXPECT_FALSE(axis.is_enabled());
  EXPECT_EQ(axis.next(0x0237), 0x0F);
  EXPECT_TRUE(axis.is_enabled());
  EXPECT_EQ(axis.next(0x0217), 0x0F) << "quick stop active: transition 16";
}

TEST(DriveCommander, LeavesOperationAsItIsTold) {
  DriveCommander axis;
  axis.request(DriveTarget::switched_on);
  EXPECT_EQ(axis.next(0x0237), 0x07) << "transition 5";
  EXPECT_EQ(axis.next(0x0233), 0x07);
  axis.request(DriveTarget::ready);
  EXPECT_EQ(axis.next(0x0237), 0x06) << "transition 8";
  axis.request(DriveTarget::voltage_off);
  EXPECT_EQ(axis.next(0x0237), 0x00) << "transition 9";
  axis.request(DriveTarget::quick_stopped);
  EXPECT_EQ(axis.next(0x0237), 0x02) << "transition 11";
  EXPECT_EQ(axis.next(0x0217), 0x02) << "it stays";
}

TEST(DriveCommander, ResetsAFaultWithOneEdgeAndDoesNotEnableByItself) {
  DriveCommander axis;
  axis.enable();
  EXPECT_EQ(axis.next(0x021F), 0x00) << "fault reaction active";
  EXPECT_EQ(axis.next(0x0218), 0x00);
  axis.reset_fault();
  EXPECT_EQ(axis.next(0x0218), 0x80);
  EXPECT_EQ(axis.next(0x0218), 0x00) << "the cause is present: another edge needs another request";
  axis.reset_fault();
  EXPECT_EQ(axis.next(0x0218), 0x80);
  EXPECT_EQ(axis.next(0x0250), 0x00) << "the wish for power has ended with the fault";
  axis.enable();
  EXPECT_EQ(axis.next(0x0250), 0x06);
}

TEST(DriveCommander, HaltsAndSendsBitsOfTheModeWhileEnabled) {
  DriveCommander axis;
  axis.enable();
  axis.halt(true);
  axis.set_mode_bits(controlword::start_homing);
  EXPECT_EQ(axis.next(0x0233), 0x0F);
  EXPECT_EQ(axis.next(0x0237), 0x11F);
  axis.halt(false);
  axis.set_mode_bits(0);
  EXPECT_EQ(axis.next(0x0237), 0x0F);
}

TEST(DriveCommander, WaitsForTheAcknowledgementOfASetPoint) {
  DriveCommander axis;
  axis.enable();
  axis.start_set_point(controlword::relative);
  EXPECT_EQ(axis.next(0x1237), 0x0F) << "the set-point before is still acknowledged";
  EXPECT_EQ(axis.next(0x0237), 0x5F);
  EXPECT_EQ(axis.next(0x0237), 0x5F) << "an acknowledgement may take its time";
  EXPECT_EQ(axis.next(0x1237), 0x0F);
  EXPECT_TRUE(axis.set_point_is_pending());
  EXPECT_EQ(axis.next(0x0237), 0x0F);
  EXPECT_FALSE(axis.set_point_is_pending());
  axis.start_set_point();
  EXPECT_EQ(axis.next(0x0218), 0x00) << "a fault withdraws it";
  EXPECT_FALSE(axis.set_point_is_pending());
}

TEST(DriveCommander, MovesADriveOfTheProfile) {
  DriveBench drive;
  DriveCommander axis;
  drive.set<od::modes_of_operation>(canopen::cia402::mode::profile_position);
  axis.enable();
  for (int i = 0; i < 5 && !axis.is_enabled(); ++i) drive.control(axis.next(drive.statusword()));
  ASSERT_EQ(drive.state(), State::operation_enabled);

  axis.start_set_point();
  for (int i = 0; i < 3; ++i) {
    drive.control(axis.next(drive.statusword()), 5'000);
    drive.pass(std::chrono::milliseconds{10});
  }
  EXPECT_FALSE(axis.set_point_is_pending());
  drive.pass(std::chrono::seconds{20});
  EXPECT_EQ(drive.position(), 5'000);

  axis.request(DriveTarget::voltage_off);
  drive.control(axis.next(drive.statusword()));
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
}

}  // namespace

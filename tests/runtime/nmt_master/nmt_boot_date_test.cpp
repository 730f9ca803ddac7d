/// What an NMT master checks before it configures a slave: the software, and date and time of the configuration; and
/// the restoring of default values. Expected frames: CiA 302-2, figures "check software version", "check configuration"
/// and "restore configuration", with the SDO frames of CiA 301.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>

#include <string>
#include <vector>

#include "nmt_boot_bench.hpp"
#include "support/bench.hpp"

namespace {

using boot_bench::Desk;
using boot_bench::device_type;
using boot_bench::slave;
using canopen::AbortCode;
using canopen::BootResult;
using canopen::BootStatus;
using canopen::NmtSlave;
using canopen::NodeId;
namespace assignment = canopen::slave_assignment;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

constexpr std::uint8_t small_dcf[] = {1, 0, 0, 0, 0x01, 0x20, 0, 1, 0, 0, 0, 0x2A};  // 2001h:00 = 42

constexpr auto asks_device_type = "605 40 00 10 00 00 00 00 00";
constexpr auto asks_software = "605 40 56 1F 01 00 00 00 00";
constexpr auto asks_date = "605 40 20 10 01 00 00 00 00";
constexpr auto asks_time = "605 40 20 10 02 00 00 00 00";
constexpr auto writes_dcf = "605 2F 01 20 00 2A 00 00 00";
constexpr auto dcf_written = "585 60 01 20 00 00 00 00 00";
constexpr auto reads_dcf = "605 40 01 20 00 00 00 00 00";
constexpr auto dcf_read = "585 4F 01 20 00 2A 00 00 00";

/// 2026-11-24 is day 15668 (3D34h) since 1984-01-01; 12:00 is 43,200,000 ms (0293 2E00h).
NmtSlave dated() {
  NmtSlave result = slave(5);
  result.configuration_date = 15'668;
  result.configuration_time = 43'200'000;
  result.concise_dcf = small_dcf;
  return result;
}

constexpr auto same_date = "585 43 20 10 01 34 3D 00 00";
constexpr auto same_time = "585 43 20 10 02 00 2E 93 02";

/// Boots node 5 up to the response with its device type; returns the next frame of the master.
std::string identify(Desk& desk) {
  desk.start();
  EXPECT_EQ(desk.take("705 00"), asks_device_type);
  return desk.take(device_type);
}

// Date and time

TEST(NmtBoot, ASlaveWithTheExpectedDateAndTimeIsNotConfigured) {
  Desk desk{{dated()}};
  EXPECT_EQ(identify(desk), asks_date);
  EXPECT_EQ(desk.take(same_date), asks_time);
  EXPECT_FALSE(desk.master.configuration_is_current(NodeId{5}));
  EXPECT_EQ(desk.take(same_time), reads_dcf);
  EXPECT_EQ(desk.take(dcf_read), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"})) << "what the application sets at each boot-up";
  EXPECT_TRUE(desk.master.configuration_is_current(NodeId{5}));
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.pass(20ms), "000 01 05");
}

TEST(NmtBoot, ASlaveWithAnotherDateOrTimeIsConfigured) {
  for (const auto& [date, time] :
       {std::pair{"585 43 20 10 01 33 3D 00 00", ""}, std::pair{same_date, "585 43 20 10 02 01 2E 93 02"},
        std::pair{"585 80 20 10 01 00 00 02 06", ""},  // without 1020h
        std::pair{same_date, "585 80 20 10 02 11 00 09 06"}}) {
    SCOPED_TRACE(date);
    Desk desk{{dated()}};
    EXPECT_EQ(identify(desk), asks_date);
    std::string next = desk.take(date);
    if (*time != 0) {
      EXPECT_EQ(next, asks_time);
      next = desk.take(time);
    }
    EXPECT_EQ(next, writes_dcf);
    EXPECT_EQ(desk.take(dcf_written), reads_dcf);
    EXPECT_EQ(desk.take(dcf_read), "");
    EXPECT_FALSE(desk.master.configuration_is_current(NodeId{5}));
    EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"}));
  }
}

TEST(NmtBoot, DateAndTimeAreComparedOnlyIfTheListHasBoth) {
  NmtSlave without_time = dated();
  without_time.configuration_time = 0;
  Desk desk{{without_time}};
  EXPECT_EQ(identify(desk), writes_dcf);
}

TEST(NmtBoot, ASlaveThatLosesItsConfigurationIsConfiguredAtItsNextBootUp) {
  Desk desk{{dated()}};
  identify(desk);
  desk.take(same_date);
  desk.take(same_time);
  desk.take(dcf_read);
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  desk.pass(20ms);
  EXPECT_EQ(desk.take("705 00"), asks_device_type);
  EXPECT_EQ(desk.take(device_type), asks_date);
  EXPECT_EQ(desk.take("585 43 20 10 01 00 00 00 00"), writes_dcf) << "a changed parameter sets 1020h to 0";
  EXPECT_FALSE(desk.master.configuration_is_current(NodeId{5}));
}

// Default values

NmtSlave restored(std::uint8_t parameters) {
  NmtSlave result = slave(5);
  result.assignment |= assignment::restore;
  result.restored_parameters = parameters;
  result.concise_dcf = small_dcf;
  return result;
}

TEST(NmtBoot, RestoresTheDefaultValuesOnceAndConfiguresAfterTheReset) {
  Desk desk{{restored(1)}};
  EXPECT_EQ(identify(desk), "605 23 11 10 01 6C 6F 61 64") << "\"load\"";
  EXPECT_EQ(desk.take("585 60 11 10 01 00 00 00 00"), "000 81 05") << "restored with the reset";
  EXPECT_EQ(desk.take("705 00"), asks_device_type);
  EXPECT_EQ(desk.take(device_type), writes_dcf);
  EXPECT_EQ(desk.take(dcf_written), reads_dcf);
  EXPECT_EQ(desk.take(dcf_read), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 boot-up", "5 configure"}));
  EXPECT_EQ(desk.take("705 00"), asks_device_type);
  EXPECT_EQ(desk.take(device_type), "605 23 11 10 01 6C 6F 61 64") << "again with the next boot-up";
}

TEST(NmtBoot, RestoredCommunicationParametersNeedAResetOfTheCommunicationOnly) {
  Desk desk{{restored(2)}};
  EXPECT_EQ(identify(desk), "605 23 11 10 02 6C 6F 61 64");
  EXPECT_EQ(desk.take("585 60 11 10 02 00 00 00 00"), "000 82 05");
}

TEST(NmtBoot, NothingIsRestoredWithoutTheBitOrWithoutASubIndex) {
  Desk without_sub_index{{restored(0)}};
  EXPECT_EQ(identify(without_sub_index), writes_dcf);
  NmtSlave without_bit = restored(1);
  without_bit.assignment &= ~assignment::restore;
  Desk desk{{without_bit}};
  EXPECT_EQ(identify(desk), writes_dcf);
}

TEST(NmtBoot, ACurrentConfigurationIsNotRestored) {
  NmtSlave both = dated();
  both.assignment |= assignment::restore;
  both.restored_parameters = 1;
  Desk desk{{both}};
  EXPECT_EQ(identify(desk), asks_date);
  desk.take(same_date);
  EXPECT_EQ(desk.take(same_time), reads_dcf);
  EXPECT_EQ(desk.take(dcf_read), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"}));
}

TEST(NmtBoot, ASlaveThatRefusesToRestoreIsNotBooted) {
  Desk desk{{restored(1)}};
  identify(desk);
  EXPECT_EQ(desk.take("585 80 11 10 01 20 00 00 08"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 J"}));
  const BootResult& result = desk.told.results.back();
  EXPECT_EQ(result.index, 0x1011);
  EXPECT_EQ(result.sub_index, 1);
  EXPECT_EQ(result.abort_code, AbortCode::not_stored);
}

TEST(NmtBoot, ASlaveWhoseBootUpMessageIsMissingAfterTheRestoreIsConfigured) {
  Desk desk{{restored(1)}};
  identify(desk);
  desk.take("585 60 11 10 01 00 00 00 00");
  EXPECT_EQ(desk.pass(999ms), "");
  EXPECT_EQ(desk.pass(1ms), asks_device_type);
  EXPECT_EQ(desk.take(device_type), writes_dcf);
}

TEST(NmtBoot, ARestoreThatAFailureHasOvertakenIsRepeated) {
  NmtSlave with_product = restored(1);
  with_product.product_code = 7;
  Desk desk{{with_product}};
  identify(desk);
  desk.take("585 43 18 10 02 07 00 00 00");
  EXPECT_EQ(desk.take("585 60 11 10 01 00 00 00 00"), "000 81 05");
  desk.take("705 00");
  desk.take(device_type);
  desk.take("585 43 18 10 02 08 00 00 00");
  EXPECT_EQ(desk.log().back(), "5 M") << "another device in its place";
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.take("585 43 18 10 02 07 00 00 00"), "605 23 11 10 01 6C 6F 61 64");
}

// Software

NmtSlave with_software(std::uint32_t bits) {
  NmtSlave result = slave(5);
  result.assignment |= assignment::software_version | bits;
  result.software = 0x0001'0203;
  return result;
}

TEST(NmtBoot, ComparesTheSoftwareBeforeTheConfiguration) {
  Desk desk{{with_software(0)}};
  EXPECT_EQ(identify(desk), asks_software);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up"}));
  EXPECT_EQ(desk.take("585 43 56 1F 01 03 02 01 00"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 configure"}));
}

TEST(NmtBoot, TellsWhyASlaveWithAnotherSoftwareIsNotBooted) {
  struct Row {
    std::uint32_t bits;
    const char* letter;
  };
  // The letters of CiA 302-2. A node to be kept alive is not updated.
  for (const Row& row : {Row{0, "5 H"}, Row{assignment::software_update, "5 I"},
                         Row{assignment::software_update | assignment::keep_alive, "5 H"}}) {
    SCOPED_TRACE(row.bits);
    Desk desk{{with_software(row.bits)}};
    desk.master.start(desk.now);
    desk.bus.take();
    desk.take("705 00");
    EXPECT_EQ(desk.take(device_type), asks_software);
    EXPECT_EQ(desk.take("585 43 56 1F 01 04 02 01 00"), "");
    EXPECT_EQ(desk.log(), (Lines{"5 boot-up", row.letter}));
    const BootResult& result = desk.told.results.back();
    EXPECT_EQ(result.index, 0x1F56);
    EXPECT_EQ(result.sub_index, 1);
    EXPECT_EQ(result.expected, 0x0001'0203u);
    EXPECT_EQ(result.seen, 0x0001'0204u);
    EXPECT_FALSE(desk.master.network_started());
  }
}

TEST(NmtBoot, TellsThatTheSoftwareCannotBeCompared) {
  Desk unreadable{{with_software(assignment::software_update)}};
  identify(unreadable);
  unreadable.take("585 80 56 1F 01 00 00 02 06");
  EXPECT_EQ(unreadable.log(), (Lines{"5 boot-up", "5 G"}));
  EXPECT_EQ(unreadable.told.results.back().abort_code, AbortCode::no_object);

  NmtSlave without_value = with_software(0);
  without_value.software = 0;
  Desk desk{{without_value}};
  EXPECT_EQ(identify(desk), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 G"}));
  EXPECT_EQ(desk.told.results.back().status, BootStatus::software_unknown);
}

TEST(NmtBoot, ASlaveWithUpdatedSoftwareIsBootedAgain) {
  Desk desk{{with_software(assignment::software_update)}};
  identify(desk);
  desk.take("585 43 56 1F 01 04 02 01 00");
  EXPECT_EQ(desk.log().back(), "5 I");
  desk.master.boot(NodeId{5}, desk.now);  // the application has updated it
  EXPECT_EQ(desk.bus.take(), "000 82 05");
  EXPECT_EQ(desk.take("705 00"), asks_device_type);
  EXPECT_EQ(desk.take(device_type), asks_software);
  desk.take("585 43 56 1F 01 03 02 01 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"}));
}

// Silence and a full bus

TEST(NmtBoot, ASlaveThatIsSilentInAnyOfTheseStepsIsAskedAgain) {
  NmtSlave all = dated();
  all.assignment |= assignment::software_version | assignment::restore;
  all.software = 1;
  all.restored_parameters = 1;
  const Lines answers{device_type, "585 43 56 1F 01 01 00 00 00", same_date, "585 43 20 10 02 00 00 00 00"};
  for (std::size_t silent_after = 1; silent_after <= answers.size(); ++silent_after) {
    SCOPED_TRACE(silent_after);
    Desk desk{{all}};
    desk.start();
    desk.take("705 00");
    for (std::size_t i = 0; i < silent_after; ++i) desk.take(answers[i]);
    EXPECT_NE(desk.pass(150ms).find("605 80"), std::string::npos) << "the transfer is aborted";
    EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 B"}));
    EXPECT_NE(desk.pass(1s).find(asks_device_type), std::string::npos);
  }
}

}  // namespace

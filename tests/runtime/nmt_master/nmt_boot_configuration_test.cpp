/// The configuration of slaves while an NMT master boots them: by the application and by a concise DCF.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>

#include <array>
#include <string>
#include <vector>

#include "nmt_boot_bench.hpp"
#include "support/bench.hpp"

namespace {

using boot_bench::Desk;
using boot_bench::device_type;
using boot_bench::slave;
using boot_bench::Transfer;
using canopen::AbortCode;
using canopen::NmtSlave;
using canopen::NodeId;
using canopen::SdoAnswer;
using canopen::SdoRequest;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

TEST(NmtBoot, TheApplicationConfiguresBeforeErrorControl) {
  Desk desk{{slave(5, 100)}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"}));
  EXPECT_EQ(desk.pass(10s), "") << "it takes the time that it takes";

  Transfer first, second;
  const std::array<std::uint8_t, 2> value{0x12, 0x34};
  EXPECT_TRUE(desk.master.request(NodeId{5}, first.write(0x2001, 0, value), desk.now));
  EXPECT_TRUE(desk.master.request(NodeId{5}, second.write(0x2002, 0, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2B 01 20 00 12 34 00 00") << "one after the other";
  EXPECT_EQ(desk.take("585 60 01 20 00 00 00 00 00"), "605 2B 02 20 00 12 34 00 00");
  EXPECT_EQ(desk.take("585 60 02 20 00 00 00 00 00"), "");
  EXPECT_EQ(first.result, canopen::ok);
  EXPECT_EQ(second.result, canopen::ok);

  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.bus.take(), "605 40 17 10 00 00 00 00 00");
  desk.take("585 4B 17 10 00 32 00 00 00");
  EXPECT_EQ(desk.beat(5, 50ms), "000 01 05");
  EXPECT_EQ(desk.log(), (Lines{"5 0", "network started"}));
}

TEST(NmtBoot, AFailedConfigurationEndsTheBootUp) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.master.configured(NodeId{5}, AbortCode::value_too_high, desk.now);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 J"}));
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::value_too_high);
  EXPECT_EQ(desk.pass(10s), "");
  EXPECT_FALSE(desk.master.network_started());
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00") << "until it boots up again";
}

TEST(NmtBoot, AConfigurationThatABootUpHasOvertakenDoesNotCount) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.bus.take(), "");
  desk.take(device_type);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 boot-up", "5 r", "5 configure"}));
}

constexpr std::uint8_t dcf[] = {2,    0,    0, 0,                                     // two entries
                                0x0C, 0x20, 0, 5, 0, 0, 0, 'h',  'e', 'l', 'l', 'o',  // 200Ch: a string
                                0x17, 0x10, 0, 2, 0, 0, 0, 0x32, 0};                  // 1017h = 50

TEST(NmtBoot, WritesTheConciseDcfBeforeTheApplicationConfigures) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.take("585 60 0C 20 00 00 00 00 00"), "605 05 68 65 6C 6C 6F 00 00");
  EXPECT_EQ(desk.take("585 20 00 00 00 00 00 00 00"), "605 2B 17 10 00 32 00 00 00");
  EXPECT_EQ(desk.take("585 60 17 10 00 00 00 00 00"), "605 40 0C 20 00 00 00 00 00") << "it is read back";
  EXPECT_EQ(desk.take("585 41 0C 20 00 05 00 00 00"), "605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(desk.take("585 05 68 65 6C 6C 6F 00 00"), "605 40 17 10 00 00 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up"}));
  EXPECT_EQ(desk.take("585 4B 17 10 00 32 00 00 00"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 configure"}));
}

TEST(NmtBoot, TellsWhichEntryOfTheConciseDcfWasRefused) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.take("585 80 0C 20 00 12 00 07 06"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 J"}));
  EXPECT_EQ(desk.told.results.back().index, 0x200C);
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::length_too_high);
}

TEST(NmtBoot, RefusesAConciseDcfThatIsShorterThanItSays) {
  for (std::size_t size = 1; size < std::size(dcf); ++size) {
    NmtSlave with_dcf = slave(5);
    with_dcf.concise_dcf = std::span{dcf}.first(size);
    Desk desk{{with_dcf}};
    desk.start();
    desk.take("705 00");
    desk.take(device_type);
    desk.take("585 60 0C 20 00 00 00 00 00");
    desk.take("585 20 00 00 00 00 00 00 00");
    desk.take("585 60 17 10 00 00 00 00 00");
    EXPECT_EQ(desk.log().back(), "5 J") << size;
    EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::length_mismatch) << size;
  }
}

TEST(NmtBoot, TheBootUpGoesOnWhenASlaveIsSilentInTheMiddle) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.pass(100ms), "605 80 0C 20 00 00 00 04 05");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 B"}));
  EXPECT_EQ(desk.told.results.back().index, 0x200C);
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::timeout);
  EXPECT_EQ(desk.pass(1s), "000 80 05 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
}

/// A transfer that configures a slave: its end is the end of the configuration.
struct Configuration {
  static void done(void* context, NodeId node_id, const SdoAnswer& answer) {
    auto& desk = *static_cast<Desk*>(context);
    desk.master.configured(node_id, answer.result, desk.now);
  }
  static SdoRequest write(Desk& desk, std::uint16_t index, std::span<const std::uint8_t> bytes) {
    SdoRequest request;
    request.index = index;
    request.download = true;
    request.bytes = bytes;
    request.done = done;
    request.context = &desk;
    return request;
  }
};

TEST(NmtBoot, AConfigurationThatABootUpEndsHasNotFailed) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  const std::array<std::uint8_t, 1> value{1};
  EXPECT_TRUE(desk.master.request(NodeId{5}, Configuration::write(desk, 0x2001, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2F 01 20 00 01 00 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 01 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 boot-up", "5 r"}));
  desk.take(device_type);
  EXPECT_TRUE(desk.master.request(NodeId{5}, Configuration::write(desk, 0x2001, value), desk.now));
  desk.take("585 60 01 20 00 00 00 00 00");
  desk.pass(20ms);
  EXPECT_EQ(desk.log(),
            (Lines{"5 configure", "5 0", "5 not watched: no heartbeat time and no guard time in the network list",
                   "network started"}));
}

TEST(NmtBoot, ABootUpInTheMiddleOfTheConciseDcfBeginsItAnew) {
  NmtSlave listed = slave(5);
  listed.concise_dcf = dcf;
  Desk desk{{listed}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.take("585 60 0C 20 00 00 00 00 00"), "605 05 68 65 6C 6C 6F 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 0C 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take("585 20 00 00 00 00 00 00 00"), "") << "to the last segment before the reset";
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 boot-up", "5 r"}));
}

}  // namespace

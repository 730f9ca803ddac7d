/// Block downloads of an SDO server.
#include <gtest/gtest.h>

#include <array>

#include "counting.hpp"
#include "sdo_bench.hpp"

namespace {

using bench::counting;
using bench::crc_text;
using bench::SdoBench;
using canopen::AbortCode;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(SdoBlockDownload, TakesAStringWithItsCrc) {
  SdoBench device;
  EXPECT_EQ(device.ask("C6 0C 20 00 0D 00 00 00"), "A4 0C 20 00 7F 00 00 00");
  EXPECT_EQ(device.ask("01 53 61 6D 70 6C 65 20"), "");
  EXPECT_EQ(device.ask("82 64 65 76 69 63 65 00"), "A2 02 7F 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");
  EXPECT_EQ(device.ask("C5 61 AE 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "Sample device");
}

TEST(SdoBlockDownload, TakesItWithoutSizeAndCrcAsWell) {
  SdoBench device;
  EXPECT_EQ(device.ask("C0 0C 20 00 00 00 00 00"), "A4 0C 20 00 7F 00 00 00");
  EXPECT_EQ(device.ask("81 48 69 00 00 00 00 00"), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "Hi");
}

TEST(SdoBlockDownload, TakesNumbers) {
  SdoBench device;
  device.ask("C2 17 10 00 02 00 00 00");
  device.ask("81 E8 03 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(device.store.get<od::producer_heartbeat_time>()), 1000);
  device.ask("C2 07 20 00 08 00 00 00");
  device.ask("01 FE FF FF FF FF FF FF");
  device.ask("82 FF 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("D9 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::integer64_value>(), -2);
}

TEST(SdoBlockDownload, TakesAnEmptyString) {
  SdoBench device;
  device.ask("C6 0C 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("81 00 00 00 00 00 00 00"), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("DD 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "");
}

TEST(SdoBlockDownload, FillsADomainToItsLastByteAndNotBeyond) {
  SdoBench device;
  std::array<std::uint8_t, 10> memory{};
  memory.back() = 0xEE;
  device.bind<od::parameter_file>(std::span{memory}.first(9), 9);
  device.ask("C6 12 20 00 09 00 00 00");
  EXPECT_EQ(device.store.get<od::parameter_file>().size, 0u);
  device.ask("01 01 02 03 04 05 06 07");
  device.ask("82 08 09 FF FF FF FF FF");
  EXPECT_EQ(device.ask("D5 " + crc_text(counting<9>()) + " 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(memory, (std::array<std::uint8_t, 10>{1, 2, 3, 4, 5, 6, 7, 8, 9, 0xEE}));
  EXPECT_EQ(device.store.get<od::parameter_file>().size, 9u);
}

TEST(SdoBlockDownload, ConfirmsTheLastSegmentBeforeALostOne) {
  SdoBench device;
  device.ask("C2 0C 20 00 10 00 00 00");
  device.ask("01 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("83 4F 50 00 00 00 00 00"), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("01 48 49 4A 4B 4C 4D 4E"), "");
  EXPECT_EQ(device.ask("01 48 49 4A 4B 4C 4D 4E"), "");  // twice
  EXPECT_EQ(device.ask("82 4F 50 00 00 00 00 00"), "A2 02 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "ABCDEFGHIJKLMNOP");
}

TEST(SdoBlockDownload, ConfirmsNothingWhenTheFirstSegmentWasLost) {
  SdoBench device;
  device.ask("C2 0C 20 00 10 00 00 00");
  EXPECT_EQ(device.ask("02 48 49 4A 4B 4C 4D 4E"), "");
  EXPECT_EQ(device.ask("83 4F 50 00 00 00 00 00"), "A2 00 7F 00 00 00 00 00");
}

TEST(SdoBlockDownload, ConfirmsASubBlockOf127Segments) {
  SdoBench device;
  std::array<std::uint8_t, 1000> memory{};
  device.bind<od::parameter_file>(memory, 0);
  device.ask("C2 12 20 00 80 03 00 00");  // 128 * 7 bytes
  for (unsigned i = 1; i < 127; ++i) {
    canopen::sdo::Data segment{};
    segment.fill(static_cast<std::uint8_t>(i));
    EXPECT_EQ(device.ask(bench::text_of(segment)), "");
  }
  EXPECT_EQ(device.ask("7F 7F 7F 7F 7F 7F 7F 7F"), "A2 7F 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("81 AA AA AA AA AA AA AA"), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("C1 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::parameter_file>().size, 896u);
  EXPECT_EQ(memory[7 * 127 - 1], 0x7F);
  EXPECT_EQ(memory[7 * 127], 0xAA);
}

TEST(SdoBlockDownload, TakesSegmentsWhoseFirstByteLooksLikeACommand) {
  SdoBench device;
  std::array<std::uint8_t, 1000> memory{};
  device.bind<od::parameter_file>(memory, 0);
  device.ask("C0 12 20 00 00 00 00 00");
  for (unsigned i = 1; i <= 0x60; ++i)
    device.ask(bench::text_of({static_cast<std::uint8_t>(i)}));  // 40h, 60h among them
  EXPECT_EQ(device.ask("E1 00 00 00 00 00 00 00"), "A2 61 7F 00 00 00 00 00");
}

TEST(SdoBlockDownload, RefusesAWrongCrcAndStoresNothing) {
  SdoBench device;
  device.ask("C6 0C 20 00 02 00 00 00");
  device.ask("81 48 69 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "80 0C 20 00 04 00 04 05");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");

  std::array<std::uint8_t, 9> memory{};
  device.bind<od::parameter_file>(memory, 9);
  device.ask("C6 12 20 00 02 00 00 00");
  device.ask("81 48 69 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 01 00 00 00 00 00 00"), "80 12 20 00 04 00 04 05");
  EXPECT_EQ(device.store.get<od::parameter_file>().size, 0u);
}

TEST(SdoBlockDownload, RefusesTheSequenceNumberZero) {
  SdoBench device;
  device.ask("C2 0C 20 00 10 00 00 00");
  EXPECT_EQ(device.ask("00 41 42 43 44 45 46 47"), "80 0C 20 00 03 00 04 05");
}

TEST(SdoBlockDownload, RefusesSizesThatLie) {
  SdoBench device;
  EXPECT_EQ(device.ask("C2 0C 20 00 11 00 00 00"), "80 0C 20 00 12 00 07 06");  // 17 characters, 16 at most
  EXPECT_EQ(device.ask("C2 02 20 00 01 00 00 00"), "80 02 20 00 13 00 07 06");

  device.ask("C2 0C 20 00 06 00 00 00");  // more than announced, in a segment that is not the last
  EXPECT_EQ(device.ask("01 41 42 43 44 45 46 47"), "80 0C 20 00 12 00 07 06");
  device.ask("C2 0C 20 00 06 00 00 00");  // more than announced, in the last one
  device.ask("81 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("C1 00 00 00 00 00 00 00"), "80 0C 20 00 12 00 07 06");
  device.ask("C2 0C 20 00 06 00 00 00");  // less than announced
  device.ask("81 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("C9 00 00 00 00 00 00 00"), "80 0C 20 00 10 00 07 06");
  device.ask("C0 02 20 00 00 00 00 00");  // less than the object needs
  device.ask("81 41 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("D9 00 00 00 00 00 00 00"), "80 02 20 00 13 00 07 06");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoBlockDownload, RefusesWhatAnyDownloadRefuses) {
  SdoBench device;
  EXPECT_EQ(device.ask("C6 04 10 00 02 00 00 00"), "80 04 10 00 00 00 02 06");
  EXPECT_EQ(device.ask("C6 00 10 00 04 00 00 00"), "80 00 10 00 02 00 01 06");
  EXPECT_EQ(device.ask("C6 12 20 00 04 00 00 00"), "80 12 20 00 20 00 00 08");
  device.refuse = [](auto, auto) { return AbortCode::device_state; };
  device.ask("C2 0C 20 00 02 00 00 00");
  device.ask("81 48 69 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "80 0C 20 00 22 00 00 08");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoBlockDownload, EndsWithAnAbortOfTheClientAmongTheSegments) {
  SdoBench device;
  std::array<std::uint8_t, 9> memory{};
  device.bind<od::parameter_file>(memory, 9);
  device.ask("C6 12 20 00 09 00 00 00");
  device.ask("01 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("80 12 20 00 00 00 00 08"), "");
  EXPECT_EQ(device.store.get<od::parameter_file>().size, 0u);
  EXPECT_EQ(device.ask("40 00 10 00 00 00 00 00"), "43 00 10 00 91 01 0F 00");
}

TEST(SdoBlockDownload, ANewInitiateReplacesItWhenItsSegmentsAreThere) {
  SdoBench device;
  device.ask("C6 0C 20 00 02 00 00 00");
  device.ask("81 48 69 00 00 00 00 00");
  EXPECT_EQ(device.ask("40 00 10 00 00 00 00 00"), "43 00 10 00 91 01 0F 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");
}

// Time-outs

struct WithTimeout : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true, .sdo_timeout = 1000};
};

TEST(SdoBlockDownload, ConfirmsWhatHasComeOfASubBlockWhoseEndIsOverdue) {
  SdoBench<WithTimeout> device;
  device.ask("C2 0C 20 00 10 00 00 00");
  device.ask("01 41 42 43 44 45 46 47");
  EXPECT_EQ(device.server.next_deadline(), device.now + canopen::Duration{500ms});
  EXPECT_EQ(device.pass(499ms), "");
  EXPECT_EQ(device.pass(1ms), "A2 01 7F 00 00 00 00 00");
  device.ask("01 48 49 4A 4B 4C 4D 4E");
  EXPECT_EQ(device.ask("82 4F 50 00 00 00 00 00"), "A2 02 7F 00 00 00 00 00");
  EXPECT_EQ(device.ask("D5 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
}

/// The client stops after its first segment: its next frame is not a segment, but only a time-out can detect that.
TEST(SdoBlockDownload, LeavesTheServerDeafForASecondAtMost) {
  SdoBench device;
  EXPECT_EQ(device.ask("C6 0C 20 00 10 00 00 00"), "A4 0C 20 00 7F 00 00 00");
  device.ask("01 41 42 43 44 45 46 47");
  EXPECT_EQ(device.pass(500ms), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "80 0C 20 00 00 00 04 05");
  EXPECT_EQ(device.ask("40 00 10 00 00 00 00 00"), "43 00 10 00 91 01 0F 00");
}

struct WithoutTimeout : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true, .sdo_timeout = 0};
};

TEST(SdoBlockDownload, WaitsWithoutEndWhereTheTimeoutIs0) {
  SdoBench<WithoutTimeout> device;
  device.ask("C2 0C 20 00 10 00 00 00");
  EXPECT_FALSE(device.server.next_deadline());
}

TEST(SdoTimeout, IsOneSecondWithBlockTransferUnlessTheDeviceSaysOtherwise) {
  using canopen::sdo_timeout_of;
  EXPECT_EQ(sdo_timeout_of({}), 0);
  EXPECT_EQ(sdo_timeout_of({.sdo_block_transfer = true}), 1000);
  EXPECT_EQ(sdo_timeout_of({.sdo_block_transfer = true, .sdo_timeout = 0}), 0);
  EXPECT_EQ(sdo_timeout_of({.sdo_timeout = 250}), 250);
}

TEST(SdoBlockDownload, AbortsWhenNothingComesOfASubBlock) {
  SdoBench<WithTimeout> device;
  device.ask("C2 0C 20 00 10 00 00 00");
  EXPECT_EQ(device.pass(999ms), "");
  EXPECT_EQ(device.pass(1ms), "80 0C 20 00 00 00 04 05");
  EXPECT_FALSE(device.server.next_deadline());
}

}  // namespace

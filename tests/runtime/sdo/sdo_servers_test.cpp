/// The SDO servers of a node: several channels, block transfers on a busy bus, streamed DOMAINs.
#include <gtest/gtest.h>

#include <sdo_device/device.hpp>
#include <vector>

#include "support/bench.hpp"

namespace {

namespace od = sdo_device::od;
using Bench = bench::Bench<sdo_device::Device>;

/// Gives the second server the CAN-IDs 540h and 4C0h.
void enable_second_server(Bench& device) {
  EXPECT_EQ(device.ask("605 23 01 12 01 40 05 00 00"), "585 60 01 12 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 01 12 02 C0 04 00 00"), "585 60 01 12 02 00 00 00 00");
}

TEST(SdoServers, SecondOneIsSilentWhileItsCobIdsAreInvalid) {
  Bench device;
  EXPECT_EQ(device.ask("640 40 00 10 00 00 00 00 00"), "");
  EXPECT_EQ(device.ask("000 40 00 10 00 00 00 00 00"), "");
}

TEST(SdoServers, SecondOneAnswersOnItsOwnCanIds) {
  Bench device;
  enable_second_server(device);
  EXPECT_EQ(device.ask("540 40 01 12 01 00 00 00 00"), "4C0 43 01 12 01 40 05 00 00");
  EXPECT_EQ(device.ask("605 40 01 12 01 00 00 00 00"), "585 43 01 12 01 40 05 00 00");
}

/// CiA 301, 7.5.2.33: bit 30 means that the COB-ID is assigned dynamically. It is not part of the CAN-ID.
TEST(SdoServers, SecondOneAnswersWhereItsCobIdsAreAssignedDynamically) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 01 12 01 80 06 00 40"), "585 60 01 12 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 01 12 02 C0 04 00 40"), "585 60 01 12 02 00 00 00 00");
  EXPECT_EQ(device.ask("680 40 01 12 01 00 00 00 00"), "4C0 43 01 12 01 80 06 00 40");
}

/// This device has no numbers of more than 32 bits.
TEST(SdoServers, SendANumberInABlockAsItWasAtTheBeginning) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 02 20 00 44 33 22 11"), "585 60 02 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 A0 02 20 00 7F 00 00 00"), "585 C6 02 20 00 04 00 00 00");
  const std::array<std::uint8_t, 4> other{1, 2, 3, 4};
  EXPECT_EQ(device.node.set(0x2002, 0, other), canopen::ok);
  EXPECT_EQ(device.ask("605 A3 00 00 00 00 00 00 00"), "585 81 44 33 22 11 00 00 00");
}

TEST(SdoServers, HaveTransfersOfTheirOwn) {
  std::array<std::uint8_t, 16> memory{};
  Bench device;
  device.node.bind<od::firmware>(memory);
  device.node.bind_constant<od::log>(std::span<const std::uint8_t>{memory});
  enable_second_server(device);
  EXPECT_EQ(device.ask("605 21 00 20 00 08 00 00 00"), "585 60 00 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("540 40 01 20 00 00 00 00 00"), "4C0 41 01 20 00 10 00 00 00");
  EXPECT_EQ(device.ask("605 00 01 02 03 04 05 06 07"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("540 60 00 00 00 00 00 00 00"), "4C0 00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("605 1D 08 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("540 70 00 00 00 00 00 00 00"), "4C0 10 08 00 00 00 00 00 00");
}

TEST(SdoServers, ADomainThatOneWritesIsTakenFromTheOther) {
  std::array<std::uint8_t, 16> memory{};
  Bench device;
  device.node.bind<od::firmware>(memory);
  enable_second_server(device);
  EXPECT_EQ(device.ask("540 40 00 20 00 00 00 00 00"), "4C0 41 00 20 00 10 00 00 00");
  EXPECT_EQ(device.ask("605 21 00 20 00 02 00 00 00"),
            "585 60 00 20 00 00 00 00 00 | 4C0 80 00 20 00 20 00 00 08");  // 0800 0020h
}

TEST(SdoServers, ASegmentOfABlockTakesNoDomainWhateverItLooksLike) {
  std::array<std::uint8_t, 300> memory{};
  Bench device;
  device.node.bind<od::firmware>(memory);
  device.node.bind_constant<od::log>(std::span<const std::uint8_t>{memory});
  enable_second_server(device);
  EXPECT_EQ(device.ask("540 40 01 20 00 00 00 00 00"), "4C0 41 01 20 00 2C 01 00 00");
  EXPECT_EQ(device.ask("605 C2 00 20 00 2C 01 00 00"), "585 A4 00 20 00 7F 00 00 00");
  for (int sequence = 1; sequence <= 32; ++sequence) {
    char segment[40];
    std::snprintf(segment, sizeof segment, "605 %02X 00 00 00 00 00 00 00", static_cast<unsigned>(sequence));
    EXPECT_EQ(device.ask(segment), "");
  }
  EXPECT_EQ(device.ask("605 21 01 20 00 00 00 00 00"), "");  // the 33rd segment, not a download of 2001h
  EXPECT_EQ(device.ask("540 60 00 00 00 00 00 00 00"), "4C0 00 00 00 00 00 00 00 00");
}

TEST(SdoServers, CobIdsStayWhileTheChannelIsValid) {
  Bench device;
  enable_second_server(device);
  EXPECT_EQ(device.ask("605 23 01 12 01 41 05 00 00"), "585 80 01 12 01 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 01 12 01 40 05 00 80"), "585 60 01 12 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 01 12 01 01 06 00 00"), "585 80 01 12 01 30 00 09 06");  // restricted
}

TEST(SdoBlockTransfer, WaitsForRoomBetweenSegments) {
  std::array<std::uint8_t, 15> memory{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  Bench device;
  device.node.bind_constant<od::log>(std::span<const std::uint8_t>{memory});
  EXPECT_EQ(device.ask("605 A4 01 20 00 7F 00 00 00"), "585 C6 01 20 00 0F 00 00 00");
  device.bus.room = 1;
  EXPECT_EQ(device.ask("605 A3 00 00 00 00 00 00 00"), "585 01 01 02 03 04 05 06 07");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(std::chrono::seconds{0}), "585 02 08 09 0A 0B 0C 0D 0E | 585 83 0F 00 00 00 00 00 00");
  // 15 bytes: six bytes of the last segment are padding. The CRC is CRC-CCITT with the initial value 0.
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : memory) crc = canopen::crc16_ccitt(crc, byte);
  char end[32];
  std::snprintf(end, sizeof end, "585 D9 %02X %02X 00 00 00 00 00", crc & 0xFFu, static_cast<unsigned>(crc >> 8));
  EXPECT_EQ(device.ask("605 A2 03 7F 00 00 00 00 00"), end);
  EXPECT_EQ(device.ask("605 A1 00 00 00 00 00 00 00"), "");
}

TEST(StreamedDomain, IsReadFromTheApplicationPieceByPiece) {
  auto device = bench::with<sdo_device::Device>(
      canopen::on_domain_read<od::log>([](std::uint32_t offset, std::span<std::uint8_t> bytes) {
        std::uint32_t count = 0;
        while (count < bytes.size() && offset + count < 10) {
          bytes[count] = static_cast<std::uint8_t>(0x30 + offset + count);
          ++count;
        }
        return count;
      }));
  EXPECT_EQ(device.ask("605 40 01 20 00 00 00 00 00"), "585 40 01 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 30 31 32 33 34 35 36");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 19 37 38 39 00 00 00 00");
}

TEST(StreamedDomain, IsGivenToTheApplicationPieceByPiece) {
  std::string log;
  auto device = bench::with<sdo_device::Device>(
      canopen::on_domain_write<od::firmware>([&](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
        log += std::to_string(offset) + "+" + std::to_string(bytes.size()) + (last ? "! " : " ");
      }));
  device.ask("605 21 00 20 00 09 00 00 00");
  device.ask("605 00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("605 1B 08 09 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_TRUE(log.starts_with("0+7 7+2")) << log;
  EXPECT_NE(log.find('!'), std::string::npos) << log;
}

}  // namespace

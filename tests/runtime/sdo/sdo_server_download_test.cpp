/// Expedited and segmented downloads of an SDO server.
#include <gtest/gtest.h>

#include <array>

#include "support/bench.hpp"

namespace {

using bench::Bench;
namespace od = sample::od;

// Expedited download

TEST(SdoServer, DownloadsUpToFourBytesExpedited) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 05 20 00 78 56 34 12"), "585 60 05 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer32_value>(), 0x12345678);
  EXPECT_EQ(device.ask("605 27 03 20 00 FE FF FF 00"), "585 60 03 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer24_value>(), -2);
  EXPECT_EQ(device.ask("605 2B 02 20 00 FD FF 00 00"), "585 60 02 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer16_value>(), -3);
  EXPECT_EQ(device.ask("605 2F 01 20 00 FC 00 00 00"), "585 60 01 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer8_value>(), -4);
}

TEST(SdoServer, TakesTheObjectsSizeWhenTheClientIndicatesNone) {
  Bench device;
  EXPECT_EQ(device.ask("605 22 02 20 00 34 12 99 99"), "585 60 02 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer16_value>(), 0x1234);
}

TEST(SdoServer, RefusesExpeditedDataOfAWrongLength) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 02 20 00 01 00 00 00"), "585 80 02 20 00 12 00 07 06");
  EXPECT_EQ(device.ask("605 2F 02 20 00 01 00 00 00"), "585 80 02 20 00 13 00 07 06");
  EXPECT_EQ(device.ask("605 22 08 20 00 01 00 00 00"), "585 80 08 20 00 13 00 07 06");  // UNSIGNED64
}

TEST(SdoServer, RefusesValuesOutsideTheLimits) {
  Bench device;
  EXPECT_EQ(device.ask("605 2F 01 20 00 65 00 00 00"), "585 80 01 20 00 31 00 09 06");  // 101
  EXPECT_EQ(device.ask("605 2F 01 20 00 9B 00 00 00"), "585 80 01 20 00 32 00 09 06");  // -101
  EXPECT_EQ(device.ask("605 2F 01 20 00 9C 00 00 00"), "585 60 01 20 00 00 00 00 00");  // -100
  EXPECT_EQ(device.ask("605 27 03 20 00 41 42 0F 00"), "585 80 03 20 00 31 00 09 06");  // 1000001
  EXPECT_EQ(device.ask("605 27 03 20 00 BF BD F0 00"), "585 80 03 20 00 32 00 09 06");  // -1000001
  EXPECT_EQ(device.ask("605 2F 19 20 00 C9 00 00 00"), "585 80 19 20 00 31 00 09 06");  // 201
  EXPECT_EQ(device.ask("605 2F 19 20 00 00 00 00 00"), "585 80 19 20 00 32 00 09 06");  // 0
  EXPECT_EQ(device.ask("605 23 0A 20 00 00 00 00 40"), "585 80 0A 20 00 31 00 09 06");  // 2.0
  EXPECT_EQ(device.ask("605 23 0A 20 00 00 00 00 C0"), "585 80 0A 20 00 32 00 09 06");  // -2.0
  EXPECT_EQ(device.ask("605 23 0A 20 00 00 00 C0 7F"), "585 80 0A 20 00 30 00 09 06");  // not a number
  EXPECT_EQ(device.ask("605 2B 13 20 03 0B 00 00 00"), "585 80 13 20 03 31 00 09 06");  // third element: 11
  EXPECT_EQ(device.ask("605 2B 13 20 03 0A 00 00 00"), "585 60 13 20 03 00 00 00 00");
}

TEST(SdoServer, ABooleanIsZeroOrOne) {
  Bench device;
  EXPECT_EQ(device.ask("605 2F 00 20 00 01 00 00 00"), "585 60 00 20 00 00 00 00 00");
  EXPECT_TRUE(device.node.get<od::boolean_value>());
  EXPECT_EQ(device.ask("605 2F 00 20 00 02 00 00 00"), "585 80 00 20 00 30 00 09 06");
}

TEST(SdoServer, DownloadsAShortStringExpedited) {
  Bench device;
  EXPECT_EQ(device.ask("605 2B 0C 20 00 48 69 00 00"), "585 60 0C 20 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "Hi");
}

// Segmented download

TEST(SdoServer, DownloadsAStringInSegments) {
  Bench device;
  EXPECT_EQ(device.ask("605 21 0C 20 00 08 00 00 00"), "585 60 0C 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 00 41 42 43 44 45 46 47"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "hello");
  EXPECT_EQ(device.ask("605 1D 48 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "ABCDEFGH");
}

TEST(SdoServer, DownloadsWithoutAnAnnouncedSize) {
  Bench device;
  EXPECT_EQ(device.ask("605 20 0D 20 00 00 00 00 00"), "585 60 0D 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 0B 11 22 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::octet_string_value>().size, 2);
}

TEST(SdoServer, DownloadsShortNumbersInSegmentsAsWell) {
  Bench device;
  EXPECT_EQ(device.ask("605 21 17 10 00 02 00 00 00"), "585 60 17 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 0B E8 03 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::producer_heartbeat_time>()), 1000);
}

TEST(SdoServer, DownloadsNumbersOfFiveToEightBytes) {
  Bench device;
  device.ask("605 21 07 20 00 08 00 00 00");
  device.ask("605 00 FE FF FF FF FF FF FF");
  EXPECT_EQ(device.ask("605 1D FF 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::integer64_value>(), -2);
  device.ask("605 21 09 20 00 05 00 00 00");
  EXPECT_EQ(device.ask("605 05 01 02 03 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::unsigned40_value>(), 0x030201u);
}

TEST(SdoServer, ChecksTheLimitsOfWideNumbers) {
  Bench device;
  device.ask("605 21 09 20 00 05 00 00 00");
  EXPECT_EQ(device.ask("605 05 01 CA 9A 3B 00 00 00"), "585 80 09 20 00 31 00 09 06");  // 1000000001
  device.ask("605 21 07 20 00 08 00 00 00");
  device.ask("605 00 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 1D 80 00 00 00 00 00 00"), "585 80 07 20 00 32 00 09 06");
}

TEST(SdoServer, DownloadsAnEmptyString) {
  Bench device;
  EXPECT_EQ(device.ask("605 21 0C 20 00 00 00 00 00"), "585 60 0C 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 0F 00 00 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "");
}

TEST(SdoServer, DownloadsIntoABoundDomain) {
  Bench device;
  std::array<std::uint8_t, 10> memory{};
  device.node.bind<od::parameter_file>(memory, 0);
  EXPECT_EQ(device.ask("605 21 12 20 00 09 00 00 00"), "585 60 12 20 00 00 00 00 00");
  device.ask("605 00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("605 1B 08 09 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(memory, (std::array<std::uint8_t, 10>{1, 2, 3, 4, 5, 6, 7, 8, 9, 0}));
  EXPECT_EQ(device.node.get<od::parameter_file>().size, 9u);
}

TEST(SdoServer, ADomainWhoseDownloadBrokeOffIsEmpty) {
  Bench device;
  std::array<std::uint8_t, 10> memory{};
  device.node.bind<od::parameter_file>(memory);
  device.ask("605 21 12 20 00 09 00 00 00");
  device.ask("605 00 01 02 03 04 05 06 07");
  device.ask("605 80 12 20 00 00 00 00 08");
  EXPECT_EQ(device.node.get<od::parameter_file>().size, 0u);
}

TEST(SdoServer, CannotStoreIntoAnUnboundDomain) {
  Bench device;
  EXPECT_EQ(device.ask("605 21 12 20 00 09 00 00 00"), "585 80 12 20 00 20 00 00 08");
  EXPECT_EQ(device.ask("605 23 12 20 00 01 02 03 04"), "585 80 12 20 00 20 00 00 08");
}

TEST(SdoServer, RefusesAnAnnouncedSizeThatDoesNotFit) {
  Bench device;
  std::array<std::uint8_t, 10> memory{};
  device.node.bind<od::parameter_file>(memory);
  EXPECT_EQ(device.ask("605 21 0C 20 00 11 00 00 00"), "585 80 0C 20 00 12 00 07 06");  // 17 characters, 16 at most
  EXPECT_EQ(device.ask("605 21 12 20 00 0B 00 00 00"), "585 80 12 20 00 12 00 07 06");
  EXPECT_EQ(device.ask("605 21 02 20 00 03 00 00 00"), "585 80 02 20 00 12 00 07 06");
  EXPECT_EQ(device.ask("605 21 02 20 00 01 00 00 00"), "585 80 02 20 00 13 00 07 06");
  EXPECT_EQ(device.ask("605 21 02 20 00 00 00 00 00"), "585 80 02 20 00 13 00 07 06");
}

TEST(SdoServer, AbortsWhenMoreComesThanAnnounced) {
  Bench device;
  device.ask("605 21 0C 20 00 03 00 00 00");
  EXPECT_EQ(device.ask("605 00 41 42 43 44 45 46 47"), "585 80 0C 20 00 12 00 07 06");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoServer, AbortsWhenLessComesThanAnnounced) {
  Bench device;
  device.ask("605 21 0C 20 00 08 00 00 00");
  EXPECT_EQ(device.ask("605 01 41 42 43 44 45 46 47"), "585 80 0C 20 00 10 00 07 06");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoServer, AbortsWhenMoreComesThanTheObjectHolds) {
  Bench device;
  device.ask("605 20 0C 20 00 00 00 00 00");
  device.ask("605 00 41 42 43 44 45 46 47");
  device.ask("605 10 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("605 00 41 42 43 44 45 46 47"), "585 80 0C 20 00 12 00 07 06");
}

TEST(SdoServer, AbortsWhenLessComesThanTheObjectNeeds) {
  Bench device;
  device.ask("605 20 02 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 0D 41 00 00 00 00 00 00"), "585 80 02 20 00 13 00 07 06");
}

struct SmallBuffer : sample::Device {
  static constexpr std::size_t longest_download = 0;
};

// shows 000.64, 002.16, 004.32
TEST(SdoServer, IsOutOfMemoryForAStringLongerThanItsBuffer) {
  Bench<SmallBuffer> device;
  EXPECT_EQ(device.ask("605 21 0C 20 00 09 00 00 00"), "585 80 0C 20 00 05 00 04 05");
  device.ask("605 20 0C 20 00 00 00 00 00");
  device.ask("605 00 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("605 10 41 42 43 44 45 46 47"), "585 80 0C 20 00 05 00 04 05");
}

}  // namespace

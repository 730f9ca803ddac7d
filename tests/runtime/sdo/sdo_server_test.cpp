#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using bench::Bench;
using canopen::AbortCode;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(SdoServer, RefusesACommandThatNothingCarriesOut) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 10 10 01 00 00 00 00"), "585 43 10 10 01 01 00 00 00");
  EXPECT_EQ(device.ask("605 23 10 10 01 73 61 76 65"), "585 80 10 10 01 20 00 00 08");
  EXPECT_EQ(device.ask("605 40 10 10 01 00 00 00 00"), "585 43 10 10 01 01 00 00 00");
}

// Expedited upload

TEST(SdoServer, UploadsUpToFourBytesExpedited) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 0F 00");  // UNSIGNED32
  EXPECT_EQ(device.node.set<od::unsigned24_value>(0x123456), canopen::ok);
  EXPECT_EQ(device.ask("605 40 04 20 00 00 00 00 00"), "585 47 04 20 00 56 34 12 00");
  device.node.set<od::integer16_value>(-2);
  EXPECT_EQ(device.ask("605 40 02 20 00 00 00 00 00"), "585 4B 02 20 00 FE FF 00 00");
  EXPECT_EQ(device.node.set<od::integer8_value>(-3), canopen::ok);
  EXPECT_EQ(device.ask("605 40 01 20 00 00 00 00 00"), "585 4F 01 20 00 FD 00 00 00");
}

TEST(SdoServer, UploadsABooleanAsOneByte) {
  Bench device;
  device.node.set<od::boolean_value>(true);
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 01 00 00 00");
}

// shows 000.25
TEST(SdoServer, UploadsReal32) {
  Bench device;
  EXPECT_EQ(device.node.set<od::real32_value>(1.5f), canopen::ok);
  EXPECT_EQ(device.ask("605 40 0A 20 00 00 00 00 00"), "585 43 0A 20 00 00 00 C0 3F");
}

TEST(SdoServer, UploadsConstantsFromTheTables) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 16 20 00 00 00 00 00"), "585 4B 16 20 00 07 00 00 00");
  EXPECT_EQ(device.ask("605 40 17 20 00 00 00 00 00"), "585 4B 17 20 00 FB FF 00 00");
  EXPECT_EQ(device.ask("605 40 18 10 00 00 00 00 00"), "585 4F 18 10 00 04 00 00 00");
  EXPECT_EQ(device.ask("605 40 18 10 03 00 00 00 00"), "585 43 18 10 03 02 00 01 00");
}

TEST(SdoServer, UploadsValuesThatFollowTheNodeId) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 00 12 01 00 00 00 00"), "585 43 00 12 01 05 06 00 00");
  EXPECT_EQ(device.ask("605 40 00 14 01 00 00 00 00"), "585 43 00 14 01 05 02 00 00");
}

TEST(SdoServer, UploadsAShortStringExpedited) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 09 10 00 00 00 00 00"), "585 4B 09 10 00 41 31 00 00");
}

TEST(SdoServer, IgnoresTheReservedBitsOfAnUploadRequest) {
  Bench device;
  EXPECT_EQ(device.ask("605 5F 00 10 00 FF FF FF FF"), "585 43 00 10 00 91 01 0F 00");
}

struct SizeNotIndicated : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_upload_size_indicated = false};
};

TEST(SdoServer, AnOptionLeavesTheSizeOfExpeditedUploadsOut) {
  Bench<SizeNotIndicated> device;
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 00 00 00");
}

// Segmented upload

TEST(SdoServer, UploadsAStringInSegments) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 0D 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 53 61 6D 70 6C 65 20");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 13 64 65 76 69 63 65 00");
}

TEST(SdoServer, UploadsNumbersOfFiveToEightBytesInSegments) {
  Bench device;
  EXPECT_EQ(device.node.set<od::integer40_value>(-2), canopen::ok);
  EXPECT_EQ(device.ask("605 40 06 20 00 00 00 00 00"), "585 41 06 20 00 05 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 05 FE FF FF FF FF 00 00");
  device.node.set<od::unsigned64_value>(0x0102030405060708);
  EXPECT_EQ(device.ask("605 40 08 20 00 00 00 00 00"), "585 41 08 20 00 08 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 08 07 06 05 04 03 02");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 1D 01 00 00 00 00 00 00");
}

TEST(SdoServer, ANumberIsUploadedAsItWasAtTheBeginning) {
  Bench device;
  device.node.set<od::unsigned64_value>(0x0102030405060708);
  device.ask("605 40 08 20 00 00 00 00 00");
  device.node.set<od::unsigned64_value>(0);
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 08 07 06 05 04 03 02");
}

// shows 000.27
TEST(SdoServer, UploadsTimeOfDay) {
  Bench device;
  device.node.set<od::time_of_day_value>({0x0ABCDEF0, 0x1234});
  EXPECT_EQ(device.ask("605 40 0F 20 00 00 00 00 00"), "585 41 0F 20 00 06 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 03 F0 DE BC 0A 34 12 00");
}

TEST(SdoServer, UploadsAnEmptyStringAsOneEmptySegment) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 0D 20 00 00 00 00 00"), "585 41 0D 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 0F 00 00 00 00 00 00 00");
}

TEST(SdoServer, UploadsABoundDomain) {
  Bench device;
  std::array<std::uint8_t, 9> memory{1, 2, 3, 4, 5, 6, 7, 8, 9};
  device.node.bind<od::parameter_file>(memory);
  EXPECT_EQ(device.ask("605 40 12 20 00 00 00 00 00"), "585 41 12 20 00 09 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 1B 08 09 00 00 00 00 00");
}

TEST(SdoServer, HasNoDataOfAnUnboundDomain) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 12 20 00 00 00 00 00"), "585 80 12 20 00 24 00 00 08");
}

TEST(SdoServer, EndsTheTransferOfADomainThatIsBoundAnew) {
  Bench device;
  std::array<std::uint8_t, 9> memory{};
  device.node.bind<od::parameter_file>(memory);
  device.ask("605 40 12 20 00 00 00 00 00");
  device.node.bind<od::parameter_file>(memory);
  EXPECT_EQ(device.pass(0ms), "585 80 12 20 00 20 00 00 08");
}

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
  EXPECT_EQ(device.node.get<od::producer_heartbeat_time>(), 1000);
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

// Access types

TEST(SdoServer, RefusesWhatDoesNotExist) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 04 10 00 00 00 00 00"), "585 80 04 10 00 00 00 02 06");
  EXPECT_EQ(device.ask("605 2F 04 10 00 00 00 00 00"), "585 80 04 10 00 00 00 02 06");
  EXPECT_EQ(device.ask("605 40 00 10 01 00 00 00 00"), "585 80 00 10 01 11 00 09 06");
  EXPECT_EQ(device.ask("605 40 18 10 05 00 00 00 00"), "585 80 18 10 05 11 00 09 06");
  EXPECT_EQ(device.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(device.ask("605 2F 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
}

// shows 000.60, 002.18
TEST(SdoServer, RefusesToReadWhatIsWriteOnly) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 14 20 00 00 00 00 00"), "585 80 14 20 00 01 00 01 06");
  EXPECT_EQ(device.ask("605 2B 14 20 00 34 12 00 00"), "585 60 14 20 00 00 00 00 00");
}

TEST(SdoServer, RefusesToWriteWhatIsReadOnly) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 00 10 00 00 00 00 00"), "585 80 00 10 00 02 00 01 06");
  EXPECT_EQ(device.ask("605 2B 41 60 00 00 00 00 00"), "585 80 41 60 00 02 00 01 06");
  EXPECT_EQ(device.ask("605 21 08 10 00 08 00 00 00"), "585 80 08 10 00 02 00 01 06");
}

// Protocol

TEST(SdoServer, AbortsASecondSegmentWithTheSameToggleBit) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  device.ask("605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 00 00 03 05");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");

  device.ask("605 21 0C 20 00 0A 00 00 00");
  EXPECT_EQ(device.ask("605 10 41 42 43 44 45 46 47"), "585 80 0C 20 00 00 00 03 05");
}

TEST(SdoServer, AbortsUnknownCommandSpecifiers) {
  Bench device;
  EXPECT_EQ(device.ask("605 E0 00 10 00 00 00 00 00"), "585 80 00 10 00 01 00 04 05");
  EXPECT_EQ(device.ask("605 A4 00 10 00 7F 00 00 00"), "585 80 00 10 00 01 00 04 05");  // block upload
  EXPECT_EQ(device.ask("605 C2 17 10 00 02 00 00 00"), "585 80 17 10 00 01 00 04 05");  // block download
}

TEST(SdoServer, NamesTheTransferThatAnUnknownCommandEnds) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 E0 00 20 01 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
}

TEST(SdoServer, AbortsSegmentsWithoutATransfer) {
  Bench device;
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.ask("605 00 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
}

TEST(SdoServer, AbortsSegmentsOfTheOtherDirection) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 00 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
  device.ask("605 21 0C 20 00 0A 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 0C 20 00 01 00 04 05");
}

TEST(SdoServer, ANewInitiateReplacesATransfer) {
  Bench device;
  device.ask("605 21 0C 20 00 08 00 00 00");
  device.ask("605 00 41 42 43 44 45 46 47");
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 0F 00");
  EXPECT_EQ(device.ask("605 1D 48 00 00 00 00 00 00"), "585 80 00 10 00 01 00 04 05");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoServer, AnAbortOfTheClientEndsATransferWithoutAnAnswer) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
}

TEST(SdoServer, IgnoresFramesThatAreNotEightBytesLongOrRemote) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 00 10 00"), "");
  EXPECT_EQ(device.ask("605"), "");
  EXPECT_EQ(device.ask("605 R 8"), "");
  EXPECT_EQ(device.ask("00000605 40 00 10 00 00 00 00 00"), "");
  EXPECT_EQ(device.ask("606 40 00 10 00 00 00 00 00"), "");
}

TEST(SdoServer, ServesInPreOperationalAndOperationalOnly) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 0F 00");
  device.ask(bench::stop);
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "");
}

TEST(SdoServer, StoppingEndsATransfer) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  device.ask(bench::stop);
  device.ask(bench::enter_pre_operational);
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
}

TEST(SdoServer, KeepsItsAnswerUntilTheBusHasRoom) {
  Bench device;
  device.bus.room = 0;
  EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.bus.room = 10;
  EXPECT_EQ(device.pass(1ms), "585 43 00 10 00 91 01 0F 00");
  EXPECT_FALSE(device.node.next_deadline());
}

TEST(SdoServer, SendsAWaitingAnswerBeforeItTakesTheNextFrame) {
  Bench device;
  device.bus.room = 0;
  device.ask("605 40 00 10 00 00 00 00 00");
  device.bus.room = 10;
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 43 00 10 00 91 01 0F 00 | 585 4B 17 10 00 00 00 00 00");
}

struct WithTimeout : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_timeout = 1000};
};

// shows 000.64, 002.14
TEST(SdoServer, AnOptionAbortsATransferWhoseClientIsSilent) {
  Bench<WithTimeout> device;
  device.ask("605 40 08 10 00 00 00 00 00");
  device.pass(500ms);
  device.ask("605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(device.pass(999ms), "");
  EXPECT_EQ(device.pass(1ms), "585 80 08 10 00 00 00 04 05");
}

TEST(SdoServer, WaitsForItsClientWithoutEnd) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_FALSE(device.node.next_deadline());
  device.pass(1min);
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 53 61 6D 70 6C 65 20");
}

// Handlers

TEST(SdoServer, AsksTheWriteHandlerBeforeItStores) {
  auto device = bench::with(canopen::on_write<od::integer24_value>(
      [](std::int32_t value) { return value == -2 ? AbortCode::local_control : canopen::ok; }));
  EXPECT_EQ(device.ask("605 27 03 20 00 FE FF FF 00"), "585 80 03 20 00 21 00 00 08");
  EXPECT_EQ(device.node.get<od::integer24_value>(), 0);
  EXPECT_EQ(device.ask("605 27 03 20 00 FD FF FF 00"), "585 60 03 20 00 00 00 00 00");
}

TEST(SdoServer, GivesStringsAndDomainsToTheirHandlers) {
  std::string text;
  std::uint32_t bytes = 0;
  auto device =
      bench::with(canopen::on_write<od::visible_string_value>([&](const auto& value) { text = value.view(); }),
                  canopen::on_write<od::parameter_file>([&](canopen::Domain file) { bytes = file.size; }));
  std::array<std::uint8_t, 4> memory{};
  device.node.bind<od::parameter_file>(memory);
  device.ask("605 2B 0C 20 00 48 69 00 00");
  device.ask("605 27 12 20 00 01 02 03 00");
  EXPECT_EQ(text, "Hi");
  EXPECT_EQ(bytes, 3u);
}

TEST(SdoServer, LeavesADomainAsItsHandlerBindsIt) {
  std::array<std::uint8_t, 9> first{};
  std::array<std::uint8_t, 2> second{0xEE, 0xEE};
  auto device = bench::with(canopen::on_write<od::parameter_file>(
      [&](auto& node, canopen::Domain) { node.template bind<od::parameter_file>(second, 0); }));
  device.node.bind<od::parameter_file>(first, 0);
  device.ask("605 21 12 20 00 09 00 00 00");
  device.ask("605 00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("605 1B 08 09 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(first, (std::array<std::uint8_t, 9>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(second, (std::array<std::uint8_t, 2>{0xEE, 0xEE}));
  EXPECT_EQ(device.node.get<od::parameter_file>().size, 0u);
}

TEST(SdoServer, LetsTheReadHandlerRefreshTheValue) {
  auto device =
      bench::with(canopen::on_read<od::position_actual_value>([] { return std::int32_t{77}; }),
                  canopen::on_read<od::statusword>([](auto& node) { node.template set<od::statusword>(0x37); }),
                  canopen::on_read<od::integer16_value>([] { return AbortCode::hardware; }));
  EXPECT_EQ(device.ask("605 40 64 60 00 00 00 00 00"), "585 43 64 60 00 4D 00 00 00");
  EXPECT_EQ(device.ask("605 40 41 60 00 00 00 00 00"), "585 4B 41 60 00 37 00 00 00");
  EXPECT_EQ(device.ask("605 40 02 20 00 00 00 00 00"), "585 80 02 20 00 00 00 06 06");
}

}  // namespace

/// Expedited and segmented uploads of an SDO server.
#include <gtest/gtest.h>

#include <array>

#include "support/bench.hpp"

namespace {

using bench::Bench;
namespace od = sample::od;
using namespace std::chrono_literals;

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

TEST(SdoServer, AStringIsUploadedAsItWasAtTheBeginning) {
  Bench device;
  device.node.set<od::visible_string_value>("AAAAAAAAAA");
  EXPECT_EQ(device.ask("605 40 0C 20 00 00 00 00 00"), "585 41 0C 20 00 0A 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 00 41 41 41 41 41 41 41");
  device.node.set<od::visible_string_value>("BBBB");
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 19 41 41 41 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 0C 20 00 00 00 00 00"), "585 43 0C 20 00 42 42 42 42");
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

}  // namespace

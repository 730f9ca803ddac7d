/// Block uploads of an SDO server.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "counting.hpp"
#include "sdo_bench.hpp"

namespace {

using bench::counting;
using bench::crc_text;
using bench::SdoBench;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(SdoBlockUpload, SendsAStringInOneSubBlockWithItsCrc) {
  SdoBench device;
  EXPECT_EQ(device.ask("A4 08 10 00 7F 00 00 00"), "C6 08 10 00 0D 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "01 53 61 6D 70 6C 65 20 | 82 64 65 76 69 63 65 00");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "C5 61 AE 00 00 00 00 00");
  EXPECT_EQ(device.ask("A1 00 00 00 00 00 00 00"), "");
  const std::string text = "Sample device";
  EXPECT_EQ(crc_text({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), "61 AE");
}

TEST(SdoBlockUpload, HasNoCrcForAClientThatSupportsNone) {
  SdoBench device;
  EXPECT_EQ(device.ask("A0 08 10 00 7F 00 00 00"), "C6 08 10 00 0D 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "C5 00 00 00 00 00 00 00");
}

TEST(SdoBlockUpload, SendsSubBlocksOfTheSizeThatTheClientWantsEachTime) {
  SdoBench device;
  auto memory = counting<28>();
  device.bind<od::parameter_file>(memory, memory.size());
  EXPECT_EQ(device.ask("A4 12 20 00 01 00 00 00"), "C6 12 20 00 1C 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "01 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("A2 01 02 00 00 00 00 00"), "01 08 09 0A 0B 0C 0D 0E | 02 0F 10 11 12 13 14 15");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "81 16 17 18 19 1A 1B 1C");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "C1 " + crc_text(memory) + " 00 00 00 00 00");
}

TEST(SdoBlockUpload, SendsAnEmptyValueAsOneEmptySegment) {
  SdoBench device;
  EXPECT_EQ(device.ask("A4 0D 20 00 7F 00 00 00"), "C6 0D 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "81 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "DD 00 00 00 00 00 00 00");
}

TEST(SdoBlockUpload, SendsShortAndWideNumbersAsTheyWereAtTheBeginning) {
  SdoBench device;
  EXPECT_EQ(device.ask("A0 00 10 00 7F 00 00 00"), "C6 00 10 00 04 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "81 91 01 0F 00 00 00 00");
  device.store.set<od::unsigned64_value>(0x0807060504030201);
  EXPECT_EQ(device.ask("A0 08 20 00 7F 00 00 00"), "C6 08 20 00 08 00 00 00");
  device.store.set<od::unsigned64_value>(0);
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "01 01 02 03 04 05 06 07 | 82 08 00 00 00 00 00 00");
}

TEST(SdoBlockUpload, SendsTheRestOfASubBlockAgainFromTheFirstSegmentThatWasLost) {
  SdoBench device;
  auto memory = counting<30>();
  device.bind<od::parameter_file>(memory, memory.size());
  device.ask("A4 12 20 00 04 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 01 04 00 00 00 00 00"),
            "01 08 09 0A 0B 0C 0D 0E | 02 0F 10 11 12 13 14 15 | 03 16 17 18 19 1A 1B 1C | 84 1D 1E 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 02 01 00 00 00 00 00"), "01 16 17 18 19 1A 1B 1C");
  EXPECT_EQ(device.ask("A2 00 7F 00 00 00 00 00"), "01 16 17 18 19 1A 1B 1C | 82 1D 1E 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "D5 " + crc_text(memory) + " 00 00 00 00 00");
}

TEST(SdoBlockUpload, GoesOnWhenTheBusHasRoom) {
  SdoBench device;
  auto memory = counting<21>();
  device.bind<od::parameter_file>(memory, memory.size());
  device.ask("A4 12 20 00 7F 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00", 1), "01 01 02 03 04 05 06 07");
  EXPECT_TRUE(device.server.has_reply());
  EXPECT_EQ(device.take(1), "02 08 09 0A 0B 0C 0D 0E");
  EXPECT_EQ(device.take(), "83 0F 10 11 12 13 14 15");
  EXPECT_FALSE(device.server.has_reply());
}

TEST(SdoBlockUpload, ChangesTheProtocolForAValueUpToTheThreshold) {
  SdoBench device;
  EXPECT_EQ(device.ask("A4 08 10 00 7F 0D 00 00"), "41 08 10 00 0D 00 00 00");
  EXPECT_EQ(device.ask("60 00 00 00 00 00 00 00"), "00 53 61 6D 70 6C 65 20");
  EXPECT_EQ(device.ask("A4 08 10 00 7F 0C 00 00"), "C6 08 10 00 0D 00 00 00");
  EXPECT_EQ(device.ask("A4 00 10 00 7F 04 00 00"), "43 00 10 00 91 01 0F 00");
}

TEST(SdoBlockUpload, RefusesBlockSizesOtherThan1To127) {
  SdoBench device;
  EXPECT_EQ(device.ask("A4 08 10 00 00 00 00 00"), "80 08 10 00 02 00 04 05");
  EXPECT_EQ(device.ask("A4 08 10 00 80 00 00 00"), "80 08 10 00 02 00 04 05");
  device.ask("A4 08 10 00 01 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 01 00 00 00 00 00 00"), "80 08 10 00 02 00 04 05");
}

TEST(SdoBlockUpload, RefusesTheConfirmationOfASegmentThatWasNotSent) {
  SdoBench device;
  device.ask("A4 08 10 00 01 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "80 08 10 00 03 00 04 05");
}

TEST(SdoBlockUpload, KnowsWhichRequestIsDue) {
  SdoBench device;
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.ask("A1 00 00 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
  device.ask("A4 08 10 00 7F 00 00 00");
  EXPECT_EQ(device.ask("A1 00 00 00 00 00 00 00"), "80 08 10 00 01 00 04 05");
  device.ask("A4 08 10 00 7F 00 00 00");
  EXPECT_EQ(device.ask("60 00 00 00 00 00 00 00"), "80 08 10 00 01 00 04 05");
}

TEST(SdoBlockUpload, RefusesWhatAnyUploadRefuses) {
  SdoBench device;
  EXPECT_EQ(device.ask("A4 04 10 00 7F 00 00 00"), "80 04 10 00 00 00 02 06");
  EXPECT_EQ(device.ask("A4 14 20 00 7F 00 00 00"), "80 14 20 00 01 00 01 06");
  EXPECT_EQ(device.ask("A4 12 20 00 7F 00 00 00"), "80 12 20 00 24 00 00 08");
}

TEST(SdoBlockUpload, EndsWithAnAbortOfTheClientAndWithANewInitiate) {
  SdoBench device;
  device.ask("A4 08 10 00 01 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
  device.ask("A4 08 10 00 01 00 00 00");
  device.ask("A3 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("40 00 10 00 00 00 00 00"), "43 00 10 00 91 01 0F 00");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "80 00 00 00 01 00 04 05");
}

struct WithTimeout : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true, .sdo_timeout = 1000};
};

TEST(SdoBlockUpload, AbortsWhenASubBlockIsNotConfirmed) {
  SdoBench<WithTimeout> device;
  device.ask("A4 08 10 00 7F 00 00 00");
  device.now = device.now + canopen::Duration{900ms};
  device.ask("A3 00 00 00 00 00 00 00", 1);
  device.now = device.now + canopen::Duration{900ms};
  device.take();  // a slow bus: the time-out starts with the last segment sent
  EXPECT_EQ(device.pass(999ms), "");
  EXPECT_EQ(device.pass(1ms), "80 08 10 00 00 00 04 05");
}

TEST(SdoBlock, IsRefusedByADeviceWithoutIt) {
  SdoBench<sample::Device> device;
  EXPECT_EQ(device.ask("A4 08 10 00 7F 00 00 00"), "80 08 10 00 01 00 04 05");
  EXPECT_EQ(device.ask("C6 0C 20 00 0D 00 00 00"), "80 0C 20 00 01 00 04 05");
  EXPECT_LT(sizeof(canopen::SdoServer<sample::Device>), sizeof(canopen::SdoServer<bench::WithBlock>));
}

TEST(SdoServerArray, ServesSeveralClientsAtOnce) {
  SdoBench device;
  std::array<canopen::SdoServer<bench::WithBlock>, 2> servers;
  const auto ask = [&](std::size_t number, const std::string& request) {
    servers.at(number).on_request(bench::bytes_of(request), device.hooks(), device.now);
    const std::string answer = bench::text_of(servers.at(number).reply());
    servers.at(number).reply_sent(device.hooks(), device.now);
    return answer;
  };
  EXPECT_EQ(ask(0, "40 08 10 00 00 00 00 00"), "41 08 10 00 0D 00 00 00");
  EXPECT_EQ(ask(1, "21 0C 20 00 08 00 00 00"), "60 0C 20 00 00 00 00 00");
  EXPECT_EQ(ask(0, "60 00 00 00 00 00 00 00"), "00 53 61 6D 70 6C 65 20");
  EXPECT_EQ(ask(1, "00 41 42 43 44 45 46 47"), "20 00 00 00 00 00 00 00");
  EXPECT_EQ(ask(0, "70 00 00 00 00 00 00 00"), "13 64 65 76 69 63 65 00");
  EXPECT_EQ(ask(1, "1D 48 00 00 00 00 00 00"), "30 00 00 00 00 00 00 00");
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "ABCDEFGH");
}

}  // namespace

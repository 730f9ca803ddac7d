/// The SDO server of a node: access types, invalid requests, NMT states, time-outs and handlers.
#include <gtest/gtest.h>

#include <array>
#include <string>

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
  EXPECT_EQ(device.ask("605 70 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");

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
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
}

TEST(SdoServer, AbortsSegmentsWithoutATransfer) {
  Bench device;
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.ask("605 00 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  device.ask("605 40 18 10 01 00 00 00 00");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05") << "not of the last transfer";
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
  EXPECT_EQ(device.ask("605 1D 48 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "hello");
}

TEST(SdoServer, AnAbortOfTheClientEndsATransferWithoutAnAnswer) {
  Bench device;
  device.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
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
  EXPECT_EQ(device.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
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

/// What the application does with its node: sets objects, also in handlers, requests NMT commands and reports errors.
#include <gtest/gtest.h>

#include <every_service/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::ErrorRegister;
using canopen::NmtCommand;
using namespace std::chrono_literals;
namespace od = every_service::od;
using Device = bench::Bench<every_service::Device>;

template <class... Handlers>
auto with(Handlers... handlers) {
  return bench::with<every_service::Device>(std::move(handlers)...);
}

constexpr auto write_byte = "605 2F 00 20 00 09 00 00 00";
constexpr auto byte_written = "585 60 00 20 00 00 00 00 00";

// Values

TEST(WriteOfAnEqualValue, SendsNoTpdo) {
  Device device;
  device.ask(bench::start);
  EXPECT_EQ(device.ask(write_byte), std::string{byte_written} + " | 185 09 00 00 00");
  EXPECT_EQ(device.ask(write_byte), byte_written);
  EXPECT_EQ(device.ask("605 2F 00 20 00 0A 00 00 00"), std::string{byte_written} + " | 185 0A 00 00 00");
}

TEST(WriteOfAnEqualValue, ByNumberSendsNoTpdoEither) {
  Device device;
  device.ask(bench::start);
  const std::uint8_t nine[] = {9};
  EXPECT_EQ(device.node.set(0x2000, 0, nine), canopen::ok);
  EXPECT_EQ(device.pass(0s), "185 09 00 00 00");
  EXPECT_EQ(device.node.set(0x2000, 0, nine), canopen::ok);
  EXPECT_EQ(device.pass(0s), "");
}

TEST(WriteOfAnEqualValue, OfAServicesParameterStillCounts) {
  Device device;
  EXPECT_EQ(device.ask("605 2B 17 10 00 64 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  device.pass(50ms);
  device.ask("605 2B 17 10 00 64 00 00 00");
  EXPECT_EQ(device.pass(99ms), "");
  EXPECT_EQ(device.pass(1ms), "705 7F");
}

TEST(WriteHandler, ThatSetsItsObjectHasTheLastWord) {
  auto device = with(canopen::on_write<od::byte>([](auto& node, std::uint8_t value) {
    static_cast<void>(node.template set<od::byte>(value > 5 ? std::uint8_t{5} : value));
  }));
  device.ask(bench::start);
  EXPECT_EQ(device.ask(write_byte), std::string{byte_written} + " | 185 05 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 5);
  EXPECT_EQ(device.ask(write_byte), byte_written) << "it was 5 before";
  EXPECT_EQ(device.node.get<od::byte>(), 5);
  device.ask("205 07 00 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 5) << "the same for an RPDO";
  device.ask("605 2F 00 20 00 03 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 3);
}

TEST(WriteHandler, ThatSetsAStringHasTheLastWord) {
  auto device = with(canopen::on_write<od::text>(
      [](auto& node, const auto&) { static_cast<void>(node.template set<od::text>("cut")); }));
  device.ask("605 23 06 20 00 61 62 63 64");
  EXPECT_EQ(device.node.get<od::text>().view(), "cut");
}

TEST(WriteHandler, ThatSetsAnotherObjectLeavesItsOwnToTheWrite) {
  auto device = with(canopen::on_write<od::byte>(
      [](auto& node, std::uint8_t value) { static_cast<void>(node.template set<od::word>(value)); }));
  device.ask(write_byte);
  EXPECT_EQ(device.node.get<od::byte>(), 9);
  EXPECT_EQ(device.node.get<od::word>(), 9);
}

// Parameters of services: the same rules as for SDO

TEST(SetOfAParameter, ObeysTheRulesOfItsService) {
  Device device;
  using tpdo1 = od::tpdo_communication_parameter_1::cob_id;
  EXPECT_EQ(device.node.set<tpdo1>(canopen::raw(0x190)), AbortCode::invalid_value) << "while it is valid";
  EXPECT_EQ(device.node.set<tpdo1>(canopen::raw(0x8000'0185)), canopen::ok);
  EXPECT_EQ(device.node.set<tpdo1>(canopen::raw(0x601)), AbortCode::invalid_value) << "restricted";
  EXPECT_EQ(device.node.set<tpdo1>(canopen::raw(0x190)), canopen::ok);
  EXPECT_EQ(canopen::to_raw(device.node.get<tpdo1>()), 0x190u);
  EXPECT_EQ(device.node.set<od::synchronous_counter_overflow_value>(canopen::raw(1)), AbortCode::invalid_value);
  EXPECT_EQ(device.node.set<od::cob_id_emcy>(canopen::raw(0x8000'0085)), canopen::ok);
  EXPECT_EQ(device.node.set<od::cob_id_emcy>(canopen::raw(0x585)), AbortCode::invalid_value);
}

// NMT commands from handlers

TEST(RequestInAWriteHandler, WaitsForTheSdoAnswer) {
  auto device = with(canopen::on_write<od::byte>(
      [](auto& node, std::uint8_t) { node.request(NmtCommand::reset_node, canopen::TimePoint{}); }));
  EXPECT_EQ(device.ask(write_byte), std::string{byte_written} + " | 705 00");
}

TEST(RequestInAWriteHandler, WaitsUntilTheBusHasTakenTheAnswer) {
  auto device = with(canopen::on_write<od::byte>(
      [](auto& node, std::uint8_t) { node.request(NmtCommand::reset_node, canopen::TimePoint{}); }));
  device.bus.room = 0;
  device.ask(write_byte);
  EXPECT_EQ(device.node.get<od::byte>(), 9);
  device.bus.room = 10;
  EXPECT_EQ(device.pass(0s), std::string{byte_written} + " | 705 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(RequestInAWriteHandler, GivesWayToANewerNmtCommand) {
  auto device = with(canopen::on_write<od::byte>(
      [](auto& node, std::uint8_t) { node.request(NmtCommand::start, canopen::TimePoint{}); }));
  device.bus.room = 0;
  device.ask(write_byte);
  EXPECT_EQ(device.node.state(), canopen::NmtState::pre_operational) << "the answer is not sent";
  device.ask("000 02 05");
  EXPECT_EQ(device.node.state(), canopen::NmtState::stopped);
  device.bus.room = 10;
  device.pass(1s);
  EXPECT_EQ(device.node.state(), canopen::NmtState::stopped);
}

TEST(RequestInAWriteHandler, OfAnRpdoComesAfterItsOtherObjects) {
  auto device = with(canopen::on_write<od::byte>(
      [](auto& node, std::uint8_t) { node.request(NmtCommand::reset_node, canopen::TimePoint{}); }));
  device.ask(bench::start);
  const std::string sent = device.ask("205 07 34 12 00 00 00 00");
  EXPECT_TRUE(sent.ends_with("705 00")) << sent;
  EXPECT_EQ(device.node.get<od::byte>(), 0);
  EXPECT_EQ(device.node.get<od::word>(), 0);
}

TEST(RequestInADomainHandler, WaitsForTheSdoAnswer) {
  auto device = with(
      canopen::on_domain_write<od::stream>([](auto& node, std::uint32_t, std::span<const std::uint8_t>, bool last) {
        if (last) node.request(NmtCommand::reset_node, canopen::TimePoint{});
      }));
  EXPECT_EQ(device.ask("605 23 08 20 00 01 02 03 04"), "585 60 08 20 00 00 00 00 00 | 705 00");
}

TEST(Request, OutsideOfHandlersIsCarriedOutAtOnce) {
  Device device;
  device.node.request(NmtCommand::reset_node, device.now);
  EXPECT_EQ(device.bus.take(), "705 00");
}

// Errors

TEST(Emergency, IsSentWithTheNextCall) {
  Device device;
  device.node.emergency(0x1000, ErrorRegister::generic);
  EXPECT_EQ(device.bus.take(), "");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  EXPECT_EQ(device.pass(0s), "085 00 10 01 00 00 00 00 00");
}

TEST(EmergencyOver, WithoutAnErrorSendsNothing) {
  Device device;
  device.node.emergency_over(ErrorRegister::generic);
  device.node.emergency_over(ErrorRegister::none);
  EXPECT_EQ(device.pass(1s), "");
  device.node.emergency(0x2310, ErrorRegister::current);
  EXPECT_EQ(device.pass(0s), "085 10 23 03 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::voltage);
  EXPECT_EQ(device.pass(0s), "");
  device.node.emergency_over(ErrorRegister::current);
  EXPECT_EQ(device.pass(0s), "085 00 00 00 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::current);
  EXPECT_EQ(device.pass(0s), "");
}

TEST(EmergencyOver, OfOneOfTwoErrorsWithTheSameBitNamesNone) {
  Device device;
  device.node.emergency(0x2310, ErrorRegister::current);
  device.node.emergency(0x2320, ErrorRegister::current);
  device.pass(0s);
  device.node.emergency_over(ErrorRegister::none);
  EXPECT_EQ(device.pass(0s), "085 00 00 03 00 00 00 00 00");
}

/// CiA 301, 7.5.2.2: bit 0 is set whenever there is an error.
TEST(Emergency, WithoutABitSetsTheGenericOne) {
  Device device;
  device.node.emergency(0xFF00, ErrorRegister::none);
  EXPECT_EQ(device.pass(0s), "085 00 FF 01 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::none);
  EXPECT_EQ(device.pass(0s), "085 00 00 00 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::none);
  EXPECT_EQ(device.pass(0s), "");
}

TEST(Emergency, ThatFindsNoRoomIsCounted) {
  Device device;
  device.bus.room = 0;
  for (std::uint16_t code = 1; code <= 40; ++code) device.node.emergency(code, ErrorRegister::generic);
  device.pass(1s);
  EXPECT_EQ(device.node.lost_emergencies(), 36);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s),
            "085 01 00 01 00 00 00 00 00 | 085 02 00 01 00 00 00 00 00 | "
            "085 03 00 01 00 00 00 00 00 | 085 28 00 01 00 00 00 00 00");
  EXPECT_EQ(device.node.lost_emergencies(), 36);
}

}  // namespace

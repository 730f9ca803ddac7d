/// A device whose EDS does not define its COB-IDs and transmission types: it uses the defaults of CiA 301.
#include <gtest/gtest.h>

#include <bare_device/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

namespace od = bare_device::od;
using namespace std::chrono_literals;
using Bench = bench::Bench<bare_device::Device>;

TEST(BareDevice, ObeysNmt) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(device.node.state(), canopen::NmtState::operational);
  device.ask(bench::stop);
  EXPECT_EQ(device.node.state(), canopen::NmtState::stopped);
}

// CiA 301, 7.5.2.33: 600h + node-ID and 580h + node-ID.
TEST(BareDevice, AnswersOnTheDefaultSdo) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 00 12 01 00 00 00 00"), "585 43 00 12 01 05 06 00 00");
  EXPECT_EQ(device.ask("605 40 00 12 02 00 00 00 00"), "585 43 00 12 02 85 05 00 00");
  EXPECT_EQ(device.ask("605 40 18 10 00 00 00 00 00"), "585 4F 18 10 00 01 00 00 00") << "the highest sub-index";
}

TEST(BareDevice, HasNoFurtherSdoServerUntilAMasterSwitchesItOn) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 01 12 01 00 00 00 00"), "585 43 01 12 01 00 00 00 80");
  EXPECT_EQ(device.ask("605 40 01 12 02 00 00 00 00"), "585 43 01 12 02 00 00 00 80");
  EXPECT_EQ(device.ask("000 40 00 10 00 00 00 00 00"), "");
}

// CiA 301, 7.3.5: the pre-defined connection set.
TEST(BareDevice, SendsItsFirstFourTpdosOnThePredefinedCanIds) {
  Bench device;
  EXPECT_EQ(device.ask(bench::start), "185 00 | 285 00 | 385 00 | 485 00");
  device.node.set<od::inputs<2>>(0x12);
  EXPECT_EQ(device.pass(1s), "285 12");
  device.node.set<od::inputs<5>>(0x55);
  EXPECT_EQ(device.pass(1s), "") << "TPDO 5 is off";
  EXPECT_EQ(device.ask("605 40 04 18 01 00 00 00 00"), "585 43 04 18 01 00 00 00 80");
}

TEST(BareDevice, TakesItsFirstFourRpdosFromThePredefinedCanIds) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 11");
  device.ask("305 22");
  device.ask("405 33");
  device.ask("505 44");
  EXPECT_EQ(device.node.get<od::outputs<1>>(), 0x11);
  EXPECT_EQ(device.node.get<od::outputs<2>>(), 0x22);
  EXPECT_EQ(device.node.get<od::outputs<3>>(), 0x33);
  EXPECT_EQ(device.node.get<od::outputs<4>>(), 0x44);
  device.ask("000 01 00");
  EXPECT_EQ(device.node.get<od::outputs<5>>(), 0) << "RPDO 5 is off";
}

TEST(BareDevice, IsEventDrivenWithoutTransmissionTypes) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 00 14 02 00 00 00 00"), "585 4F 00 14 02 FF 00 00 00");
  EXPECT_EQ(device.ask("605 40 00 18 02 00 00 00 00"), "585 4F 00 18 02 FF 00 00 00");
}

TEST(BareDevice, SendsItsEmcyOnThePredefinedCanId) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00") << "no error yet";
  device.node.emergency(0x5000, canopen::ErrorRegister::generic);
  EXPECT_EQ(device.pass(1s), "085 00 50 01 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 01 00 00 00");
}

TEST(BareDevice, ProducesSyncOnThePredefinedCanId) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 80 00 00 00");
  device.ask("605 23 06 10 00 10 27 00 00");
  device.ask("605 23 05 10 00 80 00 00 40");
  EXPECT_EQ(device.pass(10ms), "080");
}

TEST(BareDevice, HasTheCanIdOfTime) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 12 10 00 00 00 00 00"), "585 43 12 10 00 00 01 00 00");
}

TEST(BareDevice, NeverSendsOnCanId0) {
  Bench device;
  std::string sent = device.ask(bench::start) + " | ";
  for (const char* request :
       {"000 80 05", "000 01 05", "080", "100 00 00 00 00 00 00", "205 01", "605 40 00 10 00 00 00 00 00"})
    sent += device.ask(request) + " | ";
  device.node.emergency(0x1000, canopen::ErrorRegister::generic);
  sent += device.pass(10s);
  EXPECT_EQ(sent.find("000 "), std::string::npos) << sent;
}

}  // namespace

/// EMCY producer: messages, error register, history.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::ErrorRegister;
namespace od = pdo_device::od;
using namespace std::chrono_literals;

using Bench = bench::Bench<pdo_device::Device>;

TEST(Emcy, TellsAnErrorOnce) {
  Bench device;
  device.node.emergency(0x4210, ErrorRegister::temperature, {1, 2, 3, 4, 5});
  EXPECT_EQ(device.node.next_deadline(), device.now);
  EXPECT_EQ(device.pass(1s), "085 10 42 09 01 02 03 04 05");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0x09);
}

TEST(Emcy, TellsWhatIsLeftWhenAnErrorGoes) {
  Bench device;
  device.node.emergency(0x4210, ErrorRegister::temperature);
  device.node.emergency(0x3120, ErrorRegister::voltage);
  EXPECT_EQ(device.pass(0s), "085 10 42 09 00 00 00 00 00 | 085 20 31 0D 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::temperature);
  EXPECT_EQ(device.pass(0s), "085 00 00 05 00 00 00 00 00");
  device.node.emergency_over(ErrorRegister::voltage);
  EXPECT_EQ(device.pass(0s), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0);
}

TEST(Emcy, KeepsAHistoryWithTheNewestFirst) {
  Bench device;
  for (std::uint16_t code = 1; code <= 4; ++code) device.node.emergency(code, ErrorRegister::generic, {0xAA, 0xBB});
  device.pass(0s);
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 03 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 04 00 AA BB");
  EXPECT_EQ(device.ask("605 40 03 10 03 00 00 00 00"), "585 43 03 10 03 02 00 AA BB");
}

TEST(Emcy, HistoryIsEmptyAtFirst) {
  Bench device;
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 01 00 00 00 00"), "585 80 03 10 01 24 00 00 08");
}

TEST(Emcy, HistoryIsClearedByZeroOnly) {
  Bench device;
  device.node.emergency(0x1000, ErrorRegister::generic);
  device.pass(0s);
  EXPECT_EQ(device.ask("605 2F 03 10 00 01 00 00 00"), "585 80 03 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 2F 03 10 00 00 00 00 00"), "585 60 03 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 01 00 00 00 00"), "585 80 03 10 01 24 00 00 08");
}

TEST(Emcy, HistoryStaysInItsMemoryWhateverTheApplicationSets) {
  Bench device;
  const std::uint8_t count[] = {200};
  EXPECT_EQ(device.node.set(0x1003, 0, count), canopen::ok);
  EXPECT_EQ(device.node.set<od::inhibit_time_emcy>(canopen::raw(5)), canopen::ok);
  device.node.set<od::byte>(9);
  device.node.emergency(0x4210, ErrorRegister::temperature);
  device.pass(0s);
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 03 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 10 42 00 00");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::inhibit_time_emcy>()), 5);
  EXPECT_EQ(device.node.get<od::byte>(), 9);
}

TEST(Emcy, KeepsTheInhibitTime) {
  Bench device;
  device.ask("605 2B 15 10 00 64 00 00 00");  // 10 ms
  device.node.emergency(std::uint16_t{1}, ErrorRegister::generic);
  device.node.emergency(std::uint16_t{2}, ErrorRegister::generic);
  device.node.emergency(std::uint16_t{3}, ErrorRegister::generic);
  EXPECT_EQ(device.pass(9999us), "085 01 00 01 00 00 00 00 00");
  EXPECT_EQ(device.pass(1us), "085 02 00 01 00 00 00 00 00");
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), "085 03 00 01 00 00 00 00 00");
}

TEST(Emcy, IsHeldBackInStopped) {
  Bench device;
  device.ask(bench::stop);
  device.node.emergency(0x1000, ErrorRegister::generic);
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_FALSE(device.node.next_deadline());
  EXPECT_EQ(device.ask(bench::enter_pre_operational), "085 00 10 01 00 00 00 00 00");
}

TEST(Emcy, IsNotSentWhileItsCobIdIsInvalid) {
  Bench device;
  device.ask("605 23 14 10 00 85 00 00 80");
  device.node.emergency(0x1000, ErrorRegister::generic);
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_EQ(device.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 00 10 00 00");
}

TEST(Emcy, KeepsItsCanIdWhileItIsValid) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 14 10 00 86 00 00 00"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 14 10 00 85 00 00 00"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 14 10 00 86 00 00 80"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 14 10 00 87 00 00 00"), "585 60 14 10 00 00 00 00 00");
  device.node.emergency(0x1000, ErrorRegister::generic);
  EXPECT_EQ(device.pass(0s), "087 00 10 01 00 00 00 00 00");
}

TEST(Emcy, HasNoRestrictedCanId) {
  Bench device;
  device.ask("605 23 14 10 00 85 00 00 80");
  EXPECT_EQ(device.ask("605 23 14 10 00 01 07 00 00"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 14 10 00 00 08 00 00"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 14 10 00 00 00 00 80"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 14 10 00 00 00 00 00"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 14 10 00 80 00 00 00"), "585 80 14 10 00 30 00 09 06") << "a SYNC for all others";
  EXPECT_EQ(device.ask("605 23 14 10 00 00 07 00 00"), "585 60 14 10 00 00 00 00 00");
}

TEST(Emcy, MayHaveA29BitCanIdButNotBit30) {
  Bench device;
  device.ask("605 23 14 10 00 85 00 00 80");
  EXPECT_EQ(device.ask("605 23 14 10 00 85 00 00 40"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 14 10 00 01 00 00 20"), "585 60 14 10 00 00 00 00 00");
  device.node.emergency(0x1000, ErrorRegister::generic);
  EXPECT_EQ(device.pass(0s), "00000001 00 10 01 00 00 00 00 00");
}

TEST(Emcy, OfManyThatWaitTheLastOneStays) {
  Bench device;
  device.bus.room = 0;
  for (std::uint16_t code = 1; code <= 6; ++code) device.node.emergency(code, ErrorRegister::generic);
  device.pass(0s);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s),
            "085 01 00 01 00 00 00 00 00 | 085 02 00 01 00 00 00 00 00 | 085 03 00 01 00 00 00 00 00 | "
            "085 06 00 01 00 00 00 00 00");
}

TEST(Emcy, AResetForgetsAllErrors) {
  Bench device;
  device.node.emergency(0x1000, ErrorRegister::current);
  device.pass(0s);
  EXPECT_EQ(device.ask(bench::reset_communication), "705 00");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0);
  device.node.emergency(0x1000, ErrorRegister::voltage);
  EXPECT_EQ(device.pass(0s), "085 00 10 05 00 00 00 00 00");
}

}  // namespace

/// The generated device of mapped_strings.eds on a bus: its PDOs map strings.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <cstdint>
#include <mapped_strings/device.hpp>
#include <vector>

namespace {

namespace od = mapped_strings::od;
using Data = std::array<std::uint8_t, 8>;

struct RecordingBus {
  std::vector<canopen::Frame> sent;
  bool send(const canopen::Frame& frame) {
    sent.push_back(frame);
    return true;
  }
};

struct Device {
  RecordingBus bus;
  canopen::TimePoint now{};
  canopen::Node<mapped_strings::Device, RecordingBus> node{bus, canopen::NodeId{5}};

  Device() {
    node.start(now);
    node.on_frame({.id = 0x000, .size = 2, .data = {0x01, 0x05}}, now);
    bus.sent.clear();
  }

  /// Returns the last frame that was sent.
  canopen::Frame last() {
    node.on_time(now);
    return bus.sent.empty() ? canopen::Frame{} : bus.sent.back();
  }
};

TEST(MappedStrings, GoOutFilledUpWithZeros) {
  Device device;
  device.node.set<od::speed>(0x1234);
  EXPECT_EQ(device.last(), (canopen::Frame{.id = 0x185, .size = 7, .data = {'R', 'E', 'A', 'D', 'Y', 0x34, 0x12}}));
  device.node.set<od::state>("RUN");
  EXPECT_EQ(device.last(), (canopen::Frame{.id = 0x185, .size = 7, .data = {'R', 'U', 'N', 0, 0, 0x34, 0x12}}));
}

TEST(MappedStrings, AreTakenOver) {
  Device device;
  device.node.on_frame({.id = 0x205, .size = 7, .data = {'G', 'O', 0, 0xA1, 0x00, 0xA3, 0xA4}}, device.now);
  EXPECT_EQ(device.node.get<od::command>().view(), "GO");
  EXPECT_EQ(device.node.get<od::key>().size, 4);
  EXPECT_EQ(device.node.get<od::key>().bytes, (std::array<std::uint8_t, 4>{0xA1, 0x00, 0xA3, 0xA4}));
}

TEST(MappedStrings, OfAConstantAreCutToTheEntry) {
  const auto data = mapped_strings::Tpdo2::pack(Device{}.node.get<od::serial_number>(), 0x0102);
  EXPECT_EQ(data, (Data{0x12, 0x34, 0x56, 0x78, 0x02, 0x01}));
}

TEST(Dummies, OfAReal32AreSkipped) {
  Device device;
  device.node.on_frame({.id = 0x305, .size = 6, .data = {0x00, 0x00, 0xC0, 0x3F, 0x22, 0x11}}, device.now);
  EXPECT_EQ(device.node.get<od::speed_setpoint>(), 0x1122);
}

}  // namespace

/// 6060h accepts the modes of 6502h alone, whichever way a value comes, in a node with and without device control.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/node/value_check.hpp>
#include <canopen/storage/stored_value_check.hpp>
#include <cia402_drive/device.hpp>
#include <cstdint>
#include <every_mode/device.hpp>
#include <every_mode_static/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::NodeId;

/// Whether bit `mode - 1` of 6502h is set; 0 is "no mode" (CiA 402-2, 6060h and 6502h).
bool is_supported(int mode, std::uint32_t supported_drive_modes) {
  return mode == 0 || (mode >= 1 && mode <= 16 && ((supported_drive_modes >> (mode - 1)) & 1) != 0);
}

constexpr std::uint32_t every = 0x3EF;
constexpr std::uint32_t four = 0xA5;

template <class Device>
struct BareNode {
  BareNode() {
    node.start(now);
    ask(bench::start);
  }
  std::string ask(const std::string& request) {
    node.on_frame(bench::frame(request), now);
    node.on_time(now);
    return bus.take();
  }
  bench::RecordingBus bus;
  canopen::TimePoint now{};
  bench::NodeOf<Device, bench::RecordingBus> node{bus, NodeId{5}};
};

std::string byte(int value) {
  char text[3];
  static_cast<void>(std::snprintf(text, sizeof text, "%02X", static_cast<unsigned>(value) & 0xFF));
  return text;
}

template <class Device, std::uint16_t Index = 0x6060>
void expect_sdo(std::uint32_t modes) {
  const std::string object = byte(Index) + " " + byte(Index >> 8) + " 00 ";
  BareNode<Device> device;
  for (int mode = -128; mode <= 127; ++mode) {
    const std::string answer = device.ask("605 2F " + object + byte(mode) + " 00 00 00");
    EXPECT_EQ(answer,
              is_supported(mode, modes) ? "585 60 " + object + "00 00 00 00" : "585 80 " + object + "30 00 09 06")
        << mode;
  }
}

TEST(ModesOfOperation, AreThoseOf6502hBySdo) {
  expect_sdo<every_mode::Device>(every);
  expect_sdo<cia402_drive::Device>(four);
}

TEST(ModesOfOperation, AreThoseOfTheirOwnAxis) { expect_sdo<every_mode::Device, 0x6860>(0x4); }

template <class Device>
void expect_rpdo(std::int8_t (*present)(BareNode<Device>&)) {
  BareNode<Device> device;
  std::int8_t expected = 0;
  for (int mode = -128; mode <= 127; ++mode) {
    device.ask("505 " + byte(mode) + " 00 00");
    if (is_supported(mode, every)) expected = static_cast<std::int8_t>(mode);
    EXPECT_EQ(present(device), expected) << mode;
  }
}

TEST(ModesOfOperation, AreThoseOf6502hByRpdo) {
  expect_rpdo<every_mode::Device>(
      [](auto& device) { return canopen::to_raw(device.node.get(every_mode::od::modes_of_operation{})); });
  expect_rpdo<every_mode_static::Device>(
      [](auto& device) { return canopen::to_raw(device.node.get(every_mode_static::od::modes_of_operation{})); });
}

TEST(ModesOfOperation, AreThoseOf6502hByAMappedRpdoThatRepeatsThem) {
  BareNode<cia402_drive::Device> device;
  for (const char* request :
       {"605 23 01 14 01 05 03 00 80", "605 2F 01 14 02 FF 00 00 00", "605 2F 01 16 00 00 00 00 00",
        "605 23 01 16 01 08 00 60 60", "605 23 01 16 02 20 00 7A 60", "605 2F 01 16 00 02 00 00 00",
        "605 23 01 14 01 05 03 00 00"})
    EXPECT_EQ(device.ask(request).substr(0, 6), "585 60") << request;
  std::int8_t expected = canopen::to_raw(device.node.get(cia402_drive::od::modes_of_operation{}));
  std::int32_t position = 0;
  for (int mode = -128; mode <= 127; ++mode) {
    if (is_supported(mode, four)) expected = static_cast<std::int8_t>(mode);
    for (int time = 0; time < 2; ++time) {
      ++position;
      device.ask("305 " + byte(mode) + " " + byte(position) + " " + byte(position >> 8) + " 00 00");
      EXPECT_EQ(canopen::to_raw(device.node.get(cia402_drive::od::modes_of_operation{})), expected) << mode;
      EXPECT_EQ(canopen::to_raw(device.node.get(cia402_drive::od::target_position{})), position) << mode;
    }
  }
}

TEST(ModesOfOperation, AreThoseOf6502hByTheApplication) {
  using Mode = every_mode::od::modes_of_operation;
  static_assert(canopen::can_be_refused<Mode>, "the result of set must be used");
  BareNode<every_mode::Device> device;
  for (int mode = -128; mode <= 127; ++mode) {
    const auto value = static_cast<std::int8_t>(mode);
    const AbortCode expected = is_supported(mode, every) ? canopen::ok : AbortCode::invalid_value;
    EXPECT_EQ(device.node.set<Mode>(canopen::from_raw<Mode::type>(value)), expected) << mode;
    const std::uint8_t bytes[] = {static_cast<std::uint8_t>(mode)};
    EXPECT_EQ(device.node.set(0x6060, 0, bytes), expected) << mode;
    EXPECT_EQ(canopen::check_value<canopen::NumbersOf<Mode>>(mode), expected) << mode;
  }
}

TEST(ModesOfOperation, AreThoseOf6502hInAStorage) {
  using Check = canopen::StoredValueCheck<every_mode::Device>;
  for (const std::uint16_t index : {std::uint16_t{0x6060}, std::uint16_t{0x6860}}) {
    for (int mode = -128; mode <= 127; ++mode) {
      const std::uint8_t bytes[] = {static_cast<std::uint8_t>(mode)};
      EXPECT_EQ(Check::is_possible(index, 0, every_mode::dictionary.find(index, 0), bytes),
                is_supported(mode, index == 0x6060 ? every : 0x4))
          << mode;
    }
  }
}

TEST(ModesOfOperation, AreRejectedBeforeTheyAreStored) {
  BareNode<every_mode::Device> device;
  device.ask("605 2F 60 60 00 03 00 00 00");
  device.ask("605 2F 60 60 00 05 00 00 00");
  EXPECT_EQ(device.ask("605 40 60 60 00 00 00 00 00"), "585 4F 60 60 00 03 00 00 00");
}

}  // namespace

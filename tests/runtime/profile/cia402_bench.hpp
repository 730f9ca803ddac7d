/// A drive with every object of CiA 402 that the profile uses, and an axis whose units are one increment, one increment
/// per second and one increment per second squared.
#pragma once

#include <gtest/gtest.h>

#include <cia402_drive/device.hpp>
#include <cstdint>
#include <string>

#include "nodes/node_bench.hpp"
#include "shared/drive_node.hpp"

namespace bench {

using canopen::cia402::State;
namespace od = cia402_drive::od;

inline constexpr canopen::cia402::AxisData plain_axis{.increments_per_turn = 1'000,
                                                      .velocity_unit = 1,
                                                      .acceleration_unit = 1,
                                                      .highest_velocity = 1'000'000,
                                                      .highest_acceleration = 100'000'000};

template <canopen::Bus B>
class PlainDrive : public nodes::DriveNode<PlainDrive<B>, cia402_drive::Device, B, canopen::cia402::Options{}> {
  using Base = nodes::DriveNode<PlainDrive<B>, cia402_drive::Device, B, canopen::cia402::Options{}>;

 public:
  PlainDrive(B& bus, nodes::Surroundings& around)
      : Base{bus, around, around.node_id.value_or(canopen::NodeId{5}), plain_axis} {}

  [[nodiscard]] auto& device_control() { return this->drive_; }
};

/// Operational; the first TPDO1 has been removed. TPDO1 is the statusword.
struct DriveBench : NodeBench<PlainDrive> {
  DriveBench() { ask(start); }

  /// RPDO1: the controlword. Returns what the drive sends in response.
  std::string control(std::uint16_t word) { return ask(text({.id = 0x205, .size = 2, .data = bytes(word)})); }
  /// RPDO2: controlword and target position.
  std::string control(std::uint16_t word, std::int32_t target) {
    canopen::Frame frame{.id = 0x305, .size = 6, .data = bytes(word)};
    for (unsigned i = 0; i < 4; ++i)
      frame.data[2 + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(target) >> (8 * i));
    return ask(text(frame));
  }
  /// Sets an object by its raw number.
  template <class O>
  void set(canopen::RawOf<typename O::type> number) {
    EXPECT_EQ(app->node().template set<O>(canopen::from_raw<typename O::type>(number)), canopen::ok);
    app->on_time(now);
    bus.take();
  }
  template <class O>
  [[nodiscard]] canopen::RawOf<typename O::type> get() {
    return canopen::to_raw(app->node().template get<O>());
  }
  [[nodiscard]] std::uint16_t statusword() { return get<od::statusword>(); }
  [[nodiscard]] State state() const { return app->drive().state(); }
  [[nodiscard]] std::int32_t position() const { return app->axis().position(); }
  [[nodiscard]] std::int32_t velocity() const { return app->axis().velocity(); }

  /// Brings the drive to Operation Enabled in a mode.
  void enable(std::int8_t mode) {
    set<od::modes_of_operation>(mode);
    for (const int word : {0x06, 0x07, 0x0F}) control(static_cast<std::uint16_t>(word));
    EXPECT_EQ(state(), State::operation_enabled);
  }
  /// Also lets the motor turn in profile velocity.
  void run(std::int32_t velocity) {
    set<od::target_velocity>(velocity);
    enable(canopen::cia402::mode::profile_velocity);
    pass(std::chrono::seconds{1});
    EXPECT_EQ(this->velocity(), velocity);
  }

 private:
  [[nodiscard]] static std::array<std::uint8_t, 8> bytes(std::uint16_t word) {
    return {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)};
  }
};

}  // namespace bench

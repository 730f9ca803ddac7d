/// A whole drive node with each mode of operation, the simulated axis, and a bus: requests and responses are frames.
#pragma once

#include <gtest/gtest.h>

#include <canopen/profile/cia402_node.hpp>
#include <canopen/profile/cia402_simulated_axis.hpp>
#include <chrono>
#include <cstdint>
#include <every_mode/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace bench {

/// Positions in increments, velocities in increments per second; 0.1 % of the torque accelerates by 100 per second
/// squared.
struct Motor : canopen::cia402::SimulatedAxis {
  Motor()
      : SimulatedAxis{{.increments_per_turn = 1'000,
                       .velocity_unit = 1,
                       .acceleration_unit = 1,
                       .highest_velocity = 1'000'000,
                       .highest_acceleration = 100'000'000,
                       .torque_acceleration = 100}} {}
};

template <class Device = every_mode::Device, class Axis = Motor>
struct EveryMode {
  EveryMode() {
    drive.start(now);
    ask("000 01 05");
  }

  std::string ask(const std::string& request) {
    drive.on_frame(frame(request), now);
    return bus.take();
  }
  /// Lets time pass; the node is called when it is due.
  void pass(canopen::Duration span) {
    const canopen::TimePoint end = now + span;
    while (drive.next_deadline() && *drive.next_deadline() <= end) {
      if (*drive.next_deadline() > now) now = *drive.next_deadline();
      drive.on_time(now);
    }
    now = end;
    drive.on_time(now);
  }
  /// Writes an object by SDO; returns the abort code, 0 for success.
  std::uint32_t write(std::uint16_t index, unsigned sub_index, std::int64_t value, unsigned bytes) {
    canopen::Frame request{.id = 0x605, .size = 8};
    request.data = {static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2), static_cast<std::uint8_t>(index),
                    static_cast<std::uint8_t>(index >> 8), static_cast<std::uint8_t>(sub_index)};
    for (unsigned i = 0; i < bytes; ++i) request.data[4 + i] = static_cast<std::uint8_t>(value >> (8 * i));
    bus.sent.clear();
    drive.on_frame(request, now);
    while (!bus.sent.empty() && bus.sent.front().id != 0x585) bus.sent.pop_front();
    EXPECT_FALSE(bus.sent.empty()) << "no response";
    const canopen::Frame answer = bus.sent.front();
    bus.sent.clear();
    if (answer.data[0] != 0x80) return 0;
    return static_cast<std::uint32_t>(answer.data[4] | answer.data[5] << 8 | answer.data[6] << 16) |
           static_cast<std::uint32_t>(answer.data[7]) << 24;
  }
  /// Writes the controlword with RPDO 1.
  void control(unsigned word) {
    drive.on_frame(
        {.id = 0x205, .size = 2, .data = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)}}, now);
    bus.take();
  }
  /// Brings the drive to Operation Enabled in a mode.
  void enable(std::int8_t mode, unsigned word = 0x0F) {
    EXPECT_EQ(write(0x6060, 0, mode, 1), 0u);
    for (const unsigned one : {0x06u, 0x07u, word}) control(one);
    EXPECT_EQ(status() & 0x6F, 0x27u);
    EXPECT_EQ(get<every_mode::od::modes_of_operation_display>(), mode);
  }

  template <class O>
  [[nodiscard]] canopen::RawOf<typename O::type> get() {
    return canopen::to_raw(drive.node().template get<O>());
  }
  [[nodiscard]] unsigned status() { return get<every_mode::od::statusword>(); }
  [[nodiscard]] bool bit(unsigned number) { return (status() >> number & 1) != 0; }
  [[nodiscard]] auto& axis() { return drive.axis(); }

  RecordingBus bus;
  canopen::TimePoint now{};
  canopen::cia402::DriveNode<Device, RecordingBus, Axis> drive{bus, canopen::NodeId{5}};
};

}  // namespace bench

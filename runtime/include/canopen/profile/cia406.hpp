/// Encoders (CiA 406): measured values with preset, measuring steps, and the cyclic timer.
///
///     canopen::Encoder<rk5c::Device> encoder;
///     auto sensor = canopen::make_node<rk5c::Device>(bus, id, canopen::cyclic_timer_sets_event_timer(),
///                                                    canopen::event_timer_sets_cyclic_timer(), ...);
///     encoder.measured(sensor, position, speed);           // each measuring cycle, in measuring steps
///     encoder.preset(value);                               // from the write handler of 6003h or 6010h
///
/// Not supported: cams, scaling and code sequence of 6000h, and the diagnostic objects from 6500h on.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/od/object.hpp"
#include "canopen/profile/channels.hpp"

namespace canopen {

/// One channel of an encoder. Its values are 6020h:Channel and 6030h:Channel of a multi-sensor device, or 6004h for the
/// only channel of other devices.
template <class Device, std::uint8_t Channel = 1>
class Encoder {
  static constexpr bool has_position = Device::dictionary.has(0x6020, Channel);
  static constexpr bool has_single_position = Channel == 1 && Device::dictionary.has(0x6004, 0);
  static constexpr bool has_speed = Device::dictionary.has(0x6030, Channel);

 public:
  /// Sets the measured values, in measuring steps. The offset is added to the position in the objects.
  template <class Node>
  void measured(Node& node, std::int32_t position, std::int16_t speed) {
    static_assert(has_position || has_single_position, "this device has neither 6004h nor this channel of 6020h");
    measured_ = position;
    const std::int32_t reported = wrapped(position, offset_);
    if constexpr (has_position) set(node, 0x6020, Channel, reported);
    if constexpr (has_single_position) set(node, 0x6004, 0, reported);
    if constexpr (has_speed) set(node, 0x6030, Channel, speed);
  }

  /// Sets the offset so that the present position has this value from the next `measured` on.
  void preset(std::int32_t value) {
    offset_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) - static_cast<std::uint32_t>(measured_));
  }

  /// Returns the offset that is added to the measured position, for the device to store.
  [[nodiscard]] std::int32_t offset() const { return offset_; }
  void set_offset(std::int32_t offset) { offset_ = offset; }

  /// Converts a length to measuring steps: 6005h:01 is in nanometres. 0 if 6005h:01 is 0.
  template <class Node>
  [[nodiscard]] static std::int32_t position_steps(Node& node,
                                                   std::int64_t nanometres) requires(Device::dictionary.has(0x6005,
                                                                                                            1)) {
    const std::uint32_t step = node.entries().template number<0x6005, 1>();
    return step == 0 ? 0 : static_cast<std::int32_t>(nanometres / step);
  }

  /// Converts a speed to measuring steps: 6005h:02 is in units of 0.01 mm/s.
  template <class Node>
  [[nodiscard]] static std::int16_t speed_steps(Node& node,
                                                std::int32_t hundredths) requires(Device::dictionary.has(0x6005, 2)) {
    const std::uint32_t step = node.entries().template number<0x6005, 2>();
    return step == 0 ? std::int16_t{0} : static_cast<std::int16_t>(hundredths / static_cast<std::int32_t>(step));
  }

 private:
  [[nodiscard]] static std::int32_t wrapped(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
  }

  /// TPDOs are triggered if the value has changed.
  template <class Node, class Type>
  static void set(Node& node, std::uint16_t index, std::uint8_t sub_index, Type value) {
    const entry::Word word = Device::dictionary.find(index, sub_index);
    if (static_cast<Type>(node.entries().number(word)) == value) return;
    std::array<std::uint8_t, sizeof(Type)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    static_cast<void>(node.set(index, sub_index, bytes));
  }

  std::int32_t measured_ = 0;
  std::int32_t offset_ = 0;
};

namespace cia406_detail {

/// Copies a value that is written to one object to another one.
template <std::uint16_t Index, std::uint8_t SubIndex>
struct Copy {
  void operator()(auto& node, std::uint16_t value) const {
    const std::uint8_t bytes[] = {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
    static_cast<void>(node.set(Index, SubIndex, bytes));
  }
};

using CyclicTimer = Object<0x6200, 0x00, std::uint16_t, Access::rw>;
using EventTimer = Object<0x1800, 0x05, std::uint16_t, Access::rw>;

}  // namespace cia406_detail

using CyclicTimerHandler = WriteHandler<cia406_detail::CyclicTimer, cia406_detail::Copy<0x1800, 5>>;
using EventTimerHandler = WriteHandler<cia406_detail::EventTimer, cia406_detail::Copy<0x6200, 0>>;

/// Handlers that keep the cyclic timer 6200h and the event timer of TPDO 1 equal, in ms.
[[nodiscard]] constexpr CyclicTimerHandler cyclic_timer_sets_event_timer() { return {}; }
[[nodiscard]] constexpr EventTimerHandler event_timer_sets_cyclic_timer() { return {}; }

}  // namespace canopen

/// Values of the objects of a drive, with the defaults of CiA 402-2 for objects that the device does not have.
#pragma once

#include <algorithm>
#include <cstdint>

#include "canopen/od/accepted_values.hpp"
#include "canopen/od/access.hpp"
#include "canopen/od/object.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_option_code.hpp"
#include "canopen/profile/cia402_options.hpp"

namespace canopen::cia402 {

/// Between the objects of two axes of a device.
inline constexpr unsigned axis_distance = 0x800;

template <class Device, Options options>
struct Parameters {
  /// The object of this axis.
  template <class ObjectType>
  using At = Object<ObjectType::index + options.axis * axis_distance, ObjectType::sub_index, typename ObjectType::type,
                    Access::rw>;

  template <class ObjectType>
  static constexpr bool has = Device::dictionary.has(At<ObjectType>::index, ObjectType::sub_index);

  /// The modes that 6060h accepts by the EDS, as bits of 6502h; 0: the EDS does not list them.
  static constexpr std::uint32_t listed_modes = [] {
    std::uint32_t modes = 0;
    for (const AcceptedRange& row : Device::dictionary.accepted) {
      if (row.index != At<object::ModesOfOperation>::index) continue;
      // NOLINTNEXTLINE(bugprone-signed-char-misuse): modes of the manufacturer are negative
      for (int number = row.values.low; number <= row.values.high; ++number) {
        modes |= bit_of_mode(static_cast<std::int8_t>(number));
      }
    }
    return modes;
  }();
  static_assert(
      options.modes == 0 || listed_modes == 0 || options.modes == (listed_modes & implemented_modes),
      "options.modes of a drive differs from 6502h: leave it out, or change the EDS or drive.additional_modes");

  static constexpr std::uint32_t modes = options.modes != 0  ? options.modes
                                         : listed_modes != 0 ? listed_modes & implemented_modes
                                                             : usual_modes;

  /// The lowest manufacturer-specific mode; 0: none.
  static constexpr std::int8_t lowest_mode = [] {
    std::int8_t lowest = options.lowest_mode;
    if (lowest != 0) return lowest;
    for (const AcceptedRange& row : Device::dictionary.accepted) {
      if (row.index == At<object::ModesOfOperation>::index) lowest = std::min(lowest, row.values.low);
    }
    return lowest;
  }();

  /// Whether the drive has a mode of the standard.
  [[nodiscard]] static constexpr bool has_mode(std::int8_t wanted) { return (modes & bit_of_mode(wanted)) != 0; }

  /// Whether 6060h accepts a value, and the drive has this mode.
  [[nodiscard]] static constexpr bool supports(std::int8_t wanted) {
    return wanted == mode::none || has_mode(wanted) || (wanted < 0 && wanted >= lowest_mode) ||
           (listed_modes & ~implemented_modes & bit_of_mode(wanted)) != 0;
  }

  /// Whether the application operates modes: manufacturer-specific ones, and those of 6502h that the profile lacks.
  static constexpr bool leaves_modes =
      (listed_modes & ~implemented_modes) != 0 || (lowest_mode < 0 && listed_modes != 0);

  /// Returns the value of an object; `otherwise` if the device does not have it. A node whose objects are not known
  /// when it is compiled has value_or.
  template <class ObjectType, class Node>
  [[nodiscard]] static typename ObjectType::type value(const Node& node, typename ObjectType::type otherwise) {
    if constexpr (requires { node.template value_or<At<ObjectType>>(otherwise); }) {
      return node.template value_or<At<ObjectType>>(otherwise);
    } else if constexpr (has<ObjectType>) {
      return node.template get<At<ObjectType>>();
    } else {
      return otherwise;
    }
  }

  /// Sets an object, if the device has it.
  template <class ObjectType, class Node>
  static void set([[maybe_unused]] Node& node, [[maybe_unused]] const typename ObjectType::type& new_value) {
    if constexpr (has<ObjectType>) static_cast<void>(node.template set<At<ObjectType>>(new_value));
  }

  /// Returns the braking that an option code selects, whose default is `otherwise`.
  template <class ObjectType, class Node>
  [[nodiscard]] static Braking braking(const Node& node, std::int16_t otherwise) {
    return braking_of(value<ObjectType>(node, otherwise));
  }

  /// Returns 605Ah.
  template <class Node>
  [[nodiscard]] static std::int16_t quick_stop_option(const Node& node) {
    return value<object::QuickStopOptionCode>(node, option_code::quick_stop);
  }

  /// Returns 6081h, 6083h and 6084h.
  template <class Node>
  [[nodiscard]] static Profile profile(const Node& node) {
    return {at_most_allowed(node, value<object::ProfileVelocity>(node, options.profile.velocity)),
            value<object::ProfileAcceleration>(node, options.profile.acceleration),
            value<object::ProfileDeceleration>(node, options.profile.deceleration)};
  }

  /// Returns 6085h.
  template <class Node>
  [[nodiscard]] static std::uint32_t quick_stop_deceleration(const Node& node) {
    return value<object::QuickStopDeceleration>(node, profile(node).deceleration);
  }

  /// Returns the deceleration of a braking with power; 0: as hard as possible.
  template <class Node>
  [[nodiscard]] static std::uint32_t deceleration(const Node& node, Braking braking) {
    if (braking == Braking::slow_down_ramp) return profile(node).deceleration;
    return braking == Braking::quick_stop_ramp ? quick_stop_deceleration(node) : 0;
  }

  /// Returns a speed limited to 607Fh, where 0 is no limit.
  template <class Node>
  [[nodiscard]] static std::uint32_t at_most_allowed(const Node& node, std::uint32_t speed) {
    const std::uint32_t most = value<object::MaxProfileVelocity>(node, 0);
    return most != 0 ? std::min(speed, most) : speed;
  }

  /// Returns a position limited to 607Dh; unchanged without limits, and if the upper one is not above the lower one.
  template <class Node>
  [[nodiscard]] static std::int32_t within_software_limits([[maybe_unused]] const Node& node, std::int32_t position) {
    if constexpr (has<object::MinPositionLimit> && has<object::MaxPositionLimit>) {
      const std::int32_t lowest = value<object::MinPositionLimit>(node, 0);
      const std::int32_t highest = value<object::MaxPositionLimit>(node, 0);
      if (lowest < highest) return std::clamp(position, lowest, highest);
    }
    return position;
  }

  /// Whether a position is at or beyond the software limit in this direction.
  template <class Node>
  [[nodiscard]] static bool software_limit_blocks(const Node& node, std::int32_t position, std::int32_t direction) {
    constexpr std::int32_t highest = 0x7FFF'FFFF;
    constexpr std::int32_t lowest = -highest - 1;
    return (direction > 0 && within_software_limits(node, highest) <= position && position != highest) ||
           (direction < 0 && within_software_limits(node, lowest) >= position && position != lowest);
  }
};

}  // namespace canopen::cia402

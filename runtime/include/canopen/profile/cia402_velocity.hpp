/// Velocity mode (2), as of a frequency converter: limits, factors and ramps of 6042h (CiA 402-2, velocity mode).
#pragma once

#include <algorithm>
#include <cstdint>

#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"

namespace canopen::cia402 {

/// The objects of velocity mode in the units of the axis. 6042h times 604Bh and 604Ch is in rpm. A factor with a 0 is
/// not used.
template <class DriveParameters, Options options>
struct Velocity {
  /// Returns 6042h within 6046h; 0 stays 0.
  template <class Node>
  [[nodiscard]] static std::int32_t target(const Node& node) {
    const std::int32_t wanted = DriveParameters::template value<object::VelocityTarget>(node, 0);
    constexpr std::uint32_t highest = 0x7FFF'FFFF;
    const std::uint32_t most =
        std::min(DriveParameters::template value<object::VelocityMaxAmount>(node, highest), highest);
    const std::uint32_t least = std::min(DriveParameters::template value<object::VelocityMinAmount>(node, 0), most);
    const auto amount = static_cast<std::uint32_t>(wanted < 0 ? -wanted : wanted);
    const auto limited = static_cast<std::int32_t>(std::clamp(amount, least, most));
    return wanted == 0 ? 0 : to_axis(node, wanted < 0 ? -limited : limited, options.velocity_of_rpm);
  }

  /// Returns 6048h and 6049h; without them, 6083h and 6084h.
  template <class Node>
  [[nodiscard]] static Profile ramps(const Node& node) {
    const Profile profile = DriveParameters::profile(node);
    return {profile.velocity,
            slope<object::VelocityAccelerationSpeed, object::VelocityAccelerationTime>(node, profile.acceleration),
            slope<object::VelocityDecelerationSpeed, object::VelocityDecelerationTime>(node, profile.deceleration)};
  }

  /// Returns 604Ah; `otherwise` without it.
  template <class Node>
  [[nodiscard]] static std::uint32_t quick_stop(const Node& node, std::uint32_t otherwise) {
    return slope<object::VelocityQuickStopSpeed, object::VelocityQuickStopTime>(node, otherwise);
  }

  /// Returns a velocity of the axis in the unit of 6042h, for 6043h and 6044h.
  template <class Node>
  [[nodiscard]] static std::int16_t from_axis(const Node& node, std::int32_t velocity) {
    std::int64_t value = scaled(velocity, {options.velocity_of_rpm.denominator, options.velocity_of_rpm.numerator});
    const Ratio dimension = dimension_factor(node);
    const Ratio set_point = set_point_factor(node);
    value = scaled(value, {dimension.denominator, dimension.numerator});
    value = scaled(value, {set_point.denominator, set_point.numerator});
    return static_cast<std::int16_t>(std::clamp<std::int64_t>(value, -0x8000, 0x7FFF));
  }

 private:
  /// A speed per time; a time of 0 is as steep as the axis allows, and so is a slope of 0.
  template <class Speed, class Time, class Node>
  [[nodiscard]] static std::uint32_t slope(const Node& node, std::uint32_t otherwise) {
    if constexpr (DriveParameters::template has<Speed>) {
      const std::uint32_t time = DriveParameters::template value<Time>(node, 1);
      if (time == 0) return 0;
      const auto speed = static_cast<std::int32_t>(
          std::min<std::uint32_t>(DriveParameters::template value<Speed>(node, 0), 0x7FFF'FFFF));
      const std::int32_t per_time = to_axis(node, speed, options.acceleration_of_rpm);
      return static_cast<std::uint32_t>(per_time < 0 ? 0 : per_time) / time;
    } else {
      return otherwise;
    }
  }

  template <class Node>
  [[nodiscard]] static std::int32_t to_axis(const Node& node, std::int32_t value, Ratio of_rpm) {
    const std::int64_t rpm = scaled(scaled(value, set_point_factor(node)), dimension_factor(node));
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(scaled(rpm, of_rpm), -0x7FFF'FFFF, 0x7FFF'FFFF));
  }

  template <class Node>
  [[nodiscard]] static Ratio set_point_factor(const Node& node) {
    return {DriveParameters::template value<object::SetPointNumerator>(node, 1),
            DriveParameters::template value<object::SetPointDenominator>(node, 1)};
  }
  template <class Node>
  [[nodiscard]] static Ratio dimension_factor(const Node& node) {
    return {DriveParameters::template value<object::DimensionNumerator>(node, 1),
            DriveParameters::template value<object::DimensionDenominator>(node, 1)};
  }

  /// Limited to 32 bits, so that factors do not overflow.
  [[nodiscard]] static std::int64_t scaled(std::int64_t value, Ratio by) {
    if (by.numerator == 0 || by.denominator == 0 || by.numerator == by.denominator) return value;
    return std::clamp<std::int64_t>(value * by.numerator / by.denominator, -0x7FFF'FFFF, 0x7FFF'FFFF);
  }
};

}  // namespace canopen::cia402

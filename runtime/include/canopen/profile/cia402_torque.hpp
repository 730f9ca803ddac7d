/// Profile torque (4) and cyclic synchronous torque (10): limits and slope of 6071h (CiA 402-2, torque modes).
#pragma once

#include <algorithm>
#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_parameters.hpp"

namespace canopen::cia402 {

/// The torque demand 6074h. Torque is in 0.1 % of the rated torque.
template <class DriveParameters>
class Torque {
 public:
  /// The next demand begins at 0.
  void clear() { *this = Torque{}; }

  [[nodiscard]] std::int16_t demand() const { return demand_; }
  /// Whether the demand has reached the target.
  [[nodiscard]] bool reached() const { return demand_ == target_; }
  /// Whether 6072h, 60E0h or 60E1h limits the target.
  [[nodiscard]] bool limited() const { return limited_; }

  /// Profile torque: the demand moves to 6071h with the slope 6087h, in 0.1 % per second; at once if that is 0.
  template <class Node>
  void approach(const Node& node, Duration span) {
    take_target(node, DriveParameters::template value<object::TargetTorque>(node, 0));
    const std::uint32_t slope = DriveParameters::template value<object::TorqueSlope>(node, 0);
    if (slope == 0) {
      demand_ = target_;
      return;
    }
    constexpr std::uint64_t second = 1'000'000;
    const std::uint64_t grown = rest_ + std::uint64_t{slope} * static_cast<std::uint32_t>(span.count());
    const auto most = static_cast<std::int32_t>(std::min<std::uint64_t>(grown / second, 0x1'0000));
    rest_ = reached() ? 0 : static_cast<std::uint32_t>(grown % second);
    const std::int32_t way = target_ - demand_;
    demand_ = static_cast<std::int16_t>(demand_ + std::clamp(way, -most, most));
  }

  /// Cyclic synchronous torque: the demand is 6071h plus the offset 60B2h.
  template <class Node>
  void follow(const Node& node) {
    take_target(node, DriveParameters::template value<object::TargetTorque>(node, 0) +
                          std::int32_t{DriveParameters::template value<object::TorqueOffset>(node, 0)});
    demand_ = target_;
  }

  /// A limit blocks the motion.
  void block() {
    demand_ = 0;
    rest_ = 0;
  }

 private:
  template <class Node>
  void take_target(const Node& node, std::int32_t wanted) {
    const auto limit = [&](std::uint16_t other) {
      const std::uint16_t most = std::min(DriveParameters::template value<object::MaxTorque>(node, 0x7FFF), other);
      return std::int32_t{std::min<std::uint16_t>(most, 0x7FFF)};
    };
    const std::int32_t positive = limit(DriveParameters::template value<object::PositiveTorqueLimit>(node, 0x7FFF));
    const std::int32_t negative = limit(DriveParameters::template value<object::NegativeTorqueLimit>(node, 0x7FFF));
    const std::int32_t allowed = std::clamp(wanted, -negative, positive);
    limited_ = allowed != wanted;
    target_ = static_cast<std::int16_t>(allowed);
  }

  std::int16_t demand_ = 0;
  std::int16_t target_ = 0;
  bool limited_ = false;
  std::uint32_t rest_ = 0;  ///< of the slope, in millionths of a unit
};

}  // namespace canopen::cia402

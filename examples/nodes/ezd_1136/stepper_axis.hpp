/// The motor of the stepper drive with its encoder, current and torque.
#pragma once

#include <algorithm>
#include <canopen/base/clock.hpp>
#include <canopen/profile/cia402_axis.hpp>
#include <canopen/profile/cia402_simulated_axis.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

#include "terminals.hpp"

namespace ezd_1136_node {

/// Values of 20CEh: what commands the motor.
enum class Control : std::uint16_t {
  pulses = 0,    ///< the pulse input
  software = 1,  ///< the modes of operation
  torque = 5,    ///< 6071h
  pressing = 6,  ///< the modes of operation, until the motor presses against something
};

/// The settings of the axis, in the units of their objects.
struct StepperSettings {
  std::uint32_t resolution = 4'000;                                 ///< 20F2h, pulses per turn
  bool motor_reversed = false;                                      ///< bit 0 of 20C9h
  bool encoder_reversed = false;                                    ///< bit 1 of 20C9h
  bool closed_loop = true;                                          ///< 20D9h
  std::uint32_t jump_speed = 0;                                     ///< 6082h, 0.01 turns per second
  std::uint16_t filter = 50;                                        ///< 20E0h
  std::int16_t target_torque = 0;                                   ///< 6071h
  std::uint32_t torque_slope = 0;                                   ///< 6087h, per second; 0: at once
  std::int16_t torque_speed = 0;                                    ///< 211Fh, 0.01 turns per second
  std::int16_t reference_torque = 0;                                ///< 2103h; 0: pressing does not end a motion
  std::int16_t check_torque = 0;                                    ///< 211Eh, ms
  std::uint16_t locked_above = 0;                                   ///< 20DBh, 0.01 turns per second
  std::uint16_t locked_count = 0;                                   ///< 20DDh, ms
  std::int32_t lowest = std::numeric_limits<std::int32_t>::min();   ///< 607Dh:01
  std::int32_t highest = std::numeric_limits<std::int32_t>::max();  ///< 607Dh:02
};

/// Positions are pulses, velocities 0.01 turns per second, ramps turns per second squared.
[[nodiscard]] constexpr canopen::cia402::AxisData axis_data(std::uint32_t pulses_per_turn) {
  const auto pulses = static_cast<double>(pulses_per_turn);
  return {.increments_per_turn = pulses,
          .velocity_unit = pulses / 100,
          .acceleration_unit = pulses,
          .highest_velocity = pulses * 50,
          .highest_acceleration = pulses * 2'000};
}

/// The trajectory is in commanded pulses. The actual values come from the encoder in closed loop, and from the
/// trajectory in open loop. Torque is in 0.1 % of the rated torque, which gives the motor 1000 turns per
/// second squared.
class StepperAxis : public canopen::cia402::SimulatedAxis {
  using Base = canopen::cia402::SimulatedAxis;

 public:
  explicit StepperAxis(const canopen::cia402::AxisData& data) : Base{data}, turn_{data.increments_per_turn} {}

  // canopen::cia402::Axis

  void enable(bool on) {
    if (on != powered_) {
      powered_ = on;
      torque_demand_ = 0;
      rests_for_ = locked_for_ = presses_for_ = {};
      command_.reset();
      take_position_as_demand();
    }
    Base::enable(on);
  }
  void move_to(std::int32_t position, const canopen::cia402::Profile& profile) {
    command_.reset();
    if (follows_modes()) Base::move_to(position, profile);
  }
  void run_at(std::int32_t velocity, const canopen::cia402::Profile& profile) {
    command_ = VelocityCommand{velocity, profile};
    if (follows_modes()) Base::run_at(velocity, profile);
  }
  void follow(std::int32_t position) {
    if (follows_modes()) Base::follow(position);
  }
  void stop(std::uint32_t deceleration) {
    command_.reset();
    torque_demand_ = 0;
    operates_ = false;  // until the drive lets it operate again
    Base::stop(deceleration);
  }
  void set_position(std::int32_t position) {
    const double behind = Base::position() - filtered_;
    Base::set_position(settings_.closed_loop ? position : position - (Base::position_demand() - Base::position()));
    filtered_ = Base::position() - behind;
    encoder_offset_ = std::int64_t{position} - encoder_sign_ * std::int64_t{motor_position()};
    pulse_target_ = position;
  }

  void step(canopen::Duration span) {
    const std::int32_t before = motor_position();
    if (powered_ && operates_) {
      if (control_ == Control::torque) step_torque(span);
      if (control_ == Control::pulses) step_pulses();
    }
    Base::step(span);
    step_filter(span);
    const double turned = static_cast<double>(std::int64_t{motor_position()} - before) / turn_;
    shaft_ += settings_.motor_reversed ? -turned : turned;
    rests_for_ = moving() ? canopen::Duration{0} : std::min(rests_for_ + span, longest);
    locked_for_ = is_held_up() ? std::min(locked_for_ + span, longest) : canopen::Duration{0};
    step_pressing(span);
  }

  [[nodiscard]] bool moving() const { return Base::moving() || (!is_stalled() && is_behind()); }
  [[nodiscard]] std::int32_t position() const {
    if (!settings_.closed_loop) return Base::position_demand();
    const std::int64_t count = encoder_offset_ + encoder_sign_ * std::int64_t{motor_position()};
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(count, std::numeric_limits<std::int32_t>::min(),
                                                              std::numeric_limits<std::int32_t>::max()));
  }
  [[nodiscard]] std::int32_t velocity() const {
    return settings_.closed_loop ? encoder_sign_ * motor_velocity() : Base::velocity_demand();
  }
  [[nodiscard]] std::uint32_t inputs() const { return terminals.bits() | (Base::inputs() & machine_switches); }

  // The drive

  /// Updates the settings. The present position keeps its number.
  void configure(const StepperSettings& settings) {
    const StepperSettings before = settings_;
    const std::int32_t place = position();
    settings_ = settings;
    if (settings.resolution != before.resolution) {
      Base::set_data(axis_data(settings.resolution));
      filtered_ = Base::position();
      turn_ = settings.resolution;
    }
    Base::jump_velocity = settings.jump_speed * (turn_ / 100);
    const int sign = settings.motor_reversed == settings.encoder_reversed ? 1 : -1;
    if (sign != encoder_sign_ || settings.closed_loop != before.closed_loop) {
      encoder_sign_ = sign;
      encoder_offset_ = std::int64_t{place} - sign * std::int64_t{motor_position()};
    }
  }
  /// Selects what commands the motor; it stops first.
  void select(Control control) {
    if (control == control_) return;
    control_ = control;
    torque_demand_ = 0;
    Base::stop(0);
    pulse_target_ = Base::position_demand();
    if (follows_modes() && powered_ && command_) Base::run_at(command_->velocity, command_->profile);
  }
  /// Whether the drive lets the motor operate: not while it is halted or stops.
  void operate(bool operates) {
    if (operates && !operates_) pulse_target_ = Base::position_demand();
    operates_ = operates;
  }

  [[nodiscard]] bool controls_torque() const { return control_ == Control::torque && powered_; }
  /// 6074h
  [[nodiscard]] std::int16_t torque_demand() const { return static_cast<std::int16_t>(std::lround(torque_demand_)); }
  /// The torque of the motor: that of its load, at most what is commanded.
  [[nodiscard]] std::int16_t torque() const {
    if (!powered_) return 0;
    if (!controls_torque()) return is_held_up() ? rated_torque : std::min(load_, rated_torque);
    const std::int16_t demand = torque_demand();
    const bool at_speed = std::abs(Base::velocity()) >= std::abs(settings_.torque_speed);
    if (is_stalled() || !at_speed) return demand;
    return demand < 0 ? static_cast<std::int16_t>(-load_) : load_;
  }
  /// How long the motor has been at rest.
  [[nodiscard]] canopen::Duration rests_for() const { return rests_for_; }
  /// Whether the rotor does not turn although the motor is to turn. Only the encoder shows it.
  [[nodiscard]] bool rotor_is_locked() const {
    return settings_.closed_loop && locked_for_ > std::chrono::milliseconds{settings_.locked_count};
  }

  // The machine

  InputTerminals terminals;

  void hold(std::uint32_t switches, bool down) { terminals.set_switches(switches, down); }
  bool turn_to(std::int32_t position) {
    const std::int64_t place = settings_.closed_loop ? encoder_sign_ * (position - encoder_offset_) : position;
    const bool turned = Base::turn_to(static_cast<std::int32_t>(place));
    if (turned) filtered_ = Base::position();
    return turned;
  }
  void block(bool blocked) {
    blocked_ = blocked;
    Base::block(is_stalled());
  }
  /// The torque that the load needs. Above the rated torque it stalls the motor.
  void set_load(std::int16_t torque) {
    load_ = torque;
    Base::block(is_stalled());
  }
  [[nodiscard]] bool overloaded() const { return load_ > rated_torque; }
  /// Pulses at the pulse input, negative in the other direction.
  void add_pulses(std::int32_t count) {
    if (control_ != Control::pulses || !powered_ || !operates_) return;
    const std::int64_t target = std::int64_t{pulse_target_} + count;
    pulse_target_ = static_cast<std::int32_t>(std::clamp<std::int64_t>(target, std::numeric_limits<std::int32_t>::min(),
                                                                       std::numeric_limits<std::int32_t>::max()));
  }
  /// Turns of the shaft since power-on, positive for the direction without 20C9h.
  [[nodiscard]] double shaft_turns() const { return shaft_; }

  static constexpr std::int16_t rated_torque = 1'000;

 private:
  struct VelocityCommand {
    std::int32_t velocity;
    canopen::cia402::Profile profile;
  };

  static constexpr canopen::Duration longest = std::chrono::minutes{2};
  static constexpr std::uint32_t braking = 50;  ///< of a motor whose load exceeds its torque, turns per second squared
  static constexpr std::uint32_t machine_switches = 0x7;
  static constexpr int no_delay = 50;  ///< value of 20E0h, from which on the filter does not delay the motor

  [[nodiscard]] bool follows_modes() const { return control_ == Control::software || control_ == Control::pressing; }
  [[nodiscard]] bool is_stalled() const { return blocked_ || overloaded(); }

  /// Whether a limit switch or a software limit blocks motion in this direction.
  [[nodiscard]] bool is_limited(std::int32_t direction) const {
    return canopen::cia402::limit_switch_blocks(inputs(), direction) ||
           (direction > 0 && position() >= settings_.highest) || (direction < 0 && position() <= settings_.lowest);
  }

  /// Whether the motor is to turn, faster than 20DBh, and does not.
  [[nodiscard]] bool is_held_up() const {
    if (!powered_) return false;
    const std::int32_t limit = settings_.locked_above;
    if (control_ == Control::torque) {
      const bool is_at_rest = is_stalled() || (torque_demand() != 0 && std::abs(torque_demand()) <= load_);
      return is_at_rest && torque_demand() != 0 && std::abs(settings_.torque_speed) > limit;
    }
    if (!is_stalled()) return false;
    const bool behind = Base::position_demand() != Base::position();
    return std::abs(Base::velocity_demand()) > limit || (behind && locked_for_ > canopen::Duration{0});
  }

  void take_position_as_demand() {
    if (encoder_sign_ != 1 || encoder_offset_ != 0) set_position(position());
    pulse_target_ = Base::position();
  }

  /// The time constant of the filter: a smaller value is a longer delay. The default value does not delay.
  [[nodiscard]] canopen::Duration delay() const {
    const int below = no_delay - settings_.filter;
    return std::chrono::milliseconds{std::max(below, 0)};
  }
  /// Whether the motor is behind its trajectory.
  [[nodiscard]] bool is_behind() const { return motor_position() != Base::position(); }
  /// The position of the motor in commanded pulses: its trajectory after the filter.
  [[nodiscard]] std::int32_t motor_position() const {
    return delay() == canopen::Duration{0} ? Base::position() : static_cast<std::int32_t>(std::lround(filtered_));
  }
  [[nodiscard]] std::int32_t motor_velocity() const {
    return delay() == canopen::Duration{0} ? Base::velocity()
                                           : static_cast<std::int32_t>(std::lround(filtered_velocity_));
  }
  void step_filter(canopen::Duration span) {
    if (delay() == canopen::Duration{0}) {
      filtered_ = Base::position();
      return;
    }
    const double share =
        std::min(1.0, static_cast<double>(span.count()) / static_cast<double>((delay() + span).count()));
    const double way = is_stalled() ? 0 : (Base::position() - filtered_) * share;
    filtered_ += way;
    filtered_velocity_ = way / (static_cast<double>(span.count()) / 1e6) / (turn_ / 100);
  }

  void step_torque(canopen::Duration span) {
    const double slope = settings_.torque_slope * (span.count() / 1e6);
    const double way = settings_.target_torque - torque_demand_;
    torque_demand_ += settings_.torque_slope == 0 ? way : std::clamp(way, -slope, slope);
    const std::int32_t free = std::abs(torque_demand()) - load_;
    if (is_stalled() || is_limited(torque_demand())) {
      Base::stop(0);
      if (Base::velocity_demand() == 0) give_up_the_way();
    } else if (free <= 0) {
      Base::stop(braking);
    } else {
      const std::int32_t speed = std::abs(settings_.torque_speed);
      const auto ramp = static_cast<std::uint32_t>(free);
      Base::run_at(torque_demand_ < 0 ? -speed : speed, {static_cast<std::uint32_t>(speed), ramp, ramp});
    }
  }

  void step_pulses() {
    const std::int32_t target = std::clamp(pulse_target_, settings_.lowest, settings_.highest);
    if (!is_limited(target - Base::position_demand())) Base::follow(target);
  }

  /// Makes the present position the demand.
  void give_up_the_way() {
    Base::enable(false);
    Base::enable(true);
  }

  /// Ends a motion whose torque has been that of 2103h for 211Eh.
  void step_pressing(canopen::Duration span) {
    const bool presses = control_ == Control::pressing && powered_ && settings_.reference_torque > 0 &&
                         torque() >= settings_.reference_torque && moving();
    presses_for_ = presses ? presses_for_ + span : canopen::Duration{0};
    if (!presses || presses_for_ < std::chrono::milliseconds{settings_.check_torque}) return;
    give_up_the_way();
  }

  StepperSettings settings_{};
  Control control_ = Control::software;
  double turn_;
  int encoder_sign_ = 1;  ///< -1: the encoder counts against the commanded pulses
  std::int64_t encoder_offset_ = 0;
  double filtered_ = 0;           ///< position of the motor, in commanded pulses
  double filtered_velocity_ = 0;  ///< 0.01 turns per second
  double shaft_ = 0;
  bool powered_ = false;
  bool operates_ = false;
  bool blocked_ = false;
  std::int16_t load_ = 0;
  double torque_demand_ = 0;
  std::int32_t pulse_target_ = 0;
  canopen::Duration rests_for_{};
  canopen::Duration locked_for_{};
  canopen::Duration presses_for_{};
  std::optional<VelocityCommand> command_;  ///< of the present mode
};

}  // namespace ezd_1136_node

/// A simulated motor with an encoder and switches, for canopen::cia402::Drive in a program of a PC.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_option_code.hpp"

namespace canopen::cia402 {

/// The motor, and the units of the objects of its drive. Positions are in increments.
struct AxisData {
  double increments_per_turn;
  double velocity_unit;              ///< increments per second
  double acceleration_unit;          ///< increments per second squared
  double highest_velocity;           ///< increments per second
  double highest_acceleration;       ///< increments per second squared; also used if a ramp is 0
  double torque_acceleration = 100;  ///< increments per second squared of a motor without load for 0.1 % of its torque
};

/// The trajectory is one step ahead of the motor. Without power it coasts to a stop.
class SimulatedAxis {
 public:
  explicit SimulatedAxis(const AxisData& data) : data_{data} {}

  /// Changes the units. The position keeps its number; the motor turns as fast as before.
  void set_data(const AxisData& data) {
    const double ratio = data.increments_per_turn / data_.increments_per_turn;
    for (double* const value : {&velocity_, &demand_velocity_, &wanted_, &acceleration_, &deceleration_})
      *value *= ratio;
    data_ = data;
    turns_ = turns();
  }

  /// The velocity at which a motion to a position begins and ends without a ramp, in increments per second.
  double jump_velocity = 0;

  // Axis

  void enable(bool on) {
    if (on == enabled_) return;
    enabled_ = on;
    demand_ = position_;
    added_ = 0;
    course_ = Course::stop;
    deceleration_ = data_.highest_acceleration;
  }
  void move_to(std::int32_t position, const Profile& profile) {
    course_ = Course::position;
    target_ = position + added_;
    take(profile);
    wanted_ = std::min(profile.velocity * data_.velocity_unit, data_.highest_velocity);
  }
  void run_at(std::int32_t velocity, const Profile& profile) {
    course_ = Course::velocity;
    take(profile);
    wanted_ = std::clamp(velocity * data_.velocity_unit, -data_.highest_velocity, data_.highest_velocity);
  }
  void stop(std::uint32_t deceleration) {
    course_ = Course::stop;
    deceleration_ = ramp(deceleration);
  }
  /// The same, with the deceleration that the current limit of this braking allows.
  void stop(std::uint32_t deceleration, Braking braking) {
    stop(deceleration);
    if (braking == Braking::quick_stop_ramp && quick_stop_deceleration) {
      deceleration_ = ramp(*quick_stop_deceleration);
    }
    if (braking == Braking::slow_down_ramp && highest_deceleration) {
      deceleration_ = std::min(deceleration_, ramp(*highest_deceleration));
    }
  }
  void follow(std::int32_t position) {
    course_ = Course::follow;
    target_ = position + added_;
  }
  void apply_torque(std::int16_t torque) {
    course_ = Course::torque;
    torque_ = torque;
  }
  [[nodiscard]] std::int16_t torque() const {
    return enabled_ && course_ == Course::torque ? torque_ : std::int16_t{0};
  }
  /// Edges of the probe inputs that `probe` has simulated, and index pulses.
  [[nodiscard]] std::optional<std::int32_t> latched(const ProbeEdge& edge) {
    return std::exchange(edge.source <= 2 ? probed_[edge.source == 2][edge.positive] : turned_[edge.positive],
                         std::nullopt);
  }
  /// Shifts the target with the position.
  void set_position(std::int32_t position) {
    const double shift = position - position_;
    position_ += shift;
    demand_ += shift;
    target_ += shift;
    machine_ -= sign_ * shift;
    turns_ = turns();
  }

  void step(Duration span) {
    const double seconds = span.count() / 1e6;
    const double before = position_;
    const bool moved = enabled_ && moving();
    const double speed = std::abs(demand_velocity_);
    if (!blocked_) {
      position_ = demand_;
      velocity_ = demand_velocity_;
    } else {
      velocity_ = 0;
    }
    if (enabled_) {
      if (blocked_ && course_ == Course::torque) demand_velocity_ = 0;
      advance(seconds);
      add_motion(seconds);
    } else {
      demand_velocity_ = blocked_ ? 0 : towards(demand_velocity_, 0, coasting * seconds);
      demand_ = position_ + demand_velocity_ * seconds;
    }
    const std::int64_t turns_now = turns();
    if (turns_now != turns_ && position_ != before) {
      index_pulse_ = true;
      turned_[true] = turned_[false] = position();
    }
    turns_ = turns_now;
    speed_change_ = std::abs(demand_velocity_) - speed;
    watch_limit_switches(moved);
  }

  [[nodiscard]] bool moving() const {
    const bool on_its_way = course_ == Course::position || (course_ == Course::velocity && wanted_ != 0) ||
                            (course_ == Course::torque && torque_ != 0);
    return (enabled_ && on_its_way) || demand_velocity_ != 0 || velocity_ != 0;
  }
  [[nodiscard]] std::int32_t position() const { return rounded(position_); }
  [[nodiscard]] std::int32_t velocity() const {
    const double added = enabled_ && !blocked_ ? added_velocity_ : 0;
    return rounded((velocity_ + added) / data_.velocity_unit);
  }
  /// 1: the trajectory accelerates, -1: it decelerates, 0: its velocity is constant.
  [[nodiscard]] int speed_change() const { return speed_change_ > 0 ? 1 : speed_change_ < 0 ? -1 : 0; }
  [[nodiscard]] std::int32_t position_demand() const { return rounded(demand_ - added_); }
  [[nodiscard]] std::int32_t velocity_demand() const {
    const double units = demand_velocity_ / data_.velocity_unit;
    return rounded(units > 0 ? std::ceil(units) : std::floor(units));
  }
  [[nodiscard]] std::uint32_t inputs() const { return (actuated() ^ inverted_) & ~ignored_; }
  /// The switches that are actuated, as bits of input.
  [[nodiscard]] std::uint32_t actuated() const {
    const double place = sign_ * position_ + machine_;
    std::uint32_t bits = held_;
    if (negative_limit && place <= *negative_limit) bits |= input::negative_limit;
    if (positive_limit && place >= *positive_limit) bits |= input::positive_limit;
    if (home_switch && place >= *home_switch) bits |= input::home_switch;
    return bits;
  }
  [[nodiscard]] bool index_pulse() {
    const bool passed = index_pulse_;
    index_pulse_ = false;
    return passed;
  }

  /// The deceleration of a quick stop whose current is limited; std::nullopt: the ramp of the command.
  std::optional<std::uint32_t> quick_stop_deceleration;
  /// The highest deceleration of a stop at a ramp whose current is limited.
  std::optional<std::uint32_t> highest_deceleration;

  /// Selects the switches that the drive ignores, and those whose signal it inverts, as bits of input.
  void evaluate(std::uint32_t ignored, std::uint32_t inverted) {
    ignored_ = ignored;
    inverted_ = inverted;
    watch_limit_switches(enabled_ && moving());
  }
  /// Returns the limit switches that have become active while the axis moved with power since the last call, as bits of
  /// input.
  [[nodiscard]] std::uint32_t take_trips() { return std::exchange(trips_, 0); }

  /// Reverses the direction in which the shaft turns for a positive velocity. The present position keeps its number.
  void reverse(bool reversed) {
    const double sign = reversed ? -1 : 1;
    machine_ += (sign_ - sign) * position_;
    sign_ = sign;
    turns_ = turns();
  }

  // The machine

  std::optional<double> negative_limit;  ///< position of the switch, in increments from the position at power-on
  std::optional<double> positive_limit;
  std::optional<double> home_switch;  ///< active from this position on

  /// Turns the shaft by hand. Returns false with power.
  bool turn_to(std::int32_t position) {
    if (enabled_) return false;
    position_ = demand_ = position;
    turns_ = turns();
    return true;
  }
  /// Turns the shaft by hand by a number of increments. Returns false with power.
  bool turn_by(std::int32_t increments) { return turn_to(rounded(position_ + sign_ * increments)); }
  /// The signal at the input of touch probe 1 or 2 changes.
  void probe(unsigned number, bool on) { probed_[number == 2][on] = position(); }
  /// Blocks or releases the shaft.
  void block(bool blocked) { blocked_ = blocked; }
  /// Adds a velocity to the commanded motion of a motor with power, in increments per second.
  void add_velocity(double velocity) { added_velocity_ = velocity; }
  /// Holds or releases switches.
  void hold(std::uint32_t inputs, bool down) {
    held_ = down ? held_ | inputs : held_ & ~inputs;
    watch_limit_switches(enabled_ && moving());
  }

  /// The position on the machine, in increments from the position at power-on.
  [[nodiscard]] std::int32_t machine_position() const { return rounded(sign_ * position_ + machine_); }
  /// The direction in which the shaft turns: 1, -1, or 0 at standstill.
  [[nodiscard]] int turning() const {
    const double velocity = sign_ * velocity_;
    return velocity > 0 ? 1 : velocity < 0 ? -1 : 0;
  }

 private:
  enum class Course : std::uint8_t { stop, position, velocity, follow, torque };

  static constexpr double coasting = 50'000;  ///< increments per second squared

  [[nodiscard]] static std::int32_t rounded(double number) {
    return static_cast<std::int32_t>(std::clamp(std::round(number), double{std::numeric_limits<std::int32_t>::min()},
                                                double{std::numeric_limits<std::int32_t>::max()}));
  }
  [[nodiscard]] static double towards(double from, double to, double most) {
    return from < to ? std::min(from + most, to) : std::max(from - most, to);
  }
  [[nodiscard]] double ramp(std::uint32_t value) const {
    const double wanted = value * data_.acceleration_unit;
    return value == 0 ? data_.highest_acceleration : std::min(wanted, data_.highest_acceleration);
  }
  void take(const Profile& profile) {
    acceleration_ = ramp(profile.acceleration);
    deceleration_ = ramp(profile.deceleration);
  }
  [[nodiscard]] std::int64_t turns() const {
    return static_cast<std::int64_t>(std::floor((sign_ * position_ + machine_) / data_.increments_per_turn));
  }

  /// Remembers the limit switches that have become active; `moved`: the axis moved with power before.
  void watch_limit_switches(bool moved) {
    const std::uint32_t active = inputs() & (input::negative_limit | input::positive_limit);
    if (moved) trips_ |= active & ~active_limits_;
    active_limits_ = active;
  }

  /// The velocity after a time on the way to another one, with the acceleration or the deceleration.
  [[nodiscard]] double ramped(double from, double to, double seconds) const {
    const bool faster = std::abs(to) > std::abs(from) && from * to >= 0;
    return towards(from, to, (faster ? acceleration_ : deceleration_) * seconds);
  }

  void advance(double seconds) {
    switch (course_) {
      case Course::stop: demand_velocity_ = towards(demand_velocity_, 0, deceleration_ * seconds); break;
      case Course::velocity:
        demand_velocity_ = ramped(demand_velocity_, wanted_, seconds);
        if (wanted_ == 0 && demand_velocity_ == 0) course_ = Course::stop;
        break;
      case Course::position: return advance_to_target(seconds);
      case Course::follow: {
        const double furthest = data_.highest_velocity * seconds;
        const double way = std::clamp(target_ - demand_, -furthest, furthest);
        demand_velocity_ = way / seconds;
        break;
      }
      case Course::torque:
        demand_velocity_ = std::clamp(demand_velocity_ + torque_ * data_.torque_acceleration * seconds,
                                      -data_.highest_velocity, data_.highest_velocity);
        break;
    }
    demand_ += demand_velocity_ * seconds;
  }

  void add_motion(double seconds) {
    const double way = added_velocity_ * seconds;
    demand_ += way;
    target_ += way;
    added_ += way;
  }

  /// Advances with the highest velocity that can still stop at the target, limited by the profile.
  void advance_to_target(double seconds) {
    const double way = target_ - demand_;
    const double step = deceleration_ * seconds;
    const double can_stop = step * (std::sqrt(0.25 + 2 * std::abs(way) / (step * seconds)) - 0.5);
    const double goal = std::copysign(std::min(wanted_, std::max(can_stop, jump_velocity)), way);
    const double jump = std::min(jump_velocity, std::abs(goal));
    if (demand_velocity_ * goal >= 0 && std::abs(demand_velocity_) < jump) demand_velocity_ = std::copysign(jump, goal);
    demand_velocity_ = ramped(demand_velocity_, goal, seconds);
    const double ahead = demand_velocity_ * seconds;
    if (std::abs(way) <= std::abs(ahead) + arrived && std::abs(demand_velocity_) <= std::max(2 * step, jump_velocity) &&
        wanted_ != 0) {
      demand_ = target_;
      demand_velocity_ = 0;
      course_ = Course::stop;
    } else {
      demand_ += ahead;
    }
  }

  static constexpr double arrived = 1e-3;  ///< increments

  AxisData data_;
  bool enabled_ = false;
  bool blocked_ = false;
  bool index_pulse_ = false;
  std::uint32_t held_ = 0;
  std::uint32_t ignored_ = 0;        ///< switches without effect
  std::uint32_t inverted_ = 0;       ///< switches whose signal is inverted
  std::uint32_t active_limits_ = 0;  ///< at the last look
  std::uint32_t trips_ = 0;          ///< limit switches that have become active during a motion
  Course course_ = Course::stop;
  double sign_ = 1;     ///< -1: the shaft turns in the other direction
  double machine_ = 0;  ///< offset from the position to the position on the machine
  double position_ = 0;
  double velocity_ = 0;
  double demand_ = 0;
  double demand_velocity_ = 0;
  double speed_change_ = 0;  ///< of the trajectory in the last step
  double target_ = 0;
  double added_ = 0;           ///< position demand that `add_velocity` has added since the motor has power
  double added_velocity_ = 0;  ///< increments per second
  double wanted_ = 0;          ///< target velocity
  double acceleration_ = 0;
  double deceleration_ = 0;
  std::int64_t turns_ = 0;
  std::int16_t torque_ = 0;
  std::optional<std::int32_t> probed_[2][2];  ///< by input and edge: the position at the last one
  std::optional<std::int32_t> turned_[2];     ///< the same of the index pulse
};

static_assert(TorqueAxis<SimulatedAxis> && ProbedAxis<SimulatedAxis>);

}  // namespace canopen::cia402

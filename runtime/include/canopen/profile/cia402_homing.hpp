/// Homing methods as rows of a table, and their movements (CiA 402-2, 11.2 to 11.4).
#pragma once

#include <cstdint>

#include "canopen/profile/cia402_axis.hpp"

namespace canopen::cia402 {

struct HomingMethod {
  std::int8_t number;     ///< 6098h
  std::int8_t direction;  ///< of the search; 0: home is the present position
  std::uint8_t signal;    ///< bit of `input` that is searched for and left again; 0: none
  bool index_pulse;       ///< home is the next index pulse after that
};

inline constexpr HomingMethod homing_methods[] = {
    {1, -1, input::negative_limit, true},
    {2, 1, input::positive_limit, true},
    {3, 1, input::home_switch, true},
    {5, -1, input::home_switch, true},
    {17, -1, input::negative_limit, false},
    {18, 1, input::positive_limit, false},
    {19, 1, input::home_switch, false},
    {21, -1, input::home_switch, false},
    {33, -1, 0, true},
    {34, 1, 0, true},
    {35, 0, 0, false},
    {37, 0, 0, false},
};

/// Finds a homing method; null if it is not supported.
[[nodiscard]] constexpr const HomingMethod* homing_method(std::int8_t number) {
  for (const HomingMethod& row : homing_methods) {
    if (row.number == number) return &row;
  }
  return nullptr;
}

/// The parameters of a homing, from its objects.
struct HomingParameters {
  std::int8_t method;          ///< 6098h
  std::uint32_t fast;          ///< 6099h:01, towards the switch
  std::uint32_t slow;          ///< 6099h:02, off the switch and towards the index pulse
  std::uint32_t acceleration;  ///< 609Ah
  std::int32_t home_offset;    ///< 607Ch
};

/// One homing of one axis.
class Homing {
 public:
  [[nodiscard]] bool running() const { return phase_ != Phase::idle && phase_ != Phase::attained && !failed(); }
  [[nodiscard]] bool attained() const { return phase_ == Phase::attained; }
  [[nodiscard]] bool failed() const { return phase_ == Phase::failed; }

  /// Starts homing. Fails if the method is not supported or a speed that it needs is 0.
  template <Axis AxisType>
  void start(AxisType& axis, const HomingParameters& parameters) {
    parameters_ = parameters;
    method_ = homing_method(parameters.method);
    const bool needs_fast = method_ != nullptr && method_->signal != 0;
    const bool needs_slow = method_ != nullptr && method_->direction != 0;
    if (method_ == nullptr || (needs_fast && parameters.fast == 0) || (needs_slow && parameters.slow == 0)) {
      phase_ = Phase::failed;
    } else if (method_->direction == 0) {
      arrive(axis);
    } else if (method_->signal == 0) {
      static_cast<void>(axis.index_pulse());
      run(axis, method_->direction, parameters.slow);
      phase_ = Phase::index;
    } else {
      run(axis, method_->direction, parameters.fast);
      phase_ = Phase::search;
    }
  }

  /// Executes one step; call it with each step of the axis.
  template <Axis AxisType>
  void step(AxisType& axis) {
    switch (phase_) {
      case Phase::idle:
      case Phase::attained:
      case Phase::failed: return;
      case Phase::search:
        if (active(axis, method_->signal)) {
          run(axis, -method_->direction, parameters_.slow);
          phase_ = Phase::leave;
        } else if (blocked(axis, method_->direction)) {
          fail(axis);
        }
        return;
      case Phase::leave:
        if (active(axis, method_->signal)) return;
        static_cast<void>(axis.index_pulse());
        if (!method_->index_pulse) return arrive(axis);
        phase_ = Phase::index;
        return;
      case Phase::index:
        if (axis.index_pulse()) return arrive(axis);
        if (method_->signal == 0 && blocked(axis, method_->direction)) fail(axis);
        return;
      case Phase::stop:
        if (!axis.moving()) phase_ = Phase::attained;
        return;
    }
  }

  /// Ends homing before home is attained, or resets that it was.
  void interrupt() { phase_ = Phase::idle; }
  /// Ends homing before home is attained.
  void interrupt_running() {
    if (running()) interrupt();
  }

 private:
  enum class Phase : std::uint8_t { idle, search, leave, index, stop, attained, failed };

  template <Axis AxisType>
  [[nodiscard]] static bool active(const AxisType& axis, std::uint8_t signal) {
    return (axis.inputs() & signal) != 0;
  }

  /// Whether a limit switch blocks motion in this direction.
  template <Axis AxisType>
  [[nodiscard]] static bool blocked(const AxisType& axis, std::int32_t direction) {
    return active(axis, direction < 0 ? input::negative_limit : input::positive_limit);
  }

  template <Axis AxisType>
  void run(AxisType& axis, std::int32_t direction, std::uint32_t speed) {
    axis.run_at(direction * static_cast<std::int32_t>(speed),
                Profile{speed, parameters_.acceleration, parameters_.acceleration});
  }

  /// Sets the home position, which is the home offset away from zero.
  template <Axis AxisType>
  void arrive(AxisType& axis) {
    axis.set_position(static_cast<std::int32_t>(-static_cast<std::int64_t>(parameters_.home_offset)));
    axis.stop(parameters_.acceleration);
    phase_ = Phase::stop;
  }

  template <Axis AxisType>
  void fail(AxisType& axis) {
    axis.stop(parameters_.acceleration);
    phase_ = Phase::failed;
  }

  HomingParameters parameters_{};
  const HomingMethod* method_ = nullptr;
  Phase phase_ = Phase::idle;
};

}  // namespace canopen::cia402

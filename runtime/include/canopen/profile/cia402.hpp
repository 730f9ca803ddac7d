/// A drive of CiA 402-2: device control, between the objects of a node and an axis that moves in the modes of
/// operation.
///
///     MyAxis axis;
///     canopen::cia402::Drive<my_drive::Device, MyAxis> drive{axis};
///     auto node = canopen::make_node<my_drive::Device>(bus, node_id, drive.error_handler());
///     drive.start();                               // power-on, before node.start(now)
///     node.on_frame(frame, now);                   // after each frame, and at next_deadline():
///     drive.on_time(node, now);
///     node.on_time(now);
///
/// Objects are optional: if the device does not have one, its default in the standard is used.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/emcy/emcy_producer.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/profile/cia402_actual_values.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_conditions.hpp"
#include "canopen/profile/cia402_connection.hpp"
#include "canopen/profile/cia402_homing.hpp"
#include "canopen/profile/cia402_modes.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_option_code.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"
#include "canopen/profile/cia402_set_points.hpp"
#include "canopen/profile/cia402_state_machine.hpp"
#include "canopen/profile/cia402_touch_probe.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

/// Optional functions of an application:
///     void operate(std::int8_t mode)              a step in a manufacturer-specific mode; it moves the axis
///     std::uint16_t statusword(std::uint16_t)     returns the statusword with the manufacturer-specific bits
///     void abort_connection(std::int16_t code)    communication is lost and 6007h is 1 or manufacturer-specific:
///                                                 replaces the fault of the profile
struct NoApplication {};

template <class Device, Axis AxisType, Options options = Options{}>
class Drive {
  using DriveParameters = Parameters<Device, options>;

 public:
  /// The axis must outlive the drive.
  explicit constexpr Drive(AxisType& moved_axis) : axis_{moved_axis} {}

  /// Handler that the node of a drive needs. An error that the node reports is written to 603Fh. A heartbeat or life
  /// guarding event and bus-off are a loss of communication, as is NMT Stopped: the next `on_time` applies 6007h.
  using ErrorTaker = typename Connection<Parameters<Device, options>>::ErrorTaker;
  [[nodiscard]] constexpr ErrorHandler<ErrorTaker> error_handler() { return on_error(ErrorTaker{&connection_}); }

  /// Power-on, or a reset that restarts the drive: transitions 0 and 1. The axis has no power.
  void start() {
    axis_.enable(false);
    modes_.restart();
    conditions_.clear();
    if constexpr (has_probes) probes_.clear();
    controlword_ = 0;
    fault_bits_ = ErrorRegister{};
    halted_ = leaving_ = false;
    connection_.restart();
    enter(State::switch_on_disabled);
  }

  /// Processes the controlword and moves the axis. Call it after each frame that the node has processed and at
  /// `next_deadline`.
  template <class Node, class Application>
  void on_time(Node& node, TimePoint now, Application&& application) {
    static_assert(std::remove_cvref_t<Node>::template has_handler<ErrorHandler<ErrorTaker>>,
                  "the node of a drive needs drive.error_handler() among its handlers");
    if constexpr (has_probes) probes_.take(node, axis_);
    if (!busy()) stepped_ = now;
    watch_connection(node, application);
    take_controlword(node);
    for (unsigned steps = 0; busy() && now - stepped_ >= step_time; ++steps) {
      if (steps == options.max_steps) {
        stepped_ = now;
        break;
      }
      stepped_ = stepped_ + step_time;
      step(node, application);
    }
    publish(node, now, application);
  }
  template <class Node>
  void on_time(Node& node, TimePoint now) {
    on_time(node, now, NoApplication{});
  }

  /// Returns when the axis is to take its next step; empty if it is at rest without power.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (connection_.lost()) return stepped_;
    return busy() ? std::optional{stepped_ + step_time} : std::nullopt;
  }

  /// Reports an error of the drive: transition 13, 603Fh and an EMCY. A fault reset ends it.
  template <class Node>
  void fault(Node& node, EmergencyCode code, ErrorRegister bits, const EmergencyInfo& info = {}) {
    node.emergency(code, bits, info);
    signal_fault(node, bits);
  }

  /// Sets whether errors are still present: a fault reset (transition 15) is not possible then.
  void keep_fault(bool there) { fault_is_there_ = there; }

  /// Stops the drive like the command quick stop: transition 11.
  template <class Node>
  void quick_stop(Node& node) {
    if (state_ == State::operation_enabled) enter_quick_stop(node);
  }

  void set_voltage_enabled(bool enabled) { voltage_enabled_ = enabled; }  ///< bit 4 of the statusword
  void set_warning(bool there) { warning_ = there; }                      ///< bit 7

  /// Sets the mode of a drive without 6060h.
  void select(std::int8_t new_mode) requires(!DriveParameters::template has<object::ModesOfOperation>) {
    modes_.select(new_mode);
  }

  /// Whether the drive has a mode of operation. If the EDS lists the modes in 6502h, 6060h accepts only these.
  [[nodiscard]] static constexpr bool supports(std::int8_t wanted) { return DriveParameters::supports(wanted); }

  /// Whether the node has to pass written data records and SYNC: the drive has interpolated position mode.
  static constexpr bool has_interpolation = Modes<Device, AxisType, options>::has_interpolation;

  /// Takes a data record that has been received for 60C1h:01; device_state: the buffer is full or disabled (60C4h).
  /// Call it in the write handler of 60C1h:01, and return the result.
  template <class Node>
  [[nodiscard]] AbortCode offer_set_point(const Node& node, std::int32_t position) requires(has_interpolation) {
    return modes_.offer_set_point(node, position);
  }
  /// A SYNC has been received. If 1006h is equal to the interpolation time 60C2h, or the device does not have it, the
  /// next period begins.
  template <class Node>
  void on_sync(const Node& node) requires(has_interpolation) {
    modes_.on_sync(node);
  }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] std::int8_t mode() const { return modes_.present(); }  ///< 6061h
  /// Whether the motor operates in a mode: in Operation Enabled, not halted, and not leaving that state.
  [[nodiscard]] bool operates() const { return state_ == State::operation_enabled && !halted_ && !leaving_; }
  [[nodiscard]] bool halted() const { return halted_ && state_ == State::operation_enabled; }
  [[nodiscard]] bool target_reached() const { return conditions_.reached(); }
  [[nodiscard]] bool following_error() const { return conditions_.following_error(); }  ///< 6065h exceeded for 6066h
  /// Whether the axis is limited by 607Dh.
  [[nodiscard]] bool at_software_limit() const { return conditions_.software_limit(); }
  [[nodiscard]] bool at_limit_switch() const { return conditions_.limit_switch(); }  ///< a limit switch is active
  [[nodiscard]] const Homing& homing() const { return modes_.homing(); }
  [[nodiscard]] const SetPoints& set_points() const { return modes_.set_points(); }

 private:
  static constexpr Duration step_time{options.step};
  static constexpr bool has_probes = DriveParameters::template has<object::TouchProbeFunction>;
  static_assert(!has_probes || ProbedAxis<AxisType>,
                "this drive has touch probes, 60B8h: its axis needs latched(), profile/cia402_axis.hpp");

  /// Whether the axis depends on time.
  [[nodiscard]] bool busy() const { return has_power(state_) || axis_.moving() || probes_.enabled(); }

  // Loss of communication

  /// Applies 6007h once for each loss (CiA 402-2, abort connection option code).
  template <class Node, class Application>
  void watch_connection(Node& node, [[maybe_unused]] Application& application) {
    const Loss loss = connection_.take(node.state());
    if (loss == Loss::none) return;
    if (!has_power(state_) && !(options.faults_without_power && loss == Loss::reported)) return;
    const auto code =
        DriveParameters::template value<object::AbortConnectionOptionCode>(node, option_code::abort_connection);
    switch (code) {
      case option_code::no_action: return;
      case option_code::disable_voltage: return carry_out(node, Command::disable_voltage);
      case option_code::quick_stop_command: return carry_out(node, Command::quick_stop);
      default: break;
    }
    if constexpr (requires { application.abort_connection(code); }) {
      application.abort_connection(code);
    } else if (loss == Loss::stopped) {
      fault(node, emergency_code::communication, ErrorRegister::communication);
    } else {
      node.hold_error(ErrorRegister::communication);
      signal_fault(node, ErrorRegister::communication);
    }
  }

  // Device control

  /// Executes transition 13 for an error that has been reported.
  template <class Node>
  void signal_fault(Node& node, ErrorRegister bits) {
    fault_bits_ = fault_bits_ | bits;
    if (state_ == State::fault || state_ == State::fault_reaction_active) return;
    const bool had_power = has_power(state_);
    leave_operation();
    const Braking braking =
        DriveParameters::template braking<object::FaultReactionOptionCode>(node, option_code::fault_reaction);
    if (!had_power || braking == Braking::none || !axis_.moving()) return enter(State::fault);
    enter(State::fault_reaction_active);
    brake(node, braking);
  }

  template <class Node>
  void take_controlword(Node& node) {
    remote_ = node.state() == NmtState::pre_operational || node.state() == NmtState::operational;
    if (!remote_) return;
    const auto word = DriveParameters::template value<object::Controlword>(node, 0);
    const auto rising = static_cast<std::uint16_t>(word & ~controlword_);
    const bool changed = word != controlword_;
    const State before = state_;
    controlword_ = word;
    if ((rising & controlword::fault_reset) != 0 && state_ == State::fault && !fault_is_there_) reset_fault(node);
    if (changed) carry_out(node, command_of(word));
    if constexpr (options.ready_without_shutdown) {
      if (state_ == State::switch_on_disabled) enter(State::ready_to_switch_on);
    }
    if (take_mode(node) || state_ != before) watch(node, Duration{0});
    if (changing_ || !(operates() || halted())) return;
    const bool begins = modes_.take_bits(node, axis_, controlword_, rising, halted_);
    if (begins && !options.target_reached_until_motion) conditions_.expect_motion();
    take_halt(node);
  }

  template <class Node>
  void reset_fault(Node& node) {
    enter(State::switch_on_disabled);
    node.emergency_over(fault_bits_);
    fault_bits_ = ErrorRegister{};
  }

  template <class Node>
  void carry_out(Node& node, Command command) {
    while (const Transition* transition = transition_of(state_, command)) {
      if (options.ready_without_shutdown && transition->from == State::ready_to_switch_on &&
          transition->to == State::switch_on_disabled) {
        return;
      }
      switch (transition->number) {
        case 5: return leave<object::DisableOperationOptionCode>(node, option_code::disable_operation, transition->to);
        case 8: return leave<object::ShutdownOptionCode>(node, option_code::shutdown, transition->to);
        case 11: return enter_quick_stop(node);
        case 16:
          if (!option_code::stays_in_quick_stop(DriveParameters::quick_stop_option(node))) return;
          break;
        default: break;
      }
      enter(transition->to);
    }
    if (command == Command::enable_operation && leaving_) resume();
  }

  /// Leaves Operation Enabled for a state without power, once the axis has stopped as an option code says.
  template <class OptionCode, class Node>
  void leave(Node& node, std::int16_t otherwise, State to) {
    const Braking braking = DriveParameters::template braking<OptionCode>(node, otherwise);
    if (braking == Braking::none || !axis_.moving()) return enter(to);
    leaving_ = true;
    leave_to_ = to;
    modes_.interrupt_homing();
    brake(node, braking);
  }

  /// Continues the motion that was stopped.
  void resume() {
    leaving_ = changing_ = false;
    modes_.resume();
  }

  template <class Node>
  void enter_quick_stop(Node& node) {
    const Braking braking = braking_of(DriveParameters::quick_stop_option(node));
    leave_operation();
    enter(State::quick_stop_active);
    if (braking == Braking::none) return enter(State::switch_on_disabled);
    brake(node, braking);
  }

  void leave_operation() {
    modes_.end();
    halted_ = leaving_ = changing_ = false;
  }

  void enter(State next) {
    if (next == State::operation_enabled) modes_.begin();
    if (state_ == State::operation_enabled && next != State::operation_enabled) leave_operation();
    state_ = next;
    axis_.enable(has_power(next));
  }

  template <class Node>
  void brake(const Node& node, Braking braking) {
    if (braking == Braking::none) return axis_.enable(false);
    stop(axis_, modes_.deceleration(node, braking), braking);
  }

  // Modes of operation

  /// Changes the mode when the axis is at standstill; a moving axis is stopped first. Returns whether it has changed.
  template <class Node>
  bool take_mode(Node& node) {
    const std::int8_t wanted = modes_.wanted(node);
    if (wanted == modes_.present() || !supports(wanted)) {
      if (changing_) resume();
      return false;
    }
    if (state_ == State::operation_enabled && axis_.moving()) {
      if (!changing_) axis_.stop(modes_.deceleration(node, Braking::slow_down_ramp));
      changing_ = true;
      modes_.interrupt_homing();
      return false;
    }
    changing_ = false;
    if (modes_.controls_torque() && state_ == State::operation_enabled) axis_.stop(0);
    modes_.change(wanted);
    return true;
  }

  template <class Node>
  void take_halt(Node& node) {
    const bool halt = (controlword_ & controlword::halt) != 0;
    if (halt == halted_) return;
    halted_ = halt;
    if (halt) {
      modes_.interrupt_homing();
      const Braking braking = DriveParameters::template braking<object::HaltOptionCode>(node, option_code::halt);
      stop(axis_, modes_.deceleration(node, braking), braking);
    } else {
      resume();
    }
    watch(node, Duration{0});
  }

  template <class Node, class Application>
  void step(Node& node, Application& application) {
    if (operates() && !changing_) modes_.operate(node, axis_, application, step_time);
    axis_.step(step_time);
    if constexpr (has_probes) probes_.step(node, axis_);
    modes_.step_homing(axis_);
    if (state_ == State::operation_enabled) modes_.keep_limits(node, axis_);
    if (!halted_) modes_.finish_set_point(axis_);
    watch(node, step_time);
    if (axis_.moving()) return;
    switch (state_) {
      case State::quick_stop_active:
        if (!option_code::stays_in_quick_stop(DriveParameters::quick_stop_option(node)))
          enter(State::switch_on_disabled);
        break;
      case State::fault_reaction_active: enter(State::fault); break;
      case State::operation_enabled:
        if (leaving_) enter(leave_to_);
        if (changing_ && take_mode(node)) watch(node, Duration{0});
        break;
      case State::not_ready_to_switch_on:
      case State::switch_on_disabled:
      case State::ready_to_switch_on:
      case State::switched_on:
      case State::fault: break;
    }
  }

  /// Updates the conditions of bits 10, 12 and 13 of the statusword after a time span.
  template <class Node>
  void watch(const Node& node, Duration span) {
    conditions_.watch(node, axis_,
                      {.mode = modes_.present(),
                       .stopping = state_ == State::quick_stop_active || halted_,
                       .halted = halted_,
                       .homing = modes_.homing().running(),
                       .set_point = modes_.has_set_point(),
                       .at_target = modes_.at_target(axis_)},
                      span);
  }

  struct NoProbes {
    static constexpr bool enabled() { return false; }
  };

  // Statusword and actual values

  [[nodiscard]] std::uint16_t status() const {
    unsigned bits = bits_of(state_);
    if (quick_stop_bit_is_open(state_)) bits |= controlword_ & controlword::quick_stop ? statusword::quick_stop : 0;
    if (voltage_enabled_) bits |= statusword::voltage_enabled;
    if (warning_) bits |= statusword::warning;
    if (remote_) bits |= statusword::remote;
    if (at_limit_switch() || (options.tells_software_limits && at_software_limit())) bits |= statusword::internal_limit;
    if (modes_.limited()) bits |= statusword::internal_limit;
    const bool enabled = state_ == State::operation_enabled;
    if (conditions_.reached() && (enabled || state_ == State::quick_stop_active)) bits |= statusword::target_reached;
    if (enabled) bits |= modes_.status_bits(conditions_, operates());
    return static_cast<std::uint16_t>(bits);
  }

  template <class Node, class Application>
  void publish(Node& node, TimePoint now, Application& application) {
    conditions_.watch_limits(node, axis_, homing().running());
    std::uint16_t word = status();
    if constexpr (requires { application.statusword(word); }) word = application.statusword(word);
    const bool changed = word != DriveParameters::template value<object::Statusword>(node, 0);
    DriveParameters::template set<object::Statusword>(node, word);
    DriveParameters::template set<object::ModesOfOperationDisplay>(node, mode());
    if constexpr (Modes<Device, AxisType, options>::has_torque)
      DriveParameters::template set<object::TorqueDemand>(node, modes_.torque_demand());
    actual_values_.publish(node, axis_, now, changed);
  }

  // Bytes first: a Cortex-M0+ accesses offsets up to 31 with one instruction.
  AxisType& axis_;
  State state_ = State::not_ready_to_switch_on;
  State leave_to_ = State::switch_on_disabled;  ///< valid while `leaving_`
  std::uint16_t controlword_ = 0;               ///< the one processed last
  ErrorRegister fault_bits_{};
  bool fault_is_there_ = false;
  bool voltage_enabled_ = true;
  bool warning_ = false;
  bool remote_ = false;
  bool halted_ = false;
  bool leaving_ = false;   ///< decelerating to leave Operation Enabled
  bool changing_ = false;  ///< decelerating to change the mode
  Modes<Device, AxisType, options> modes_{};
  [[no_unique_address]] std::conditional_t<has_probes, TouchProbes<DriveParameters>, NoProbes> probes_{};
  TimePoint stepped_{};  ///< the axis has moved up to this time
  ActualValues<Device, options> actual_values_{};
  [[no_unique_address]] Conditions<Device, options> conditions_{};
  Connection<Parameters<Device, options>> connection_{};
};

}  // namespace canopen::cia402

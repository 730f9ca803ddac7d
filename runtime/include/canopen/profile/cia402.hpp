/// A drive of CiA 402-2: device control and modes of operation, between the objects of a node and an axis.
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

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "canopen/base/clock.hpp"
#include "canopen/emcy/emcy_producer.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_homing.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_option_code.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_set_points.hpp"
#include "canopen/profile/cia402_state_machine.hpp"
#include "canopen/profile/cia402_window.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

/// Optional functions of an application:
///     void operate(std::int8_t mode)              a step in a manufacturer-specific mode; it moves the axis
///     std::uint16_t statusword(std::uint16_t)     returns the statusword with the manufacturer-specific bits
///     void abort_connection(std::int16_t code)    communication is lost and 6007h is 1 or manufacturer-specific:
///                                                 replaces the fault of the profile
struct NoApplication {};

template <class Device, Axis A, Options options = Options{}>
class Drive {
 public:
  /// The axis must outlive the drive.
  explicit constexpr Drive(A& moved_axis) : axis_{moved_axis} {}

  /// Handler that the node of a drive needs. An error that the node reports is written to 603Fh. A heartbeat or life
  /// guarding event and bus-off are a loss of communication, as is NMT Stopped: the next `on_time` applies 6007h.
  struct ErrorTaker {
    Drive* drive;
    void operator()(auto& node, std::uint16_t code) const {
      set<object::ErrorCode>(node, code);
      if (code == emergency_code::error_control || code == emergency_code::bus_off) drive->loss_ = Loss::reported;
    }
  };
  [[nodiscard]] constexpr ErrorHandler<ErrorTaker> error_handler() { return on_error(ErrorTaker{this}); }

  /// Power-on, or a reset that restarts the drive: transitions 0 and 1. The axis has no power.
  void start() {
    axis_.enable(false);
    set_points_.clear();
    homing_.interrupt();
    at_target_ = at_speed_ = at_rest_ = off_course_ = {};
    controlword_ = 0;
    fault_bits_ = ErrorRegister{};
    halted_ = leaving_ = false;
    loss_ = Loss::none;
    mode_ = options.initial_mode;
    enter(State::switch_on_disabled);
  }

  /// Processes the controlword and moves the axis. Call it after each frame that the node has processed and at
  /// `next_deadline`.
  template <class Node, class Application>
  void on_time(Node& node, TimePoint now, Application&& application) {
    static_assert(std::remove_cvref_t<Node>::template has_handler<ErrorHandler<ErrorTaker>>,
                  "the node of a drive needs drive.error_handler() among its handlers");
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
    if (loss_ != Loss::none) return stepped_;
    return busy() ? std::optional{stepped_ + step_time} : std::nullopt;
  }

  /// Reports an error of the drive: transition 13, 603Fh and an EMCY. A fault reset ends it.
  template <class Node>
  void fault(Node& node, std::uint16_t code, ErrorRegister bits, const EmergencyInfo& info = {}) {
    node.emergency(code, bits, info);
    signal_fault(node, bits);
  }

  /// Sets whether errors are still present: a fault reset (transition 15) is not possible meanwhile.
  void keep_fault(bool there) { fault_is_there_ = there; }

  /// Stops the drive like the command quick stop: transition 11.
  template <class Node>
  void quick_stop(Node& node) {
    if (state_ == State::operation_enabled) enter_quick_stop(node);
  }

  void set_voltage_enabled(bool enabled) { voltage_enabled_ = enabled; }  ///< bit 4 of the statusword
  void set_warning(bool there) { warning_ = there; }                      ///< bit 7

  /// Sets the mode of a drive without 6060h.
  void select(std::int8_t new_mode) requires(!Device::dictionary.has(0x6060, 0)) { selected_ = new_mode; }

  /// Whether 6060h accepts this value.
  [[nodiscard]] static constexpr bool supports(std::int8_t wanted) {
    return wanted == mode::none || has_mode(wanted) || (wanted < 0 && wanted >= options.lowest_mode);
  }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] std::int8_t mode() const { return mode_; }  ///< 6061h
  /// Whether the motor operates in a mode: in Operation Enabled, not halted, and not leaving that state.
  [[nodiscard]] bool operates() const { return state_ == State::operation_enabled && !halted_ && !leaving_; }
  [[nodiscard]] bool halted() const { return halted_ && state_ == State::operation_enabled; }
  [[nodiscard]] bool target_reached() const { return reached_; }
  [[nodiscard]] bool following_error() const { return following_error_; }   ///< 6065h exceeded for 6066h
  [[nodiscard]] bool at_software_limit() const { return software_limit_; }  ///< the axis is limited by 607Dh
  [[nodiscard]] bool at_limit_switch() const { return limit_switch_; }      ///< a limit switch is active
  [[nodiscard]] const Homing& homing() const { return homing_; }
  [[nodiscard]] const SetPoints& set_points() const { return set_points_; }

 private:
  static constexpr Duration step_time{options.step};
  static constexpr std::int32_t max_position = 0x7FFF'FFFF;
  static constexpr std::int32_t min_position = -max_position - 1;

  [[nodiscard]] static constexpr bool has_mode(std::int8_t wanted) {
    return (options.modes & bit_of_mode(wanted)) != 0;
  }

  template <class O>
  static constexpr bool has = Device::dictionary.has(O::index, O::sub_index);

  /// Returns the value of an object; `otherwise` if the device does not have it.
  template <class O, class Node>
  [[nodiscard]] static typename O::type value(const Node& node, typename O::type otherwise) {
    if constexpr (has<O>) {
      return node.template get<O>();
    } else {
      return otherwise;
    }
  }

  template <class O, class Node>
  static void set([[maybe_unused]] Node& node, [[maybe_unused]] const typename O::type& new_value) {
    if constexpr (has<O>) static_cast<void>(node.template set<O>(new_value));
  }

  /// Whether the axis depends on time.
  [[nodiscard]] bool busy() const { return has_power(state_) || axis_.moving(); }

  // Loss of communication

  enum class Loss : std::uint8_t {
    none,
    reported,  ///< by a service, with its EMCY
    stopped,   ///< NMT Stopped, which is not reported by a service
  };

  /// Applies 6007h once for each loss (CiA 402-2, abort connection option code).
  template <class Node, class Application>
  void watch_connection(Node& node, [[maybe_unused]] Application& application) {
    const bool stopped = node.state() == NmtState::stopped;
    if (stopped && !stopped_ && loss_ == Loss::none) loss_ = Loss::stopped;
    stopped_ = stopped;
    const Loss loss = loss_;
    loss_ = Loss::none;
    if (loss == Loss::none) return;
    if (!has_power(state_) && !(options.faults_without_power && loss == Loss::reported)) return;
    const auto code = value<object::AbortConnectionOptionCode>(node, option_code::abort_connection);
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
    const Braking braking = braking_of(value<object::FaultReactionOptionCode>(node, option_code::fault_reaction));
    if (!had_power || braking == Braking::none || !axis_.moving()) return enter(State::fault);
    enter(State::fault_reaction_active);
    brake(node, braking);
  }

  template <class Node>
  void take_controlword(Node& node) {
    remote_ = node.state() == NmtState::pre_operational || node.state() == NmtState::operational;
    if (!remote_) return;
    const auto word = value<object::Controlword>(node, 0);
    const auto rising = static_cast<std::uint16_t>(word & ~controlword_);
    const bool changed = word != controlword_;
    const State before = state_;
    controlword_ = word;
    if ((rising & controlword::fault_reset) != 0 && state_ == State::fault && !fault_is_there_) reset_fault(node);
    if (changed) carry_out(node, command_of(word));
    if constexpr (options.ready_without_shutdown) {
      if (state_ == State::switch_on_disabled) enter(State::ready_to_switch_on);
    }
    if (take_mode(node) || state_ != before) watch_windows(node, Duration{0});
    if ((operates() || halted()) && !changing_) take_mode_bits(node, rising);
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
        case 5:
          return leave(node,
                       braking_of(value<object::DisableOperationOptionCode>(node, option_code::disable_operation)),
                       transition->to);
        case 8:
          return leave(node, braking_of(value<object::ShutdownOptionCode>(node, option_code::shutdown)),
                       transition->to);
        case 11: return enter_quick_stop(node);
        case 16:
          if (!option_code::stays_in_quick_stop(quick_stop_option(node))) return;
          break;
        default: break;
      }
      enter(transition->to);
    }
    if (command == Command::enable_operation && leaving_) resume();
  }

  /// Leaves Operation Enabled for a state without power, once the axis is at standstill.
  template <class Node>
  void leave(Node& node, Braking braking, State to) {
    if (braking == Braking::none || !axis_.moving()) return enter(to);
    leaving_ = true;
    leave_to_ = to;
    homing_.interrupt_running();
    brake(node, braking);
  }

  /// Continues the motion that was stopped.
  void resume() {
    leaving_ = changing_ = false;
    set_points_.start_again();
    velocity_told_ = false;
  }

  template <class Node>
  [[nodiscard]] static std::int16_t quick_stop_option(const Node& node) {
    return value<object::QuickStopOptionCode>(node, option_code::quick_stop);
  }

  template <class Node>
  void enter_quick_stop(Node& node) {
    const Braking braking = braking_of(quick_stop_option(node));
    leave_operation();
    enter(State::quick_stop_active);
    if (braking == Braking::none) return enter(State::switch_on_disabled);
    brake(node, braking);
  }

  void leave_operation() {
    set_points_.clear();
    homing_.interrupt_running();
    halted_ = leaving_ = changing_ = homing_starts_ = false;
  }

  void enter(State next) {
    if (next == State::operation_enabled) velocity_told_ = false;
    if (state_ == State::operation_enabled && next != State::operation_enabled) leave_operation();
    state_ = next;
    axis_.enable(has_power(next));
  }

  template <class Node>
  void brake(const Node& node, Braking braking) {
    switch (braking) {
      case Braking::none: return axis_.enable(false);
      case Braking::slow_down_ramp: return axis_.stop(profile(node).deceleration);
      case Braking::quick_stop_ramp: return axis_.stop(quick_stop_deceleration(node));
      case Braking::hardest: return axis_.stop(0);
    }
  }

  template <class Node>
  [[nodiscard]] static std::uint32_t quick_stop_deceleration(const Node& node) {
    return value<object::QuickStopDeceleration>(node, profile(node).deceleration);
  }

  template <class Node>
  [[nodiscard]] static Profile profile(const Node& node) {
    return {at_most_allowed(node, value<object::ProfileVelocity>(node, options.profile.velocity)),
            value<object::ProfileAcceleration>(node, options.profile.acceleration),
            value<object::ProfileDeceleration>(node, options.profile.deceleration)};
  }

  /// Returns a speed limited to 607Fh, where 0 is no limit.
  template <class Node>
  [[nodiscard]] static std::uint32_t at_most_allowed(const Node& node, std::uint32_t speed) {
    const std::uint32_t most = value<object::MaxProfileVelocity>(node, 0);
    return most != 0 ? std::min(speed, most) : speed;
  }

  // Modes of operation

  /// Changes the mode when the axis is at standstill; a moving axis is stopped first. Returns whether it has changed.
  template <class Node>
  bool take_mode(Node& node) {
    const std::int8_t wanted = value<object::ModesOfOperation>(node, selected_);
    if (wanted == mode_ || !supports(wanted)) {
      if (changing_) resume();
      return false;
    }
    if (state_ == State::operation_enabled && axis_.moving()) {
      if (!changing_) axis_.stop(profile(node).deceleration);
      changing_ = true;
      homing_.interrupt_running();
      return false;
    }
    changing_ = false;
    mode_ = wanted;
    set_points_.clear();
    homing_.interrupt();
    velocity_told_ = false;
    return true;
  }

  template <class Node>
  void take_mode_bits(Node& node, std::uint16_t rising) {
    if constexpr (has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) take_set_point(node, rising);
    }
    if constexpr (has_mode(mode::homing)) {
      if (mode_ == mode::homing) take_homing_bits(node, rising);
    }
    take_halt(node);
  }

  template <class Node>
  void take_halt(Node& node) {
    const bool halt = (controlword_ & controlword::halt) != 0;
    if (halt == halted_) return;
    halted_ = halt;
    if (halt) {
      homing_.interrupt_running();
      const Braking braking = braking_of(value<object::HaltOptionCode>(node, option_code::halt));
      axis_.stop(braking == Braking::slow_down_ramp    ? profile(node).deceleration
                 : braking == Braking::quick_stop_ramp ? quick_stop_deceleration(node)
                                                       : 0);
    } else {
      resume();
    }
    watch_windows(node, Duration{0});
  }

  template <class Node, class Application>
  void step(Node& node, Application& application) {
    if (operates() && !changing_) operate(node, application);
    axis_.step(step_time);
    if constexpr (has_mode(mode::homing)) {
      if (homing_.running()) homing_.step(axis_);
    }
    keep_limits(node);
    if (set_points_.active() && !set_points_.starts() && !halted_ && !axis_.moving()) set_points_.reached();
    watch_windows(node, step_time);
    if (axis_.moving()) return;
    switch (state_) {
      case State::quick_stop_active:
        if (!option_code::stays_in_quick_stop(quick_stop_option(node))) enter(State::switch_on_disabled);
        break;
      case State::fault_reaction_active: enter(State::fault); break;
      case State::operation_enabled:
        if (leaving_) enter(leave_to_);
        if (changing_ && take_mode(node)) watch_windows(node, Duration{0});
        break;
      case State::not_ready_to_switch_on:
      case State::switch_on_disabled:
      case State::ready_to_switch_on:
      case State::switched_on:
      case State::fault: break;
    }
  }

  template <class Node, class Application>
  void operate(Node& node, Application& application) {
    if constexpr (has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) return operate_profile_position();
    }
    if constexpr (has_mode(mode::profile_velocity)) {
      if (mode_ == mode::profile_velocity) return operate_profile_velocity(node);
    }
    if constexpr (has_mode(mode::cyclic_synchronous_position)) {
      if (mode_ == mode::cyclic_synchronous_position) return follow_target(node);
    }
    if constexpr (has_mode(mode::homing)) {
      if (homing_starts_) return start_homing(node);
    }
    if constexpr (requires { application.operate(mode_); }) {
      if (mode_ < 0) application.operate(mode_);
    }
  }

  // Cyclic synchronous position

  template <class Node>
  void follow_target(const Node& node) {
    const std::uint32_t offset = static_cast<std::uint32_t>(value<object::PositionOffset>(node, 0));
    const std::uint32_t target = static_cast<std::uint32_t>(value<object::TargetPosition>(node, 0)) + offset;
    const std::int32_t allowed = within_software_limits(node, static_cast<std::int32_t>(target));
    const std::int32_t demand = axis_.position_demand();
    if (!blocks(axis_.inputs(), allowed == demand ? 0 : allowed > demand ? 1 : -1)) axis_.follow(allowed);
  }

  // Profile position

  template <class Node>
  void take_set_point(Node& node, std::uint16_t rising) {
    if ((controlword_ & controlword::new_set_point) == 0) set_points_.release();
    if ((rising & controlword::new_set_point) == 0) return;
    auto target = static_cast<std::uint32_t>(value<object::TargetPosition>(node, 0));
    if ((controlword_ & controlword::relative) != 0) {
      target += static_cast<std::uint32_t>(set_points_.active() ? set_points_.last_target() : axis_.position_demand());
    }
    set_points_.offer({within_software_limits(node, static_cast<std::int32_t>(target)), profile(node)},
                      (controlword_ & controlword::change_immediately) != 0);
    if constexpr (!options.target_reached_until_motion) reached_ = false;
  }

  void operate_profile_position() {
    const SetPoint* const set_point = set_points_.to_start();
    if (set_point == nullptr) return;
    if (blocks(axis_.inputs(), axis_.position_demand() < set_point->target ? 1 : -1)) return set_points_.clear();
    axis_.move_to(set_point->target, set_point->profile);
  }

  // Profile velocity

  template <class Node>
  void operate_profile_velocity(Node& node) {
    const Profile ramps = profile(node);
    const std::int32_t wanted = velocity_target(node);
    if (velocity_told_ && wanted == told_velocity_ && ramps == told_ramps_) return;
    velocity_told_ = true;
    told_velocity_ = wanted;
    told_ramps_ = ramps;
    axis_.run_at(wanted, ramps);
  }

  /// Returns 60FFh limited to 607Fh; 0 if a limit switch or software limit blocks the motion.
  template <class Node>
  [[nodiscard]] std::int32_t velocity_target(const Node& node) const {
    std::int32_t wanted = value<object::TargetVelocity>(node, 0);
    const std::uint32_t allowed = std::min<std::uint32_t>(at_most_allowed(node, 0x7FFF'FFFF), 0x7FFF'FFFF);
    const auto most = static_cast<std::int32_t>(allowed);
    wanted = std::clamp(wanted, -most, most);
    return blocks(axis_.inputs(), wanted) || software_limit_blocks(node, wanted) ? 0 : wanted;
  }

  // Homing

  template <class Node>
  void take_homing_bits(Node& node, std::uint16_t rising) {
    if ((rising & controlword::start_homing) != 0 && !halted_ && (controlword_ & controlword::halt) == 0) {
      if constexpr (options.target_reached_until_motion) {
        homing_starts_ = true;
      } else {
        start_homing(node);
        reached_ = false;
      }
    } else if ((controlword_ & controlword::start_homing) == 0 && homing_.running()) {
      homing_.interrupt();
      axis_.stop(profile(node).deceleration);
    }
  }

  template <class Node>
  void start_homing(const Node& node) {
    const std::uint32_t acceleration = value<object::ProfileAcceleration>(node, options.homing_acceleration);
    homing_.start(axis_, {.method = value<object::HomingMethodCode>(node, 0),
                          .fast = value<object::SpeedToSwitch>(node, 0),
                          .slow = value<object::SpeedToZero>(node, 0),
                          .acceleration = value<object::HomingAcceleration>(node, acceleration),
                          .home_offset = value<object::HomeOffset>(node, 0)});
    homing_starts_ = false;
  }

  // Limits and windows

  /// Whether a limit switch blocks motion in this direction.
  [[nodiscard]] static bool blocks(std::uint32_t inputs, std::int32_t direction) {
    return direction != 0 && (inputs & (direction > 0 ? input::positive_limit : input::negative_limit)) != 0;
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

  /// Whether the demand is at or beyond the software limit in this direction.
  template <class Node>
  [[nodiscard]] bool software_limit_blocks(const Node& node, std::int32_t direction) const {
    const std::int32_t demand = axis_.position_demand();
    return (direction > 0 && within_software_limits(node, max_position) <= demand && demand != max_position) ||
           (direction < 0 && within_software_limits(node, min_position) >= demand && demand != min_position);
  }

  /// Stops an axis at a limit.
  template <class Node>
  void keep_limits(const Node& node) {
    const std::int32_t velocity = axis_.velocity_demand();
    if (state_ != State::operation_enabled || homing_.running()) return;
    const bool at_switch = blocks(axis_.inputs(), velocity);
    if (at_switch) set_points_.clear();
    if (at_switch || (mode_ == mode::profile_velocity && software_limit_blocks(node, velocity))) {
      axis_.stop(quick_stop_deceleration(node));
    }
  }

  /// Updates the conditions of bits 10 to 13 of the statusword after a time span.
  template <class Node>
  void watch_windows(const Node& node, Duration span) {
    const std::uint32_t lag = distance(axis_.position_demand(), axis_.position());
    if constexpr (has<object::FollowingErrorWindow>) {
      const std::uint32_t window = value<object::FollowingErrorWindow>(node, 0);
      off_course_.step(window != 0 && window != 0xFFFF'FFFF && lag > window, span);
      following_error_ = off_course_.lasts(value<object::FollowingErrorTimeOut>(node, 0));
    }
    const std::uint32_t window = value<object::PositionWindow>(node, 0);
    at_target_.step(!axis_.moving() && !set_points_.active() && (window == 0xFFFF'FFFF || lag <= window), span);
    if constexpr (has_mode(mode::profile_velocity)) {
      const std::int32_t velocity = axis_.velocity();
      const std::int32_t wanted = halted_ ? 0 : value<object::TargetVelocity>(node, 0);
      at_speed_.step(distance(velocity, wanted) <= value<object::VelocityWindow>(node, 0), span);
      at_rest_.step(distance(velocity, 0) <= value<object::VelocityThreshold>(node, 0), span);
      resting_ = at_rest_.lasts(value<object::VelocityThresholdTime>(node, 0));
    }
    reached_ = is_reached(node);
  }

  /// Bit 10 of the statusword.
  template <class Node>
  [[nodiscard]] bool is_reached(const Node& node) const {
    if (state_ == State::quick_stop_active || halted_) return !axis_.moving();
    switch (mode_) {
      case mode::profile_velocity: return at_speed_.lasts(value<object::VelocityWindowTime>(node, 0));
      case mode::homing: return !homing_.running() && !axis_.moving();
      default: return at_target_.lasts(value<object::PositionWindowTime>(node, 0));
    }
  }

  // Statusword and actual values

  [[nodiscard]] std::uint16_t mode_bits() const {
    const auto bit_if = [](bool there, std::uint16_t bit) { return there ? bit : std::uint16_t{0}; };
    std::uint16_t bits = bit_if(reached_, statusword::target_reached);
    if (state_ != State::operation_enabled) return state_ == State::quick_stop_active ? bits : std::uint16_t{0};
    switch (mode_) {
      case mode::profile_position:
        bits |= bit_if(set_points_.acknowledge(), statusword::set_point_acknowledge);
        bits |= bit_if(following_error_, statusword::following_error);
        break;
      case mode::profile_velocity:
        bits |= bit_if(options.tells_speed_is_zero && resting_, statusword::speed_is_zero);
        break;
      case mode::homing:
        bits |= bit_if(homing_.attained(), statusword::homing_attained);
        bits |= bit_if(homing_.failed(), statusword::homing_error);
        break;
      case mode::cyclic_synchronous_position:
        bits |= bit_if(operates(), statusword::follows_command);
        bits |= bit_if(following_error_, statusword::following_error);
        break;
      default: break;
    }
    return bits;
  }

  [[nodiscard]] std::uint16_t common_bits() const {
    std::uint16_t bits = bits_of(state_);
    if (quick_stop_bit_is_open(state_)) bits |= controlword_ & controlword::quick_stop ? statusword::quick_stop : 0;
    if (voltage_enabled_) bits |= statusword::voltage_enabled;
    if (warning_) bits |= statusword::warning;
    if (remote_) bits |= statusword::remote;
    if (limit_switch_ || (options.tells_software_limits && software_limit_)) bits |= statusword::internal_limit;
    return bits;
  }

  template <class Node>
  void look_at_limits(const Node& node) {
    limit_switch_ = !homing_.running() && (axis_.inputs() & (input::negative_limit | input::positive_limit)) != 0;
    software_limit_ = !homing_.running() && (software_limit_blocks(node, 1) || software_limit_blocks(node, -1));
  }

  template <class Node, class Application>
  void publish(Node& node, TimePoint now, Application& application) {
    look_at_limits(node);
    auto word = static_cast<std::uint16_t>(common_bits() | mode_bits());
    if constexpr (requires { application.statusword(word); }) word = application.statusword(word);
    const bool changed = word != value<object::Statusword>(node, 0);
    set<object::Statusword>(node, word);
    set<object::ModesOfOperationDisplay>(node, mode_);
    if (!changed && axis_.moving() && now - published_ < Duration{options.actual_values}) return;
    published_ = now;
    set<object::PositionDemandValue>(node, axis_.position_demand());
    set<object::PositionActualValue>(node, axis_.position());
    set<object::VelocityDemandValue>(node, axis_.velocity_demand());
    set<object::VelocityActualValue>(node, axis_.velocity());
    set<object::FollowingErrorActualValue>(
        node, static_cast<std::int32_t>(static_cast<std::uint32_t>(axis_.position_demand()) -
                                        static_cast<std::uint32_t>(axis_.position())));
    set<object::DigitalInputs>(node, axis_.inputs());
  }

  A& axis_;
  State state_ = State::not_ready_to_switch_on;
  State leave_to_ = State::switch_on_disabled;  ///< valid while `leaving_`
  std::int8_t mode_ = options.initial_mode;
  std::int8_t selected_ = options.initial_mode;
  std::uint16_t controlword_ = 0;  ///< the one processed last
  ErrorRegister fault_bits_{};
  Loss loss_ = Loss::none;  ///< to which 6007h has not been applied yet
  bool stopped_ = false;    ///< whether the NMT state was Stopped at the last check
  bool fault_is_there_ = false;
  bool voltage_enabled_ = true;
  bool warning_ = false;
  bool remote_ = false;
  bool halted_ = false;
  bool leaving_ = false;        ///< decelerating to leave Operation Enabled
  bool changing_ = false;       ///< decelerating to change the mode
  bool homing_starts_ = false;  ///< with the next step
  bool reached_ = true;
  bool resting_ = true;
  bool following_error_ = false;
  bool software_limit_ = false;
  bool limit_switch_ = false;
  bool velocity_told_ = false;
  std::int32_t told_velocity_ = 0;
  Profile told_ramps_{};
  SetPoints set_points_{};
  Homing homing_{};
  Lasting at_target_{};
  Lasting at_speed_{};
  Lasting at_rest_{};
  Lasting off_course_{};
  TimePoint stepped_{};    ///< the axis has moved up to this time
  TimePoint published_{};  ///< when actual values were set last
};

}  // namespace canopen::cia402

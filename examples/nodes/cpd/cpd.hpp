/// A servo drive with modes of CiA 402 and four manufacturer-specific ones: manual movement, electronic gear, current
/// and speed.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/node.hpp>
#include <cpd/device.hpp>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "error_memory.hpp"
#include "shared/description.hpp"
#include "shared/drive_node.hpp"

namespace cpd_node {

namespace od = cpd::od;
using canopen::ErrorRegister;
using canopen::cia402::State;

/// Positions are increments, velocities turns per minute, ramps turns per minute and second.
inline constexpr double turn = 16'384;
inline constexpr std::int32_t highest_speed = 12'000;
inline constexpr canopen::cia402::AxisData axis{.increments_per_turn = turn,
                                                .velocity_unit = turn / 60,
                                                .acceleration_unit = turn / 60,
                                                .highest_velocity = highest_speed * turn / 60,
                                                .highest_acceleration = 200'000 * turn / 60};

namespace mode {
inline constexpr std::int8_t speed = -4;
inline constexpr std::int8_t current = -3;
inline constexpr std::int8_t gear = -2;
inline constexpr std::int8_t manual = -1;
}  // namespace mode

inline constexpr canopen::cia402::Options options = [] {
  canopen::cia402::Options result;
  result.lowest_mode = mode::speed;
  result.ready_without_shutdown = true;
  result.target_reached_until_motion = true;
  result.tells_speed_is_zero = false;
  result.faults_without_power = true;  // manual 002, 9.4.9
  result.actual_values = 10'000;
  return result;
}();

/// Bits of 301Bh:09.
namespace manual_movement {
inline constexpr std::uint16_t positive = 1;
inline constexpr std::uint16_t negative = 2;
inline constexpr std::uint16_t fast = 4;
}  // namespace manual_movement

/// Bits of the monitoring signals 301Ch:07 and :08.
namespace signal {
inline constexpr std::uint16_t limit_switch = 0x0002;
inline constexpr std::uint16_t software_limit = 0x0004;
}  // namespace signal

/// Values of 3006h:0Fh and :10h: the contact of a limit switch.
namespace contact {
inline constexpr std::uint16_t none = 0;           ///< the switch is not evaluated
inline constexpr std::uint16_t break_contact = 1;  ///< closed at rest
inline constexpr std::uint16_t make_contact = 2;   ///< closed when the switch is actuated
}  // namespace contact

/// Bits of 3008h:01, the levels of the inputs and outputs. The manual does not print them.
namespace terminal {
inline constexpr std::uint16_t reference = 0x0001;       ///< the home switch
inline constexpr std::uint16_t negative_limit = 0x0002;  ///< LIMN
inline constexpr std::uint16_t positive_limit = 0x0004;  ///< LIMP
inline constexpr unsigned first_free = 3;                ///< this bit and those above it are set by the line `digital`
}  // namespace terminal

/// Bits of 301Ch:04. The manual does not print them.
namespace action {
inline constexpr std::uint16_t warning = 0x0001;
inline constexpr std::uint16_t error = 0x0008;
inline constexpr std::uint16_t standstill = 0x0040;
inline constexpr std::uint16_t positive = 0x0080;    ///< the motor turns in positive direction
inline constexpr std::uint16_t negative = 0x0100;    ///< in negative direction
inline constexpr std::uint16_t in_window = 0x0200;   ///< the following error is not greater than 6067h
inline constexpr std::uint16_t no_profile = 0x0800;  ///< the speed that the drive demands is 0
inline constexpr std::uint16_t decelerates = 0x1000;
inline constexpr std::uint16_t accelerates = 0x2000;
inline constexpr std::uint16_t constant_speed = 0x4000;
}  // namespace action

/// Asynchronous errors in 2041h.
namespace drive_status {
inline constexpr std::uint16_t internal_error = 0x0020;
inline constexpr std::uint16_t external_error = 0x0040;
inline constexpr std::uint16_t warning = 0x0080;
}  // namespace drive_status

namespace error_code {
inline constexpr std::uint16_t following_error = 0x8611;
inline constexpr std::uint16_t reference_limit = 0x8612;
}  // namespace error_code

inline constexpr std::uint16_t with_parameter = 2;       ///< 301Bh:10 and :11: the set-point is 3020h:04, 3021h:04
inline constexpr std::uint16_t immediate_gear = 1;       ///< 301Bh:12
inline constexpr std::uint16_t pulses_as_signal = 1;     ///< 3005h:02
inline constexpr std::int32_t axis_range = 0x1000'0000;  ///< increments, in both directions
inline constexpr std::int32_t current_step = 20;         ///< turns per minute and second for 0.01 A

/// Of the negative modes, which the option of the device accepts, there are four.
struct AcceptsMode {
  canopen::AbortCode operator()(od::modes_of_operation::type wanted) const {
    return canopen::to_raw(wanted) >= mode::speed ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
struct AcceptsHomingMethod {
  canopen::AbortCode operator()(od::homing_method::type wanted) const {
    const std::int8_t method = canopen::to_raw(wanted);
    return method == 0 || canopen::cia402::homing_method(method) != nullptr ? canopen::ok
                                                                            : canopen::AbortCode::invalid_value;
  }
};

/// 6086h, ProfileType: ramps are linear, 0.
struct AcceptsProfileType {
  canopen::AbortCode operator()(od::motion_profile_type::type type) const {
    return canopen::to_raw(type) == 0 ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};

/// 3004h:01, PAReeprSave: 1 stores the same parameters as 1010h:01.
struct SavesSettings {
  canopen::AbortCode operator()(auto& node, std::uint16_t value) const {
    return value == 1 ? node.save() : value == 0 ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
/// 3004h:08, PARusrReset: 1 deletes the stored parameters, like 1011h:01; the next reset loads the default values.
struct RestoresSettings {
  canopen::AbortCode operator()(auto& node, std::uint16_t value) const {
    return value == 1 ? node.restore() : value == 0 ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
/// 303Ch:01, FLT_err_num.
struct ReadsErrorMemory {
  ErrorMemory* memory;
  std::uint16_t operator()() const { return memory->next(); }
};
/// 303Bh:05, FLT_MemReset.
struct RewindsErrorMemory {
  ErrorMemory* memory;
  void operator()(std::uint16_t) const { memory->rewind(); }
};

/// 303Ch has the errors of both the services and the drive (manual 002, 3.5.1).
struct RemembersErrors {
  ErrorMemory* memory;
  nodes::Surroundings* around;
  void operator()(std::uint16_t code) const {
    if (!memory->add(code)) around->log("the error memory cannot be stored");
  }
};

template <class Self, canopen::Bus B>
using Base = nodes::DriveNode<Self, cpd::Device, B, options, canopen::StoredIn<nodes::NodeStorage>,
                              canopen::WriteHandler<od::modes_of_operation, AcceptsMode>,
                              canopen::WriteHandler<od::homing_method, AcceptsHomingMethod>,
                              canopen::WriteHandler<od::motion_profile_type, AcceptsProfileType>,
                              canopen::WriteHandler<od::parameter_storage::save_settings_to_eeprom, SavesSettings>,
                              canopen::WriteHandler<od::parameter_storage::reset_user_settings, RestoresSettings>,
                              canopen::ReadHandler<od::error_memory::error_number, ReadsErrorMemory>,
                              canopen::WriteHandler<od::error_memory_control::error_memory_reset, RewindsErrorMemory>,
                              canopen::ErrorHandler<RemembersErrors>>;

template <canopen::Bus B>
class Cpd : public Base<Cpd<B>, B> {
  using Node = Base<Cpd<B>, B>;
  using Node::axis_;
  using Node::drive_;
  using Node::node_;

 public:
  static constexpr std::uint8_t error_register_bits = 0xB1;  ///< bits 1 to 3 and 6 are reserved (9.4.2)
  static constexpr nodes::Description description{
      "cpd", "A servo drive of CiA 402 with manual movement, electronic gear, current and speed control.", "127",
      "  fault CODE [BITS]                an error of the drive: 603Fh, EMCY; BITS of 1001h\n"
      "  warning BITS on|off              a warning of the drive: 301Ch:0Bh, bit 7 of 6041h and 2041h\n"
      "  pulses N                         at the position interface, for the electronic gear\n"
      "  analogue 1|2 MILLIVOLTS          the voltage at ANA1 or ANA2\n"
      "  digital N on|off                 the level of input or output N, 3 to 15: a bit of 3008h:01\n"
      "  limit negative|positive on|off   actuates or releases a limit switch\n"
      "  contact negative|positive break|make   the contact of a limit switch; default: as in 3006h\n"
      "  switches NEGATIVE POSITIVE       where the limit switches are, in increments from power-on\n"
      "  home on|off                      the home switch\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand to a position, without power\n"
      "  turn N                           the shaft is turned by hand by N increments, without power\n"};

  Cpd(B& bus, nodes::Surroundings& around)
      : Node{bus,
             around,
             around.node_id.value_or(canopen::NodeId{127}),
             axis,
             canopen::stored_in(around.parameters),
             {},
             {},
             {},
             {},
             {},
             {{&errors_}},
             {{&errors_}},
             {{&errors_, &around}}},
        errors_{around.application} {
    errors_.load();
  }

  void restarted() {
    reference_is_valid_ = movement_ended_ = false;
    movement_ = 0;
    status_ = latched_ = latched_warnings_ = 0;
  }

  // Inputs. Call on_time after them.

  /// The voltage at ANA1 or ANA2, in mV.
  void set_analogue(unsigned number, std::int16_t millivolts) { analogue_.at(number - 1) = millivolts; }
  /// The level of an input or output: bit 3 to 15 of 3008h:01.
  void set_digital(unsigned number, bool high) {
    const auto bit = static_cast<std::uint16_t>(1u << number);
    levels_ = static_cast<std::uint16_t>(high ? levels_ | bit : levels_ & ~bit);
  }
  /// Begins or ends warnings: bits of 301Ch:0Bh.
  void set_warnings(std::uint16_t bits, bool active) {
    warnings_ = static_cast<std::uint16_t>(active ? warnings_ | bits : warnings_ & ~bits);
  }
  /// The contact of a limit switch of the machine; without it, each switch has the contact that 3006h names.
  void set_contact(bool positive, std::uint16_t kind) { contacts_.at(positive ? 1 : 0) = kind; }

  /// One step in a manufacturer-specific mode.
  void operate(std::int8_t mode) {
    if (movement_ended_ && !end_is_reported_) return;
    movement_ended_ = false;
    switch (mode) {
      case mode::manual: return operate_manual();
      case mode::gear: return operate_gear();
      case mode::current: return operate_current();
      case mode::speed: return operate_speed();
      default: return;
    }
  }

  /// Bits 13 (movement ended with an error), 14 (movement ended) and 15 (reference point valid); bit 10 also at
  /// standstill without power.
  std::uint16_t statusword(std::uint16_t word) {
    namespace bit = canopen::cia402::statusword;
    const bool stands = !axis_.moving() && !drive_.homing().running();
    if (drive_.state() != State::operation_enabled) {
      word |= bit::following_error;
      if (stands) word |= bit::target_reached;
    } else if (drive_.mode() < 0) {
      word = static_cast<std::uint16_t>(stands ? word | bit::target_reached : word & ~bit::target_reached);
    }
    if (stands || movement_ended_) word |= bit::manufacturer_14;
    end_is_reported_ = movement_ended_;
    if (reference_is_valid_) word |= bit::manufacturer_15;
    return word;
  }

  void watch() {
    take_settings();
    if (drive_.homing().attained()) reference_is_valid_ = true;
    if (std::abs(std::int64_t{axis_.position()}) > axis_range) reference_is_valid_ = false;
    watch_signals();
    if (drive_.following_error() && drive_.state() == State::operation_enabled) {
      status_ |= drive_status::internal_error;
      this->fault(error_code::following_error, ErrorRegister::device_profile, {0x11, 0x86, 0x65, 0x60, 0x00});
    }
    if (was_fault_ && drive_.state() == State::ready_to_switch_on) status_ = latched_ = 0;  // fault reset
    watch_warnings();
    was_fault_ = drive_.state() == State::fault;
    const bool failed = was_fault_ || drive_.state() == State::fault_reaction_active;
    if (failed && (status_ & drive_status::external_error) == 0) status_ |= drive_status::internal_error;
    const bool warns = warnings_ != 0;
    set<od::drive_status>(static_cast<std::uint16_t>(status_ | (warns ? drive_status::warning : 0)));
    set<od::monitoring_status::latched_monitoring_signals>(latched_);
    set<od::monitoring_status::action_status>(action_status(failed));
    set<od::motion_generator::ramp_position_actual_value>(axis_.position_demand());
    set<od::inputs_and_outputs::digital_inputs_and_outputs>(levels());
    set<od::analogue_inputs::analogue_input_ana1>(analogue_[0]);
    set<od::analogue_inputs::analogue_input_ana2>(analogue_[1]);
    show_shaft();
  }

  bool take_line(const nodes::InputLine& line) {
    if (line.is("pulses", 1)) {
      const auto count = line.number<std::int32_t>(1);
      if (count) pulses_ += *count;
      return count.has_value();
    }
    if (line.is("switches", 2)) {
      const auto negative = line.number<std::int32_t>(1);
      const auto positive = line.number<std::int32_t>(2);
      if (!negative || !positive) return false;
      axis_.negative_limit = *negative;
      axis_.positive_limit = *positive;
      return true;
    }
    if (line.is("analogue", 2)) {
      const auto number = line.number<unsigned>(1, 1, 2);
      const auto millivolts = line.number<std::int16_t>(2);
      if (number && millivolts) set_analogue(*number, *millivolts);
      return number && millivolts;
    }
    if (line.is("digital", 2)) {
      const auto number = line.number<unsigned>(1, terminal::first_free, 15);
      const auto high = line.on_or_off(2);
      if (number && high) set_digital(*number, *high);
      return number && high;
    }
    if (line.is("warning", 2)) {
      const auto bits = line.number<std::uint16_t>(1);
      const auto active = line.on_or_off(2);
      if (bits && active) set_warnings(*bits, *active);
      return bits && active;
    }
    if (line.is("contact", 2) && (line.word(1) == "negative" || line.word(1) == "positive") &&
        (line.word(2) == "break" || line.word(2) == "make")) {
      set_contact(line.word(1) == "positive", line.word(2) == "break" ? contact::break_contact : contact::make_contact);
      return true;
    }
    if (line.is("turn", 1)) {
      const auto increments = line.number<std::int32_t>(1);
      return increments && axis_.turn_by(*increments);
    }
    return false;
  }

 private:
  /// The raw numbers of objects: the drive calculates with integers.
  template <class O>
  void set(canopen::RawOf<typename O::type> number) {
    static_cast<void>(node_.set(O{}, canopen::from_raw<typename O::type>(number)));
  }
  template <class O>
  [[nodiscard]] canopen::RawOf<typename O::type> get() const {
    return canopen::to_raw(node_.get(O{}));
  }

  using Values = canopen::cia402::Parameters<cpd::Device, options>;

  /// Moves at a velocity of at most 607Fh. Ends at a software limit, and does not begin towards an active limit switch.
  void run_at(std::int32_t velocity) {
    const auto most =
        static_cast<std::int32_t>(std::min<std::uint32_t>(Values::at_most_allowed(node_, 0x7FFF'FFFF), 0x7FFF'FFFF));
    run_freely(std::clamp(velocity, -most, most), get<od::profile_acceleration>(), get<od::profile_deceleration>());
  }
  void run_freely(std::int32_t velocity, std::uint32_t acceleration, std::uint32_t deceleration) {
    const std::int32_t from = axis_.position_demand();
    if (canopen::cia402::limit_switch_blocks(axis_.inputs(), velocity) ||
        Values::software_limit_blocks(node_, from, velocity)) {
      velocity = 0;
    }
    const std::int32_t end = velocity > 0 ? 0x7FFF'FFFF : -0x7FFF'FFFF;
    const std::int32_t limit = Values::within_software_limits(node_, end);
    if (velocity != 0 && limit != end) {
      axis_.move_to(limit, {static_cast<std::uint32_t>(std::abs(velocity)), acceleration, deceleration});
    } else {
      axis_.run_at(velocity, {0, acceleration, deceleration});
    }
  }

  /// A new direction or speed ends the movement before it begins the next one. A movement that was halted is continued.
  void operate_manual() {
    const std::uint16_t wanted = get<od::operating_mode_settings::manual_movement_activation>();
    if (wanted != movement_ && movement_ != 0) {
      movement_ = 0;
      movement_ended_ = true;
      if (wanted == 0) run_at(0);
      return;
    }
    if (wanted != movement_) {
      movement_ = wanted;
      const bool is_fast = (wanted & manual_movement::fast) != 0;
      const std::int32_t speed =
          is_fast ? get<od::manual_movement::fast_speed>() : get<od::manual_movement::slow_speed>();
      const std::int32_t direction = (wanted & manual_movement::positive) != 0   ? 1
                                     : (wanted & manual_movement::negative) != 0 ? -1
                                                                                 : 0;
      manual_velocity_ = direction * speed;
    }
    run_at(movement_ != 0 ? manual_velocity_ : 0);
  }

  /// The axis follows the pulses times numerator / denominator, from its position at the last change of a factor.
  void operate_gear() {
    const std::int32_t numerator = get<od::electronic_gear::gear_numerator>();
    const std::int32_t denominator = get<od::electronic_gear::gear_denominator>();
    const bool on = get<od::operating_mode_settings::gear_activation>() == immediate_gear &&
                    get<od::position_interface::signal_selection>() == pulses_as_signal && denominator != 0;
    if (!on || numerator != numerator_ || denominator != denominator_) {
      numerator_ = on ? numerator : 0;
      denominator_ = denominator;
      gear_from_ = axis_.position_demand();
      pulses_from_ = pulses_;
      if (!on) return;
    }
    const std::int64_t way = (pulses_ - pulses_from_) * numerator / denominator;
    const std::int64_t target = std::clamp<std::int64_t>(gear_from_ + way, -0x7FFF'FFFF, 0x7FFF'FFFF);
    follow(Values::within_software_limits(node_, static_cast<std::int32_t>(target)));
  }

  /// Follows a position with at most 607Fh, unless a limit switch is active in this direction.
  void follow(std::int32_t position) {
    const std::int32_t from = axis_.position_demand();
    const std::int32_t direction = position > from ? 1 : position < from ? -1 : 0;
    if (canopen::cia402::limit_switch_blocks(axis_.inputs(), direction)) return axis_.stop(0);
    const double speed = Values::at_most_allowed(node_, static_cast<std::uint32_t>(highest_speed)) * axis.velocity_unit;
    const auto most = static_cast<std::int64_t>(speed * options.step / 1e6);
    axis_.follow(static_cast<std::int32_t>(std::clamp<std::int64_t>(position, from - most, from + most)));
  }

  /// A motor without load accelerates in proportion to its current.
  void operate_current() {
    if (get<od::operating_mode_settings::current_setpoint_specification>() != with_parameter) return;
    const std::int32_t current = get<od::current_control::current_setpoint>();
    const auto ramp = static_cast<std::uint32_t>(std::abs(current) * current_step);
    run_freely(current > 0 ? highest_speed : current < 0 ? -highest_speed : 0, ramp, ramp);
  }

  void operate_speed() {
    if (get<od::operating_mode_settings::speed_setpoint_specification>() != with_parameter) return;
    run_at(get<od::speed_control::speed_setpoint>());
  }

  /// The settings that are effective at once: contacts, current limits; the direction of rotation at standstill.
  void take_settings() {
    namespace bit = canopen::cia402::input;
    const std::uint16_t negative = get<od::motion_settings::negative_limit_switch_contact>();
    const std::uint16_t positive = get<od::motion_settings::positive_limit_switch_contact>();
    const auto bits_if = [&](auto condition) {
      return (condition(negative, contacts_[0]) ? bit::negative_limit : 0u) |
             (condition(positive, contacts_[1]) ? bit::positive_limit : 0u);
    };
    axis_.evaluate(bits_if([](std::uint16_t set, auto) { return set == contact::none; }),
                   bits_if([](std::uint16_t set, auto built) { return built && *built != set; }));
    const auto deceleration = [](std::uint16_t current) {
      return current != 0 ? std::optional{static_cast<std::uint32_t>(current * current_step)} : std::nullopt;
    };
    axis_.quick_stop_deceleration = deceleration(get<od::current_limits::quick_stop_current_limit>());
    axis_.highest_deceleration = deceleration(get<od::current_limits::stop_current_limit>());
    const bool reversed = get<od::motion_settings::direction_of_rotation_inversion>() != 0;
    if (reversed != reversed_ && !axis_.moving()) axis_.reverse(reversed_ = reversed);
  }

  /// A limit switch that stops a movement is an error, except during homing.
  void watch_signals() {
    namespace bit = canopen::cia402::input;
    std::uint16_t active = 0;
    const bool at_switch = (axis_.inputs() & (bit::negative_limit | bit::positive_limit)) != 0;
    if (at_switch && !drive_.homing().running()) active |= signal::limit_switch;
    if (drive_.at_software_limit()) active |= signal::software_limit;
    set<od::monitoring_status::active_monitoring_signals>(active);
    const bool tripped = axis_.take_trips() != 0 && drive_.mode() != canopen::cia402::mode::homing;
    if (tripped) active |= signal::limit_switch;
    latched_ |= active;
    if (!tripped || drive_.state() != State::operation_enabled) return;
    status_ |= drive_status::external_error;
    this->fault(error_code::reference_limit, ErrorRegister::device_profile, {0x12, 0x86, 0x1C, 0x30, 0x08});
  }

  /// The command fault reset also deletes the saved warnings.
  void watch_warnings() {
    const bool reset = node_.get(od::controlword{}).fault_reset();
    if (reset && !resets_) latched_warnings_ = 0;
    resets_ = reset;
    latched_warnings_ |= warnings_;
    drive_.set_warning(warnings_ != 0);
    set<od::monitoring_status::active_warnings>(warnings_);
    set<od::monitoring_status::latched_warnings>(latched_warnings_);
  }

  [[nodiscard]] std::uint16_t action_status(bool failed) const {
    const std::int32_t velocity = axis_.velocity();
    const std::int64_t lag = std::abs(std::int64_t{axis_.position_demand()} - axis_.position());
    const bool in_window = lag <= get<od::position_window>();
    unsigned bits = in_window ? action::in_window : 0u;
    if (warnings_ != 0) bits |= action::warning;
    if (failed) bits |= action::error;
    bits |= velocity > 0 ? action::positive : velocity < 0 ? action::negative : action::standstill;
    if (axis_.velocity_demand() == 0) {
      bits |= action::no_profile;
    } else {
      const int change = axis_.speed_change();
      bits |= change > 0 ? action::accelerates : change < 0 ? action::decelerates : action::constant_speed;
    }
    return static_cast<std::uint16_t>(bits);
  }

  /// Bits of `terminal`.
  [[nodiscard]] std::uint16_t levels() const {
    namespace bit = canopen::cia402::input;
    const std::uint32_t actuated = axis_.actuated();
    const auto is_high = [](std::optional<std::uint16_t> built, std::uint16_t set, bool on) {
      return built.value_or(set) == contact::make_contact ? on : !on;
    };
    unsigned result = levels_;
    if ((actuated & bit::home_switch) != 0) result |= terminal::reference;
    if (is_high(contacts_[0], get<od::motion_settings::negative_limit_switch_contact>(),
                (actuated & bit::negative_limit) != 0)) {
      result |= terminal::negative_limit;
    }
    if (is_high(contacts_[1], get<od::motion_settings::positive_limit_switch_contact>(),
                (actuated & bit::positive_limit) != 0)) {
      result |= terminal::positive_limit;
    }
    return static_cast<std::uint16_t>(result);
  }

  void show_shaft() {
    const int turning = axis_.turning();
    if (turning == turning_) return;
    turning_ = turning;
    this->around_.log(turning > 0   ? "shaft turns clockwise"
                      : turning < 0 ? "shaft turns anticlockwise"
                                    : "shaft stands");
  }

  ErrorMemory errors_;
  std::uint16_t movement_ = 0;  ///< present value of 301Bh:09
  bool movement_ended_ = false;
  bool end_is_reported_ = false;  ///< bit 14 has reported the end
  bool reference_is_valid_ = false;
  std::int32_t manual_velocity_ = 0;  ///< of the present manual movement
  bool was_fault_ = false;
  bool reversed_ = false;                                   ///< 3006h:12h in effect
  bool resets_ = false;                                     ///< bit 7 of the controlword
  int turning_ = 0;                                         ///< the direction that the log shows
  std::uint16_t latched_ = 0;                               ///< 301Ch:08
  std::uint16_t warnings_ = 0;                              ///< 301Ch:0Bh
  std::uint16_t latched_warnings_ = 0;                      ///< 301Ch:0Ch
  std::uint16_t levels_ = 0;                                ///< bits of 3008h:01 from `terminal::first_free` on
  std::array<std::int16_t, 2> analogue_{};                  ///< ANA1, ANA2
  std::array<std::optional<std::uint16_t>, 2> contacts_{};  ///< of the negative and the positive limit switch
  std::uint16_t status_ = 0;                                ///< 2041h
  std::int64_t pulses_ = 0;                                 ///< of the position interface
  std::int64_t pulses_from_ = 0;
  std::int64_t gear_from_ = 0;
  std::int32_t numerator_ = 0;
  std::int32_t denominator_ = 0;
};

}  // namespace cpd_node

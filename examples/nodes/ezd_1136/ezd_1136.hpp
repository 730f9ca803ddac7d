/// A closed-loop stepper drive: control modes, alarms, warnings, digital inputs and outputs, and a statusword with
/// manufacturer-specific bits.
#pragma once

#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/node.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ezd_1136/device.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "shared/description.hpp"
#include "shared/drive_node.hpp"
#include "stepper_axis.hpp"
#include "terminals.hpp"

template <>
struct nodes::AxisOf<ezd_1136::Device> {
  using type = ezd_1136_node::StepperAxis;
};

namespace ezd_1136_node {

namespace od = ezd_1136::od;
namespace mode = canopen::cia402::mode;
using canopen::ErrorRegister;
using canopen::cia402::State;

/// Bit 11 of the statusword reports only the limit switches. 6060h accepts CSP, although 6502h does not include it: an
/// option of the device.
inline constexpr canopen::cia402::Options options = [] {
  canopen::cia402::Options result;
  result.tells_software_limits = false;
  result.actual_values = 10'000;
  return result;
}();

/// An alarm: its code is the low byte of the emergency error code. The lamp flashes green once, then red
/// `red_flashes` times.
struct Alarm {
  std::uint8_t code;
  ErrorRegister bits;
  std::uint8_t red_flashes;
  std::string_view name;
};

inline constexpr Alarm alarms[] = {
    {10, ErrorRegister::current, 1, "motor overcurrent"},
    {11, ErrorRegister::current, 2, "motor phase loss"},
    {12, ErrorRegister::current, 1, "motor overcurrent beyond the compensation limit"},
    {13, ErrorRegister::voltage, 4, "undervoltage"},
    {14, ErrorRegister::voltage, 3, "overvoltage"},
    {15, ErrorRegister::temperature, 5, "driver overheating"},
    {16, ErrorRegister::manufacturer, 5, "driver fault"},
    {20, ErrorRegister::manufacturer, 5, "EEPROM write error"},
    {24, ErrorRegister::device_profile, 5, "overspeed"},
    {25, ErrorRegister::device_profile, 5, "position deviation"},
    {26, ErrorRegister::device_profile, 5, "motor overload"},
    {50, ErrorRegister::communication, 5, "bus communication abnormal"},
    {100, ErrorRegister::communication, 5, "bus communication error"},
};

[[nodiscard]] constexpr const Alarm* alarm_of(std::uint8_t code) {
  for (const Alarm& row : alarms) {
    if (row.code == code) return &row;
  }
  return nullptr;
}

/// Warnings are bits of the high byte of the emergency error code.
namespace warning {
inline constexpr std::uint16_t eeprom_read = 256;
inline constexpr std::uint16_t unstable_voltage = 512;
inline constexpr std::uint16_t emergency_stop = 1'024;
inline constexpr std::uint16_t positive_limit = 2'048;
inline constexpr std::uint16_t negative_limit = 4'096;
inline constexpr std::uint16_t homing_failed = 8'192;
}  // namespace warning

/// Values of 206Dh.
namespace run_state {
inline constexpr std::int16_t not_enabled = 1;
inline constexpr std::int16_t stopped = 2;
inline constexpr std::int16_t running = 3;
}  // namespace run_state

inline constexpr int lowest_supply = 18;   ///< V
inline constexpr int highest_supply = 60;  ///< V

inline constexpr std::uint32_t default_resolution = 4'000;  ///< of 20F2h

/// Of the motor, which 2127h = 1 writes to 20D0h and 20D1h.
inline constexpr std::uint16_t motor_inductance = 3'200;  ///< in 1e-6 H
inline constexpr std::uint16_t motor_resistance = 1'100;  ///< in 1e-3 ohm

/// 20CEh: 2 to 4 are not supported.
struct AcceptsControlMode {
  Control* control;
  canopen::AbortCode operator()(od::control_mode::type mode) const {
    const std::uint16_t wanted = canopen::to_raw(mode);
    if (wanted >= 2 && wanted <= 4) return canopen::AbortCode::invalid_value;
    *control = static_cast<Control>(wanted);
    return canopen::ok;
  }
};

struct AcceptsHomingMethod {
  canopen::AbortCode operator()(od::homing_method::type wanted) const {
    const std::int8_t method = canopen::to_raw(wanted);
    return method == 0 || canopen::cia402::homing_method(method) != nullptr ? canopen::ok
                                                                            : canopen::AbortCode::invalid_value;
  }
};
/// 605Ah: 1, 2, 5 and 6.
struct AcceptsQuickStopOption {
  canopen::AbortCode operator()(od::quick_stop_option_code::type option) const {
    const std::int16_t code = canopen::to_raw(option);
    return code == 1 || code == 2 || code == 5 || code == 6 ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
/// The other option codes, up to the highest that the drive supports.
template <std::int16_t Highest>
struct AcceptsOption {
  canopen::AbortCode operator()(auto option) const {
    const std::int16_t code = canopen::to_raw(option);
    return code >= 0 && code <= Highest ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};

template <class Self, canopen::Bus B>
using Base =
    nodes::DriveNode<Self, ezd_1136::Device, B, options, canopen::WriteHandler<od::homing_method, AcceptsHomingMethod>,
                     canopen::WriteHandler<od::quick_stop_option_code, AcceptsQuickStopOption>,
                     canopen::WriteHandler<od::shutdown_option_code, AcceptsOption<1>>,
                     canopen::WriteHandler<od::disable_operation_option_code, AcceptsOption<1>>,
                     canopen::WriteHandler<od::fault_reaction_option_code, AcceptsOption<2>>,
                     canopen::WriteHandler<od::control_mode, AcceptsControlMode>>;

template <canopen::Bus B>
class Ezd1136 : public Base<Ezd1136<B>, B> {
  using Node = Base<Ezd1136<B>, B>;
  using Node::axis_;
  using Node::drive_;
  using Node::node_;

 public:
  static constexpr nodes::Description description{
      "ezd_1136", "A closed-loop stepper drive of CiA 402.", "1",
      "  alarm CODE                       10 to 16, 20, 24 to 26, 50 or 100\n"
      "  warning BITS on|off              256, 512, 1024 (emergency stop), 2048, 4096, 8192, or their sum\n"
      "  supply VOLTS                     below 18 V alarm 13, above 60 V alarm 14\n"
      "  phases on|off                    the motor is connected; off: alarm 11\n"
      "  input N on|off                   digital input 1 to 8\n"
      "  limit negative|positive on|off   a limit switch, at digital input 1 or 2\n"
      "  home on|off                      the origin switch, at digital input 3\n"
      "  pulses N                         at the pulse input, for 20CEh = 0\n"
      "  load N                           torque of the load, in 0.1 % of the rated torque; above 1000 alarm 26\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  current AMPERES|off              a measured current for 2064h, instead of the simulated one\n"
      "  analogue VOLTS                   at the analogue input, for 2090h\n"
      "  position N                       the shaft is turned by hand, without power\n"
      "  fault CODE [BITS]                another error: 603Fh, EMCY; BITS of 1001h\n"};

  Ezd1136(B& bus, nodes::Surroundings& around)
      : Node{
            bus, around,     around.node_id.value_or(canopen::NodeId{1}), axis_data(default_resolution), {}, {}, {}, {},
            {},  {&control_}} {}

  void restarted() {
    alarm_ = 0;
    warnings_ = 0;
    was_commanded_ = false;
    control_ = Control::software;
  }

  /// Bits 8, 12, 14 and 15 as in the manual, and bit 10 only after a motion.
  std::uint16_t statusword(std::uint16_t word) {
    namespace bit = canopen::cia402::statusword;
    const State state = drive_.state();
    const bool in_fault = state == State::fault || state == State::fault_reaction_active;
    const bool positions = drive_.mode() == mode::profile_position || drive_.mode() == mode::homing;
    remember_commands();
    if (drive_.mode() == mode::profile_position && drive_.operates()) {
      word = static_cast<std::uint16_t>(is_in_position() ? word | bit::target_reached : word & ~bit::target_reached);
    }
    if (drive_.halted() || state == State::quick_stop_active || drive_.at_limit_switch()) word |= bit::manufacturer_8;
    if (positions && state == State::operation_enabled && !was_commanded_) {
      word |= bit::manufacturer_15;
      if (!drive_.halted()) word = static_cast<std::uint16_t>(word & ~bit::target_reached);
    }
    if (drive_.mode() == mode::profile_position && was_commanded_) word |= bit::set_point_acknowledge;
    if (drive_.mode() == mode::profile_velocity && in_fault && axis_.velocity() == 0) {
      word |= bit::speed_is_zero | bit::target_reached;
    }
    if (a_parameter_is_0()) word |= bit::manufacturer_14;
    return word;
  }

  void watch() {
    configure_axis();
    if (alarm_ != 0 && drive_.state() == State::switch_on_disabled) alarm_ = 0;  // fault reset
    raise_alarms_of_the_axis();
    report_warnings();
    detect_motor();
    set<od::bus_voltage>(static_cast<std::uint16_t>(supply_ * 100));
    set<od::drive_error_code>(static_cast<std::uint16_t>(warnings_ | alarm_));
    set<od::run_state>(drive_.state() != State::operation_enabled ? run_state::not_enabled
                       : axis_.moving()                           ? run_state::running
                                                                  : run_state::stopped);
    set<od::locked_rotor_detection>(axis_.rotor_is_locked() ? 1 : 0);
    set<od::integrated_current>(measured_current_.value_or(current()));
    set<od::torque_demand_value>(axis_.torque_demand());
    set<od::current_actual_value>(axis_.controls_torque() ? axis_.torque() : std::int16_t{0});
    show_lamp();
    show_outputs();
  }

  /// Raises alarm 50 while enabled, and alarm 100 when the node is then started again.
  void abort_connection(std::int16_t) {
    was_disconnected_ = true;
    raise(50);
  }
  void on_state(canopen::NmtState state) {
    if (state != canopen::NmtState::operational || !was_disconnected_) return;
    was_disconnected_ = false;
    raise(100);
  }

  // The inputs of the drive. After a call, `on_time` processes the change.

  /// Returns false if the alarm does not exist.
  bool raise(std::uint8_t code) {
    const Alarm* const alarm = alarm_of(code);
    if (alarm == nullptr) return false;
    alarm_ = code;
    this->fault(static_cast<std::uint16_t>(warnings_ | code), alarm->bits);
    return true;
  }
  void set_warnings(std::uint16_t bits, bool on) {
    injected_ = static_cast<std::uint16_t>(on ? injected_ | bits : injected_ & ~bits);
  }
  void set_supply(int volts) {
    supply_ = volts;
    keep_fault();
    if (const std::uint8_t code = supply_alarm(); code != 0) static_cast<void>(raise(code));
  }
  void connect_phases(bool connected) {
    phases_ = connected;
    keep_fault();
    if (!connected) static_cast<void>(raise(11));
  }
  /// `number`: 1 to 8.
  void set_input(unsigned number, bool on) { axis_.terminals.set(number, on); }
  void set_analogue(double volts) { set<od::analog_voltage>(static_cast<std::uint16_t>(std::lround(volts * 1000))); }
  /// A measured current for 2064h; std::nullopt: the simulated one.
  void set_current(std::optional<double> amperes) {
    measured_current_ = amperes ? std::optional{static_cast<std::int16_t>(std::lround(*amperes * 1000))} : std::nullopt;
  }

  /// Digital outputs 1 to 5, from bit 0 on.
  [[nodiscard]] std::uint8_t outputs() const { return outputs_shown_; }

  bool take_line(const nodes::InputLine& line) {
    if (line.is("alarm", 1)) {
      const auto code = line.number<std::uint8_t>(1);
      return code && raise(*code);
    }
    if (line.is("warning", 2)) {
      const auto bits = line.number<std::uint16_t>(1, 256, 16'128);
      const auto on = line.on_or_off(2);
      if (bits && on) set_warnings(*bits, *on);
      return bits && on;
    }
    if (line.is("supply", 1)) {
      const auto volts = line.number<int>(1, 0, 655);
      if (volts) set_supply(*volts);
      return volts.has_value();
    }
    if (line.is("phases", 1)) {
      const auto on = line.on_or_off(1);
      if (on) connect_phases(*on);
      return on.has_value();
    }
    if (line.is("input", 2)) {
      const auto number = line.number<unsigned>(1, 1, input_count);
      const auto on = line.on_or_off(2);
      if (number && on) set_input(*number, *on);
      return number && on;
    }
    if (line.is("pulses", 1)) {
      const auto count = line.number<std::int32_t>(1, -1'000'000, 1'000'000);
      if (count) axis_.add_pulses(*count);
      return count.has_value();
    }
    if (line.is("load", 1)) {
      const auto torque = line.number<std::int16_t>(1, 0);
      if (torque) axis_.set_load(*torque);
      return torque.has_value();
    }
    if (line.is("current", 1)) {
      const auto amperes = line.word(1) == "off" ? std::nullopt : line.real(1);
      set_current(amperes);
      return amperes || line.word(1) == "off";
    }
    if (line.is("analogue", 1)) {
      const auto volts = line.real(1);
      if (volts) set_analogue(*volts);
      return volts.has_value();
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
  [[nodiscard]] canopen::RawOf<typename O::type> value() const {
    return canopen::to_raw(node_.get(O{}));
  }
  template <class O>
  [[nodiscard]] bool is_0() const {
    return value<O>() == 0;
  }

  [[nodiscard]] std::uint8_t supply_alarm() const {
    return supply_ < lowest_supply ? 13 : supply_ > highest_supply ? 14 : 0;
  }
  void keep_fault() { drive_.keep_fault(supply_alarm() != 0 || !phases_); }

  void configure_axis() {
    axis_.terminals.configure(input_functions(), value<od::digital_input_logic>());
    const auto direction = value<od::running_direction>();
    const auto lowest = value<od::software_position_limit<1>>();
    const auto highest = value<od::software_position_limit<2>>();
    const bool limited = lowest < highest;  // no limit otherwise, in each mode of operation
    axis_.configure({.resolution = value<od::resolution_setting>(),
                     .motor_reversed = (direction & 1) != 0,
                     .encoder_reversed = (direction & 2) != 0,
                     .closed_loop = value<od::motor_mode_setting>() == 1,
                     .jump_speed = value<od::end_velocity>(),
                     .filter = value<od::filter_coefficient>(),
                     .target_torque = value<od::target_torque>(),
                     .torque_slope = value<od::torque_slope>(),
                     .torque_speed = value<od::torque_speed>(),
                     .reference_torque = value<od::reference_torque>(),
                     .check_torque = value<od::check_torque_timer>(),
                     .locked_above = value<od::lrd_threshold_speed>(),
                     .locked_count = value<od::lrd_maximum_count>(),
                     .lowest = limited ? lowest : std::numeric_limits<std::int32_t>::min(),
                     .highest = limited ? highest : std::numeric_limits<std::int32_t>::max()});
    axis_.select(control_);
    axis_.operate(drive_.operates());
  }
  [[nodiscard]] std::array<std::uint16_t, input_count> input_functions() const {
    return {value<od::digital_input_functions<1>>(), value<od::digital_input_functions<2>>(),
            value<od::digital_input_functions<3>>(), value<od::digital_input_functions<4>>(),
            value<od::digital_input_functions<5>>(), value<od::digital_input_functions<6>>(),
            value<od::digital_input_functions<7>>(), value<od::digital_input_functions<8>>()};
  }
  [[nodiscard]] std::array<std::uint16_t, output_count> output_functions() const {
    return {value<od::digital_output_functions<1>>(), value<od::digital_output_functions<2>>(),
            value<od::digital_output_functions<3>>(), value<od::digital_output_functions<4>>(),
            value<od::digital_output_functions<5>>()};
  }

  /// The pulses between the commanded and the actual position.
  [[nodiscard]] std::uint32_t deviation() const {
    return canopen::cia402::distance(axis_.position_demand(), axis_.position());
  }
  /// A motion has ended within 20F7h of its target.
  [[nodiscard]] bool is_in_position() const {
    return !axis_.moving() && !drive_.set_points().active() && deviation() <= value<od::in_position_range>();
  }

  /// Alarms 24, 25 and 26. Their limits are 20FEh in 0.01 turns per second and 2102h in counts of the encoder; 0: none.
  void raise_alarms_of_the_axis() {
    if (drive_.state() != State::operation_enabled) return;
    const std::int16_t fastest = value<od::maximum_speed>();
    const std::uint16_t most = value<od::position_error_threshold>();
    const std::uint64_t counts =
        std::uint64_t{deviation()} * value<od::encoder_resolution>() / value<od::resolution_setting>();
    if (fastest > 0 && std::abs(axis_.velocity()) > fastest) {
      static_cast<void>(raise(24));
    } else if (most != 0 && counts > most && !axis_.controls_torque()) {
      static_cast<void>(raise(25));
    } else if (axis_.overloaded() && axis_.moving()) {
      static_cast<void>(raise(26));
    }
  }

  /// 2127h = 1 in open loop.
  void detect_motor() {
    if (value<od::automatic_parameter_detection>() != 1 || value<od::motor_mode_setting>() != 0) return;
    set<od::l1e6>(motor_inductance);
    set<od::r1e3>(motor_resistance);
  }

  /// The current of the motor in mA: 20F1h, after 20F5h at rest 20D5h per cent of it; in torque control in proportion
  /// to the torque.
  [[nodiscard]] std::int16_t current() const {
    if (!canopen::cia402::has_power(drive_.state())) return 0;
    const std::int32_t operating = value<od::current_command_setting>();
    if (axis_.controls_torque()) {
      return static_cast<std::int16_t>(operating * std::abs(axis_.torque()) / StepperAxis::rated_torque);
    }
    const bool idle = axis_.rests_for() >= std::chrono::milliseconds{value<od::half_current_time>()};
    return static_cast<std::int16_t>(idle ? operating * value<od::idle_current>() / 100 : operating);
  }

  /// Records whether the drive got a motion command in this mode since it was enabled.
  void remember_commands() {
    const State state = drive_.state();
    const canopen::cia402::Homing& homing = drive_.homing();
    const bool keeps = state == State::operation_enabled || state == State::quick_stop_active ||
                       state == State::fault_reaction_active || state == State::fault;
    if (!keeps || drive_.mode() != commanded_mode_) was_commanded_ = false;
    commanded_mode_ = drive_.mode();
    if (drive_.set_points().acknowledge() || homing.running() || homing.attained() || homing.failed()) {
      was_commanded_ = true;
    }
  }

  /// Bit 14: a speed or ramp of the mode is 0.
  [[nodiscard]] bool a_parameter_is_0() const {
    const bool ramps = is_0<od::profile_acceleration>() || is_0<od::profile_deceleration>();
    switch (drive_.mode()) {
      case mode::profile_position: return ramps || is_0<od::profile_velocity>();
      case mode::profile_velocity: return ramps;
      case mode::homing:
        return is_0<od::homing_speeds<1>>() || is_0<od::homing_speeds<2>>() || is_0<od::homing_acceleration>();
      default: return false;
    }
  }

  [[nodiscard]] std::uint16_t present_warnings() const {
    const std::uint32_t inputs = axis_.inputs();
    const std::int32_t position = axis_.position();
    std::uint16_t bits = injected_;
    if ((inputs & canopen::cia402::input::positive_limit) != 0 || position >= value<od::software_position_limit<2>>()) {
      bits |= warning::positive_limit;
    }
    if ((inputs & canopen::cia402::input::negative_limit) != 0 || position <= value<od::software_position_limit<1>>()) {
      bits |= warning::negative_limit;
    }
    if (drive_.homing().failed()) bits |= warning::homing_failed;
    if (axis_.terminals.has(input_function::emergency_stop)) bits |= warning::emergency_stop;
    return bits;
  }

  /// Sends an EMCY with the sum of the warnings if one is new, with 0000h if one is over; not during homing, which
  /// searches the limits.
  void report_warnings() {
    const std::uint16_t now = present_warnings();
    if ((now & warning::emergency_stop) != 0) drive_.quick_stop(node_);
    if (drive_.homing().running() || now == warnings_) return;
    const bool fresh = (now & ~warnings_) != 0;
    warnings_ = now;
    if (fresh) {
      const auto code = static_cast<std::uint16_t>(now | alarm_);
      set<od::error_code>(code);
      node_.emergency(code, ErrorRegister::manufacturer);
    } else {
      node_.emergency_over(now == 0 ? ErrorRegister::manufacturer : ErrorRegister{});
    }
  }

  void show_lamp() {
    const Alarm* const alarm = alarm_of(alarm_);
    std::string lamp = "LED green flashing";
    if (alarm != nullptr) {
      lamp = "LED 1 green + " + std::to_string(alarm->red_flashes) + " red";
    } else if (warnings_ != 0) {
      lamp = "LED red steady";
    } else if (drive_.state() == State::operation_enabled && axis_.moving()) {
      lamp = "LED green steady";
    }
    if (lamp == lamp_) return;
    lamp_ = lamp;
    this->around_.log(lamp);
  }

  /// 60FEh:01 switches the outputs that 60FEh:02 releases; 21AEh inverts outputs.
  void show_outputs() {
    const std::uint32_t word = value<od::digital_outputs<1>>() & value<od::digital_outputs<2>>();
    const std::array<std::uint16_t, output_count> functions = output_functions();
    std::uint8_t levels = 0;
    for (unsigned i = 0; i < output_count; ++i) {
      bool on = false;
      switch (functions[i]) {
        case output_function::control_word: on = (word >> (first_terminal_bit + i) & 1u) != 0; break;
        case output_function::alarm: on = alarm_ != 0; break;
        case output_function::in_position: on = is_in_position(); break;
        case output_function::motor_has_power: on = canopen::cia402::has_power(drive_.state()); break;
        default: break;
      }
      if (on) levels = static_cast<std::uint8_t>(levels | 1u << i);
    }
    levels = static_cast<std::uint8_t>((levels ^ value<od::digital_output_logic>()) & ((1u << output_count) - 1));
    const unsigned changed = levels ^ outputs_shown_;
    outputs_shown_ = levels;
    for (unsigned i = 0; i < output_count; ++i) {
      if ((changed >> i & 1u) == 0) continue;
      this->around_.log("output " + std::to_string(i + 1) + ((levels >> i & 1u) != 0 ? " on" : " off"));
    }
  }

  Control control_ = Control::software;           ///< 20CEh; the manual requires this mode for motion by CANopen
  std::optional<std::int16_t> measured_current_;  ///< mA
  bool phases_ = true;                            ///< the motor is connected
  std::uint8_t outputs_shown_ = 0;                ///< digital outputs from bit 0 on
  std::uint8_t alarm_ = 0;                        ///< until a fault reset
  std::uint16_t warnings_ = 0;                    ///< reported warnings
  std::uint16_t injected_ = 0;                    ///< warnings of input lines
  int supply_ = 48;                               ///< V
  bool was_commanded_ = false;
  bool was_disconnected_ = false;  ///< while enabled
  std::int8_t commanded_mode_ = 0;
  std::string lamp_;
};

}  // namespace ezd_1136_node

/// A closed-loop stepper drive: alarms, warnings, and a statusword with manufacturer-specific bits.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/node.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ezd_1136/device.hpp>
#include <iterator>
#include <string>
#include <string_view>

#include "shared/description.hpp"
#include "shared/drive_node.hpp"

namespace ezd_1136_node {

namespace od = ezd_1136::od;
namespace mode = canopen::cia402::mode;
using canopen::ErrorRegister;
using canopen::cia402::State;

/// Positions are pulses, velocities 0.01 turns per second, ramps turns per second squared.
inline constexpr nodes::AxisData axis{.increments_per_turn = 10'000,
                                      .velocity_unit = 100,
                                      .acceleration_unit = 10'000,
                                      .highest_velocity = 10'000 * 50,
                                      .highest_acceleration = 10'000 * 2'000};

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

struct AcceptsHomingMethod {
  canopen::AbortCode operator()(std::int8_t method) const {
    return method == 0 || canopen::cia402::homing_method(method) != nullptr ? canopen::ok
                                                                            : canopen::AbortCode::invalid_value;
  }
};
/// 605Ah: 1, 2, 5 and 6.
struct AcceptsQuickStopOption {
  canopen::AbortCode operator()(std::int16_t code) const {
    return code == 1 || code == 2 || code == 5 || code == 6 ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
/// The other option codes, up to the highest that the drive supports.
template <std::int16_t Highest>
struct AcceptsOption {
  canopen::AbortCode operator()(std::int16_t code) const {
    return code >= 0 && code <= Highest ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};

template <class Self, canopen::Bus B>
using Base =
    nodes::DriveNode<Self, ezd_1136::Device, B, options, canopen::WriteHandler<od::homing_method, AcceptsHomingMethod>,
                     canopen::WriteHandler<od::quick_stop_option_code, AcceptsQuickStopOption>,
                     canopen::WriteHandler<od::shutdown_option_code, AcceptsOption<1>>,
                     canopen::WriteHandler<od::disable_operation_option_code, AcceptsOption<1>>,
                     canopen::WriteHandler<od::fault_reaction_option_code, AcceptsOption<2>>>;

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
      "  current AMPERES                  of the motor, for 2064h\n"
      "  analogue VOLTS                   at the analogue input, for 2090h\n"
      "  limit negative|positive on|off   a limit switch\n"
      "  home on|off                      the home switch\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand, without power\n"};

  Ezd1136(B& bus, nodes::Surroundings& around)
      : Node{bus, around, around.node_id.value_or(canopen::NodeId{1}), axis, {}, {}, {}, {}, {}} {}

  void restarted() {
    alarm_ = 0;
    warnings_ = 0;
    was_commanded_ = false;
  }

  /// Bits 8, 12, 14 and 15 as in the manual, and bit 10 only after a motion.
  std::uint16_t statusword(std::uint16_t word) {
    namespace bit = canopen::cia402::statusword;
    const State state = drive_.state();
    const bool in_fault = state == State::fault || state == State::fault_reaction_active;
    const bool positions = drive_.mode() == mode::profile_position || drive_.mode() == mode::homing;
    remember_commands();
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
    if (alarm_ != 0 && drive_.state() == State::switch_on_disabled) alarm_ = 0;  // fault reset
    const std::uint32_t deviation = canopen::cia402::distance(axis_.position_demand(), axis_.position());
    const std::uint16_t most = node_.get(od::position_error_threshold{});
    if (most != 0 && deviation > most && drive_.state() == State::operation_enabled) raise(25);
    report_warnings();
    set<od::bus_voltage>(static_cast<std::uint16_t>(supply_ * 100));
    set<od::drive_error_code>(static_cast<std::uint16_t>(warnings_ | alarm_));
    set<od::run_state>(drive_.state() != State::operation_enabled ? run_state::not_enabled
                       : axis_.moving()                           ? run_state::running
                                                                  : run_state::stopped);
    show_lamp();
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

  bool take_line(const nodes::InputLine& line) {
    if (line.is("alarm", 1)) {
      const auto code = line.number<std::uint8_t>(1);
      return code && raise(*code);
    }
    if (line.is("warning", 2)) {
      const auto bits = line.number<std::uint16_t>(1, 256, 16'128);
      const auto on = line.on_or_off(2);
      if (!bits || !on) return false;
      injected_ = static_cast<std::uint16_t>(*on ? injected_ | *bits : injected_ & ~*bits);
      return true;
    }
    if (line.is("supply", 1)) {
      const auto volts = line.number<int>(1, 0, 655);
      if (volts) set_supply(*volts);
      return volts.has_value();
    }
    if (line.is("current", 1)) {
      const auto amperes = line.real(1);
      if (amperes) set<od::integrated_current>(static_cast<std::int16_t>(std::lround(*amperes * 1000)));
      return amperes.has_value();
    }
    if (line.is("analogue", 1)) {
      const auto volts = line.real(1);
      if (volts) set<od::analog_voltage>(static_cast<std::uint16_t>(std::lround(*volts * 1000)));
      return volts.has_value();
    }
    return false;
  }

 private:
  template <class O>
  void set(typename O::type value) {
    static_cast<void>(node_.set(O{}, value));
  }
  template <class O>
  [[nodiscard]] bool is_0() const {
    return node_.get(O{}) == 0;
  }

  /// Returns false if the alarm does not exist.
  bool raise(std::uint8_t code) {
    const Alarm* const alarm = alarm_of(code);
    if (alarm == nullptr) return false;
    alarm_ = code;
    this->fault(static_cast<std::uint16_t>(warnings_ | code), alarm->bits);
    return true;
  }

  void set_supply(int volts) {
    supply_ = volts;
    const std::uint8_t code = volts < lowest_supply ? 13 : volts > highest_supply ? 14 : 0;
    drive_.keep_fault(code != 0);
    if (code != 0) static_cast<void>(raise(code));
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
    if ((inputs & canopen::cia402::input::positive_limit) != 0 ||
        position >= node_.get(od::software_position_limit<2>{})) {
      bits |= warning::positive_limit;
    }
    if ((inputs & canopen::cia402::input::negative_limit) != 0 ||
        position <= node_.get(od::software_position_limit<1>{})) {
      bits |= warning::negative_limit;
    }
    if (drive_.homing().failed()) bits |= warning::homing_failed;
    return bits;
  }

  /// Sends an EMCY with the sum of the warnings if one is new, with 0000h if one is over. Does nothing during homing,
  /// which searches the limits.
  void report_warnings() {
    if (drive_.homing().running()) return;
    const std::uint16_t now = present_warnings();
    if (now == warnings_) return;
    const bool fresh = (now & ~warnings_) != 0;
    warnings_ = now;
    if ((now & warning::emergency_stop) != 0) drive_.quick_stop(node_);
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

  std::uint8_t alarm_ = 0;      ///< until a fault reset
  std::uint16_t warnings_ = 0;  ///< reported warnings
  std::uint16_t injected_ = 0;  ///< warnings of input lines
  int supply_ = 48;             ///< V
  bool was_commanded_ = false;
  bool was_disconnected_ = false;  ///< while enabled
  std::int8_t commanded_mode_ = 0;
  std::string lamp_;
};

}  // namespace ezd_1136_node

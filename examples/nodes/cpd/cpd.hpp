/// A servo drive with modes of CiA 402 and four manufacturer-specific ones: manual movement, electronic gear, current
/// and speed.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/node.hpp>
#include <cpd/device.hpp>
#include <cstdint>
#include <cstdlib>
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
inline constexpr nodes::AxisData axis{.increments_per_turn = turn,
                                      .velocity_unit = turn / 60,
                                      .acceleration_unit = turn / 60,
                                      .highest_velocity = 12'000 * turn / 60,
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
  canopen::AbortCode operator()(std::int8_t wanted) const {
    return wanted >= mode::speed ? canopen::ok : canopen::AbortCode::invalid_value;
  }
};
struct AcceptsHomingMethod {
  canopen::AbortCode operator()(std::int8_t method) const {
    return method == 0 || canopen::cia402::homing_method(method) != nullptr ? canopen::ok
                                                                            : canopen::AbortCode::invalid_value;
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
  static constexpr nodes::Description description{
      "cpd", "A servo drive of CiA 402 with manual movement, electronic gear, current and speed control.", "127",
      "  fault CODE [BITS]                an error of the drive: 603Fh, EMCY; BITS of 1001h\n"
      "  pulses N                         at the position interface, for the electronic gear\n"
      "  limit negative|positive on|off   a limit switch\n"
      "  switches NEGATIVE POSITIVE       where the limit switches are, in increments from power-on\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand, without power\n"};

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
             {{&errors_}},
             {{&errors_}},
             {{&errors_, &around}}},
        errors_{around.application} {
    errors_.load();
  }

  void restarted() {
    reference_is_valid_ = movement_ended_ = false;
    movement_ = 0;
    status_ = latched_ = 0;
  }

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
    if (drive_.homing().attained()) reference_is_valid_ = true;
    if (std::abs(std::int64_t{axis_.position()}) > axis_range) reference_is_valid_ = false;
    watch_signals();
    if (drive_.following_error() && drive_.state() == State::operation_enabled) {
      status_ |= drive_status::internal_error;
      this->fault(error_code::following_error, ErrorRegister::device_profile, {0x11, 0x86, 0x65, 0x60, 0x00});
    }
    if (was_fault_ && drive_.state() == State::ready_to_switch_on) status_ = latched_ = 0;  // fault reset
    was_fault_ = drive_.state() == State::fault;
    const bool failed = was_fault_ || drive_.state() == State::fault_reaction_active;
    if (failed && (status_ & drive_status::external_error) == 0) status_ |= drive_status::internal_error;
    set<od::drive_status>(status_);
    set<od::monitoring_status::latched_monitoring_signals>(latched_);
    set<od::motion_generator::ramp_position_actual_value>(axis_.position_demand());
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
    return false;
  }

 private:
  template <class O>
  void set(typename O::type value) {
    static_cast<void>(node_.set(O{}, value));
  }
  template <class O>
  [[nodiscard]] typename O::type get() const {
    return node_.get(O{});
  }

  void run_at(std::int32_t velocity) {
    axis_.run_at(velocity, {0, get<od::profile_acceleration>(), get<od::profile_deceleration>()});
  }

  /// A new direction or speed ends the movement before it begins the next one.
  void operate_manual() {
    const std::uint16_t wanted = get<od::operating_mode_settings::manual_movement_activation>();
    if (wanted == movement_) return;
    if (movement_ != 0) {
      movement_ = 0;
      movement_ended_ = true;
      if (wanted == 0) run_at(0);
      return;
    }
    movement_ = wanted;
    const bool is_fast = (wanted & manual_movement::fast) != 0;
    const std::int32_t speed =
        is_fast ? get<od::manual_movement::fast_speed>() : get<od::manual_movement::slow_speed>();
    const std::int32_t direction = (wanted & manual_movement::positive) != 0   ? 1
                                   : (wanted & manual_movement::negative) != 0 ? -1
                                                                               : 0;
    run_at(direction * speed);
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
    axis_.follow(static_cast<std::int32_t>(gear_from_ + way));
  }

  /// A motor without load accelerates in proportion to its current.
  void operate_current() {
    if (get<od::operating_mode_settings::current_setpoint_specification>() != with_parameter) return;
    const std::int32_t current = get<od::current_control::current_setpoint>();
    const auto ramp = static_cast<std::uint32_t>(std::abs(current) * current_step);
    const std::int32_t most = 12'000;
    axis_.run_at(current > 0 ? most : current < 0 ? -most : 0, {0, ramp, ramp});
  }

  void operate_speed() {
    if (get<od::operating_mode_settings::speed_setpoint_specification>() != with_parameter) return;
    run_at(get<od::speed_control::speed_setpoint>());
  }

  /// A limit switch that stops a movement is an error, except during homing.
  void watch_signals() {
    std::uint16_t active = 0;
    if (drive_.at_limit_switch()) active |= signal::limit_switch;
    if (drive_.at_software_limit()) active |= signal::software_limit;
    const bool tripped = (active & signal::limit_switch) != 0 && (active_ & signal::limit_switch) == 0;
    const bool stops = tripped && axis_.moving() && drive_.state() == State::operation_enabled;
    active_ = active;
    latched_ |= active;
    set<od::monitoring_status::active_monitoring_signals>(active);
    if (!stops) return;
    status_ |= drive_status::external_error;
    this->fault(error_code::reference_limit, ErrorRegister::device_profile, {0x12, 0x86, 0x1C, 0x30, 0x08});
  }

  ErrorMemory errors_;
  std::uint16_t movement_ = 0;  ///< present value of 301Bh:09
  bool movement_ended_ = false;
  bool end_is_reported_ = false;  ///< bit 14 has reported the end
  bool reference_is_valid_ = false;
  bool was_fault_ = false;
  std::uint16_t active_ = 0;   ///< 301Ch:07
  std::uint16_t latched_ = 0;  ///< 301Ch:08
  std::uint16_t status_ = 0;   ///< 2041h
  std::int64_t pulses_ = 0;    ///< of the position interface
  std::int64_t pulses_from_ = 0;
  std::int64_t gear_from_ = 0;
  std::int32_t numerator_ = 0;
  std::int32_t denominator_ = 0;
};

}  // namespace cpd_node

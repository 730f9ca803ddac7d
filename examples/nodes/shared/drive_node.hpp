/// A drive of CiA 402 on a host: a node, its device control and a simulated axis.
#pragma once

#include <algorithm>
#include <canopen/node.hpp>
#include <canopen/profile/cia402.hpp>
#include <canopen/profile/cia402_simulated_axis.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "input_line.hpp"
#include "panel.hpp"
#include "surroundings.hpp"

namespace nodes {

using canopen::cia402::AxisData;
using canopen::cia402::SimulatedAxis;

[[nodiscard]] constexpr std::string_view to_text(canopen::cia402::State state) {
  using canopen::cia402::State;
  switch (state) {
    case State::not_ready_to_switch_on: return "not ready to switch on";
    case State::switch_on_disabled: return "switch on disabled";
    case State::ready_to_switch_on: return "ready to switch on";
    case State::switched_on: return "switched on";
    case State::operation_enabled: return "operation enabled";
    case State::quick_stop_active: return "quick stop active";
    case State::fault_reaction_active: return "fault reaction active";
    case State::fault: return "fault";
  }
  return "unknown";
}

/// The axis of a device: a class with the functions of SimulatedAxis. A drive with its own axis specializes it.
template <class Device>
struct AxisOf {
  using type = SimulatedAxis;
};

/// The common part of the drives. `Self` derives from it and may have:
///     void operate(std::int8_t mode)               see canopen::cia402::NoApplication
///     std::uint16_t statusword(std::uint16_t)      the same
///     void watch()                                 called after each change and each step
///     void abort_connection(std::int16_t code)     the same
///     void restarted()                             power-on, or an NMT reset
///     void on_state(canopen::NmtState state)       an NMT state is entered
///     bool take_line(const InputLine& line)        its own inputs, or with the time as second argument
///     std::uint8_t error_register_bits             the bits of 1001h that the device has; default: all
/// `node_id` is the node-ID at power-on; the handlers are passed to the node. The surroundings must outlive it.
template <class Self, class Device, canopen::Bus B, canopen::cia402::Options options, class... Handlers>
class DriveNode {
 public:
  DriveNode(B& bus, Surroundings& around, canopen::NodeId node_id, const AxisData& axis, Handlers... handlers)
      : around_{around},
        panel_{around},
        axis_{axis},
        node_{bus,
              node_id,
              canopen::on_state(StateTeller{this}),
              canopen::on_life_guarding(GuardTeller{this}),
              canopen::on_heartbeat(HeartbeatTeller{this}),
              drive_.error_handler(),
              std::move(handlers)...} {}
  DriveNode(const DriveNode&) = delete;
  DriveNode& operator=(const DriveNode&) = delete;

  void start(canopen::TimePoint now) {
    node_.start(now);
    on_time(now);
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    node_.on_frame(frame, now);
    on_time(now);
  }
  void on_time(canopen::TimePoint now) {
    drive_.on_time(node_, now, self());
    if constexpr (requires { self().watch(); }) {
      self().watch();
      drive_.on_time(node_, now, self());
    }
    if (drive_.state() != state_shown_) {
      state_shown_ = drive_.state();
      around_.log("drive " + std::string{to_text(state_shown_)});
    }
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const {
    const std::optional<canopen::TimePoint> a = node_.next_deadline();
    const std::optional<canopen::TimePoint> b = drive_.next_deadline();
    return a && b ? std::min(*a, *b) : a ? a : b;
  }

  void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) {
    panel_.on_bus_status(status);
    node_.on_bus_status(status, now);
    on_time(now);
  }

  /// Accepts the lines of `common_inputs`, and those of `Self`.
  bool input(const InputLine& line, canopen::TimePoint now) {
    bool taken = take(line);
    if constexpr (requires { self().take_line(line); }) taken = taken || self().take_line(line);
    if constexpr (requires { self().take_line(line, now); }) taken = taken || self().take_line(line, now);
    on_time(now);
    return taken;
  }

  using MotorAxis = typename AxisOf<Device>::type;

  [[nodiscard]] MotorAxis& axis() { return axis_; }
  [[nodiscard]] const MotorAxis& axis() const { return axis_; }
  [[nodiscard]] const Panel& panel() const { return panel_; }
  [[nodiscard]] const auto& drive() const { return drive_; }
  [[nodiscard]] auto& node() { return node_; }

 private:
  struct StateTeller {
    DriveNode* drive;
    void operator()(auto& node, canopen::NmtState state) const {
      drive->panel_.on_state(state, node.node_id());
      if (state == canopen::NmtState::initialisation) drive->restart();
      if constexpr (requires { drive->self().on_state(state); }) drive->self().on_state(state);
    }
  };
  struct GuardTeller {
    DriveNode* drive;
    void operator()(bool lost) const { drive->panel_.on_life_guarding(lost); }
  };
  struct HeartbeatTeller {
    DriveNode* drive;
    void operator()(canopen::HeartbeatEvent event, canopen::NodeId, canopen::NmtState) const {
      const bool lost = event == canopen::HeartbeatEvent::lost;
      if (!lost && event != canopen::HeartbeatEvent::back) return;
      drive->panel_.on_heartbeat(lost);
    }
  };

 protected:
  static constexpr auto common_inputs =
      "  fault CODE [BITS]                an error of the drive: 603Fh, EMCY; BITS of 1001h\n"
      "  limit negative|positive on|off   a limit switch\n"
      "  home on|off                      the home switch\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand, without power\n";

  [[nodiscard]] Self& self() { return static_cast<Self&>(*this); }

  /// Reports an error of the drive as the profile requires.
  void fault(std::uint16_t code, canopen::ErrorRegister bits, const canopen::EmergencyInfo& info = {}) {
    drive_.fault(node_, code, bits, info);
  }

  Surroundings& around_;
  Panel panel_;
  MotorAxis axis_;
  using DeviceControl = canopen::cia402::Drive<Device, MotorAxis, options>;
  DeviceControl drive_{axis_};
  canopen::Node<Device, B, canopen::StateHandler<StateTeller>, canopen::LifeGuardingHandler<GuardTeller>,
                canopen::HeartbeatHandler<HeartbeatTeller>, canopen::ErrorHandler<typename DeviceControl::ErrorTaker>,
                Handlers...>
      node_;

 private:
  void restart() {
    drive_.start();
    if constexpr (requires { self().restarted(); }) self().restarted();
  }

  [[nodiscard]] bool take(const InputLine& line) {
    namespace bit = canopen::cia402::input;
    if (line.is("fault", 1) || line.is("fault", 2)) {
      const auto code = line.number<std::uint16_t>(1);
      const auto bits = line.is("fault", 2) ? line.number<std::uint8_t>(2) : std::optional<std::uint8_t>{0x01};
      std::uint8_t known = 0xFF;
      if constexpr (requires { Self::error_register_bits; }) known = Self::error_register_bits;
      if (code && bits) fault(*code, static_cast<canopen::ErrorRegister>(*bits & known));
      return code && bits;
    }
    if (line.is("limit", 2) && (line.word(1) == "negative" || line.word(1) == "positive")) {
      const auto on = line.on_or_off(2);
      if (on) axis_.hold(line.word(1) == "negative" ? bit::negative_limit : bit::positive_limit, *on);
      return on.has_value();
    }
    if (line.is("home", 1)) {
      const auto on = line.on_or_off(1);
      if (on) axis_.hold(bit::home_switch, *on);
      return on.has_value();
    }
    if (line.is("block", 1)) {
      const auto on = line.on_or_off(1);
      if (on) axis_.block(*on);
      return on.has_value();
    }
    if (line.is("position", 1)) {
      const auto position = line.number<std::int32_t>(1);
      return position && axis_.turn_to(*position);
    }
    return false;
  }

  canopen::cia402::State state_shown_ = canopen::cia402::State::not_ready_to_switch_on;
};

}  // namespace nodes

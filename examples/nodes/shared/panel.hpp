/// NMT state, RUN and ERR indicators (CiA 303-3) of a node as lines of its log, one line for each change.
#pragma once

#include <canopen/can/bus_status.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/indicator/indicator.hpp>
#include <canopen/nmt/heartbeat_consumer.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "surroundings.hpp"

namespace nodes {

[[nodiscard]] constexpr std::string_view to_text(canopen::IndicatorPattern pattern) {
  switch (pattern) {
    case canopen::IndicatorPattern::off: return "off";
    case canopen::IndicatorPattern::flickering: return "flickering";
    case canopen::IndicatorPattern::blinking: return "blinking";
    case canopen::IndicatorPattern::single_flash: return "single flash";
    case canopen::IndicatorPattern::double_flash: return "double flash";
    case canopen::IndicatorPattern::triple_flash: return "triple flash";
    case canopen::IndicatorPattern::quadruple_flash: return "quadruple flash";
    case canopen::IndicatorPattern::on: return "on";
  }
  return "unknown";
}

/// Shows what the node reports. The surroundings must outlive it.
class Panel {
 public:
  explicit Panel(Surroundings& around) : around_{around} {}

  void on_state(canopen::NmtState state, canopen::NodeId node_id) {
    if (state == canopen::NmtState::initialisation) errors_ = kept_over_reset(errors_);
    state_ = state;
    around_.log("state " + std::string{to_text(state)} + ", node-ID " +
                (node_id.valid() ? std::to_string(node_id.value()) : std::string{"none"}));
    show();
  }
  void on_life_guarding(bool lost) { set(canopen::IndicatorError::error_control, lost); }
  void on_heartbeat(bool any_lost) { set(canopen::IndicatorError::error_control, any_lost); }
  void on_bus_status(const canopen::BusStatus& status) {
    set(canopen::IndicatorError::warning_limit, status.state == canopen::BusState::passive);
    set(canopen::IndicatorError::bus_off, status.state == canopen::BusState::off);
  }
  /// Sets or ends an error that ERR shows.
  void set(canopen::IndicatorError error, bool there) {
    const auto bit = static_cast<std::uint8_t>(error);
    errors_ = static_cast<std::uint8_t>(there ? errors_ | bit : errors_ & ~bit);
    show();
  }
  /// Sets the activity that RUN shows, such as LSS.
  void set_activity(canopen::IndicatorActivity activity) {
    activity_ = activity;
    show();
  }

  [[nodiscard]] canopen::IndicatorPattern run() const { return canopen::run_pattern(state_, activity_); }
  [[nodiscard]] canopen::IndicatorPattern error() const {
    return canopen::error_pattern(static_cast<canopen::IndicatorError>(errors_));
  }

 private:
  /// Errors of the CAN controller remain after a reset.
  [[nodiscard]] static std::uint8_t kept_over_reset(std::uint8_t errors) {
    using canopen::IndicatorError;
    return static_cast<std::uint8_t>(
        errors & static_cast<std::uint8_t>(IndicatorError::warning_limit | IndicatorError::bus_off));
  }

  void show() {
    tell("RUN ", run(), run_shown_);
    tell("ERR ", error(), error_shown_);
  }
  void tell(const char* lamp, canopen::IndicatorPattern pattern, canopen::IndicatorPattern& shown) {
    if (pattern == shown) return;
    shown = pattern;
    around_.log(lamp + std::string{to_text(pattern)});
  }

  Surroundings& around_;
  canopen::NmtState state_ = canopen::NmtState::initialisation;
  canopen::IndicatorActivity activity_ = canopen::IndicatorActivity::none;
  std::uint8_t errors_ = 0;
  canopen::IndicatorPattern run_shown_ = canopen::IndicatorPattern::off;
  canopen::IndicatorPattern error_shown_ = canopen::IndicatorPattern::off;
};

}  // namespace nodes

/// A tank that measures its level, reports an overflow by EMCY, and shows its state by two LEDs.
#pragma once

#include <canopen/indicator/indicator.hpp>
#include <canopen/node.hpp>
#include <cstdint>
#include <tank/device.hpp>

#include "board.hpp"

namespace od = tank::od;

struct Tank {
  void start() { board.start_measuring(); }

  /// TPDO 1 is sent when the level has changed.
  void every(canopen::Milliseconds<100>, auto& node) {
    const od::level::type level = board.level();
    if (level != measured) node.set(od::level{}, level);
    measured = level;
    const bool is_above = level > node.get(od::maximum_level{});
    if (is_above && !was_above) {
      const auto low = static_cast<std::uint8_t>(level.raw() & 0xFF);
      const auto high = static_cast<std::uint8_t>(level.raw() >> 8);
      node.emergency(0xFF01, canopen::ErrorRegister::manufacturer, {low, high});
    }
    if (!is_above && was_above) node.emergency_over(canopen::ErrorRegister::manufacturer);
    was_above = is_above;
  }

  od::level::type measured{};
  bool was_above = false;
};

/// The RUN and ERR indicators of CiA 303-3.
class Panel {
 public:
  void on_state(canopen::NmtState state) { run_ = canopen::run_pattern(state, canopen::IndicatorActivity::none); }
  void on_heartbeat(canopen::HeartbeatEvent event, canopen::NodeId, canopen::NmtState) {
    using canopen::HeartbeatEvent;
    if (event == HeartbeatEvent::lost) master_ = canopen::IndicatorError::error_control;
    if (event == HeartbeatEvent::back) master_ = canopen::IndicatorError::none;
  }
  /// The loop calls it with the status that it passes to the node.
  void show(const canopen::BusStatus& status) {
    bus_ = status.state == canopen::BusState::off       ? canopen::IndicatorError::bus_off
           : status.state == canopen::BusState::passive ? canopen::IndicatorError::warning_limit
                                                        : canopen::IndicatorError::none;
  }
  /// The shortest pattern, flickering, changes each 50 ms.
  void every(canopen::Milliseconds<50>, auto& node) {
    leds_.show(run_, canopen::error_pattern(master_ | bus_));
    leds_.on_time(node.now());
    board.set_leds(leds_.run(node.now()), leds_.error(node.now()));
  }

 private:
  canopen::Indicators<> leds_;
  canopen::IndicatorPattern run_ = canopen::IndicatorPattern::off;
  canopen::IndicatorError master_ = canopen::IndicatorError::none;
  canopen::IndicatorError bus_ = canopen::IndicatorError::none;
};

/// The composition of the device, for its program and its conformance test.
using TankParts = canopen::Composition<tank::Device, Tank, Panel>;

/// An I/O module of CiA 401 on a host: its outputs are lines of the log, its inputs are input lines. Its EDS determines
/// its types of channels.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/node.hpp>
#include <canopen/profile/cia401.hpp>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "input_line.hpp"
#include "panel.hpp"
#include "surroundings.hpp"

namespace nodes {

/// Analogue channels of -10 V to +10 V: raw = (U + 10) / 20 * 65535 - 32768.
inline constexpr double lowest_volts = -10;
inline constexpr double highest_volts = 10;

[[nodiscard]] constexpr std::int16_t raw_from_volts(double volts) {
  const double within = std::clamp(volts, lowest_volts, highest_volts);
  return static_cast<std::int16_t>((within - lowest_volts) / (highest_volts - lowest_volts) * 65535 - 32768);
}
[[nodiscard]] constexpr double volts_from_raw(std::int16_t raw) {
  return (raw + 32768.0) / 65535 * (highest_volts - lowest_volts) + lowest_volts;
}

/// An error that the firmware of a module detects, with its EMCY.
struct ModuleFault {
  std::string_view name;
  std::uint16_t code;
  canopen::ErrorRegister bits;
  canopen::EmergencyInfo info;
};

inline constexpr ModuleFault module_faults[] = {
    {"can-controller", 0x1000, canopen::ErrorRegister::manufacturer, {0x01}},
    {"eeprom", 0x5000, canopen::ErrorRegister::manufacturer, {0x02}},
    {"rx-buffer", 0x8110, canopen::ErrorRegister::communication, {0x04}},
    {"tx-buffer", 0x8110, canopen::ErrorRegister::communication, {0x05}},
};

/// The surroundings must outlive it.
template <class Device, canopen::Bus B>
class IoModule {
 public:
  IoModule(B& bus, Surroundings& around, canopen::NodeId node_id)
      : around_{around},
        panel_{around},
        node_{bus, around.node_id.value_or(node_id), canopen::stored_in(around.parameters),
              canopen::on_state(StateTeller{this}), canopen::on_life_guarding(GuardTeller{this})} {}

  void start(canopen::TimePoint now) {
    node_.start(now);
    update();
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    node_.on_frame(frame, now);
    update();
  }
  void on_time(canopen::TimePoint now) {
    node_.on_time(now);
    update();
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const { return node_.next_deadline(); }

  void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) {
    panel_.on_bus_status(status);
    node_.on_bus_status(status, now);
    if (canopen::outputs_fail(status)) fail();
    update();
  }

  /// `digital BLOCK LEVELS`, `analogue CHANNEL VOLTS`, `switches TENS UNITS`, `fault NAME`, `fault over`.
  bool input(const InputLine& line, canopen::TimePoint now) {
    const bool taken = take(line);
    on_time(now);
    return taken;
  }

  /// Sets the levels at the input terminals of a block; blocks and channels count from 0.
  void set_digital(std::uint8_t block, std::uint8_t levels) {
    if (block < digital_levels_.size()) digital_levels_[block] = levels;
    update();
  }
  /// Sets the value that an input channel measures.
  void set_analogue(std::uint8_t channel, std::int16_t raw) {
    if (channel < analogue_values_.size()) analogue_values_[channel] = raw;
    update();
  }

  /// Called when an output changes, for the input that it is wired to.
  std::function<void(std::uint8_t block, std::uint8_t levels)> on_digital;
  std::function<void(std::uint8_t channel, std::int16_t raw)> on_analogue;

  [[nodiscard]] const Panel& panel() const { return panel_; }
  [[nodiscard]] auto& node() { return node_; }

 private:
  struct StateTeller {
    IoModule* module;
    void operator()(auto& node, canopen::NmtState state) const {
      module->panel_.on_state(state, node.node_id());
      if (canopen::outputs_fail(state)) module->fail();
    }
  };
  struct GuardTeller {
    IoModule* module;
    void operator()(bool lost) const {
      module->panel_.on_life_guarding(lost);
      if (lost) module->fail();
    }
  };
  using Node = canopen::Node<Device, B, canopen::StoredIn<NodeStorage>, canopen::StateHandler<StateTeller>,
                             canopen::LifeGuardingHandler<GuardTeller>>;

  void fail() {
    around_.log("outputs take their error values");
    digital_outputs_.fail(node_);
    analogue_outputs_.fail(node_);
  }

  /// Updates the objects from the inputs and the outputs from the objects.
  void update() {
    if (around_.parameters.take_failure()) static_cast<void>(take_fault("eeprom"));
    for (std::uint8_t block = 0; block < digital_levels_.size(); ++block) {
      digital_inputs_.sample(node_, block, digital_levels_[block]);
    }
    for (std::uint8_t channel = 0; channel < analogue_values_.size(); ++channel) {
      analogue_inputs_.sample(node_, channel, analogue_values_[channel]);
    }
    digital_outputs_.update(node_, [this](std::uint8_t block, std::uint8_t levels) {
      tell("digital %u 0x%02X", block + 1u, levels);
      if (on_digital) on_digital(block, levels);
    });
    analogue_outputs_.update(node_, [this](std::uint8_t channel, std::int16_t raw) {
      tell("analogue %u %.3f V", channel + 1u, volts_from_raw(raw));
      if (on_analogue) on_analogue(channel, raw);
    });
  }

  [[nodiscard]] bool take(const InputLine& line) {
    if (line.is("digital", 2)) {
      const auto block = line.number<std::uint8_t>(1, 1, digital_inputs_.blocks);
      const auto levels = line.number<std::uint8_t>(2);
      if (block && levels) set_digital(static_cast<std::uint8_t>(*block - 1), *levels);
      return block && levels;
    }
    if (line.is("analogue", 2)) {
      const auto channel = line.number<std::uint8_t>(1, 1, analogue_inputs_.channels);
      const auto volts = line.real(2);
      if (channel && volts) set_analogue(static_cast<std::uint8_t>(*channel - 1), raw_from_volts(*volts));
      return channel && volts;
    }
    if (line.is("switches", 2)) {
      const auto tens = line.number<std::uint8_t>(1, 0, 9);
      const auto units = line.number<std::uint8_t>(2, 0, 9);
      return tens && units && turn_switches(static_cast<std::uint8_t>(10 * *tens + *units));
    }
    return line.is("fault", 1) && take_fault(line.word(1));
  }

  /// The module reads its rotary switches at power-on.
  [[nodiscard]] bool turn_switches(std::uint8_t node_id) {
    if (node_id == 0) return false;
    around_.node_id = canopen::NodeId{node_id};
    return true;
  }

  [[nodiscard]] bool take_fault(std::string_view name) {
    if (name == "over") {
      node_.emergency_over(canopen::ErrorRegister::manufacturer | canopen::ErrorRegister::communication);
      return true;
    }
    const auto* const fault = std::ranges::find(module_faults, name, &ModuleFault::name);
    if (fault == std::end(module_faults)) return false;
    node_.emergency(fault->code, fault->bits, fault->info);
    return true;
  }

  template <class... Arguments>
  void tell(const char* format, Arguments... arguments) {
    std::array<char, 64> line;
    std::snprintf(line.data(), line.size(), format, arguments...);
    around_.log(line.data());
  }

  Surroundings& around_;
  Panel panel_;
  [[no_unique_address]] canopen::DigitalInputs<Device> digital_inputs_;
  [[no_unique_address]] canopen::DigitalOutputs<Device> digital_outputs_;
  [[no_unique_address]] canopen::AnalogueInputs<Device> analogue_inputs_;
  [[no_unique_address]] canopen::AnalogueOutputs<Device> analogue_outputs_;
  std::array<std::uint8_t, canopen::DigitalInputs<Device>::blocks> digital_levels_{};
  std::array<std::int16_t, canopen::AnalogueInputs<Device>::channels> analogue_values_{};
  Node node_;
};

}  // namespace nodes

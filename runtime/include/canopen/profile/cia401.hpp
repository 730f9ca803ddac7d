/// Generic I/O modules (CiA 401): transfers values between the terminals of a module and the objects of its dictionary.
///
///     canopen::DigitalInputs<can_2053c::Device> inputs;
///     canopen::DigitalOutputs<can_2057c::Device> outputs;
///     ...
///     inputs.sample(node, 0, read_port());                                  // as often as the terminals are read
///     outputs.update(node, [](std::uint8_t block, std::uint8_t level) { write_port(block, level); });
///     outputs.fail(node);                                                   // communication is lost
///
/// Objects that are not in the EDS have no cost. Supported are blocks of eight digital channels and 16-bit analogue
/// channels. Not supported are channels grouped by 1, 16 or 32, counters, the interrupt source 6422h, and the offsets
/// and scales 6431h, 6432h, 6446h and 6447h.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "canopen/can/bus_status.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/profile/channels.hpp"

namespace canopen {

/// Whether outputs take their error values: the node is Stopped, by its master or by 1029h, or communication is lost. A
/// life guarding event is such a loss, too.
[[nodiscard]] constexpr bool outputs_fail(NmtState entered) { return entered == NmtState::stopped; }
[[nodiscard]] constexpr bool outputs_fail(HeartbeatEvent event) { return event == HeartbeatEvent::lost; }
[[nodiscard]] constexpr bool outputs_fail(const BusStatus& status) { return status.state == BusState::off; }

/// Digital inputs in blocks of eight, 6000h.
template <class Device>
class DigitalInputs {
  using Value = ChannelObject<Device, 0x6000>;
  using Polarity = ChannelObject<Device, 0x6002>;
  using Filter = ChannelObject<Device, 0x6003>;
  using AnyChange = ChannelObject<Device, 0x6006>;
  using LowToHigh = ChannelObject<Device, 0x6007>;
  using HighToLow = ChannelObject<Device, 0x6008>;

 public:
  static constexpr std::uint8_t blocks = Value::count;

  /// Sets the levels of a block's terminals, bit 0 the lowest channel; blocks count from 0. A channel with its bit set
  /// in 6003h changes when two consecutive calls report the same level. A change triggers TPDOs if 6005h and the masks
  /// 6006h to 6008h allow it, or if the device does not have them.
  template <class Node>
  void sample([[maybe_unused]] Node& node, [[maybe_unused]] std::uint8_t block, [[maybe_unused]] std::uint8_t levels) {
    if constexpr (blocks > 0) {
      if (block >= blocks) return;
      const EntryAccess<Device> entries = node.entries();
      const std::uint8_t before = Value::template get<std::uint8_t>(entries, block, 0);
      const auto after = static_cast<std::uint8_t>(settled(entries, block, levels) ^
                                                   Polarity::template get<std::uint8_t>(entries, block, 0));
      if (after != before) Value::set(node, block, after, !is_event(entries, block, before, after));
    }
  }

 private:
  struct NoFilter {};
  struct Levels {
    std::array<std::uint8_t, blocks> last{};  ///< levels at the last call
    std::array<std::uint8_t, blocks> held{};  ///< filtered levels
  };

  [[nodiscard]] std::uint8_t settled([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint8_t block,
                                     std::uint8_t levels) {
    if constexpr (Filter::exists) {
      const std::uint8_t filtered = Filter::template get<std::uint8_t>(entries, block, 0);
      const unsigned unsettled = filtered & (levels ^ filter_.last[block]);
      filter_.last[block] = levels;
      filter_.held[block] = static_cast<std::uint8_t>((levels & ~unsettled) | (filter_.held[block] & unsettled));
      return filter_.held[block];
    } else {
      return levels;
    }
  }

  [[nodiscard]] static bool is_event([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint8_t block,
                                     [[maybe_unused]] std::uint8_t before, [[maybe_unused]] std::uint8_t after) {
    if constexpr (Device::dictionary.has(0x6005, 0)) {
      if (!is_true(entries, Device::dictionary.find(0x6005, 0))) return false;
    }
    if constexpr (AnyChange::exists || LowToHigh::exists || HighToLow::exists) {
      const unsigned changed = before ^ after;
      const unsigned event = (changed & AnyChange::template get<unsigned>(entries, block, 0)) |
                             (changed & after & LowToHigh::template get<unsigned>(entries, block, 0)) |
                             (changed & before & HighToLow::template get<unsigned>(entries, block, 0));
      return event != 0;
    } else {
      return true;
    }
  }

  [[no_unique_address]] std::conditional_t<Filter::exists, Levels, NoFilter> filter_{};
};

/// Digital outputs in blocks of eight, 6200h.
template <class Device>
class DigitalOutputs {
  using Value = ChannelObject<Device, 0x6200>;
  using Polarity = ChannelObject<Device, 0x6202>;
  using ErrorMode = ChannelObject<Device, 0x6206>;
  using ErrorValue = ChannelObject<Device, 0x6207>;
  using Filter = ChannelObject<Device, 0x6208>;

 public:
  static constexpr std::uint8_t blocks = Value::count;

  /// Transfers 6200h to the terminals, which are initially low: calls `drive(block, levels)` for each block
  /// whose levels change. Channels whose bit in 6208h is 0 do not change. Call it after the node has processed a
  /// frame or time.
  template <class Node, class Drive>
  void update([[maybe_unused]] Node& node, [[maybe_unused]] Drive&& drive) {
    const EntryAccess<Device> entries = node.entries();
    for (std::uint8_t block = 0; block < blocks; ++block) {
      const unsigned value =
          Value::template get<unsigned>(entries, block, 0) ^ Polarity::template get<unsigned>(entries, block, 0);
      const unsigned followed = Filter::template get<unsigned>(entries, block, 0xFF);
      const auto levels = static_cast<std::uint8_t>((value & followed) | (levels_[block] & ~followed));
      if (levels == levels_[block]) continue;
      levels_[block] = levels;
      drive(block, levels);
    }
  }

  /// Sets channels whose bit in 6206h is 1 to their value in 6207h, which they keep until another one is written. A
  /// device with neither object keeps its outputs.
  template <class Node>
  void fail([[maybe_unused]] Node& node) {
    if constexpr (Value::exists && (ErrorMode::exists || ErrorValue::exists)) {
      for (std::uint8_t block = 0; block < blocks; ++block) {
        const EntryAccess<Device> entries = node.entries();
        const unsigned mode = ErrorMode::template get<unsigned>(entries, block, 0xFF);
        const unsigned before = Value::template get<unsigned>(entries, block, 0);
        const auto after = static_cast<std::uint8_t>((before & ~mode) |
                                                     (ErrorValue::template get<unsigned>(entries, block, 0) & mode));
        if (after != before) Value::set(node, block, after);
      }
    }
  }

 private:
  std::array<std::uint8_t, blocks> levels_{};
};

/// Analogue inputs of 16 bits, 6401h.
template <class Device>
class AnalogueInputs {
  using Value = ChannelObject<Device, 0x6401>;
  using Trigger = ChannelObject<Device, 0x6421>;
  using UpperLimit = ChannelObject<Device, 0x6424>;
  using LowerLimit = ChannelObject<Device, 0x6425>;
  using Delta = ChannelObject<Device, 0x6426>;
  using NegativeDelta = ChannelObject<Device, 0x6427>;
  using PositiveDelta = ChannelObject<Device, 0x6428>;
  static constexpr bool has_delta = Delta::exists || NegativeDelta::exists || PositiveDelta::exists;

 public:
  static constexpr std::uint8_t channels = Value::count;

  /// Sets the measured value of a channel; channels count from 0. A change triggers TPDOs if 6423h allows it and 6421h
  /// selects it: at or above the limit 6424h, below 6425h, or by more than 6426h to 6428h from the value that triggered
  /// last. Limits and deltas have the scale of 6401h. If limits and deltas are both selected, both conditions must be
  /// met. A device without these objects sends every change.
  template <class Node>
  void sample([[maybe_unused]] Node& node, [[maybe_unused]] std::uint8_t channel, [[maybe_unused]] std::int16_t value) {
    if constexpr (channels > 0) {
      if (channel >= channels) return;
      const EntryAccess<Device> entries = node.entries();
      if (value == Value::template get<std::int16_t>(entries, channel, 0)) return;
      const bool event = is_event(entries, channel, value);
      if constexpr (has_delta) {
        if (event) reported_[channel] = value;
      }
      Value::set(node, channel, value, !event);
    }
  }

 private:
  // Bits of 6421h
  static constexpr unsigned above_upper_limit = 0x01;
  static constexpr unsigned below_lower_limit = 0x02;
  static constexpr unsigned changed = 0x04;
  static constexpr unsigned fallen = 0x08;
  static constexpr unsigned risen = 0x10;
  static constexpr unsigned by_limit = above_upper_limit | below_lower_limit;
  static constexpr unsigned by_delta = changed | fallen | risen;

  struct NoDelta {};

  [[nodiscard]] bool is_event([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint8_t channel,
                              [[maybe_unused]] std::int16_t value) const {
    if constexpr (Device::dictionary.has(0x6423, 0)) {
      if (!is_true(entries, Device::dictionary.find(0x6423, 0))) return false;
    }
    if constexpr (Trigger::exists) {
      const unsigned trigger = Trigger::template get<unsigned>(entries, channel, 0);
      if ((trigger & (by_limit | by_delta)) == 0) return false;
      return ((trigger & by_limit) == 0 || outside(entries, channel, trigger, value)) &&
             ((trigger & by_delta) == 0 || moved(entries, channel, trigger, value));
    } else {
      return true;
    }
  }

  [[nodiscard]] static bool outside(EntryAccess<Device> entries, std::uint8_t channel, unsigned trigger,
                                    std::int32_t value) {
    if ((trigger & above_upper_limit) != 0 && value >= UpperLimit::template get<std::int32_t>(entries, channel, 0))
      return true;
    return (trigger & below_lower_limit) != 0 && value < LowerLimit::template get<std::int32_t>(entries, channel, 0);
  }

  [[nodiscard]] bool moved([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint8_t channel,
                           [[maybe_unused]] unsigned trigger, [[maybe_unused]] std::int32_t value) const {
    if constexpr (has_delta) {
      const std::int32_t way = value - reported_[channel];
      const auto up = static_cast<std::uint32_t>(way > 0 ? way : 0);
      const auto down = static_cast<std::uint32_t>(way < 0 ? -way : 0);
      if ((trigger & changed) != 0 && up + down > Delta::template get<std::uint32_t>(entries, channel, 0)) return true;
      if ((trigger & fallen) != 0 && down > NegativeDelta::template get<std::uint32_t>(entries, channel, 0))
        return true;
      return (trigger & risen) != 0 && up > PositiveDelta::template get<std::uint32_t>(entries, channel, 0);
    } else {
      return true;
    }
  }

  [[no_unique_address]] std::conditional_t<has_delta, std::array<std::int16_t, channels>, NoDelta> reported_{};
};

/// Analogue outputs of 16 bits, 6411h.
template <class Device>
class AnalogueOutputs {
  using Value = ChannelObject<Device, 0x6411>;
  using ErrorMode = ChannelObject<Device, 0x6443>;
  using ErrorValue = ChannelObject<Device, 0x6444>;

 public:
  static constexpr std::uint8_t channels = Value::count;

  /// Transfers 6411h to the terminals, which are initially 0: calls `drive(channel, value)` for each channel that
  /// changes. Call it after the node has processed a frame or time.
  template <class Node, class Drive>
  void update([[maybe_unused]] Node& node, [[maybe_unused]] Drive&& drive) {
    const EntryAccess<Device> entries = node.entries();
    for (std::uint8_t channel = 0; channel < channels; ++channel) {
      const auto value = Value::template get<std::int16_t>(entries, channel, 0);
      if (value == values_[channel]) continue;
      values_[channel] = value;
      drive(channel, value);
    }
  }

  /// Sets channels whose 6443h is 1 to their value in 6444h, which they keep until another one is written. A device
  /// with neither object keeps its outputs.
  template <class Node>
  void fail([[maybe_unused]] Node& node) {
    if constexpr (Value::exists && (ErrorMode::exists || ErrorValue::exists)) {
      for (std::uint8_t channel = 0; channel < channels; ++channel) {
        const EntryAccess<Device> entries = node.entries();
        if (ErrorMode::template get<std::uint8_t>(entries, channel, 1) == 0) continue;
        const auto after = static_cast<std::int16_t>(ErrorValue::template get<std::int32_t>(entries, channel, 0));
        if (after != Value::template get<std::int16_t>(entries, channel, 0)) Value::set(node, channel, after);
      }
    }
  }

 private:
  std::array<std::int16_t, channels> values_{};
};

}  // namespace canopen

/// LSS slave: configuration of node-ID and bit rate over the bus (CiA 305).
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/lss/lss_options.hpp"
#include "canopen/lss/lss_protocol.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Functions of the node that a slave calls. They are passed by value, and have a reference to what they change:
///   std::uint32_t identity(sub_index);      1018h:01..04
///   LssError accept(node_id);               1..127 or 255, not active yet; may reject it
///   LssError accept(bit_timing);            one that the options allow, not active yet; may reject it
///   LssError store(node_id, bit_timing);    stores both in non-volatile memory
///   void reset_communication();             a device without node-ID has received one
///   void stop_communication();              leaves the bus
///   void start_communication(bit_timing);   returns to the bus
template <class Type>
concept LssSlaveHooks = requires(Type hooks, std::uint8_t sub_index, NodeId node_id, LssBitTiming bit_timing) {
  { hooks.identity(sub_index) } -> std::same_as<std::uint32_t>;
  { hooks.accept(node_id) } -> std::same_as<LssError>;
  { hooks.accept(bit_timing) } -> std::same_as<LssError>;
  { hooks.store(node_id, bit_timing) } -> std::same_as<LssError>;
  hooks.reset_communication();
  hooks.stop_communication();
  hooks.start_communication(bit_timing);
};

/// One slave. It has the three node-IDs of a device: the persistent one, the pending one, which LSS configures, and the
/// active one, which the device uses.
///
/// It holds at most one response until the bus has room; a later one replaces it.
///
/// `AtRunTime`: the options are set before power-on; those of the type are what the code can do.
template <LssOptions options = LssOptions{}, bool AtRunTime = false>
class LssSlave {
 public:
  /// Sets the options of a slave that has them at run time.
  void set_options(const LssOptions& at_run_time) requires AtRunTime { set_.value = at_run_time; }

  /// Power-on, with the stored values. The pending node-ID is the persistent one.
  void start(NodeId persistent, LssBitTiming bit_timing) {
    persistent_ = persistent;
    if constexpr (has_bit_timing) timing_.pending = bit_timing;
    reset_application();
  }

  /// NMT reset application: values that have not been stored are lost.
  void reset_application() { pending_ = persistent_; }

  /// NMT reset communication: the pending node-ID becomes active. Without node-ID (255), a device stays in
  /// Initialisation.
  NodeId reset_communication() {
    active_ = pending_;
    fastscan_position_ = 0;
    reply_ = lss::Command::none;
    wait();
    return active_;
  }

  /// Handles a new NMT state of the node. LSS is available in Pre-operational and Stopped, unless the options say
  /// otherwise, and in Initialisation without node-ID. In other states the slave is waiting.
  void enter(NmtState state) {
    served_ = serves(state);
    if (!served_) wait();
  }

  /// Processes a frame from the bus. One that is not a request of eight bytes is ignored.
  void on_frame(const Frame& frame, LssSlaveHooks auto hooks, TimePoint now) {
    if (!lss::is_lss(frame, lss::request_id) || !served_ || silent()) return;
    handle(frame, hooks, now);
  }

  /// Switches the bit rate when the delay has elapsed.
  void on_time([[maybe_unused]] LssSlaveHooks auto hooks, [[maybe_unused]] TimePoint now) {
    if constexpr (has_bit_timing) {
      if (timing_.phase == Phase::before_switch && now >= timing_.due) {
        timing_.phase = Phase::silent;
        timing_.due = timing_.due + from_milliseconds(timing_.switch_delay);
        hooks.stop_communication();
      }
      if (timing_.phase == Phase::silent && now >= timing_.due) {
        timing_.phase = Phase::none;
        hooks.start_communication(timing_.next);
      }
    }
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if constexpr (has_bit_timing) {
      if (timing_.phase != Phase::none) return timing_.due;
    }
    return std::nullopt;
  }

  /// Whether the node may not send anything because the bit rate is being switched.
  [[nodiscard]] bool silent() const {
    if constexpr (has_bit_timing) {
      return timing_.phase == Phase::silent;
    } else {
      return false;
    }
  }

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_reply() const { return reply_ != lss::Command::none; }

  /// Sends the response, if any. Returns false if the bus had no room or the node is silent; the response is kept.
  template <Bus BusType>
  bool serve(BusType& bus) {
    if (!has_reply()) return true;
    if (silent()) return false;
    if (!bus.send(lss::make_frame(lss::response_id, reply_, reply_word_))) return false;
    reply_ = lss::Command::none;
    return true;
  }

  [[nodiscard]] LssState state() const { return state_; }
  [[nodiscard]] NodeId node_id() const { return active_; }
  [[nodiscard]] NodeId pending_node_id() const { return pending_; }
  [[nodiscard]] NodeId persistent_node_id() const { return persistent_; }

 private:
  static constexpr bool has_bit_timing = options.bit_rates != 0 || options.manufacturer_bit_timing;

  /// Switching of the bit rate: starts after one delay, and takes another one.
  enum class Phase : std::uint8_t { none, before_switch, silent };

  struct Timing {
    TimePoint due{};
    std::uint16_t switch_delay = 0;  ///< ms
    LssBitTiming pending{};
    LssBitTiming next{};
    Phase phase = Phase::none;
  };
  struct NoTiming {};

  struct OfType {};
  struct SetOptions {
    LssOptions value{};
  };
  [[nodiscard]] constexpr const LssOptions& chosen() const {
    if constexpr (AtRunTime) {
      return set_.value;
    } else {
      return options;
    }
  }

  [[nodiscard]] bool serves(NmtState state) const {
    switch (state) {
      case NmtState::initialisation: return active_ == unconfigured_node_id;
      case NmtState::pre_operational: return true;
      case NmtState::stopped: return chosen().served_in_stopped;
      case NmtState::operational: return chosen().served_in_operational;
    }
    return false;
  }

  void wait() {
    state_ = LssState::waiting;
    expected_ = 0;
  }

  /// Whether a service is available only in the configuration state.
  [[nodiscard]] static constexpr bool configures(lss::Command command) {
    return (command >= lss::Command::configure_node_id && command <= lss::Command::store_configuration) ||
           command >= lss::Command::inquire_vendor_id;
  }

  void handle(const Frame& frame, auto hooks, [[maybe_unused]] TimePoint now) {
    const auto command = static_cast<lss::Command>(frame.data[0]);
    const std::uint32_t word = lss::word_of(frame);
    const std::uint8_t expected = expected_;
    expected_ = 0;
    if (configures(command) && state_ != LssState::configuration) return;
    switch (command) {
      case lss::Command::switch_state_global: return switch_state(frame.data[1], hooks);
      case lss::Command::select_vendor_id:
      case lss::Command::select_product_code:
      case lss::Command::select_revision_number:
      case lss::Command::select_serial_number:
      case lss::Command::identify_vendor_id:
      case lss::Command::identify_product_code:
      case lss::Command::identify_revision_number_low:
      case lss::Command::identify_revision_number_high:
      case lss::Command::identify_serial_number_low:
      case lss::Command::identify_serial_number_high: return compare(frame.data[0], expected, word, hooks);
      case lss::Command::identify_non_configured:
        if (unconfigured()) answer(lss::Command::identified_non_configured);
        return;
      case lss::Command::fastscan:
        if constexpr (options.fastscan) {
          if (chosen().fastscan) fastscan(frame, word, hooks);
        }
        return;
      case lss::Command::configure_node_id: return answer(command, configure_node_id(NodeId{frame.data[1]}, hooks));
      case lss::Command::configure_bit_timing:
        return answer(command, configure_bit_timing({frame.data[1], frame.data[2]}, hooks));
      case lss::Command::activate_bit_timing: return activate_bit_timing(static_cast<std::uint16_t>(word), now);
      case lss::Command::store_configuration: return answer(command, store(hooks));
      case lss::Command::inquire_vendor_id:
      case lss::Command::inquire_product_code:
      case lss::Command::inquire_revision_number:
      case lss::Command::inquire_serial_number:
        return answer(command, hooks.identity(static_cast<std::uint8_t>(frame.data[0] - 0x59)));
      case lss::Command::inquire_node_id: return answer(command, active_.value());
      case lss::Command::none:
      case lss::Command::selected:
      case lss::Command::identified:
      case lss::Command::identified_non_configured: return;
    }
  }

  /// Switches the state. A device without node-ID that has received one leaves Initialisation when it returns
  /// to waiting.
  void switch_state(std::uint8_t mode, auto hooks) {
    if (mode == static_cast<std::uint8_t>(LssState::configuration)) {
      state_ = LssState::configuration;
    } else if (mode == static_cast<std::uint8_t>(LssState::waiting)) {
      state_ = LssState::waiting;
      if (active_ == unconfigured_node_id && pending_ != unconfigured_node_id) hooks.reset_communication();
    }
  }

  /// Compares one frame of switch state selective or identify remote slave. All frames must match, in their order.
  void compare(std::uint8_t command, std::uint8_t expected, std::uint32_t word, auto hooks) {
    constexpr auto select = static_cast<std::uint8_t>(lss::Command::select_vendor_id);
    constexpr auto identify = static_cast<std::uint8_t>(lss::Command::identify_vendor_id);
    const bool selecting = command < identify;
    if (selecting && state_ != LssState::waiting) return;
    if (command != select && command != identify && command != expected) return;
    if (!matches(command, word, hooks)) return;
    if (command == static_cast<std::uint8_t>(lss::Command::select_serial_number)) {
      state_ = LssState::configuration;
      answer(lss::Command::selected);
    } else if (command == static_cast<std::uint8_t>(lss::Command::identify_serial_number_high)) {
      answer(lss::Command::identified);
    } else {
      expected_ = static_cast<std::uint8_t>(command + 1);
    }
  }

  /// What a frame of switch state selective or identify remote slave requires of a number of 1018h. A range compares
  /// the major part of the revision number, the upper 16 bits.
  struct Condition {
    std::uint8_t sub_index : 4;
    std::uint8_t at_least : 1;
    std::uint8_t at_most : 1;
    std::uint8_t major : 1;
  };

  /// From command 40h on; 44h and 45h are not conditions.
  static constexpr Condition conditions[] = {
      {1, 1, 1, 0}, {2, 1, 1, 0}, {3, 1, 1, 0}, {4, 1, 1, 0}, {},           {},
      {1, 1, 1, 0}, {2, 1, 1, 0}, {3, 1, 0, 1}, {3, 0, 1, 1}, {4, 1, 0, 0}, {4, 0, 1, 0},
  };

  [[nodiscard]] static bool matches(std::uint8_t command, std::uint32_t word, auto hooks) {
    const Condition condition = conditions[command - static_cast<std::uint8_t>(lss::Command::select_vendor_id)];
    std::uint32_t own = hooks.identity(condition.sub_index);
    if (condition.major != 0) {
      own >>= 16;
      word >>= 16;
    }
    return (own >= word || condition.at_least == 0) && (own <= word || condition.at_most == 0);
  }

  /// Whether the device waits in Initialisation for its node-ID.
  [[nodiscard]] bool unconfigured() const {
    return active_ == unconfigured_node_id && pending_ == unconfigured_node_id;
  }

  /// Compares bits BitCheck..31 of one number of 1018h. After the last bit, a slave proceeds to the number LSSNext or,
  /// if that is an earlier one, to the configuration state.
  void fastscan(const Frame& frame, std::uint32_t id_number, auto hooks) {
    const std::uint8_t bit_check = frame.data[5];
    const std::uint8_t lss_sub = frame.data[6];
    const std::uint8_t lss_next = frame.data[7];
    if (!unconfigured() || state_ != LssState::waiting) return;
    if (bit_check == lss::fastscan_reset) {
      fastscan_position_ = 0;
    } else {
      if (bit_check > 31 || lss_sub != fastscan_position_ || lss_next > 3) return;
      const std::uint32_t difference = id_number ^ hooks.identity(static_cast<std::uint8_t>(lss_sub + 1));
      if (difference >> bit_check != 0) return;
      fastscan_position_ = lss_next;
      if (bit_check == 0 && lss_next < lss_sub) state_ = LssState::configuration;
    }
    answer(lss::Command::identified);
  }

  [[nodiscard]] LssError configure_node_id(NodeId node_id, auto hooks) {
    const bool takes_away = chosen().unconfigurable && node_id == unconfigured_node_id;
    if (!node_id.valid() && !takes_away) return lss::node_id_out_of_range;
    const LssError error = hooks.accept(node_id);
    if (error.code == 0) pending_ = node_id;
    return error;
  }

  [[nodiscard]] bool supports(LssBitTiming bit_timing) const {
    if (bit_timing.table >= 128) return chosen().manufacturer_bit_timing;
    return bit_timing.table == 0 && bit_timing.index < 16 && (chosen().bit_rates >> bit_timing.index & 1) != 0;
  }

  [[nodiscard]] LssError configure_bit_timing(LssBitTiming bit_timing, auto hooks) {
    if constexpr (has_bit_timing) {
      if (supports(bit_timing)) {
        const LssError error = hooks.accept(bit_timing);
        if (error.code == 0) timing_.pending = bit_timing;
        return error;
      }
    }
    return lss::bit_timing_not_supported;
  }

  void activate_bit_timing([[maybe_unused]] std::uint16_t switch_delay, [[maybe_unused]] TimePoint now) {
    if constexpr (has_bit_timing) {
      timing_.switch_delay = switch_delay;
      timing_.due = now + from_milliseconds(switch_delay);
      timing_.next = timing_.pending;
      timing_.phase = Phase::before_switch;
    }
  }

  [[nodiscard]] LssError store(auto hooks) {
    LssBitTiming bit_timing{};
    if constexpr (has_bit_timing) bit_timing = timing_.pending;
    const LssError error = hooks.store(pending_, bit_timing);
    if (error.code == 0) persistent_ = pending_;
    return error;
  }

  void answer(lss::Command command, std::uint32_t word = 0) {
    reply_ = command;
    reply_word_ = word;
  }
  void answer(lss::Command command, LssError error) {
    answer(command, error.code | static_cast<std::uint32_t>(error.specific) << 8);
  }

  std::uint32_t reply_word_ = 0;  ///< bytes 1..4 of the response
  [[no_unique_address]] std::conditional_t<has_bit_timing, Timing, NoTiming> timing_{};
  lss::Command reply_ = lss::Command::none;
  std::uint8_t expected_ = 0;  ///< next command of switch state selective or identify remote slave
  std::uint8_t fastscan_position_ = 0;
  LssState state_ = LssState::waiting;
  NodeId persistent_{};
  NodeId pending_{};
  NodeId active_{};
  bool served_ = false;
  [[no_unique_address]] std::conditional_t<AtRunTime, SetOptions, OfType> set_{};
};

}  // namespace canopen

/// The master's side of a drive: the controlwords that bring it to a state, and the handshake of set-points
/// (CiA 402-2, 7.2 and 8.4; profile position: clause 10).
///
///     canopen::cia402::DriveCommander axis;
///     axis.enable();
///     plant.on(signals::axis1::statusword{}, [&](std::uint16_t word) { plant.axis1.controlword(axis.next(word)); });
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "canopen/od/typed_value.hpp"
#include "canopen/profile/cia402_state_machine.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

/// Returns the state that a statusword reports; empty for a combination of bits that the standard does not define.
[[nodiscard]] constexpr std::optional<State> state_of(std::uint16_t statusword) {
  constexpr std::uint16_t without_quick_stop = 0x004F;
  constexpr std::uint16_t with_quick_stop = 0x006F;
  for (std::size_t i = 0; i < state_bits.size(); ++i) {
    const auto state = static_cast<State>(i);
    const std::uint16_t mask = quick_stop_bit_is_open(state) ? without_quick_stop : with_quick_stop;
    if ((statusword & mask) == (bits_of(state) & mask)) return state;
  }
  return std::nullopt;
}
/// The same of the word of a device.
template <FieldWord Statusword>
[[nodiscard]] constexpr std::optional<State> state_of(const Statusword& statusword) {
  return state_of(statusword.raw());
}

/// Where a master wants a drive to be.
enum class DriveTarget : std::uint8_t {
  voltage_off,    ///< Switch On Disabled: no torque, the axis coasts
  ready,          ///< Ready To Switch On
  switched_on,    ///< Switched On: power without torque
  enabled,        ///< Operation Enabled
  quick_stopped,  ///< Quick Stop Active, or Switch On Disabled, depending on 605Ah
};

/// The command for each target in the states in which the standard defines commands, in the order of State.
inline constexpr std::array<std::array<std::uint16_t, 6>, 5> controlwords_to_target = {{
    // not ready, switch on disabled, ready, switched on, operation enabled, quick stop active
    {0x00, 0x00, 0x00, 0x00, 0x00, 0x00},  // voltage off
    {0x00, 0x06, 0x06, 0x06, 0x06, 0x00},  // ready
    {0x00, 0x06, 0x07, 0x07, 0x07, 0x00},  // switched on
    {0x00, 0x06, 0x07, 0x0F, 0x0F, 0x0F},  // enabled
    {0x00, 0x00, 0x02, 0x02, 0x02, 0x02},  // quick stopped
}};

/// Computes controlwords from statuswords. It has no bus: send the result of `next` by PDO or SDO. A fault ends the
/// wish for power, so that a drive is not enabled by itself after its fault is reset.
class DriveCommander {
 public:
  void enable() { target_ = DriveTarget::enabled; }
  void request(DriveTarget target) { target_ = target; }
  [[nodiscard]] DriveTarget target() const { return target_; }

  /// Sends one rising edge of bit 7 if the drive is in Fault. Then call `enable` again.
  void reset_fault() { reset_ = true; }

  /// Stops the axis in its mode while true (bit 8).
  void halt(bool on) { halted_ = on; }

  /// Other bits of the mode of operation while the drive is enabled, such as `controlword::start_homing`.
  void set_mode_bits(std::uint16_t bits) { mode_bits_ = bits; }

  /// Starts the set-point of profile position that has been sent or is sent with the next controlword: bit 4 is 1 until
  /// the drive acknowledges it. `how`: `controlword::change_immediately`, `controlword::relative`, or both.
  void start_set_point(std::uint16_t how = 0) {
    set_point_ = Handshake::requested;
    how_ = how & (controlword::change_immediately | controlword::relative);
  }
  /// Whether a set-point has been requested and the drive has not acknowledged it and withdrawn the acknowledgement.
  [[nodiscard]] bool set_point_is_pending() const { return set_point_ != Handshake::none; }

  /// Returns the state of the last statusword; empty before the first one.
  [[nodiscard]] std::optional<State> state() const { return state_; }
  [[nodiscard]] bool is_enabled() const { return state_ == State::operation_enabled; }

  /// Returns the controlword to send after this statusword. Call it with each statusword; a drive needs several to
  /// reach a target.
  [[nodiscard]] std::uint16_t next(std::uint16_t statusword) {
    state_ = state_of(statusword);
    if (!state_) return 0;
    if (*state_ == State::fault || *state_ == State::fault_reaction_active) return next_in_fault();
    const std::uint16_t command =
        controlwords_to_target[static_cast<std::size_t>(target_)][static_cast<std::size_t>(*state_)];
    if (!is_enabled() || target_ != DriveTarget::enabled) {
      set_point_ = Handshake::none;
      return command;
    }
    return static_cast<std::uint16_t>(command | mode_bits_ | set_point_bits(statusword) |
                                      (halted_ ? controlword::halt : 0));
  }
  /// The same with the word of a device, for its object 6040h.
  template <FieldWord Statusword>
  [[nodiscard]] RawNumber<std::uint16_t> next(const Statusword& statusword) {
    return canopen::raw(next(statusword.raw()));
  }

 private:
  enum class Handshake : std::uint8_t { none, requested, sent, acknowledged };

  std::uint16_t next_in_fault() {
    target_ = DriveTarget::voltage_off;
    set_point_ = Handshake::none;
    if (*state_ == State::fault_reaction_active) return 0;
    return std::exchange(reset_, false) ? controlword::fault_reset : 0;
  }

  /// A new set-point begins with bit 12 of the statusword at 0, and is taken when that is 1.
  std::uint16_t set_point_bits(std::uint16_t statusword) {
    const bool is_acknowledged = (statusword & statusword::set_point_acknowledge) != 0;
    switch (set_point_) {
      case Handshake::none: return 0;
      case Handshake::requested:
        if (is_acknowledged) return 0;  // of the set-point before
        set_point_ = Handshake::sent;
        break;
      case Handshake::sent:
        if (!is_acknowledged) break;
        set_point_ = Handshake::acknowledged;
        return 0;
      case Handshake::acknowledged:
        if (!is_acknowledged) set_point_ = Handshake::none;
        return 0;
    }
    return static_cast<std::uint16_t>(controlword::new_set_point | how_);
  }

  DriveTarget target_ = DriveTarget::voltage_off;
  std::optional<State> state_;
  std::uint16_t mode_bits_ = 0;
  std::uint16_t how_ = 0;
  Handshake set_point_ = Handshake::none;
  bool reset_ = false;
  bool halted_ = false;
};

}  // namespace canopen::cia402

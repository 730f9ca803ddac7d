#ifndef EDSC_TYPED_DRIVE_MEANING_HPP
#define EDSC_TYPED_DRIVE_MEANING_HPP

#include <canopen/od/quantity.hpp>
#include <canopen/od/typed_value.hpp>
#include <cstdint>
#include <ratio>

namespace typed_drive::meaning {

enum class mode : std::int8_t {
  no_mode = 0,
  profile_position = 1,
  profile_velocity = 3,
  homing = 6,
};

enum class heater_state : std::uint8_t {
  off = 0,
  heating = 1,
  cooling = 5,
};

struct controlword : canopen::Fields<std::uint16_t> {
  using Fields::Fields;

  [[nodiscard]] constexpr bool switch_on() const { return has_(0x0001); }
  constexpr controlword& switch_on(bool on) { return assign_(0x0001, on), *this; }
  [[nodiscard]] constexpr bool enable_voltage() const { return has_(0x0002); }
  constexpr controlword& enable_voltage(bool on) { return assign_(0x0002, on), *this; }
  [[nodiscard]] constexpr bool quick_stop() const { return has_(0x0004); }
  constexpr controlword& quick_stop(bool on) { return assign_(0x0004, on), *this; }
  [[nodiscard]] constexpr bool enable_operation() const { return has_(0x0008); }
  constexpr controlword& enable_operation(bool on) { return assign_(0x0008, on), *this; }
  [[nodiscard]] constexpr bool halt() const { return has_(0x0100); }
  constexpr controlword& halt(bool on) { return assign_(0x0100, on), *this; }

  struct profile_position_fields {
    controlword& word;
    [[nodiscard]] constexpr bool new_set_point() const { return word.has_(0x0010); }
    constexpr profile_position_fields& new_set_point(bool on) { return word.assign_(0x0010, on), *this; }
    [[nodiscard]] constexpr bool relative() const { return word.has_(0x0040); }
    constexpr profile_position_fields& relative(bool on) { return word.assign_(0x0040, on), *this; }
  };
  [[nodiscard]] constexpr profile_position_fields profile_position() { return {*this}; }
};

struct statusword : canopen::Fields<std::uint16_t> {
  using Fields::Fields;

  [[nodiscard]] constexpr bool ready_to_switch_on() const { return has_(0x0001); }
  constexpr statusword& ready_to_switch_on(bool on) { return assign_(0x0001, on), *this; }
  [[nodiscard]] constexpr bool switched_on() const { return has_(0x0002); }
  constexpr statusword& switched_on(bool on) { return assign_(0x0002, on), *this; }
  [[nodiscard]] constexpr bool operation_enabled() const { return has_(0x0004); }
  constexpr statusword& operation_enabled(bool on) { return assign_(0x0004, on), *this; }
  [[nodiscard]] constexpr bool fault() const { return has_(0x0008); }
  constexpr statusword& fault(bool on) { return assign_(0x0008, on), *this; }

  enum class state_value : std::uint8_t {
    not_ready_to_switch_on,
    switch_on_disabled,
    operation_enabled,
    fault,
  };
  [[nodiscard]] constexpr bool is(state_value value) const {
    switch (value) {
      case state_value::not_ready_to_switch_on: return (number_ & 0x004F) == 0x0000;
      case state_value::switch_on_disabled: return (number_ & 0x004F) == 0x0040;
      case state_value::operation_enabled: return (number_ & 0x006F) == 0x0027;
      case state_value::fault: return (number_ & 0x004F) == 0x0008;
    }
    return false;
  }

  struct profile_position_fields : Fields {
    using Fields::Fields;
    [[nodiscard]] constexpr bool set_point_acknowledge() const { return has_(0x1000); }
    [[nodiscard]] constexpr bool following_error() const { return has_(0x2000); }
  };
  [[nodiscard]] constexpr profile_position_fields profile_position() const {
    return profile_position_fields{canopen::raw(number_)};
  }
  struct profile_velocity_fields : Fields {
    using Fields::Fields;
    [[nodiscard]] constexpr bool speed() const { return has_(0x1000); }
  };
  [[nodiscard]] constexpr profile_velocity_fields profile_velocity() const {
    return profile_velocity_fields{canopen::raw(number_)};
  }
};

struct door : canopen::Fields<std::uint8_t> {
  using Fields::Fields;

  [[nodiscard]] constexpr bool open() const { return has_(0x01); }
  constexpr door& open(bool on) { return assign_(0x01, on), *this; }
  [[nodiscard]] constexpr std::int8_t trim() const { return static_cast<std::int8_t>(signed_part_(2, 2)); }
  constexpr door& trim(canopen::SignedFieldNumber<2> value) {
    return assign_part_(2, 0x03, static_cast<std::uint8_t>(value.number)), *this;
  }
  [[nodiscard]] constexpr std::uint8_t zone() const { return part_(4, 0x0F); }
  constexpr door& zone(canopen::FieldNumber<4> value) {
    return assign_part_(4, 0x0F, static_cast<std::uint8_t>(value.number)), *this;
  }
};

using temperature = canopen::Quantity<std::int16_t, canopen::unit::degree_celsius, std::ratio<1, 10>>;
using position = canopen::Quantity<std::int32_t, canopen::unit::revolution, std::ratio<1, 10'000>>;
using energy = canopen::Quantity<std::uint64_t, canopen::unit::watt_hour>;
using depth = canopen::Quantity<std::int16_t, canopen::unit::kelvin, std::ratio<-1, 2>>;

}  // namespace typed_drive::meaning

#endif  // EDSC_TYPED_DRIVE_MEANING_HPP

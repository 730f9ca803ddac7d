/// Types of objects with a meaning, for bench/footprint/twins.cpp.
#pragma once

#include <canopen/od/object.hpp>
#include <canopen/od/quantity.hpp>
#include <canopen/od/typed_value.hpp>
#include <canopen/od/value_for.hpp>
#include <canopen/pdo/pdo.hpp>
#include <cstdint>
#include <ratio>

namespace twins {

enum class mode : std::int8_t { profile_position = 1, profile_velocity = 3, homing = 6 };

struct word : canopen::Fields<std::uint16_t> {
  using Fields::Fields;
  [[nodiscard]] constexpr bool ready() const { return has_(0x0001); }
  constexpr word& ready(bool on) { return assign_(0x0001, on), *this; }
  [[nodiscard]] constexpr bool enabled() const { return has_(0x0004); }
  constexpr word& enabled(bool on) { return assign_(0x0004, on), *this; }
  [[nodiscard]] constexpr bool fault() const { return has_(0x0008); }
  constexpr word& halt(bool on) { return assign_(0x0100, on), *this; }
  [[nodiscard]] constexpr std::uint8_t zone() const { return static_cast<std::uint8_t>(part_(4, 0x000F)); }
  constexpr word& zone(canopen::FieldNumber<4> value) {
    return assign_part_(4, 0x000F, static_cast<std::uint16_t>(value.number)), *this;
  }
};

using temperature = canopen::Quantity<std::int16_t, canopen::unit::degree_celsius, std::ratio<1, 10>>;
using position = canopen::Quantity<std::int32_t, canopen::unit::revolution, std::ratio<1, 10'000>>;

template <std::uint16_t Index, class Type>
using Numbers = canopen::Object<Index, 0, Type, canopen::Access::rw, canopen::Mappable::both>;
template <std::uint16_t Index, class Type>
struct Typed : Numbers<Index, canopen::RawOf<Type>> {
  using type = Type;
};

/// The values of a device, which the compiler does not know.
struct Values {
  std::uint16_t word;
  std::int16_t temperature;
  std::int32_t position;
  std::int8_t mode;
};

}  // namespace twins

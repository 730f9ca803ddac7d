/// An object of the dictionary as a C++ type: the base of the generated od:: types.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "canopen/od/access.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

/// Bits of a value on the wire that follow from its C++ type; 0 for strings and domains.
template <class T>
inline constexpr std::uint16_t wire_bits = std::is_arithmetic_v<T> ? sizeof(T) * 8 : 0;
template <>
inline constexpr std::uint16_t wire_bits<bool> = 1;
template <>
inline constexpr std::uint16_t wire_bits<TimeOfDay> = 48;
template <>
inline constexpr std::uint16_t wire_bits<TimeDifference> = 48;

/// Type and access rights of an entry. A generated type derives from it and adds index, sub-index, name, limits and
/// default value of the EDS. Entries with the same type and access rights share the base: a compiler needs time for
/// each instance of a template, in a namespace of many names the more.
template <class T, Access A, Mappable M = Mappable::no, std::uint16_t Bits = wire_bits<T>>
struct TypedObject {
  using type = T;
  static constexpr Access access = A;
  static constexpr Mappable mappable = M;
  static constexpr std::uint16_t bits = Bits;
};

/// The same with index and sub-index, for objects that are not generated and for elements of an ARRAY.
template <std::uint16_t Index, std::uint8_t SubIndex, class T, Access A, Mappable M = Mappable::no,
          std::uint16_t Bits = wire_bits<T>>
struct Object : TypedObject<T, A, M, Bits> {
  static constexpr std::uint16_t index = Index;
  static constexpr std::uint8_t sub_index = SubIndex;
};

/// A type with the attributes of an object.
template <class O>
concept DictionaryObject = requires {
  typename O::type;
  { O::index } -> std::convertible_to<std::uint16_t>;
  { O::sub_index } -> std::convertible_to<std::uint8_t>;
  { O::access } -> std::convertible_to<Access>;
  { O::mappable } -> std::convertible_to<Mappable>;
};

/// Lowest and highest value of an object: the limits of the EDS, otherwise the range of its bits.
template <class O>
[[nodiscard]] constexpr typename O::type low_limit() {
  using T = typename O::type;
  if constexpr (requires { O::low_limit; }) {
    return O::low_limit;
  } else if constexpr (std::is_integral_v<T> && std::is_signed_v<T> && O::bits < sizeof(T) * 8) {
    return static_cast<T>(-(T{1} << (O::bits - 1)));
  } else {
    return std::numeric_limits<T>::lowest();
  }
}

template <class O>
[[nodiscard]] constexpr typename O::type high_limit() {
  using T = typename O::type;
  if constexpr (requires { O::high_limit; }) {
    return O::high_limit;
  } else if constexpr (std::is_same_v<T, bool>) {
    return true;
  } else if constexpr (std::is_integral_v<T> && O::bits < sizeof(T) * 8) {
    return static_cast<T>((T{1} << (O::bits - (std::is_signed_v<T> ? 1 : 0))) - 1);
  } else {
    return std::numeric_limits<T>::max();
  }
}

}  // namespace canopen

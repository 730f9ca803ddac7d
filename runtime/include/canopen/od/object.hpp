/// An object of the dictionary as a C++ type: the base of the generated od:: types.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "canopen/od/access.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

/// Whether an index is in the communication profile area, 1000h..1FFFh, whose objects belong to services.
[[nodiscard]] constexpr bool is_communication_index(std::uint16_t index) { return index < 0x2000; }

/// Bits of a value on the wire that follow from its C++ type; 0 for strings and domains.
template <class Type>
inline constexpr std::uint16_t wire_bits = std::is_arithmetic_v<Type> ? sizeof(Type) * 8 : 0;
template <>
inline constexpr std::uint16_t wire_bits<bool> = 1;
template <>
inline constexpr std::uint16_t wire_bits<TimeOfDay> = 48;
template <>
inline constexpr std::uint16_t wire_bits<TimeDifference> = 48;

/// Type and access rights of an entry. A generated type derives from it and adds index, sub-index, name, limits and
/// default value of the EDS. Entries with the same type and access rights share the base: a compiler needs time for
/// each instance of a template, in a namespace of many names the more.
template <class Type, Access ObjectAccess, Mappable ObjectMappable = Mappable::no, std::uint16_t Bits = wire_bits<Type>>
struct TypedObject {
  using type = Type;
  static constexpr Access access = ObjectAccess;
  static constexpr Mappable mappable = ObjectMappable;
  static constexpr std::uint16_t bits = Bits;
};

/// The same with index and sub-index, for objects that are not generated and for elements of an ARRAY.
template <std::uint16_t Index, std::uint8_t SubIndex, class Type, Access ObjectAccess,
          Mappable ObjectMappable = Mappable::no, std::uint16_t Bits = wire_bits<Type>>
struct Object : TypedObject<Type, ObjectAccess, ObjectMappable, Bits> {
  static constexpr std::uint16_t index = Index;
  static constexpr std::uint8_t sub_index = SubIndex;
};

/// A type with the attributes of an object.
template <class ObjectType>
concept DictionaryObject = requires {
  typename ObjectType::type;
  { ObjectType::index } -> std::convertible_to<std::uint16_t>;
  { ObjectType::sub_index } -> std::convertible_to<std::uint8_t>;
  { ObjectType::access } -> std::convertible_to<Access>;
  { ObjectType::mappable } -> std::convertible_to<Mappable>;
};

/// An object with the raw numbers of another one as its values.
template <class ObjectType>
struct NumbersOf : ObjectType {
  using type = RawOf<typename ObjectType::type>;
};

/// Lowest and highest raw number of an object: the limits of the EDS, otherwise the range of its bits.
template <class ObjectType>
[[nodiscard]] constexpr RawOf<typename ObjectType::type> low_limit() {
  using Type = RawOf<typename ObjectType::type>;
  if constexpr (requires { ObjectType::low_limit; }) {
    return to_raw(ObjectType::low_limit);
  } else if constexpr (std::is_integral_v<Type> && std::is_signed_v<Type> && ObjectType::bits < sizeof(Type) * 8) {
    return static_cast<Type>(-(Type{1} << (ObjectType::bits - 1)));
  } else {
    return std::numeric_limits<Type>::lowest();
  }
}

template <class ObjectType>
[[nodiscard]] constexpr RawOf<typename ObjectType::type> high_limit() {
  using Type = RawOf<typename ObjectType::type>;
  if constexpr (requires { ObjectType::high_limit; }) {
    return to_raw(ObjectType::high_limit);
  } else if constexpr (std::is_same_v<Type, bool>) {
    return true;
  } else if constexpr (std::is_integral_v<Type> && ObjectType::bits < sizeof(Type) * 8) {
    return static_cast<Type>((Type{1} << (ObjectType::bits - (std::is_signed_v<Type> ? 1 : 0))) - 1);
  } else {
    return std::numeric_limits<Type>::max();
  }
}

}  // namespace canopen

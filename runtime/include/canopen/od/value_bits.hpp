/// Values of the dictionary and their bits on the bus, which SDO and PDO have in common (CiA 301, 7.1).
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value.hpp"

namespace canopen::value_detail {

/// A string value of the dictionary: `Type::size` bytes; the remaining bytes of its entry are zero.
template <class Type>
concept StringValue = requires(Type value) {
  value.bytes[0];
  { value.size } -> std::convertible_to<std::size_t>;
};

/// Text, which ends at its first 00h; an octet string is as long as its entry.
template <class Type>
concept TextValue = StringValue<Type> && std::same_as<decltype(std::declval<const Type&>().view()), std::string_view>;

/// Returns the bits of a value as on the wire; above those of its type, signed values are sign-extended.
template <class Type>
[[nodiscard]] constexpr auto raw_of(const Type& value) {
  if constexpr (Meaningful<Type>) {
    return raw_of(to_raw(value));
  } else if constexpr (std::is_same_v<Type, float>) {
    return std::bit_cast<std::uint32_t>(value);
  } else if constexpr (std::is_same_v<Type, double>) {
    return std::bit_cast<std::uint64_t>(value);
  } else if constexpr (std::is_same_v<Type, TimeOfDay> || std::is_same_v<Type, TimeDifference>) {
    return value.milliseconds | (static_cast<std::uint64_t>(value.days) << 32);
  } else if constexpr (StringValue<Type>) {
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < value.size && i < sizeof raw; ++i) raw |= std::uint64_t{value.bytes[i]} << (8 * i);
    return raw;
  } else if constexpr (sizeof(Type) <= sizeof(std::uint32_t)) {
    return static_cast<std::uint32_t>(value);
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

template <class Type>
[[nodiscard]] constexpr std::uint64_t to_bits(const Type& value) {
  if constexpr (Meaningful<Type>) {
    return to_bits(to_raw(value));
  } else if constexpr (std::is_signed_v<Type> && std::is_integral_v<Type>) {
    return static_cast<std::uint64_t>(value);
  } else {
    return raw_of(value);
  }
}

template <class Type, unsigned Bits>
[[nodiscard]] constexpr Type string_from_bits(std::uint64_t raw) {
  constexpr std::size_t entry_bytes = Bits / 8;
  Type value;
  for (std::size_t i = 0; i < entry_bytes && i < Type::capacity(); ++i) {
    const auto byte = static_cast<std::uint8_t>(raw >> (8 * i));
    if (TextValue<Type> && byte == 0) break;
    value.bytes[i] = byte;
    value.size = static_cast<std::uint16_t>(i + 1);
  }
  return value;
}

/// Returns a value from its `Bits` bits; the other bits of `raw` must be zero.
template <class Type, unsigned Bits>
[[nodiscard]] constexpr Type from_bits(std::uint64_t raw) {
  if constexpr (Meaningful<Type>) {
    return from_raw<Type>(from_bits<RawOf<Type>, Bits>(raw));
  } else if constexpr (std::is_same_v<Type, float>) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  } else if constexpr (std::is_same_v<Type, double>) {
    return std::bit_cast<double>(raw);
  } else if constexpr (std::is_same_v<Type, TimeOfDay> || std::is_same_v<Type, TimeDifference>) {
    return Type{static_cast<std::uint32_t>(raw), static_cast<std::uint16_t>(raw >> 32)};
  } else if constexpr (StringValue<Type>) {
    return string_from_bits<Type, Bits>(raw);
  } else if constexpr (std::is_signed_v<Type> && Bits <= 32) {
    constexpr unsigned unused = 32 - Bits;
    return static_cast<Type>(static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) << unused) >> unused);
  } else if constexpr (std::is_signed_v<Type>) {
    constexpr unsigned unused = 64 - Bits;
    return static_cast<Type>(static_cast<std::int64_t>(raw << unused) >> unused);
  } else {
    return static_cast<Type>(raw);
  }
}

/// Returns the value of an object from the bytes that SDO transfers; there must be as many as the object has.
template <DictionaryObject Object>
[[nodiscard]] typename Object::type value_from(std::span<std::uint8_t> bytes) {
  using Type = typename Object::type;
  if constexpr (Meaningful<Type>) {
    return from_raw<Type>(value_from<NumbersOf<Object>>(bytes));
  } else if constexpr (std::is_same_v<Type, Domain>) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return Domain{bytes.data(), size, size};
  } else if constexpr (Object::bits == 0) {
    Type text{};
    text.size = static_cast<std::uint16_t>(bytes.size());
    if (!bytes.empty()) std::memcpy(text.bytes.data(), bytes.data(), bytes.size());
    return text;
  } else if constexpr (std::is_same_v<Type, bool>) {
    return bytes[0] != 0;
  } else if constexpr (Object::bits == sizeof(Type) * 8) {
    Type value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  } else {
    std::uint64_t raw = 0;
    std::memcpy(&raw, bytes.data(), Object::bits / 8);
    return from_bits<Type, Object::bits>(raw);
  }
}

}  // namespace canopen::value_detail

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
#include "canopen/od/value.hpp"

namespace canopen::value_detail {

/// A string value of the dictionary: `T::size` bytes; the remaining bytes of its entry are zero.
template <class T>
concept StringValue = requires(T value) {
  value.bytes[0];
  { value.size } -> std::convertible_to<std::size_t>;
};

/// Text, which ends at its first 00h; an octet string is as long as its entry.
template <class T>
concept TextValue = StringValue<T> && std::same_as<decltype(std::declval<const T&>().view()), std::string_view>;

/// Returns the bits of a value as on the wire; above those of its type, signed values are sign-extended.
template <class T>
[[nodiscard]] constexpr auto raw_of(const T& value) {
  if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<std::uint32_t>(value);
  } else if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<std::uint64_t>(value);
  } else if constexpr (std::is_same_v<T, TimeOfDay> || std::is_same_v<T, TimeDifference>) {
    return value.milliseconds | (static_cast<std::uint64_t>(value.days) << 32);
  } else if constexpr (StringValue<T>) {
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < value.size && i < sizeof raw; ++i) raw |= std::uint64_t{value.bytes[i]} << (8 * i);
    return raw;
  } else if constexpr (sizeof(T) <= sizeof(std::uint32_t)) {
    return static_cast<std::uint32_t>(value);
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

template <class T>
[[nodiscard]] constexpr std::uint64_t to_bits(const T& value) {
  if constexpr (std::is_signed_v<T> && std::is_integral_v<T>) {
    return static_cast<std::uint64_t>(value);
  } else {
    return raw_of(value);
  }
}

template <class T, unsigned Bits>
[[nodiscard]] constexpr T string_from_bits(std::uint64_t raw) {
  constexpr std::size_t entry_bytes = Bits / 8;
  T value;
  for (std::size_t i = 0; i < entry_bytes && i < T::capacity(); ++i) {
    const auto byte = static_cast<std::uint8_t>(raw >> (8 * i));
    if (TextValue<T> && byte == 0) break;
    value.bytes[i] = byte;
    value.size = static_cast<std::uint16_t>(i + 1);
  }
  return value;
}

/// Returns a value from its `Bits` bits; the other bits of `raw` must be zero.
template <class T, unsigned Bits>
[[nodiscard]] constexpr T from_bits(std::uint64_t raw) {
  if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  } else if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<double>(raw);
  } else if constexpr (std::is_same_v<T, TimeOfDay> || std::is_same_v<T, TimeDifference>) {
    return T{static_cast<std::uint32_t>(raw), static_cast<std::uint16_t>(raw >> 32)};
  } else if constexpr (StringValue<T>) {
    return string_from_bits<T, Bits>(raw);
  } else if constexpr (std::is_signed_v<T> && Bits <= 32) {
    constexpr unsigned unused = 32 - Bits;
    return static_cast<T>(static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) << unused) >> unused);
  } else if constexpr (std::is_signed_v<T>) {
    constexpr unsigned unused = 64 - Bits;
    return static_cast<T>(static_cast<std::int64_t>(raw << unused) >> unused);
  } else {
    return static_cast<T>(raw);
  }
}

/// Returns the value of an object from the bytes that SDO transfers; there must be as many as the object has.
template <DictionaryObject O>
[[nodiscard]] typename O::type value_from(std::span<std::uint8_t> bytes) {
  using T = typename O::type;
  if constexpr (std::is_same_v<T, Domain>) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return Domain{bytes.data(), size, size};
  } else if constexpr (O::bits == 0) {
    T text{};
    text.size = static_cast<std::uint16_t>(bytes.size());
    if (!bytes.empty()) std::memcpy(text.bytes.data(), bytes.data(), bytes.size());
    return text;
  } else if constexpr (std::is_same_v<T, bool>) {
    return bytes[0] != 0;
  } else if constexpr (O::bits == sizeof(T) * 8) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  } else {
    std::uint64_t raw = 0;
    std::memcpy(&raw, bytes.data(), O::bits / 8);
    return from_bits<T, O::bits>(raw);
  }
}

}  // namespace canopen::value_detail

/// C++ types of values that are not plain numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"

namespace canopen {

/// TIME_OF_DAY (CiA 301, 7.1.6.5): 48 bits, with the same layout in memory and on the wire.
struct TimeOfDay {
  std::uint32_t milliseconds = 0;  ///< after midnight, 28 bits
  std::uint16_t days = 0;          ///< since 1 January 1984

  friend constexpr bool operator==(TimeOfDay, TimeOfDay) = default;
};

/// TIME_DIFFERENCE (CiA 301, 7.1.6.6).
struct TimeDifference {
  std::uint32_t milliseconds = 0;  ///< 28 bits
  std::uint16_t days = 0;

  friend constexpr bool operator==(TimeDifference, TimeDifference) = default;
};

/// Common base of all strings: a length and up to `Capacity` bytes, which the dictionary accesses at one offset.
template <std::size_t Capacity>
struct StringStorage {
  static_assert(Capacity <= 0xFFFF);
  std::uint16_t size = 0;  ///< bytes in use
  std::array<std::uint8_t, Capacity> bytes{};

  static constexpr std::size_t capacity() { return Capacity; }
};

/// VISIBLE_STRING: ISO 646 text without a terminating zero. A literal converts to it; one that is longer than the
/// capacity does not compile.
template <std::size_t Capacity>
struct VisibleString : StringStorage<Capacity> {
  constexpr VisibleString() = default;
  template <std::size_t Size>
  constexpr VisibleString(const char (&literal)[Size]) {  // NOLINT(google-explicit-constructor): text converts to it
    static_assert(Size <= Capacity + 1, "the text is longer than the string");
    for (const char character : literal) {
      if (character == 0 || this->size == Capacity) break;
      this->bytes[this->size++] = static_cast<std::uint8_t>(character);
    }
  }

  /// Returns the string with this text; 0607 0012h if it is longer than the capacity.
  [[nodiscard]] static constexpr Result<VisibleString> from(std::string_view text) {
    if (text.size() > Capacity) return AbortCode::length_too_high;
    return truncated(text);
  }
  /// Returns the string with the first bytes of a text, as many as it has room for.
  [[nodiscard]] static constexpr VisibleString truncated(std::string_view text) {
    VisibleString string;
    while (string.size < text.size() && string.size < Capacity) {
      string.bytes[string.size] = static_cast<std::uint8_t>(text[string.size]);
      ++string.size;
    }
    return string;
  }

  [[nodiscard]] std::string_view view() const {
    return {reinterpret_cast<const char*>(this->bytes.data()), this->size};
  }
};

/// OCTET_STRING: any bytes. A list of constants converts to it; one that is longer than the capacity does not compile.
/// Clang before 16 ends with a segmentation fault where this constructor is consteval: there, the program ends with a
/// trap at a longer list, unless it is a constant expression, which does not compile.
template <std::size_t Capacity>
struct OctetString : StringStorage<Capacity> {
  constexpr OctetString() = default;
#if defined(__clang__) && __clang_major__ < 16
  constexpr OctetString(std::initializer_list<std::uint8_t> octets) : OctetString{truncated(octets)} {
    if (octets.size() > Capacity) __builtin_trap();
  }
#else
  consteval OctetString(std::initializer_list<std::uint8_t> octets) {
    for (const std::uint8_t octet : octets) this->bytes[this->size++] = octet;
  }
#endif

  /// Returns the string with these bytes; 0607 0012h if they are more than the capacity.
  [[nodiscard]] static constexpr Result<OctetString> from(std::span<const std::uint8_t> octets) {
    if (octets.size() > Capacity) return AbortCode::length_too_high;
    return truncated(octets);
  }
  /// Returns the string with the first ones of these bytes, as many as it has room for.
  [[nodiscard]] static constexpr OctetString truncated(std::span<const std::uint8_t> octets) {
    OctetString string;
    while (string.size < octets.size() && string.size < Capacity) {
      string.bytes[string.size] = octets[string.size];
      ++string.size;
    }
    return string;
  }

  [[nodiscard]] constexpr std::span<const std::uint8_t> view() const { return {this->bytes.data(), this->size}; }
};

/// UNICODE_STRING: UTF-16 code units, low byte first. The capacity is in bytes. A literal converts to it; one that is
/// longer than the capacity does not compile.
template <std::size_t Capacity>
struct UnicodeString : StringStorage<Capacity> {
  constexpr UnicodeString() = default;
  template <std::size_t Size>
  constexpr UnicodeString(const char16_t (&literal)[Size]) {  // NOLINT(google-explicit-constructor)
    static_assert(2 * (Size - 1) <= Capacity, "the text is longer than the string");
    for (const char16_t unit : literal) {
      if (unit == 0 || this->size + 2u > Capacity) break;
      append(unit);
    }
  }

  /// Returns the string with this text; 0607 0012h if it is longer than the capacity.
  [[nodiscard]] static constexpr Result<UnicodeString> from(std::u16string_view text) {
    if (2 * text.size() > Capacity) return AbortCode::length_too_high;
    return truncated(text);
  }
  /// Returns the string with the first code units of a text, as many as it has room for.
  [[nodiscard]] static constexpr UnicodeString truncated(std::u16string_view text) {
    UnicodeString string;
    for (const char16_t unit : text) {
      if (string.size + 2u > Capacity) break;
      string.append(unit);
    }
    return string;
  }

 private:
  constexpr void append(char16_t unit) {
    this->bytes[this->size] = static_cast<std::uint8_t>(unit & 0xFF);
    this->bytes[this->size + 1u] = static_cast<std::uint8_t>(unit >> 8);
    this->size = static_cast<std::uint16_t>(this->size + 2);
  }
};

/// DOMAIN: memory of the application, which SDO reads and writes as a whole. Unbound until the application sets `data`.
struct Domain {
  std::uint8_t* data = nullptr;
  std::uint32_t size = 0;      ///< bytes that an upload sends
  std::uint32_t capacity = 0;  ///< bytes that a download may write; 0: none
};

}  // namespace canopen

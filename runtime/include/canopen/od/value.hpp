/// C++ types of values that are not plain numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

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

/// VISIBLE_STRING: ISO 646 text without a terminating zero.
template <std::size_t Capacity>
struct VisibleString : StringStorage<Capacity> {
  constexpr VisibleString() = default;
  /// Truncates text that is longer than the capacity.
  constexpr VisibleString(std::string_view text) {  // NOLINT(google-explicit-constructor): text converts to it
    while (this->size < text.size() && this->size < Capacity) {
      this->bytes[this->size] = static_cast<std::uint8_t>(text[this->size]);
      ++this->size;
    }
  }
  constexpr VisibleString(const char* text)
      : VisibleString{std::string_view{text}} {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] std::string_view view() const {
    return {reinterpret_cast<const char*>(this->bytes.data()), this->size};
  }
};

/// OCTET_STRING: any bytes.
template <std::size_t Capacity>
struct OctetString : StringStorage<Capacity> {
  constexpr OctetString() = default;
  constexpr OctetString(std::initializer_list<std::uint8_t> octets)
      : OctetString{std::span<const std::uint8_t>{octets.begin(), octets.size()}} {}
  /// Truncates bytes beyond the capacity.
  constexpr OctetString(std::span<const std::uint8_t> octets) {  // NOLINT(google-explicit-constructor)
    while (this->size < octets.size() && this->size < Capacity) {
      this->bytes[this->size] = octets[this->size];
      ++this->size;
    }
  }

  [[nodiscard]] constexpr std::span<const std::uint8_t> view() const { return {this->bytes.data(), this->size}; }
};

/// UNICODE_STRING: UTF-16 code units, low byte first. The capacity is in bytes.
template <std::size_t Capacity>
struct UnicodeString : StringStorage<Capacity> {
  constexpr UnicodeString() = default;
  /// Truncates code units beyond the capacity.
  constexpr UnicodeString(std::u16string_view text) {  // NOLINT(google-explicit-constructor)
    for (const char16_t unit : text) {
      if (this->size + 2u > Capacity) break;
      this->bytes[this->size] = static_cast<std::uint8_t>(unit & 0xFF);
      this->bytes[this->size + 1u] = static_cast<std::uint8_t>(unit >> 8);
      this->size = static_cast<std::uint16_t>(this->size + 2);
    }
  }
};

/// DOMAIN: memory of the application, which SDO reads and writes as a whole. Unbound until the application sets `data`.
struct Domain {
  std::uint8_t* data = nullptr;
  std::uint32_t size = 0;      ///< bytes that an upload sends
  std::uint32_t capacity = 0;  ///< bytes that a download may write; 0: none
};

}  // namespace canopen

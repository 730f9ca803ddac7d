/// Default values in flash that a reset copies to RAM. Most of their bytes are zero: an image for size leaves these
/// out.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "canopen/base/bytes.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/od/dictionary.hpp"

namespace canopen {

/// The default values of a part of the values of a device, as bytes: `Preset` is the address of the constant, `Offset`
/// that of the part in the values. Bytes between the values are zero.
template <class Device, auto Preset, std::size_t Offset>
class PresetBytes {
  using Part = std::remove_cvref_t<decltype(*Preset)>;

  template <class Visit>
  static constexpr void for_each_value(Visit&& visit) {
    Device::dictionary.for_each_entry([&](std::uint16_t, std::uint8_t, entry::Word word) {
      const std::size_t at = entry::offset_of(word) - Offset;
      if (entry::place_of(word) == entry::Place::ram && at < size) visit(at, word);
    });
  }

 public:
  static constexpr std::size_t size = sizeof(Part);
  /// Of the dictionary, each of which `are_numbers` and `bytes` visit.
  static constexpr std::size_t objects = Device::dictionary.entries.size();

  /// Whether all values are numbers. Bytes of strings after their ends are indeterminate for a compiler.
  [[nodiscard]] static constexpr bool are_numbers() {
    bool all = true;
    for_each_value([&](std::size_t, entry::Word word) { all = all && entry::wire_bytes(word) != 0; });
    return all;
  }

  [[nodiscard]] static constexpr std::array<std::uint8_t, size> bytes() {
    const auto values = std::bit_cast<std::array<std::uint8_t, size>>(*Preset);
    std::array<std::uint8_t, size> known{};
    for_each_value([&](std::size_t at, entry::Word word) {
      const std::size_t bytes = entry::wire_bytes(word);
      // A signed number of 24 bits, for example, is extended to 32 bits. The bytes after a time of day are
      // indeterminate.
      const bool is_extended = entry::class_of(word) == entry::Class::signed_integer;
      const std::size_t end = at + (is_extended ? std::bit_ceil(bytes) : bytes);
      for (std::size_t i = at; i < end; ++i) known[i] = values[i];
    });
    return known;
  }
};

namespace preset_detail {

/// Each eight bytes are a byte with a bit for each that is not zero, and these.
template <class Preset>
struct Packed {
  static constexpr std::size_t size = [] {
    std::size_t count = (Preset::size + 7) / 8;
    for (const std::uint8_t byte : Preset::bytes()) count += byte != 0 ? 1u : 0u;
    return count;
  }();

  static constexpr std::array<std::uint8_t, size> bytes = [] {
    std::array<std::uint8_t, size> packed{};
    constexpr auto all = Preset::bytes();
    std::size_t at = 0;
    for (std::size_t first = 0; first < all.size(); first += 8) {
      std::uint8_t& mask = packed[at++];
      for (std::size_t i = first; i < first + 8 && i < all.size(); ++i) {
        if (all[i] == 0) continue;
        mask = static_cast<std::uint8_t>(mask | 1u << (i - first));
        packed[at++] = all[i];
      }
    }
    return packed;
  }();
};

[[gnu::noinline]] inline void unpack(std::uint8_t* to, std::size_t size, const std::uint8_t* packed) {
  unsigned mask = 1;
  for (const std::uint8_t* const end = to + size; to != end; ++to) {
    if (mask == 1) mask = *packed++ | 0x100u;
    *to = (mask & 1) != 0 ? *packed++ : std::uint8_t{0};
    mask >>= 1;
  }
}

inline constexpr std::size_t unpack_code = 44;         ///< bytes of `unpack` on a Cortex-M0+
inline constexpr std::size_t max_packed_bytes = 4096;  ///< compilers take longer for more
inline constexpr std::size_t max_objects = 2048;       ///< Clang evaluates a million steps

/// Whether a reset unpacks the default values, which saves 4 to 132 bytes of a Cortex-M0+. The other build does not
/// compute it.
template <class Preset>
[[nodiscard]] constexpr bool is_packed() {
  constexpr bool is_considered = prefers_size && Preset::size <= max_packed_bytes && Preset::objects <= max_objects;
  if constexpr (is_considered) {
    if constexpr (Preset::are_numbers()) {
      return Packed<Preset>::size + unpack_code < Preset::size;
    }
  }
  return false;
}

}  // namespace preset_detail

/// Sets a part of the values of a device to its default values.
template <class Device, auto Preset, std::size_t Offset>
void set_preset(std::remove_cvref_t<decltype(*Preset)>& values) {
  using Bytes = PresetBytes<Device, Preset, Offset>;
  if constexpr (preset_detail::is_packed<Bytes>()) {
    preset_detail::unpack(reinterpret_cast<std::uint8_t*>(&values), sizeof values,
                          preset_detail::Packed<Bytes>::bytes.data());
  } else {
    copy_bytes(&values, Preset, sizeof values);
  }
}

}  // namespace canopen

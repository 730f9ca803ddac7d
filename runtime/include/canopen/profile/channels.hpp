/// The channels of an I/O device: arrays of the dictionary whose elements correspond to each other by sub-index.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/access_probe.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Returns the value of a BOOLEAN.
template <class Device>
[[nodiscard]] bool is_true(EntryAccess<Device> entries, entry::Word word) {
  std::array<std::uint8_t, 8> scratch;
  return entries.read(word, scratch)[0] != 0;
}

/// An object with one element per channel, found at compile time. It has no cost in a device without the object.
template <class Device, std::uint16_t Index>
struct ChannelObject {
  /// Number of existing sub-indices, from 1 on.
  static constexpr std::uint8_t count = [] {
    std::uint8_t channels = 0;
    while (channels < 254 && Device::dictionary.has(Index, static_cast<std::uint8_t>(channels + 1))) ++channels;
    return channels;
  }();
  static constexpr bool exists = count > 0;

  static constexpr std::array<entry::Word, count> words = [] {
    std::array<entry::Word, count> result{};
    for (std::uint8_t i = 0; i < count; ++i) {
      result[i] = Device::dictionary.find(Index, static_cast<std::uint8_t>(i + 1));
    }
    return result;
  }();

  /// Returns the value of a channel, counted from 0; `missing` if the device does not have the object or the element.
  template <class Type>
  [[nodiscard]] static Type get([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint8_t channel,
                                Type missing) {
    if constexpr (exists) {
      if (channel < count) {
        AccessProbe<Device>::uses(Index, static_cast<std::uint8_t>(channel + 1));
        return static_cast<Type>(entries.number(words[channel]));
      }
    }
    return missing;
  }

  /// Sets a channel. `silently`: without the event that triggers TPDOs.
  template <class Node, class Type>
  static void set(Node& node, std::uint8_t channel, Type value, bool silently = false) {
    static_assert(exists, "this device has no such object");
    std::array<std::uint8_t, sizeof(Type)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (silently) {
      AccessProbe<Device>::uses(Index, static_cast<std::uint8_t>(channel + 1));
      node.entries().write_value(words[channel], bytes);
    } else {
      static_cast<void>(node.set(Index, static_cast<std::uint8_t>(channel + 1), bytes));
    }
  }
};

}  // namespace canopen

/// The object dictionary of every_type.eds, with the bytes of values as text.
#pragma once

#include <array>
#include <bit>
#include <canopen/od/object_store.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <every_type/device.hpp>
#include <string>
#include <vector>

namespace every_type_test {

using Store = canopen::ObjectStore<every_type::Device>;
using Bytes = std::vector<std::uint8_t>;

struct Device {
  explicit Device(std::uint8_t node_id = 5) {
    store.reset_application(canopen::NodeId{node_id});
    store.reset_communication(canopen::NodeId{node_id});
  }

  Bytes read(std::uint16_t index, std::uint8_t sub_index) {
    std::array<std::uint8_t, 8> scratch{};
    const auto bytes = store.entries().read(every_type::dictionary.find(index, sub_index), scratch);
    return {bytes.begin(), bytes.end()};
  }

  canopen::AbortCode check(std::uint16_t index, std::uint8_t sub_index, const Bytes& bytes) {
    return store.entries().check(index, sub_index, every_type::dictionary.find(index, sub_index), bytes);
  }

  Store store;
};

inline std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, text.empty() ? "%02X" : " %02X", static_cast<unsigned>(byte));
    text += digits;
  }
  return text;
}

inline std::string label(std::uint16_t index, std::uint8_t sub_index) {
  char text[16];
  std::snprintf(text, sizeof text, "%04Xh:%02X", static_cast<unsigned>(index), static_cast<unsigned>(sub_index));
  return text;
}

/// A number of up to 64 bits as it is sent, little-endian.
inline Bytes wire(std::int64_t number, std::size_t size) {
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  return bytes;
}
inline Bytes wire(float number) { return wire(std::bit_cast<std::int32_t>(number), 4); }
inline Bytes wire(double number) { return wire(std::bit_cast<std::int64_t>(number), 8); }

}  // namespace every_type_test

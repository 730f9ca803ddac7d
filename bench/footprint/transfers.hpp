/// SDO transfers of a DOMAIN of 8192 bytes, as a client requests them. `exchange(request)` passes a request to the
/// server, and returns the command byte of its last response. A transfer returns whether the server has completed it.
#pragma once

#include <array>
#include <cstdint>
#include <device/device.hpp>

using Bytes = std::array<std::uint8_t, 8>;

constexpr std::uint32_t domain_bytes = 8192;
constexpr std::uint32_t segment_bytes = 7;
constexpr std::uint8_t largest_block = 127;

inline Bytes initiate(std::uint8_t command, std::uint8_t segments = 0) {
  constexpr std::uint16_t index = device::od::blob_8k::index;
  return {command, index & 0xFF, index >> 8, 0, segments, 0, 0, 0};
}

template <class Exchange>
bool upload_segments(Exchange exchange) {
  exchange(initiate(0x40));
  std::uint8_t command = 0x60;
  while ((exchange({command}) & 1) == 0) command ^= 0x10;
  return true;
}

template <class Exchange>
bool download_segments(Exchange exchange) {
  exchange(initiate(0x20));
  std::uint8_t command = 0x00;
  std::uint8_t reply = 0;
  for (std::uint32_t sent = 0; sent < domain_bytes; sent += segment_bytes) {
    const std::uint32_t left = domain_bytes - sent;
    const auto end = static_cast<std::uint8_t>(left <= segment_bytes ? ((segment_bytes - left) << 1) | 1 : 0);
    reply = exchange({static_cast<std::uint8_t>(command | end), 1, 2, 3, 4, 5, 6, 7});
    command ^= 0x10;
  }
  return (reply & 0xEF) == 0x20;
}

constexpr std::uint8_t unused_bytes = (segment_bytes - domain_bytes % segment_bytes) % segment_bytes;

/// CRC-16 of CiA 301, 7.2.4.3.16, of the bytes that the downloads send.
constexpr std::uint16_t crc_of_download = [] {
  std::uint32_t crc = 0;
  for (std::uint32_t at = 0; at < domain_bytes; ++at) {
    crc ^= (at % segment_bytes + 1) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000) != 0 ? 0x1021U : 0U);
    crc &= 0xFFFF;
  }
  return static_cast<std::uint16_t>(crc);
}();

template <class Exchange>
bool upload_blocks(Exchange exchange) {
  exchange(initiate(0xA4, largest_block));
  std::uint8_t reply = exchange({0xA3});
  while (reply != 0xC1 + (unused_bytes << 2))
    reply = exchange({0xA2, static_cast<std::uint8_t>(reply & 0x7F), largest_block});
  exchange({0xA1});
  return true;
}

template <class Exchange>
bool download_blocks(Exchange exchange) {
  exchange(initiate(0xC4));
  std::uint8_t sequence = 0;
  for (std::uint32_t sent = 0; sent < domain_bytes; sent += segment_bytes) {
    ++sequence;
    const auto end = static_cast<std::uint8_t>(domain_bytes - sent <= segment_bytes ? 0x80 : 0);
    exchange({static_cast<std::uint8_t>(sequence | end), 1, 2, 3, 4, 5, 6, 7});
    if (sequence == largest_block) sequence = 0;
  }
  return exchange({static_cast<std::uint8_t>(0xC1 | unused_bytes << 2), crc_of_download & 0xFF,
                   crc_of_download >> 8}) == 0xA1;
}

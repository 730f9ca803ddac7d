/// Shared by the tests of the manuals: a manual's list of objects, and reads and writes over SDO.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>

#include "support/bench.hpp"

namespace manual {

enum class Access : std::uint8_t { ro, rw };
using enum Access;

/// A row of a manual's list of objects. Node-ID-dependent values are those of node 5.
struct Entry {
  std::uint16_t index;
  std::uint8_t sub_index;
  unsigned bytes;
  Access access;
  std::uint32_t value;
};

/// An SDO frame of eight bytes: "605", 0x40, 1000h:00, 0 is "605 40 00 10 00 00 00 00 00".
inline std::string sdo(const std::string& can_id, unsigned command, std::uint16_t index, std::uint8_t sub_index,
                       std::uint32_t data) {
  const canopen::Frame head = bench::frame(can_id);
  canopen::Frame frame{};
  frame.id = head.id;
  frame.size = 8;
  frame.data = {static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(index),
                static_cast<std::uint8_t>(index >> 8), sub_index};
  for (unsigned i = 0; i < 4; ++i) frame.data[4 + i] = static_cast<std::uint8_t>(data >> (8 * i));
  return bench::text(frame);
}

/// The bits of a command specifier for the size of expedited data.
constexpr unsigned unused(unsigned bytes) { return (4 - bytes) << 2; }

/// Expects that each entry has its default value in the bytes of its type and rejects writes if it is read-only.
template <class Bench>
void expect_entries(Bench& device, std::span<const Entry> entries, bool size_indicated = true) {
  for (const auto& [index, sub_index, bytes, access, value] : entries) {
    char place[16];
    std::snprintf(place, sizeof place, "%04Xh:%02X", static_cast<unsigned>(index), static_cast<unsigned>(sub_index));
    SCOPED_TRACE(place);
    const unsigned upload = size_indicated ? 0x43 | unused(bytes) : 0x42;
    EXPECT_EQ(device.ask(sdo("605", 0x40, index, sub_index, 0)), sdo("585", upload, index, sub_index, value));
    const std::string answer = device.ask(sdo("605", 0x23 | unused(bytes), index, sub_index, value));
    const std::string refusal = sdo("585", 0x80, index, sub_index, 0x0601'0002);
    if (access == ro) {
      EXPECT_EQ(answer, refusal);
    } else {
      EXPECT_NE(answer, refusal);
    }
  }
}

/// Writes a value of this many bytes and returns the answer.
template <class Bench>
std::string write(Bench& device, std::uint16_t index, std::uint8_t sub_index, unsigned bytes, std::uint32_t value) {
  return device.ask(sdo("605", 0x23 | unused(bytes), index, sub_index, value));
}

/// The answers to a write.
inline std::string taken(std::uint16_t index, std::uint8_t sub_index) { return sdo("585", 0x60, index, sub_index, 0); }
inline std::string refused(std::uint16_t index, std::uint8_t sub_index, std::uint32_t code) {
  return sdo("585", 0x80, index, sub_index, code);
}

}  // namespace manual

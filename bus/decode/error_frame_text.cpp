#include "decode/error_frame_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>

namespace edsc {
namespace {

struct Flag {
  std::uint32_t bit;
  std::string_view text;
};

constexpr std::uint32_t lost_arbitration = 0x002, controller = 0x004, protocol = 0x008, transceiver = 0x010,
                        counters = 0x200;

constexpr Flag classes[] = {
    {0x001, "transmission timed out"},
    {lost_arbitration, "arbitration lost"},
    {controller, "controller"},
    {protocol, "protocol violation"},
    {transceiver, "transceiver"},
    {0x020, "no acknowledgement"},
    {0x040, "bus off"},
    {0x080, "bus error"},
    {0x100, "controller restarted"},
};

constexpr Flag controller_states[] = {
    {0x01, "receive buffer overflow"},
    {0x02, "transmit buffer overflow"},
    {0x04, "warning level of receive errors"},
    {0x08, "warning level of transmit errors"},
    {0x10, "error passive by receive errors"},
    {0x20, "error passive by transmit errors"},
    {0x40, "error active again"},
};

constexpr Flag violations[] = {
    {0x01, "single bit"},
    {0x02, "frame format"},
    {0x04, "bit stuffing"},
    {0x08, "dominant bit not sent"},
    {0x10, "recessive bit not sent"},
    {0x20, "bus overload"},
    {0x40, "active error announcement"},
    {0x80, "while sending"},
};

/// Locations in the frame; values, not bits.
constexpr Flag places[] = {
    {0x02, "ID bits 28..21"},
    {0x03, "start of frame"},
    {0x04, "SRR bit"},
    {0x05, "IDE bit"},
    {0x06, "ID bits 20..18"},
    {0x07, "ID bits 17..13"},
    {0x08, "CRC"},
    {0x09, "reserved bit 0"},
    {0x0A, "data"},
    {0x0B, "length"},
    {0x0C, "RTR bit"},
    {0x0D, "reserved bit 1"},
    {0x0E, "ID bits 4..0"},
    {0x0F, "ID bits 12..5"},
    {0x12, "intermission"},
    {0x18, "CRC delimiter"},
    {0x19, "acknowledge slot"},
    {0x1A, "end of frame"},
    {0x1B, "acknowledge delimiter"},
};

constexpr Flag wires[] = {
    {0x04, "no wire at CAN_H"},        {0x05, "CAN_H shorted to battery"}, {0x06, "CAN_H shorted to supply"},
    {0x07, "CAN_H shorted to ground"}, {0x40, "no wire at CAN_L"},         {0x50, "CAN_L shorted to battery"},
    {0x60, "CAN_L shorted to supply"}, {0x70, "CAN_L shorted to ground"},  {0x80, "CAN_L shorted to CAN_H"},
};

/// ` (a, b)`; empty if no bit is set.
void append_flags(std::string& text, std::span<const Flag> flags, std::uint32_t value) {
  const char* separator = " (";
  for (const Flag& flag : flags) {
    if ((value & flag.bit) == 0) continue;
    text += separator;
    text += flag.text;
    separator = ", ";
  }
  if (*separator == ',') text += ')';
}

void append_named(std::string& text, std::string_view before, std::span<const Flag> rows, std::uint8_t value) {
  for (const Flag& row : rows) {
    if (row.bit != value) continue;
    text += before;
    text += row.text;
  }
}

void append_details(std::string& text, std::uint32_t error_class, const canopen::Frame& frame) {
  switch (error_class) {
    case lost_arbitration:
      if (frame.data[0] != 0) fmt::format_to(std::back_inserter(text), " at bit {}", frame.data[0]);
      return;
    case controller: return append_flags(text, controller_states, frame.data[1]);
    case protocol:
      append_flags(text, violations, frame.data[2]);
      return append_named(text, " at ", places, frame.data[3]);
    case transceiver: return append_named(text, ", ", wires, frame.data[4]);
    default: return;
  }
}

}  // namespace

void append_error_frame_text(std::string& text, const canopen::Frame& frame) {
  const char* separator = "";
  for (const Flag& row : classes) {
    if ((frame.id & row.bit) == 0) continue;
    text += separator;
    text += row.text;
    append_details(text, row.bit, frame);
    separator = "; ";
  }
  if (*separator == '\0') text += "error frame";
  if ((frame.id & counters) != 0 || frame.data[6] != 0 || frame.data[7] != 0) {
    fmt::format_to(std::back_inserter(text), "; {} transmit and {} receive errors", frame.data[6], frame.data[7]);
  }
}

}  // namespace edsc

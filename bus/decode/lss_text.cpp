#include "decode/lss_text.hpp"

#include <fmt/format.h>

#include <canopen/lss/lss_protocol.hpp>
#include <iterator>
#include <string_view>

#include "values/append.hpp"

namespace edsc {
namespace {

using canopen::lss::Command;

/// The data after the text of a command.
enum class Content : std::uint8_t {
  nothing,
  mode,        ///< byte 1: waiting or configuration
  node_id,     ///< byte 1
  bit_timing,  ///< bytes 1, 2: table and index
  error,       ///< bytes 1, 2: error code and specific error
  fastscan,    ///< ID number, bit check, part, next part
};

struct LssRow {
  Command command;
  bool from_master;
  Content content;
  std::string_view words;  ///< {0} is the number in bytes 1 to 4, {1} that in bytes 1 and 2
};

constexpr LssRow rows[] = {
    {Command::switch_state_global, true, Content::mode, "switch state global: "},
    {Command::select_vendor_id, true, Content::nothing, "switch state selective: vendor-ID {0:08X}h"},
    {Command::select_product_code, true, Content::nothing, "switch state selective: product code {0:08X}h"},
    {Command::select_revision_number, true, Content::nothing, "switch state selective: revision number {0:08X}h"},
    {Command::select_serial_number, true, Content::nothing, "switch state selective: serial number {0:08X}h"},
    {Command::selected, false, Content::nothing, "in configuration, selected by its LSS address"},
    {Command::configure_node_id, true, Content::node_id, "configure node-ID "},
    {Command::configure_node_id, false, Content::error, "configure node-ID: "},
    {Command::configure_bit_timing, true, Content::bit_timing, "configure bit timing: "},
    {Command::configure_bit_timing, false, Content::error, "configure bit timing: "},
    {Command::activate_bit_timing, true, Content::nothing, "activate bit timing: switch delay {1} ms"},
    {Command::store_configuration, true, Content::nothing, "store configuration"},
    {Command::store_configuration, false, Content::error, "store configuration: "},
    {Command::inquire_vendor_id, true, Content::nothing, "inquire vendor-ID"},
    {Command::inquire_vendor_id, false, Content::nothing, "vendor-ID {0:08X}h"},
    {Command::inquire_product_code, true, Content::nothing, "inquire product code"},
    {Command::inquire_product_code, false, Content::nothing, "product code {0:08X}h"},
    {Command::inquire_revision_number, true, Content::nothing, "inquire revision number"},
    {Command::inquire_revision_number, false, Content::nothing, "revision number {0:08X}h"},
    {Command::inquire_serial_number, true, Content::nothing, "inquire serial number"},
    {Command::inquire_serial_number, false, Content::nothing, "serial number {0:08X}h"},
    {Command::inquire_node_id, true, Content::nothing, "inquire node-ID"},
    {Command::inquire_node_id, false, Content::node_id, "node-ID "},
    {Command::identify_vendor_id, true, Content::nothing, "identify remote slave: vendor-ID {0:08X}h"},
    {Command::identify_product_code, true, Content::nothing, "identify remote slave: product code {0:08X}h"},
    {Command::identify_revision_number_low, true, Content::nothing,
     "identify remote slave: revision number from {0:08X}h"},
    {Command::identify_revision_number_high, true, Content::nothing,
     "identify remote slave: revision number to {0:08X}h"},
    {Command::identify_serial_number_low, true, Content::nothing, "identify remote slave: serial number from {0:08X}h"},
    {Command::identify_serial_number_high, true, Content::nothing, "identify remote slave: serial number to {0:08X}h"},
    {Command::identified, false, Content::nothing, "identified"},
    {Command::identify_non_configured, true, Content::nothing, "identify slaves without node-ID"},
    {Command::identified_non_configured, false, Content::nothing, "a slave without node-ID"},
    {Command::fastscan, true, Content::fastscan, "fastscan: "},
};

constexpr std::string_view address_parts[] = {"vendor-ID", "product code", "revision number", "serial number"};

void append_bit_timing(std::string& text, std::uint8_t table, std::uint8_t index) {
  if (table == 0 && index < std::size(canopen::lss::bit_rates) && canopen::lss::bit_rates[index] != 0) {
    append_decimal(text, canopen::lss::bit_rates[index]);
    text += " kbit/s";
  } else if (table == 0 && index == canopen::lss::automatic_bit_rate) {
    text += "automatic bit rate detection";
  } else {
    fmt::format_to(std::back_inserter(text), "index {} of table {}", index, table);
  }
}

std::string_view error_words(Command command, std::uint8_t code) {
  if (code == 0) return "done";
  if (code == canopen::lss::implementation_specific) return "refused, manufacturer-specific error";
  if (command == Command::configure_node_id && code == 1) return "refused, node-ID out of range";
  if (command == Command::configure_bit_timing && code == 1) return "refused, bit timing not supported";
  if (command == Command::store_configuration && code == 1) return "refused, not supported";
  if (command == Command::store_configuration && code == 2) return "refused, storage access failed";
  return "refused, unknown error";
}

void append_fastscan(std::string& text, const canopen::Frame& frame) {
  const std::uint8_t bit = frame.data[5], part = frame.data[6], next = frame.data[7];
  if (bit == canopen::lss::fastscan_reset) {
    text += "slaves without node-ID answer";
    return;
  }
  const auto name = [](std::uint8_t number) {
    return number < std::size(address_parts) ? address_parts[number] : std::string_view{"an unknown number"};
  };
  fmt::format_to(std::back_inserter(text), "{} {:08X}h from bit {} up, then {}", name(part),
                 canopen::lss::word_of(frame), bit, name(next));
}

void append_content(std::string& text, const LssRow& row, const canopen::Frame& frame) {
  switch (row.content) {
    case Content::nothing: return;
    case Content::mode:
      text += frame.data[1] == 0 ? "waiting" : frame.data[1] == 1 ? "configuration" : "an unknown mode";
      return;
    case Content::node_id:
      append_decimal(text, frame.data[1]);
      if (frame.data[1] == canopen::unconfigured_node_id.value()) text += " (none)";
      return;
    case Content::bit_timing: return append_bit_timing(text, frame.data[1], frame.data[2]);
    case Content::error:
      text += error_words(row.command, frame.data[1]);
      if (frame.data[1] != 0) fmt::format_to(std::back_inserter(text), " ({}, {})", frame.data[1], frame.data[2]);
      return;
    case Content::fastscan: return append_fastscan(text, frame);
  }
}

}  // namespace

bool append_lss_text(std::string& text, const canopen::Frame& frame, bool from_master) {
  if (frame.remote || frame.size != 8) {
    text += "not an LSS message, which has 8 bytes";
    return false;
  }
  for (const LssRow& row : rows) {
    if (row.command != static_cast<Command>(frame.data[0]) || row.from_master != from_master) continue;
    const std::uint32_t word = canopen::lss::word_of(frame);
    fmt::format_to(std::back_inserter(text), fmt::runtime(row.words), word, word & 0xFFFF);
    append_content(text, row, frame);
    return true;
  }
  fmt::format_to(std::back_inserter(text), "unknown command {:02X}h", frame.data[0]);
  return false;
}

}  // namespace edsc

#include "trace.hpp"

#include <fmt/format.h>

#include <bit>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>

namespace demo {
namespace {

using canopen::DataClass;
using canopen::Frame;

std::string hex_bytes(const Frame& frame) {
  std::string text;
  for (unsigned i = 0; i < frame.size; ++i) text += fmt::format("{:02X} ", frame.data[i]);
  return text;
}

std::string number_text(std::uint64_t raw, unsigned bits, const canopen::DataTypeRow* type) {
  if (type == nullptr) return fmt::format("{:X}h", raw);
  switch (type->kind) {
    case DataClass::signed_integer: {
      const unsigned unused = 64 - bits;
      return fmt::format("{}", static_cast<std::int64_t>(raw << unused) >> unused);
    }
    case DataClass::real:
      if (bits == 32) return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
      return fmt::format("{}", std::bit_cast<double>(raw));
    case DataClass::boolean: return raw != 0 ? "true" : "false";
    case DataClass::unsigned_integer:
    case DataClass::time:
    case DataClass::domain:
    case DataClass::string: break;
  }
  return raw < 10 ? fmt::format("{}", raw) : fmt::format("{} ({:X}h)", raw, raw);
}

/// Bits of the data of a frame, as a number.
std::uint64_t bits_of(const Frame& frame, unsigned offset, unsigned bits) {
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < bits; ++i) {
    const unsigned at = offset + i;
    raw |= static_cast<std::uint64_t>((frame.data[at / 8] >> (at % 8)) & 1u) << i;
  }
  return raw;
}

std::string entry_name(const KnownNode& node, std::uint16_t index, std::uint8_t sub_index) {
  const auto* row = canopen::find_description(node.names, index, sub_index);
  if (row == nullptr) return fmt::format("{:04X}h:{:02X}", index, sub_index);
  return fmt::format("{:04X}h:{:02X} {}{}{}", index, sub_index, row->object, row->entry.empty() ? "" : ", ",
                     row->entry);
}

const canopen::DataTypeRow* entry_type(const KnownNode& node, std::uint16_t index, std::uint8_t sub_index) {
  const auto* row = canopen::find_description(node.names, index, sub_index);
  return row == nullptr ? nullptr : canopen::find_data_type(static_cast<std::uint32_t>(row->type));
}

std::string expedited_value(const Frame& frame, const canopen::DataTypeRow* type, bool sized) {
  unsigned bytes = sized ? 4u - ((frame.data[0] >> 2) & 3u) : 4u;
  if (!sized && type != nullptr && type->bits > 0) bytes = std::min(bytes, (type->bits + 7u) / 8u);
  if (type != nullptr && type->kind == DataClass::string) {
    return fmt::format("\"{}\"", std::string(reinterpret_cast<const char*>(&frame.data[4]), bytes));
  }
  return number_text(bits_of(frame, 32, bytes * 8), bytes * 8, type);
}

std::string segment_text(const Frame& frame) {
  const unsigned bytes = 7u - ((frame.data[0] >> 1) & 7u);
  std::string text;
  for (unsigned i = 1; i <= bytes; ++i) {
    const char c = static_cast<char>(frame.data[i]);
    text += c >= 0x20 && c < 0x7F ? c : '.';
  }
  return fmt::format("\"{}\"{}", text, (frame.data[0] & 1) != 0 ? ", the last" : "");
}

std::uint16_t index_of(const Frame& frame) { return static_cast<std::uint16_t>(frame.data[1] | (frame.data[2] << 8)); }

std::string abort_text(const Frame& frame) {
  const auto code = static_cast<std::uint32_t>(bits_of(frame, 32, 32));
  return fmt::format("abort {:04X} {:04X}h {}", code >> 16, code & 0xFFFF,
                     canopen::to_text(canopen::abort_code_from(code)));
}

std::string_view state_name(unsigned state) {
  switch (state) {
    case 0: return "boot-up";
    case 4: return "Stopped";
    case 5: return "Operational";
    case 127: return "Pre-operational";
    default: return "unknown state";
  }
}

std::string_view command_name(unsigned command) {
  switch (command) {
    case 1: return "start";
    case 2: return "stop";
    case 128: return "enter Pre-operational";
    case 129: return "reset node";
    case 130: return "reset communication";
    default: return "unknown command";
  }
}

}  // namespace

void Trace::print(const Frame& frame, canopen::TimePoint now) {
  ++frames_;
  const std::string text = meaning(frame);
  if (!on_) return;
  fmt::print("{:>9.3f} ms  {:03X}  {:<24} {}\n", now.since_start().count() / 1000.0, frame.id, hex_bytes(frame), text);
}

std::string Trace::meaning(const Frame& frame) {
  if (frame.id == canopen::function_code::nmt && frame.size >= 2) {
    const std::string who = frame.data[1] == 0 ? "all nodes" : fmt::format("node {}", frame.data[1]);
    return fmt::format("NMT    {} {}", command_name(frame.data[0]), who);
  }
  if (frame.id == canopen::function_code::sync) return "SYNC";
  const auto id = static_cast<std::uint8_t>(frame.id & 0x7F);
  const auto known = nodes_.find(id);
  if (known == nodes_.end()) return "";
  const KnownNode& node = known->second;
  switch (frame.id & 0x780) {
    case canopen::function_code::emcy: return fmt::format("EMCY   {}", node.name);
    case canopen::function_code::error_control:
      return fmt::format("{} {} {}", frame.data[0] == 0 ? "BOOT  " : "HEART ", node.name,
                         state_name(frame.data[0] & 0x7Fu));
    case canopen::function_code::sdo_request: return "SDO >  " + sdo_request(frame, node, id);
    case canopen::function_code::sdo_response: return "SDO <  " + sdo_response(frame, node, id);
    case 0x180:
    case 0x280:
    case 0x380:
    case 0x480: return pdo(frame, node, true, static_cast<std::uint16_t>((frame.id & 0x780) / 0x100));
    case 0x200:
    case 0x300:
    case 0x400:
    case 0x500: return pdo(frame, node, false, static_cast<std::uint16_t>((frame.id & 0x780) / 0x100 - 1));
    default: return "";
  }
}

std::string Trace::sdo_request(const Frame& frame, const KnownNode& node, std::uint8_t id) {
  const unsigned command = frame.data[0] >> 5;
  Mux& open = open_sdo_[id];
  if (command == 1 || command == 2) open = {index_of(frame), frame.data[3]};
  const std::string entry = entry_name(node, open.index, open.sub_index);
  switch (command) {
    case 0: return fmt::format("{} segment {}", node.name, segment_text(frame));
    case 1: {
      const bool expedited = (frame.data[0] & 2) != 0;
      if (!expedited) return fmt::format("{} write {}, {} bytes", node.name, entry, bits_of(frame, 32, 32));
      const auto* type = entry_type(node, open.index, open.sub_index);
      return fmt::format("{} write {} = {}", node.name, entry, expedited_value(frame, type, (frame.data[0] & 1) != 0));
    }
    case 2: return fmt::format("{} read {}", node.name, entry);
    case 3: return fmt::format("{} next segment", node.name);
    case 4: return fmt::format("{} {}", node.name, abort_text(frame));
    default: return fmt::format("{} ?", node.name);
  }
}

std::string Trace::sdo_response(const Frame& frame, const KnownNode& node, std::uint8_t id) {
  const Mux open = open_sdo_[id];
  const std::string entry = entry_name(node, open.index, open.sub_index);
  switch (frame.data[0] >> 5) {
    case 0: return fmt::format("{} segment {}", node.name, segment_text(frame));
    case 1: return fmt::format("{} segment confirmed", node.name);
    case 2: {
      const bool expedited = (frame.data[0] & 2) != 0;
      if (!expedited) return fmt::format("{} {}: {} bytes follow", node.name, entry, bits_of(frame, 32, 32));
      const auto* type = entry_type(node, open.index, open.sub_index);
      return fmt::format("{} {} = {}", node.name, entry, expedited_value(frame, type, (frame.data[0] & 1) != 0));
    }
    case 3: return fmt::format("{} {} written", node.name, entry);
    case 4: return fmt::format("{} {}: {}", node.name, entry, abort_text(frame));
    default: return fmt::format("{} ?", node.name);
  }
}

std::string Trace::pdo(const Frame& frame, const KnownNode& node, bool transmit, std::uint16_t number) const {
  std::string text = fmt::format("{}{:<2} {}", transmit ? "TPDO" : "RPDO", number, node.name);
  for (const PdoDescription& pdo : node.pdos) {
    if (pdo.transmit != transmit || pdo.number != number) continue;
    const char* separator = ": ";
    for (const PdoField& field : pdo.fields) {
      if ((field.offset + field.bits + 7) / 8 > frame.size) break;
      const auto* row = canopen::find_description(node.names, field.index, field.sub_index);
      text += fmt::format("{}{} = {}", separator, row == nullptr ? "(dummy)" : row->name(),
                          number_text(bits_of(frame, field.offset, field.bits), field.bits,
                                      entry_type(node, field.index, field.sub_index)));
      separator = ", ";
    }
  }
  return text;
}

}  // namespace demo

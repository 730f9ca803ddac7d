#include "decode/services.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/data_type.hpp>
#include <iterator>

#include "decode/error_register_text.hpp"
#include "device/error_code_text.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/nmt_text.hpp"
#include "values/value_text.hpp"

namespace edsc {

using canopen::Frame;

void wrong_length(const Frame& frame, std::string_view right, Message& message) {
  message.problem = true;
  if (frame.remote) {
    message.text += "a remote frame, not a frame with data";
  } else {
    fmt::format_to(std::back_inserter(message.text), "{}, not {}", counted(unsigned{frame.size}, "byte"), right);
  }
}

void decode_nmt(const Frame& frame, Message& message) {
  message.service = Service::nmt;
  if (frame.remote || frame.size < 2) return wrong_length(frame, "the 2 of a command", message);
  message.node_id = frame.data[1];
  const auto command = static_cast<canopen::NmtCommand>(frame.data[0]);
  if (const NmtCommandText* row = find_nmt_command(&NmtCommandText::command, command)) {
    message.command = command;
    message.text += row->text;
  } else {
    fmt::format_to(std::back_inserter(message.text), "unknown command {}", frame.data[0]);
    message.problem = true;
  }
  if (message.node_id == 0) message.text += ", all nodes";
}

void decode_sync(const Frame& frame, Message& message) {
  message.service = Service::sync;
  if (frame.remote || frame.size > 1) return wrong_length(frame, "0 or 1", message);
  if (frame.size == 0) return;
  message.counter = frame.data[0];
  message.text += "counter ";
  append_decimal(message.text, frame.data[0]);
  constexpr std::uint8_t max_counter = 240;  // CiA 301, 7.2.5.2.2
  if (message.counter >= 1 && message.counter <= max_counter) return;
  message.problem = true;
  message.text += ", which is not 1 to 240";
}

void decode_time(const Frame& frame, Message& message) {
  message.service = Service::time;
  if (frame.remote || frame.size < 6) return wrong_length(frame, "6", message);
  const auto* type = canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::time_of_day));
  const std::uint64_t number = number_of(data_of(frame));
  append_number(message.text, *type, number, type->bits);
  constexpr std::uint64_t milliseconds = 0x0FFF'FFFF;  // CiA 301, 7.1.6.6: 28 bits, since midnight
  constexpr std::uint64_t day = std::uint64_t{24} * 60 * 60 * 1000;
  if ((number & milliseconds) < day) return;
  message.problem = true;
  message.text += ", which is after the end of the day";
}

void decode_emcy(const Frame& frame, const Device* device, Message& message) {
  message.service = Service::emcy;
  if (frame.remote || frame.size < 3) return wrong_length(frame, "8", message);
  message.error_code = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
  message.error_register = frame.data[2];
  message.problem = is_error(device, message.error_code);
  message.error_text = error_code_text(device, message.error_code);
  append_hex_number(message.text, message.error_code, 4);
  message.text += ' ';
  message.text += message.error_text;
  message.text += ", error register ";
  append_hex_number(message.text, message.error_register, 2);
  message.text += " (";
  append_error_register(message.text, message.error_register);
  message.text += ')';
  const auto manufacturer = data_of(frame).subspan(3);
  if (std::ranges::any_of(manufacturer, [](std::uint8_t byte) { return byte != 0; })) {
    message.text += ", manufacturer ";
    append_hex_bytes(message.text, manufacturer);
  }
}

}  // namespace edsc

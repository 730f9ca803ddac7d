#include "server/candump_line.hpp"

#include <algorithm>

#include "values/append.hpp"

namespace edsc {

std::string candump_line(const canopen::Frame& frame, std::string_view bus, socketcand::TimeStamp time) {
  std::string line{"("};
  socketcand::append_time(line, time);
  line.append(") ").append(bus).append(" ");
  append_can_id(line, frame);
  line += frame.remote ? "#R" : "#";
  if (frame.remote && frame.size > 0) append_decimal(line, frame.size);
  append_hex_bytes(line, data_of(frame), "");
  return line;
}

std::string interface_of(std::string_view bus) {
  std::string_view name = bus.substr(0, bus.find('@'));
  name.remove_prefix(name.find_last_of("/:") + 1);
  return std::string{is_interface_name(name) ? name : "can0"};
}

bool is_interface_name(std::string_view name) {
  constexpr std::size_t max_length = 15;
  return !name.empty() && name.size() <= max_length &&
         std::ranges::all_of(name, [](unsigned char c) { return c > ' ' && c < 0x7F; });
}

}  // namespace edsc

#include "server/candump_line.hpp"

#include <algorithm>

namespace edsc {

std::string candump_line(const canopen::Frame& frame, std::string_view bus, socketcand::TimeStamp time) {
  socketcand::ElementText stamp;
  stamp.add_time(time);
  socketcand::ElementText text;
  text.add_id(frame);
  text.add('#');
  if (frame.remote) text.add('R');
  if (frame.remote && frame.size > 0) text.add_hex(frame.size, 1);
  for (std::size_t i = 0; !frame.remote && i < frame.size; ++i) text.add_hex(frame.data[i], 2);
  std::string line{"("};
  line.append(stamp.view()).append(") ").append(bus).append(" ").append(text.view());
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

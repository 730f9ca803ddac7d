#include "bus_server/candump_line.hpp"

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

}  // namespace edsc

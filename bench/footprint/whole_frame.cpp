/// Calls of an Operational node, from the frame that it receives to the one that it sends: an RPDO that is applied at
/// the next SYNC, an expedited upload and download of an application object, and `on_time` with nothing due.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

struct Mailbox {
  volatile std::uint32_t id;
  volatile std::uint32_t words[2];
};
Mailbox mailbox;

[[gnu::noinline]] bool transmit(const canopen::Frame& frame) {
  const canopen::FrameWords words = canopen::words_of(frame);
  mailbox.id = frame.id;
  mailbox.words[0] = words.first;
  mailbox.words[1] = words.second;
  return true;
}

struct Can {
  static bool send(const canopen::Frame& frame) { return transmit(frame); }
};
Can can;

constinit auto node = canopen::make_node<device::Device>(can);
constexpr canopen::TimePoint start{};
constexpr canopen::TimePoint later{canopen::Duration{1}};

}  // namespace

void program() {
  start_counter();
  node.start(canopen::NodeId{5}, start);
  const auto receive = [](std::uint32_t id, std::uint8_t size, std::uint32_t first, std::uint32_t second) {
    node.on_frame(canopen::make_frame(id, size, {first, second}), later);
  };
  receive(0x000, 2, 0x0501, 0);  // NMT: start node 5
  node.on_time(start);
  print_mean("on-time", [](std::uint32_t) { node.on_time(later); });
  print_mean("rpdo", [=](std::uint32_t) { receive(0x305, 8, 1, 2); });
  print_mean("upload", [=](std::uint32_t) { receive(0x605, 8, 0x0060'8340, 0); });          // 6083h
  print_mean("download", [=](std::uint32_t i) { receive(0x605, 8, 0x0060'8323, i + 1); });  // with a new value
  end_program();
}

/// A complete node as in firmware, with one mailbox for each direction.
#include "../cortex_m/startup.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

/// A CAN controller with one transmit and one receive mailbox.
struct Mailbox {
  volatile std::uint32_t status;  ///< 1: transmit mailbox full, 2: receive mailbox full
  volatile std::uint32_t id;
  volatile std::uint32_t size;
  volatile std::uint32_t data[2];
};
constexpr std::uintptr_t controller = 0x4000'6400;
constexpr std::uintptr_t timer = 0x4000'0024;

Mailbox& transmit() { return *reinterpret_cast<Mailbox*>(controller); }
Mailbox& receive() { return *reinterpret_cast<Mailbox*>(controller + sizeof(Mailbox)); }

struct Can {
  static bool send(const canopen::Frame& frame) {
    Mailbox& box = transmit();
    if ((box.status & 1) != 0) return false;
    const canopen::FrameWords words = canopen::words_of(frame);
    box.id = frame.id;
    box.data[0] = words.first;
    box.data[1] = words.second;
    box.size = frame.size;
    return true;
  }
};
Can can;

constinit auto node = canopen::make_node<device::Device>(can);

canopen::TimePoint now() {
  return canopen::TimePoint{canopen::Duration{*reinterpret_cast<volatile std::uint32_t*>(timer)}};
}

}  // namespace

void program() {
  node.start(canopen::NodeId{5}, now());
  for (;;) {
    Mailbox& box = receive();
    if ((box.status & 2) != 0) {
      node.on_frame(canopen::make_frame(box.id, static_cast<std::uint8_t>(box.size), {box.data[0], box.data[1]}),
                    now());
    }
    node.on_time(now());
  }
}

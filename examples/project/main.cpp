/// A valve: an SDO client opens it.
#include <canopen/node.hpp>
#include <valve/device.hpp>

/// Replaces a CAN controller; drivers are in canopen/port/.
struct Can {
  canopen::Frame last{};
  bool send(const canopen::Frame& frame) { return last = frame, true; }
};

int main() {
  Can can;
  auto node = canopen::make_node<valve::Device>(can, canopen::NodeId{5});
  node.start(canopen::TimePoint{});
  node.on_frame({.id = 0x605, .size = 8, .data = {0x2F, 0x00, 0x20, 0x00, 50}}, canopen::TimePoint{});
  return node.get<valve::od::opening>() == 50 && can.last.id == 0x585 ? 0 : 1;
}

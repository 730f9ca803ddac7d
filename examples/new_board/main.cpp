/// Firmware of the pump of examples/first_device: its application class, with SLCAN on the serial line of the board.
#include <canopen/node.hpp>
#include <pump/device.hpp>

#include "board.hpp"
#include "pump.hpp"
#include "serial_bus.hpp"

constinit SerialBus bus;
canopen::Node<PumpParts, SerialBus> node{bus};

int main() {
  board::start();
  node.start(canopen::NodeId{EDSC_NODE_ID}, board::now());
  for (;;) {
    while (const auto frame = bus.receive()) node.on_frame(*frame, board::now());
    node.on_time(board::now());
  }
}

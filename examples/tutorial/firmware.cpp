/// The pump on a board, with SLCAN on its serial line in place of a CAN controller.
#include "board.hpp"
#include "pump.hpp"
#include "serial_bus.hpp"

namespace {

constinit SerialBus bus;
auto node = canopen::make_node<PumpParts>(bus);

}  // namespace

int main() {
  board::start();
  node.start(canopen::NodeId{EDSC_NODE_ID}, board::now());
  for (;;) {
    if (const auto frame = bus.receive()) node.on_frame(*frame, board::now());
    node.on_time(board::now());
  }
}

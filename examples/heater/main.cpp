/// The heater as node 5 on a SocketCAN interface: `heater can0`.
#include <canopen/host/socketcan.hpp>

#include "heater.hpp"

int main(int, char** arguments) {
  canopen::SocketCan bus{arguments[1]};
  canopen::Node<HeaterParts, canopen::SocketCan> node{bus, canopen::NodeId{5}};
  bus.run(node);
}

/// The pump as node 5 on a bus: `pump_node BUS`.
#include <canopen/host/host_bus.hpp>
#include <cstdio>

#include "pump.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  canopen::HostBus bus{argv[1]};
  canopen::Node<pump::Device, canopen::HostBus, Pump> node{bus, canopen::NodeId{5}};
  std::puts("node 5 is on the bus");
  std::fflush(stdout);
  bus.run(node);
}

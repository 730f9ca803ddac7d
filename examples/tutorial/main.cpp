/// The pump as node 5 on a bus: `pump_node BUS`.
#include <canopen/host/host_bus.hpp>
#include <cstdio>
#include <exception>

#include "pump.hpp"

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: pump_node BUS\n", stderr), 2;
  canopen::HostBus bus{argv[1]};
  canopen::Node<PumpParts, canopen::HostBus> node{bus, canopen::NodeId{5}};
  std::puts("node 5 is on the bus");
  std::fflush(stdout);
  bus.run(node);
} catch (const std::exception& problem) {
  std::fprintf(stderr, "pump_node: %s\n", problem.what());
  return 1;
}

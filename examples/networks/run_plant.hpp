/// The `main` of the master of a plant: `PROGRAM BUS` until SIGINT or SIGTERM. Prints what happens to the nodes.
#pragma once

#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <canopen_plant/plant_text.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

namespace run_plant_detail {

inline std::atomic<bool> stop{false};

}  // namespace run_plant_detail

inline void print_line(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

/// Prints boot-ups and faults by the names of the network file.
template <class Plant>
void print_events(Plant& plant) {
  plant.on_booted = [](const canopen::PlantNode& node) { print_line(std::string{node.name} + ": booted"); };
  plant.on_fault = [](const canopen::PlantNode& node, const canopen::PlantFault& fault) {
    print_line(fault_text(node, fault, Plant::Network::places, Plant::Network::errors));
  };
}

/// `Control` is constructed with the bus, and has the member `plant`.
template <template <class Bus> class Control>
int run_plant(int argc, char** argv) {
  using run_plant_detail::stop;
  if (argc != 2) {
    std::fprintf(stderr,
                 "usage: %s BUS\nBUS is socketcan:can0, slcan:/dev/ttyACM0 or socketcand:127.0.0.1:29536/vcan0\n",
                 argv[0]);
    return 2;
  }
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  try {
    canopen::HostBus bus{argv[1]};
    Control<canopen::HostBus> control{bus};
    print_events(control.plant);
    bus.run(control.plant, stop);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[0], problem.what());
    return 1;
  }
  return 0;
}

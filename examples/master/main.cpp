/// The master of the plant on a bus of the host: `master BUS` until SIGINT or SIGTERM.
#include <atomic>
#include <canopen/port/host_bus.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>

#include "plant_master.hpp"

namespace {

std::atomic<bool> stop{false};

void log(std::string_view line) {
  std::printf("%.*s\n", static_cast<int>(line.size()), line.data());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || std::string_view{argv[1]}.starts_with('-')) {
    std::fprintf(stderr,
                 "usage: %s BUS\nBUS is socketcan:vcan0, slcan:/dev/ttyACM0 or socketcand:127.0.0.1:29536/vcan0\n",
                 argv[0]);
    return 2;
  }
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  std::optional<canopen::HostBus> bus;
  try {
    bus.emplace(argv[1]);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[0], problem.what());
    return 2;
  }
  try {
    PlantMaster<canopen::HostBus> plant{*bus, log};
    plant.start();
    while (!stop) plant.run_cycle();
    std::printf("inputs were as the outputs in %u cycles, otherwise in %u\n", plant.agreed(), plant.differed());
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[0], problem.what());
    return 1;
  }
  return 0;
}

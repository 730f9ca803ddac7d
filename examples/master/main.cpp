/// The master of the plant on a bus of the host: `master BUS [CYCLE_MS]` until SIGINT or SIGTERM.
#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>
#include <system_error>

#include "plant_master.hpp"

namespace {

std::atomic<bool> stop{false};

void log(std::string_view line) {
  std::printf("%.*s\n", static_cast<int>(line.size()), line.data());
  std::fflush(stdout);
}

/// A cycle of 10..10000 ms; std::nullopt if the text is not one.
std::optional<canopen::Duration> cycle_of(std::string_view text) {
  std::uint32_t milliseconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), milliseconds);
  if (error != std::errc{} || end != text.data() + text.size() || milliseconds < 10 || milliseconds > 10'000) {
    return std::nullopt;
  }
  return std::chrono::milliseconds{milliseconds};
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<canopen::Duration> cycle = argc == 3 ? cycle_of(argv[2]) : std::optional{usual_cycle};
  if (argc < 2 || argc > 3 || std::string_view{argv[1]}.starts_with('-') || !cycle) {
    std::fprintf(stderr,
                 "usage: %s BUS [CYCLE_MS]\n"
                 "BUS is socketcan:vcan0, slcan:/dev/ttyACM0 or socketcand:127.0.0.1:29536/vcan0\n"
                 "CYCLE_MS, 10..10000, is the cycle in ms, and the guard time; 100 by default\n",
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
    PlantMaster<canopen::HostBus> plant{*bus, log, *cycle};
    plant.start();
    while (!stop) plant.run_cycle();
    std::printf("inputs were as the outputs in %u cycles, otherwise in %u\n", plant.agreed(), plant.differed());
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[0], problem.what());
    return 1;
  }
  return 0;
}

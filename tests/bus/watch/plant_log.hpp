/// A plant of examples/networks in simulated time, as a log of candump: `PROGRAM SECONDS`. Normal operation, with
/// faults that the plant allows: EMCY messages and their ends, SDO reads of a tool, aborted transfers, and PDOs that
/// the recorder has lost, one at a time.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "networks/plant_bench.hpp"

namespace plant_log {

/// The time of the first frame: any date.
inline constexpr std::uint64_t first_second = 1'700'000'000;

class Printer {
 public:
  explicit Printer(std::uint64_t lost_every) : lost_every_{lost_every} {}

  void print(const canopen::Frame& frame, std::uint64_t us) {
    const bool is_pdo = frame.id > 0x180 && frame.id < 0x580;
    if (is_pdo && ++pdos_ % lost_every_ == 0) return;
    std::printf("(%llu.%06llu) can0 %03X#", static_cast<unsigned long long>(first_second + us / 1'000'000),
                static_cast<unsigned long long>(us % 1'000'000), frame.id);
    if (frame.remote) std::printf("R%u", frame.size);
    for (std::size_t i = 0; i < frame.size && !frame.remote; ++i) std::printf("%02X", frame.data[i]);
    std::putchar('\n');
  }

 private:
  std::uint64_t lost_every_, pdos_ = 0;
};

/// The SDO client of a tool, which reads objects and does not look at the responses: one more than the master.
inline canopen::Frame read_request(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub_index) {
  canopen::Frame frame;
  frame.id = 0x600U + node_id;
  frame.size = 8;
  frame.data = {0x40, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub_index, 0, 0, 0, 0};
  return frame;
}

/// `every_second(bench, second)` changes the plant.
template <class Bench, class EverySecond>
int run(int argc, char** argv, std::uint8_t nodes, std::uint64_t lost_every, EverySecond every_second) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SECONDS\n", argv[0]);
    return 2;
  }
  const unsigned long seconds = std::strtoul(argv[1], nullptr, 10);
  Bench bench;
  Printer printer{lost_every};
  bench.bus.listen([&](const canopen::Frame& frame, canopen::TimePoint) { printer.print(frame, bench.bus.elapsed()); });
  canopen::VirtualBus::Endpoint& tool = bench.bus.attach();
  bench.start();
  if (!bench.boot(canopen::Duration{20'000'000})) {
    std::fprintf(stderr, "%s: the plant has not booted\n", argv[0]);
    return 1;
  }
  for (unsigned long second = 0; second < seconds; ++second) {
    every_second(bench, second);
    // A tool reads the identity and the error register; each twentieth object does not exist.
    const auto node_id = static_cast<std::uint8_t>(1 + second / 7 % nodes);
    if (second % 7 == 3) static_cast<void>(tool.send(read_request(node_id, 0x1018, 1)));
    if (second % 7 == 5) static_cast<void>(tool.send(read_request(node_id, second % 20 == 0 ? 0x5FFF : 0x1001, 0)));
    bench.bus.run_for(canopen::Duration{1'000'000});
    bench.forget();
  }
  return 0;
}

}  // namespace plant_log

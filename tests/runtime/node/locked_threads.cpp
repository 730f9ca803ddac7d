/// Two threads set and read objects of a node that a third one runs, all with a mutex, under ThreadSanitizer.
/// `locked_threads [ROUNDS]`
#include <canopen/node.hpp>
#include <canopen/node/locked.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <sample/device.hpp>
#include <thread>

#include "support/omitting.hpp"

namespace {

namespace od = sample::od;

struct CountingBus {
  bool send(const canopen::Frame&) {
    ++frames;
    return true;
  }
  std::uint32_t frames = 0;
};

}  // namespace

int main(int argument_count, char** arguments) {
  const std::uint32_t rounds =
      argument_count > 1 ? static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10)) : 200'000;
  CountingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5});
  std::mutex mutex;
  canopen::Locked locked{node, mutex};
  locked.start(canopen::TimePoint{});
  locked.on_frame(canopen::Frame{.id = 0, .size = 2, .data = {1, 0}}, canopen::TimePoint{});
  bool wrong = false;
  std::thread writer{[&] {
    for (std::uint32_t i = 1; i <= rounds; ++i) {
      (void)locked.set<od::statusword>(static_cast<std::uint16_t>(i));
      (void)locked.set<od::unsigned64_value>(std::uint64_t{i} << 32 | i);
    }
  }};
  std::thread reader{[&] {
    for (std::uint32_t i = 0; i < rounds; ++i) {
      const std::uint64_t value = locked.get<od::unsigned64_value>();
      wrong = wrong || value >> 32 != (value & 0xFFFF'FFFF);
    }
  }};
  while (locked.get<od::unsigned64_value>() >> 32 != rounds) {
    if (locked.next_deadline()) locked.on_time(canopen::TimePoint{});
  }
  writer.join();
  reader.join();
  std::printf("%u rounds, %u frames%s\n", rounds, bus.frames, wrong ? ", a value is torn" : "");
  return wrong || bus.frames < 2 ? 1 : 0;
}

/// Measures the CPU time of a VirtualBus in simulated time with 127 nodes at 1 Mbit/s. `virtual_bus [MINUTES
/// [PERIOD]]`, the period of the most frequent messages in ms. The checksum includes all frames and their times: it
/// must be the same for each kind of endpoints, and in another implementation.
#include <can_2053c/device.hpp>
#include <canopen/node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>

#include "support/omitting.hpp"

namespace {

using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using namespace std::chrono_literals;

/// FNV-1a.
struct Checksum {
  void add(std::uint32_t value) {
    for (unsigned i = 0; i < 4; ++i) sum = (sum ^ ((value >> (8 * i)) & 0xFF)) * 0x100'0000'01B3;
  }
  std::uint64_t sum = 0xCBF2'9CE4'8422'2325;
};

enum class Endpoints : std::uint8_t {
  connected,      ///< with VirtualBus::connect
  own_callbacks,  ///< the bus does not know what they do, and passes all frames
  independent,    ///< after VirtualBus::assume_independent_endpoints
};

template <class Device>
struct Station {
  Station(VirtualBus& bus, std::uint8_t node_id, unsigned period, Endpoints kind)
      : endpoint{bus.attach()}, node{endpoint, NodeId{node_id}} {
    VirtualBus::connect(endpoint, node);
    if (kind != Endpoints::connected)
      endpoint.on_frame = [this](const Frame& frame, TimePoint now) { node.on_frame(frame, now); };
    node.start(bus.now());
    const auto event_timer = static_cast<std::uint16_t>(period + 37 * period * node_id / 1000);
    const std::uint8_t bytes[2] = {static_cast<std::uint8_t>(event_timer), static_cast<std::uint8_t>(event_timer >> 8)};
    (void)node.set(0x1800, 5, bytes);
    (void)node.set(0x1017, 0, bytes);
  }
  VirtualBus::Endpoint& endpoint;
  bench::NodeOf<Device, VirtualBus::Endpoint> node;
};

/// Simulates and prints one line; returns the checksum. `period`: the shortest event timer and heartbeat, in ms; the
/// longest is 5.7 times as long.
std::uint64_t simulate(unsigned minutes, unsigned period, Endpoints kind) {
  VirtualBus bus{1'000'000};
  if (kind == Endpoints::independent) bus.assume_independent_endpoints();
  VirtualBus::Endpoint& master = bus.attach();
  std::deque<Station<cpd::Device>> drives;
  std::deque<Station<can_2053c::Device>> modules;
  std::deque<Station<rk5c::Device>> sensors;
  for (std::uint8_t id = 1; id < 43; ++id) drives.emplace_back(bus, id, period, kind);
  for (std::uint8_t id = 43; id < 86; ++id) modules.emplace_back(bus, id, period, kind);
  for (std::uint8_t id = 86; id < 128; ++id) sensors.emplace_back(bus, id, period, kind);
  std::size_t frames = 0;
  Checksum checksum;
  bus.listen([&](const Frame& frame, TimePoint now) {
    ++frames;
    checksum.add(now.since_start().count());
    checksum.add(frame.id);
    for (std::size_t i = 0; i < frame.size; ++i) checksum.add(frame.data[i]);
  });
  master.send(Frame{.id = 0, .size = 2, .data = {1, 0}});
  const std::clock_t begin = std::clock();
  for (unsigned minute = 0; minute < minutes; ++minute) {
    bus.run_for(1min);
    master.send(Frame{.id = 0x080});
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  constexpr const char* names[] = {"connected nodes", "own callbacks", "independent endpoints"};
  std::printf("%u min, 127 nodes, %s: %zu frames, %.2f s of CPU, %.2f us a frame, checksum %016llx\n", minutes,
              names[static_cast<std::size_t>(kind)], frames, seconds, seconds * 1e6 / static_cast<double>(frames),
              static_cast<unsigned long long>(checksum.sum));
  return checksum.sum;
}

}  // namespace

int main(int count, char** arguments) {
  const auto argument = [&](int position, unsigned otherwise) {
    return count > position ? static_cast<unsigned>(std::strtoul(arguments[position], nullptr, 10)) : otherwise;
  };
  const unsigned minutes = argument(1, 60);
  const unsigned period = argument(2, 1000);
  const std::uint64_t connected = simulate(minutes, period, Endpoints::connected);
  const bool is_same = connected == simulate(minutes, period, Endpoints::independent) &&
                       connected == simulate(minutes, period, Endpoints::own_callbacks);
  return is_same ? 0 : 1;
}

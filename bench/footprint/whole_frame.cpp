/// Calls of an Operational node, from the frame that it receives to those that it sends: SDO, PDOs, a SYNC, and
/// `on_time` with nothing due.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"
#include "counted_bus.hpp"
#include "drive.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

CountedBus bus;
using Parts = canopen::Composition<device::Device, Drive, canopen::without<device::od::blob_1k, device::od::blob_8k>>;
constinit canopen::Node<Parts, CountedBus> node{bus};
constexpr canopen::TimePoint start{};
constexpr canopen::TimePoint later{canopen::Duration{1}};

/// As from a driver: the compiler does not see which frame it is.
[[gnu::noinline]] void receive(std::uint32_t id, std::uint8_t size, std::uint32_t first = 0, std::uint32_t second = 0) {
  node.on_frame(canopen::make_frame(id, size, {first, second}), later);
}

/// Prints a mean of calls each of which must send this number of frames.
template <class F>
void print_sending(const char* name, std::uint32_t frames, F run) {
  const std::uint32_t before = bus.sent();
  run(0);
  if (bus.sent() - before == frames) print_mean(name, run);
}

}  // namespace

void program() {
  start_counter();
  node.start(canopen::NodeId{5}, start);
  receive(0x000, 2, 0x0501);  // NMT: start node 5
  node.on_time(start);
  print_sending("on-time", 0, [](std::uint32_t) { node.on_time(later); });
  print_sending("rpdo", 0, [](std::uint32_t) { receive(0x305, 8, 1, 2); });
  print_sending("foreign", 0, [](std::uint32_t) { receive(0x1A3, 8, 1, 2); });                   // a TPDO of node 35
  print_sending("upload", 1, [](std::uint32_t) { receive(0x605, 8, 0x0060'8440); });             // 6084h
  print_sending("download", 1, [](std::uint32_t i) { receive(0x605, 8, 0x0060'8423, i + 1); });  // with a new value
  print_sending("sync-cycle", 4, [](std::uint32_t i) {
    for (const std::uint32_t id : {0x205u, 0x305u, 0x405u, 0x505u}) receive(id, 8, i, id);
    receive(0x80, 0);
  });
  end_program();
}

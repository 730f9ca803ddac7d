/// SDO transfers of a DOMAIN by an Operational node, from each frame that it receives to those that it sends.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"
#include "counted_bus.hpp"
#include "drive.hpp"
#include "transfers.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <cstring>
#include <device/device.hpp>

namespace {

CountedBus bus;
std::uint8_t memory[domain_bytes];
using Parts = canopen::Composition<device::Device, Drive, canopen::without<device::od::blob_1k>>;
auto node = canopen::make_node<Parts>(bus, canopen::bound_to<device::od::blob_8k>(memory, domain_bytes));
constexpr canopen::TimePoint start{};
constexpr canopen::TimePoint later{canopen::Duration{1}};

/// As from a driver: the compiler does not see which frame it is.
[[gnu::noinline]] void receive(std::uint32_t id, std::uint8_t size, std::uint32_t first, std::uint32_t second) {
  node.on_frame(canopen::make_frame(id, size, {first, second}), later);
}

std::uint8_t exchange(const Bytes& request) {
  std::uint32_t words[2];
  std::memcpy(words, request.data(), sizeof words);
  receive(0x605, 8, words[0], words[1]);
  return bus.last_command();
}

template <class Transfer>
void print_per_byte(const char* name, Transfer transfer) {
  const std::uint32_t before = bus.sent();
  bool is_complete = false;
  const std::uint32_t instructions = count([&] { is_complete = transfer(exchange); });
  if (is_complete && bus.sent() - before > 8) print(name, instructions, domain_bytes);
}

}  // namespace

void program() {
  start_counter();
  node.start(canopen::NodeId{5}, start);
  receive(0x000, 2, 0x0501, 0);  // NMT: start node 5
  node.on_time(start);
  print_per_byte("segmented-upload", [](auto exchange) { return upload_segments(exchange); });
  print_per_byte("segmented-download", [](auto exchange) { return download_segments(exchange); });
  if constexpr (device::Device::options.sdo_block_transfer) {
    print_per_byte("block-upload", [](auto exchange) { return upload_blocks(exchange); });
    print_per_byte("block-download", [](auto exchange) { return download_blocks(exchange); });
  }
  end_program();
}

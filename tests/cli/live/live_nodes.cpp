/// Nodes of live_device.eds on a bus: `live_nodes BUS NODE-ID...` runs them until SIGTERM. 255: a device without
/// node-ID, for LSS. Each prints a line when it is up.
#include <algorithm>
#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <live_device/device.hpp>
#include <string>
#include <thread>
#include <vector>

namespace od = live_device::od;

namespace {

using canopen::AbortCode;
using canopen::NodeId;

std::atomic<bool> stop{false};

/// Stores the settings of LSS. It rejects node-ID 126 and 800 kbit/s, and cannot store node-ID 125.
struct LssPort {
  NodeId node_id;
  canopen::LssBitTiming timing{0, 2};

  canopen::LssError accept(NodeId wanted) {
    return wanted == NodeId{126} ? canopen::lss::node_id_out_of_range : canopen::lss::success;
  }
  canopen::LssError accept(canopen::LssBitTiming wanted) {
    return wanted.index == 1 ? canopen::lss::bit_timing_not_supported : canopen::lss::success;
  }
  canopen::LssError store(NodeId wanted, canopen::LssBitTiming) {
    node_id = wanted;
    return wanted == NodeId{125} ? canopen::lss::storage_access_error : canopen::lss::success;
  }
  canopen::LssBitTiming bit_timing() { return timing; }
  void stop_communication() {}
  void start_communication(canopen::LssBitTiming) {}
};

/// The data that 2000h has received and 2001h sends.
struct Memory {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(3'000, 0xA5);

  AbortCode write(std::uint32_t offset, std::span<const std::uint8_t> piece) {
    bytes.resize(offset);
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return canopen::ok;
  }
  std::uint32_t read(std::uint32_t offset, std::span<std::uint8_t> to) const {
    const std::size_t size = offset < bytes.size() ? std::min(bytes.size() - offset, to.size()) : 0;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(offset, bytes.size())), size,
                to.begin());
    return static_cast<std::uint32_t>(size);
  }
};

void run(const std::string& address, NodeId node_id, std::uint32_t serial_number) {
  canopen::HostBus bus{address};
  canopen::MemoryStorage storage;
  LssPort lss{node_id};
  Memory memory;
  bool up = false;
  auto node = canopen::make_node<live_device::Device>(
      bus, node_id, canopen::stored_in(storage), canopen::configured_by_lss(lss),
      canopen::on_domain_write<od::firmware>(
          [&](std::uint32_t offset, std::span<const std::uint8_t> piece, bool) { return memory.write(offset, piece); }),
      canopen::on_domain_read<od::log>(
          [&](std::uint32_t offset, std::span<std::uint8_t> to) { return memory.read(offset, to); }),
      canopen::on_write<od::speed>([](auto& device, od::speed::type speed) {
        return speed > device.template get<od::maximum_speed>() ? AbortCode::value_too_high : canopen::ok;
      }),
      canopen::on_read<od::rounded_value>(
          [](auto& device) { return static_cast<std::uint16_t>(device.template get<od::rounded_value>() / 10 * 10); }),
      canopen::on_state([&](auto& device, canopen::NmtState) {
        (void)device.template set<od::identity_object::serial_number>(serial_number);  // any value fits
        if (!up) std::printf("node %u is up\n", static_cast<unsigned>(node_id.value()));
        std::fflush(stdout);
        up = true;
      }));
  bus.run(node, stop);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, [](int) { stop = true; });
  std::vector<std::jthread> nodes;
  for (int i = 2; i < argc; ++i) {
    const auto node_id = static_cast<std::uint8_t>(std::atoi(argv[i]));
    nodes.emplace_back([address = std::string{argv[1]}, node_id, i] {
      try {
        run(address, NodeId{node_id}, 0x100 + static_cast<std::uint32_t>(i) - 2);
      } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        std::_Exit(1);
      }
    });
  }
  return 0;
}

/// A node for the tests in the virtual machine: `vm_node BUS NODE-ID [serve]` runs until SIGTERM; with `serve` it uses
/// its own poll loop.
#include <poll.h>

#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <canopen/node.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <every_service/device.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace {

constexpr std::size_t file_bytes = 20'000;

std::atomic<bool> stop{false};

template <class Node>
void serve_in_own_loop(canopen::HostBus& bus, Node& node) {
  node.start(canopen::HostBus::now());
  bus.serve(node);
  while (!stop) {
    pollfd waiting{bus.file_descriptor(), POLLIN, 0};
    if (::poll(&waiting, 1, -1) > 0) bus.serve(node);
  }
}

using Parts =
    canopen::Composition<every_service::Device, canopen::BoundTo<every_service::od::file>,
                         canopen::without<canopen::part::lss, canopen::part::storage, every_service::od::stream>>;

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::signal(SIGTERM, [](int) { stop = true; });
  try {
    canopen::HostBus bus{argv[1]};
    const canopen::NodeId id{static_cast<std::uint8_t>(std::atoi(argv[2]))};
    auto node = canopen::make_node<Parts>(bus, id);
    std::vector<std::uint8_t> file(file_bytes);
    node.bind<every_service::od::file>(file);
    if (argc == 4 && std::string_view{argv[3]} == "serve") {
      serve_in_own_loop(bus, node);
    } else {
      bus.run(node, stop);
    }
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}

/// Frames wait in order of priority if the interface has no space: `vm_urgent BUS` sends frames 701h until forty of
/// them wait, then eight frames 081h, prints the number of frames 701h, and sends until no frame waits.
#include <canopen/host/host_bus.hpp>
#include <cstdio>
#include <stdexcept>

namespace {

canopen::Frame numbered(std::uint32_t id, unsigned number) {
  canopen::Frame frame{};
  frame.id = id;
  frame.size = 2;
  frame.data[0] = static_cast<std::uint8_t>(number >> 8);
  frame.data[1] = static_cast<std::uint8_t>(number);
  return frame;
}

void send(canopen::HostBus& bus, const canopen::Frame& frame) {
  if (!bus.send(frame)) throw std::runtime_error{"the queue takes no more"};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    canopen::HostBus bus{argv[1]};
    unsigned late = 0;
    while (bus.waiting() < 40) send(bus, numbered(0x701, late++));
    for (unsigned number = 0; number < 8; ++number) send(bus, numbered(0x081, number));
    std::printf("%u\n", late);
    std::fflush(stdout);
    while (bus.waiting() > 0) (void)bus.receive(std::chrono::milliseconds{10});
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}

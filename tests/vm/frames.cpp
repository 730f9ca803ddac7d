/// Many frames through two ports: `vm_frames BUS BUS COUNT` sends COUNT frames at full speed on the first bus and
/// receives them from the second. None may be lost or reordered.
#include <canopen/host/host_bus.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace {

constexpr std::uint64_t window = 100;  ///< frames in transit; a socket has space for more

canopen::Frame numbered(std::uint64_t number) {
  canopen::Frame frame{};
  frame.id = 0x181;
  frame.size = sizeof number;
  std::memcpy(frame.data.data(), &number, sizeof number);
  return frame;
}

std::uint64_t number_of(const canopen::Frame& frame) {
  std::uint64_t number = 0;
  std::memcpy(&number, frame.data.data(), sizeof number);
  return number;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  constexpr canopen::Duration long_enough = std::chrono::seconds{2};
  try {
    canopen::HostBus from{argv[1]};
    canopen::HostBus to{argv[2]};
    const std::uint64_t count = std::strtoull(argv[3], nullptr, 10);
    std::uint64_t sent = 0;
    std::uint64_t received = 0;
    while (received < count) {
      while (sent < count && sent - received < window && from.send(numbered(sent))) ++sent;
      const auto frame = to.receive(sent - received == window || sent == count ? long_enough : canopen::Duration{0});
      if (frame && number_of(*frame) != received) throw std::runtime_error{"a frame is lost or has overtaken others"};
      if (!frame && (sent - received == window || sent == count)) throw std::runtime_error{"frames are lost"};
      if (frame) ++received;
    }
    if (to.receive(canopen::Duration{0})) throw std::runtime_error{"there are more frames than were sent"};
    std::printf("%llu frames, none lost, none reordered\n", static_cast<unsigned long long>(received));
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}

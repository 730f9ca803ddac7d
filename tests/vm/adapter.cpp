/// An SLCAN adapter with a node: `vm_adapter NODE-ID` prints the name of its serial line, a pseudo-terminal, and runs
/// until SIGTERM.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <canopen/host/event_descriptor.hpp>
#include <canopen/node.hpp>
#include <canopen/port/slcan_adapter.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <every_service/device.hpp>
#include <span>
#include <utility>

namespace {

std::atomic<bool> stop{false};

using Parts =
    canopen::Composition<every_service::Device, canopen::without<canopen::part::lss, canopen::part::storage,
                                                                 every_service::od::file, every_service::od::stream>>;

class Device {
 public:
  Device(canopen::Descriptor line, canopen::NodeId id) : line_{std::move(line)}, node_{bus_, id} {}

  // The interface for the adapter.
  void write(std::span<const char> text) const { (void)!::write(line_.number(), text.data(), text.size()); }
  bool open(const canopen::SlcanChannel& channel) {
    constexpr std::uint16_t code_of_500_kbit = 6;
    start_due_ = channel.rate == canopen::SlcanChannel::Rate::code && channel.value == code_of_500_kbit;
    return start_due_;
  }
  void close() {}
  bool send(const canopen::Frame& frame) {
    node_.on_frame(frame, canopen::monotonic_now());
    return true;
  }
  std::uint8_t status() const { return 0; }

  /// Serves the line for at most ten milliseconds.
  void work() {
    pollfd waiting{line_.number(), POLLIN, 0};
    std::array<char, 256> bytes;
    if (::poll(&waiting, 1, 10) > 0) {
      const ssize_t count = ::read(line_.number(), bytes.data(), bytes.size());
      for (ssize_t i = 0; i < count; ++i) adapter_.on_character(bytes[static_cast<std::size_t>(i)], *this);
    }
    if (std::exchange(start_due_, false)) node_.start(canopen::monotonic_now());
    node_.on_time(canopen::monotonic_now());
  }

 private:
  struct NodeBus {
    Device* device;
    bool send(const canopen::Frame& frame) {
      device->adapter_.on_frame(frame, canopen::monotonic_now(), *device);
      return true;
    }
  };

  canopen::Descriptor line_;
  canopen::SlcanAdapter adapter_;
  NodeBus bus_{this};
  canopen::Node<Parts, NodeBus> node_;
  bool start_due_ = false;  ///< the channel was opened
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::signal(SIGTERM, [](int) { stop = true; });
  canopen::Descriptor line = canopen::opened(::posix_openpt(O_RDWR | O_NOCTTY), "posix_openpt");
  if (::grantpt(line.number()) != 0 || ::unlockpt(line.number()) != 0) return 1;
  std::printf("%s\n", ::ptsname(line.number()));
  std::fflush(stdout);
  Device device{std::move(line), canopen::NodeId{static_cast<std::uint8_t>(std::atoi(argv[1]))}};
  while (!stop) device.work();
  return 0;
}

/// A servo drive on SocketCAN: `socketcan_drive can0 5` is node 5 on can0 until it gets SIGINT or SIGTERM.
#include <atomic>
#include <canopen/host/socketcan.hpp>
#include <canopen/node.hpp>
#include <charconv>
#include <cpc_tc1/device.hpp>
#include <csignal>
#include <cstdio>
#include <string_view>

namespace od = cpc_tc1::od;

namespace {

std::atomic<bool> stop{false};

struct Drive {
  using command = od::controlword::type::command_value;
  using state = od::statusword::type::state_value;

  /// The state after a command, from any state. canopen::cia402::DriveNode has all transitions
  /// (docs/profiles/drive.md).
  static state state_after(od::controlword::type word) {
    if (word.is(command::shutdown)) return state::ready_to_switch_on;
    if (word.is(command::switch_on)) return state::switched_on;
    if (word.is(command::enable_operation)) return state::operation_enabled;
    return state::switch_on_disabled;
  }
  void written(od::controlword, od::controlword::type word, auto& node) {
    const auto status = od::statusword::type{}.state(state_after(word)).voltage_enabled(true).remote(true);
    node.set(od::statusword{}, status);
  }
};

/// The drive has neither storage nor LSS.
using DriveParts =
    canopen::Composition<cpc_tc1::Device, Drive, canopen::without<canopen::part::lss, canopen::part::storage>>;

canopen::NodeId parse_node_id(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return canopen::NodeId{whole && value <= 127 ? static_cast<std::uint8_t>(value) : std::uint8_t{0}};
}

}  // namespace

int main(int argc, char** argv) {
  const canopen::NodeId id = argc == 3 ? parse_node_id(argv[2]) : canopen::NodeId{};
  if (!id.valid()) {
    std::fprintf(stderr, "usage: %s INTERFACE NODE-ID\n", argv[0]);
    return 2;
  }
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  try {
    canopen::SocketCan bus{argv[1]};
    canopen::Node<DriveParts, canopen::SocketCan> drive{bus, id};
    bus.run(drive, stop);
  } catch (const std::system_error& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[1], problem.what());
    return 1;
  }
  return 0;
}

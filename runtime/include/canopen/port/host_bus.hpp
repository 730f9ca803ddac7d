/// A CAN bus by its address, for programs on a host:
///
///     canopen::HostBus bus{"socketcan:can0"};
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5});
///     bus.run(drive, stop);
#pragma once

#include <atomic>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "canopen/frame.hpp"
#include "canopen/port/socketcan.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// The port that an address tells of. Its node must not outlive it.
class HostBus {
 public:
  /// `socketcan:INTERFACE`. Throws std::invalid_argument, with a sentence, for what is no address, and
  /// std::system_error for what cannot be opened.
  explicit HostBus(const std::string& address) : port_{open(address)} {}

  /// False when the bus has no room now; the frame is then not taken.
  [[nodiscard]] bool send(const Frame& frame) {
    return std::visit([&](auto& port) { return port.send(frame); }, port_);
  }

  /// The next frame, or nothing when none comes within this time. Throws std::system_error when the bus is lost.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    return std::visit([&](auto& port) { return port.receive(timeout); }, port_);
  }

  /// Starts a node and runs it until `stop` is true, which is looked at ten times a second at least.
  template <class Node>
  void run(Node& node, const std::atomic<bool>& stop) {
    std::visit([&](auto& port) { port.run(node, stop); }, port_);
  }

  /// Does what there is to do for a node that has been started, without waiting: to be called once after `node.start` and
  /// whenever `file_descriptor` can be read.
  template <class Node>
  void serve(Node& node) {
    std::visit([&](auto& port) { port.serve(node); }, port_);
  }

  /// When the last frame that `receive` gave has come.
  [[nodiscard]] TimePoint received_at() const {
    return std::visit([](const auto& port) { return port.received_at(); }, port_);
  }

  /// CLOCK_MONOTONIC, cut to what a TimePoint holds.
  [[nodiscard]] static TimePoint now() { return monotonic_now(); }

  /// Readable when there is something to do, for a poll loop of the application's own.
  [[nodiscard]] int file_descriptor() const {
    return std::visit([](const auto& port) { return port.file_descriptor(); }, port_);
  }

 private:
  using Port = std::variant<SocketCan>;

  [[nodiscard]] static Port open(const std::string& address) {
    const std::size_t colon = address.find(':');
    const std::string_view kind = std::string_view{address}.substr(0, colon);
    if (colon == std::string::npos || colon + 1 == address.size()) refuse(address);
    if (kind == "socketcan") return SocketCan{address.substr(colon + 1)};
    refuse(address);
  }

  [[noreturn]] static void refuse(const std::string& address) {
    throw std::invalid_argument{"\"" + address + "\" is no bus: write socketcan:INTERFACE"};
  }

  Port port_;
};

}  // namespace canopen

/// A CAN bus selected by an address, for programs on a host:
///
///     canopen::HostBus bus{"socketcan:can0"};
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5});
///     bus.run(drive, stop);
#pragma once

#include <atomic>
#include <charconv>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/host/event_descriptor.hpp"
#include "canopen/host/host_loop.hpp"
#include "canopen/host/slcan.hpp"
#include "canopen/host/socketcan.hpp"
#include "canopen/host/socketcand.hpp"

namespace canopen {

/// The port that an address selects. Its node must not outlive it.
class HostBus {
 public:
  /// `socketcan:INTERFACE`, `slcan:DEVICE[@BIT-RATE[,BAUD]]` or `socketcand:HOST:PORT/INTERFACE`; BIT-RATE is that of
  /// the CAN bus, BAUD that of the serial line. Throws std::invalid_argument with a message if the address is invalid,
  /// and std::system_error if it cannot be opened.
  explicit HostBus(const std::string& address) : port_{open(address)} {}

  /// Sends a frame. Returns false if the bus has no room; the frame is then not sent.
  [[nodiscard]] bool send(const Frame& frame) {
    return std::visit([&](auto& port) { return port.send(frame); }, port_);
  }

  /// Returns the next frame; empty if none is received within this time. Throws std::system_error if the bus is lost.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    return std::visit([&](auto& port) { return port.receive(timeout); }, port_);
  }

  /// Starts a node and runs it until `stop` is true, which is checked at least ten times a second.
  template <class Node>
  void run(Node& node, const std::atomic<bool>& stop = host_loop::never) {
    host_loop::run(*this, node, stop);
  }

  /// Serves a node that has been started, without waiting: call it once after `node.start` and whenever
  /// `file_descriptor` is readable.
  template <class Node>
  void serve(Node& node) {
    host_loop::serve(*this, node);
  }

  /// Returns when the last frame returned by `receive` was received.
  [[nodiscard]] TimePoint received_at() const {
    return std::visit([](const auto& port) { return port.received_at(); }, port_);
  }

  /// Returns the number of frames that wait for room.
  [[nodiscard]] std::size_t waiting() const {
    return std::visit([](const auto& port) { return port.waiting(); }, port_);
  }

  /// Returns CLOCK_MONOTONIC, truncated to a TimePoint.
  [[nodiscard]] static TimePoint now() { return monotonic_now(); }

  /// Readable when there is an event, for the application's own poll loop.
  [[nodiscard]] int file_descriptor() const {
    return std::visit([](const auto& port) { return port.file_descriptor(); }, port_);
  }

  /// Serves the node as soon as possible: after another thread has given it work through a Mailbox or Locked, which the
  /// node would notice at its next frame or deadline. Any thread and a signal handler may call it.
  void wake() const {
    std::visit([](const auto& port) { port.wake(); }, port_);
  }

  // For host_loop.hpp: one loop with the code of a node, not one for each kind of port.

  template <class Node>
  void listen_for(Node& node) {
    if (auto* const port = std::get_if<SocketCan>(&port_)) {
      if constexpr (requires { port->listen_for(node); }) port->listen_for(node);
    }
  }
  [[nodiscard]] std::optional<PortEvent> take() {
    return std::visit([](auto& port) { return port.take(); }, port_);
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return std::visit([](const auto& port) { return port.next_deadline(); }, port_);
  }
  [[nodiscard]] Duration hold_off() const {
    return std::visit([](const auto& port) { return port.hold_off(); }, port_);
  }
  [[nodiscard]] TimePoint pass_time() {
    return std::visit([](auto& port) { return port.pass_time(); }, port_);
  }
  [[nodiscard]] EventDescriptor& events() {
    return std::visit([](auto& port) -> EventDescriptor& { return port.events(); }, port_);
  }

 private:
  using Port = std::variant<SocketCan, SlcanPort, SocketcandPort>;

  [[nodiscard]] static Port open(const std::string& address) {
    const auto [kind, rest] = split(address, address.find(':'));
    if (kind == "socketcan" && !rest.empty()) return SocketCan{rest};
    if (kind == "slcan" && !rest.empty()) return open_slcan(address, rest);
    if (kind == "socketcand") {
      const auto [server, bus] = split(rest, rest.find('/'));
      auto [host, port] = split(server, server.rfind(':'));
      if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
      if (!host.empty() && !port.empty() && !bus.empty()) return SocketcandPort{host, port, bus};
    }
    refuse(address);
  }

  [[nodiscard]] static SlcanPort open_slcan(const std::string& address, const std::string& rest) {
    const auto [device, rates] = split(rest, rest.rfind('@'));
    SlcanOptions options;
    if (!rates.empty()) {
      const auto [bit_rate, baud] = split(rates, rates.find(','));
      options.bit_rate = number(address, bit_rate);
      if (!baud.empty()) options.baud = number(address, baud);
    }
    return SlcanPort{device, options};
  }

  /// Returns the text before and after the character at `at`; all of it and an empty text if `at` is npos.
  [[nodiscard]] static std::pair<std::string, std::string> split(const std::string& text, std::size_t at) {
    if (at == std::string::npos) return {text, ""};
    return {text.substr(0, at), text.substr(at + 1)};
  }

  [[nodiscard]] static std::uint32_t number(const std::string& address, const std::string& digits) {
    std::uint32_t value = 0;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value);
    if (error != std::errc{} || end != last || value == 0) refuse(address);
    return value;
  }

  [[noreturn]] static void refuse(const std::string& address) {
    throw std::invalid_argument{"\"" + address +
                                "\" is not a bus address: write socketcan:INTERFACE, slcan:DEVICE[@BIT-RATE[,BAUD]] or "
                                "socketcand:HOST:PORT/INTERFACE"};
  }

  Port port_;
};

}  // namespace canopen

/// A CAN bus by its address, for programs on a host:
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

#include "canopen/frame.hpp"
#include "canopen/port/event_descriptor.hpp"
#include "canopen/port/slcan.hpp"
#include "canopen/port/socketcan.hpp"
#include "canopen/port/socketcand.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// The port that an address tells of. Its node must not outlive it.
class HostBus {
 public:
  /// `socketcan:INTERFACE`, `slcan:DEVICE[@BIT-RATE[,BAUD]]` or `socketcand:HOST:PORT/INTERFACE`; BIT-RATE is that of
  /// the CAN bus, BAUD that of the serial line. Throws std::invalid_argument, with a sentence, for what is no address,
  /// and std::system_error for what cannot be opened.
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

  /// Does what there is to do for a node that has been started, without waiting: to be called once after `node.start`
  /// and whenever `file_descriptor` can be read.
  template <class Node>
  void serve(Node& node) {
    std::visit([&](auto& port) { port.serve(node); }, port_);
  }

  /// When the last frame that `receive` gave has come.
  [[nodiscard]] TimePoint received_at() const {
    return std::visit([](const auto& port) { return port.received_at(); }, port_);
  }

  /// Frames that wait for room.
  [[nodiscard]] std::size_t waiting() const {
    return std::visit([](const auto& port) { return port.waiting(); }, port_);
  }

  /// CLOCK_MONOTONIC, cut to what a TimePoint holds.
  [[nodiscard]] static TimePoint now() { return monotonic_now(); }

  /// Readable when there is something to do, for a poll loop of the application's own.
  [[nodiscard]] int file_descriptor() const {
    return std::visit([](const auto& port) { return port.file_descriptor(); }, port_);
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

  /// What stands before and behind a character; all of it and nothing where the character is not there.
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
                                "\" is no bus: write socketcan:INTERFACE, slcan:DEVICE[@BIT-RATE[,BAUD]] or "
                                "socketcand:HOST:PORT/INTERFACE"};
  }

  Port port_;
};

}  // namespace canopen

/// The bus of a command.
#pragma once

#include <algorithm>
#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "online/interruption.hpp"

namespace edsc {

/// The bus failed while in use.
struct BusLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The interface of a LiveBus to its port: a port of the host, or a bus in simulated time.
class BusPort {
 public:
  BusPort() = default;
  BusPort(const BusPort&) = delete;
  BusPort& operator=(const BusPort&) = delete;
  virtual ~BusPort() = default;

  /// False if the port cannot take the frame now. `send` and `receive` throw std::system_error if the bus is lost.
  [[nodiscard]] virtual bool send(const canopen::Frame& frame) = 0;
  /// The next frame, or nothing if none is received within this time.
  [[nodiscard]] virtual std::optional<canopen::Frame> receive(canopen::Duration timeout) = 0;
  [[nodiscard]] virtual canopen::TimePoint now() const = 0;
  /// The time of reception of the last frame of `receive`.
  [[nodiscard]] virtual canopen::TimePoint received_at() const = 0;
  /// The longest wait of one `receive`; interruptions are checked after it.
  [[nodiscard]] virtual canopen::Duration longest_at_once() const { return canopen::from_milliseconds(50); }
};

/// A bus that detects its loss: reported by the port, or if the port does not accept a frame for two seconds.
class LiveBus {
 public:
  /// Opens a port of the host (canopen::HostBus) or a SimulatedPort. Throws std::invalid_argument for a malformed
  /// address, std::runtime_error if it cannot be opened.
  explicit LiveBus(const std::string& address);
  explicit LiveBus(std::unique_ptr<BusPort> port) : port_{std::move(port)} {}

  /// Returns false if the port cannot take the frame now.
  [[nodiscard]] bool send(const canopen::Frame& frame);

  /// Waits until the port takes the frame. Throws Interrupted, BusLost.
  void send_all(const canopen::Frame& frame);

  /// The next frame; nothing if none is received within this time, or at an interruption. Throws BusLost.
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout);

  /// Passes frames to `on_frame` for this time. Throws Interrupted, BusLost.
  void listen(canopen::Duration span);

  /// The port of the bus.
  [[nodiscard]] BusPort& port() { return *port_; }

  [[nodiscard]] canopen::TimePoint now() const { return port_->now(); }
  /// The time of reception of the last frame of `receive`.
  [[nodiscard]] canopen::TimePoint received_at() const { return port_->received_at(); }

  /// Called with every received frame.
  std::function<void(const canopen::Frame&, canopen::TimePoint now)> on_frame;
  /// Called with every frame that the port has accepted.
  std::function<void(const canopen::Frame&, canopen::TimePoint now)> on_sent;

 private:
  std::unique_ptr<BusPort> port_;
  std::optional<canopen::TimePoint> refused_since_;
};

/// Passes frames and time to a client, such as SdoClient or LssMaster, until it is no longer busy. Calls `cancel` once
/// at an interruption. Throws BusLost.
template <class Client, class Cancel>
void run(LiveBus& bus, Client& client, Cancel cancel) {
  constexpr canopen::Duration try_again{1'000};
  bool cancelled = false;
  while (client.busy()) {
    const canopen::TimePoint present = bus.now();
    const std::optional<canopen::TimePoint> deadline = client.next_deadline();
    const canopen::Duration wait = deadline && *deadline > present ? *deadline - present : try_again;
    if (const std::optional<canopen::Frame> frame = bus.receive(wait)) client.on_frame(*frame, bus.now());
    client.on_time(bus.now());
    if (Interruption::noted() && !cancelled) {
      cancelled = true;
      if (!cancel()) return;
    }
  }
}

}  // namespace edsc

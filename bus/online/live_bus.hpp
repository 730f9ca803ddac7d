/// The bus that a command talks to.
#pragma once

#include <algorithm>
#include <canopen/frame.hpp>
#include <canopen/time.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "online/interruption.hpp"

namespace edsc {

/// The bus broke while it was in use.
struct BusLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a LiveBus sends and receives with: the ports of the host, or a bus in simulated time.
class BusPort {
 public:
  BusPort() = default;
  BusPort(const BusPort&) = delete;
  BusPort& operator=(const BusPort&) = delete;
  virtual ~BusPort() = default;

  /// False if the port cannot take the frame now. `send` and `receive` throw std::system_error if the bus is lost.
  [[nodiscard]] virtual bool send(const canopen::Frame& frame) = 0;
  /// The next frame, or nothing when none comes within this time.
  [[nodiscard]] virtual std::optional<canopen::Frame> receive(canopen::Duration timeout) = 0;
  [[nodiscard]] virtual canopen::TimePoint now() const = 0;
  /// When the last frame that `receive` gave was received.
  [[nodiscard]] virtual canopen::TimePoint received_at() const = 0;
  /// Readable when there is something to do.
  [[nodiscard]] virtual int file_descriptor() const = 0;
  /// How long `receive` may wait at once: an interruption is noted behind it.
  [[nodiscard]] virtual canopen::Duration longest_at_once() const { return canopen::from_milliseconds(50); }
};

/// A bus that reports when it is lost: by what the port says, or by taking no frame for two seconds.
class LiveBus {
 public:
  /// A port of the host, canopen::HostBus, or a SimulatedPort. Throws std::invalid_argument for a malformed address, another
  /// std::runtime_error for what cannot be opened.
  explicit LiveBus(const std::string& address);
  explicit LiveBus(std::unique_ptr<BusPort> port) : port_{std::move(port)} {}

  /// False when there is no room now.
  [[nodiscard]] bool send(const canopen::Frame& frame);

  /// Waits until there is room. Throws Interrupted, BusLost.
  void send_all(const canopen::Frame& frame);

  /// The next frame; nothing when none comes within this time, or at an interruption. Throws BusLost.
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout);

  /// Hands frames to `on_frame` for this time. Throws Interrupted, BusLost.
  void listen(canopen::Duration span);

  /// What it sends and receives with.
  [[nodiscard]] BusPort& port() { return *port_; }

  [[nodiscard]] canopen::TimePoint now() const { return port_->now(); }
  [[nodiscard]] int file_descriptor() const { return port_->file_descriptor(); }
  /// When the last frame that `receive` gave was received.
  [[nodiscard]] canopen::TimePoint received_at() const { return port_->received_at(); }

  /// Called with every frame that is received.
  std::function<void(const canopen::Frame&, canopen::TimePoint now)> on_frame;
  /// Called with every frame that the port has taken.
  std::function<void(const canopen::Frame&, canopen::TimePoint now)> on_sent;

 private:
  std::unique_ptr<BusPort> port_;
  std::optional<canopen::TimePoint> refused_since_;
};

/// Hands frames and time to a client, SdoClient or LssMaster for instance, until it is no longer busy. At an
/// interruption `cancel` is called once. Throws BusLost.
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

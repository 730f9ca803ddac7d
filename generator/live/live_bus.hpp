/// The bus that a command talks to.
#pragma once

#include <algorithm>
#include <canopen/frame.hpp>
#include <canopen/port/host_bus.hpp>
#include <canopen/time.hpp>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "live/interruption.hpp"

namespace edsc {

/// The bus broke while it was in use.
struct BusLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A HostBus that tells when it is lost: by what the port says, or by taking no frame for two seconds.
class LiveBus {
 public:
  /// Throws std::invalid_argument for a malformed address, std::system_error for what cannot be opened.
  explicit LiveBus(const std::string& address) : bus_{address} {}

  /// False when there is no room now.
  [[nodiscard]] bool send(const canopen::Frame& frame);

  /// Waits until there is room. Throws Interrupted, BusLost.
  void send_all(const canopen::Frame& frame);

  /// The next frame; nothing when none comes within this time, or at an interruption. Throws BusLost.
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout);

  /// Hands frames to `on_frame` for this time. Throws Interrupted, BusLost.
  void listen(canopen::Duration span);

  [[nodiscard]] static canopen::TimePoint now() { return canopen::HostBus::now(); }
  [[nodiscard]] int file_descriptor() const { return bus_.file_descriptor(); }
  /// When the last frame that `receive` gave has come.
  [[nodiscard]] canopen::TimePoint received_at() const { return bus_.received_at(); }

  /// Called with every frame that is received.
  std::function<void(const canopen::Frame&, canopen::TimePoint now)> on_frame;

 private:
  canopen::HostBus bus_;
  std::optional<canopen::TimePoint> refused_since_;
};

/// Hands frames and time to a client, SdoClient or LssMaster for instance, until it is no longer busy. At an
/// interruption `cancel` is called once. Throws BusLost.
template <class Client, class Cancel>
void run(LiveBus& bus, Client& client, Cancel cancel) {
  constexpr canopen::Duration try_again{1'000};
  bool cancelled = false;
  while (client.busy()) {
    const canopen::TimePoint present = LiveBus::now();
    const std::optional<canopen::TimePoint> deadline = client.next_deadline();
    const canopen::Duration wait = deadline && *deadline > present ? *deadline - present : try_again;
    if (const std::optional<canopen::Frame> frame = bus.receive(wait)) client.on_frame(*frame, LiveBus::now());
    client.on_time(LiveBus::now());
    if (Interruption::noted() && !cancelled) {
      cancelled = true;
      if (!cancel()) return;
    }
  }
}

/// Opens the bus and runs a command on it. What goes wrong on the way is told on standard error. Throws as the
/// constructor of LiveBus does.
[[nodiscard]] int with_bus(const std::string& address, const std::function<int(LiveBus&)>& command);

}  // namespace edsc

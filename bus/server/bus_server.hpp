/// CAN buses of this process, served over TCP with the socketcand protocol.
#pragma once

#include <signal.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canopen/can/frame.hpp"
#include "canopen/host/descriptor.hpp"
#include "server/bus_client.hpp"
#include "server/listen_address.hpp"
#include "server/socketcand_text.hpp"

namespace edsc {

struct BusLimits {
  std::size_t clients = 64;
  std::size_t backlog = std::size_t{8} << 20;  ///< bytes pending for one client, above which it is disconnected
  std::chrono::milliseconds handshake{5000};   ///< after which a client that has not opened a bus is disconnected
};

/// Events that the server reports; none of the functions may be empty.
struct BusEvents {
  std::function<void(const canopen::Frame&, const std::string& bus, socketcand::TimeStamp)> on_frame;
  std::function<void(const std::string& message)> on_trouble;  ///< a client is disconnected or cannot be accepted
};

/// Each bus forwards every frame to all its clients except the sender, to all in the same order, without waiting for
/// any.
class BusServer {
 public:
  /// Starts listening. Throws std::system_error on failure.
  BusServer(const ListenAddress& address, std::vector<std::string> buses, BusLimits limits, BusEvents events);
  BusServer(const BusServer&) = delete;
  BusServer& operator=(const BusServer&) = delete;
  ~BusServer();

  /// The address it listens at, with the actual port.
  [[nodiscard]] const ListenAddress& address() const { return address_; }
  [[nodiscard]] std::size_t clients() const { return clients_.size(); }

  /// Waits for requests of clients, at most for this time, and serves them. `signals` is the signal mask during the
  /// wait; a signal ends it.
  void poll_once(std::chrono::milliseconds wait, const sigset_t* signals = nullptr);

 private:
  using Clock = BusClient::Clock;

  void listen();
  /// Null if there is none; errno says why.
  [[nodiscard]] std::unique_ptr<BusClient> accept_client() const;
  void accept();
  void refuse_without_descriptor();
  void turn_away(BusClient& client, const std::string& reason) const;
  [[nodiscard]] bool receive(BusClient& client);
  [[nodiscard]] bool answer(BusClient& client, const ClientRequest& request);
  [[nodiscard]] bool open_bus(BusClient& client, const std::string& name);
  void deliver(const BusClient& sender, const canopen::Frame& frame);
  [[nodiscard]] std::chrono::milliseconds until_handshake_ends(std::chrono::milliseconds at_most) const;
  /// Whether its time to open a bus is over.
  [[nodiscard]] bool is_overdue(const BusClient& client, Clock::time_point now) const;
  void flush(Clock::time_point now);
  void log(const BusClient& client, const std::string& message) const;

  ListenAddress address_;
  std::vector<std::string> buses_;
  BusLimits limits_;
  BusEvents events_;
  int listener_ = -1;
  canopen::Descriptor reserve_;       ///< is closed to accept, and refuse, a client when the process has no other one
  Clock::time_point accepts_from_{};  ///< no descriptor was free at all
  std::vector<std::unique_ptr<BusClient>> clients_;
};

}  // namespace edsc

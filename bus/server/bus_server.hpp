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

#include "canopen/frame.hpp"
#include "server/bus_client.hpp"
#include "server/listen_address.hpp"
#include "server/socketcand_text.hpp"

namespace edsc {

struct BusLimits {
  std::size_t clients = 64;
  std::size_t backlog = std::size_t{8} << 20;  ///< bytes on their way to one client, beyond which it is disconnected
  std::chrono::milliseconds handshake{5000};   ///< after which a client that has opened no bus is disconnected
};

/// What the server tells of; none of them may be empty.
struct BusEvents {
  std::function<void(const canopen::Frame&, const std::string& bus, socketcand::TimeStamp)> on_frame;
  std::function<void(const std::string& message)> on_trouble;  ///< a client is disconnected
};

/// Each bus hands every frame to all its clients but the sender, to all in the same order. It waits for none of them.
class BusServer {
 public:
  /// Listens. Throws std::system_error when it cannot.
  BusServer(const ListenAddress& address, std::vector<std::string> buses, BusLimits limits, BusEvents events);
  BusServer(const BusServer&) = delete;
  BusServer& operator=(const BusServer&) = delete;
  ~BusServer();

  /// Where it listens, with the port that it has got.
  [[nodiscard]] const ListenAddress& address() const { return address_; }
  [[nodiscard]] std::size_t clients() const { return clients_.size(); }

  /// Waits until a client wants something, or for this time at most, and serves all that do. `signals` is the mask
  /// while it waits; a signal ends the turn.
  void turn(std::chrono::milliseconds wait, const sigset_t* signals = nullptr);

 private:
  using Clock = BusClient::Clock;

  void listen();
  void welcome();
  [[nodiscard]] bool hear(BusClient& client);
  [[nodiscard]] bool answer(BusClient& client, ClientRequest request);
  [[nodiscard]] bool open_bus(BusClient& client);
  void deliver(const BusClient& sender);
  [[nodiscard]] std::chrono::milliseconds until_handshake_ends(std::chrono::milliseconds at_most) const;
  void flush();
  void report(const BusClient& client, const std::string& message) const;

  ListenAddress address_;
  std::vector<std::string> buses_;
  BusLimits limits_;
  BusEvents events_;
  int listener_ = -1;
  std::vector<std::unique_ptr<BusClient>> clients_;
};

}  // namespace edsc

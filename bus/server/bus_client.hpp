/// One client of the bus server: what it may say in which mode of the socketcand protocol, and what is on its way to
/// it.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "canopen/frame.hpp"
#include "server/socketcand_text.hpp"

namespace edsc {

/// What a client's element comes to for the server.
enum class ClientRequest { nothing, open_bus, send_frame, leave };

class BusClient {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Command { open, rawmode, bcmmode, send, echo };

  /// Takes the connected, non-blocking socket ; `name` tells of it in messages.
  BusClient(int socket, std::string name);
  BusClient(const BusClient&) = delete;
  BusClient& operator=(const BusClient&) = delete;
  ~BusClient();

  [[nodiscard]] int socket() const { return socket_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// When it was connected.
  [[nodiscard]] Clock::time_point since() const { return since_; }

  /// The number of the bus that it has opened.
  [[nodiscard]] std::optional<std::size_t> bus() const { return bus_; }

  /// True in the raw mode: it gets all frames of its bus.
  [[nodiscard]] bool listens() const { return raw_; }

  /// One byte of what the client says. `open_bus`: answer with `opened` or `refuse`; `send_frame`: `frame()` goes to
  /// the bus; `leave`: it is to be closed, `leaves_because` says why.
  [[nodiscard]] ClientRequest take(char c);

  /// The name that an `open_bus` asks for.
  [[nodiscard]] const std::string& wanted_bus() const { return wanted_bus_; }
  [[nodiscard]] const canopen::Frame& frame() const { return frame_; }
  [[nodiscard]] const std::string& leaves_because() const { return leaves_because_; }

  void opened(std::size_t bus);

  /// Tells the client "< error REASON >".
  void refuse(std::string_view reason);

  /// Puts text behind what is on its way to the client.
  void put(std::string_view text) { backlog_.append(text); }

  /// Writes as much as the connection takes. False when it is broken.
  [[nodiscard]] bool flush();

  /// Bytes on their way to the client.
  [[nodiscard]] std::size_t backlog() const { return backlog_.size() - written_; }

 private:
  [[nodiscard]] ClientRequest on_element(std::string_view element);
  [[nodiscard]] ClientRequest on_command(Command command, std::string_view element);
  [[nodiscard]] ClientRequest leave(std::string reason);

  int socket_;
  std::string name_;
  socketcand::ElementReader reader_;
  std::optional<std::size_t> bus_;
  bool raw_ = false;
  std::string wanted_bus_;
  canopen::Frame frame_;
  std::string leaves_because_;
  std::string backlog_;
  std::size_t written_ = 0;  ///< of the backlog
  Clock::time_point since_ = Clock::now();
};

}  // namespace edsc

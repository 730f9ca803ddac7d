/// One client of the bus server: the requests that each mode of the socketcand protocol allows, and the data pending
/// for the client.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "canopen/can/frame.hpp"
#include "server/socketcand_text.hpp"

namespace edsc {

/// What a client's element asks the server for.
struct ClientRequest {
  enum class Kind { nothing, open_bus, send_frame, leave };

  Kind kind = Kind::nothing;
  std::string text{};      ///< of `open_bus`, the name of the bus; of `leave`, the reason
  canopen::Frame frame{};  ///< of `send_frame`
};

class BusClient {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes the connected, non-blocking socket; `name` identifies the client in messages.
  BusClient(int socket, std::string name);
  BusClient(const BusClient&) = delete;
  BusClient& operator=(const BusClient&) = delete;
  ~BusClient();

  [[nodiscard]] int socket() const { return socket_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// When it was connected.
  [[nodiscard]] Clock::time_point since() const { return since_; }

  /// The number of the opened bus.
  [[nodiscard]] std::optional<std::size_t> bus() const { return bus_; }

  /// True in the raw mode: the client receives all frames of its bus.
  [[nodiscard]] bool listens() const { return raw_; }

  /// Reads one byte from the client. `open_bus`: answer with `opened` or `refuse`; `send_frame`: send it to the bus;
  /// `leave`: close the connection.
  [[nodiscard]] ClientRequest take(char c);

  void opened(std::size_t bus);

  /// Sends "< error REASON >" to the client.
  void refuse(std::string_view reason);

  /// Appends text to the data pending for the client.
  void put(std::string_view text) { backlog_.append(text); }

  /// Writes as much as the connection accepts. Returns false if it is broken.
  [[nodiscard]] bool flush();

  /// Bytes pending for the client.
  [[nodiscard]] std::size_t backlog() const { return backlog_.size() - written_; }

 private:
  [[nodiscard]] ClientRequest on_element(std::string_view element);
  [[nodiscard]] ClientRequest on_open(std::string_view rest);

  int socket_;
  std::string name_;
  socketcand::ElementReader reader_;
  std::optional<std::size_t> bus_;
  bool raw_ = false;
  std::string backlog_;
  std::size_t written_ = 0;  ///< of the backlog
  Clock::time_point since_ = Clock::now();
};

}  // namespace edsc

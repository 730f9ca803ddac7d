/// An HTTP server whose clients cost it a bounded time and memory.
#pragma once

#include <httplib.h>

#include <cstddef>
#include <mutex>
#include <unordered_set>

namespace edsc {

/// Answers one request for each connection. It reads at most 16 kB of it, or as many bytes as set, within five seconds
/// of its acceptance.
class BoundedServer final : public httplib::Server {
 public:
  void set_threads(std::size_t count);

  /// Of a request with its headers. Before binding.
  void set_max_request_bytes(std::size_t count) { max_request_bytes_ = count; }

  /// After binding: connections that the server has not accepted yet wait, as many as the system allows. httplib lets
  /// five wait; the others would be delayed by seconds.
  void lengthen_queue();

  /// Closes all connections, and each later one at once, so that stop() does not wait for a client.
  void end_connections();

 private:
  bool process_and_close_socket(socket_t socket) override;
  [[nodiscard]] bool begin_connection(socket_t socket);
  void end_connection(socket_t socket);

  std::size_t max_request_bytes_ = 16'384;
  std::mutex mutex_;
  std::unordered_set<socket_t> open_;
  bool has_ended_ = false;
};

}  // namespace edsc

#include "web/bounded_server.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <utility>

namespace edsc {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// void in cpp-httplib 0.11 of Debian 12, bool in 0.18 of Debian 13.
using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

/// Threads that know when their connection was accepted. The time of a connection includes that in which it waits for
/// a thread: otherwise clients that send nothing would delay others by that of all those before them.
class ConnectionThreads final : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(std::size_t count) : threads_{count} {}

  Enqueued enqueue(std::function<void()> connection) override {
    return threads_.enqueue([connection = std::move(connection), accepted = steady_clock::now()] {
      accepted_ = accepted;
      connection();
    });
  }

  void shutdown() override { threads_.shutdown(); }

  /// Of the connection of this thread.
  [[nodiscard]] static steady_clock::time_point accepted() { return accepted_; }

 private:
  static thread_local steady_clock::time_point accepted_;
  httplib::ThreadPool threads_;
};

thread_local steady_clock::time_point ConnectionThreads::accepted_;

/// A connection of one request, of which only so many bytes are read, within this time.
class BoundedStream final : public httplib::Stream {
 public:
  BoundedStream(int socket, steady_clock::time_point accepted, std::size_t max_bytes)
      : socket_{socket}, end_of_reading_{accepted + read_time}, max_bytes_{max_bytes} {}

  [[nodiscard]] bool is_readable() const override { return begin_ != end_ || waits_for(POLLIN, milliseconds{0}); }
  [[nodiscard]] bool is_writable() const override { return waits_for(POLLOUT, write_time); }

  ssize_t read(char* out, std::size_t size) override {
    if (begin_ == end_ && !fill()) return -1;
    const std::size_t count = std::min(size, end_ - begin_);
    std::memcpy(out, buffer_.data() + begin_, count);
    begin_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* data, std::size_t size) override {
    if (!waits_for(POLLOUT, write_time)) return -1;
    return ::send(socket_, data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  static constexpr milliseconds read_time{5'000};
  static constexpr milliseconds write_time{5'000};

  [[nodiscard]] bool waits_for(short event, milliseconds most) const {
    pollfd waited{socket_, event, 0};
    return poll(&waited, 1, static_cast<int>(most.count())) == 1 && (waited.revents & event) != 0;
  }

  bool fill() {
    const auto left = std::chrono::duration_cast<milliseconds>(end_of_reading_ - steady_clock::now());
    // What was received while all threads were busy is read also after this time.
    if (bytes_ >= max_bytes_ || !waits_for(POLLIN, std::max(left, milliseconds{0}))) return false;
    const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (count <= 0) return false;
    begin_ = 0;
    end_ = static_cast<std::size_t>(count);
    bytes_ += end_;
    return true;
  }

  int socket_;
  steady_clock::time_point end_of_reading_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::size_t begin_ = 0, end_ = 0;
  std::array<char, 4096> buffer_{};
};

}  // namespace

void BoundedServer::set_threads(std::size_t count) {
  new_task_queue = [count] { return new ConnectionThreads{count}; };
}

void BoundedServer::lengthen_queue() { ::listen(svr_sock_, SOMAXCONN); }

void BoundedServer::end_connections() {
  const std::lock_guard lock{mutex_};
  has_ended_ = true;
  for (const socket_t socket : open_) ::shutdown(socket, SHUT_RDWR);
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  bool is_done = false;
  if (begin_connection(socket)) {
    BoundedStream stream{socket, ConnectionThreads::accepted(), max_request_bytes_};
    bool is_closed = false;
    // cpp-httplib 0.18 also takes the addresses and ports of both ends.
    const auto process = [&](auto& server) {
      if constexpr (requires { server.process_request(stream, true, is_closed, nullptr); }) {
        return server.process_request(stream, true, is_closed, nullptr);
      } else {
        return server.process_request(stream, {}, 0, {}, 0, true, is_closed, nullptr);
      }
    };
    is_done = process(*this);
    ::shutdown(socket, SHUT_RDWR);
    end_connection(socket);
  }
  ::close(socket);
  return is_done;
}

bool BoundedServer::begin_connection(socket_t socket) {
  const std::lock_guard lock{mutex_};
  if (!has_ended_) open_.insert(socket);
  return !has_ended_;
}

void BoundedServer::end_connection(socket_t socket) {
  const std::lock_guard lock{mutex_};
  open_.erase(socket);
}

}  // namespace edsc

/// A CAN bus accessed over a byte stream: common part of the ports for SLCAN and socketcand. Host side.
#pragma once

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/send_queue.hpp"
#include "canopen/host/event_descriptor.hpp"
#include "canopen/host/host_loop.hpp"

namespace canopen {

/// `Protocol` is SlcanHost or SocketcandClient. If the stream ends or fails, std::system_error is thrown: reconnecting
/// is left to the application, which knows what was lost.
template <class Protocol>
class StreamPort {
 public:
  static constexpr std::size_t queue_capacity = 64;

  StreamPort(StreamPort&&) noexcept = default;
  StreamPort& operator=(StreamPort&&) noexcept = default;
  ~StreamPort() {
    if (stream_.number() >= 0 && !Protocol::farewell.empty()) {
      static_cast<void>(write(Protocol::farewell));
    }
  }

  /// Sends a frame. Returns false if it is not accepted: the queue is full, or the bus is off.
  [[nodiscard]] bool send(const Frame& frame) {
    congested_ = reported_.state == BusState::off;
    if (congested_) return false;
    if (queue_.full()) flush();
    congested_ = !queue_.push(frame);
    flush();
    return !congested_;
  }

  /// Returns the next frame; empty if none is received within this time. Throws std::system_error if the stream
  /// has ended.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) { return host_loop::receive(*this, timeout); }

  /// Returns when the last frame returned by `receive` was received.
  [[nodiscard]] TimePoint received_at() const { return present_; }

  /// Starts a node and runs it until `stop` is true, which is checked at least ten times a second.
  template <class Node>
  void run(Node& node, const std::atomic<bool>& stop = host_loop::never) {
    host_loop::run(*this, node, stop);
  }

  /// Serves a node that has been started, without waiting.
  template <class Node>
  void serve(Node& node) {
    host_loop::serve(*this, node);
  }

  [[nodiscard]] static TimePoint now() { return monotonic_now(); }

  /// Readable when there is an event, for the application's own poll loop.
  [[nodiscard]] int file_descriptor() const { return events_.number(); }

  /// Serves the node as soon as possible: after another thread has given it work through a Mailbox or Locked, which the
  /// node would notice at its next frame or deadline. Any thread and a signal handler may call it.
  void wake() const { events_.wake(); }

  [[nodiscard]] const BusStatus& status() const { return reported_; }

  /// Returns the number of frames that wait for room.
  [[nodiscard]] std::size_t waiting() const { return queue_.size(); }

  // For host_loop.hpp.

  [[nodiscard]] std::optional<PortEvent> take() {
    flush();
    for (std::size_t reads = 0;; ++reads) {
      while (has_more()) {
        const std::optional<Frame> frame = protocol_.on_character(bytes_[read_++], present_);
        if (frame) return PortEvent{frame, present_, reported_};
        if (const auto changed = status_event()) return changed;
      }
      // A stream may contain bytes continuously without a frame: time must pass all the same.
      if (reads == reads_at_once || !read_some()) break;
    }
    protocol_.on_time(pass_time());
    flush();
    return status_event();
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return protocol_.next_deadline(); }
  [[nodiscard]] Duration hold_off() const {
    if (!congested_) return Duration{0};
    return reported_.state == BusState::off ? host_loop::look_again : host_loop::try_again;
  }
  [[nodiscard]] bool has_more() const { return read_ < count_; }
  [[nodiscard]] TimePoint pass_time() { return present_ = monotonic_now(); }
  [[nodiscard]] EventDescriptor& events() { return events_; }

 protected:
  /// `stream` must be non-blocking. `stream_name` is for messages.
  StreamPort(Descriptor stream, std::string stream_name)
      : stream_{std::move(stream)}, is_socket_{is_socket(stream_)}, name_{std::move(stream_name)} {
    events_.watch(stream_.number());
  }

  /// Waits until the protocol, which has been started, has opened the bus. Throws std::system_error if it does not do
  /// so within this time.
  void connect(Duration timeout) {
    const TimePoint end = now() + timeout;
    const auto connecting = [this] { return protocol_.state() == Protocol::State::connecting; };
    while (connecting()) {
      const TimePoint before =
          pass_time();  // what had arrived by then is read, even if this process is suspended later
      flush();
      for (std::size_t reads = 0; connecting(); ++reads) {
        while (connecting() && has_more()) (void)protocol_.on_character(bytes_[read_++], present_);
        if (!connecting() || reads == reads_at_once || !read_some()) break;
      }
      protocol_.on_time(before);
      flush();
      if (!connecting()) break;
      if (before >= end) throw std::system_error{std::make_error_code(std::errc::timed_out), name_};
      events_.wait(host_loop::until(protocol_.next_deadline(), before, end - before));
    }
    if (protocol_.state() == Protocol::State::refused) {
      const std::string why{protocol_.problem()};
      throw std::system_error{std::make_error_code(std::errc::connection_refused), name_ + ": " + why};
    }
    if (has_more()) events_.set_alarm(present_, now());  // the first frames have arrived
  }

  Protocol protocol_;

 private:
  static constexpr std::size_t reads_at_once = 4;  ///< between two checks of the time

  [[nodiscard]] ssize_t write(std::string_view text) const {
    if (is_socket_) return ::send(stream_.number(), text.data(), text.size(), MSG_NOSIGNAL);
    return ::write(stream_.number(), text.data(), text.size());
  }

  [[nodiscard]] static bool is_socket(const Descriptor& stream) {
    struct ::stat status {};
    return ::fstat(stream.number(), &status) == 0 && S_ISSOCK(status.st_mode);
  }

  /// Writes pending data, as far as the stream has room.
  void flush() {
    for (;;) {
      if (pending_.empty() && !next_message()) return events_.wait_for_room(false);
      const ssize_t count = write(pending_);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) return events_.wait_for_room(true);
      if (count < 0) throw_errno("write to " + name_);
      pending_.erase(0, static_cast<std::size_t>(count));
    }
  }

  /// Moves the next message to `pending_`; false if there is none.
  [[nodiscard]] bool next_message() {
    if (const std::string_view output = protocol_.output(); !output.empty()) {
      pending_ = output;
      protocol_.output_taken();
    } else if (!queue_.empty() && protocol_.state() == Protocol::State::open) {
      std::array<char, Protocol::longest_message> message;
      pending_.assign(message.data(), Protocol::encode(queue_.front(), message));
      queue_.pop();
    }
    return !pending_.empty();
  }

  /// Reads available bytes; false if there are none.
  [[nodiscard]] bool read_some() {
    const ssize_t count = ::read(stream_.number(), bytes_.data(), bytes_.size());
    read_ = count_ = 0;
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return false;
    if (count < 0) throw_errno("read from " + name_);
    if (count == 0)
      throw std::system_error{std::make_error_code(std::errc::connection_reset), name_ + ": the stream has ended"};
    count_ = static_cast<std::size_t>(count);
    present_ = monotonic_now();
    return true;
  }

  /// Returns a status that has not been reported yet.
  [[nodiscard]] std::optional<PortEvent> status_event() {
    const BusStatus status = protocol_.status();
    if (status == reported_) return std::nullopt;
    if (status.state == BusState::off) queue_.clear();
    reported_ = status;
    return PortEvent{std::nullopt, present_, status};
  }

  Descriptor stream_;
  bool is_socket_;
  std::string name_;
  EventDescriptor events_;
  SendQueue<queue_capacity> queue_;
  std::string pending_;  ///< the part of a message that has not been written yet
  std::array<char, 1024> bytes_{};
  std::size_t count_ = 0;
  std::size_t read_ = 0;  ///< number of these that have been processed
  TimePoint present_ = monotonic_now();
  BusStatus reported_{};
  bool congested_ = false;  ///< there was no room for the last frame
};

}  // namespace canopen

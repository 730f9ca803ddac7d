/// A CAN bus at the other end of a byte stream: what the ports for SLCAN and socketcand share. Host side.
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

#include "canopen/bus_status.hpp"
#include "canopen/frame.hpp"
#include "canopen/port/event_descriptor.hpp"
#include "canopen/port/host_loop.hpp"
#include "canopen/send_queue.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// `Protocol` is SlcanHost or SocketcandClient. A stream that ends, or breaks, throws std::system_error: to connect
/// again is for the application, which knows what was lost.
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

  /// False when the frame is not taken: as many wait as can, or the bus is off.
  [[nodiscard]] bool send(const Frame& frame) {
    congested_ = told_.state == BusState::off;
    if (congested_) return false;
    if (queue_.full()) flush();
    congested_ = !queue_.push(frame);
    flush();
    return !congested_;
  }

  /// The next frame, or nothing when none comes within this time. Throws std::system_error when the stream has ended.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) { return host_loop::receive(*this, timeout); }

  /// When the last frame that `receive` gave has come.
  [[nodiscard]] TimePoint received_at() const { return present_; }

  /// Starts a node and runs it until `stop` is true, which is looked at ten times a second at least.
  template <class Node>
  void run(Node& node, const std::atomic<bool>& stop) {
    host_loop::run(*this, node, stop);
  }

  /// Does what there is to do for a node that has been started, without waiting.
  template <class Node>
  void serve(Node& node) {
    host_loop::serve(*this, node);
  }

  [[nodiscard]] static TimePoint now() { return monotonic_now(); }

  /// Readable when there is something to do, for a poll loop of the application's own.
  [[nodiscard]] int file_descriptor() const { return events_.number(); }

  [[nodiscard]] const BusStatus& status() const { return told_; }

  /// Frames that wait for room.
  [[nodiscard]] std::size_t waiting() const { return queue_.size(); }

  // For host_loop.hpp.

  [[nodiscard]] std::optional<PortEvent> take() {
    flush();
    for (std::size_t reads = 0;; ++reads) {
      while (has_more()) {
        const std::optional<Frame> frame = protocol_.on_character(bytes_[read_++], present_);
        if (frame) return PortEvent{frame, present_, told_};
        if (const auto changed = status_event()) return changed;
      }
      // A stream may bring bytes without end and no frame: time must pass meanwhile.
      if (reads == reads_at_once || !read_some()) break;
    }
    protocol_.on_time(pass_time());
    flush();
    return status_event();
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return protocol_.next_deadline(); }
  [[nodiscard]] Duration hold_off() const {
    if (!congested_) return Duration{0};
    return told_.state == BusState::off ? host_loop::look_again : host_loop::try_again;
  }
  [[nodiscard]] bool has_more() const { return read_ < count_; }
  [[nodiscard]] TimePoint pass_time() { return present_ = monotonic_now(); }
  [[nodiscard]] EventDescriptor& events() { return events_; }

 protected:
  /// `stream` does not block. `name` is for messages.
  StreamPort(Descriptor stream, std::string stream_name)
      : stream_{std::move(stream)}, is_socket_{is_socket(stream_)}, name_{std::move(stream_name)} {
    events_.watch(stream_.number());
  }

  /// Waits until the protocol, which has been started, has opened the bus. Throws std::system_error when it does not
  /// within this time.
  void connect(Duration timeout) {
    const TimePoint end = now() + timeout;
    const auto connecting = [this] { return protocol_.state() == Protocol::State::connecting; };
    while (connecting()) {
      flush();
      for (std::size_t reads = 0; connecting(); ++reads) {
        while (connecting() && has_more()) (void)protocol_.on_character(bytes_[read_++], present_);
        if (!connecting() || reads == reads_at_once || !read_some()) break;
      }
      protocol_.on_time(pass_time());
      flush();
      if (!connecting()) break;
      if (present_ >= end) throw std::system_error{std::make_error_code(std::errc::timed_out), name_};
      events_.wait(host_loop::until(protocol_.next_deadline(), present_, end - present_));
    }
    if (protocol_.state() == Protocol::State::refused) {
      const std::string why{protocol_.problem()};
      throw std::system_error{std::make_error_code(std::errc::connection_refused), name_ + ": " + why};
    }
    if (has_more()) events_.set_alarm(present_, now());  // the first frames are here
  }

  Protocol protocol_;

 private:
  static constexpr std::size_t reads_at_once = 4;  ///< between two looks at the time

  [[nodiscard]] ssize_t write(std::string_view text) const {
    if (is_socket_) return ::send(stream_.number(), text.data(), text.size(), MSG_NOSIGNAL);
    return ::write(stream_.number(), text.data(), text.size());
  }

  [[nodiscard]] static bool is_socket(const Descriptor& stream) {
    struct ::stat status {};
    return ::fstat(stream.number(), &status) == 0 && S_ISSOCK(status.st_mode);
  }

  /// Writes what waits, as far as the stream has room.
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

  /// Puts the next message into `pending_`; false when there is none.
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

  /// Reads what is there; false when that is nothing.
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

  /// Tells a status that has not been told yet.
  [[nodiscard]] std::optional<PortEvent> status_event() {
    const BusStatus status = protocol_.status();
    if (status == told_) return std::nullopt;
    if (status.state == BusState::off) queue_.clear();
    told_ = status;
    return PortEvent{std::nullopt, present_, status};
  }

  Descriptor stream_;
  bool is_socket_;
  std::string name_;
  EventDescriptor events_;
  SendQueue<queue_capacity> queue_;
  std::string pending_;  ///< of a message, what has not been written yet
  std::array<char, 1024> bytes_{};
  std::size_t count_ = 0;
  std::size_t read_ = 0;  ///< of them have been looked at
  TimePoint present_ = monotonic_now();
  BusStatus told_{};
  bool congested_ = false;  ///< the last frame found no room
};

}  // namespace canopen

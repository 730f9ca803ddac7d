/// Linux SocketCAN: a raw CAN socket as a bus, and a loop that runs a node on it. Host side.
#pragma once

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "canopen/frame.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// One CAN interface. Its own frames do not come back, error frames are filtered out.
class SocketCan {
 public:
  /// Throws std::system_error when the interface does not exist or cannot be opened.
  explicit SocketCan(const std::string& interface)
      : socket_{::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)} {
    if (socket_ < 0) fail("socket");
    try {
      open(interface);
    } catch (...) {
      ::close(socket_);
      throw;
    }
  }
  SocketCan(SocketCan&& other) noexcept : socket_{std::exchange(other.socket_, -1)}, congested_{other.congested_} {}
  SocketCan& operator=(SocketCan&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(congested_, other.congested_);
    return *this;
  }
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;
  ~SocketCan() {
    if (socket_ >= 0) ::close(socket_);
  }

  /// False when the interface has no room now, or is down.
  [[nodiscard]] bool send(const Frame& frame) {
    can_frame raw{};
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
    raw.can_dlc = frame.size;
    std::memcpy(raw.data, frame.data.data(), frame.data.size());
    ssize_t written = 0;
    do {
      written = ::write(socket_, &raw, sizeof raw);
    } while (written < 0 && errno == EINTR);
    congested_ = written != static_cast<ssize_t>(sizeof raw);
    return !congested_;
  }

  /// The next frame, or nothing when none comes within this time. Throws std::system_error when the socket is broken.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    pollfd waiting{socket_, POLLIN, 0};
    const timespec span = to_timespec(timeout);
    const int ready = ::ppoll(&waiting, 1, &span, nullptr);
    if (ready < 0 && errno != EINTR) fail("poll");
    return ready > 0 ? take() : std::nullopt;
  }

  /// Runs a node until `stop` is true, which is looked at after each frame and deadline, and ten times a second.
  template <class Node>
  void run(Node& node, const std::atomic<bool>& stop) {
    constexpr Duration look_at_stop{100'000};
    constexpr Duration try_again{1'000};
    node.start(now());
    while (!stop) {
      Duration wait = look_at_stop;
      if (const auto deadline = node.next_deadline()) {
        const TimePoint present = now();
        wait = *deadline > present ? std::min(wait, *deadline - present) : Duration{0};
      }
      if (congested_) wait = std::clamp(wait, try_again, look_at_stop);
      if (const auto frame = receive(wait)) node.on_frame(*frame, now());
      node.on_time(now());
    }
  }

  /// CLOCK_MONOTONIC, cut to what a TimePoint holds.
  [[nodiscard]] static TimePoint now() {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    const auto microseconds =
        static_cast<std::uint64_t>(time.tv_sec) * 1'000'000 + static_cast<std::uint64_t>(time.tv_nsec) / 1'000;
    return TimePoint{Duration{static_cast<std::uint32_t>(microseconds)}};
  }

  /// For a poll loop of the application's own.
  [[nodiscard]] int file_descriptor() const { return socket_; }

 private:
  [[noreturn]] static void fail(const std::string& what) {
    throw std::system_error{errno, std::generic_category(), what};
  }

  void open(const std::string& interface) {
    const unsigned index = ::if_nametoindex(interface.c_str());
    if (index == 0) fail("CAN interface \"" + interface + "\"");
    const can_err_mask_t no_errors = 0;
    if (::setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &no_errors, sizeof no_errors) != 0)
      fail("CAN_RAW_ERR_FILTER");
    const int off = 0;
    if (::setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off) != 0) fail("CAN_RAW_RECV_OWN_MSGS");
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(index);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      fail("bind to \"" + interface + "\"");
  }

  [[nodiscard]] std::optional<Frame> take() {
    can_frame raw{};
    const ssize_t size = ::read(socket_, &raw, sizeof raw);
    if (size < 0 && errno != EAGAIN && errno != EINTR && errno != ENETDOWN) fail("read");
    if (size != static_cast<ssize_t>(sizeof raw) || raw.can_dlc > 8) return std::nullopt;
    Frame frame{};
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.size = raw.can_dlc;
    std::memcpy(frame.data.data(), raw.data, frame.data.size());
    return frame;
  }

  [[nodiscard]] static timespec to_timespec(Duration span) {
    timespec result{};
    result.tv_sec = static_cast<time_t>(span.count() / 1'000'000);
    result.tv_nsec = static_cast<long>(span.count() % 1'000'000) * 1'000;
    return result;
  }

  int socket_;
  bool congested_ = false;  ///< the last frame found no room
};

}  // namespace canopen

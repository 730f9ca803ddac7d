/// Linux SocketCAN: a raw CAN socket as a bus, and a loop that runs a node on it. Host side.
///
///     canopen::SocketCan bus{"can0"};
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5});
///     bus.run(drive, stop);
///
/// In an application's own poll loop: `node.start(bus.now())`, then `bus.serve(node)` once, and again whenever
/// `bus.file_descriptor()` is readable.
#pragma once

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/send_queue.hpp"
#include "canopen/host/event_descriptor.hpp"
#include "canopen/host/host_loop.hpp"
#include "canopen/host/socketcan_frame.hpp"
#include "canopen/node/accepted_frames.hpp"

namespace canopen {

/// One CAN interface, for one node or for an application that calls `receive`. Its own frames are not received. Frames
/// for which the socket has no room wait, the most urgent one first. While the controller is bus-off, or the interface
/// is down or removed, frames are rejected and waiting ones are discarded; an interface that returns, even as a new one
/// with the same name, is used again.
class SocketCan {
 public:
  static constexpr std::size_t queue_capacity = 64;

  /// Throws std::system_error if the interface does not exist or cannot be opened.
  explicit SocketCan(const std::string& interface) : interface_{interface} { open(); }

  /// Sends a frame. Returns false if it is not accepted: the queue is full, or the bus is off or down.
  [[nodiscard]] bool send(const Frame& frame) {
    congested_ = down_ || status_.state == BusState::off;
    if (congested_) return false;
    if (queue_.empty() && write(frame)) return true;
    if (!down_ && queue_.full()) flush();
    congested_ = down_ || !queue_.push(frame);
    return !congested_;
  }

  /// Returns the next frame; empty if none is received within this time. Throws std::system_error if the socket fails.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    accept_all();
    return host_loop::receive(*this, timeout);
  }

  /// Returns when the last frame returned by `receive` was received, by the kernel's clock.
  [[nodiscard]] TimePoint received_at() const { return last_; }

  /// Starts a node and runs it until `stop` is true, which is checked after each frame and deadline, and ten
  /// times a second.
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

  /// Returns the status of the CAN controller, from its error frames.
  [[nodiscard]] const BusStatus& status() const { return status_; }

  /// Returns the number of frames that wait for room.
  [[nodiscard]] std::size_t waiting() const { return queue_.size(); }

  // For host_loop.hpp.

  /// Makes the kernel discard frames that the node ignores.
  template <class SomeNode>
  requires requires { typename SomeNode::DeviceType; }
  void listen_for(SomeNode& node) {
    constexpr std::size_t most = max_accepted_frames<typename SomeNode::DeviceType>;
    if constexpr (most <= CAN_RAW_FILTER_MAX) {
      std::array<can_filter, most> filters;
      std::size_t count = 0;
      for_each_accepted_frame(node,
                              [&](const AcceptedFrame& frame) { filters[count++] = socketcan::filter_of(frame); });
      accept(filters.data(), count);
    }
  }

  [[nodiscard]] std::optional<PortEvent> take() {
    if (down_) reopen();
    if (!down_ && !queue_.empty()) flush();
    for (;;) {
      if (read_ == received_count_ && (std::exchange(drained_, false) || !read_batch())) break;
      const can_frame& raw = received_[read_];
      advance(times_[read_]);
      if ((raw.can_id & CAN_ERR_FLAG) != 0) {
        note_error(raw);
        ++read_;
      } else if (status_.state == BusState::off) {
        status_.state = BusState::active;  // a controller that receives frames is on the bus
      } else if (status_ == reported_) {
        ++read_;
        return PortEvent{socketcan::frame_of(raw), last_, status_};
      }
      if (const auto changed = status_event()) return changed;
    }
    if (status_.overrun && pass_time() >= overrun_end_) status_.overrun = false;
    return status_event();
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next;
    const auto consider = [&next](bool counts, TimePoint time) {
      if (counts && (!next || time < *next)) next = time;
    };
    consider(down_, reopen_at_);
    consider(retry_, retry_at_);
    consider(status_.overrun, overrun_end_);
    return next;
  }

  [[nodiscard]] Duration hold_off() const {
    if (!congested_) return Duration{0};
    return down_ || status_.state == BusState::off ? host_loop::look_again : host_loop::try_again;
  }
  [[nodiscard]] bool has_more() const { return read_ < received_count_; }
  [[nodiscard]] TimePoint pass_time() {
    advance(now());
    return last_;
  }
  [[nodiscard]] EventDescriptor& events() { return events_; }

 private:
  static constexpr std::size_t batch = 16;
  static constexpr Duration overrun_span{1'000'000};  ///< how long a loss of frames is reported
  static constexpr int receive_buffer = 1 << 20;      ///< bytes; the kernel may give less

  // The interface

  void open() {
    const unsigned index = ::if_nametoindex(interface_.c_str());
    if (index == 0) throw_errno("CAN interface \"" + interface_ + "\"");
    Descriptor fresh = opened(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW), "socket");
    const can_err_mask_t errors = CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
    socketcan::set_option(fresh, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors);
    socketcan::set_option(fresh, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, int{0});
    socketcan::set_option(fresh, SOL_SOCKET, SO_TIMESTAMPNS, int{1});
    socketcan::set_option(fresh, SOL_SOCKET, SO_RXQ_OVFL, int{1});
    socketcan::set_option(fresh, SOL_SOCKET, SO_RCVBUF, receive_buffer);
    // Only few frames of one socket wait in the kernel, where none can overtake them.
    socketcan::set_option(fresh, SOL_SOCKET, SO_SNDBUF, int{0});
    if (!filters_.empty()) set_filters(fresh);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(index);
    if (::bind(fresh.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw_errno("bind to \"" + interface_ + "\"");
    }
    events_.watch(fresh.number());
    socket_ = std::move(fresh);
    index_ = index;
    lost_ = 0;
  }

  void go_down() {
    down_ = true;
    drop_queue();
    reopen_at_ = now() + host_loop::look_again;
  }

  /// Checks whether the interface exists and is up. A new one with the same name needs a new socket.
  void reopen() {
    const TimePoint present = now();
    if (present < reopen_at_) return;
    reopen_at_ = present + host_loop::look_again;
    const unsigned index = ::if_nametoindex(interface_.c_str());
    if (index == 0) return;
    if (index != index_) {
      try {
        open();
      } catch (const std::system_error&) {
        return;  // it has been removed again
      }
    }
    ifreq request{};
    interface_.copy(request.ifr_name, sizeof request.ifr_name - 1);
    if (::ioctl(socket_.number(), SIOCGIFFLAGS, &request) != 0 || (request.ifr_flags & IFF_UP) == 0) return;
    down_ = false;
    congested_ = false;
    status_.state = BusState::active;
  }

  // Filters

  [[nodiscard]] static bool same_filter(const can_filter& a, const can_filter& b) {
    return a.can_id == b.can_id && a.can_mask == b.can_mask;
  }

  /// Sets the filters. They change rarely: the kernel is called only if they do.
  void accept(const can_filter* filters, std::size_t count) {
    if (std::equal(filters, filters + count, filters_.begin(), filters_.end(), same_filter)) return;
    filters_.assign(filters, filters + count);
    set_filters(socket_);
  }

  void accept_all() {
    if (filters_.empty() || same_filter(filters_.front(), socketcan::every_frame)) return;
    filters_.clear();
    filters_.push_back(socketcan::every_frame);
    set_filters(socket_);
  }

  void set_filters(const Descriptor& socket) const {
    const auto size = static_cast<socklen_t>(filters_.size() * sizeof(can_filter));
    if (::setsockopt(socket.number(), SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(), size) != 0) {
      throw_errno("CAN_RAW_FILTER");
    }
  }

  // Sending

  /// Returns false if the socket has no room, or the interface is down.
  [[nodiscard]] bool write(const Frame& frame) {
    const can_frame raw = socketcan::raw_of(frame);
    ssize_t written = 0;
    do {
      written = ::write(socket_.number(), &raw, sizeof raw);
    } while (written < 0 && errno == EINTR);
    if (written == static_cast<ssize_t>(sizeof raw)) return true;
    switch (errno) {
      case EAGAIN: events_.wait_for_room(true); break;
      case ENOBUFS:  // the queue of the interface is full; no descriptor reports when it is not
        retry_ = true;
        retry_at_ = now() + host_loop::try_again;
        break;
      case ENETDOWN:
      case ENXIO:
      case ENODEV: go_down(); break;
      default: throw_errno("write to \"" + interface_ + "\"");
    }
    return false;
  }

  void drop_queue() {
    queue_.clear();
    retry_ = false;
    events_.wait_for_room(false);
  }

  void flush() {
    if (retry_ && now() < retry_at_) return;
    retry_ = false;
    while (!queue_.empty() && write(queue_.front())) queue_.pop();
    if (queue_.empty()) events_.wait_for_room(false);
  }

  // Receiving

  /// Reads available frames; false if there are none.
  [[nodiscard]] bool read_batch() {
    read_ = received_count_ = 0;
    std::array<iovec, batch> parts;
    std::array<socketcan::Control, batch> control;
    std::array<mmsghdr, batch> headers;
    for (std::size_t i = 0; i < batch; ++i) {
      parts[i] = {&received_[i], sizeof received_[i]};
      headers[i] = {};
      headers[i].msg_hdr.msg_iov = &parts[i];
      headers[i].msg_hdr.msg_iovlen = 1;
      headers[i].msg_hdr.msg_control = control[i].bytes;
      headers[i].msg_hdr.msg_controllen = sizeof control[i].bytes;
    }
    const int count = ::recvmmsg(socket_.number(), headers.data(), batch, 0, nullptr);
    if (count <= 0) {
      if (count < 0) read_failed();
      return false;
    }
    received_count_ = static_cast<std::size_t>(count);
    drained_ = received_count_ < batch;
    const socketcan::Clocks clocks = socketcan::read_clocks();
    for (std::size_t i = 0; i < received_count_; ++i) times_[i] = time_of(headers[i].msg_hdr, clocks);
    return true;
  }

  void read_failed() {
    switch (errno) {
      case EAGAIN:
      case EINTR: return;
      case ENETDOWN:
      case ENXIO:
      case ENODEV: return go_down();
      default: throw_errno("read from \"" + interface_ + "\"");
    }
  }

  /// Returns when a frame was received: the kernel's time stamp, converted to the clock of `now`. Counts frames that
  /// were lost before it.
  [[nodiscard]] TimePoint time_of(msghdr& message, const socketcan::Clocks& clocks) {
    constexpr std::int64_t most = 1'000'000'000;  // older ones mean that the clock was set
    TimePoint time = clocks.monotonic;
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
      if (part->cmsg_level != SOL_SOCKET) continue;
      if (part->cmsg_type == SCM_TIMESTAMPNS) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
        const std::int64_t age = clocks.real - socketcan::nanoseconds(stamp);
        const bool plausible = age > 0 && age < most;
        if (plausible) time = TimePoint{time.since_start() - Duration{static_cast<std::uint32_t>(age / 1'000)}};
      } else if (part->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t lost = 0;
        std::memcpy(&lost, CMSG_DATA(part), sizeof lost);
        if (lost != lost_) note_overrun(clocks.monotonic);
        lost_ = lost;
      }
    }
    return time;
  }

  // Status

  /// Processes an error frame of the controller (linux/can/error.h).
  void note_error(const can_frame& raw) {
    constexpr std::uint8_t passive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
    constexpr std::uint8_t not_passive = CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING;
    if ((raw.can_id & CAN_ERR_RESTARTED) != 0) status_.state = BusState::active;
    if ((raw.can_id & CAN_ERR_CRTL) != 0) {
      if ((raw.data[1] & CAN_ERR_CRTL_RX_OVERFLOW) != 0) note_overrun(last_);
      if (status_.state != BusState::off && (raw.data[1] & passive) != 0) {
        status_.state = BusState::passive;
      } else if (status_.state != BusState::off && (raw.data[1] & not_passive) != 0) {
        status_.state = BusState::active;
      }
    }
    if ((raw.can_id & CAN_ERR_BUSOFF) != 0) status_.state = BusState::off;
  }

  void note_overrun(TimePoint time) {
    status_.overrun = true;
    overrun_end_ = time + overrun_span;
  }

  /// Keeps time from going back: a frame may have been received before the time last passed to the node.
  void advance(TimePoint time) {
    constexpr Duration most{2'000'000};
    if (last_ - time > most) last_ = time;
  }

  /// Returns a status that has not been reported yet.
  [[nodiscard]] std::optional<PortEvent> status_event() {
    if (status_ == reported_) return std::nullopt;
    if (status_.state == BusState::off) drop_queue();
    reported_ = status_;
    return PortEvent{std::nullopt, last_, status_};
  }

  std::string interface_;
  EventDescriptor events_;
  Descriptor socket_;
  unsigned index_ = 0;               ///< of the interface that the socket is bound to
  std::vector<can_filter> filters_;  ///< empty: every frame
  SendQueue<queue_capacity> queue_;

  std::array<can_frame, batch> received_{};
  std::array<TimePoint, batch> times_{};
  std::size_t received_count_ = 0;
  std::size_t read_ = 0;    ///< number of these that have been passed on
  TimePoint last_ = now();  ///< of the last frame
  bool drained_ = false;    ///< the last batch was not full: there are no more frames
  std::uint32_t lost_ = 0;  ///< frames for which the socket was full, counted by the kernel

  BusStatus status_{};
  BusStatus reported_{};
  TimePoint overrun_end_{};
  TimePoint reopen_at_{};
  TimePoint retry_at_{};
  bool retry_ = false;  ///< the interface had no room: wait until retry_at_
  bool down_ = false;
  bool congested_ = false;  ///< there was no room for the last frame
};

}  // namespace canopen

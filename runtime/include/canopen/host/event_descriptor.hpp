/// One descriptor of the operating system that becomes readable when others have events, or at a point in time: for the
/// poll loop of an application. Linux, host side.
#pragma once

#include <poll.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>

#include "canopen/base/clock.hpp"
#include "canopen/host/descriptor.hpp"

namespace canopen {

/// Returns CLOCK_MONOTONIC, truncated to a TimePoint.
[[nodiscard]] inline TimePoint monotonic_now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  const auto microseconds =
      static_cast<std::uint64_t>(time.tv_sec) * 1'000'000 + static_cast<std::uint64_t>(time.tv_nsec) / 1'000;
  return TimePoint{Duration{static_cast<std::uint32_t>(microseconds)}};
}

[[nodiscard]] inline timespec to_timespec(Duration span) {
  timespec result{};
  result.tv_sec = static_cast<time_t>(span.count() / 1'000'000);
  result.tv_nsec = static_cast<long>(span.count() % 1'000'000) * 1'000;
  return result;
}

/// Throws the error of the last system call.
[[noreturn]] inline void throw_errno(const std::string& what) {
  throw std::system_error{errno, std::generic_category(), what};
}

/// Returns the descriptor that a system call has opened. Throws std::system_error if the call has failed.
[[nodiscard]] inline Descriptor opened(int number, const std::string& what) {
  if (number < 0) throw_errno(what);
  return Descriptor{number};
}

class EventDescriptor {
 public:
  EventDescriptor()
      : epoll_{opened(::epoll_create1(EPOLL_CLOEXEC), "epoll_create1")},
        timer_{opened(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC), "timerfd_create")},
        wake_{opened(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC), "eventfd")} {
    control(EPOLL_CTL_ADD, timer_.number(), EPOLLIN);
    control(EPOLL_CTL_ADD, wake_.number(), EPOLLIN);
  }

  /// Readable when there is an event.
  [[nodiscard]] int number() const { return epoll_.number(); }

  /// Watches `descriptor` for reading, instead of the previous one, which has been or will be closed.
  void watch(int descriptor) {
    control(EPOLL_CTL_ADD, descriptor, EPOLLIN);
    watched_ = descriptor;
    waits_for_room_ = false;
  }

  /// Sets whether to watch it for writing as well.
  void wait_for_room(bool wanted) {
    if (wanted == waits_for_room_) return;
    control(EPOLL_CTL_MOD, watched_, wanted ? EPOLLIN | EPOLLOUT : EPOLLIN);
    waits_for_room_ = wanted;
  }

  /// Makes it readable from this time on, until the next call. An alarm that is already set for an earlier
  /// time is kept.
  void set_alarm(std::optional<TimePoint> at, TimePoint now) {
    const bool ringing = alarm_ && *alarm_ <= now;
    if (!at && !ringing) return;
    if (at && alarm_ && !ringing && *alarm_ <= *at) return;
    if (at && ringing && *at <= now) return;
    itimerspec setting{};
    if (at) setting.it_value = to_timespec(*at > now ? *at - now : Duration{0});
    if (at && setting.it_value.tv_sec == 0 && setting.it_value.tv_nsec == 0) setting.it_value.tv_nsec = 1;
    if (::timerfd_settime(timer_.number(), 0, &setting, nullptr) != 0) throw_errno("timerfd_settime");
    alarm_ = at;
  }

  /// Waits until the descriptor has an event or is woken, for this time at most.
  void wait(Duration timeout) const {
    std::array<pollfd, 2> waiting{{
        {watched_, static_cast<short>(waits_for_room_ ? POLLIN | POLLOUT : POLLIN), 0},
        {wake_.number(), POLLIN, 0},
    }};
    const timespec span = to_timespec(timeout);
    if (::ppoll(waiting.data(), waiting.size(), &span, nullptr) < 0 && errno != EINTR) throw_errno("poll");
    if (waiting[1].revents != 0) take_wake();
  }

  /// Makes it readable until `take_wake`, and ends `wait`. Any thread and a signal handler may call it.
  void wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(::write(wake_.number(), &one, sizeof one));  // fails only if it is readable already
  }

  /// What was set before `wake` can be seen after this call.
  void take_wake() const {
    std::uint64_t count = 0;
    static_cast<void>(::read(wake_.number(), &count, sizeof count));
  }

 private:
  void control(int operation, int descriptor, std::uint32_t events) const {
    epoll_event event{};
    event.events = events;
    if (::epoll_ctl(epoll_.number(), operation, descriptor, &event) != 0) throw_errno("epoll_ctl");
  }

  Descriptor epoll_;
  Descriptor timer_;
  Descriptor wake_;
  std::optional<TimePoint> alarm_;
  int watched_ = -1;
  bool waits_for_room_ = false;
};

}  // namespace canopen

/// The periodic functions of the application: node/period.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/service_set.hpp"

namespace canopen::service {

/// Calls each function at start + n * period, for n from 1, in each NMT state and without node-ID. A call that is late
/// does not delay the following ones. Of several that have been missed, one is made.
template <class Device, class... Handlers>
class Periodic : public ServiceDefaults<Periodic<Device, Handlers...>> {
  static constexpr std::size_t count = (handler_detail::PeriodsOf<Handlers>::type::size + ... + std::size_t{0});

 public:
  static constexpr bool exists = count != 0;
  static constexpr bool runs_without_node_id = true;

  template <class Host>
  void on_start(Host& host) {
    auto next = next_.begin();
    host.handlers.for_each_period(host.node(), [&](Duration period, auto&&) { *next++ = host.now + period; });
    runs_ = true;
  }

  template <class Host>
  void on_time(Host& host) {
    if (!runs_) return;
    auto next = next_.begin();
    const TimePoint now = host.now;
    host.handlers.for_each_period(host.node(), [&](Duration period, auto&& call) {
      TimePoint& due = *next++;
      if (is_within(due, period, now)) return;
      due = due + period;
      if (!is_within(due, period, now)) due = now + (period - (now - due) % period.count());
      call();
    });
  }

  template <class Host>
  std::optional<TimePoint> deadline(Host&) const {
    if (!runs_) return std::nullopt;
    TimePoint first = next_[0];
    for (const TimePoint due : next_) {
      if (due < first) first = due;
    }
    return first;
  }

 private:
  std::array<TimePoint, count> next_{};
  bool runs_ = false;  ///< since `start`
};

}  // namespace canopen::service

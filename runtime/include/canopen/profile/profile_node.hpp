/// What the nodes of the profiles have in common: they are used like a node.
#pragma once

#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"

namespace canopen {

/// Base of a class `Profile` with the functions
///
///     auto& node();                     // the same const
///     void on_time(TimePoint now);
///     void after_event(TimePoint now);  // the node has processed a frame or a change of the bus status
template <class Profile>
class ProfileNode {
 public:
  ProfileNode(const ProfileNode&) = delete;
  ProfileNode& operator=(const ProfileNode&) = delete;

  void start(TimePoint now) {
    profile().node().start(now);
    profile().on_time(now);
  }
  void on_frame(const Frame& frame, TimePoint now) {
    profile().node().on_frame(frame, now);
    profile().after_event(now);
  }
  void on_bus_status(const BusStatus& status, TimePoint now) {
    profile().node().on_bus_status(status, now);
    profile().after_event(now);
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return static_cast<const Profile&>(*this).node().next_deadline();
  }
  [[nodiscard]] std::optional<TimePoint> next_periodic_call() const {
    return static_cast<const Profile&>(*this).node().next_periodic_call();
  }

 protected:
  constexpr ProfileNode() = default;

 private:
  [[nodiscard]] Profile& profile() { return static_cast<Profile&>(*this); }
};

}  // namespace canopen

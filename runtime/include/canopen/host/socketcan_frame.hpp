/// What Linux SocketCAN and the runtime exchange: frames, filters, options and times.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/host/descriptor.hpp"
#include "canopen/host/event_descriptor.hpp"
#include "canopen/node/accepted_frames.hpp"

namespace canopen {

namespace socketcan {

inline constexpr can_filter every_frame{0, 0};

/// Returns the filter for the frames that a node accepts.
[[nodiscard]] inline can_filter filter_of(const AcceptedFrame& frame) {
  can_filter filter{};
  filter.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
  filter.can_mask = (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG;
  return filter;
}

/// Returns a frame as the kernel transmits it.
[[nodiscard]] inline can_frame raw_of(const Frame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
  raw.can_dlc = frame.size;
  std::memcpy(raw.data, frame.data.data(), frame.data.size());
  return raw;
}

[[nodiscard]] inline Frame frame_of(const can_frame& raw) {
  Frame frame{};
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = std::min<std::uint8_t>(raw.can_dlc, 8);
  std::memcpy(frame.data.data(), raw.data, frame.data.size());
  return frame;
}

[[nodiscard]] inline std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// The same time on two clocks.
struct Clocks {
  std::int64_t real;  ///< CLOCK_REALTIME in ns
  TimePoint monotonic;
};
[[nodiscard]] inline Clocks read_clocks() {
  timespec clock{};
  ::clock_gettime(CLOCK_REALTIME, &clock);
  return {nanoseconds(clock), monotonic_now()};
}

/// Room for a time stamp and the number of lost frames of a message.
struct Control {
  alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))];
};

template <class Value>
void set_option(const Descriptor& socket, int level, int name, const Value& value) {
  if (::setsockopt(socket.number(), level, name, &value, sizeof value) != 0) throw_errno("CAN socket option");
}

}  // namespace socketcan

}  // namespace canopen

/// A node on a bus that records frames; frames are written as in a candump log.
#pragma once

#include <canopen/node.hpp>
#include <cstdio>
#include <deque>
#include <limits>
#include <sample/device.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "omitting.hpp"

namespace bench {

/// "605 40 00 10 00 00 00 00 00": CAN-ID and data bytes. A CAN-ID of three characters has 11 bits, one of eight 29.
/// "185 R 8" is a remote frame.
inline canopen::Frame frame(const std::string& text) {
  std::istringstream words{text};
  std::string word;
  words >> word;
  canopen::Frame result{};
  result.id = static_cast<std::uint32_t>(std::stoul(word, nullptr, 16));
  result.extended = word.size() == 8;
  while (words >> word) {
    if (word == "R") {
      result.remote = true;
    } else if (result.remote) {
      result.size = static_cast<std::uint8_t>(std::stoul(word));
    } else {
      result.data.at(result.size++) = static_cast<std::uint8_t>(std::stoul(word, nullptr, 16));
    }
  }
  return result;
}

inline std::string text(const canopen::Frame& frame) {
  char piece[16];
  std::snprintf(piece, sizeof piece, frame.extended ? "%08X" : "%03X", static_cast<unsigned>(frame.id));
  std::string result = piece;
  if (frame.remote) return result + " R " + std::to_string(frame.size);
  for (std::size_t i = 0; i < frame.size; ++i) {
    std::snprintf(piece, sizeof piece, " %02X", static_cast<unsigned>(frame.data.at(i)));
    result += piece;
  }
  return result;
}

struct RecordingBus {
  std::deque<canopen::Frame> sent;
  std::size_t room = std::numeric_limits<std::size_t>::max();  ///< frames that the bus still accepts

  bool send(const canopen::Frame& frame) {
    if (room == 0) return false;
    --room;
    sent.push_back(frame);
    return true;
  }

  /// All frames sent since the last call, with " | " between them.
  std::string take() {
    std::string result;
    for (; !sent.empty(); sent.pop_front()) result += (result.empty() ? "" : " | ") + text(sent.front());
    return result;
  }
};

/// A device with node-ID 5, switched on at time 0; its boot-up message has been removed.
template <class Device = sample::Device, class... Handlers>
class Bench {
 public:
  explicit Bench(Handlers... handlers) : node{bus, canopen::NodeId{5}, std::move(handlers)...} {
    node.start(now);
    bus.take();
  }

  /// Returns what the device sends in response to this frame.
  std::string ask(const std::string& request) {
    node.on_frame(frame(request), now);
    return bus.take();
  }

  /// Returns what the device sends during this time: `on_time` is called at each deadline and at the end.
  std::string pass(canopen::Duration span) {
    const canopen::TimePoint end = now + span;
    while (const auto deadline = node.next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now) now = *deadline;
      node.on_time(now);
      if (bus.room == 0) break;
    }
    now = end;
    node.on_time(now);
    return bus.take();
  }

  RecordingBus bus;
  canopen::TimePoint now{};
  bench::NodeOf<Device, RecordingBus, Handlers...> node;
};

template <class Device = sample::Device, class... Handlers>
Bench<Device, Handlers...> with(Handlers... handlers) {
  return Bench<Device, Handlers...>{std::move(handlers)...};
}

inline constexpr auto start = "000 01 05";
inline constexpr auto stop = "000 02 05";
inline constexpr auto enter_pre_operational = "000 80 05";
inline constexpr auto reset_node = "000 81 05";
inline constexpr auto reset_communication = "000 82 05";

}  // namespace bench

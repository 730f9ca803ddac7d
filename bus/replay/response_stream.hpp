/// The frames of one service of a node, in their order: those of the log, and those that were received.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <optional>

#include "decode/message.hpp"
#include "replay/replay.hpp"

namespace edsc::replay {

/// What is compared with each other.
struct StreamKey {
  Service service{};
  std::uint32_t place = 0;  ///< SDO: the channel; PDO: the COB-ID; otherwise the node-ID
  friend auto operator<=>(const StreamKey&, const StreamKey&) = default;
};

/// A frame of a node, from the log or received.
struct StreamFrame {
  DecodedFrame decoded;
  std::uint8_t node_id = 0;
  std::int64_t at_us = 0;  ///< of the replay
  std::size_t line = 0;
  bool has_time = false;
  std::int64_t log_us = 0;
  std::optional<EntryKey> entry;
  bool is_abort = false;
  std::uint32_t abort_code = 0;
};

struct ResponseStream {
  std::deque<StreamFrame> expected, received;
  std::optional<DecodedFrame> request;
  std::optional<EntryKey> entry;  ///< of the SDO transfer
  bool skips = false;  ///< an ignored SDO transfer, or one with a difference: not compared until the next one
  std::optional<canopen::Frame> last_expected, last_received;  ///< of a PDO
};

/// Whether the next request waits for responses of this service.
[[nodiscard]] constexpr bool is_awaited(Service service) {
  return service == Service::sdo || service == Service::lss || service == Service::boot_up ||
         service == Service::guarding;
}

/// Whether all responses precede the next request: those that remain are additional.
[[nodiscard]] constexpr bool follows_requests(Service service) {
  return service == Service::sdo || service == Service::lss || service == Service::guarding;
}

/// The kind of the difference between two frames; nothing if they are equal.
[[nodiscard]] std::optional<DifferenceKind> compare(Service service, const StreamFrame& expected,
                                                    const StreamFrame& received);

}  // namespace edsc::replay

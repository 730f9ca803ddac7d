/// Worst-case response times of CAN messages, by R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: "Controller Area
/// Network (CAN) schedulability analysis: Refuted, revisited and revised", Real-Time Systems 35 (2007), pages 239-272.
///
/// The analysis assumes that each node sends the frame of highest priority among those that it has queued. It does not
/// hold for a node whose transmit buffers are a FIFO, or whose driver lets a queued frame of low priority block one of
/// high priority. Frames have the largest possible number of stuff bits.
///
/// Times are whole nanoseconds, and rounded up: a bit time that is not a whole number of nanoseconds is too long by
/// less than one. No comparison uses floating point.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edsc {

using Nanoseconds = std::chrono::nanoseconds;

/// Longest period, jitter and interval of errors, and longest busy period that is examined.
inline constexpr Nanoseconds max_message_time = std::chrono::hours{24};
/// With more messages, the sums of the analysis could exceed 64 bits.
inline constexpr std::size_t max_message_count = 16'384;

/// One message: the frames that one node sends with one CAN-ID.
///
/// Synchronous PDOs are messages with the period of SYNC (1006h) times the transmission type, at least 1. All are
/// queued after the same SYNC, which is the worst case of the analysis anyway: it does not know offsets. The caller
/// adds to the jitter the worst response time of the SYNC frame and the time that a node needs from its reception to
/// the PDO in its transmit buffer. The worst response time of the PDO is then measured from the moment when SYNC was
/// due; the synchronous window length (1007h) begins later, so that a PDO with a response time up to 1007h is in the
/// window. With a deadline of 1007h, `meets_deadline` says so.
struct CanMessage {
  std::uint32_t can_id = 0;  ///< 11 bits, or 29 with `extended`
  bool extended = false;
  bool remote = false;
  std::uint8_t size = 8;  ///< data bytes, 0..8; of a remote frame the requested ones, which it does not contain
  /// Period, or shortest time between two events that queue the message: 0..24 h. Zero means that nothing limits the
  /// rate, as of an event-driven PDO without inhibit time: neither this message nor one of lower priority has a bound.
  Nanoseconds period{};
  /// Longest time from the event to the frame in the transmit buffer, 0..24 h; the shortest is zero. It may be longer
  /// than the period, but the frames are queued in the order of their events.
  Nanoseconds jitter{};
  std::optional<Nanoseconds> deadline{};  ///< from the event to the end of the frame; none means `period`
};

/// The longest response time that meets the deadline: without one, the period.
[[nodiscard]] constexpr Nanoseconds deadline_of(const CanMessage& message) {
  return message.deadline.value_or(message.period);
}

struct BusTiming {
  std::uint32_t bit_rate = 0;  ///< bit/s: 1,000..1,000,000
  /// Shortest time between two errors, up to 24 h; none if there are no errors. Each error costs 31 bit times and the
  /// longest frame that may have to be repeated.
  std::optional<Nanoseconds> error_interval{};
};

enum class ResponseBound : std::uint8_t {
  found,
  /// Messages of the same and of higher priority, with the errors, need the whole bus: the response time grows without
  /// limit. A utilisation of less than 1 by at most 2^-32 for each message counts as 1.
  overload,
  /// The busy period is longer than `max_message_time` or takes too many steps; the utilisation is nearly 1. This takes
  /// less than a second.
  not_found,
};

/// Results for one message. Times end with the intermission: the frame itself is received three bit times earlier.
struct ResponseTime {
  ResponseBound bound = ResponseBound::overload;
  Nanoseconds transmission{};              ///< of its frame, with all stuff bits
  Nanoseconds blocking{};                  ///< longest frame of lower priority
  std::optional<Nanoseconds> busy_period;  ///< longest time for which the bus has frames of this or higher priority
  std::uint64_t instances = 0;             ///< frames of this message in the busy period; each is examined
  std::optional<Nanoseconds> worst;        ///< from the event, jitter included; only if `bound` is `found`
  bool meets_deadline = false;             ///< false without a bound
};

/// Whether the members have values in the ranges given above, and the CAN-ID fits the format.
[[nodiscard]] bool is_valid(const CanMessage& message);
[[nodiscard]] bool is_valid(const BusTiming& bus);

/// Returns the worst-case response times of all messages, in their order. If the bus or a message is not valid, or
/// there are more than `max_message_count` messages, the result is empty.
///
/// The priority is the arbitration of ISO 11898-1: an 11-bit frame wins over a 29-bit one whose first 11 bits are the
/// same, a data frame over a remote one. Each of several messages that arbitration cannot distinguish, such as a COB-ID
/// of two nodes, is delayed by the others as by messages of higher priority. This bounds the delay, but if both nodes
/// start at the same time, their data collide: such a network is faulty.
[[nodiscard]] std::vector<ResponseTime> response_times(std::span<const CanMessage> messages, const BusTiming& bus);

/// The part of the time for which the bus is busy; 1 is a full bus. For display.
struct BusLoad {
  double min = 0;  ///< frames without stuff bits
  double max = 0;  ///< frames with the largest possible number of stuff bits
};

/// Returns the load by all messages with a period, without errors. Zeros if the bus or a message is not valid.
[[nodiscard]] BusLoad bus_load(std::span<const CanMessage> messages, const BusTiming& bus);

}  // namespace edsc

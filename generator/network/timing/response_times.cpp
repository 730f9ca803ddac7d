#include "network/timing/response_times.hpp"

#include <algorithm>
#include <canopen/can/arbitration.hpp>
#include <canopen/can/frame_length.hpp>

namespace edsc {
namespace {

constexpr std::uint32_t error_bits = 31;  ///< error flags, error delimiter and intermission, at most
/// The utilisation is counted in units of 2^-32.
constexpr std::int64_t full_utilisation = std::int64_t{1} << 32;
/// Terms of the sums that are computed for one message before the search ends.
constexpr std::size_t max_terms = 20'000'000;

/// A message as the analysis uses it, with the names of the paper.
struct QueuedMessage {
  std::uint64_t arbitration = 0;
  std::size_t place = 0;  ///< in the messages of the caller
  Nanoseconds c{};        ///< transmission time
  Nanoseconds t{};        ///< period
  Nanoseconds j{};        ///< jitter
};

[[nodiscard]] canopen::Frame frame_of(const CanMessage& message) {
  return {.id = message.can_id, .size = message.size, .extended = message.extended, .remote = message.remote};
}

[[nodiscard]] Nanoseconds bit_time_of(const BusTiming& bus) {
  constexpr std::uint32_t second = 1'000'000'000;
  return Nanoseconds{(second + bus.bit_rate - 1) / bus.bit_rate};
}

/// How many periods begin in [0, time): time / period, rounded up.
[[nodiscard]] std::int64_t periods_in(Nanoseconds time, Nanoseconds period) {
  return (time + period - Nanoseconds{1}) / period;
}

/// Whether C / T summed over the messages is less than 1. Sums stay below 2^63: a quotient is at most 1.6e8 * 2^32.
class Utilisation {
 public:
  void add(Nanoseconds c, Nanoseconds t) {
    if (is_full()) return;
    sum_ += t.count() == 0 ? full_utilisation : (c.count() * full_utilisation + t.count() - 1) / t.count();
  }
  [[nodiscard]] bool is_full() const { return sum_ >= full_utilisation; }

 private:
  std::int64_t sum_ = 0;
};

/// The analysis of one message. With a utilisation of less than 1, each C is less than its T, so that a term
/// periods_in(x, T) * C is less than x + C. As x is at most 48 h and a second, 16,384 terms are below 3e18 ns.
class BusyPeriod {
 public:
  /// `same_or_higher` has `message` and all messages that may delay it, except for the blocking. Each error costs
  /// `error_cost`.
  BusyPeriod(std::span<const QueuedMessage> same_or_higher, const QueuedMessage& message, Nanoseconds blocking,
             Nanoseconds error_cost, const BusTiming& bus)
      : all_{same_or_higher},
        message_{message},
        blocking_{blocking},
        bit_time_{bit_time_of(bus)},
        error_cost_{error_cost},
        error_interval_{bus.error_interval},
        steps_left_{max_terms / same_or_higher.size()} {}

  void examine(ResponseTime& result) {
    const std::optional<Nanoseconds> length = fixed_point(message_.c, [&](Nanoseconds length_so_far) {
      Nanoseconds sum = blocking_ + errors_in(length_so_far);
      for (const QueuedMessage& other : all_) sum += periods_in(length_so_far + other.j, other.t) * other.c;
      return sum;
    });
    if (!length) return;
    const std::int64_t instances = periods_in(*length + message_.j, message_.t);
    Nanoseconds worst{};
    Nanoseconds wait = blocking_;
    for (std::int64_t instance = 0; instance < instances; ++instance) {
      const std::optional<Nanoseconds> found = longest_wait(instance, wait);
      if (!found) return;
      worst = std::max(worst, message_.j + *found - instance * message_.t + message_.c);
      wait = *found + message_.c;
    }
    result.bound = ResponseBound::found;
    result.busy_period = length;
    result.instances = static_cast<std::uint64_t>(instances);
    result.worst = worst;
  }

 private:
  /// From the begin of the busy period until the frame of this instance, counted from 0, wins the arbitration. A frame
  /// that is queued up to one bit time later still takes part in it.
  [[nodiscard]] std::optional<Nanoseconds> longest_wait(std::int64_t instance, Nanoseconds at_least) {
    return fixed_point(at_least, [&](Nanoseconds wait) {
      Nanoseconds sum = blocking_ + instance * message_.c + errors_in(wait + message_.c);
      for (const QueuedMessage& other : all_) {
        if (&other != &message_) sum += periods_in(wait + other.j + bit_time_, other.t) * other.c;
      }
      return sum;
    });
  }

  [[nodiscard]] Nanoseconds errors_in(Nanoseconds time) const {
    return error_interval_ ? periods_in(time, *error_interval_) * error_cost_ : Nanoseconds{};
  }

  /// Repeats `next`, which does not decrease, until it returns its argument. None if it exceeds the longest time, or
  /// the steps for this message are used up.
  template <class Next>
  [[nodiscard]] std::optional<Nanoseconds> fixed_point(Nanoseconds time, Next next) {
    while (steps_left_ > 0 && time <= max_message_time) {
      --steps_left_;
      const Nanoseconds sum = next(time);
      if (sum == time) return time;
      time = sum;
    }
    return std::nullopt;
  }

  std::span<const QueuedMessage> all_;
  const QueuedMessage& message_;
  Nanoseconds blocking_;
  Nanoseconds bit_time_;
  Nanoseconds error_cost_;
  std::optional<Nanoseconds> error_interval_;
  std::size_t steps_left_;
};

/// The messages in the order of arbitration, the dominant one first.
[[nodiscard]] std::vector<QueuedMessage> by_priority(std::span<const CanMessage> messages, const BusTiming& bus) {
  std::vector<QueuedMessage> queued;
  queued.reserve(messages.size());
  for (const CanMessage& message : messages) {
    const canopen::Frame frame = frame_of(message);
    queued.push_back({canopen::arbitration_value(frame), queued.size(),
                      canopen::max_bits_on_wire(frame) * bit_time_of(bus), message.period, message.jitter});
  }
  std::ranges::stable_sort(queued, {}, &QueuedMessage::arbitration);
  return queued;
}

[[nodiscard]] bool are_valid(std::span<const CanMessage> messages, const BusTiming& bus) {
  return is_valid(bus) && messages.size() <= max_message_count &&
         std::ranges::all_of(messages, [](const CanMessage& message) { return is_valid(message); });
}

[[nodiscard]] bool is_message_time(Nanoseconds time) { return time >= Nanoseconds{} && time <= max_message_time; }

}  // namespace

bool is_valid(const CanMessage& message) {
  const std::uint32_t max_can_id = message.extended ? 0x1FFF'FFFF : 0x7FF;
  return message.can_id <= max_can_id && message.size <= 8 && is_message_time(message.period) &&
         is_message_time(message.jitter);
}

bool is_valid(const BusTiming& bus) {
  if (bus.bit_rate < 1'000 || bus.bit_rate > 1'000'000) return false;
  return !bus.error_interval || (is_message_time(*bus.error_interval) && *bus.error_interval > Nanoseconds{});
}

std::vector<ResponseTime> response_times(std::span<const CanMessage> messages, const BusTiming& bus) {
  if (!are_valid(messages, bus)) return {};
  const std::vector<QueuedMessage> queued = by_priority(messages, bus);
  // The longest frame of each message and those after it.
  std::vector<Nanoseconds> longest_from(queued.size() + 1);
  for (std::size_t i = queued.size(); i > 0; --i) longest_from[i - 1] = std::max(longest_from[i], queued[i - 1].c);

  std::vector<ResponseTime> results(messages.size());
  Utilisation same_or_higher;
  Nanoseconds longest{};
  std::size_t lower = 0;  // the first message of lower priority
  for (std::size_t i = 0; i < queued.size(); ++i) {
    for (; lower < queued.size() && queued[lower].arbitration == queued[i].arbitration; ++lower) {
      same_or_higher.add(queued[lower].c, queued[lower].t);
      longest = std::max(longest, queued[lower].c);
    }
    ResponseTime& result = results[queued[i].place];
    result.transmission = queued[i].c;
    result.blocking = longest_from[lower];
    const Nanoseconds error_cost = error_bits * bit_time_of(bus) + longest;
    Utilisation utilisation = same_or_higher;
    if (bus.error_interval) utilisation.add(error_cost, *bus.error_interval);
    if (utilisation.is_full()) continue;
    result.bound = ResponseBound::not_found;
    BusyPeriod{std::span{queued}.first(lower), queued[i], result.blocking, error_cost, bus}.examine(result);
    const CanMessage& message = messages[queued[i].place];
    result.meets_deadline = result.worst && *result.worst <= deadline_of(message);
  }
  return results;
}

BusLoad bus_load(std::span<const CanMessage> messages, const BusTiming& bus) {
  BusLoad load;
  if (!are_valid(messages, bus)) return load;
  for (const CanMessage& message : messages) {
    if (message.period == Nanoseconds{}) continue;
    const double bits_per_period =
        static_cast<double>(bus.bit_rate) * static_cast<double>(message.period.count()) / 1e9;
    load.min += canopen::bits_on_wire(frame_of(message)) / bits_per_period;
    load.max += canopen::max_bits_on_wire(frame_of(message)) / bits_per_period;
  }
  return load;
}

}  // namespace edsc

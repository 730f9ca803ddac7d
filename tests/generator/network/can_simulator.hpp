/// A second description of CAN: arbitration bit by bit, and a bus that serves queued frames. It shares nothing with
/// the analysis that it checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "network/timing/response_times.hpp"

namespace edsc {

/// The bits of a frame that take part in the arbitration, in the order on the wire; a '0' is dominant.
/// 11 bits: identifier, RTR, IDE (dominant). 29 bits: base identifier, SRR (recessive), IDE (recessive), extension,
/// RTR.
inline std::string arbitration_bits(const CanMessage& message) {
  std::string bits;
  const auto append = [&bits, &message](int from, int to) {
    for (int bit = from; bit >= to; --bit) bits += ((message.can_id >> bit) & 1U) != 0 ? '1' : '0';
  };
  const char rtr = message.remote ? '1' : '0';
  if (!message.extended) {
    append(10, 0);
    return bits + rtr + '0';
  }
  append(28, 18);
  bits += "11";
  append(17, 0);
  return bits + rtr;
}

/// The worst-case length in bits: 55 + 10 n and 80 + 10 n for n data bytes (section 3 of the paper).
inline std::int64_t worst_bits(const CanMessage& message) {
  return (message.extended ? 80 : 55) + (message.remote ? 0 : 10 * message.size);
}

/// A frame that is queued some time after its event; times in nanoseconds.
struct QueuedFrame {
  std::int64_t event = 0;
  std::int64_t queued = 0;
};

/// A bus on which each node sends its frames in the order of queueing, and the most dominant of all frames wins. A
/// frame that is queued less than a bit time after the bus became idle still takes part in the arbitration.
class CanSimulator {
 public:
  /// `frames` has the frames of each message, in the order of queueing.
  CanSimulator(const std::vector<CanMessage>& messages, std::uint32_t bit_rate,
               std::vector<std::vector<QueuedFrame>> frames)
      : bit_time_{1'000'000'000 / bit_rate}, frames_{std::move(frames)}, sent_(messages.size()) {
    for (const CanMessage& message : messages) {
      bits_.push_back(arbitration_bits(message));
      length_.push_back(worst_bits(message) * bit_time_);
    }
  }

  /// Errors destroy the last bit of frames, at least `interval` apart, each with a probability of one half.
  void make_errors(std::int64_t interval, unsigned seed) {
    error_interval_ = interval;
    random_.seed(seed);
  }

  /// Sends all frames, from the time at which the bus becomes idle. Returns the longest response time of each message.
  std::vector<std::int64_t> run(std::int64_t idle_from) {
    std::vector<std::int64_t> longest(bits_.size());
    std::int64_t now = idle_from;
    while (const std::vector<QueuedFrame>* const first = first_queued()) {
      now = std::max(now, (*first)[sent_[index_of(first)]].queued);
      const std::size_t winner = arbitrate(now);
      std::int64_t end = now + length_[winner];
      if (error_interval_ != 0 && end - bit_time_ >= next_error_ && random_() % 2 == 0) {
        next_error_ = end - bit_time_ + error_interval_;
        now = end + 31 * bit_time_;
        continue;
      }
      const QueuedFrame& frame = frames_[winner][sent_[winner]++];
      longest[winner] = std::max(longest[winner], end - frame.event);
      now = end;
    }
    return longest;
  }

 private:
  [[nodiscard]] std::size_t index_of(const std::vector<QueuedFrame>* frames) const {
    return static_cast<std::size_t>(frames - frames_.data());
  }

  [[nodiscard]] const std::vector<QueuedFrame>* first_queued() const {
    const std::vector<QueuedFrame>* first = nullptr;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (sent_[i] == frames_[i].size()) continue;
      if (first == nullptr || frames_[i][sent_[i]].queued < (*first)[sent_[index_of(first)]].queued)
        first = &frames_[i];
    }
    return first;
  }

  [[nodiscard]] std::size_t arbitrate(std::int64_t now) const {
    std::size_t winner = frames_.size();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (sent_[i] == frames_[i].size() || frames_[i][sent_[i]].queued >= now + bit_time_) continue;
      if (winner == frames_.size() || bits_[i] < bits_[winner]) winner = i;
    }
    return winner;
  }

  std::int64_t bit_time_;
  std::vector<std::vector<QueuedFrame>> frames_;
  std::vector<std::size_t> sent_;
  std::vector<std::string> bits_;
  std::vector<std::int64_t> length_;
  std::int64_t error_interval_ = 0;
  std::int64_t next_error_ = 0;
  std::minstd_rand random_;
};

}  // namespace edsc

/// The side of a host that uses an SLCAN adapter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/port/slcan_codec.hpp"

namespace canopen {

/// The host's side: opens the channel of an adapter, and converts its lines to frames. `output` is what it needs to
/// write; frames are encoded with `encode`.
class SlcanHost {
 public:
  enum class State : std::uint8_t { connecting, open, refused };
  static constexpr std::size_t longest_message = slcan::longest_line;
  static constexpr std::string_view farewell = "C\r";

  /// Starts to open the channel. Bit rate code 0..8; empty: set in the adapter. A missing response is ignored after
  /// half a second, because some adapters do not send any.
  void start(std::optional<std::uint8_t> bit_rate_code, TimePoint now) {
    bit_rate_code_ = bit_rate_code;
    put("\r\r\rC\r");  // ends an unfinished command and an open channel
    enter(Step::closing, now + settling);
  }

  [[nodiscard]] State state() const {
    if (step_ == Step::open) return State::open;
    return step_ == Step::refused ? State::refused : State::connecting;
  }

  /// Returns why the channel was rejected.
  [[nodiscard]] std::string_view problem() const { return problem_; }

  /// Returns the status that the adapter reports.
  [[nodiscard]] BusStatus status() const { return status_; }

  /// Processes a character of the adapter; returns the frame that it ends, if any.
  [[nodiscard]] std::optional<Frame> on_character(char character, TimePoint now) {
    const std::optional<std::string_view> line = reader_.take(character);
    if (!line) return std::nullopt;
    switch (step_) {
      case Step::closing:
      case Step::refused: return std::nullopt;
      case Step::setting:
      case Step::opening:
        if (line->empty()) next_step(now);
        if (!line->empty() && (*line)[0] == slcan::refusal) refuse(now);
        return std::nullopt;
      case Step::open: break;
    }
    if (!line->empty() && ((*line)[0] == slcan::refusal || (*line)[0] == 'F')) {
      on_status(*line, now);
      return std::nullopt;
    }
    return slcan::decode(*line);
  }

  void on_time(TimePoint now) {
    if (!deadline_ || now < *deadline_) return;
    if (step_ != Step::open) return next_step(now);
    if (asked_) return forget_flags();
    put("F\r");
    asked_ = true;
    deadline_ = now + response_timeout;
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return deadline_; }

  /// Returns what must be written before any frame; call `output_taken` when that has been done.
  [[nodiscard]] std::string_view output() const { return {output_.data(), output_size_}; }
  void output_taken() { output_size_ = 0; }

  [[nodiscard]] static std::size_t encode(const Frame& frame, std::span<char, longest_message> line) {
    return slcan::encode(frame, line);
  }

 private:
  enum class Step : std::uint8_t { closing, setting, opening, open, refused };

  static constexpr Duration settling{100'000};          ///< for data still in transit
  static constexpr Duration response_timeout{500'000};  ///< for a response
  static constexpr Duration between_flags{1'000'000};
  static constexpr std::uint8_t max_refusals = 3;

  void enter(Step step, std::optional<TimePoint> deadline) {
    step_ = step;
    deadline_ = deadline;
  }

  void next_step(TimePoint now) {
    if (step_ == Step::closing && bit_rate_code_) {
      const char command[] = {'S', static_cast<char>('0' + *bit_rate_code_), slcan::end};
      put({command, sizeof command});
      enter(Step::setting, now + response_timeout);
    } else if (step_ == Step::closing || step_ == Step::setting) {
      put("O\r");
      enter(Step::opening, now + response_timeout);
    } else {
      enter(Step::open, std::nullopt);
    }
  }

  /// Handles a rejection. A slow adapter's response to earlier commands may look like one: only the third one
  /// is accepted.
  void refuse(TimePoint now) {
    if (++refusals_ < max_refusals) {
      put("C\r");
      return enter(Step::closing, now + settling);
    }
    problem_ = step_ == Step::setting ? "the adapter refuses the bit rate" : "the adapter does not open its channel";
    enter(Step::refused, std::nullopt);
  }

  /// Handles a rejection, for instance of a frame without room. The flags show the cause, and are read until they
  /// are clear.
  void on_status(std::string_view line, TimePoint now) {
    if (line[0] == slcan::refusal) {
      if (has_flags_ && !asked_) deadline_ = now;
      return;
    }
    const std::optional<std::uint32_t> flags = line.size() == 3 ? slcan::hex_number(line.substr(1)) : std::nullopt;
    if (!flags) return;
    asked_ = false;
    status_.state = (*flags & slcan::flag::error_passive) != 0 ? BusState::passive : BusState::active;
    status_.overrun = (*flags & (slcan::flag::data_overrun | slcan::flag::receive_queue_full)) != 0;
    deadline_.reset();
    if (status_ != BusStatus{}) deadline_ = now + between_flags;
  }

  /// Stops reading the flags of an adapter that does not support them.
  void forget_flags() {
    asked_ = has_flags_ = false;
    deadline_.reset();
    status_ = {};
  }

  void put(std::string_view text) {
    for (const char character : text) {
      if (output_size_ < output_.size()) output_[output_size_++] = character;
    }
  }

  slcan::LineReader reader_;
  std::array<char, 16> output_{};
  std::uint8_t output_size_ = 0;
  Step step_ = Step::closing;
  std::optional<std::uint8_t> bit_rate_code_;
  std::optional<TimePoint> deadline_;
  std::string_view problem_;
  BusStatus status_;
  std::uint8_t refusals_ = 0;
  bool asked_ = false;  ///< the flags have been requested, without a response so far
  bool has_flags_ = true;
};

}  // namespace canopen

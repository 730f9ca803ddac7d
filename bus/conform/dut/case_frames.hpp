/// The frames on the bus during a case: those that the test sends, and those that it waits for.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "conform/verdict.hpp"
#include "online/live_bus.hpp"

namespace edsc::conform {

using canopen::Duration;

/// The time since the run began, at a point in time of the bus. Parts of a run pass it on.
struct RunClock {
  canopen::TimePoint at;
  std::uint64_t elapsed = 0;  ///< microseconds
};

/// Records each frame of a case. Time passes only while a member waits.
class CaseFrames {
 public:
  /// A position in the recorded frames.
  using Mark = std::size_t;
  using Match = std::function<bool(const canopen::Frame&)>;

  /// Without a clock the run begins now.
  explicit CaseFrames(LiveBus& bus, std::optional<RunClock> clock = {});
  ~CaseFrames();
  CaseFrames(const CaseFrames&) = delete;
  CaseFrames& operator=(const CaseFrames&) = delete;

  [[nodiscard]] Mark mark() const { return frames_.size(); }
  void send(const canopen::Frame& frame);
  void send(std::uint32_t can_id, std::span<const std::uint8_t> data);
  void send_remote(std::uint32_t can_id, std::uint8_t size);
  /// Returns the first matching frame that was received since the mark. Waits for at most `span`, and longer for a
  /// device whose responses are slow: see `slowest_response`. To test silence, use `collect`.
  std::optional<SeenFrame> wait_for(const Match& match, Duration span, Mark since);
  std::optional<SeenFrame> wait_for(const Match& match, Duration span) { return wait_for(match, span, mark()); }
  /// Waits for `span` and returns all matching frames that were received.
  std::vector<SeenFrame> collect(const Match& match, Duration span);
  void pass_time(Duration span) {
    (void)collect([](const canopen::Frame&) { return false; }, span);
  }
  /// Frames received since the mark.
  [[nodiscard]] std::vector<SeenFrame> received_since(Mark since, const Match& match) const;
  [[nodiscard]] std::uint64_t now() const;  ///< microseconds since the run began
  [[nodiscard]] RunClock clock() const { return {last_time_, elapsed_}; }

  [[nodiscard]] static Match with_id(std::uint32_t can_id);
  /// Matches data frames with the CAN-ID of a COB-ID as an object holds it. Ignores bit 31 (valid).
  [[nodiscard]] static Match with_cob_id(std::uint32_t cob_id);

  /// Called with each frame on the bus, also between cases.
  std::function<void(const SeenFrame&)> on_record = [](const SeenFrame&) {};

  /// By how much the test itself was late during this case, in microseconds.
  [[nodiscard]] std::uint64_t lag() const { return lag_; }
  /// By how much the responses of the device varied during the run, in microseconds: the computer of the device, which
  /// may be that of the test, was late by that much.
  [[nodiscard]] std::uint64_t device_lag() const { return slowest_response_ - fastest_response_; }
  [[nodiscard]] std::uint64_t slowest_response() const { return slowest_response_; }
  [[nodiscard]] std::uint64_t slowest_response_of_case() const { return slowest_of_case_; }

 protected:
  /// Frames with these CAN-IDs are requests, each with one response.
  void measure_responses(std::uint32_t request_id, std::uint32_t response_id);
  /// Forgets the frames and the lag of the last case.
  void clear_frames();
  [[nodiscard]] const std::vector<SeenFrame>& frames() const { return frames_; }
  /// The frame that `wait_for` has returned last.
  [[nodiscard]] Mark last_match() const { return last_match_; }

 private:
  void record(const canopen::Frame& frame, canopen::TimePoint at, bool sent);
  void measure_response(const canopen::Frame& frame, bool sent);
  void take_frame(Duration longest);

  LiveBus& bus_;
  std::vector<SeenFrame> frames_;
  canopen::TimePoint last_time_;
  std::uint64_t elapsed_ = 0;  ///< microseconds since the run began, at last_time_
  std::uint64_t lag_ = 0;
  Mark last_match_ = 0;
  std::uint32_t request_id_ = 0, response_id_ = 0;
  std::optional<std::uint64_t> request_sent_at_;  ///< of the request whose response is awaited, microseconds
  std::uint64_t fastest_response_ = 0, slowest_response_ = 0, slowest_of_case_ = 0;  ///< microseconds
};

/// The times from each frame to the next one, in microseconds.
[[nodiscard]] std::vector<std::uint64_t> intervals_of(const std::vector<SeenFrame>& frames);

}  // namespace edsc::conform

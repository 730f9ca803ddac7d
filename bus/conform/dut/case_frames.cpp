#include "conform/dut/case_frames.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>

#include "online/interruption.hpp"

namespace edsc::conform {

using canopen::Frame;
using canopen::TimePoint;

CaseFrames::CaseFrames(LiveBus& bus, std::optional<RunClock> clock) : bus_{bus}, last_time_{bus.now()} {
  if (clock) {
    last_time_ = clock->at;
    elapsed_ = clock->elapsed;
  }
  bus_.on_frame = [this](const Frame& frame, TimePoint) { record(frame, bus_.received_at(), false); };
  bus_.on_sent = [this](const Frame& frame, TimePoint at) { record(frame, at, true); };
}

CaseFrames::~CaseFrames() {
  bus_.on_frame = nullptr;
  bus_.on_sent = nullptr;
}

void CaseFrames::clear_frames() {
  frames_.clear();
  lag_ = 0;
  slowest_of_case_ = 0;
}

void CaseFrames::send(const Frame& frame) { bus_.send_all(frame); }

void CaseFrames::send(std::uint32_t can_id, std::span<const std::uint8_t> data) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.size = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), frame.data.size()));
  std::copy_n(data.begin(), frame.size, frame.data.begin());
  send(frame);
}

void CaseFrames::send_remote(std::uint32_t can_id, std::uint8_t size) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.remote = true;
  frame.size = size;
  send(frame);
}

void CaseFrames::take_frame(Duration longest) {
  const TimePoint end = bus_.now() + longest;
  const bool came = bus_.receive(longest).has_value();
  const TimePoint present = bus_.now();
  if (Interruption::noted()) throw Interrupted{};
  const TimePoint due = came ? bus_.received_at() : end;
  if (present > due) lag_ = std::max<std::uint64_t>(lag_, (present - due).count());
}

std::optional<SeenFrame> CaseFrames::wait_for(const Match& match, Duration span, Mark since) {
  constexpr std::uint64_t slow = 20'000;
  const std::uint64_t more = slowest_response_ > slow ? slowest_response_ : 0;
  const TimePoint end = bus_.now() + span + Duration{static_cast<std::uint32_t>(more)};
  for (;;) {
    for (; since < frames_.size(); ++since) {
      if (frames_[since].sent || !match(frames_[since].frame)) continue;
      last_match_ = since;
      return frames_[since];
    }
    const TimePoint present = bus_.now();
    if (present >= end) return std::nullopt;
    take_frame(end - present);
  }
}

std::vector<SeenFrame> CaseFrames::collect(const Match& match, Duration span) {
  const Mark since = mark();
  const TimePoint end = bus_.now() + span;
  for (TimePoint present = bus_.now(); present < end; present = bus_.now()) take_frame(end - present);
  return received_since(since, match);
}

std::vector<SeenFrame> CaseFrames::received_since(Mark since, const Match& match) const {
  std::vector<SeenFrame> found;
  for (; since < frames_.size(); ++since) {
    if (!frames_[since].sent && match(frames_[since].frame)) found.push_back(frames_[since]);
  }
  return found;
}

std::uint64_t CaseFrames::now() const {
  const TimePoint present = bus_.now();
  return present > last_time_ ? elapsed_ + (present - last_time_).count() : elapsed_;
}

void CaseFrames::record(const Frame& frame, TimePoint at, bool sent) {
  if (at > last_time_) {
    elapsed_ += (at - last_time_).count();
    last_time_ = at;
  }
  frames_.push_back({frame, elapsed_, sent});
  on_record(frames_.back());
  measure_response(frame, sent);
}

void CaseFrames::measure_responses(std::uint32_t request_id, std::uint32_t response_id) {
  request_id_ = request_id;
  response_id_ = response_id;
}

void CaseFrames::measure_response(const Frame& frame, bool sent) {
  if (sent && with_id(request_id_)(frame)) {
    request_sent_at_ = elapsed_;
  } else if (!sent && request_sent_at_ && with_id(response_id_)(frame)) {
    const std::uint64_t took = elapsed_ - *request_sent_at_;
    const bool is_first = slowest_response_ == 0;
    fastest_response_ = is_first ? took : std::min(fastest_response_, took);
    slowest_response_ = std::max(slowest_response_, took);
    slowest_of_case_ = std::max(slowest_of_case_, took);
    request_sent_at_.reset();
  }
}

std::vector<std::uint64_t> intervals_of(const std::vector<SeenFrame>& frames) {
  std::vector<std::uint64_t> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) intervals.push_back(frames[i].at - frames[i - 1].at);
  return intervals;
}

CaseFrames::Match CaseFrames::with_id(std::uint32_t can_id) {
  return [can_id](const Frame& frame) { return frame.id == can_id && !frame.extended && !frame.remote; };
}

CaseFrames::Match CaseFrames::with_cob_id(std::uint32_t cob_id) {
  const canopen::CobId id{cob_id};
  return
      [id](const Frame& frame) { return frame.id == id.can_id() && frame.extended == id.extended() && !frame.remote; };
}

}  // namespace edsc::conform

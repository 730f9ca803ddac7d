/// The frames of a case: those that the test sends, and those that it waits for.
#include <algorithm>

#include "conform/dut/dut.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {

using canopen::Frame;
using canopen::TimePoint;

void Dut::send(const Frame& frame) { bus_.send_all(frame); }

void Dut::send(std::uint32_t can_id, std::span<const std::uint8_t> data) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.size = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), frame.data.size()));
  std::copy_n(data.begin(), frame.size, frame.data.begin());
  send(frame);
}

void Dut::send_remote(std::uint32_t can_id, std::uint8_t size) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.remote = true;
  frame.size = size;
  send(frame);
}

void Dut::take_frame(Duration longest) {
  const TimePoint end = bus_.now() + longest;
  const bool came = bus_.receive(longest).has_value();
  const TimePoint present = bus_.now();
  if (Interruption::noted()) throw Interrupted{};
  const TimePoint due = came ? bus_.received_at() : end;
  if (present > due) lag_ = std::max<std::uint64_t>(lag_, (present - due).count());
}

std::optional<SeenFrame> Dut::wait_for(const Match& match, Duration span, Mark since) {
  const TimePoint end = bus_.now() + span;
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

std::vector<SeenFrame> Dut::collect(const Match& match, Duration span) {
  const Mark since = mark();
  const TimePoint end = bus_.now() + span;
  for (TimePoint present = bus_.now(); present < end; present = bus_.now()) take_frame(end - present);
  return received_since(since, match);
}

std::vector<SeenFrame> Dut::received_since(Mark since, const Match& match) const {
  std::vector<SeenFrame> found;
  for (; since < frames_.size(); ++since) {
    if (!frames_[since].sent && match(frames_[since].frame)) found.push_back(frames_[since]);
  }
  return found;
}

std::uint64_t Dut::now() const {
  const TimePoint present = bus_.now();
  return present > last_time_ ? elapsed_ + (present - last_time_).count() : elapsed_;
}

void Dut::record(const Frame& frame, TimePoint at, bool sent) {
  if (at > last_time_) {
    elapsed_ += (at - last_time_).count();
    last_time_ = at;
  }
  frames_.push_back({frame, elapsed_, sent});
}

Dut::Match Dut::with_id(std::uint32_t can_id) {
  return [can_id](const Frame& frame) { return frame.id == can_id && !frame.extended && !frame.remote; };
}

Dut::Match Dut::with_cob_id(std::uint32_t cob_id) {
  const canopen::CobId id{cob_id};
  return
      [id](const Frame& frame) { return frame.id == id.can_id() && frame.extended == id.extended() && !frame.remote; };
}

Dut::Match Dut::error_control() const { return with_id(0x700U + node().value()); }

Dut::Match Dut::boot_up() const {
  return [id = 0x700U + node().value()](const Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] == 0;
  };
}

Dut::Match Dut::heartbeat() const {
  return [id = 0x700U + node().value()](const Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] != 0;
  };
}

}  // namespace edsc::conform

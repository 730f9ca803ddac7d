/// The handshake of profile position mode: one set-point in progress, one waiting (CiA 402-2, 10.3.1).
#pragma once

#include <cstdint>

#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

struct SetPoint {
  std::int32_t target;
  Profile profile;
};

class SetPoints {
 public:
  /// Processes a rising edge of bit 4 of the controlword: `set_point` starts at once if there is none or bit 5 is set,
  /// otherwise when the present one has been reached. It is ignored while another one is waiting.
  void offer(const SetPoint& set_point, bool immediately) {
    if (active_ && !immediately && waits_) return;
    if (active_ && !immediately) {
      next_ = set_point;
      waits_ = true;
    } else {
      present_ = set_point;
      active_ = start_ = true;
      waits_ = false;
    }
    acknowledged_ = true;
  }

  /// Processes bit 4 = 0: a further set-point is accepted as soon as there is room.
  void release() { acknowledged_ = false; }

  /// Returns bit 12 of the statusword.
  [[nodiscard]] bool acknowledge() const { return acknowledged_ || waits_; }

  /// Whether the axis is moving to a set-point.
  [[nodiscard]] bool active() const { return active_; }
  /// Returns the reference of relative set-points while one is active.
  [[nodiscard]] std::int32_t last_target() const { return waits_ ? next_.target : present_.target; }

  /// Returns the present set-point once, when it is to be passed to the axis; otherwise null.
  [[nodiscard]] const SetPoint* to_start() {
    if (!start_) return nullptr;
    start_ = false;
    return &present_;
  }
  /// Whether `to_start` returns a set-point.
  [[nodiscard]] bool starts() const { return start_; }

  /// Makes `to_start` return the present set-point again, after a halt.
  void start_again() { start_ = active_; }

  /// Reports that the present set-point has been reached.
  void reached() {
    active_ = waits_;
    if (!waits_) return;
    present_ = next_;
    start_ = true;
    waits_ = false;
  }

  /// Discards all set-points.
  void clear() { *this = SetPoints{}; }

 private:
  SetPoint present_{};
  SetPoint next_{};
  bool active_ = false;
  bool start_ = false;
  bool waits_ = false;  ///< `next_` is waiting
  bool acknowledged_ = false;
};

}  // namespace canopen::cia402

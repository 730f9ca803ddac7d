/// The hand-shake of profile position mode: one set-point in progress, one behind it (CiA 402-2, 10.3.1).
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
  /// The controlword has bit 4 anew: `set_point` goes on at once where the axis has none or bit 5 is set, else when the
  /// present one is reached. Not taken while another one waits.
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

  /// Bit 4 is 0: a further set-point may come as soon as there is room.
  void release() { acknowledged_ = false; }

  /// Bit 12 of the statusword.
  [[nodiscard]] bool acknowledge() const { return acknowledged_ || waits_; }

  /// Whether the axis is under way to a set-point.
  [[nodiscard]] bool active() const { return active_; }
  /// Where relative set-points count from while one is active.
  [[nodiscard]] std::int32_t last_target() const { return waits_ ? next_.target : present_.target; }

  /// The present set-point, once, when the axis is to be told it.
  [[nodiscard]] const SetPoint* to_start() {
    if (!start_) return nullptr;
    start_ = false;
    return &present_;
  }
  /// Whether `to_start` has one.
  [[nodiscard]] bool starts() const { return start_; }

  /// The axis is to be told the present set-point again, after a halt.
  void start_again() { start_ = active_; }

  /// The present one is reached.
  void reached() {
    active_ = waits_;
    if (!waits_) return;
    present_ = next_;
    start_ = true;
    waits_ = false;
  }

  /// Forgets all of them.
  void clear() { *this = SetPoints{}; }

 private:
  SetPoint present_{};
  SetPoint next_{};
  bool active_ = false;
  bool start_ = false;
  bool waits_ = false;  ///< `next_` does
  bool acknowledged_ = false;
};

}  // namespace canopen::cia402

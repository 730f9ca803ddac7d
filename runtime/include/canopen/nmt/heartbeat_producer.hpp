/// Boot-up message and heartbeat producer (CiA 301, 7.2.8.3.2.2 and 7.2.8.3.3).
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Sends the NMT state in one byte with CAN-ID 700h + node-ID. Periods are those of 1017h; 0: off.
class HeartbeatProducer {
 public:
  /// Makes the boot-up message due. It counts as the first heartbeat.
  void boot_up() {
    boot_up_due_ = true;
    running_ = false;
  }

  /// Handles a write to 1017h: the first heartbeat is due at once, the next ones after each period.
  void set_period(Duration period, TimePoint now) {
    running_ = period.count() != 0;
    due_ = now;
  }

  /// Sends the boot-up message or a heartbeat if it is due. Returns false if the bus had no room; it remains due.
  template <Bus BusType>
  bool serve(BusType& bus, NodeId node_id, NmtState state, Duration period, TimePoint now) {
    if (boot_up_due_) {
      state = NmtState::initialisation;
      due_ = now;
    } else if (!running_ || due_.is_ahead(now)) {
      return true;
    }
    const std::uint32_t cob_id = function_code::error_control + std::uint32_t{node_id.value()};
    if (!send_words(bus, cob_id, 1, static_cast<std::uint8_t>(state))) return false;
    boot_up_due_ = false;
    running_ = period.count() != 0;
    due_ = due_.at() + period;
    if (due_.has_passed(now)) due_ = now + period;  // called so late that whole periods are missing
    return true;
  }

  /// Whether the boot-up message is waiting to be sent.
  [[nodiscard]] bool boot_up_due() const { return boot_up_due_; }

  /// Returns when the next heartbeat is due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return running_ ? std::optional{due_.at()} : std::nullopt;
  }

  /// Keeps the deadline while the bus has no room.
  void keep_deadline(TimePoint now) { due_.keep(now); }

 private:
  Deadline due_{};
  bool boot_up_due_ = false;
  bool running_ = false;
};

}  // namespace canopen

/// Common parts of the drivers of CAN controllers.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/shared_number.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/node/accepted_frames.hpp"

namespace canopen {

enum class BusMode : std::uint8_t {
  normal,
  silent,  ///< only listens, without sending or acknowledging: to detect a bit rate, or to monitor
};

/// Interface of a CAN controller driver: BxCan, Fdcan and new ports (docs/porting.md).
template <class Type>
concept CanController = Bus<Type> && requires(Type& can, std::uint32_t number, std::span<const AcceptedFrame> frames) {
  { can.start(number, number, BusMode::silent) } -> std::same_as<bool>;  // clock in Hz, bit rate in bit/s
  { can.stop() } -> std::same_as<bool>;
  can.accept_all();
  can.accept(frames);
  { can.receive() } -> std::same_as<std::optional<Frame>>;
  { can.status_change() } -> std::same_as<std::optional<BusStatus>>;
};

/// Returns the size for the data length code of a classic frame: 9 to 15 mean 8 (ISO 11898-1).
[[nodiscard]] constexpr std::uint8_t size_of_code(std::uint32_t code) {
  return static_cast<std::uint8_t>((code & 0xF) > 8 ? 8 : code & 0xF);
}

/// Polls until `reached` is true. Returns false if that does not happen, for instance without a clock. 11 recessive
/// bits take 1.1 ms at 10 kbit/s, the longest frame 16 ms.
template <class Condition>
[[nodiscard]] bool wait_until(Condition&& reached) {
  for (std::uint32_t tries = 1'000'000; tries > 0; --tries) {
    if (reached()) return true;
  }
  return false;
}

/// Reports changes of a controller's status to a node. `note_overrun` may be called in an interrupt.
class StatusReport {
 public:
  /// Records that frames have been lost.
  void note_overrun() { overruns_.publish(static_cast<std::uint16_t>(overruns_.own() + 1)); }

  [[nodiscard]] std::optional<BusStatus> change(BusState state) {
    const std::uint16_t overruns = overruns_.read();
    const BusStatus status{state, overruns != seen_};
    seen_ = overruns;
    if (status == reported_) return std::nullopt;
    reported_ = status;
    return status;
  }

 private:
  BusStatus reported_{};
  SharedNumber<std::uint16_t> overruns_;
  std::uint16_t seen_ = 0;
};

}  // namespace canopen

/// What the drivers of CAN controllers have in common.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/accepted_frames.hpp"
#include "canopen/bus_status.hpp"
#include "canopen/frame.hpp"

namespace canopen {

enum class BusMode : std::uint8_t {
  normal,
  silent,  ///< listens, and neither sends nor acknowledges: to find out a bit rate, or to watch
};

/// What a program asks of a CAN controller: BxCan, Fdcan, and what a new port has to have (docs/porting.md).
template <class T>
concept CanController = Bus<T> && requires(T& can, std::uint32_t number, std::span<const AcceptedFrame> frames) {
  { can.start(number, number, BusMode::silent) } -> std::same_as<bool>;  // clock in Hz, bit rate in bit/s
  { can.stop() } -> std::same_as<bool>;
  can.accept_all();
  can.accept(frames);
  { can.receive() } -> std::same_as<std::optional<Frame>>;
  { can.status_change() } -> std::same_as<std::optional<BusStatus>>;
};

/// The data length code of a classic frame: 9 to 15 mean 8 (ISO 11898-1).
[[nodiscard]] constexpr std::uint8_t size_of_code(std::uint32_t code) {
  return static_cast<std::uint8_t>((code & 0xF) > 8 ? 8 : code & 0xF);
}

/// Reads until `reached` is true. False: it does not come, as without a clock. 11 recessive bits take 1.1 ms at
/// 10 kbit/s, the longest frame 16 ms.
template <class Condition>
[[nodiscard]] bool wait_until(Condition&& reached) {
  for (std::uint32_t patience = 1'000'000; patience > 0; --patience) {
    if (reached()) return true;
  }
  return false;
}

/// Tells a node what a controller says of itself, when it is another than the last time.
class StatusReport {
 public:
  /// Frames have been lost.
  void note_overrun() { overrun_ = true; }

  [[nodiscard]] std::optional<BusStatus> change(BusState state) {
    const BusStatus status{state, overrun_};
    overrun_ = false;
    if (status == told_) return std::nullopt;
    told_ = status;
    return status;
  }

 private:
  BusStatus told_{};
  bool overrun_ = false;
};

}  // namespace canopen

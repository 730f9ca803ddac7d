/// A CAN bus over SLCAN on the board's serial line: for the host the board is an SLCAN adapter to a bus with one node.
#pragma once

#include <array>
#include <canopen/base/clock.hpp>
#include <canopen/can/bus_status.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/port/slcan_adapter.hpp>
#include <canopen/port/slcan_codec.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board.hpp"

/// While the channel of the host is closed, `send` accepts no frames, as on a bus without another node to acknowledge
/// them, and due frames remain due. Therefore the node starts at power-on, and its boot-up message is the first frame
/// that the host receives.
class SerialBus {
 public:
  /// Sends a frame to the host. Returns false if the channel is closed or the buffer has no space for it.
  [[nodiscard]] bool send(const canopen::Frame& frame) {
    if (!adapter_.is_open() || room() < canopen::slcan::longest_line + longest_answer) return false;
    adapter_.on_frame(frame, board::now(), *this);
    return true;
  }

  /// Returns a frame of the host, if one was received. Transfers characters in both directions.
  [[nodiscard]] std::optional<canopen::Frame> receive() {
    while (first_ != last_ && board::uart_put(line_[first_ % line_.size()])) ++first_;
    if (room() < longest_answer) return std::nullopt;
    received_ = false;
    if (const std::optional<char> character = board::uart_get()) {
      Side side{*this};
      adapter_.on_character(*character, side);
    }
    return received_ ? std::optional{frame_} : std::nullopt;
  }

  /// Writes to the serial line. The caller has checked that there is space.
  void write(std::span<const char> text) {
    for (const char character : text) line_[last_++ % line_.size()] = character;
  }

 private:
  static constexpr std::size_t longest_answer = 12;

  /// The bus as the adapter needs it. The bit rate is ignored: the adapter does not have a CAN bus.
  struct Side {
    SerialBus& bus;
    void write(std::span<const char> text) { bus.write(text); }
    bool open(const canopen::SlcanChannel&) { return true; }
    void close() {}
    bool send(const canopen::Frame& frame) {
      bus.frame_ = frame;
      bus.received_ = true;
      return true;
    }
    std::uint8_t status() { return 0; }
  };

  [[nodiscard]] std::size_t room() const { return line_.size() - static_cast<std::uint8_t>(last_ - first_); }

  canopen::SlcanAdapter adapter_{"edsc"};
  canopen::Frame frame_{};
  bool received_ = false;
  std::uint8_t first_ = 0;
  std::uint8_t last_ = 0;
  std::array<char, 128> line_{};  ///< characters for the UART; the size is a power of two
};

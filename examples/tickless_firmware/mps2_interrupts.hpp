/// Timers and interrupts of the MPS2 boards (AN385): an alarm for the next deadline, a timer in place of an ADC, and
/// the UART.
#pragma once

#include <algorithm>
#include <canopen/base/clock.hpp>
#include <cstdint>
#include <optional>

#include "board.hpp"
#include "registers.hpp"

namespace interrupts {

using board::word_at;

inline constexpr unsigned uart_received = 0;  // numbers of the interrupts
inline constexpr unsigned uart_sent = 1;
inline constexpr unsigned alarm_timer = 8;
inline constexpr unsigned measuring_timer = 9;

inline constexpr std::uintptr_t nvic_enable = 0xE000'E100;
inline constexpr std::uintptr_t uart = 0x4000'4000;
inline constexpr std::uintptr_t uart_control = uart + 0x08;
inline constexpr std::uintptr_t uart_clear = uart + 0x0C;
inline constexpr std::uint32_t uart_send_interrupt = 4;     // control
inline constexpr std::uint32_t uart_receive_interrupt = 8;  // control

/// A CMSDK timer, which counts down at 25 MHz and then interrupts.
template <std::uintptr_t Base>
struct Timer {
  static constexpr std::uint32_t cycles_per_microsecond = 25;
  static constexpr canopen::Duration longest{100'000'000};

  static void start(canopen::Duration span) {
    const std::uint32_t cycles = std::min(span, longest).count() * cycles_per_microsecond;
    stop();
    word_at(Base + 0x08) = cycles;  // the value after the end
    word_at(Base + 0x04) = cycles;
    word_at(Base) = 1 | 8;  // enabled, with interrupt
  }
  static void stop() {
    word_at(Base) = 0;
    acknowledge();
  }
  static void acknowledge() { word_at(Base + 0x0C) = 1; }
};
using AlarmTimer = Timer<0x4000'0000>;
using MeasuringTimer = Timer<0x4000'1000>;

inline void start() {
  word_at(uart_control) = word_at(uart_control) | uart_send_interrupt | uart_receive_interrupt;
  word_at(nvic_enable) = 1u << uart_received | 1u << uart_sent | 1u << alarm_timer | 1u << measuring_timer;
}

/// Sets the alarm for a deadline. Returns false if it has come already.
[[nodiscard]] inline bool set_alarm(std::optional<canopen::TimePoint> deadline) {
  AlarmTimer::stop();
  if (!deadline) return true;
  const canopen::TimePoint now = board::now();
  if (*deadline <= now) return false;
  AlarmTimer::start(*deadline - now);
  return true;
}

}  // namespace interrupts

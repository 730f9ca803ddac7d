/// Lines of a log of Vector CANoe or CANalyzer, with Classical CAN frames:
///
///   date Wed Apr 16 09:21:13.159 am 2014
///   base hex  timestamps absolute
///   Begin Triggerblock Wed Apr 16 09:21:13.159 am 2014
///     0.015991 1  64              Rx   d 8 00 01 02 03 04 05 06 07  Length = 0
///     0.017000 1  18EBFF00x       Tx   d 2 A0 0F
///     0.018000 2  1FF             Rx   r 8
///     0.019000 1  ErrorFrame
///     0.020000 CANFD   1 Rx  1FF  0 0 1  1 05   130000  130  0 0 0 0 0 0       of a channel for CAN FD
///
/// With `base dec`, CAN-IDs, lengths and bytes are decimal; with `timestamps relative`, a time counts from the previous
/// event. Events that are not frames, such as statistics, are remarks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "decode/formats/log_source.hpp"

namespace edsc {

[[nodiscard]] bool is_asc(std::string_view beginning);

class AscParser final : public LineParser {
 public:
  /// The time is in seconds since the start of the measurement, with six decimals.
  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  [[nodiscard]] LogLine parse_header(std::string_view word, std::string_view rest);
  [[nodiscard]] LogLine parse_base(std::string_view text);
  [[nodiscard]] LogLine parse_event(std::string_view time, std::string_view rest);
  [[nodiscard]] bool parse_id(std::string_view word, canopen::Frame& frame) const;
  void parse_fd_channel(std::string_view rest, LogLine& line) const;
  [[nodiscard]] bool parse_bytes(std::string_view& rest, std::uint8_t size, canopen::Frame& frame) const;
  void parse_data(std::string_view rest, LogLine& line) const;

  int base_ = 16;
  bool relative_ = false;
  std::int64_t sum_ = 0;  ///< of relative times, in us
  std::string time_;
};

}  // namespace edsc

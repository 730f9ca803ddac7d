/// A line or packet of a log, and the parser of lines in any format of candump:
///
///   (1436509052.249713) vcan0 123#DEADBEEF                    -L, also followed by R or T
///    vcan0  123   [4]  DE AD BE EF                            on the screen, also with -a and -x
///    (1436509052.249713)  vcan0  123   [4]  DE AD BE EF       -t a, d, z
///    (2015-07-10 08:17:32.249713)  vcan0  123   [4]  DE ...   -t A
///
/// 123#R8 and `remote request` are remote frames; CAN-IDs of eight digits are extended, or flags of an error frame; ##
/// and lengths of two digits are CAN FD. A frame without time and interface, 123#DEADBEEF, is also a line.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace edsc {

enum class LogLineKind : std::uint8_t {
  blank,
  frame,
  error_frame,  ///< the CAN-ID holds flags of linux/can/error.h
  remark,       ///< comments, headers, events that are not frames, lines that candump -e writes below an error frame
  can_fd,
  broken,
  unreadable,  ///< broken, as is the rest of the log
};

/// Times of a log are at most this long after its origin, so that their sums and differences can be computed.
inline constexpr std::int64_t max_log_time_us = 4'000'000'000'000'000'000;

/// Texts are views of the line, or of its parser.
struct LogLine {
  LogLineKind kind = LogLineKind::blank;
  std::size_t number = 0;             ///< of the line or packet, from 1
  std::string_view text;              ///< the line
  std::optional<std::uint64_t> byte;  ///< of a packet: its offset in the log
  bool has_time = false;
  std::int64_t microseconds = 0;  ///< since the time origin of the log
  std::string_view time;          ///< candump: as written, without parentheses
  std::string_view interface;
  canopen::Frame frame;
  std::string_view problem;  ///< of a broken line: the fault, as part of a sentence
};

[[nodiscard]] LogLine parse_log_line(std::string_view text);

/// The line, as a broken one.
[[nodiscard]] LogLine broken(LogLine line, std::string_view problem);

}  // namespace edsc

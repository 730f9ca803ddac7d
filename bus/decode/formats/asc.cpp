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
#include <cstdint>
#include <string>
#include <string_view>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/text_source.hpp"
#include "decode/formats/words.hpp"

namespace edsc {
namespace {

/// The words that lines of the header begin with, in lower case.
constexpr std::string_view asc_header_words[] = {"date",  "base", "timestamps", "internal", "no",
                                                 "begin", "end",  "previous",   "//"};

bool is_header_word(std::string_view word) {
  return word.starts_with("//") ||
         std::ranges::any_of(asc_header_words, [&](std::string_view known) { return is_word(word, known); });
}

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

bool is_asc(std::string_view beginning) {
  std::string_view line = first_line(beginning);
  const std::string_view word = take_word(line);
  // An interface of candump may have one of these names; then the CAN-ID and the length follow.
  return is_header_word(word) && line.find('[') == std::string_view::npos && line.find('#') == std::string_view::npos;
}

LogLine AscParser::parse(std::string_view text) {
  text = first_line(text);
  const std::string_view word = take_word(text);
  if (word.empty()) return {};
  return is_digit(word.front()) ? parse_event(word, text) : parse_header(word, text);
}

LogLine AscParser::parse_header(std::string_view word, std::string_view rest) {
  if (is_word(word, "base")) return parse_base(rest);
  if (is_word(word, "timestamps")) return parse_base(rest);
  LogLine line;
  if (!is_header_word(word)) return broken(line, "neither an event nor a line of the header");
  line.kind = LogLineKind::remark;
  return line;
}

/// `hex  timestamps absolute`
LogLine AscParser::parse_base(std::string_view text) {
  LogLine line;
  line.kind = LogLineKind::remark;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (is_word(word, "hex") || is_word(word, "dec")) {
      base_ = is_word(word, "hex") ? 16 : 10;
    } else if (is_word(word, "absolute") || is_word(word, "relative")) {
      relative_ = is_word(word, "relative");
    } else if (!is_word(word, "timestamps")) {
      return broken(line, "expected hex or dec, and timestamps absolute or relative");
    }
  }
  return line;
}

LogLine AscParser::parse_event(std::string_view time, std::string_view rest) {
  LogLine line;
  const auto microseconds = parse_decimal(time, 6);
  if (!microseconds) return broken(line, "the time is not a number of seconds");
  sum_ = relative_ ? std::min(sum_ + *microseconds, max_log_time_us) : *microseconds;
  line.has_time = true;
  line.microseconds = sum_;
  time_.clear();
  append_seconds(time_, sum_);
  line.time = time_;
  line.kind = LogLineKind::remark;

  const std::string_view channel = take_word(rest);
  if (is_word(channel, "canfd")) {
    parse_fd_channel(rest, line);
    return line;
  }
  if (!is_number(channel)) return line;  // `Start of measurement`, `CAN 1 Status:`
  line.interface = channel;
  const std::string_view id = take_word(rest);
  if (is_word(id, "errorframe")) {
    line.kind = LogLineKind::error_frame;
    line.frame.extended = true;  // the CAN-ID of an error frame has error flags; they are not known here
    return line;
  }
  const std::string_view direction = take_word(rest);
  if (!is_word(direction, "rx") && !is_word(direction, "tx")) return line;  // `Statistic:`, a request to transmit
  if (!parse_id(id, line.frame)) return broken(line, "the CAN-ID is not a number of 11 bits, or of 29 bits with x");
  line.kind = LogLineKind::frame;
  parse_data(rest, line);
  return line;
}

/// `1 Rx 706  0 0 1  1 05   130000  130  0 0 0 0 0 0`: after the CAN-ID a name, which may be missing, two flags, length
/// code and length, data, duration and length of the frame, and flags with the kind of the frame.
void AscParser::parse_fd_channel(std::string_view rest, LogLine& line) const {
  constexpr std::uint32_t remote_flag = 0x10, fd_flag = 0x1000;
  line.kind = LogLineKind::can_fd;
  line.interface = take_word(rest);
  take_word(rest);  // direction
  const std::string_view id = take_word(rest);
  if (is_word(id, "errorframe")) {
    line.kind = LogLineKind::error_frame;
    line.frame.extended = true;
    return;
  }
  std::string_view word = take_word(rest);
  if (!is_number(word)) word = take_word(rest);
  take_word(rest);
  const auto code = parse_whole<std::uint8_t>(take_word(rest), base_);
  const auto size = parse_whole<std::uint8_t>(take_word(rest));
  LogLine classical = line;
  canopen::Frame& frame = classical.frame;
  if (!code || !size || *size > frame.data.size() || !parse_id(id, frame) || !parse_bytes(rest, *size, frame)) return;
  take_word(rest);
  take_word(rest);
  const auto flags = parse_whole<std::uint32_t>(take_word(rest), 16);
  if (!flags || (*flags & fd_flag) != 0) return;
  frame.remote = (*flags & remote_flag) != 0;
  if (frame.remote) frame.size = std::min(*code, std::uint8_t{8});
  classical.kind = LogLineKind::frame;
  line = classical;
}

/// Returns false if there are fewer.
bool AscParser::parse_bytes(std::string_view& rest, std::uint8_t size, canopen::Frame& frame) const {
  while (frame.size < size) {
    const auto byte = parse_whole<std::uint8_t>(take_word(rest), base_);
    if (!byte) return false;
    frame.data[frame.size++] = *byte;
  }
  return true;
}

/// `64`, `18EBFF00x`
bool AscParser::parse_id(std::string_view word, canopen::Frame& frame) const {
  frame.extended = word.ends_with('x') || word.ends_with('X');
  if (frame.extended) word.remove_suffix(1);
  const auto id = parse_whole<std::uint32_t>(word, base_);
  frame.id = id.value_or(0);
  return id && *id <= (frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
}

/// `d 8 00 01 02 03 04 05 06 07`, `r`, `r 8`
void AscParser::parse_data(std::string_view rest, LogLine& line) const {
  constexpr std::uint8_t max_code = 15;  // the length codes 9 to 15 are 8 bytes (ISO 11898-1)
  const std::string_view kind = take_word(rest);
  line.frame.remote = is_word(kind, "r");
  if (!line.frame.remote && !is_word(kind, "d")) {
    line = broken(line, "missing d or r after the direction");
    return;
  }
  const std::string_view length = take_word(rest);
  const auto code = parse_whole<std::uint8_t>(length, base_);
  if (line.frame.remote && (!code || *code > max_code)) return;  // older logs have no length
  if (!code || *code > max_code) {
    line = broken(line, "the length is not 0 to 15");
    return;
  }
  const std::uint8_t size = std::min(*code, std::uint8_t{8});
  if (line.frame.remote) {
    line.frame.size = size;
    return;
  }
  if (!parse_bytes(rest, size, line.frame)) line = broken(line, "fewer bytes than the length states");
}

}  // namespace

const LogFormat asc_format{"asc", "log of Vector CANoe and CANalyzer", is_asc, open_text<AscParser>};

}  // namespace edsc

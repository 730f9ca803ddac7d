/// Logs of BUSMASTER, as versions 1.3 to 3.2 write them:
///
///   ***BUSMASTER Ver 3.2.2***
///   ***PROTOCOL CAN***
///   ***HEX***
///   ***SYSTEM MODE***
///   ***<Time><Tx/Rx><Channel><CAN ID><Type><DLC><DataBytes>***
///   10:17:05:1234 Rx 1 0x705 s 1 05
///   10:17:05:1250 Rx 1 0x18EFC034 xr 0
///
/// A time is hours, minutes, seconds and units of 100 us: of the day (SYSTEM), since the start (ABSOLUTE) or since the
/// line before (RELATIVE).
#include <array>
#include <string>
#include <string_view>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/text_source.hpp"
#include "decode/formats/words.hpp"

namespace edsc {
namespace {

constexpr std::string_view mark = "***";

bool is_busmaster(std::string_view beginning) { return first_line(beginning).starts_with("***BUSMASTER"); }

class BusmasterParser final : public LineParser {
 public:
  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  void parse_header(std::string_view text);
  [[nodiscard]] bool parse_time(std::string_view word, LogLine& line);
  [[nodiscard]] static std::string_view parse_type(std::string_view word, LogLine& line);
  [[nodiscard]] std::string_view parse_data(std::string_view rest, LogLine& line) const;

  enum class Times : std::uint8_t { of_day, since_start, since_line_before };
  static constexpr std::int64_t day_us = 86'400'000'000;

  Times times_ = Times::of_day;
  bool is_decimal_ = false;
  std::int64_t days_us_ = 0;  ///< of the days that have ended during the log
  std::int64_t last_us_ = 0;
  std::string time_;
};

void BusmasterParser::parse_header(std::string_view text) {
  if (text == "***HEX***") is_decimal_ = false;
  if (text == "***DEC***") is_decimal_ = true;
  if (text == "***SYSTEM MODE***") times_ = Times::of_day;
  if (text == "***ABSOLUTE MODE***") times_ = Times::since_start;
  if (text == "***RELATIVE MODE***") times_ = Times::since_line_before;
}

/// `10:17:05:1234`
bool BusmasterParser::parse_time(std::string_view word, LogLine& line) {
  constexpr std::array<std::int64_t, 4> units_us{3'600'000'000, 60'000'000, 1'000'000, 100};
  std::int64_t microseconds = 0;
  for (const std::int64_t unit_us : units_us) {
    const std::size_t end = std::min(word.find(':'), word.size());
    const auto number = parse_whole<std::uint16_t>(word.substr(0, end));
    if (!number || (end == word.size()) != (unit_us == units_us.back())) return false;
    microseconds += *number * unit_us;
    word.remove_prefix(std::min(end + 1, word.size()));
  }
  if (times_ == Times::since_line_before) {
    microseconds += last_us_;
  } else if (times_ == Times::of_day) {
    microseconds += days_us_;
    if (microseconds + day_us / 2 < last_us_) {
      days_us_ += day_us;
      microseconds += day_us;
    }
  }
  last_us_ = microseconds;
  line.has_time = true;
  line.microseconds = microseconds;
  time_.clear();
  append_seconds(time_, microseconds);
  line.time = time_;
  return true;
}

/// s or x: 11 or 29 bits; sr and xr: remote; s-fd, x-fd and others: not a frame of classical CAN.
std::string_view BusmasterParser::parse_type(std::string_view word, LogLine& line) {
  if (word.empty() || (word.front() != 's' && word.front() != 'x')) return "the type is not s, x, sr or xr";
  line.frame.extended = word.front() == 'x';
  word.remove_prefix(1);
  line.frame.remote = word == "r";
  if (word.find("fd") != std::string_view::npos) {
    line.kind = LogLineKind::can_fd;
  } else if (!word.empty() && word != "r") {
    return "the type is not s, x, sr or xr";
  }
  return "";
}

std::string_view BusmasterParser::parse_data(std::string_view rest, LogLine& line) const {
  const auto length = parse_whole<std::uint8_t>(take_word(rest));
  if (!length || *length > 8) return "the length is not 0 to 8";
  if (line.frame.remote) {
    line.frame.size = *length;
    return "";
  }
  while (line.frame.size < *length) {
    const auto byte = parse_whole<std::uint8_t>(take_word(rest), is_decimal_ ? 10 : 16);
    if (!byte) return "fewer bytes than the length states";
    line.frame.data[line.frame.size++] = *byte;
  }
  return "";
}

LogLine BusmasterParser::parse(std::string_view text) {
  LogLine line;
  text = first_line(text);
  if (text.empty()) return line;
  if (is_busmaster(text) || text.starts_with(mark)) {
    line.kind = LogLineKind::remark;
    parse_header(text);
    return line;
  }
  line.kind = LogLineKind::frame;
  if (!parse_time(take_word(text), line))
    return broken(line, "the time is not hours, minutes, seconds and units of 100 us");
  const std::string_view direction = take_word(text);
  if (!is_word(direction, "rx") && !is_word(direction, "tx")) return broken(line, "missing Rx or Tx");
  line.interface = take_word(text);
  std::string_view id_text = take_word(text);
  if (id_text.starts_with("0x")) id_text.remove_prefix(2);
  const auto id = parse_whole<std::uint32_t>(id_text, is_decimal_ ? 10 : 16);
  std::string_view problem = parse_type(take_word(text), line);
  if (problem.empty() && (!id || *id > (line.frame.extended ? 0x1FFF'FFFFU : 0x7FFU))) {
    problem = "the CAN-ID is not a number of 11 bits, or 29 bits with x";
  }
  line.frame.id = id.value_or(0);
  if (problem.empty() && line.kind == LogLineKind::frame) problem = parse_data(text, line);
  return problem.empty() ? line : broken(line, problem);
}

}  // namespace

const LogFormat busmaster_format{"busmaster", "log of BUSMASTER", is_busmaster, open_text<BusmasterParser>};

}  // namespace edsc

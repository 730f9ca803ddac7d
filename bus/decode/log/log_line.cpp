#include "decode/log/log_line.hpp"

#include <algorithm>
#include <chrono>

#include "decode/formats/words.hpp"

namespace edsc {
namespace {

/// Bit 29 of an eight-digit CAN-ID: an error frame.
constexpr std::uint32_t error_flag = 0x2000'0000;

/// `1436509052.249713`
bool parse_seconds(std::string_view text, std::int64_t& microseconds) {
  const auto number = parse_decimal(text, 6);  // candump -N has nanoseconds
  microseconds = number.value_or(0);
  return number.has_value();
}

/// `2015-07-10 08:17:32.249713`
bool parse_date(std::string_view text, std::int64_t& microseconds) {
  constexpr std::size_t seconds_at = std::string_view{"0000-00-00 00:00:"}.size();
  if (text.size() < seconds_at + 2) return false;
  const std::string_view form = text[10] == 'T' ? "0000-00-00T00:00:" : "0000-00-00 00:00:";
  const auto fields = parse_form<5>(text.substr(0, seconds_at), form);
  std::int64_t seconds = 0;
  if (!fields || !parse_seconds(text.substr(seconds_at), seconds)) return false;
  const auto [year, month, day, hour, minute] = *fields;
  if (month < 1 || month > 12 || day < 1 || day > 31) return false;
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(year)}, std::chrono::month{month},
                                         std::chrono::day{day}};
  const auto days = std::chrono::sys_days{date}.time_since_epoch().count();
  microseconds = ((std::int64_t{days} * 24 + hour) * 60 + minute) * 60'000'000 + seconds;
  return true;
}

/// Three digits, or eight of an extended CAN-ID or of the flags of an error frame.
bool parse_id(std::string_view text, LogLine& line) {
  const auto id = parse_whole<std::uint32_t>(text, 16);
  if (!id || (text.size() != 3 && text.size() != 8)) return false;
  line.frame.extended = text.size() == 8;
  const bool is_error = line.frame.extended && (*id & error_flag) != 0;
  line.kind = is_error ? LogLineKind::error_frame : LogLineKind::frame;
  line.frame.id = is_error ? *id & ~error_flag : *id;
  return line.frame.id <= (line.frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
}

std::optional<std::uint8_t> parse_byte(std::string_view digits) {
  return digits.size() == 2 ? parse_whole<std::uint8_t>(digits, 16) : std::nullopt;
}

/// `DEADBEEF`, `DE.AD.BE.EF`, `R`, `R8`, also followed by `_E`, a raw length, as in cansend.
LogLine parse_compact(std::string_view text, LogLine line) {
  const std::size_t hash = text.find('#');
  if (!parse_id(text.substr(0, hash), line)) return broken(line, "the CAN-ID does not have 3 or 8 hexadecimal digits");
  std::string_view data = text.substr(hash + 1);
  if (data.starts_with('#')) {
    line.kind = LogLineKind::can_fd;
    return line;
  }
  if (const std::size_t raw = data.find('_'); raw != std::string_view::npos) data = data.substr(0, raw);
  if (data.starts_with('R') || data.starts_with('r')) {
    line.frame.remote = true;
    if (data.size() > 2 || (data.size() == 2 && (data[1] < '0' || data[1] > '8'))) {
      return broken(line, "the length after R is not 0 to 8");
    }
    line.frame.size = data.size() == 2 ? static_cast<std::uint8_t>(data[1] - '0') : std::uint8_t{0};
    return line;
  }
  while (!data.empty()) {
    if (data.front() == '.') {
      data.remove_prefix(1);
      continue;
    }
    const auto byte = parse_byte(data.substr(0, 2));
    if (!byte) return broken(line, "the data are not pairs of hexadecimal digits");
    if (line.frame.size == 8) return broken(line, "a frame has at most 8 bytes");
    line.frame.data[line.frame.size++] = *byte;
    data.remove_prefix(2);
  }
  return line;
}

/// `123   [4]  DE AD BE EF`, from the length on. Any text of candump after the bytes is ignored.
LogLine parse_columns(std::string_view rest, LogLine line) {
  const std::string_view length = take_word(rest);
  if (length.size() < 3 || length.front() != '[' || length.back() != ']') {
    return broken(line, "missing length in brackets after the CAN-ID");
  }
  if (length.size() == 4 && is_digit(length[1]) && is_digit(length[2])) {
    line.kind = LogLineKind::can_fd;
    return line;
  }
  if (length.size() != 3 || length[1] < '0' || length[1] > '8') return broken(line, "the length is not 0 to 8");
  const auto size = static_cast<std::uint8_t>(length[1] - '0');
  std::string_view word = take_word(rest);
  if (word == "remote") {
    line.frame.remote = true;
    line.frame.size = size;
    return line;
  }
  for (; line.frame.size < size; word = take_word(rest)) {
    const auto byte = parse_byte(word);
    if (!byte) return broken(line, "fewer bytes than the length states");
    line.frame.data[line.frame.size++] = *byte;
  }
  return line;
}

}  // namespace

LogLine broken(LogLine line, std::string_view problem) {
  line.kind = LogLineKind::broken;
  line.problem = problem;
  return line;
}

LogLine parse_log_line(std::string_view text) {
  LogLine line;
  if (text.ends_with('\r')) text.remove_suffix(1);
  std::string_view rest = text;
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  if (rest.empty()) return line;
  if (text.front() == '\t') {
    line.kind = LogLineKind::remark;
    return line;
  }
  if (rest.front() == '(') {
    const std::size_t end = rest.find(')');
    if (end == std::string_view::npos) return broken(line, "the time is not terminated");
    line.time = rest.substr(1, end - 1);
    line.has_time = parse_seconds(line.time, line.microseconds) || parse_date(line.time, line.microseconds);
    if (!line.has_time) return broken(line, "the time is neither a number of seconds nor a date");
    rest.remove_prefix(end + 1);
  }
  std::string_view word = take_word(rest);
  if (word.find('#') != std::string_view::npos) return parse_compact(word, line);
  for (const char c : word) {
    if (c <= ' ' || c == '\x7F') return broken(line, "missing interface name");
  }
  line.interface = word;
  word = take_word(rest);
  if (word.find('#') != std::string_view::npos) return parse_compact(word, line);
  if (word == "RX" || word == "TX") {  // candump -x: direction, and two flags
    take_word(rest);
    take_word(rest);
    word = take_word(rest);
  }
  if (!parse_id(word, line)) return broken(line, "missing CAN-ID");
  return parse_columns(rest, line);
}

}  // namespace edsc

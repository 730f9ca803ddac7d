#include "decode/log_line.hpp"

#include <array>
#include <charconv>
#include <chrono>

#include "text/ascii.hpp"

namespace edsc {
namespace {

constexpr std::uint8_t no_digit = 0xFF;

/// The value of a hexadecimal digit.
constexpr std::array<std::uint8_t, 256> hex_values = [] {
  std::array<std::uint8_t, 256> values{};
  for (unsigned c = 0; c < values.size(); ++c) {
    const char letter = to_lower(static_cast<char>(c));
    values[c] = letter >= '0' && letter <= '9'   ? static_cast<std::uint8_t>(letter - '0')
                : letter >= 'a' && letter <= 'f' ? static_cast<std::uint8_t>(letter - 'a' + 10)
                                                 : no_digit;
  }
  return values;
}();

std::uint8_t hex_value(char c) { return hex_values[static_cast<unsigned char>(c)]; }

/// Removes the next word and the blanks before it from the text.
std::string_view take_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && (text[begin] == ' ' || text[begin] == '\t')) ++begin;
  std::size_t end = begin;
  while (end < text.size() && text[end] != ' ' && text[end] != '\t') ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// `1436509052.249713`
bool parse_seconds(std::string_view text, std::int64_t& microseconds) {
  constexpr std::size_t max_digits = 12;
  std::int64_t number = 0;
  std::size_t at = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) number = number * 10 + (text[at] - '0');
  if (at == 0 || at > max_digits) return false;
  std::size_t decimals = 0;
  if (at < text.size() && text[at] == '.') {
    for (++at; at < text.size() && is_digit(text[at]); ++at) {
      if (++decimals <= 6) number = number * 10 + (text[at] - '0');  // candump -N has nanoseconds
    }
  }
  for (; decimals < 6; ++decimals) number *= 10;
  microseconds = number;
  return at == text.size();
}

bool parse_number(std::string_view text, int& number) {
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  return parsed.ec == std::errc{} && parsed.ptr == text.data() + text.size();
}

/// `2015-07-10 08:17:32.249713`
bool parse_date(std::string_view text, std::int64_t& microseconds) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || (text[10] != ' ' && text[10] != 'T') || text[13] != ':' ||
      text[16] != ':')
    return false;
  const bool numbers = parse_number(text.substr(0, 4), year) && parse_number(text.substr(5, 2), month) &&
                       parse_number(text.substr(8, 2), day) && parse_number(text.substr(11, 2), hour) &&
                       parse_number(text.substr(14, 2), minute);
  if (!numbers || month < 1 || month > 12 || day < 1 || day > 31 || hour < 0 || minute < 0) return false;
  std::int64_t seconds = 0;
  if (!parse_seconds(text.substr(17), seconds)) return false;
  const auto days = std::chrono::sys_days{std::chrono::year{year} / month / day}.time_since_epoch().count();
  microseconds = ((std::int64_t{days} * 24 + hour) * 60 + minute) * 60'000'000 + seconds;
  return true;
}

LogLine broken(LogLine line, std::string_view problem) {
  line.kind = LogLineKind::broken;
  line.problem = problem;
  return line;
}

/// Three digits, or eight of an extended CAN-ID or of the flags of an error frame.
bool parse_id(std::string_view text, LogLine& line) {
  if (text.size() != 3 && text.size() != 8) return false;
  std::uint32_t id = 0;
  for (const char c : text) {
    const std::uint8_t digit = hex_value(c);
    if (digit == no_digit) return false;
    id = id << 4 | digit;
  }
  line.kind = LogLineKind::frame;
  line.frame.extended = text.size() == 8;
  if (line.frame.extended && (id & log_error_flag) != 0) {
    line.kind = LogLineKind::error_frame;
    id &= ~log_error_flag;
  }
  line.frame.id = id;
  return line.frame.extended ? id <= 0x1FFF'FFFF : id <= 0x7FF;
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
  std::uint8_t size = 0;
  for (std::size_t at = 0; at < data.size();) {
    if (data[at] == '.') {
      ++at;
      continue;
    }
    const std::uint8_t high = hex_value(data[at]);
    const std::uint8_t low = at + 1 < data.size() ? hex_value(data[at + 1]) : no_digit;
    if ((high | low) == no_digit || low == no_digit)
      return broken(line, "the data are not pairs of hexadecimal digits");
    if (size == 8) return broken(line, "a frame has at most 8 bytes");
    line.frame.data[size++] = static_cast<std::uint8_t>(high << 4 | low);
    at += 2;
  }
  line.frame.size = size;
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
  line.frame.size = static_cast<std::uint8_t>(length[1] - '0');
  for (unsigned i = 0; i < line.frame.size; ++i) {
    const std::string_view byte = take_word(rest);
    if (i == 0 && byte == "remote") {
      line.frame.remote = true;
      return line;
    }
    if (byte.size() != 2 || hex_value(byte[0]) == no_digit || hex_value(byte[1]) == no_digit) {
      return broken(line, "fewer bytes than the length states");
    }
    line.frame.data[i] = static_cast<std::uint8_t>(hex_value(byte[0]) << 4 | hex_value(byte[1]));
  }
  if (line.frame.size == 0 && take_word(rest) == "remote") line.frame.remote = true;
  return line;
}

bool is_id(std::string_view word) {
  LogLine unused;
  return parse_id(word, unused);
}

}  // namespace

LogLine parse_log_line(std::string_view text) {
  LogLine line;
  if (text.ends_with('\r')) text.remove_suffix(1);
  std::string_view rest = text;
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t')) rest.remove_prefix(1);
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
  if (!is_id(word)) return broken(line, "missing CAN-ID");
  static_cast<void>(parse_id(word, line));
  return parse_columns(rest, line);
}

}  // namespace edsc

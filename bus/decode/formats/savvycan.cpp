/// Logs of SavvyCAN in the format of GVRET: CSV with a header that names the columns. The time is in microseconds.
///
///   Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8
///   166064000,00000705,false,Rx,0,1,05,00,00,00,00,00,00,00,
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/text_source.hpp"
#include "decode/formats/words.hpp"

namespace edsc {
namespace {

constexpr std::string_view first_column = "time stamp,";

/// Removes the next cell and the comma after it from the text.
std::string_view take_cell(std::string_view& text) {
  const std::size_t end = std::min(text.find(','), text.size());
  const std::string_view cell = trim(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return cell;
}

bool is_savvycan(std::string_view beginning) {
  const std::string_view line = first_line(beginning);
  return is_word(line.substr(0, first_column.size()), first_column);
}

class SavvycanParser final : public LineParser {
 public:
  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  void parse_header(std::string_view text);
  [[nodiscard]] std::string_view parse_cell(std::string_view column, std::string_view cell, LogLine& line);

  std::vector<std::string> columns_;  ///< in lower case
  std::size_t stated_length_ = 0;
  std::string time_;
};

void SavvycanParser::parse_header(std::string_view text) {
  columns_.clear();
  while (!text.empty()) {
    columns_.emplace_back(take_cell(text));
    std::ranges::transform(columns_.back(), columns_.back().begin(), to_lower);
  }
}

/// Returns a problem, or nothing.
std::string_view SavvycanParser::parse_cell(std::string_view column, std::string_view cell, LogLine& line) {
  if (column == "time stamp") {
    const auto microseconds = parse_whole<std::uint64_t>(cell);
    if (!microseconds || *microseconds >= static_cast<std::uint64_t>(max_log_time_us)) {
      return "the time is not a number of microseconds";
    }
    line.has_time = true;
    line.microseconds = static_cast<std::int64_t>(*microseconds);
    time_.clear();
    append_seconds(time_, line.microseconds);
    line.time = time_;
  } else if (column == "id") {
    const auto id = parse_whole<std::uint32_t>(cell, 16);
    if (!id || *id > 0x1FFF'FFFFU) return "the CAN-ID is not a hexadecimal number of at most 29 bits";
    line.frame.id = *id;
  } else if (column == "extended") {
    line.frame.extended = is_word(cell, "true") || cell == "1";
  } else if (column == "bus") {
    line.interface = cell;
  } else if (column == "len") {
    const auto length = parse_whole<std::uint8_t>(cell);
    if (!length) return "the length is not a number";
    if (*length > 8) line.kind = LogLineKind::can_fd;
    stated_length_ = std::min<std::size_t>(*length, 8);
  } else if (column.size() == 2 && column.front() == 'd' && is_digit(column.back()) &&
             line.kind == LogLineKind::frame && line.frame.size < stated_length_) {
    const auto byte = parse_whole<std::uint8_t>(cell, 16);
    if (!byte) return "fewer bytes than the length states";
    line.frame.data[line.frame.size++] = *byte;
  }
  return "";
}

LogLine SavvycanParser::parse(std::string_view text) {
  LogLine line;
  text = first_line(text);
  if (text.empty()) return line;
  if (is_savvycan(text)) {
    line.kind = LogLineKind::remark;
    parse_header(text);
    return line;
  }
  line.kind = LogLineKind::frame;
  stated_length_ = 0;
  for (const std::string& column : columns_) {
    const std::string_view problem = parse_cell(column, take_cell(text), line);
    if (!problem.empty()) return broken(line, problem);
  }
  if (line.kind == LogLineKind::frame && line.frame.size < stated_length_) {
    return broken(line, "fewer bytes than the length states");
  }
  if (!line.frame.extended && line.frame.id > 0x7FF) {
    return broken(line, "the CAN-ID has more than 11 bits, and Extended is not true");
  }
  return line;
}

}  // namespace

const LogFormat savvycan_format{"savvycan", "CSV log of SavvyCAN (GVRET)", is_savvycan, open_text<SavvycanParser>};

}  // namespace edsc

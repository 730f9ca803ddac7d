/// Lines of a trace of PEAK PCAN-View, PCAN-Explorer or PCAN-Trace, by "PEAK CAN TRC File Format":
///
///   ;$FILEVERSION=1.1
///       1)      1059.9  Rx         0300  7  00 00 00 00 04 00 00
///       2)      1283.2  Rx     18EFC034  0  RTR
///   ;$FILEVERSION=2.1
///   ;$COLUMNS=N,O,T,B,I,d,R,L,D
///       1      1059.900 DT 1      0300 Rx -  7    00 00 00 00 04 00 00
///       2      1283.231 RR 1  18EFC034 Rx -  0
///       3      1298.945 ER 1         - Rx -  5    04 00 02 00 00
///
/// A time is in milliseconds. A trace without a version has version 1.0: message number, time, CAN-ID, length, data.
#include <string>
#include <string_view>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/text_source.hpp"
#include "decode/formats/words.hpp"

namespace edsc {
namespace {

struct TrcVersion {
  std::string_view version, columns;
};

constexpr TrcVersion trc_versions[] = {
    {"1.0", "NOIl"}, {"1.1", "NOdIl"}, {"1.2", "NOBdIl"}, {"1.3", "NOBdIRl"}, {"2.0", "NOTIdlD"}, {"2.1", "NOTBIdRLD"},
};

/// The types of the lines that are not data frames: in version 2, and in version 1 in place of the direction.
struct TrcType {
  std::string_view name;
  LogLineKind kind;
};

constexpr TrcType trc_types[] = {
    {"DT", LogLineKind::frame},     {"RR", LogLineKind::frame},       {"FD", LogLineKind::can_fd},
    {"FB", LogLineKind::can_fd},    {"FE", LogLineKind::can_fd},      {"BI", LogLineKind::can_fd},
    {"ST", LogLineKind::remark},    {"EC", LogLineKind::remark},      {"EV", LogLineKind::remark},
    {"Warng", LogLineKind::remark}, {"ER", LogLineKind::error_frame}, {"Error", LogLineKind::error_frame},
    {"Rx", LogLineKind::frame},     {"Tx", LogLineKind::frame},
};

/// The CAN-ID of a status line of version 1.
constexpr std::uint32_t status_id = 0xFFFF'FFFF;

const TrcType* find_type(std::string_view name) {
  const auto* const found = std::ranges::find(trc_types, name, &TrcType::name);
  return found == std::end(trc_types) ? nullptr : found;
}

/// `00 00 04`, `RTR` and nothing
void parse_trc_data(std::string_view rest, std::uint8_t size, LogLine& line) {
  std::string_view word = take_word(rest);
  line.frame.remote = line.frame.remote || word == "RTR";
  if (line.frame.remote) {
    line.frame.size = size;
    return;
  }
  for (; line.frame.size < size; word = take_word(rest)) {
    const auto byte = word.size() == 2 ? parse_whole<std::uint8_t>(word, 16) : std::nullopt;
    if (!byte) {
      line = broken(line, "fewer bytes than the length states");
      return;
    }
    line.frame.data[line.frame.size++] = *byte;
  }
}

class TrcParser final : public LineParser {
 public:
  /// The time is in seconds since the start of the trace, with six decimals.
  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  [[nodiscard]] LogLine parse_comment(std::string_view text);
  [[nodiscard]] LogLine parse_event(std::string_view rest);
  [[nodiscard]] std::string_view parse_column(char column, std::string_view word, LogLine& line);

  /// Letters of $COLUMNS: N message number, O time, T type, B bus, I CAN-ID, d direction or type of version 1, R
  /// reserved, l length, L length code; D, the data, is the last one.
  std::string columns_ = "NOIl";
  std::string time_;
};

bool is_trc(std::string_view beginning) { return first_line(beginning).starts_with(';'); }

LogLine TrcParser::parse(std::string_view text) {
  text = first_line(text);
  if (text.empty()) return {};
  return text.front() == ';' ? parse_comment(text.substr(1)) : parse_event(text);
}

LogLine TrcParser::parse_comment(std::string_view text) {
  constexpr std::string_view version_key = "$FILEVERSION=", columns_key = "$COLUMNS=";
  LogLine line;
  line.kind = LogLineKind::remark;
  if (text.starts_with(version_key)) {
    const auto* const row =
        std::ranges::find(trc_versions, trim(text.substr(version_key.size())), &TrcVersion::version);
    if (row == std::end(trc_versions)) {
      line.kind = LogLineKind::unreadable;
      line.problem = "the file version is not 1.0 to 1.3, 2.0 or 2.1";
      return line;
    }
    columns_ = row->columns;
  } else if (text.starts_with(columns_key)) {
    columns_.clear();
    for (const char c : trim(text.substr(columns_key.size()))) {
      if (c != ',') columns_ += c;
    }
    if (!columns_.starts_with("NOT") || columns_.find('I') == std::string::npos ||
        columns_.find_first_not_of("NOTBIdRlLD") != std::string::npos) {
      line.kind = LogLineKind::unreadable;
      line.problem = "the columns do not begin with N,O,T, lack I, or are not N, O, T, B, I, d, R, l, L and D";
    }
  }
  return line;
}

/// Returns a problem, or nothing.
std::string_view TrcParser::parse_column(char column, std::string_view word, LogLine& line) {
  switch (column) {
    case 'N':
      if (word.ends_with(')')) word.remove_suffix(1);
      return is_number(word) ? "" : "missing message number";
    case 'O': {
      const auto microseconds = parse_decimal(word, 3);
      if (!microseconds) return "the time is not a number of milliseconds";
      line.has_time = true;
      line.microseconds = *microseconds;
      time_.clear();
      append_seconds(time_, *microseconds);
      line.time = time_;
      return "";
    }
    case 'T':
    case 'd': {
      const TrcType* const type = find_type(word);
      if (type == nullptr) return column == 'T' ? "unknown type of message" : "missing Rx or Tx";
      if (column == 'T' || columns_.find('T') == std::string::npos) line.kind = type->kind;
      line.frame.remote = line.frame.remote || word == "RR";
      return "";
    }
    case 'B': line.interface = word; return "";
    case 'I': {
      const auto id = parse_whole<std::uint32_t>(word, 16);
      line.frame.extended = word.size() > 4;
      line.frame.id = id.value_or(0);
      if (id == status_id) line.kind = LogLineKind::remark;
      const bool fits = id && *id <= (line.frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
      return fits || line.kind != LogLineKind::frame ? "" : "the CAN-ID is not a number of 11 bits, or 8 digits";
    }
    default: return "";
  }
}

LogLine TrcParser::parse_event(std::string_view rest) {
  LogLine line;
  line.kind = LogLineKind::frame;
  std::uint8_t size = 0;
  for (const char column : columns_) {
    if (column == 'D') break;
    const std::string_view word = take_word(rest);
    if (column == 'l' || column == 'L') {
      constexpr std::uint8_t max_code = 15;  // the length codes 9 to 15 are 8 bytes (ISO 11898-1)
      const auto length = parse_whole<std::uint8_t>(word);
      if (!length || *length > max_code) return broken(line, "the length is not 0 to 15");
      size = std::min(*length, std::uint8_t{8});
      continue;
    }
    const std::string_view problem = parse_column(column, word, line);
    if (!problem.empty()) return broken(line, problem);
    // Columns of other lines may be empty, so that the words after them have other positions.
    const bool has_bus = columns_.find('B') > columns_.find(column) && columns_.find('B') != std::string::npos;
    if (line.kind != LogLineKind::frame && !(column == 'T' && has_bus)) break;
  }
  if (line.kind == LogLineKind::frame) parse_trc_data(rest, size, line);
  if (line.kind == LogLineKind::error_frame) {
    line.frame = {};
    line.frame.extended = true;  // the CAN-ID of an error frame has error flags; they are not known here
  }
  return line;
}

}  // namespace

const LogFormat trc_format{"trc", "trace of PEAK PCAN-View, versions 1.0 to 2.1", is_trc, open_text<TrcParser>};

}  // namespace edsc

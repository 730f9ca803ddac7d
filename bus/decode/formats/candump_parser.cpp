#include "decode/formats/candump_parser.hpp"

#include <algorithm>

namespace edsc {
namespace {

/// Frames of two interfaces may be slightly out of order. A difference, in contrast, is soon much shorter than another.
bool is_difference(std::int64_t us, std::int64_t before_us) {
  constexpr std::int64_t out_of_order_part = 16;
  return us < before_us - before_us / out_of_order_part;
}

}  // namespace

CandumpParser::CandumpParser(std::string_view beginning) {
  while (!differences_) {
    const std::size_t end = beginning.find('\n');
    if (end == std::string_view::npos) break;
    (void)parse(beginning.substr(0, end));
    beginning.remove_prefix(end + 1);
  }
  last_us_.reset();
  sum_us_ = 0;
}

/// Times that begin with 0 and decrease are differences.
void CandumpParser::count_time(LogLine& line) {
  if (!last_us_) from_zero_ = line.microseconds == 0;
  differences_ = differences_ || (from_zero_ && is_difference(line.microseconds, last_us_.value_or(0)));
  last_us_ = line.microseconds;
  if (!from_zero_) return;
  sum_us_ = std::min(sum_us_ + line.microseconds, max_log_time_us);
  if (differences_) line.microseconds = sum_us_;
}

LogLine CandumpParser::parse(std::string_view text) {
  LogLine line = parse_log_line(text);
  if (line.has_time) count_time(line);
  return line;
}

}  // namespace edsc

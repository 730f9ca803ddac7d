/// Lines of candump (decode/log/log_line.hpp), with the times of its option -t d, which count from the previous line.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/text_source.hpp"

namespace edsc {
namespace {

/// Frames of two interfaces may be slightly out of order. A difference, in contrast, is soon much shorter than another.
bool is_difference(std::int64_t us, std::int64_t before_us) {
  constexpr std::int64_t out_of_order_part = 16;
  return us < before_us - before_us / out_of_order_part;
}

class CandumpParser final : public LineParser {
 public:
  /// The beginning of the log shows whether its times are differences; if it is too short for that, later lines do.
  explicit CandumpParser(std::string_view beginning);

  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  void count_time(LogLine& line);

  bool differences_ = false;
  std::optional<std::int64_t> last_us_;
  std::int64_t sum_us_ = 0;  ///< of the times of a log that begins with 0
  bool from_zero_ = false;
};

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

std::unique_ptr<LogSource> open_candump(LogInput& input, std::string& /*problem*/) {
  return std::make_unique<TextSource<CandumpParser>>(input, input.beginning());
}

}  // namespace

const LogFormat candump_format{"candump", "log or screen output of candump", [](std::string_view) { return true; },
                               open_candump};

}  // namespace edsc

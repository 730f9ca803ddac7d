/// Lines of candump (decode/log/log_line.hpp), with the times of its option -t d, which count from the previous line.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "decode/formats/log_source.hpp"

namespace edsc {

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

}  // namespace edsc

/// A candump log, line by line, to text or JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/log_line.hpp"
#include "decode/message_filter.hpp"
#include "decode/print_message.hpp"
#include "decode/summary.hpp"

namespace edsc {

struct LogDecoderSettings {
  std::string log_name;   ///< in complaints
  std::string interface;  ///< frames of others are passed over; empty: of all
  bool json = false;
  bool color = false;
  MessageFilter filter;  ///< what is shown; all frames are followed
};

class LogDecoder {
 public:
  /// Complaints about lines up to which they are listed; the others are counted.
  static constexpr std::size_t most_complaints = 50;

  LogDecoder(const std::vector<KnownNode>& nodes, NodeLabels labels, LogDecoderSettings settings);

  /// Appends what the line says to `out`, and what is wrong with it to `complaints`.
  void decode(std::string_view line, std::size_t line_number, std::string& out, std::string& complaints);

  /// What is left to say at the end: transfers that are not finished, and complaints that were counted.
  void finish(std::string& complaints);

  [[nodiscard]] const Summary& summary() const { return summary_; }
  [[nodiscard]] bool skipped_lines() const { return broken_lines_ > 0; }

 private:
  void complain(std::size_t line_number, std::string_view what, std::string& complaints);
  void count_time(LogLine& line);

  LogDecoderSettings settings_;
  NodeLabels labels_;
  Decoder decoder_;
  Message message_;
  Summary summary_;
  std::size_t broken_lines_ = 0, complaints_ = 0;

  // candump -t d tells the time since the frame before.
  bool has_time_ = false, from_zero_ = false, deltas_ = false;
  std::int64_t last_time_ = 0, sum_ = 0;
};

}  // namespace edsc

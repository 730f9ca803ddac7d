/// The lines or packets of a log, one by one, to text, JSON or CSV.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/log/log_line.hpp"
#include "decode/log/message_filter.hpp"
#include "decode/log/print_message.hpp"
#include "decode/log/summary.hpp"

namespace edsc {

enum class LogOutput : std::uint8_t { text, json, csv };

struct LogDecoderSettings {
  std::string log_name;   ///< in error messages
  std::string interface;  ///< ignore frames of other interfaces; empty: all
  LogOutput output = LogOutput::text;
  bool color = false;
  MessageFilter filter;  ///< frames to show; all frames are evaluated
};

class LogDecoder {
 public:
  /// Maximum number of listed errors; any more are counted.
  static constexpr std::size_t max_complaints = 50;

  LogDecoder(const std::vector<KnownNode>& nodes, NodeLabels labels, LogDecoderSettings settings);

  /// Appends the decoded line to `out`, and errors to `complaints`.
  void decode(LogLine& line, std::string& out, std::string& complaints);

  /// Returns the message of a frame, valid until the next call; null for other lines and interfaces. Errors as above.
  [[nodiscard]] const Message* evaluate(LogLine& line, std::string& complaints);

  /// Appends the errors at the end of the log: unfinished transfers, and the number of errors that were not listed.
  void finish(std::string& complaints);

  [[nodiscard]] const Summary& summary() const { return summary_; }
  [[nodiscard]] const Decoder& decoder() const { return decoder_; }
  [[nodiscard]] bool skipped_lines() const { return summary_.broken_lines() > 0; }

 private:
  void complain(const LogLine& line, std::string_view what, std::string& complaints);

  LogDecoderSettings settings_;
  NodeLabels labels_;
  Decoder decoder_;
  Message message_;
  Summary summary_;
  std::size_t complaints_ = 0;
};

}  // namespace edsc

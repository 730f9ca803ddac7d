/// Logs of lines: a format has a parser for one of them.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "decode/formats/log_input.hpp"
#include "decode/formats/log_source.hpp"
#include "decode/log/log_reader.hpp"

namespace edsc {

/// Parses the lines of a text format, in their order.
class LineParser {
 public:
  LineParser() = default;
  LineParser(const LineParser&) = delete;
  LineParser& operator=(const LineParser&) = delete;
  virtual ~LineParser() = default;

  /// `text` has no line end. The texts of the result are valid until the next call, and as long as `text`.
  [[nodiscard]] virtual LogLine parse(std::string_view text) = 0;
};

/// A log of lines.
template <class Parser>
class TextSource final : public LogSource {
 public:
  template <class... Settings>
  explicit TextSource(LogInput& input, const Settings&... settings) : reader_{input}, parser_{settings...} {}

  [[nodiscard]] bool next(LogLine& line) override {
    std::string_view text;
    if (at_end_ || !reader_.next(text)) return false;
    line = parser_.parse(text);
    line.number = reader_.line_number();
    line.text = text;
    at_end_ = line.kind == LogLineKind::unreadable;
    return true;
  }

 private:
  LogReader reader_;
  Parser parser_;
  bool at_end_ = false;
};

/// `LogFormat::open` of a format whose parser does not need the beginning of the log.
template <class Parser>
std::unique_ptr<LogSource> open_text(LogInput& input, std::string& /*problem*/) {
  return std::make_unique<TextSource<Parser>>(input);
}

}  // namespace edsc

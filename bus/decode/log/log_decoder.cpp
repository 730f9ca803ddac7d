#include "decode/log/log_decoder.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "decode/error_frame_text.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

std::string broken_line_text(const LogLine& line, std::string_view text) {
  constexpr std::size_t max_shown = 60;
  std::string sentence = fmt::format("skipped, {}: ", line.problem);
  append_quoted(sentence, text.substr(0, max_shown));
  if (text.size() > max_shown) sentence += "...";
  return sentence;
}

}  // namespace

LogDecoder::LogDecoder(const std::vector<KnownNode>& nodes, NodeLabels labels, LogDecoderSettings settings)
    : settings_{std::move(settings)}, labels_{std::move(labels)}, decoder_{nodes} {}

void LogDecoder::complain(std::size_t line_number, std::string_view what, std::string& complaints) {
  if (++complaints_ > max_complaints) return;
  fmt::format_to(std::back_inserter(complaints), "{}:{}: {}\n", printable(settings_.log_name), line_number,
                 printable(what));
}

/// Times that begin with 0 and decrease are differences, which are added up from then on.
void LogDecoder::count_time(LogLine& line) {
  if (!line.has_time) return;
  if (!has_time_) from_zero_ = line.microseconds == 0;
  if (has_time_ && from_zero_ && !deltas_ && line.microseconds < last_time_) {
    deltas_ = true;
    sum_ = last_time_;
  }
  has_time_ = true;
  last_time_ = line.microseconds;
  if (!deltas_) return;
  sum_ += line.microseconds;
  line.microseconds = sum_;
}

void LogDecoder::decode(std::string_view text, std::size_t line_number, std::string& out, std::string& complaints) {
  LogLine line = parse_log_line(text);
  if (!settings_.interface.empty() && !line.interface.empty() && line.interface != settings_.interface) return;
  switch (line.kind) {
    case LogLineKind::blank:
    case LogLineKind::remark: return;
    case LogLineKind::can_fd:
      summary_.add_can_fd();
      return complain(line_number, "a CAN FD frame is ignored", complaints);
    case LogLineKind::broken:
      summary_.add_broken_line();
      return complain(line_number, broken_line_text(line, text), complaints);
    case LogLineKind::frame:
      count_time(line);
      decoder_.decode({line.frame, line.has_time, line.microseconds}, message_);
      break;
    case LogLineKind::error_frame:
      count_time(line);
      message_.clear();
      message_.service = Service::error_frame;
      message_.problem = true;
      append_error_frame_text(message_.text, line.frame);
      break;
  }
  summary_.add(line, message_);
  if (!settings_.filter.passes(line, message_)) return;
  if (settings_.json) {
    append_json(out, line, line_number, message_, labels_);
  } else {
    append_text(out, line, message_, labels_, settings_.color);
  }
}

void LogDecoder::finish(std::string& complaints) {
  const auto open = decoder_.open_transfers();
  summary_.set_open_transfers(open.size());
  for (const std::string& transfer : open) {
    fmt::format_to(std::back_inserter(complaints), "{}: {} was not finished\n", printable(settings_.log_name),
                   printable(transfer));
  }
  if (complaints_ > max_complaints) {
    fmt::format_to(std::back_inserter(complaints), "{}: {} like {}\n", printable(settings_.log_name),
                   counted(complaints_ - max_complaints, "more line"),
                   complaints_ - max_complaints == 1 ? "this" : "these");
  }
}

}  // namespace edsc

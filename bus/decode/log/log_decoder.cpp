#include "decode/log/log_decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "decode/error_frame_text.hpp"
#include "decode/log/print_csv.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

std::string broken_line_text(const LogLine& line) {
  constexpr std::size_t max_shown = 60;
  if (line.kind == LogLineKind::unreadable) return fmt::format("the rest cannot be read: {}", line.problem);
  std::string sentence = fmt::format("skipped, {}", line.problem);
  if (line.byte) return sentence;
  sentence += ": ";
  append_quoted(sentence, line.text.substr(0, max_shown));
  if (line.text.size() > max_shown) sentence += "...";
  return sentence;
}

/// `12`, `packet 12 at byte 345`
std::string place_text(const LogLine& line) {
  return line.byte ? fmt::format(" packet {} at byte {}", line.number, *line.byte) : std::to_string(line.number);
}

}  // namespace

LogDecoder::LogDecoder(const std::vector<KnownNode>& nodes, NodeLabels labels, LogDecoderSettings settings)
    : settings_{std::move(settings)}, labels_{std::move(labels)}, decoder_{nodes} {}

void LogDecoder::complain(const LogLine& line, std::string_view what, std::string& complaints) {
  if (++complaints_ > max_complaints) return;
  fmt::format_to(std::back_inserter(complaints), "{}:{}: {}\n", printable(settings_.log_name), place_text(line),
                 printable(what));
}

const Message* LogDecoder::evaluate(LogLine& line, std::string& complaints) {
  if (!settings_.interface.empty() && !line.interface.empty() && line.interface != settings_.interface) return nullptr;
  switch (line.kind) {
    case LogLineKind::blank:
    case LogLineKind::remark: return nullptr;
    case LogLineKind::can_fd:
      summary_.add_can_fd();
      complain(line, "a CAN FD frame is ignored", complaints);
      return nullptr;
    case LogLineKind::broken:
    case LogLineKind::unreadable:
      summary_.add_broken_line();
      complain(line, broken_line_text(line), complaints);
      return nullptr;
    case LogLineKind::frame: decoder_.decode({line.frame, line.has_time, line.microseconds}, message_); break;
    case LogLineKind::error_frame:
      message_.clear();
      message_.service = Service::error_frame;
      message_.problem = true;
      append_error_frame_text(message_.text, line.frame);
      break;
  }
  summary_.add(line, message_);
  return &message_;
}

void LogDecoder::decode(LogLine& line, std::string& out, std::string& complaints) {
  const Message* const message = evaluate(line, complaints);
  if (message == nullptr || !settings_.filter.passes(line, *message)) return;
  switch (settings_.output) {
    case LogOutput::text: return append_text(out, line, *message, labels_, settings_.color);
    case LogOutput::json: return append_json(out, line, *message, labels_);
    case LogOutput::csv: return append_csv(out, line, *message, labels_);
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

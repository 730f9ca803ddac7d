#include "conform/report/decoded_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conform/report/report_facts.hpp"
#include "decode/decoder.hpp"
#include "decode/log/log_line.hpp"
#include "decode/log/print_message.hpp"
#include "text/counted.hpp"

namespace edsc::conform {

void decode_frames(std::span<const SeenFrame> frames, std::uint8_t node, const Device& sheet,
                   const std::function<void(const SeenFrame&, const Message&)>& use) {
  Decoder decoder{{KnownNode{node, &sheet}}};
  Message message;
  for (const SeenFrame& seen : frames) {
    decoder.decode({seen.frame, true, static_cast<std::int64_t>(seen.at)}, message);
    use(seen, message);
  }
}

std::vector<std::string> frame_lines(std::span<const SeenFrame> frames, std::uint8_t node, const Device& sheet,
                                     std::size_t max_frames) {
  std::vector<std::string> lines;
  std::size_t left_out = frames.size() - std::min(frames.size(), max_frames);
  if (left_out > 0)
    lines.push_back(fmt::format("{} not shown; --log writes all frames", counted(left_out, "earlier frame")));
  const NodeLabels labels;
  const std::size_t width = frames.empty() ? 0 : time_text(frames.back().at).size();
  decode_frames(frames, node, sheet, [&](const SeenFrame& seen, const Message& message) {
    if (left_out > 0) {
      --left_out;
      return;
    }
    const std::string time = fmt::format("{:>{}}", time_text(seen.at), width);
    LogLine line;
    line.has_time = true;
    line.time = time;
    line.interface = direction_text(seen);
    line.frame = seen.frame;
    std::string text;
    append_text(text, line, message, labels, false);
    text.pop_back();  // the line end
    lines.push_back(std::move(text));
  });
  return lines;
}

}  // namespace edsc::conform

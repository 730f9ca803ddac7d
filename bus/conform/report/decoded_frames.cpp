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

std::vector<std::size_t> shown_frames(std::size_t count, std::span<const std::size_t> named, std::size_t max_frames) {
  std::vector<bool> is_shown(count, false);
  std::size_t left = std::min(count, max_frames);
  const auto show = [&](std::size_t position) {
    if (left == 0 || position >= count || is_shown[position]) return;
    is_shown[position] = true;
    --left;
  };
  for (const std::size_t position : named) show(position);
  for (std::size_t distance = 1; !named.empty() && left != 0 && distance < count; ++distance) {
    for (const std::size_t position : named) {
      if (position >= distance) show(position - distance);
      show(position + distance);
    }
  }
  for (std::size_t position = count; position != 0 && left != 0; --position) show(position - 1);
  std::vector<std::size_t> positions;
  for (std::size_t position = 0; position != count; ++position) {
    if (is_shown[position]) positions.push_back(position);
  }
  return positions;
}

namespace {

std::string line_of(const SeenFrame& seen, const Message& message, std::size_t width) {
  const std::string time = fmt::format("{:>{}}", time_text(seen.at), width);
  LogLine line;
  line.has_time = true;
  line.time = time;
  line.interface = direction_text(seen);
  line.frame = seen.frame;
  std::string text;
  append_text(text, line, message, NodeLabels{}, false);
  text.pop_back();  // the line end
  return text;
}

std::string not_shown_text(std::size_t count, bool is_first, bool is_last) {
  if (is_first) return fmt::format("{} not shown; --log writes all frames", counted(count, "earlier frame"));
  return fmt::format("{} not shown", counted(count, is_last ? "later frame" : "frame"));
}

}  // namespace

std::vector<std::string> frame_lines(std::span<const SeenFrame> frames, std::uint8_t node, const Device& sheet,
                                     std::size_t max_frames, std::span<const std::size_t> named) {
  const std::vector<std::size_t> shown = shown_frames(frames.size(), named, max_frames);
  const std::size_t width = frames.empty() ? 0 : time_text(frames.back().at).size();
  std::vector<std::string> lines;
  std::size_t position = 0, expected = 0;
  auto next = shown.begin();
  decode_frames(frames, node, sheet, [&](const SeenFrame& seen, const Message& message) {
    const std::size_t present = position++;
    if (next == shown.end() || *next != present) return;
    ++next;
    if (present != expected) lines.push_back(not_shown_text(present - expected, expected == 0, false));
    expected = present + 1;
    const bool is_named = std::ranges::find(named, present) != named.end();
    const std::string_view mark = named.empty() ? "" : is_named ? "> " : "  ";
    lines.push_back(fmt::format("{}{}", mark, line_of(seen, message, width)));
  });
  if (expected != frames.size()) lines.push_back(not_shown_text(frames.size() - expected, expected == 0, true));
  return lines;
}

}  // namespace edsc::conform

#include "eds/dynamic_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "eds/keys.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

constexpr std::string_view segment_count_key = "NrOfSeg";

/// The prefix of the segment number.
constexpr KeyRow<DynamicSegment> segment_rows[] = {
    {"Type", &DynamicSegment::type},
    {"Dir", &DynamicSegment::direction},
    {"Range", &DynamicSegment::range},
    {"PPOffset", &DynamicSegment::process_picture_offset},
};

DynamicSegment& segment_of(DynamicChannels& channels, std::uint32_t number) {
  std::vector<DynamicSegment>& segments = channels.segments;
  const auto at = std::lower_bound(segments.begin(), segments.end(), number,
                                   [](const DynamicSegment& segment, std::uint32_t n) { return segment.number < n; });
  if (at != segments.end() && at->number == number) {
    return *at;
  }
  DynamicSegment segment;
  segment.number = number;
  return *segments.insert(at, segment);
}

KeyMatch find_segment_key(std::string_view key, DynamicChannels& channels) {
  for (const KeyRow<DynamicSegment>& row : segment_rows) {
    if (const std::optional<std::uint32_t> number = number_behind(row.name, key)) {
      return {true, &(segment_of(channels, *number).*row.field)};
    }
  }
  return {};
}

}  // namespace

DynamicChannels read_dynamic_channels(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics) {
  DynamicChannels channels;
  channels.present = true;
  channels.nr_of_segments.position = section_position(source, section);
  read_keys(
      source, section, diagnostics,
      [&](std::string_view key) {
        return equal_ignoring_case(key, segment_count_key) ? KeyMatch{true, &channels.nr_of_segments}
                                                           : find_segment_key(key, channels);
      },
      segment_count_key);
  const std::string_view text = strip_inline_comment(channels.nr_of_segments.text);
  const std::optional<std::uint64_t> count = text.empty() ? std::optional<std::uint64_t>{0} : parse_unsigned(text);
  if (!count || *count != channels.segments.size()) {
    diagnostics.warning(
        "dynamic-segment", channels.nr_of_segments.position,
        fmt::format("{} must be the number of segments, {}", segment_count_key, channels.segments.size()));
  }
  return channels;
}

}  // namespace edsc

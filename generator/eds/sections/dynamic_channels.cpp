#include "eds/sections/other_sections.hpp"

#include <fmt/format.h>

#include <optional>

#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

Field* find_segment_key(std::string_view key, NumberedRows<DynamicSegment>& segments) {
  for (const KeyRow<DynamicSegment>& row : segment_keys) {
    if (const auto number = match_key(row.key, key)) return &(segments.find_or_add(*number).*row.field);
  }
  return nullptr;
}

}  // namespace

DynamicChannels read_dynamic_channels(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics) {
  DynamicChannels channels;
  channels.present = true;
  channels.nr_of_segments.position = section_position(source, section);
  NumberedRows<DynamicSegment> segments{channels.segments};
  read_keys(
      source, section, diagnostics,
      [&](std::string_view key) {
        return equal_ignoring_case(key, segment_count_key.name) ? &channels.nr_of_segments
                                                                : find_segment_key(key, segments);
      },
      segment_count_key.name);
  segments.sort();
  const std::string_view text = strip_inline_comment(channels.nr_of_segments.text);
  const std::optional<std::uint64_t> count = text.empty() ? std::optional<std::uint64_t>{0} : parse_unsigned(text);
  if (!count || *count != channels.segments.size()) {
    diagnostics.warning(
        "dynamic-segment", channels.nr_of_segments.position,
        fmt::format("{} must be the number of segments, {}", segment_count_key.name, channels.segments.size()));
  }
  return channels;
}

}  // namespace edsc

#include "eds/sections/other_sections.hpp"

#include <fmt/format.h>

#include <optional>

#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

constexpr std::string_view count_key = comment_line_count.name;

void check_count(const SourceFile& source, const IniSection& section, const Comments& comments,
                 Diagnostics& diagnostics) {
  if (!comments.lines.present) {
    diagnostics.warning("comments", section_position(source, section),
                        fmt::format("missing {} in [{}]", count_key, section.name));
    return;
  }
  const std::optional<std::uint64_t> count = number_of(comments.lines);
  const bool counts_up = comments.text.empty() || comments.text.back().number == comments.text.size();
  if (!count || *count != comments.text.size() || !counts_up) {
    diagnostics.warning("comments", comments.lines.position,
                        fmt::format("the lines are not numbered 1 to {}; there are {}",
                                    strip_inline_comment(comments.lines.text), comments.text.size()));
  }
}

}  // namespace

Comments read_comments(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics) {
  Comments comments;
  comments.present = true;
  comments.text.reserve(section.entries.size());
  NumberedRows<NumberedField> lines{comments.text};
  read_keys(
      source, section, diagnostics,
      [&](std::string_view key) {
        if (equal_ignoring_case(key, count_key)) return &comments.lines;
        const std::optional<std::uint32_t> number = match_key(comment_line, key);
        return number ? &lines.find_or_add(*number).field : nullptr;
      },
      count_key);
  lines.sort();
  check_count(source, section, comments, diagnostics);
  return comments;
}

}  // namespace edsc

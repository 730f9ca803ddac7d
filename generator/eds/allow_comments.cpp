#include "eds/allow_comments.hpp"

#include <algorithm>
#include <optional>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_name.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr std::string_view mark = "edsc:";
constexpr std::string_view verb = "allow";

bool is_compact_list(SectionKind kind) {
  return kind == SectionKind::compact_names || kind == SectionKind::compact_values ||
         kind == SectionKind::compact_denotations;
}

/// Removes the first word of `text` and the blanks after it.
std::string_view take_word(std::string_view& text) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if(text, is_blank) - text.begin());
  const std::string_view word = text.substr(0, end);
  text = trim_left(text.substr(end));
  return word;
}

class CommentFinder {
 public:
  explicit CommentFinder(const SourceFile& source) : source_{source} { found_.outline.file = &source; }

  AllowComments run() {
    for (line_number_ = 1; line_number_ <= source_.lines(); ++line_number_) read_line(source_.line(line_number_));
    return std::move(found_);
  }

 private:
  void read_line(std::string_view line) {
    const std::string_view content = trim(line);
    if (content.empty()) return;
    if (content[0] == ';' || content[0] == '#') {
      read_comment(line, content);
    } else if (content[0] == '[') {
      read_header(line, content);
    } else {
      read_entry(content);
    }
  }

  void read_comment(std::string_view line, std::string_view comment) {
    std::string_view text = trim_left(comment.substr(1));
    if (!text.starts_with(mark)) return;
    text = trim_left(text.substr(mark.size()));
    AllowComment& one = found_.comments.emplace_back();
    one.position = place(line, comment);
    if (take_word(text) == verb && !text.empty()) {
      one.rule = take_word(text);
      one.position = place(line, one.rule);
      if (take_word(text) == "-") one.reason = trim(text);
    }
    one.has_target = found_.outline.parts.empty();
  }

  void read_header(std::string_view line, std::string_view content) {
    const std::size_t end = content.find(']');
    if (end == std::string_view::npos) return;
    section_ = read_section_name(trim(content.substr(1, end - 1)), source_.choices().sub_indices);
    SheetPart part;
    part.line = line_number_;
    const bool is_object = is_object_section(section_.kind);
    if (is_object) part.index = section_.index;
    if (is_object && !is_compact_list(section_.kind)) part.sub_index = section_.sub_index;
    found_.outline.parts.push_back(part);
    apply_waiting(AllowanceScope::Kind::part);
    const std::string_view rest = trim(content.substr(end + 1));
    if (!rest.starts_with(';') && !rest.starts_with('#')) return;
    for (const std::string_view comment : split_header_comment(rest)) read_comment(line, comment);
    apply_waiting(AllowanceScope::Kind::part);
  }

  void read_entry(std::string_view content) {
    apply_waiting(AllowanceScope::Kind::line);
    const std::size_t equals = content.find('=');
    if (equals == std::string_view::npos) return;
    SheetPart part;
    part.line = line_number_;
    if (is_object_list(section_.kind)) {
      const auto index = parse_unsigned(trim(content.substr(equals + 1)));
      if (!index || *index > 0xFFFF) return;
      part.index = static_cast<std::uint16_t>(*index);
    } else if (is_compact_list(section_.kind)) {
      const auto sub_index = parse_unsigned(trim(content.substr(0, equals)));
      if (!sub_index || *sub_index > 0xFF) return;
      part.index = section_.index;
      part.sub_index = static_cast<std::uint8_t>(*sub_index);
    } else {
      return;
    }
    found_.outline.lines.push_back(part);
  }

  void apply_waiting(AllowanceScope::Kind kind) {
    for (; waiting_ < found_.comments.size(); ++waiting_) {
      AllowComment& one = found_.comments[waiting_];
      if (one.has_target) continue;
      one.has_target = true;
      one.scope.kind = kind;
      one.scope.line = line_number_;
    }
  }

  [[nodiscard]] Position place(std::string_view line, std::string_view part) const {
    return {&source_, line_number_, static_cast<std::uint32_t>(part.data() - line.data()) + 1,
            static_cast<std::uint32_t>(std::max<std::size_t>(part.size(), 1))};
  }

  const SourceFile& source_;
  AllowComments found_;
  SectionName section_;
  std::uint32_t line_number_ = 0;
  std::size_t waiting_ = 0;  ///< the first comment that may wait for the line it applies to
};

}  // namespace

AllowComments find_allow_comments(const SourceFile& source) { return CommentFinder{source}.run(); }

bool is_for_edsc(std::string_view comment) {
  return !comment.empty() && trim_left(comment.substr(1)).starts_with(mark);
}

std::vector<std::string_view> split_header_comment(std::string_view comment) {
  std::vector<std::string_view> parts;
  std::size_t start = 0;
  for (std::size_t at = comment.find(';', 1); at != std::string_view::npos; at = comment.find(';', at + 1)) {
    if (!is_for_edsc(comment.substr(at))) continue;
    parts.push_back(trim(comment.substr(start, at - start)));
    start = at;
  }
  parts.push_back(trim(comment.substr(start)));
  return parts;
}

}  // namespace edsc

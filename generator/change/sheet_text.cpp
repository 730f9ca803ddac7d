#include "change/sheet_text.hpp"

#include <optional>

#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

bool is_comment_line(std::string_view line) {
  const std::string_view content = trim(line);
  return content.starts_with(';') || content.starts_with('#');
}

/// Removes the first line, with its LF, CR LF or CR, from a text that is not empty.
std::string_view take_line(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t cr = line.find('\r');
  const bool has_cr_only = cr != std::string_view::npos && (cr + 1 < line.size() || line.size() == text.size());
  line = text.substr(0, has_cr_only ? cr + 1 : line.size() + 1);
  text.remove_prefix(line.size());
  return line;
}

}  // namespace

SheetText::SheetText(const SourceFile& source) : source_(source) {
  std::string_view rest = source.text();
  for (std::uint32_t line = 1; !rest.empty(); ++line) {
    const std::string_view text = take_line(rest);
    if (text.front() != '[' && !is_blank(text.front())) continue;
    const auto title = read_ini_header(text);
    if (!title) continue;
    if (!sections_.empty()) sections_.back().end = line;
    const SectionName name = read_section_name(*title, source.choices().sub_indices);
    const auto place = static_cast<std::uint32_t>(sections_.size());
    if (is_known(name.kind)) first_.try_emplace(identity(name), place);
    sections_.push_back({name, *title, line, source.lines() + 1});
  }
}

const TextSection* SheetText::find(std::string_view title, unsigned occurrence) const {
  const SectionName name = read_section_name(title, source_.choices().sub_indices);
  const bool is_of_standard = is_known(name.kind);
  std::size_t place = 0;
  if (is_of_standard) {
    const auto first = first_.find(identity(name));
    if (first == first_.end()) return nullptr;
    if (occurrence == 1) return &sections_[first->second];
    place = first->second;
  }
  for (; place < sections_.size(); ++place) {
    const TextSection& section = sections_[place];
    const bool is_same = is_of_standard ? is_known(section.name.kind) && identity(section.name) == identity(name)
                                        : equal_ignoring_case(section.title, title);
    if (is_same && --occurrence == 0) return &section;
  }
  return nullptr;
}

const TextSection* SheetText::find(const SectionName& name) const {
  const auto first = first_.find(identity(name));
  return first == first_.end() ? nullptr : &sections_[first->second];
}

std::vector<IniEntry> SheetText::entries(const TextSection& section) const {
  std::vector<IniEntry> entries;
  for (std::uint32_t line = section.line + 1; line < section.end; ++line) {
    if (const auto entry = read_ini_entry(source_.line(line), line)) entries.push_back(*entry);
  }
  return entries;
}

std::optional<IniEntry> SheetText::find_entry(const TextSection& section, std::string_view key,
                                              unsigned occurrence) const {
  for (std::uint32_t line = section.line + 1; line < section.end; ++line) {
    const std::string_view text = source_.line(line);
    if (text.empty() || (!is_blank(text.front()) && !key.empty() && to_lower(text.front()) != to_lower(key.front()))) {
      continue;
    }
    const auto entry = read_ini_entry(text, line);
    if (entry && equal_ignoring_case(entry->key, key) && --occurrence == 0) return entry;
  }
  return std::nullopt;
}

std::uint32_t SheetText::last_line(const TextSection& section) const {
  std::uint32_t last = section.line;
  for (std::uint32_t line = section.end - 1; line > section.line; --line) {
    if (!is_blank_line(line) && !is_comment_line(source_.line(line))) {
      last = line;
      break;
    }
  }
  std::uint32_t comment = last;
  while (comment + 1 < section.end && is_comment_line(source_.line(comment + 1))) ++comment;
  const bool is_of_next = comment + 1 == section.end && section.end <= source_.lines();
  return is_of_next ? last : comment;
}

std::uint32_t SheetText::first_line(const TextSection& section) const {
  std::uint32_t first = section.line;
  while (first > 1 && is_comment_line(source_.line(first - 1))) --first;
  return first;
}

bool SheetText::is_blank_line(std::uint32_t line) const { return trim(source_.line(line)).empty(); }

CountedName read_counted_name(std::string_view text) {
  const std::size_t mark = text.rfind('#');
  if (mark == std::string_view::npos || mark == 0) return {text};
  const auto number = parse_decimal(text.substr(mark + 1));
  if (!number || *number == 0 || *number > 1000) return {text};
  return {trim_right(text.substr(0, mark)), static_cast<unsigned>(*number)};
}

}  // namespace edsc

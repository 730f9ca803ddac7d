#include "change/sheet_text.hpp"

#include <algorithm>
#include <optional>

#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

bool is_comment_line(std::string_view line) {
  const std::string_view content = trim(line);
  return content.starts_with(';') || content.starts_with('#');
}

}  // namespace

SheetText::SheetText(const SourceFile& source) : source_(source) {
  for (std::uint32_t line = 1; line <= source.lines(); ++line) {
    const char first = source.first_character(line);
    if (first != '[' && !is_blank(first)) continue;
    const auto title = read_ini_header(source.line(line));
    if (!title) continue;
    if (!sections_.empty()) sections_.back().end = line;
    const SectionName name = read_section_name(*title, source.choices().sub_indices);
    const auto place = static_cast<std::uint32_t>(sections_.size());
    if (is_known(name.kind)) places_.emplace_back(identity(name), place);
    sections_.push_back({name, *title, line, source.lines() + 1});
  }
  std::ranges::sort(places_);
}

const TextSection* SheetText::find(std::string_view title, unsigned occurrence) const {
  const SectionName name = read_section_name(title, source_.choices().sub_indices);
  const bool is_of_standard = is_known(name.kind);
  std::size_t place = 0;
  if (is_of_standard) {
    const TextSection* const first = find(name);
    if (first == nullptr || occurrence == 1) return first;
    place = static_cast<std::size_t>(first - sections_.data());
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
  const std::uint64_t wanted = identity(name);
  const auto first = std::ranges::lower_bound(places_, wanted, {}, &IdentityPlace::first);
  return first == places_.end() || first->first != wanted ? nullptr : &sections_[first->second];
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
    const char first = source_.first_character(line);
    if (!is_blank(first) && !key.empty() && to_lower(first) != to_lower(key.front())) continue;
    const auto entry = read_ini_entry(source_.line(line), line);
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

std::string ListRows::count_key() const {
  return std::string{stated ? stated->key : section_keys::supported_objects.name};
}

ListRows list_rows(const SheetText& text, const TextSection& list) {
  const CountKey& usual = section_keys::supported_objects;
  ListRows rows;
  for (const IniEntry& entry : text.entries(list)) {
    if (const auto number = parse_unsigned(entry.key)) {
      rows.last_number = std::max(rows.last_number, *number);
      ++rows.count;
      continue;
    }
    const auto names = {usual.name, usual.misspelling, section_keys::nr_of_list_entries.name,
                        section_keys::object_link_count.name};
    const bool states_count =
        std::ranges::any_of(names, [&](std::string_view key) { return equal_ignoring_case(entry.key, key); });
    if (states_count && !rows.stated) rows.stated = entry;
  }
  return rows;
}

CountedName read_counted_name(std::string_view text) {
  const std::size_t mark = text.rfind('#');
  if (mark == std::string_view::npos || mark == 0) return {text};
  const auto number = parse_decimal(text.substr(mark + 1));
  if (!number || *number == 0 || *number > 1000) return {text};
  return {trim_right(text.substr(0, mark)), static_cast<unsigned>(*number)};
}

}  // namespace edsc

#include "change/sheet_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "eds/number.hpp"
#include "eds/sections/object_lists.hpp"
#include "eds/sections/section_keys.hpp"
#include "format/section_order.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

constexpr SectionKind list_kinds[] = {SectionKind::mandatory_objects, SectionKind::optional_objects,
                                      SectionKind::manufacturer_objects};

/// Sub-index 0 of a mapping parameter is the number of mapped objects.
constexpr bool is_mapping_parameter(std::uint16_t index) {
  return (index >= 0x1600 && index <= 0x17FF) || (index >= 0x1A00 && index <= 0x1BFF);
}

/// The place among the sections of the file. A new object belongs to the list that the standard states.
SectionPlace place_in_order(const SectionName& name) {
  return place_of_section(name, is_object_section(name.kind) ? list_of(name.index) : std::nullopt);
}

std::string_view without_comment(std::string_view value) {
  const std::string_view text = strip_inline_comment(value);
  const Formula formula = split_formula(text);
  const bool is_formula = formula.variable.starts_with('$');
  return is_formula || parse_unsigned(text) ? text : value;
}

std::optional<std::uint64_t> number_in(const IniEntry& entry) {
  return parse_unsigned(strip_inline_comment(entry.value));
}

bool is_count_key(std::string_view key) {
  return equal_ignoring_case(key, supported_objects.name) || equal_ignoring_case(key, supported_objects.misspelling);
}

}  // namespace

std::string spelled_like(std::uint64_t number, std::string_view like) {
  like = trim(strip_inline_comment(like));
  if (!is_hexadecimal(like)) return fmt::format("{}", number);
  const bool is_lower_case = std::ranges::any_of(like.substr(2), is_lower);
  const std::string digits =
      is_lower_case ? fmt::format("{:0{}x}", number, like.size() - 2) : fmt::format("{:0{}X}", number, like.size() - 2);
  return std::string{like.substr(0, 2)} + digits;
}

void SheetEdit::set_value(const IniEntry& entry, std::string_view value, const ValueOrigin& origin, bool with_comment) {
  replace_value(entry, value, with_comment);
  LineOrigin& place = lines_[entry.line].replacement->origin;
  place = {origin.file, origin.line, entry.value_column, origin.key_column, origin.value_column};
  touched_.insert(entry.line);
}

/// The line of the base with another value, and the origin of the base.
void SheetEdit::replace_value(const IniEntry& entry, std::string_view value, bool with_comment) {
  const std::string_view line = text_.source().line(entry.line);
  const std::size_t start = entry.value_column - 1;
  NewLine changed;
  changed.text = line.substr(0, start);
  changed.text += value;
  changed.text += line.substr(start + (with_comment ? entry.value : without_comment(entry.value)).size());
  changed.origin = text_.source().origin(entry.line);
  lines_[entry.line].replacement = std::move(changed);
}

/// The value remains, and its origin.
void SheetEdit::replace_key(const IniEntry& entry, std::string_view key) {
  const std::string_view line = text_.source().line(entry.line);
  NewLine changed;
  changed.text = line.substr(0, entry.key_column - 1);
  changed.text += key;
  changed.text += line.substr(entry.key_column - 1 + entry.key.size());
  changed.origin = text_.source().origin(entry.line);
  if (changed.origin.value_column == 0) {
    changed.origin.origin_key_column = entry.key_column;
    changed.origin.origin_value_column = entry.value_column;
  }
  changed.origin.value_column = static_cast<std::uint32_t>(entry.value_column + key.size() - entry.key.size());
  lines_[entry.line].replacement = std::move(changed);
}

void SheetEdit::add_comments(std::uint32_t line, std::vector<NewLine> comments) {
  if (!comments.empty()) std::ranges::move(comments, std::back_inserter(lines_[line].before));
}

void SheetEdit::add_lines_at_start(std::vector<NewLine> lines) {
  if (!lines.empty()) lines_[1].before = std::move(lines);
}

void SheetEdit::remove_entry(const IniEntry& entry) {
  lines_[entry.line].is_removed = true;
  touched_.insert(entry.line);
}

void SheetEdit::rename_entry(const IniEntry& entry, std::string_view key) {
  replace_key(entry, key);
  touched_.insert(entry.line);
}

void SheetEdit::add_entry(const TextSection& section, std::string_view key, std::vector<NewLine> lines) {
  added_entries_.push_back({&section, std::string{key}, std::move(lines)});
}

std::size_t SheetEdit::place_of(const TextSection& section) const {
  return static_cast<std::size_t>(&section - text_.sections().data());
}

void SheetEdit::remove_section(const TextSection& section) {
  removed_.insert(place_of(section));
  if (section.name.kind != SectionKind::object || text_.find(section.name) != &section) return;
  for (const TextSection& other : text_.sections()) {
    if (is_object_section(other.name.kind) && other.name.index == section.name.index) removed_.insert(place_of(other));
  }
}

void SheetEdit::rename_section(const TextSection& section, std::string_view name, const LineOrigin& origin) {
  const SectionName after = read_section_name(name);
  const auto rename = [&](const TextSection& one, const SectionName& to, std::string_view title) {
    renamed_[place_of(one)] = to;
    const std::string_view line = text_.source().line(one.line);
    const auto start = static_cast<std::size_t>(one.title.data() - line.data());
    NewLine changed;
    changed.text = line.substr(0, start);
    changed.text += title;
    changed.text += line.substr(start + one.title.size());
    changed.origin = origin;
    changed.origin.value_column = static_cast<std::uint32_t>(start) + 1;
    lines_[one.line].replacement = std::move(changed);
  };
  rename(section, after, name);
  if (section.name.kind != SectionKind::object || after.kind != SectionKind::object) return;
  for (const TextSection& other : text_.sections()) {
    if (&other == &section || !is_object_section(other.name.kind) || other.name.index != section.name.index) continue;
    SectionName moved = other.name;
    moved.index = after.index;
    const bool keeps_rest = parse_hex(other.title.substr(0, 4), 4) == other.name.index && name.size() == 4;
    rename(other, moved,
           keeps_rest ? std::string{name} + std::string{other.title.substr(4)} : spell_section_name(moved));
  }
}

void SheetEdit::add_section(const SectionName& name, std::vector<NewLine> lines) {
  added_sections_.push_back({name, std::move(lines)});
}

SectionName SheetEdit::name_after(const TextSection& section) const {
  const auto renamed = renamed_.find(place_of(section));
  return renamed == renamed_.end() ? section.name : renamed->second;
}

std::vector<std::string> SheetEdit::duplicate_sections() const {
  std::set<std::uint64_t> seen;
  std::vector<std::string> duplicates;
  const auto see = [&](const SectionName& name) {
    if (!is_known(name.kind)) return;
    const TextSection* const same = text_.find(name);
    const bool stays = same != nullptr && !is_removed(*same) && !renamed_.contains(place_of(*same));
    if (!seen.insert(identity(name)).second || stays) duplicates.push_back(spell_section_name(name));
  };
  for (const auto& [place, name] : renamed_) {
    if (!removed_.contains(place)) see(name);
  }
  for (const AddedSection& added : added_sections_) see(added.name);
  return duplicates;
}

std::set<std::uint16_t> SheetEdit::changed_objects() const {
  std::set<std::uint16_t> changed;
  const auto add = [&](const SectionName& name) {
    if (is_object_section(name.kind)) changed.insert(name.index);
  };
  for (const std::size_t place : removed_) add(text_.sections()[place].name);
  for (const auto& [place, name] : renamed_) {
    add(text_.sections()[place].name);
    add(name);
  }
  for (const AddedSection& added : added_sections_) add(added.name);
  return changed;
}

void SheetEdit::add_section_of(const SectionName& name, const std::set<std::uint16_t>& changed, Objects& objects) {
  const bool is_object = name.kind == SectionKind::object;
  if ((!is_object && name.kind != SectionKind::sub_object) || !changed.contains(name.index)) return;
  ObjectSections& sections = objects[name.index];
  if (is_object) {
    sections.has_section = true;
  } else {
    sections.sub_indices.insert(name.sub_index);
  }
}

SheetEdit::Objects SheetEdit::objects_before(const std::set<std::uint16_t>& changed) const {
  Objects objects;
  for (const TextSection& section : text_.sections()) add_section_of(section.name, changed, objects);
  return objects;
}

SheetEdit::Objects SheetEdit::objects_after(const std::set<std::uint16_t>& changed) const {
  Objects objects;
  for (const TextSection& section : text_.sections()) {
    if (!is_removed(section)) add_section_of(name_after(section), changed, objects);
  }
  for (const AddedSection& added : added_sections_) add_section_of(added.name, changed, objects);
  return objects;
}

bool SheetEdit::is_list_touched(const TextSection& list) const {
  const auto touched = touched_.lower_bound(list.line);
  return (touched != touched_.end() && *touched < list.end) || is_removed(list) ||
         std::ranges::any_of(added_entries_, [&](const AddedEntry& one) { return one.section == &list; });
}

void SheetEdit::renew_lists(const Objects& before, const Objects& after) {
  std::set<std::uint16_t> removed;
  std::map<SectionKind, std::set<std::uint16_t>> added;
  for (const auto& [index, sections] : before) {
    const auto same = after.find(index);
    if (sections.has_section && (same == after.end() || !same->second.has_section)) removed.insert(index);
  }
  for (const auto& [index, sections] : after) {
    const auto same = before.find(index);
    const auto list = list_of(index);
    if (!list || !sections.has_section || (same != before.end() && same->second.has_section)) continue;
    added[section_of(*list)].insert(index);
  }
  for (const SectionKind kind : list_kinds) renew_list(kind, removed, added[kind]);
}

void SheetEdit::renew_list(SectionKind list, const std::set<std::uint16_t>& removed,
                           const std::set<std::uint16_t>& added) {
  const TextSection* const section = text_.find(SectionName{.kind = list});
  const bool is_added = std::ranges::any_of(added_sections_, [&](const auto& one) { return one.name.kind == list; });
  if (section == nullptr) {
    if (!added.empty() && !is_added) add_list(list, added);
    return;
  }
  if (is_list_touched(*section)) return;

  struct Row {
    IniEntry entry;
    std::uint64_t number = 0;
    std::uint64_t index = 0;
  };
  std::vector<Row> rows;
  std::optional<IniEntry> count;
  for (const IniEntry& entry : text_.entries(*section)) {
    if (is_count_key(entry.key)) {
      if (!count) count = entry;
      continue;
    }
    const auto number = parse_unsigned(entry.key);
    if (number) rows.push_back({entry, *number, number_in(entry).value_or(0)});
  }
  bool is_numbered = true;
  for (std::size_t i = 0; i < rows.size(); ++i) is_numbered = is_numbered && rows[i].number == i + 1;
  const bool is_sorted = !appends_to_lists_ && is_numbered && std::ranges::is_sorted(rows, {}, &Row::index);

  std::set<std::uint16_t> missing = added;
  for (const Row& row : rows) missing.erase(static_cast<std::uint16_t>(row.index));
  const auto gone = std::ranges::count_if(
      rows, [&](const Row& row) { return removed.contains(static_cast<std::uint16_t>(row.index)); });
  if (missing.empty() && gone == 0) return;
  const std::size_t added_count = missing.size();

  const std::string_view like = rows.empty() ? "0x0000" : rows.back().entry.value;
  std::uint64_t number = 1;
  std::uint64_t last_number = 0;
  const std::uint32_t behind_last = (rows.empty() ? (count ? count->line : section->line) : rows.back().entry.line) + 1;
  const auto insert = [&](std::uint16_t index, std::uint32_t before) {
    const std::uint64_t key = is_numbered ? number++ : ++last_number;
    NewLine line{fmt::format("{}={}", key, spelled_like(index, is_hexadecimal(like) ? like : "0x0000")), {}};
    line.origin = text_.source().origin(count ? count->line : section->line);
    line.origin.value_column = static_cast<std::uint32_t>(line.text.size());
    lines_[before].before.push_back(std::move(line));
  };
  for (const Row& row : rows) last_number = std::max(last_number, row.number);
  for (const Row& row : rows) {
    while (is_sorted && !missing.empty() && *missing.begin() < row.index) {
      insert(*missing.begin(), row.entry.line);
      missing.erase(missing.begin());
    }
    if (removed.contains(static_cast<std::uint16_t>(row.index))) {
      lines_[row.entry.line].is_removed = true;
      continue;
    }
    if (is_numbered && row.number != number) replace_key(row.entry, fmt::format("{}", number));
    ++number;
  }
  for (const std::uint16_t index : missing) insert(index, behind_last);
  if (!count) return;
  if (const auto old = number_in(*count)) {
    const std::uint64_t now = *old + added_count - std::min<std::uint64_t>(*old, static_cast<std::uint64_t>(gone));
    replace_value(*count, spelled_like(now, count->value));
  }
}

void SheetEdit::add_list(SectionKind list, const std::set<std::uint16_t>& objects) {
  const std::string_view title = section_title(list);
  std::vector<std::string> texts{fmt::format("[{}]", title),
                                 fmt::format("{}={}", supported_objects.name, objects.size())};
  for (const std::uint16_t index : objects) texts.push_back(fmt::format("{}=0x{:04X}", texts.size() - 1, index));
  AddedSection added{{.kind = list}, {}};
  for (std::string& text : texts) {
    added.lines.push_back({std::move(text), text_.source().origin(1)});
    added.lines.back().origin.value_column = 1;
  }
  added_sections_.push_back(std::move(added));
}

void SheetEdit::renew_sub_indices(const Objects& before, const Objects& after) {
  for (const auto& [index, old] : before) {
    const auto now = after.find(index);
    if (now == after.end() || now->second.sub_indices == old.sub_indices) continue;
    const TextSection* const section = text_.find(SectionName{.kind = SectionKind::object, .index = index});
    if (section == nullptr) continue;
    const std::set<std::uint8_t>& subs = now->second.sub_indices;
    if (const auto count = text_.find_entry(*section, "SubNumber"); count && !is_touched(*count)) {
      if (const auto number = number_in(*count); number && *number + subs.size() >= old.sub_indices.size()) {
        const std::uint64_t changed = *number + subs.size() - old.sub_indices.size();
        if (changed != *number) replace_value(*count, spelled_like(changed, count->value));
      }
    }
    const TextSection* const first = text_.find(SectionName{.kind = SectionKind::sub_object, .index = index});
    if (first == nullptr || is_removed(*first) || subs.empty() || old.sub_indices.empty()) continue;
    const auto highest = text_.find_entry(*first, "DefaultValue");
    if (!highest || is_touched(*highest) || is_mapping_parameter(index)) continue;
    if (number_in(*highest) == *old.sub_indices.rbegin() && *subs.rbegin() != *old.sub_indices.rbegin()) {
      replace_value(*highest, spelled_like(*subs.rbegin(), highest->value));
    }
  }
}

void SheetEdit::remove_lines(const TextSection& section) {
  const std::uint32_t lines = text_.source().lines();
  std::uint32_t end = text_.last_line(section) + 1;
  while (end <= lines && end < section.end && text_.is_blank_line(end)) ++end;
  for (std::uint32_t line = text_.first_line(section); line < end; ++line) lines_[line].is_removed = true;
  has_removed_lines_ = true;
}

bool SheetEdit::separates_by_blank_line() const {
  const std::vector<TextSection>& sections = text_.sections();
  std::size_t blank = 0;
  const std::size_t compared = std::min<std::size_t>(sections.size(), 16);
  for (std::size_t i = 1; i < compared; ++i) {
    const std::uint32_t first = text_.first_line(sections[i]);
    if (first > 1 && text_.is_blank_line(first - 1)) ++blank;
  }
  return 2 * blank + 1 >= compared;
}

void SheetEdit::insert_sections() {
  if (added_sections_.empty()) return;
  std::ranges::stable_sort(added_sections_, {}, [](const AddedSection& one) { return place_in_order(one.name); });
  const bool has_blank_lines = separates_by_blank_line();
  std::vector<std::pair<SectionPlace, const TextSection*>> kept;
  for (const TextSection& section : text_.sections()) {
    if (!is_removed(section)) kept.emplace_back(place_in_order(name_after(section)), &section);
  }
  const std::uint32_t lines = text_.source().lines();
  for (AddedSection& added : added_sections_) {
    const SectionPlace place = place_in_order(added.name);
    const std::pair<SectionPlace, const TextSection*>* previous = nullptr;  // the last one of the highest place
    for (const auto& one : kept) {
      if (one.first <= place && (previous == nullptr || previous->first <= one.first)) previous = &one;
    }
    const NewLine blank{"", {.file = added.lines.front().origin.file, .line = added.lines.front().origin.line}};
    if (previous == nullptr) {
      const std::uint32_t at = kept.empty() ? lines + 1 : text_.first_line(*kept.front().second);
      std::vector<NewLine>& before = lines_[at].before;
      std::ranges::move(added.lines, std::back_inserter(before));
      if (has_blank_lines && !kept.empty()) before.push_back(blank);
      continue;
    }
    const std::uint32_t last = text_.last_line(*previous->second);
    std::vector<NewLine>& before = lines_[last + 1].before;
    if (has_blank_lines) before.push_back(blank);
    std::ranges::move(added.lines, std::back_inserter(before));
  }
}

void SheetEdit::insert_entries() {
  std::ranges::stable_sort(added_entries_, {}, [&](const AddedEntry& one) {
    return std::tuple{one.section->line, spell_key(one.section->name, one.key).order};
  });
  for (AddedEntry& added : added_entries_) {
    const std::uint64_t order = spell_key(added.section->name, added.key).order;
    std::uint32_t last = added.section->line;
    for (const IniEntry& entry : text_.entries(*added.section)) {
      if (spell_key(added.section->name, entry.key).order <= order) last = entry.line;
    }
    std::ranges::move(added.lines, std::back_inserter(lines_[last + 1].before));
  }
}

/// A file that does not end with a blank line does not get one because its last section is removed.
void SheetEdit::trim_end() {
  const std::uint32_t lines = text_.source().lines();
  if (!has_removed_lines_ || lines == 0 || text_.is_blank_line(lines)) return;
  for (std::uint32_t line = lines; line > 0; --line) {
    LineEdit* const edit = lines_.contains(line) ? &lines_[line] : nullptr;
    if (edit != nullptr && !edit->before.empty()) return;
    if (edit != nullptr && edit->is_removed) continue;
    if (!text_.is_blank_line(line)) return;
    lines_[line].is_removed = true;
  }
}

std::vector<TextEdit> SheetEdit::finish() {
  if (!removed_.empty() || !renamed_.empty() || !added_sections_.empty()) {
    const std::set<std::uint16_t> changed = changed_objects();
    const Objects before = objects_before(changed);
    const Objects after = objects_after(changed);
    renew_lists(before, after);
    renew_sub_indices(before, after);
  }
  for (const std::size_t place : removed_) remove_lines(text_.sections()[place]);
  insert_entries();
  insert_sections();
  trim_end();

  std::vector<TextEdit> edits;
  for (auto& [line, edit] : lines_) {
    if (!edit.before.empty()) edits.push_back({line, 0, std::move(edit.before)});
    if (edit.is_removed) {
      edits.push_back({line, 1, {}});
    } else if (edit.replacement) {
      edits.push_back({line, 1, {*std::move(edit.replacement)}});
    }
  }
  return edits;
}

}  // namespace edsc

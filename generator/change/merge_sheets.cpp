#include "change/merge_sheets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "change/sheet_edit.hpp"
#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

using MergeLines = std::vector<std::string>;

std::string folded(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(), to_lower);
  return result;
}

constexpr bool is_in_span(std::uint16_t index, std::uint16_t first, std::uint16_t last) {
  return index >= first && index <= last;
}

/// A section with the comment above it, up to the comment above the next one.
struct SectionBlock {
  const TextSection* section = nullptr;
  std::uint32_t first = 0, end = 0;
};

/// The comments before a key, before the header of a section, or after its last key.
struct CommentPlace {
  std::uint32_t first = 0, count = 0;  ///< lines from the first comment to the last one
  std::uint32_t before = 0;            ///< the line that follows
  MergeLines lines;                    ///< without blank lines
};
constexpr const char* before_header = "[";
constexpr const char* after_last_key = "]";

/// A version of the file: its sections by their names.
class MergeVersion {
 public:
  explicit MergeVersion(const SourceFile& source) : text_(source) {
    const std::vector<TextSection>& sections = text_.sections();
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const std::uint32_t end = i + 1 < sections.size() ? text_.first_line(sections[i + 1]) : sections[i].end;
      const SectionBlock block{&sections[i], text_.first_line(sections[i]), end};
      if (blocks_.try_emplace(name_of(sections[i]), block).second) order_.push_back(name_of(sections[i]));
    }
  }

  static std::string name_of(const TextSection& section) {
    const std::string spelled = spell_section_name(section.name);
    return folded(spelled.empty() ? section.title : std::string_view{spelled});
  }

  [[nodiscard]] const SheetText& text() const { return text_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return order_; }
  [[nodiscard]] const SectionBlock* find(const std::string& name) const {
    const auto found = blocks_.find(name);
    return found == blocks_.end() ? nullptr : &found->second;
  }

  /// The lines of a block, without blank lines at its end.
  [[nodiscard]] MergeLines lines(const SectionBlock& block) const {
    MergeLines lines;
    for (std::uint32_t line = block.first; line < block.end; ++line) lines.emplace_back(text_.source().line(line));
    while (!lines.empty() && trim(lines.back()).empty()) lines.pop_back();
    return lines;
  }

  /// The comments of a block by the key that they are before.
  [[nodiscard]] std::map<std::string, CommentPlace> comments(const SectionBlock& block) const {
    std::map<std::uint32_t, std::string> keys{{block.section->line, before_header}};
    for (const IniEntry& entry : text_.entries(*block.section)) keys.try_emplace(entry.line, folded(entry.key));
    std::map<std::string, CommentPlace> comments;
    CommentPlace place;
    std::uint32_t last_key = block.section->line;
    for (std::uint32_t line = block.first; line < block.end; ++line) {
      if (const auto key = keys.find(line); key != keys.end()) {
        place.before = last_key = line;
        comments.try_emplace(key->second, std::move(place));
        place = {};
      } else if (const std::string_view text = text_.source().line(line); !trim(text).empty()) {
        if (place.lines.empty()) place.first = line;
        place.count = line - place.first + 1;
        place.lines.emplace_back(text);
      }
    }
    place.before = last_key + 1;
    comments.try_emplace(after_last_key, std::move(place));
    return comments;
  }

  /// The sub-indices of an object that have a section.
  [[nodiscard]] std::set<std::uint8_t> sub_indices(std::uint16_t index) const {
    std::set<std::uint8_t> found;
    for (const TextSection& one : text_.sections()) {
      if (one.name.kind == SectionKind::sub_object && one.name.index == index) found.insert(one.name.sub_index);
    }
    return found;
  }

  [[nodiscard]] std::size_t objects_in(std::uint16_t first, std::uint16_t last) const {
    std::set<std::uint16_t> found;
    for (const TextSection& one : text_.sections()) {
      if (one.name.kind == SectionKind::object && is_in_span(one.name.index, first, last)) found.insert(one.name.index);
    }
    return found.size();
  }

 private:
  SheetText text_;
  std::map<std::string, SectionBlock> blocks_;
  std::vector<std::string> order_;
};

constexpr std::string_view our_marker = "<<<<<<< ours";
constexpr std::string_view between_marker = "=======";
constexpr std::string_view their_marker = ">>>>>>> theirs";

/// Both versions between markers; null lines are removed ones.
void append_conflict(MergeLines& out, const MergeLines& ours, const MergeLines& theirs) {
  out.emplace_back(our_marker);
  out.insert(out.end(), ours.begin(), ours.end());
  out.emplace_back(between_marker);
  out.insert(out.end(), theirs.begin(), theirs.end());
  out.emplace_back(their_marker);
}

class SheetMerge {
 public:
  SheetMerge(const SourceFile& base, const SourceFile& ours, const SourceFile& theirs)
      : base_(base), ours_(ours), theirs_(theirs), edit_(ours_.text()) {
    edit_.append_to_lists();
  }

  MergedSheet merge() {
    for (const std::string& name : base_.names()) merge_known(name);
    for (const std::string& name : theirs_.names()) {
      if (base_.find(name) == nullptr) merge_added(name);
    }
    count_pdos();
    const std::vector<TextEdit> edits = edit_.finish();
    const SourceFile& source = ours_.text().source();
    merged_.text = edited_bytes(source.text(), Encoding::utf8, edits, true).bytes;
    merge_comments();
    for (const auto& [name, conflict] : conflicts_) insert_conflict(name, conflict);
    return std::move(merged_);
  }

 private:
  /// A section that gets markers in the text with all other changes.
  struct SectionConflict {
    std::string title;
    std::map<std::string, std::pair<MergeLines, MergeLines>> keys;  ///< ours and theirs
    MergeLines their_section;                                       ///< of a section that one version removes
    bool is_removed_by_us = false;
    bool is_whole = false;
  };

  [[nodiscard]] static bool is_list(const TextSection& section) { return is_object_list(section.name.kind); }

  void merge_known(const std::string& name) {
    const SectionBlock& base = *base_.find(name);
    const SectionBlock* const ours = ours_.find(name);
    const SectionBlock* const theirs = theirs_.find(name);
    if (is_list(*base.section)) return;  // follows from the objects
    const MergeLines base_lines = base_.lines(base);
    if (theirs == nullptr) {
      if (ours == nullptr) return;
      if (ours_.lines(*ours) != base_lines && !changes_only_counts(*base.section, *ours->section)) {
        return conflict_of_section(name, *ours->section, {}, false);
      }
      edit_.remove_section(*ours->section);
      return;
    }
    const MergeLines their_lines = theirs_.lines(*theirs);
    if (their_lines == base_lines) return;
    if (ours == nullptr) {
      if (object_is_removed(*base.section) && changes_only_counts(*base.section, *theirs->section, &theirs_)) return;
      return conflict_of_section(name, *base.section, their_lines, true);
    }
    merge_keys(name, *base.section, *ours->section, *theirs->section);
  }

  [[nodiscard]] bool object_is_removed(const TextSection& section) const {
    return is_object_section(section.name.kind) &&
           ours_.text().find(SectionName{.kind = SectionKind::object, .index = section.name.index}) == nullptr;
  }

  /// Whether a version changes only what follows from other sections.
  [[nodiscard]] bool changes_only_counts(const TextSection& base, const TextSection& other,
                                         const MergeVersion* version = nullptr) const {
    const MergeVersion& changed = version == nullptr ? ours_ : *version;
    const auto old_keys = keys_of(base_, base);
    const auto new_keys = keys_of(changed, other);
    if (old_keys.size() != new_keys.size()) return false;
    return std::ranges::all_of(old_keys, [&](const auto& one) {
      const auto same = new_keys.find(one.first);
      return same != new_keys.end() && (same->second.value == one.second.value || is_derived(base, one.first, changed));
    });
  }

  static std::map<std::string, IniEntry> keys_of(const MergeVersion& version, const TextSection& section) {
    std::map<std::string, IniEntry> keys;
    for (const IniEntry& entry : version.text().entries(section)) keys.try_emplace(folded(entry.key), entry);
    return keys;
  }

  /// Whether a key follows from sections that a version adds or removes.
  [[nodiscard]] bool is_derived(const TextSection& section, const std::string& key, const MergeVersion& version) const {
    const SectionName& name = section.name;
    if (name.kind == SectionKind::device_info) {
      return (key == "nrofrxpdo" && changes_objects(0x1400, 0x15FF, version)) ||
             (key == "nroftxpdo" && changes_objects(0x1800, 0x19FF, version));
    }
    const bool is_mapping = is_in_span(name.index, 0x1600, 0x17FF) || is_in_span(name.index, 0x1A00, 0x1BFF);
    const bool is_count =
        (name.kind == SectionKind::object && key == "subnumber") ||
        (name.kind == SectionKind::sub_object && name.sub_index == 0 && key == "defaultvalue" && !is_mapping);
    return is_count && base_.sub_indices(name.index) != version.sub_indices(name.index);
  }

  [[nodiscard]] bool changes_objects(std::uint16_t first, std::uint16_t last, const MergeVersion& version) const {
    return base_.objects_in(first, last) != version.objects_in(first, last);
  }

  void merge_keys(const std::string& name, const TextSection& base, const TextSection& ours,
                  const TextSection& theirs) {
    const auto base_keys = keys_of(base_, base);
    const auto our_keys = keys_of(ours_, ours);
    const auto their_keys = keys_of(theirs_, theirs);
    std::set<std::string> keys;
    for (const auto* const part : {&base_keys, &their_keys}) {
      for (const auto& [key, entry] : *part) keys.insert(key);
    }
    const auto value_in = [](const auto& of, const std::string& key) -> std::optional<std::string_view> {
      const auto found = of.find(key);
      return found == of.end() ? std::nullopt : std::optional{found->second.value};
    };
    for (const std::string& key : keys) {
      const auto old_value = value_in(base_keys, key);
      const auto our_value = value_in(our_keys, key);
      const auto their_value = value_in(their_keys, key);
      if (their_value == old_value || our_value == their_value || is_derived(base, key, theirs_)) continue;
      if (our_value == old_value) {
        take_theirs(ours, our_keys, their_keys, key);
      } else {
        SectionConflict& conflict = conflicts_[name];
        conflict.title = ours.title;
        conflict.keys[key] = {line_of(ours_, our_keys, key), line_of(theirs_, their_keys, key)};
        if (!our_value) {  // the markers need a line of the key
          add_line(ours, their_keys.at(key));
        } else {
          edit_.keep_entry(our_keys.at(key));
        }
      }
    }
  }

  static MergeLines line_of(const MergeVersion& version, const std::map<std::string, IniEntry>& keys,
                            const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? MergeLines{}
                               : MergeLines{std::string{version.text().source().line(found->second.line)}};
  }

  void take_theirs(const TextSection& ours, const std::map<std::string, IniEntry>& our_keys,
                   const std::map<std::string, IniEntry>& their_keys, const std::string& key) {
    const auto our_entry = our_keys.find(key);
    const auto their_entry = their_keys.find(key);
    if (their_entry == their_keys.end()) {
      edit_.remove_entry(our_entry->second);
    } else if (our_entry == our_keys.end()) {
      add_line(ours, their_entry->second);
    } else {
      edit_.set_value(our_entry->second, their_entry->second.value,
                      {.file = &ours_.text().source(), .line = our_entry->second.line}, true);
    }
  }

  void add_line(const TextSection& ours, const IniEntry& theirs) {
    edit_.add_entry(
        ours, theirs.key,
        {{std::string{theirs_.text().source().line(theirs.line)}, ours_.text().source().origin(ours.line)}});
  }

  void merge_added(const std::string& name) {
    const SectionBlock& theirs = *theirs_.find(name);
    const SectionBlock* const ours = ours_.find(name);
    if (is_list(*theirs.section)) return;
    if (ours == nullptr) return add_section(*theirs.section, theirs_.lines(theirs));
    if (ours_.lines(*ours) == theirs_.lines(theirs)) return;
    const auto our_keys = keys_of(ours_, *ours->section);
    for (const auto& [key, entry] : keys_of(theirs_, *theirs.section)) {
      const auto same = our_keys.find(key);
      if (same == our_keys.end()) {
        add_line(*ours->section, entry);
      } else if (same->second.value != entry.value) {
        SectionConflict& conflict = conflicts_[name];
        conflict.title = ours->section->title;
        conflict.keys[key] = {{std::string{ours_.text().source().line(same->second.line)}},
                              {std::string{theirs_.text().source().line(entry.line)}}};
        edit_.keep_entry(same->second);
      }
    }
  }

  void add_section(const TextSection& section, const MergeLines& lines) {
    std::vector<NewLine> added;
    for (const std::string& line : lines) added.push_back({line, ours_.text().source().origin(1)});
    edit_.add_section(section.name, std::move(added));
  }

  void conflict_of_section(const std::string& name, const TextSection& section, const MergeLines& theirs,
                           bool is_removed_by_us) {
    SectionConflict& conflict = conflicts_[name];
    conflict.title = section.title;
    conflict.is_whole = true;
    conflict.is_removed_by_us = is_removed_by_us;
    conflict.their_section = theirs;
    if (is_removed_by_us) add_section(section, theirs);
  }

  void count_pdos() {
    const TextSection* const info = ours_.text().find(SectionName{.kind = SectionKind::device_info});
    if (info == nullptr) return;
    const auto follow = [&](std::string_view key, std::uint16_t first, std::uint16_t last) {
      const auto entry = ours_.text().find_entry(*info, key);
      const auto number = entry ? parse_unsigned(strip_inline_comment(entry->value)) : std::nullopt;
      if (!number || edit_.is_touched(*entry) || !changes_objects(first, last, theirs_)) return;
      std::size_t more = 0;
      std::size_t fewer = 0;
      for (unsigned index = first; index <= last; ++index) {
        const SectionName object{.kind = SectionKind::object, .index = static_cast<std::uint16_t>(index)};
        const bool was = base_.text().find(object) != nullptr;
        const bool is_theirs = theirs_.text().find(object) != nullptr;
        const bool is_ours = ours_.text().find(object) != nullptr;
        if (!was && is_theirs && !is_ours) ++more;
        if (was && !is_theirs && is_ours) ++fewer;
      }
      if (more == fewer || *number + more < fewer) return;
      edit_.set_value(*entry, spelled_like(*number + more - fewer, entry->value),
                      {.file = &ours_.text().source(), .line = entry->line});
    };
    follow("NrOfRXPDO", 0x1400, 0x15FF);
    follow("NrOfTXPDO", 0x1800, 0x19FF);
  }

  /// Takes the comments that they changed, in the text with all other changes.
  void merge_comments() {
    const SourceFile source("merged", merged_.text);
    const MergeVersion merged(source);
    std::vector<TextEdit> edits;
    for (const std::string& name : merged.names()) {
      const SectionBlock* const theirs = theirs_.find(name);
      const auto conflict = conflicts_.find(name);
      const bool is_whole = conflict != conflicts_.end() && conflict->second.is_whole;
      if (theirs == nullptr || is_whole) continue;
      const SectionBlock* const base = base_.find(name);
      const auto old_comments = base == nullptr ? std::map<std::string, CommentPlace>{} : base_.comments(*base);
      const auto our_comments = merged.comments(*merged.find(name));
      bool has_conflict = false;
      for (const auto& [key, new_comment] : theirs_.comments(*theirs)) {
        const auto ours = our_comments.find(key);
        const auto old = old_comments.find(key);
        const MergeLines old_lines = old == old_comments.end() ? MergeLines{} : old->second.lines;
        if (ours == our_comments.end() || new_comment.lines == old_lines || new_comment.lines == ours->second.lines)
          continue;
        MergeLines lines = new_comment.lines;
        if (ours->second.lines != old_lines) {
          lines.clear();
          append_conflict(lines, ours->second.lines, new_comment.lines);
          has_conflict = true;
        }
        const CommentPlace& place = ours->second;
        TextEdit edit{place.count == 0 ? place.before : place.first, place.count, {}};
        for (std::string& line : lines) edit.lines.push_back({std::move(line), {}});
        edits.push_back(std::move(edit));
      }
      if (has_conflict && conflict == conflicts_.end()) {
        merged_.conflicts.emplace_back(merged.find(name)->section->title);
      }
    }
    std::ranges::sort(edits, {}, &TextEdit::line);
    merged_.text = edited_bytes(source.text(), Encoding::utf8, edits, true).bytes;
  }

  void insert_conflict(const std::string& name, const SectionConflict& conflict) {
    const auto source = std::make_shared<const SourceFile>("merged", merged_.text);
    const MergeVersion merged(*source);
    const SectionBlock* const block = merged.find(name);
    if (block == nullptr) return;
    merged_.conflicts.push_back(conflict.title);
    MergeLines lines;
    if (conflict.is_whole) {
      const MergeLines text = merged.lines(*block);
      append_conflict(lines, conflict.is_removed_by_us ? MergeLines{} : text,
                      conflict.is_removed_by_us ? text : MergeLines{});
    } else {
      for (const std::string& line : merged.lines(*block)) {
        const auto entry = read_ini_entry(line, 1);
        const auto found = entry ? conflict.keys.find(folded(entry->key)) : conflict.keys.end();
        if (found == conflict.keys.end()) {
          lines.push_back(line);
        } else {
          append_conflict(lines, found->second.first, found->second.second);
        }
      }
    }
    TextEdit edit{block->first, static_cast<std::uint32_t>(merged.lines(*block).size()), {}};
    for (std::string& line : lines) edit.lines.push_back({std::move(line), {}});
    merged_.text = edited_bytes(source->text(), Encoding::utf8, {edit}, true).bytes;
  }

  MergeVersion base_, ours_, theirs_;
  SheetEdit edit_;
  std::map<std::string, SectionConflict> conflicts_;
  MergedSheet merged_;
};

}  // namespace

MergedSheet merge_sheets(const SourceFile& base, const SourceFile& ours, const SourceFile& theirs) {
  return SheetMerge(base, ours, theirs).merge();
}

}  // namespace edsc

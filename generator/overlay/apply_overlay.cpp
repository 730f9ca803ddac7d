#include "overlay/apply_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "change/sheet_edit.hpp"
#include "diagnostics/place.hpp"
#include "diagnostics/quote.hpp"
#include "eds/allow_comments.hpp"
#include "eds/number.hpp"
#include "overlay/overlay_keys.hpp"
#include "text/ascii.hpp"
#include "text/counted.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// A value in a message; a missing one has no text.
std::string shown_value(std::string_view value) { return value.empty() ? "no value" : quote(value); }

class OverlayApplier {
 public:
  OverlayApplier(const OverlayFile& overlay, const SheetText& base, Diagnostics& diagnostics)
      : overlay_(overlay), base_(base), edit_(base), diagnostics_(diagnostics) {}

  OverlayEdits apply() {
    if (!overlay_.ini.sections.empty()) edit_.add_lines_at_start(comments_above(overlay_.ini.sections.front().line));
    for (const OverlaySection& section : overlay_.sections) {
      if (section.range) {
        apply_range(section);
      } else {
        apply_section(section);
      }
    }
    for (const std::string& name : edit_.duplicate_sections()) {
      diagnostics_.error("overlay-file", {overlay_.source}, fmt::format("the result has section [{}] twice", name));
    }
    result_.edits = edit_.finish();
    return std::move(result_);
  }

 private:
  void note_state(std::uint32_t line, LineState state) { result_.outcomes.push_back({line, state}); }

  [[nodiscard]] Position position_of(const OverlaySection& section) const {
    return section_position(*overlay_.source, *section.section);
  }

  [[nodiscard]] ValueOrigin value_origin(const OverlayLine& line) const {
    return {overlay_.source, line.entry.line, line.entry.key_column, line.new_column};
  }

  static std::string with_reason(std::string message, const std::string& reason) {
    if (!reason.empty()) message += fmt::format("; reason of the change: {}", reason);
    return message;
  }

  /// The comments for edsc directly above a line of the overlay.
  [[nodiscard]] std::vector<NewLine> comments_above(std::uint32_t line) const {
    std::vector<NewLine> lines;
    std::uint32_t first = line;
    while (first > 1 && is_for_edsc(trim(overlay_.source->line(first - 1)))) --first;
    for (std::uint32_t number = first; number < line; ++number) {
      lines.push_back({std::string{overlay_.source->line(number)}, {.file = overlay_.source, .line = number}});
    }
    return lines;
  }

  /// A line of the overlay, or `text` in its place, with the comments for edsc directly above it.
  [[nodiscard]] std::vector<NewLine> added_lines(std::uint32_t line, std::optional<std::string> text = {}) const {
    std::vector<NewLine> lines = comments_above(line);
    lines.push_back(
        {text ? *std::move(text) : std::string{overlay_.source->line(line)}, {.file = overlay_.source, .line = line}});
    return lines;
  }

  // Sections.

  void apply_section(const OverlaySection& section) {
    const TextSection* const target = base_.find(section.name.name, section.name.occurrence);
    if (section.remove) return remove(section, target);
    if (section.rename) {
      if (target == nullptr) return without_effect(section, *section.rename);
      rename(section, *target);
    }
    if (target == nullptr) return add_section(section);
    for (const OverlayLine& line : section.lines) apply_line(section, *target, line);
  }

  void without_effect(const OverlaySection& section, const IniEntry& entry) {
    note_state(entry.line, LineState::obsolete);
    diagnostics_.error("overlay-effect", key_position(*overlay_.source, entry),
                       with_reason(fmt::format("{} has no effect: {} does not have section [{}]", entry.key,
                                               base_.source().base().name(), section.section->name),
                                   section.reason));
  }

  void remove(const OverlaySection& section, const TextSection* target) {
    if (!section.lines.empty() || section.rename) {
      diagnostics_.error("overlay-file", position_of(section), "a removed section cannot have other lines");
    }
    if (target == nullptr) return without_effect(section, *section.remove);
    edit_.remove_section(*target);
    note_state(section.remove->line, LineState::applied);
  }

  void rename(const OverlaySection& section, const TextSection& target) {
    const IniEntry& entry = *section.rename;
    const SectionName name = read_section_name(entry.value);
    const bool is_object = target.name.kind == SectionKind::object;
    const bool fits = is_object_section(name.kind) && name.kind != SectionKind::malformed &&
                      (!is_object || name.kind == SectionKind::object);
    if (!fits) {
      diagnostics_.error("overlay-file", value_position(*overlay_.source, entry),
                         fmt::format("{} is not a name for [{}]", quote(entry.value), target.title));
      return;
    }
    edit_.rename_section(target, entry.value,
                         {.file = overlay_.source,
                          .line = entry.line,
                          .origin_key_column = entry.key_column,
                          .origin_value_column = entry.value_column});
    note_state(entry.line, LineState::applied);
  }

  void add_section(const OverlaySection& section) {
    bool is_stale = false;
    for (const OverlayLine& line : section.lines) {
      if (!line.has_arrow || line.old_value.empty()) continue;
      is_stale = true;
      if (line.new_value.empty()) {
        obsolete(line, edsc::position_of(overlay_, line));
      } else {
        stale(line, fmt::format("{} does not have section [{}]", base_.source().base().name(), section.section->name),
              {});
      }
    }
    if (is_stale || section.lines.empty()) return;
    if (section.name.occurrence > 1) {
      diagnostics_.error("overlay-file", position_of(section), "a duplicate section cannot be added");
      return;
    }
    std::vector<NewLine> lines = added_lines(section.section->line, fmt::format("[{}]", section.name.name));
    LineOrigin& header = lines.back().origin;
    header.value_column = 2;
    header.origin_value_column = section.section->column;
    for (const OverlayLine& line : section.lines) {
      append_line(line, lines);
      note_state(line.entry.line, LineState::applied);
    }
    edit_.add_section(read_section_name(section.name.name), std::move(lines));
  }

  /// The line of a new key.
  void append_line(const OverlayLine& line, std::vector<NewLine>& lines) const {
    std::vector<NewLine> added = line.has_arrow
                                     ? added_lines(line.entry.line, fmt::format("{}={}", line.key.name, line.new_value))
                                     : added_lines(line.entry.line);
    if (line.has_arrow) {
      LineOrigin& origin = added.back().origin;
      origin.value_column = static_cast<std::uint32_t>(line.key.name.size()) + 2;
      origin.origin_key_column = line.entry.key_column;
      origin.origin_value_column = line.new_column;
    }
    std::ranges::move(added, std::back_inserter(lines));
  }

  // Lines.

  void stale(const OverlayLine& line, std::string message, std::vector<Note> notes) {
    note_state(line.entry.line, LineState::stale);
    diagnostics_.error("overlay-stale", edsc::position_of(overlay_, line), with_reason(std::move(message), line.reason),
                       std::move(notes));
  }

  void obsolete(const OverlayLine& line, const Position& place) {
    note_state(line.entry.line, LineState::obsolete);
    std::vector<Note> notes;
    if (place.file != overlay_.source) notes.push_back({place, "here"});
    diagnostics_.warning("overlay-obsolete", edsc::position_of(overlay_, line),
                         fmt::format("{} already has {} for {}; delete this line", base_.source().base().name(),
                                     shown_value(line.new_value), line.key.name),
                         std::move(notes));
  }

  [[nodiscard]] Position place_in_base(const IniEntry& entry) const {
    return origin_of(value_position(base_.source(), entry));
  }

  void apply_line(const OverlaySection& section, const TextSection& target, const OverlayLine& line) {
    const auto entry = base_.find_entry(target, line.key.name, line.key.occurrence);
    if (!entry) return apply_to_missing(section, target, line);
    const std::string_view value = entry->value;
    const Position place = place_in_base(*entry);
    if (edit_.is_touched(*entry)) {
      return diagnostics_.error(
          "overlay-file", edsc::position_of(overlay_, line),
          fmt::format("another line of the overlay changes {} of [{}]", line.key.name, section.section->name));
    }
    if (!line.has_arrow) {
      if (is_same_value(value, line.new_value)) return obsolete(line, place);
      note_state(line.entry.line, LineState::stale);
      return diagnostics_.error(
          "overlay-value", edsc::position_of(overlay_, line),
          with_reason(fmt::format("the base has {} for {}; write {}={}{}=> {}", shown_value(value), line.key.name,
                                  line.entry.key, value, value.empty() ? "" : " ", line.new_value),
                      line.reason),
          {{place, "the value of the base"}});
    }
    const bool is_any_value = line.key.occurrence > 1 && line.old_value.empty() && line.new_value.empty();
    if (!is_any_value && !is_same_value(value, line.old_value)) {
      if (!line.new_value.empty() && is_same_value(value, line.new_value)) return obsolete(line, place);
      return stale(line,
                   fmt::format("{} of [{}] has {} in the base, not {}", line.key.name, section.section->name,
                               shown_value(value), shown_value(line.old_value)),
                   {{place, "the value of the base"}});
    }
    note_state(line.entry.line, LineState::applied);
    if (line.new_value.empty()) {
      edit_.remove_entry(*entry);
    } else if (line.new_value == line.old_value) {
      edit_.keep_entry(*entry);
    } else if (line.new_value == value) {
      result_.outcomes.pop_back();
      obsolete(line, place);
    } else {
      edit_.set_value(*entry, line.new_value, value_origin(line), line.old_value == value);
      edit_.add_comments(entry->line, comments_above(line.entry.line));
    }
  }

  void apply_to_missing(const OverlaySection& section, const TextSection& target, const OverlayLine& line) {
    const Position place = section_position_in_base(target);
    if (line.has_arrow && line.new_value.empty()) return obsolete(line, place);
    if (line.has_arrow && !line.old_value.empty()) {
      return stale(line,
                   fmt::format("{} of [{}] is missing in the base; expected {}", line.key.name, section.section->name,
                               quote(line.old_value)),
                   {{place, "the section of the base"}});
    }
    if (line.key.occurrence > 1) {
      return diagnostics_.error("overlay-file", edsc::position_of(overlay_, line), "a duplicate key cannot be added");
    }
    if (!added_.insert(fmt::format("{} {}", target.line, lower(line.key.name))).second) {
      return diagnostics_.error(
          "overlay-file", edsc::position_of(overlay_, line),
          fmt::format("another line of the overlay adds {} to [{}]", line.key.name, section.section->name));
    }
    std::vector<NewLine> lines;
    append_line(line, lines);
    edit_.add_entry(target, line.key.name, std::move(lines));
    note_state(line.entry.line, LineState::applied);
  }

  static std::string lower(std::string_view text) {
    std::string result{text};
    std::ranges::transform(result, result.begin(), to_lower);
    return result;
  }

  [[nodiscard]] Position section_position_in_base(const TextSection& section) const {
    const std::string_view line = base_.source().line(section.line);
    return origin_of({&base_.source(), section.line, static_cast<std::uint32_t>(section.title.data() - line.data()) + 1,
                      static_cast<std::uint32_t>(std::max<std::size_t>(section.title.size(), 1))});
  }

  // Ranges.

  void apply_range(const OverlaySection& section) {
    std::size_t changed = 0;
    if (section.remove) changed += remove_range(section);
    for (const OverlayLine& line : section.lines) changed += apply_to_range(section, line);
    if (!section.count) return;
    const auto expected = parse_unsigned(strip_inline_comment(section.count->value));
    if (expected && *expected != changed) {
      diagnostics_.error("overlay-effect", value_position(*overlay_.source, *section.count),
                         with_reason(fmt::format("the range changes {}, not {}", counted(changed, "value"), *expected),
                                     section.reason));
    }
  }

  template <class Use>
  void for_each_in(const OverlaySection& section, Use use) {
    for (const TextSection& one : base_.sections()) {
      const SectionKind kind = one.name.kind;
      const bool is_entry = kind == SectionKind::object || kind == SectionKind::sub_object;
      if (is_entry && one.name.index >= section.range->first && one.name.index <= section.range->last) use(one);
    }
  }

  std::size_t remove_range(const OverlaySection& section) {
    std::size_t removed = 0;
    for_each_in(section, [&](const TextSection& one) {
      if (one.name.kind == SectionKind::object) ++removed;
      edit_.remove_section(one);
    });
    note_state(section.remove->line, removed > 0 ? LineState::applied : LineState::obsolete);
    if (removed == 0) {
      diagnostics_.error("overlay-effect", key_position(*overlay_.source, *section.remove),
                         with_reason("the range does not have an object", section.reason));
    }
    return removed;
  }

  std::size_t count_in(const OverlaySection& section, const CountedName& key, std::string_view value) {
    std::size_t count = 0;
    const OverlayValue compared{value};
    for_each_in(section, [&](const TextSection& one) {
      const auto entry = base_.find_entry(one, key.name, key.occurrence);
      if (entry && compared.is_same(entry->value)) ++count;
    });
    return count;
  }

  std::size_t apply_to_range(const OverlaySection& section, const OverlayLine& line) {
    if (!line.has_arrow || (line.old_value.empty() && line.new_value.empty())) {
      diagnostics_.error("overlay-file", edsc::position_of(overlay_, line),
                         fmt::format("a line of a range states both values: {}=OLD => NEW", line.key.name));
      return 0;
    }
    std::size_t changed = 0;
    const OverlayValue old_value{line.old_value};
    for_each_in(section, [&](const TextSection& one) {
      const auto entry = base_.find_entry(one, line.key.name, line.key.occurrence);
      if (!entry || !old_value.is_same(entry->value)) return;
      ++changed;
      if (edit_.is_touched(*entry)) {
        diagnostics_.error("overlay-file", edsc::position_of(overlay_, line),
                           fmt::format("another line of the overlay changes {} of [{}]", line.key.name, one.title));
        return;
      }
      if (line.new_value.empty()) {
        edit_.remove_entry(*entry);
      } else {
        edit_.set_value(*entry, line.new_value, value_origin(line));
      }
    });
    const std::size_t already =
        changed == 0 && !line.new_value.empty() ? count_in(section, line.key, line.new_value) : 0;
    note_state(line.entry.line, changed > 0   ? LineState::applied
                                : already > 0 ? LineState::obsolete
                                              : LineState::stale);
    if (changed == 0) {
      diagnostics_.error("overlay-effect", edsc::position_of(overlay_, line),
                         with_reason(fmt::format("no {} of [{}] has {}; {} already {}", line.key.name,
                                                 section.section->name, shown_value(line.old_value), already,
                                                 already == 1 ? "has the new value" : "have the new value"),
                                     line.reason));
    }
    return changed;
  }

  const OverlayFile& overlay_;
  const SheetText& base_;
  SheetEdit edit_;
  Diagnostics& diagnostics_;
  OverlayEdits result_;
  std::set<std::string> added_;  ///< section and key of the keys that are added
};

void require_reasons(const OverlayFile& overlay, Diagnostics& diagnostics) {
  for (const OverlaySection& section : overlay.sections) {
    if (section.has_reason) continue;
    diagnostics.warning(
        "overlay-reason", section_position(*overlay.source, *section.section),
        fmt::format("missing reason: a comment before [{}] or before each of its lines", section.section->name));
  }
}

}  // namespace

OverlayEdits edits_of(const OverlayFile& overlay, const SheetText& base, bool needs_reasons, Diagnostics& diagnostics) {
  if (needs_reasons) require_reasons(overlay, diagnostics);
  return OverlayApplier(overlay, base, diagnostics).apply();
}

}  // namespace edsc

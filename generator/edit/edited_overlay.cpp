#include "edit/edited_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/derive_overlay.hpp"
#include "overlay/overlay_file.hpp"
#include "overlay/overlay_keys.hpp"
#include "text/ascii.hpp"

namespace edsc::edit {
namespace {

/// The value of a key of [Overlay].
std::string header_value(const SourceFile& overlay, std::string_view key) {
  const SheetText text{overlay};
  const TextSection* const header = text.find(overlay_section);
  const auto entry = header == nullptr ? std::nullopt : text.find_entry(*header, key);
  return entry ? std::string{entry->value} : "";
}

/// The section [Overlay] alone: with it, the base is read in the same way and is not changed.
std::string header_alone(const SourceFile& overlay) {
  const SheetText text{overlay};
  const TextSection* const header = text.find(overlay_section);
  std::string lines;
  for (std::uint32_t line = header == nullptr ? 0 : header->line; header != nullptr && line < header->end; ++line) {
    lines += fmt::format("{}\n", overlay.line(line));
  }
  return lines;
}

std::unique_ptr<const OpenSheet> composed(const std::string& path, const std::string& bytes, const Options& options,
                                          std::string& problem) {
  Diagnostics diagnostics;
  const auto overlay = std::make_shared<SourceFile>(path, bytes);
  const ComposedOverlay result = compose_overlay(overlay, {}, diagnostics);
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error && problem.empty()) {
      problem = fmt::format("line {}: {}", one.position.line, one.message);
    }
  }
  if (!result.text) {
    if (problem.empty()) problem = "the base cannot be read";
    return nullptr;
  }
  return open_sheet(result.base_path, std::string{result.text->text()}, options, SheetChecks::all);
}

std::string lower(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(), to_lower);
  return result;
}

/// Whether a line states the value that the base has, in another notation.
bool is_without_effect(std::string_view value) {
  const std::size_t at = value.find(arrow);
  if (at == std::string_view::npos) return false;
  const std::string_view old_value = trim(value.substr(0, at)), new_value = trim(value.substr(at + arrow.size()));
  return !old_value.empty() && !new_value.empty() && is_same_value(old_value, new_value);
}

/// The lines of a derived overlay by section and key.
using OverlayLines = std::map<std::string, std::map<std::string, std::string>>;

OverlayLines lines_of(const SourceFile& overlay) {
  OverlayLines lines;
  const SheetText text{overlay};
  for (const TextSection& section : text.sections()) {
    if (equal_ignoring_case(section.title, overlay_section)) continue;
    for (const IniEntry& entry : text.entries(section)) {
      if (!is_without_effect(entry.value))
        lines[lower(section.title)].emplace(lower(entry.key), overlay.line(entry.line));
    }
  }
  return lines;
}

/// Edits of an overlay by line.
class OverlayEdit {
 public:
  explicit OverlayEdit(const SourceFile& overlay) : overlay_{overlay}, text_{overlay} {}

  void set(const std::string& section, const std::string& key, const std::string& line) {
    const TextSection* const place = text_.find(section);
    if (place == nullptr) {
      new_sections_[section].push_back(line);
      return;
    }
    if (const auto entry = text_.find_entry(*place, key)) {
      edits_[entry->line].replacement = line;
    } else {
      edits_[text_.last_line(*place)].after.push_back(line);
    }
  }

  /// False if the overlay does not have the line.
  bool remove(const std::string& section, const std::string& key) {
    const TextSection* const place = text_.find(section);
    const auto entry = place == nullptr ? std::nullopt : text_.find_entry(*place, key);
    if (!entry) return false;
    edits_[entry->line].is_removed = true;
    const std::vector<IniEntry> entries = text_.entries(*place);
    const bool is_empty = std::ranges::all_of(entries, [&](const IniEntry& one) {
      const auto edit = edits_.find(one.line);
      return edit != edits_.end() && edit->second.is_removed;
    });
    if (!is_empty || edits_.contains(place->line)) return true;
    for (std::uint32_t line = text_.first_line(*place); line < place->end; ++line) edits_[line].is_removed = true;
    return true;
  }

  [[nodiscard]] std::vector<TextEdit> finish(const SourceFile& derived) {
    std::vector<TextEdit> edits;
    for (const auto& [line, edit] : edits_) {
      TextEdit one{line, 1, {}};
      if (edit.replacement) {
        one.lines.push_back({*edit.replacement, {}});
      } else if (!edit.is_removed) {
        one.lines.push_back({std::string{overlay_.line(line)}, {}});
      }
      for (const std::string& added : edit.after) one.lines.push_back({added, {}});
      edits.push_back(std::move(one));
    }
    if (TextEdit end = new_sections(derived); !end.lines.empty()) edits.push_back(std::move(end));
    return edits;
  }

 private:
  struct LineEdit {
    std::optional<std::string> replacement;
    bool is_removed = false;
    std::vector<std::string> after;
  };

  /// New sections are at the end, in the order and spelling of the derived overlay.
  [[nodiscard]] TextEdit new_sections(const SourceFile& derived) const {
    TextEdit end{overlay_.lines() + 1, 0, {}};
    const SheetText text{derived};
    for (const TextSection& section : text.sections()) {
      const auto found = new_sections_.find(lower(section.title));
      if (found == new_sections_.end()) continue;
      end.lines.push_back({"", {}});
      end.lines.push_back({fmt::format("[{}]", section.title), {}});
      for (const std::string& line : found->second) end.lines.push_back({line, {}});
    }
    return end;
  }

  const SourceFile& overlay_;
  SheetText text_;
  std::map<std::uint32_t, LineEdit> edits_;
  std::map<std::string, std::vector<std::string>> new_sections_;
};

}  // namespace

OpenOverlay open_overlay(const std::string& path, const std::string& bytes, const Options& options) {
  OpenOverlay open;
  const SourceFile overlay{path, bytes};
  open.base_path = header_value(overlay, "Base");
  open.sheet = composed(path, bytes, options, open.problem);
  if (!open.sheet) return open;
  std::string problem;
  open.base = composed(path, header_alone(overlay), options, problem);
  if (!open.base) open.problem = problem;
  return open;
}

ChangedOverlay changed_overlay(const std::string& path, const std::string& bytes, const OpenOverlay& before,
                               const OpenSheet& after) {
  const std::shared_ptr<const SourceFile> base = before.base->source;
  const DerivedOverlay old = derive_overlay(base, *before.sheet->source, before.base_path);
  const DerivedOverlay now = derive_overlay(base, *after.source, before.base_path);
  if (!now.problem.empty()) return {{}, now.problem};
  const SourceFile overlay{path, bytes};
  const SourceFile old_text{path, old.text}, new_text{path, now.text};
  const OverlayLines old_lines = lines_of(old_text), new_lines = lines_of(new_text);
  OverlayEdit edit{overlay};
  for (const auto& [section, keys] : new_lines) {
    for (const auto& [key, line] : keys) {
      const auto found = old_lines.find(section);
      const auto same = found == old_lines.end() ? keys.end() : found->second.find(key);
      if (found != old_lines.end() && same != found->second.end() && same->second == line) continue;
      edit.set(section, key, line);
    }
  }
  for (const auto& [section, keys] : old_lines) {
    const auto found = new_lines.find(section);
    for (const auto& [key, line] : keys) {
      if (found != new_lines.end() && found->second.contains(key)) continue;
      if (!edit.remove(section, key)) {
        return {{},
                fmt::format("the value of {} of [{}] is from a range of the overlay; edit the overlay as a text", key,
                            section)};
      }
    }
  }
  EditedBytes edited = edited_bytes(bytes, overlay.encoding(), edit.finish(new_text), true);
  if (!edited.error.empty()) return {{}, edited.error};
  std::string problem;
  const auto result = composed(path, edited.bytes, after.options, problem);
  const std::string made = result ? derive_overlay(base, *result->source, before.base_path).text : "";
  if (!result || lines_of(SourceFile{path, made}) != new_lines) {
    return {{}, problem.empty() ? "the overlay cannot express this change; edit it as a text" : problem};
  }
  return {std::move(edited.bytes), {}};
}

}  // namespace edsc::edit

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "change/sheet_edit.hpp"
#include "change/sheet_text.hpp"
#include "compare/compare_devices.hpp"
#include "device/resolve.hpp"
#include "diagnostics/place.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "format/canonical_form.hpp"
#include "lsp/features.hpp"
#include "lsp/sheet_place.hpp"
#include "overlay/repair_plan.hpp"
#include "overlay/write_overlay.hpp"
#include "rules/check_rules.hpp"
#include "system/path.hpp"
#include "text/suggestion.hpp"

namespace edsc::lsp {
namespace {

/// The range of `removed` lines from `line` on, with their line ends.
TextRange range_of_lines(const View& view, std::uint32_t line, std::uint32_t removed) {
  const std::uint32_t end = line + removed;
  if (end <= view.analysis.own->lines()) return {{line - 1, 0}, {end - 1, 0}};
  const std::uint32_t last = view.analysis.own->lines();
  const TextPosition end_of_text =
      last == 0 || !view.analysis.own->line_end(last).empty()
          ? TextPosition{last, 0}
          : TextPosition{last - 1, units_before(view.line(last), view.line(last).size(), view.encoding)};
  return {line > last ? end_of_text : TextPosition{line - 1, 0}, end_of_text};
}

std::string_view usual_line_end(const View& view) {
  const std::string_view end = view.analysis.own->line_end(1);
  return end.empty() ? "\n" : end;
}

Json to_json(const View& view, const TextEdit& edit) {
  const std::uint32_t last = view.analysis.own->lines();
  const bool is_after_open_line = edit.line > last && last > 0 && view.analysis.own->line_end(last).empty();
  std::string text = is_after_open_line ? std::string{usual_line_end(view)} : std::string{};
  for (std::size_t i = 0; i < edit.lines.size(); ++i) {
    const std::uint32_t line = edit.line + static_cast<std::uint32_t>(i);
    text += edit.lines[i].text;
    const bool keeps_end = i < edit.removed && i + 1 == edit.lines.size() && line == last;
    text += keeps_end ? view.analysis.own->line_end(line) : usual_line_end(view);
  }
  return {{"range", lsp::to_json(range_of_lines(view, edit.line, edit.removed))}, {"newText", std::move(text)}};
}

Json to_json(const View& view, const std::vector<TextEdit>& edits) {
  Json rows = Json::array();
  for (const TextEdit& edit : edits) rows.push_back(to_json(view, edit));
  return rows;
}

Json workspace_edit(const View& view, Json edits) { return {{"changes", {{view.document.uri, std::move(edits)}}}}; }

NewLine new_line(std::string text) { return {std::move(text), {}}; }

/// The sections of a document, and the entry in a line.
class EditableSheet {
 public:
  explicit EditableSheet(const View& view) : text_{*view.analysis.own} {}

  [[nodiscard]] const SheetText& text() const { return text_; }

  [[nodiscard]] const TextSection* section_at(std::uint32_t line) const {
    const auto next = std::ranges::upper_bound(text_.sections(), line, {}, &TextSection::line);
    return next == text_.sections().begin() ? nullptr : &*std::prev(next);
  }

  [[nodiscard]] std::optional<IniEntry> entry_at(std::uint32_t line) const {
    const TextSection* const section = section_at(line);
    if (section == nullptr) return std::nullopt;
    for (const IniEntry& entry : text_.entries(*section)) {
      if (entry.line == line) return entry;
    }
    return std::nullopt;
  }

 private:
  SheetText text_;
};

bool is_count_key(std::string_view key) {
  const CountKey& count = section_keys::supported_objects;
  return equal_ignoring_case(key, count.name) || equal_ignoring_case(key, count.misspelling) ||
         equal_ignoring_case(key, "NrOfEntries") || equal_ignoring_case(key, "ObjectLinks");
}

/// Adds an object to the end of a list, with its count.
bool add_to_list(const EditableSheet& sheet, const std::string& list, const std::string& index, SheetEdit& edit) {
  const TextSection* const section = sheet.text().find(list);
  if (section == nullptr) return false;
  std::uint64_t last = 0;
  std::size_t count = 0;
  std::optional<IniEntry> stated;
  for (const IniEntry& entry : sheet.text().entries(*section)) {
    if (is_count_key(entry.key)) {
      stated = entry;
    } else if (const auto number = parse_unsigned(entry.key)) {
      last = std::max(last, *number);
      ++count;
    }
  }
  const std::string key = fmt::format("{}", last + 1);
  edit.add_entry(*section, key, {new_line(fmt::format("{}={}", key, index))});
  if (stated) edit.set_value(*stated, spelled_like(count + 1, strip_inline_comment(stated->value)), {});
  return true;
}

/// Applies a remedy of edsc; false if it is not for the text of the document.
bool apply_remedy(const View& view, const EditableSheet& sheet, const Remedy& remedy, SheetEdit& edit) {
  if (remedy.place.file != view.analysis.own.get() || remedy.place.line == 0) return false;
  if (remedy.kind == Remedy::Kind::listing) return add_to_list(sheet, remedy.key, remedy.text, edit);
  if (const auto entry = sheet.entry_at(remedy.place.line)) {
    edit.set_value(*entry, remedy.text, {});
    return true;
  }
  const TextSection* const section = sheet.section_at(remedy.place.line);
  if (section == nullptr || remedy.key.empty()) return false;
  if (const auto existing = sheet.text().find_entry(*section, remedy.key)) {
    edit.set_value(*existing, remedy.text, {});
  } else {
    edit.add_entry(*section, remedy.key, {new_line(remedy.key + "=" + remedy.text)});
  }
  return true;
}

std::string title_of(const Remedy& remedy) {
  const std::string reason = remedy.reason.empty() ? std::string{} : " (" + remedy.reason + ")";
  switch (remedy.kind) {
    case Remedy::Kind::listing: return fmt::format("Add {} to [{}]", remedy.text, remedy.key);
    case Remedy::Kind::key: return fmt::format("Set {}={}{}", remedy.key, remedy.text, reason);
    case Remedy::Kind::value: break;
  }
  return fmt::format("Change to {}{}", remedy.text, reason);
}

/// Rules whose fix derives lists and counts from the rest of the file.
bool is_of_counts(RuleId rule) {
  static const AnyRule rules[] = {"object-not-listed", "object-list-count", "entry-count",
                                  "sub-number",        "pdo-count",         "sub-index-0-value"};
  return std::ranges::find(rules, rule) != std::end(rules);
}

/// A key of the section that is similar to an unknown one.
std::string similar_key(const TextSection& section, std::string_view key) {
  const SectionRow* const row = find_section(section.name.kind);
  if (row == nullptr) return {};
  std::vector<std::string_view> names;
  for (const SectionKey& one : row->keys) {
    if (!one.is_numbered()) names.push_back(one.name);
  }
  return std::string{most_similar(key, names)};
}

/// The sub-index of 1018h that a key of [DeviceInfo] repeats; 0 for another rule.
std::uint8_t identity_of(RuleId rule) {
  if (rule == AnyRule{"vendor-number"}) return 1;
  if (rule == AnyRule{"product-number"}) return 2;
  return rule == AnyRule{"revision-number"} ? 3 : 0;
}

class CodeActions {
 public:
  CodeActions(const View& view, const TextRange& range) : view_{view}, range_{range}, sheet_{view} {}

  Json run(const Json& context) {
    const Json only = context.value("only", Json::array());
    const auto wants = [&](std::string_view kind) {
      return !only.is_array() || only.empty() || std::ranges::any_of(only, [&](const Json& one) {
        const std::string wanted = one.is_string() ? one.get<std::string>() : std::string{};
        return kind == wanted || kind.starts_with(wanted + ".");
      });
    };
    if (wants("quickfix")) {
      add_remedies();
      add_fixes();
    }
    if (wants(fix_all)) add_fix_all(only.is_array() && !only.empty());
    return std::move(actions_);
  }

 private:
  static constexpr std::string_view fix_all = "source.fixAll.edsc";

  void add(const std::string& title, std::string_view kind, Json edit, bool is_preferred = false) {
    Json action{{"title", title}, {"kind", kind}, {"edit", std::move(edit)}};
    if (is_preferred) action["isPreferred"] = true;
    actions_.push_back(std::move(action));
  }

  void add_edit(const std::string& title, SheetEdit& edit, bool is_preferred = true) {
    add(title, "quickfix", workspace_edit(view_, to_json(view_, edit.finish())), is_preferred);
  }

  [[nodiscard]] bool is_in_range(const Position& position) const {
    return position.file == view_.analysis.own.get() && overlap(range_of(position, view_.encoding), range_);
  }

  [[nodiscard]] bool touches_line(const Position& position) const {
    return position.file == view_.analysis.own.get() && position.line >= range_.start.line + 1 &&
           position.line <= range_.end.line + 1;
  }

  void add_remedies() {
    for (const Remedy& remedy : view_.analysis.diagnostics.remedies()) {
      if (!touches_line(remedy.place)) continue;
      SheetEdit edit{sheet_.text()};
      if (!apply_remedy(view_, sheet_, remedy, edit)) continue;
      add_edit(title_of(remedy), edit);
      add_to_overlay(remedy);
    }
  }

  /// The same correction in a new overlay beside the file.
  void add_to_overlay(const Remedy& remedy) {
    if (view_.document.kind != DocumentKind::device || view_.document.path.find("://") != std::string::npos) return;
    const std::filesystem::path path = to_native(view_.document.path).replace_extension(".overlay");
    std::error_code error;
    const std::string overlay = from_native(path);
    if (std::filesystem::exists(path, error) || view_.workspace.find_path(overlay) != nullptr) return;
    RepairPlan plan{*view_.analysis.own};
    if (!plan.add(std::vector{remedy})) return;
    NewOverlay created = plan.overlay();
    created.base = file_name_of(view_.document.path);
    const std::string uri = uri_of_file(overlay);
    const Json insertion{{"range", lsp::to_json(TextRange{})}, {"newText", overlay_text(created)}};
    add(fmt::format("Correct it in {} instead", file_name_of(overlay)), "quickfix",
        {{"documentChanges", Json::array({{{"kind", "create"}, {"uri", uri}},
                                          {{"textDocument", {{"uri", uri}, {"version", nullptr}}},
                                           {"edits", Json::array({insertion})}}})}});
  }

  void add_fixes() {
    for (const Diagnostic& one : view_.analysis.diagnostics.all()) {
      if (!is_in_range(one.position)) continue;
      SheetEdit edit{sheet_.text()};
      const std::string title = fix(one, edit);
      if (!title.empty()) add_edit(title, edit);
    }
    std::set<RuleId> allowed;
    for (const Diagnostic& one : view_.analysis.diagnostics.all()) {
      if (is_in_range(one.position) && allowed.insert(one.rule).second) add_allowance(one);
    }
  }

  /// The title of a fix that follows from the text; empty if there is none.
  std::string fix(const Diagnostic& one, SheetEdit& edit) const {
    const auto entry = sheet_.entry_at(one.position.line);
    const TextSection* const section = sheet_.section_at(one.position.line);
    if (!entry || section == nullptr) return {};
    if (one.rule == AnyRule{"object-list-count"} || one.rule == AnyRule{"entry-count"}) {
      return fix_count(*section, *entry, edit);
    }
    if (one.rule == AnyRule{"duplicate-key"} || one.rule == AnyRule{"overlay-obsolete"}) {
      edit.remove_entry(*entry);
      return "Delete the line";
    }
    if (one.rule == AnyRule{"unknown-key"}) return fix_key(*section, *entry, edit);
    const Device* const device = view_.analysis.device();
    const std::uint8_t sub_index = identity_of(one.rule);
    const Entry* const identity = sub_index != 0 && device != nullptr ? device->find(0x1018, sub_index) : nullptr;
    if (identity == nullptr || !identity->default_value || section->name.kind != SectionKind::device_info) return {};
    const std::string text = spelled_like(identity->default_value->bits, strip_inline_comment(entry->value));
    edit.set_value(*entry, text, {});
    return fmt::format("Change to {}, the value of {}", text, entry_label(0x1018, sub_index));
  }

  std::string fix_count(const TextSection& section, const IniEntry& entry, SheetEdit& edit) const {
    if (!is_count_key(entry.key)) return {};
    std::size_t count = 0;
    for (const IniEntry& one : sheet_.text().entries(section)) count += parse_unsigned(one.key) ? 1 : 0;
    const std::string text = spelled_like(count, strip_inline_comment(entry.value));
    edit.set_value(entry, text, {});
    return fmt::format("Change to {}, the number of entries", text);
  }

  std::string fix_key(const TextSection& section, const IniEntry& entry, SheetEdit& edit) const {
    const std::string key = similar_key(section, entry.key);
    if (key.empty() || sheet_.text().find_entry(section, key)) return {};
    std::string line{view_.line(entry.line)};
    line.replace(entry.key_column - 1, entry.key.size(), key);
    edit.remove_entry(entry);
    edit.add_entry(section, key, {new_line(line)});
    return fmt::format("Change {} to {}", entry.key, key);
  }

  /// A comment with a reason, which the user completes.
  void add_allowance(const Diagnostic& one) {
    if (one.rule.row().is_fatal || view_.document.kind != DocumentKind::device) return;
    const std::uint32_t line = std::max<std::uint32_t>(one.position.line, 1);
    TextEdit insertion{line, 0, {new_line(fmt::format("; edsc: allow {} - intended", one.rule.text()))}};
    add(fmt::format("Allow {} here; state the reason in the comment", one.rule.text()), "quickfix",
        workspace_edit(view_, to_json(view_, std::vector{insertion})));
  }

  /// Lists and counts only.
  void add_fix_all(bool is_requested) {
    SheetEdit edit{sheet_.text()};
    std::set<std::uint32_t> changed;
    std::set<std::string> lists;
    for (const Remedy& remedy : view_.analysis.diagnostics.remedies()) {
      if (!is_of_counts(remedy.rule)) continue;
      // A second object of a list follows when the first one is in it.
      if (remedy.kind == Remedy::Kind::listing ? !lists.insert(remedy.key).second
                                               : !changed.insert(remedy.place.line).second) {
        continue;
      }
      (void)apply_remedy(view_, sheet_, remedy, edit);
    }
    for (const Diagnostic& one : view_.analysis.diagnostics.all()) {
      if (!is_of_counts(one.rule) || one.position.file != view_.analysis.own.get()) continue;
      const auto entry = sheet_.entry_at(one.position.line);
      if (entry && !edit.is_touched(*entry)) (void)fix(one, edit);
    }
    Json edits = to_json(view_, edit.finish());
    if (edits.empty() && !is_requested) return;
    if (!edits.empty()) add("Correct all object lists and counts", fix_all, workspace_edit(view_, std::move(edits)));
  }

  const View& view_;
  TextRange range_;
  EditableSheet sheet_;
  Json actions_ = Json::array();
};

/// The new index, or index and sub-index, that a user writes: `2040`, `0x2040`, `2040h`, `2040sub3`.
struct NewAddress {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub_index;
};

std::optional<NewAddress> read_address(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  if (text.ends_with('h') || text.ends_with('H')) text.remove_suffix(1);
  const SectionName name = read_section_name(text);
  if (!name.remark.empty() || text.size() < 4) return std::nullopt;
  if (name.kind == SectionKind::object) return NewAddress{name.index, {}};
  if (name.kind == SectionKind::sub_object) return NewAddress{name.index, name.sub_index};
  return std::nullopt;
}

/// The digits of a mapping value with another index and sub-index.
std::string remapped(std::string_view value, const MappingValue& mapped, const EntryAddress& to) {
  const MappingValue changed{to.index, to.sub_index.value_or(mapped.sub_index), mapped.bits};
  return spelled_like(changed.value(), value);
}

class Renumbering {
 public:
  Renumbering(const View& view, const EntryAddress& from, const NewAddress& to)
      : view_{view}, from_{from}, to_{to}, text_{*view.analysis.own}, edit_{text_} {}

  Json run() {
    check();
    rename_sections();
    for (const TextSection& section : text_.sections()) {
      for (const IniEntry& entry : text_.entries(section)) follow(section, entry);
    }
    return workspace_edit(view_, to_json(view_, edit_.finish()));
  }

 private:
  [[nodiscard]] bool is_of_entry() const { return to_.sub_index.has_value(); }

  void check() const {
    if (is_of_entry() && (!from_.sub_index || to_.index != from_.index)) {
      throw RequestFailed{fmt::format("a sub-index can be renumbered within {}", index_label(from_.index))};
    }
    for (const TextSection& section : text_.sections()) {
      const bool is_new = is_of_entry() ? section.name.kind == SectionKind::sub_object &&
                                              section.name.index == to_.index && section.name.sub_index == to_.sub_index
                                        : is_object_section(section.name.kind) && section.name.index == to_.index;
      if (is_new) throw RequestFailed{fmt::format("section [{}] already exists", section.title)};
    }
  }

  void rename_sections() {
    const SectionKind kind = is_of_entry() ? SectionKind::sub_object : SectionKind::object;
    for (const TextSection& section : text_.sections()) {
      if (section.name.kind != kind || section.name.index != from_.index) continue;
      if (is_of_entry() && section.name.sub_index != *from_.sub_index) continue;
      edit_.rename_section(section,
                           is_of_entry() ? fmt::format("{:04X}sub{:X}", to_.index, unsigned{*to_.sub_index})
                                         : fmt::format("{:04X}", to_.index),
                           {});
      return;
    }
    throw RequestFailed{fmt::format("{} does not have a section", index_label(from_.index))};
  }

  /// Mapping values and links follow their object. Lists follow by themselves.
  void follow(const TextSection& section, const IniEntry& entry) {
    if (const auto mapped = mapping_at(section.name, entry)) {
      const bool is_target = mapped->index == from_.index && (!is_of_entry() || mapped->sub_index == *from_.sub_index);
      const EntryAddress to{to_.index, to_.sub_index};
      if (is_target) edit_.set_value(entry, remapped(current_value(entry), *mapped, to), {});
    } else if (section.name.kind == SectionKind::object_links && !is_of_entry() &&
               listed_index(section.name, entry) == from_.index) {
      edit_.set_value(entry, spelled_like(to_.index, current_value(entry)), {});
    }
  }

  const View& view_;
  EntryAddress from_;
  NewAddress to_;
  SheetText text_;
  SheetEdit edit_;
};

SheetPlace renamed_place(const View& view, const TextPosition& at) {
  if (view.document.kind != DocumentKind::device) return {};
  return place_in(view.analysis.ini, at.line + 1, view.column_of(at));
}

}  // namespace

Json formatting(const View& view) {
  if (view.document.kind != DocumentKind::device) return Json::array();
  Diagnostics diagnostics;
  for (const AnyRule rule : {AnyRule{"unknown-key"}, AnyRule{"unknown-section"}}) diagnostics.silence(rule);
  const IniFile ini = parse_ini(*view.analysis.own, diagnostics);
  if (ini.sections.empty()) return Json::array();
  const DataSheet sheet = read_data_sheet(ini, diagnostics);
  if (diagnostics.errors() > 0) throw RequestFailed{"the file has errors; it is not formatted"};
  Diagnostics ignored;
  const Device device = resolve_device(sheet, {}, {}, ignored);
  const std::string text = to_text(canonical_form(ini, sheet, device));
  if (text == view.document.text) return Json::array();
  TextRange whole = range_of_lines(view, 1, view.analysis.own->lines());
  whole.start = {0, 0};
  return Json::array({{{"range", lsp::to_json(whole)}, {"newText", text}}});
}

Json code_lenses(const View& view, const Committed& committed) {
  Json lenses = Json::array();
  if (view.document.kind != DocumentKind::device || view.analysis.device() == nullptr || !committed) return lenses;
  const std::shared_ptr<const LoadedDevice> before = committed(view.document.path);
  if (!before || !before->device) return lenses;
  const Changes changes = compare_devices(before->named(), view.analysis.loaded->named());
  if (changes.all().empty()) return lenses;
  const auto add = [&](const TextRange& range, std::string title) {
    lenses.push_back({{"range", lsp::to_json(range)}, {"command", {{"title", std::move(title)}, {"command", ""}}}});
  };
  add({},
      fmt::format("changes since git HEAD: {}, of which {} break something", changes.all().size(), changes.breaking()));
  for (const Change& change : changes.all()) {
    const Position origin = origin_of(change.new_position);
    if (!change.is_breaking() || origin.file != view.analysis.own.get()) continue;
    std::string whom;
    const auto name = [&](bool breaks, std::string_view who) {
      if (breaks) whom += fmt::format("{}{}", whom.empty() ? "" : ", ", who);
    };
    name(change.breaks.master, "masters");
    name(change.breaks.pdo, "PDO partners");
    name(change.breaks.source, "source code");
    name(change.breaks.storage, "stored parameters");
    add(range_of(origin, view.encoding), fmt::format("breaks {}: {}", whom, message_of(change)));
  }
  return lenses;
}

Json code_actions(const View& view, const TextRange& range, const Json& context) {
  return view.is_sheet() ? CodeActions{view, range}.run(context) : Json::array();
}

Json prepare_rename(const View& view, const TextPosition& at) {
  const SheetPlace place = renamed_place(view, at);
  const auto target = target_of(place);
  if (!target) return nullptr;
  const bool is_header = place.entry == nullptr;
  const TextRange range = is_header ? range_in(*view.analysis.own, place.section->line, place.section->column,
                                               place.section->name.size(), view.encoding)
                                    : range_in(*view.analysis.own, place.entry->line, place.entry->value_column,
                                               current_value(*place.entry).size(), view.encoding);
  return {{"range", lsp::to_json(range)},
          {"placeholder", target->sub_index && is_header
                              ? fmt::format("{:04X}sub{:X}", target->index, unsigned{*target->sub_index})
                              : fmt::format("{:04X}", target->index)}};
}

Json rename(const View& view, const TextPosition& at, const std::string& new_name) {
  const auto target = target_of(renamed_place(view, at));
  if (!target) throw RequestFailed{"there is no object to renumber here"};
  const auto to = read_address(new_name);
  if (!to)
    throw RequestFailed{fmt::format("\"{}\" is not an index, as 2040, or index and sub-index, as 2040sub1", new_name)};
  return Renumbering{view, *target, *to}.run();
}

}  // namespace edsc::lsp

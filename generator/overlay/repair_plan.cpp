#include "overlay/repair_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "rules/check_rules.hpp"

namespace edsc {
namespace {

/// Rules whose remedies change how the whole file is read.
bool is_of_the_file(RuleId rule) {
  static const AnyRule rules[] = {"shifted-data-types", "sub-index-base"};
  return std::ranges::find(rules, rule) != std::end(rules);
}

}  // namespace

bool RepairPlan::add(const std::vector<Remedy>& remedies) {
  const bool is_file = std::ranges::any_of(remedies, is_of_the_file, &Remedy::rule);
  bool has_changed = false;
  for (const Remedy& remedy : remedies) {
    if (is_file && !is_of_the_file(remedy.rule)) continue;
    if (!add(remedy)) continue;
    ++counts_[remedy.rule];
    has_changed = true;
  }
  return has_changed;
}

bool RepairPlan::add(const Remedy& remedy) {
  if (remedy.kind == Remedy::Kind::listing) {
    return unlisted_.try_emplace(remedy.text, Unlisted{remedy.key, remedy.reason}).second;
  }
  if (remedy.rule == AnyRule{"sub-index-base"}) {
    if (!header_.empty()) return false;
    header_.emplace_back("SubIndices", remedy.text);
    return true;
  }
  return add_value(remedy);
}

/// The position may be one of the base, or of a line that the overlay already has.
bool RepairPlan::add_value(const Remedy& remedy) {
  if (remedy.place.file == nullptr || remedy.place.line == 0) return false;
  const SheetText& text = text_of(*remedy.place.file);
  const auto next = std::ranges::upper_bound(text.sections(), remedy.place.line, {}, &TextSection::line);
  if (next == text.sections().begin()) return false;
  const TextSection& section = *std::prev(next);
  OverlayChange change{std::string{section.title}, remedy.key, std::nullopt, remedy.text, remedy.reason};
  if (remedy.place.line != section.line) {
    const std::vector<IniEntry> entries = text.entries(section);
    const auto entry = std::ranges::find(entries, remedy.place.line, &IniEntry::line);
    if (entry == entries.end()) return false;
    change.key = entry->key;
    change.old_text = strip_inline_comment(entry->value);
  } else if (change.key.empty()) {
    return false;
  } else if (const auto existing = text.find_entry(section, change.key)) {
    change.old_text = existing->value;  // without a number: empty, or only a comment
  }
  const auto [place, is_new] = places_.try_emplace({change.section, change.key}, changes_.size());
  if (is_new) {
    changes_.push_back(std::move(change));
    return true;
  }
  OverlayChange& before = changes_[place->second];
  if (before.new_text == remedy.text || remedy.place.file == &base_.source()) return false;
  before.new_text = remedy.text;
  before.reason = remedy.reason;
  return true;
}

const SheetText& RepairPlan::text_of(const SourceFile& file) {
  if (&file == &base_.source()) return base_;
  std::unique_ptr<SheetText>& text = texts_[&file];
  if (text == nullptr) text = std::make_unique<SheetText>(file);
  return *text;
}

NewOverlay RepairPlan::overlay() const {
  NewOverlay overlay{{}, {}, header_, changes_};
  add_lists(overlay);
  return overlay;
}

/// New entries follow the last number of a list.
void RepairPlan::add_lists(NewOverlay& overlay) const {
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> lists;
  for (const auto& [index, unlisted] : unlisted_) lists[unlisted.list].emplace_back(index, unlisted.reason);
  for (const auto& [list, objects] : lists) {
    const TextSection* const section = base_.find(list);
    ListRows rows = section == nullptr ? ListRows{} : list_rows(base_, *section);
    const auto stated =
        rows.stated ? std::optional{std::string{strip_inline_comment(rows.stated->value)}} : std::nullopt;
    overlay.changes.push_back(
        {list, rows.count_key(), stated, fmt::format("{}", rows.count + objects.size()), "number of the entries"});
    for (const auto& [index, reason] : objects) {
      overlay.changes.push_back({list, fmt::format("{}", ++rows.last_number), std::nullopt, index, reason});
    }
  }
}

}  // namespace edsc

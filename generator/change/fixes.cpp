#include "change/fixes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "change/sheet_edit.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "rules/check_rules.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t identity_object = 0x1018;

}  // namespace

/// A line of a text: the header of a section, or an entry.
struct Fixes::Place {
  const TextSection* section;
  std::string title;  ///< of the section
  std::optional<IniEntry> entry;
  unsigned occurrence = 1;  ///< of the key of the entry in its section

  [[nodiscard]] std::string key() const {
    if (!entry) return {};
    return occurrence == 1 ? std::string{entry->key} : fmt::format("{}#{}", entry->key, occurrence);
  }
};

/// What fixes the findings of a rule.
struct Fixes::Row {
  AnyRule rule;
  /// Fixes from the text, for a finding in the line of an entry; null: the finding comes with its remedy.
  std::vector<Fix> (Fixes::*find)(const Place& place) const;
  bool is_of_counts = false;  ///< lists and counts that follow from the rest of the file
};

const std::vector<Fixes::Row>& Fixes::rows() {
  static const std::vector<Row> all{
      {"object-not-listed", nullptr, true},
      {"object-list-count", &Fixes::count_entries, true},
      {"entry-count", &Fixes::count_entries, true},
      {"sub-number", nullptr, true},
      {"sub-index-0-value", nullptr, true},
      {"pdo-count", nullptr, true},
      {"vendor-number", &Fixes::copy_identity<1>},
      {"product-number", &Fixes::copy_identity<2>},
      {"revision-number", &Fixes::copy_identity<3>},
      {"unknown-key", &Fixes::correct_key},
      {"duplicate-key", &Fixes::remove_line},
      {"overlay-obsolete", &Fixes::remove_line},
      {"process-data-not-mappable", &Fixes::change_access},
  };
  return all;
}

Fixes::Fixes(const SheetText& text, const Diagnostics& diagnostics, const Device* device)
    : text_{text}, diagnostics_{diagnostics}, device_{device} {
  for (const Remedy& remedy : diagnostics.remedies()) {
    if (remedy.place.file == &text.source() && remedy.place.line > 0) remedies_.emplace(remedy.place.line, &remedy);
  }
}

const TextSection* Fixes::section_at(std::uint32_t line) const {
  const auto next = std::ranges::upper_bound(text_.sections(), line, {}, &TextSection::line);
  return next == text_.sections().begin() ? nullptr : &*std::prev(next);
}

/// Nothing in the second of two sections with one title: changes name a section by its title, and so reach the first
/// one.
std::optional<Fixes::Place> Fixes::place_at(std::uint32_t line) const {
  const TextSection* const section = section_at(line);
  if (section == nullptr || text_.find(section->title) != section) return std::nullopt;
  Place place{section, std::string{section->title}, std::nullopt};
  if (line == section->line) return place;
  place.entry = read_ini_entry(text_.source().line(line), line);
  if (!place.entry) return std::nullopt;
  while (true) {
    const auto same = text_.find_entry(*section, place.entry->key, place.occurrence);
    if (!same || same->line == line) return place;
    ++place.occurrence;
  }
}

std::vector<Fix> Fixes::at(RuleId rule, std::uint32_t line) const {
  std::vector<Fix> fixes;
  const auto [first, last] = remedies_.equal_range(line);
  for (auto remedy = first; remedy != last; ++remedy) {
    if (remedy->second->rule != rule) continue;
    if (auto fix = of_remedy(*remedy->second)) fixes.push_back(*std::move(fix));
  }
  if (!fixes.empty()) return fixes;
  const auto row = std::ranges::find_if(rows(), [&](const Row& one) { return rule == one.rule; });
  if (row == rows().end() || row->find == nullptr) return fixes;
  const auto place = place_at(line);
  return place && place->entry ? (this->*row->find)(*place) : fixes;
}

std::optional<Fix> Fixes::of_remedy(const Remedy& remedy) const {
  if (remedy.kind == Remedy::Kind::listing) return of_listing(remedy);
  const auto place = place_at(remedy.place.line);
  if (!place || place->occurrence != 1) return std::nullopt;
  const std::string key = place->entry ? std::string{place->entry->key} : remedy.key;
  if (key.empty()) return std::nullopt;
  const std::string reason = remedy.reason.empty() ? "" : " (" + remedy.reason + ")";
  return Fix{place->entry ? fmt::format("Change to {}{}", remedy.text, reason)
                          : fmt::format("Set {}={}{}", key, remedy.text, reason),
             {SetValue{place->title, key, remedy.text}}};
}

std::optional<Fix> Fixes::of_listing(const Remedy& remedy) const {
  const TextSection* const list = text_.find(remedy.key);
  if (list == nullptr) return std::nullopt;
  const ListRows rows = list_rows(text_, *list);
  return Fix{fmt::format("Add {} to [{}]", remedy.text, remedy.key),
             {SetValue{remedy.key, fmt::format("{}", rows.last_number + 1), remedy.text},
              SetValue{remedy.key, rows.count_key(), fmt::format("{}", rows.count + 1)}}};
}

std::vector<Fix> Fixes::count_entries(const Place& place) const {
  const ListRows rows = list_rows(text_, *place.section);
  if (!rows.stated || rows.stated->line != place.entry->line) return {};
  const std::string text = fmt::format("{}", rows.count);
  return {{fmt::format("Change to {}, the number of entries", text), {SetValue{place.title, place.key(), text}}}};
}

std::vector<Fix> Fixes::remove_line(const Place& place) const {
  // An overlay must not have a section without a line. With the section of an object, its other sections are removed.
  const SectionName& name = place.section->name;
  const bool is_alone =
      !is_object_section(name.kind) || std::ranges::count_if(text_.sections(), [&](const TextSection& one) {
                                         return is_object_section(one.name.kind) && one.name.index == name.index;
                                       }) == 1;
  if (is_alone && text_.entries(*place.section).size() == 1) {
    return {{"Delete the section, which has no other line", {RemovePart{place.title, {}}}}};
  }
  return {{"Delete the line", {RemovePart{place.title, place.key()}}}};
}

std::vector<Fix> Fixes::correct_key(const Place& place) const {
  std::vector<Fix> fixes;
  const std::string_view written = place.entry->key;
  std::vector<std::string_view> names;
  if (const SectionRow* const row = find_section(place.section->name.kind)) {
    for (const SectionKey& key : row->keys) {
      if (!key.is_numbered()) names.push_back(key.name);
    }
  }
  const std::string similar{most_similar(written, names)};
  if (!similar.empty() && place.occurrence == 1 && !text_.find_entry(*place.section, similar)) {
    fixes.push_back(
        {fmt::format("Change {} to {}", written, similar), {RenamePart{place.title, std::string{written}, similar}}});
  }
  fixes.push_back({fmt::format("Remove {}", written), {RemovePart{place.title, place.key()}}});
  return fixes;
}

/// rwr and rww are for mappable entries: the entry becomes mappable, or its access type becomes rw.
std::vector<Fix> Fixes::change_access(const Place& place) const {
  if (!equal_ignoring_case(place.entry->key, "AccessType") || place.occurrence != 1) return {};
  return {{"Set PDOMapping=1", {SetValue{place.title, "PDOMapping", "1"}}},
          {"Change to rw", {SetValue{place.title, std::string{place.entry->key}, "rw"}}}};
}

template <std::uint8_t sub_index>
std::vector<Fix> Fixes::copy_identity(const Place& place) const {
  const Entry* const identity = device_ == nullptr ? nullptr : device_->find(identity_object, sub_index);
  if (identity == nullptr || !identity->default_value || place.section->name.kind != SectionKind::device_info)
    return {};
  const std::string text = spelled_like(identity->default_value->bits, strip_inline_comment(place.entry->value));
  return {{fmt::format("Change to {}, the value of {}", text, entry_label(identity_object, sub_index)),
           {SetValue{place.title, place.key(), text}}}};
}

std::optional<Fix> Fixes::allowance(RuleId rule, std::uint32_t line) const {
  const auto place = place_at(line);
  if (!place || rule.row().is_fatal || rule.text().empty()) return std::nullopt;
  return Fix{fmt::format("Allow {} here", rule.text()),
             {AllowFinding{place->title, place->key(), std::string{rule.text()}, {}}},
             true};
}

std::vector<SheetChange> Fixes::of_lists_and_counts() const {
  const auto is_of_counts = [](RuleId rule) {
    return std::ranges::any_of(rows(), [&](const Row& one) { return one.is_of_counts && rule == one.rule; });
  };
  std::vector<SheetChange> changes;
  std::set<std::uint32_t> lines;
  std::map<std::string, std::vector<std::string>> unlisted;
  for (const Remedy& remedy : diagnostics_.remedies()) {
    if (remedy.place.file != &text_.source() || !is_of_counts(remedy.rule)) continue;
    if (remedy.kind == Remedy::Kind::listing) {
      unlisted[remedy.key].push_back(remedy.text);
    } else if (auto fix = lines.insert(remedy.place.line).second ? of_remedy(remedy) : std::nullopt) {
      std::ranges::move(fix->changes, std::back_inserter(changes));
    }
  }
  for (const Diagnostic& one : diagnostics_.all()) {
    if (one.position.file != &text_.source() || !is_of_counts(one.rule)) continue;
    if (one.rule == AnyRule{"object-not-listed"} || !lines.insert(one.position.line).second) continue;
    for (Fix& fix : at(one.rule, one.position.line)) std::ranges::move(fix.changes, std::back_inserter(changes));
  }
  for (const auto& [list, objects] : unlisted) {
    const TextSection* const section = text_.find(list);
    if (section == nullptr) continue;
    ListRows rows = list_rows(text_, *section);
    for (const std::string& object : objects) {
      changes.emplace_back(SetValue{list, fmt::format("{}", ++rows.last_number), object});
    }
    changes.emplace_back(SetValue{list, rows.count_key(), fmt::format("{}", rows.count + objects.size())});
  }
  return changes;
}

}  // namespace edsc

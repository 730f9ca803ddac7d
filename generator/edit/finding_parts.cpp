#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_edit.hpp"
#include "edit/sheet_parts.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "rules/check_rules.hpp"
#include "text/suggestion.hpp"

namespace edsc::edit {
namespace {

constexpr std::size_t max_findings = 500;

const TextSection* section_at(const SheetText& text, std::uint32_t line) {
  const auto next = std::ranges::upper_bound(text.sections(), line, {}, &TextSection::line);
  return next == text.sections().begin() ? nullptr : &*std::prev(next);
}

std::optional<IniEntry> entry_at(const SheetText& text, const TextSection& section, std::uint32_t line) {
  for (const IniEntry& entry : text.entries(section)) {
    if (entry.line == line) return entry;
  }
  return std::nullopt;
}

/// The fixes of a finding, as changes.
class Fixes {
 public:
  Fixes(const OpenSheet& sheet, const Diagnostic& one, const SheetText& text)
      : sheet_{sheet}, one_{one}, text_{text}, section_{section_at(text, one.position.line)} {}

  Json run() {
    for (const Remedy& remedy : sheet_.diagnostics.remedies()) {
      if (remedy.rule == one_.rule && remedy.place.line == one_.position.line) add_remedy(remedy);
    }
    if (section_ != nullptr && fixes_.empty()) add_from_text();
    return std::move(fixes_);
  }

 private:
  void add(const std::string& title, const std::vector<SheetChange>& changes) {
    Json list = Json::array();
    for (const SheetChange& change : changes) list.push_back(change_as_json(change));
    fixes_.push_back({{"title", title}, {"changes", std::move(list)}});
  }

  void add_remedy(const Remedy& remedy) {
    if (remedy.kind == Remedy::Kind::listing) return add_listing(remedy);
    const TextSection* const section = section_at(text_, remedy.place.line);
    if (section == nullptr) return;
    const auto entry = entry_at(text_, *section, remedy.place.line);
    const std::string key = entry ? std::string{entry->key} : remedy.key;
    if (key.empty()) return;
    const std::string reason = remedy.reason.empty() ? "" : " (" + remedy.reason + ")";
    const std::string title = entry ? fmt::format("Change to {}{}", remedy.text, reason)
                                    : fmt::format("Set {}={}{}", key, remedy.text, reason);
    add(title, {SetValue{std::string{section->title}, key, remedy.text}});
  }

  void add_listing(const Remedy& remedy) {
    const TextSection* const list = text_.find(remedy.key);
    if (list == nullptr) return;
    std::uint64_t last = 0;
    std::size_t count = 0;
    std::string count_key{section_keys::supported_objects.name};
    for (const IniEntry& entry : text_.entries(*list)) {
      const auto number = parse_unsigned(entry.key);
      if (number) {
        last = std::max(last, *number);
        ++count;
      } else {
        count_key = entry.key;
      }
    }
    add(fmt::format("Add {} to [{}]", remedy.text, remedy.key),
        {SetValue{remedy.key, fmt::format("{}", last + 1), remedy.text},
         SetValue{remedy.key, count_key, fmt::format("{}", count + 1)}});
  }

  void add_from_text() {
    const auto entry = entry_at(text_, *section_, one_.position.line);
    if (!entry) return;
    const std::string title{section_->title};
    if (one_.rule == AnyRule{"object-list-count"} || one_.rule == AnyRule{"entry-count"}) {
      std::size_t count = 0;
      for (const IniEntry& row : text_.entries(*section_)) count += parse_unsigned(row.key) ? 1U : 0U;
      if (parse_unsigned(entry->key)) return;
      add(fmt::format("Change to {}, the number of entries", count),
          {SetValue{title, std::string{entry->key}, fmt::format("{}", count)}});
    } else if (one_.rule == AnyRule{"unknown-key"}) {
      add_key(*entry);
    } else {
      add_identity(*entry);
    }
  }

  void add_key(const IniEntry& entry) {
    const std::string title{section_->title};
    const SectionRow* const row = find_section(section_->name.kind);
    std::vector<std::string_view> names;
    if (row != nullptr) {
      for (const SectionKey& key : row->keys) {
        if (!key.is_numbered()) names.push_back(key.name);
      }
    }
    const std::string key{most_similar(entry.key, names)};
    if (!key.empty() && !text_.find_entry(*section_, key)) {
      add(fmt::format("Change {} to {}", entry.key, key), {RenamePart{title, std::string{entry.key}, key}});
    }
    add(fmt::format("Remove {}", entry.key), {RemovePart{title, std::string{entry.key}}});
  }

  void add_identity(const IniEntry& entry) {
    const std::uint8_t sub_index = one_.rule == AnyRule{"vendor-number"}     ? 1
                                   : one_.rule == AnyRule{"product-number"}  ? 2
                                   : one_.rule == AnyRule{"revision-number"} ? 3
                                                                             : 0;
    const Entry* const identity = sub_index != 0 && sheet_.device ? sheet_.device->find(0x1018, sub_index) : nullptr;
    if (identity == nullptr || !identity->default_value || section_->name.kind != SectionKind::device_info) return;
    const std::string value = spelled_like(identity->default_value->bits, strip_inline_comment(entry.value));
    add(fmt::format("Change to {}, the value of {}", value, entry_label(0x1018, sub_index)),
        {SetValue{std::string{section_->title}, std::string{entry.key}, value}});
  }

  const OpenSheet& sheet_;
  const Diagnostic& one_;
  const SheetText& text_;
  const TextSection* section_;
  Json fixes_ = Json::array();
};

}  // namespace

Json finding_json(const OpenSheet& sheet, const Diagnostic& one, const SheetText* text) {
  const bool is_here = one.position.file == sheet.source.get() && one.position.line > 0;
  const TextSection* const section = is_here && text != nullptr ? section_at(*text, one.position.line) : nullptr;
  const bool is_object = section != nullptr && is_object_section(section->name.kind);
  std::string message = one.message;
  if (one.places > 1) message += fmt::format(" (at {} places)", one.places);
  return {{"severity", to_string(one.severity)},
          {"rule", one.rule.text()},
          {"message", std::move(message)},
          {"line", is_here ? one.position.line : 0},
          {"section", section == nullptr ? std::string_view{} : section->title},
          {"object", is_object ? fmt::format("{:04X}", section->name.index) : ""},
          {"fixes", section == nullptr ? Json::array() : Fixes{sheet, one, *text}.run()}};
}

void add_findings(const OpenSheet& sheet, SheetParts& parts) {
  const SheetText text{*sheet.source};
  const std::vector<Diagnostic>& all = sheet.diagnostics.all();
  Json list = Json::array();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    for (const Diagnostic& one : all) {
      if (one.severity != severity || list.size() == max_findings) continue;
      Json finding = finding_json(sheet, one, &text);
      finding["id"] = list.size();
      list.push_back(std::move(finding));
    }
  }
  const std::size_t total = sheet.diagnostics.errors() + sheet.diagnostics.warnings() + sheet.diagnostics.notes();
  const std::size_t more = total - std::min(total, list.size());
  parts.set("findings", {{"errors", sheet.diagnostics.errors()},
                         {"warnings", sheet.diagnostics.warnings()},
                         {"list", std::move(list)},
                         {"more", more}});
}

}  // namespace edsc::edit

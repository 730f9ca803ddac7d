#include "diagnostics/allowances.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace edsc {
namespace {

using Kind = AllowanceScope::Kind;

bool is_before(const SheetPart& a, const SheetPart& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

}  // namespace

void Allowances::set_outline(SheetOutline outline) {
  outline_ = std::move(outline);
  std::ranges::stable_sort(outline_.parts, is_before);
  std::ranges::stable_sort(outline_.lines, is_before);
}

void Allowances::add(Allowance allowance) {
  places_.emplace(Key{allowance.rule, allowance.scope}, all_.size());
  all_.push_back(std::move(allowance));
}

std::optional<std::size_t> Allowances::find(RuleId rule, const Position& position) const {
  if (all_.empty() || position.file != outline_.file) return std::nullopt;
  if (position.line != 0) {
    if (const auto found = find(rule, AllowanceScope{Kind::line, position.line})) return found;
    const auto line = std::ranges::lower_bound(outline_.lines, position.line, {}, &SheetPart::line);
    if (line != outline_.lines.end() && line->line == position.line) {
      if (const auto found = find_object(rule, *line)) return found;
    }
    const auto next = std::ranges::upper_bound(outline_.parts, SheetPart{position.line, position.column}, is_before);
    if (next != outline_.parts.begin()) {
      const SheetPart& part = *std::prev(next);
      if (const auto found = find(rule, AllowanceScope{Kind::part, part.line})) return found;
      if (const auto found = find_object(rule, part)) return found;
    }
  }
  return find(rule, AllowanceScope{});
}

std::optional<std::size_t> Allowances::find(RuleId rule, const AllowanceScope& scope) const {
  const auto found = places_.find(Key{rule, scope});
  return found == places_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<std::size_t> Allowances::find_object(RuleId rule, const SheetPart& part) const {
  if (!part.index) return std::nullopt;
  if (part.sub_index) {
    if (const auto found = find(rule, AllowanceScope{Kind::entry, 0, *part.index, *part.sub_index})) return found;
  }
  return find(rule, AllowanceScope{Kind::object, 0, *part.index});
}

}  // namespace edsc

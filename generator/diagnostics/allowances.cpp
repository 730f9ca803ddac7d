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

/// The part that contains a position, or null.
const SheetPart* part_at(const SheetOutline& outline, const Position& position) {
  const auto next = std::ranges::upper_bound(outline.parts, SheetPart{position.line, position.column}, is_before);
  return next == outline.parts.begin() ? nullptr : &*std::prev(next);
}

/// A line that describes another object than its part, or null.
const SheetPart* line_at(const SheetOutline& outline, const Position& position) {
  const auto line = std::ranges::lower_bound(outline.lines, position.line, {}, &SheetPart::line);
  return line != outline.lines.end() && line->line == position.line ? &*line : nullptr;
}

}  // namespace

std::optional<std::uint16_t> object_at(const SheetOutline& outline, const Position& position) {
  if (position.file != outline.file || position.line == 0) return std::nullopt;
  if (const SheetPart* const line = line_at(outline, position)) return line->index;
  const SheetPart* const part = part_at(outline, position);
  return part == nullptr ? std::nullopt : part->index;
}

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
    if (const SheetPart* const line = line_at(outline_, position)) {
      if (const auto found = find_object(rule, *line)) return found;
    }
    if (const SheetPart* const part = part_at(outline_, position)) {
      if (const auto found = find(rule, AllowanceScope{Kind::part, part->line})) return found;
      if (const auto found = find_object(rule, *part)) return found;
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

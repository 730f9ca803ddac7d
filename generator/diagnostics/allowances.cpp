#include "diagnostics/allowances.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace edsc {
namespace {

using Kind = AllowanceScope::Kind;

AllowanceScope at_line(Kind kind, std::uint32_t line) {
  AllowanceScope scope;
  scope.kind = kind;
  scope.line = line;
  return scope;
}

bool is_before(const SheetPart& a, const SheetPart& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

}  // namespace

std::size_t Allowances::KeyHash::operator()(const Key& key) const {
  const AllowanceScope& scope = key.scope;
  const std::uint64_t place = (std::uint64_t{scope.line} << 32U) | (std::uint64_t{scope.index} << 16U) |
                              (std::uint64_t{scope.sub_index} << 8U) | static_cast<std::uint64_t>(scope.kind);
  return std::hash<std::string_view>{}(key.rule) ^ (std::hash<std::uint64_t>{}(place)*31U);
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

std::optional<std::size_t> Allowances::find(std::string_view rule, const Position& position) const {
  if (all_.empty() || position.file != outline_.file) return std::nullopt;
  if (position.line != 0) {
    if (const auto found = find(rule, at_line(Kind::line, position.line))) return found;
    const auto line = std::ranges::lower_bound(outline_.lines, position.line, {}, &SheetPart::line);
    if (line != outline_.lines.end() && line->line == position.line) {
      if (const auto found = find_object(rule, *line)) return found;
    }
    SheetPart place;
    place.line = position.line;
    place.column = position.column;
    const auto next = std::ranges::upper_bound(outline_.parts, place, is_before);
    if (next != outline_.parts.begin()) {
      const SheetPart& part = *std::prev(next);
      if (const auto found = find(rule, at_line(Kind::part, part.line))) return found;
      if (const auto found = find_object(rule, part)) return found;
    }
  }
  return find(rule, AllowanceScope{});
}

std::optional<std::size_t> Allowances::find(std::string_view rule, const AllowanceScope& scope) const {
  const auto found = places_.find(Key{std::string{rule}, scope});
  return found == places_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<std::size_t> Allowances::find_object(std::string_view rule, const SheetPart& part) const {
  if (!part.index) return std::nullopt;
  AllowanceScope scope;
  scope.index = *part.index;
  if (part.sub_index) {
    scope.kind = Kind::entry;
    scope.sub_index = *part.sub_index;
    if (const auto found = find(rule, scope)) return found;
    scope.sub_index = 0;
  }
  scope.kind = Kind::object;
  return find(rule, scope);
}

}  // namespace edsc

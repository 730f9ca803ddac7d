#include "diagnostics/consequences.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "rules/cause_rows.hpp"

namespace edsc {
namespace {

using Indices = std::vector<std::size_t>;

/// The findings of one file by their rules.
std::map<RuleId, Indices> findings_by_rule(const Diagnostics& diagnostics, const SourceFile& file) {
  std::map<RuleId, Indices> rules;
  for (std::size_t at = 0; at < diagnostics.all().size(); ++at) {
    const Diagnostic& one = diagnostics.all()[at];
    if (one.position.file == &file) rules[one.rule].push_back(at);
  }
  return rules;
}

const Indices& findings_of(const std::map<RuleId, Indices>& rules, RuleId rule) {
  static const Indices none;
  const auto found = rules.find(rule);
  return found == rules.end() ? none : found->second;
}

/// The objects of all places of a finding; empty if one is not that of an object.
std::set<std::uint16_t> objects_of(const Diagnostic& finding, const SheetOutline& outline) {
  std::set<std::uint16_t> objects;
  const auto add = [&](const Position& position) {
    const auto index = object_at(outline, position);
    if (index) objects.insert(*index);
    return index.has_value();
  };
  bool all = add(finding.position) && finding.unnamed == 0;
  // Without further places the notes are related positions.
  if (finding.places > 1) {
    for (const Note& note : finding.notes) all = all && add(note.position);
  }
  return all ? objects : std::set<std::uint16_t>{};
}

class Marker {
 public:
  Marker(Diagnostics& diagnostics, const SheetOutline& outline)
      : diagnostics_{diagnostics}, outline_{outline}, rules_{findings_by_rule(diagnostics, *outline.file)} {}

  void apply(const CauseRow& row) {
    for (const std::size_t cause : findings_of(rules_, row.cause)) {
      if (at(cause).severity < row.min_severity) continue;
      // What is itself a consequence passes its own on to its cause.
      const std::size_t root = diagnostics_.all()[cause].follows_from.value_or(cause);
      for (const AnyRule rule : row.consequences) {
        for (const std::size_t one : findings_of(rules_, rule)) {
          if (one == root || at(one).follows_from || at(one).severity > at(root).severity) continue;
          if (row.reach == CauseReach::file || is_within(objects(one), objects(cause)))
            diagnostics_.set_cause(one, root);
        }
      }
    }
  }

 private:
  [[nodiscard]] const Diagnostic& at(std::size_t index) const { return diagnostics_.all()[index]; }

  const std::set<std::uint16_t>& objects(std::size_t index) {
    const auto [found, is_new] = objects_.try_emplace(index);
    if (is_new) found->second = objects_of(at(index), outline_);
    return found->second;
  }

  static bool is_within(const std::set<std::uint16_t>& some, const std::set<std::uint16_t>& all) {
    return !some.empty() && std::ranges::includes(all, some);
  }

  Diagnostics& diagnostics_;
  const SheetOutline& outline_;
  std::map<RuleId, Indices> rules_;
  std::map<std::size_t, std::set<std::uint16_t>> objects_;  ///< of findings whose objects were needed
};

}  // namespace

bool needs_outline(const Diagnostics& diagnostics, const SourceFile& file) {
  const std::map<RuleId, Indices> rules = findings_by_rule(diagnostics, file);
  return std::ranges::any_of(cause_rows(), [&](const CauseRow& row) {
    return row.reach == CauseReach::object && !findings_of(rules, row.cause).empty() &&
           std::ranges::any_of(row.consequences, [&](AnyRule rule) { return !findings_of(rules, rule).empty(); });
  });
}

void mark_consequences(Diagnostics& diagnostics, const SheetOutline& outline) {
  if (outline.file == nullptr) return;
  Marker marker{diagnostics, outline};
  for (const CauseRow& row : cause_rows()) marker.apply(row);
}

}  // namespace edsc

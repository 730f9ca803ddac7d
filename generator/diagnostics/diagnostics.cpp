#include "diagnostics/diagnostics.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace edsc {

void Diagnostic::add_place(const Position& place, std::string text) {
  ++places;
  if (places > max_stored_places) {
    ++unnamed;
  } else {
    notes.push_back({place, std::move(text)});
  }
}

void Diagnostics::report(Diagnostic diagnostic) {
  const bool is_name = diagnostic.rule.row().is_of_names;
  if (diagnostic.severity == Severity::note && (notes_ == Notes::none || (notes_ == Notes::of_names && !is_name)))
    return;
  if (is_tolerated(diagnostic)) diagnostic.severity = Severity::warning;
  if (diagnostic.severity != Severity::error || silence_errors_) {
    const Severity severity = diagnostic.severity;
    if (drop_silenced(diagnostic) || set_aside(diagnostic)) {
      any_silenced_ = any_silenced_ || severity != Severity::note;
      return;
    }
  }
  if (diagnostic.severity == Severity::note && is_name && notes_ == Notes::without_names) return;
  if (strict_ && diagnostic.severity == Severity::warning) {
    diagnostic.severity = Severity::error;
  }
  const Kind kind{diagnostic.position.file, diagnostic.rule, diagnostic.severity};
  if (join(kind, diagnostic)) return;
  ++counts_[diagnostic.severity];
  Tally& tally = tallies_[kind];
  ++tally.found;
  if (tally.found <= max_per_rule) {
    tally.last_listed = all_.size();
    all_.push_back(std::move(diagnostic));
    return;
  }
  if (tally.found == max_per_rule + 1) {
    tally.omitted_row = omitted_.size();
    omitted_.push_back({kind.file, kind.rule, kind.severity, 0, tally.last_listed});
  }
  ++omitted_[tally.omitted_row].count;
}

void Diagnostics::offer(Remedy remedy) {
  const bool is_unwanted = std::ranges::find(silenced_, remedy.rule, &Silenced::rule) != silenced_.end() ||
                           allowances_.find(remedy.rule, remedy.place).has_value();
  if (collects_remedies_ && !is_unwanted) remedies_.push_back(std::move(remedy));
}

bool Diagnostics::join(const Kind& kind, Diagnostic& diagnostic) {
  if (diagnostic.cause.empty()) return false;
  const bool is_listed = tallies_[kind].found < max_per_rule;
  const auto [first, is_new] = first_of_cause_.try_emplace(
      Cause{kind, diagnostic.cause}, is_listed ? all_.size() : std::numeric_limits<std::size_t>::max());
  if (is_new) return false;
  if (first->second >= all_.size()) return true;
  all_[first->second].add_place(diagnostic.position, std::move(diagnostic.message));
  return true;
}

void Diagnostics::silence(RuleId rule) {
  const bool is_new = std::ranges::find(silenced_, rule, &Silenced::rule) == silenced_.end();
  if (is_new) silenced_.push_back({rule});
}

bool Diagnostics::has_silenced(RuleId rule) const {
  return std::ranges::any_of(silenced_, [&](const Silenced& one) { return one.rule == rule && one.has_fired; });
}

bool Diagnostics::counts_only(AnyRule rule, Severity severity, const SourceFile* file) const {
  const Severity listed_as = strict_ && severity == Severity::warning ? Severity::error : severity;
  const auto found = tallies_.find(Kind{file, rule, listed_as});
  return found != tallies_.end() && found->second.found >= max_per_rule;
}

bool Diagnostics::is_tolerated(const Diagnostic& diagnostic) const {
  return foreign_file_ != nullptr && diagnostic.severity == Severity::error &&
         diagnostic.position.file == foreign_file_ && !diagnostic.rule.row().is_fatal;
}

bool Diagnostics::drop_silenced(const Diagnostic& diagnostic) {
  bool is_silenced = false;
  for (Silenced& one : silenced_) {
    if (one.rule != diagnostic.rule) continue;
    is_silenced = one.has_fired = true;
  }
  return is_silenced;
}

bool Diagnostics::set_aside(Diagnostic& diagnostic) {
  const auto allowance = allowances_.find(diagnostic.rule, diagnostic.position);
  if (!allowance) return false;
  allowances_.count_finding(*allowance);
  ++suppressed_findings_;
  if (allowances_.all()[*allowance].findings <= max_per_rule)
    suppressed_.push_back({std::move(diagnostic), *allowance});
  return true;
}

}  // namespace edsc

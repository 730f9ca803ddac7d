#include "audit/findings.hpp"

#include <algorithm>

namespace edsc::audit {

Finding* Findings::count(const Subject& subject, const Moment& moment, std::int64_t excess) {
  if (silenced_.contains(subject.rule)) return nullptr;
  if (provocations_ && moment.has_time && provocations_->count(subject.rule, first_us_ + moment.us)) return nullptr;
  const auto found = findings_.find(subject);
  if (found == findings_.end() && findings_.size() >= max_findings) {
    ++not_listed_;
    return nullptr;
  }
  Finding& finding =
      found != findings_.end() ? found->second : findings_.emplace(subject, Finding{subject}).first->second;
  const bool is_first = finding.count++ == 0;
  if (finding.occurrences.size() < Finding::max_occurrences) finding.occurrences.push_back({moment.us, excess});
  if (!is_first && excess <= finding.excess) return nullptr;
  if (is_first) finding.first = moment;
  finding.worst = moment;
  finding.excess = excess;
  return &finding;
}

std::vector<const Finding*> Findings::in_order() const {
  std::vector<const Finding*> sorted;
  for (const auto& [subject, finding] : findings_) sorted.push_back(&finding);
  std::ranges::stable_sort(sorted, {}, [](const Finding* one) { return one->first.line; });
  return sorted;
}

std::vector<Provoked> Findings::provoked() const {
  return provocations_ ? provocations_->counted() : std::vector<Provoked>{};
}

std::size_t Findings::count(Severity severity) const {
  const auto has_severity = [severity](const auto& one) { return one.first.rule.row().severity == severity; };
  return static_cast<std::size_t>(std::ranges::count_if(findings_, has_severity));
}

}  // namespace edsc::audit

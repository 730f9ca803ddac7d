/// The findings of an audit, one for each rule and subject, however often it occurs.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "audit/audit_rules.hpp"
#include "audit/provocations.hpp"

namespace edsc::audit {

/// A frame in the log.
struct Moment {
  std::size_t line = 0;  ///< or packet, from 1
  bool has_time = false;
  std::int64_t us = 0;  ///< since the first frame
};

/// What a finding is about; members that do not apply are 0.
struct Subject {
  AuditRule rule;
  std::uint8_t node_id = 0;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint32_t can_id = 0;  ///< or abort code
  bool extended = false;
  friend auto operator<=>(const Subject&, const Subject&) = default;
};

/// When a finding occurred.
struct Occurrence {
  std::int64_t us = 0;
  std::int64_t excess = 0;
};

struct Finding {
  /// Maximum number of occurrences that are known one by one.
  static constexpr std::size_t max_occurrences = 512;

  Subject subject;
  Moment first = {}, worst = {};
  std::size_t count = 0;
  std::int64_t excess = 0;
  std::string expected = {}, seen = {};  ///< of the worst occurrence
  std::vector<Occurrence> occurrences = {};
};

class Findings {
 public:
  /// Maximum number of findings, so that the memory does not grow with the log; any more are counted.
  static constexpr std::size_t max_findings = 2000;

  void silence(RuleId rule) { silenced_.insert(rule); }

  /// What cases of `edsc conform` provoke is counted apart.
  void expect(Provocations provocations) { provocations_ = std::move(provocations); }
  /// The time of the first frame, as in the log.
  void begin_at(std::int64_t log_us) { first_us_ = log_us; }

  /// Counts an occurrence. `texts` returns what was expected and what was seen; it is called for the first occurrence
  /// and for those with more excess than all before.
  template <class Texts>
  void add(const Subject& subject, const Moment& moment, std::int64_t excess, Texts texts) {
    Finding* const finding = count(subject, moment, excess);
    if (finding != nullptr) std::tie(finding->expected, finding->seen) = texts();
  }

  /// In the order of their first occurrence.
  [[nodiscard]] std::vector<const Finding*> in_order() const;
  [[nodiscard]] std::size_t count(Severity severity) const;
  [[nodiscard]] std::size_t not_listed() const { return not_listed_; }
  /// What cases have provoked; empty without their report.
  [[nodiscard]] std::vector<Provoked> provoked() const;

 private:
  /// Null if the texts of an earlier occurrence remain.
  Finding* count(const Subject& subject, const Moment& moment, std::int64_t excess);

  std::map<Subject, Finding> findings_;
  std::set<RuleId> silenced_;
  std::size_t not_listed_ = 0;
  std::optional<Provocations> provocations_;
  std::int64_t first_us_ = 0;
};

}  // namespace edsc::audit

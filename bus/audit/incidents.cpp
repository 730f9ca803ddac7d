#include "audit/incidents.hpp"

#include <algorithm>

namespace edsc::audit {
namespace {

/// Rules whose excess is the time without a frame.
bool is_of_silence(RuleId rule) {
  constexpr AuditRule rules[] = {"heartbeat-late", "pdo-event-timer", "heartbeat-consumer", "sdo-timeout"};
  return std::ranges::find(rules, rule) != std::end(rules);
}

}  // namespace

std::span<const IncidentRow> incident_rows() {
  static const std::vector<IncidentRow> rows{
      {"log-gap", {"heartbeat-late",  "heartbeat-consumer", "pdo-event-timer",   "pdo-sync-cycle",      "pdo-state",
                   "sync-period",     "sync-counter",       "guarding-response", "guarding-toggle",     "nmt-state",
                   "nmt-reset",       "nmt-boot-up",        "node-lost",         "emcy-register-value", "sdo-command",
                   "sdo-unrequested", "sdo-unfinished",     "sdo-toggle",        "sdo-sequence",        "sdo-size",
                   "sdo-crc",         "sdo-timeout",        "sdo-gives-up",      "sdo-abort",           "lss-response",
                   "lss-mode",        "lss-timeout"}},
      {"node-lost",
       {"heartbeat-late", "pdo-event-timer", "pdo-sync-cycle", "sync-period", "guarding-response", "guarding-toggle",
        "nmt-state", "nmt-reset", "nmt-boot-up", "sdo-timeout", "sdo-gives-up", "sdo-abort", "sdo-unfinished",
        "sdo-command"}},
      {"sdo-gives-up", {"sdo-abort", "sdo-unrequested", "sdo-unfinished", "sdo-command", "sdo-timeout"}},
  };
  return rows;
}

bool Incidents::explains(const IncidentRow& row, const Finding& finding) const {
  const Subject& subject = finding.subject;
  if (!std::ranges::any_of(row.consequences, [&](const AuditRule& one) { return one == subject.rule; })) return false;
  const bool of_client = row.rule == AuditRule{"sdo-gives-up"};
  if (of_client && subject.rule == AuditRule{"sdo-abort"} && subject.can_id != timeout_abort) return false;
  if (finding.occurrences.size() != finding.count) return false;  // not all are known
  return std::ranges::all_of(finding.occurrences, [&](const Occurrence& one) {
    return std::ranges::any_of(incidents_, [&](const Incident& incident) {
      if (incident.rule != row.rule || (incident.node_id != 0 && incident.node_id != subject.node_id)) return false;
      if (one.us < incident.from_us) return false;
      // What was silent before the incident has been silent in it.
      if (is_of_silence(subject.rule)) return one.us - one.excess <= incident.until_us;
      return one.us <= incident.until_us;
    });
  });
}

std::vector<std::optional<std::size_t>> Incidents::causes_of(const std::vector<const Finding*>& findings) const {
  std::vector<std::optional<std::size_t>> causes(findings.size());
  for (const IncidentRow& row : incident_rows()) {
    for (std::size_t cause = 0; cause < findings.size(); ++cause) {
      if (findings[cause]->subject.rule != row.rule || causes[cause]) continue;
      const std::uint8_t node_id = findings[cause]->subject.node_id;
      for (std::size_t at = 0; at < findings.size(); ++at) {
        if (at == cause || causes[at]) continue;
        if (node_id != 0 && findings[at]->subject.node_id != node_id) continue;
        if (explains(row, *findings[at])) causes[at] = cause;
      }
    }
  }
  // A cause that follows from another one passes its consequences on.
  for (std::optional<std::size_t>& cause : causes) {
    while (cause && causes[*cause]) cause = causes[*cause];
  }
  return causes;
}

}  // namespace edsc::audit

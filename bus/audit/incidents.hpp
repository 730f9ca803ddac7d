/// Events in a log that cause findings of many rules: a gap, a lost node, a client that gives up. Each is one finding,
/// and those that follow from it are listed on demand.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "audit/findings.hpp"

namespace edsc::audit {

/// The abort code of a client whose time has passed.
inline constexpr auto timeout_abort = static_cast<std::uint32_t>(canopen::AbortCode::timeout);

/// An incident, and how long it can cause others.
struct Incident {
  AuditRule rule;
  std::uint8_t node_id = 0;  ///< 0: all nodes
  std::int64_t from_us = 0, until_us = 0;
};

/// A rule about incidents, and the rules of which findings follow from them.
struct IncidentRow {
  AuditRule rule;
  std::vector<AuditRule> consequences;
};

/// In the order in which causes are tried.
[[nodiscard]] std::span<const IncidentRow> incident_rows();

class Incidents {
 public:
  /// Maximum number of incidents, so that the memory does not grow with the log; findings of any more are not grouped.
  static constexpr std::size_t max_incidents = 4096;

  void add(const Incident& incident) {
    if (incidents_.size() < max_incidents) incidents_.push_back(incident);
  }

  /// The place in `findings` of the finding from which each one follows; empty where it does not follow from another.
  /// A finding follows from an incident if each of its occurrences is in the time of one.
  [[nodiscard]] std::vector<std::optional<std::size_t>> causes_of(const std::vector<const Finding*>& findings) const;

 private:
  [[nodiscard]] bool explains(const IncidentRow& row, const Finding& finding) const;

  std::vector<Incident> incidents_;
};

}  // namespace edsc::audit

#include "conform/provocations.hpp"

#include <algorithm>

namespace edsc::conform {
namespace {

/// Whether an id is one of those in the text.
bool contains_id(std::string_view ids, std::string_view id) {
  while (!ids.empty()) {
    const std::size_t end = std::min(ids.find(' '), ids.size());
    if (ids.substr(0, end) == id) return true;
    ids.remove_prefix(std::min(end + 1, ids.size()));
  }
  return false;
}

}  // namespace

std::span<const Provocation> provocations() {
  static const Provocation rows[] = {
      {"sdo-abort",
       "start 2.3 2.4 2.5 2.6 2.7 2.8 2.9 2.10 2.11 2.14 2.15 2.16 2.17 2.18 2.19 2.20 2.21 2.22 2.23 2.24 2.25 2.26 "
       "2.27 2.28 2.29 2.30 2.101 2.102 2.103 2.104 2.106 2.108 2.109 2.111 3.1 3.2 3.3 3.9 3.15 3.22 3.23 3.24 3.25 3.26 3.28 3.29 3.31 "
       "3.32 3.108 3.109 3.110 3.111 4.1 4.3 4.4 4.5 4.6 4.7 4.10 4.11 4.12 5.3 5.7 5.107 5.109 6.5 6.9 6.102 6.103 7.104 8.1 8.3 "
       "8.5 8.7 8.9 8.10 9.4",
       "requests that the device must or may refuse, and transfers that the test ends"},
      {"sdo-command", "2.7 2.101 2.102 2.103 2.104", "an unknown command specifier, and segments without a transfer"},
      {"sdo-toggle", "2.14 2.15 2.17", "a segment with the wrong toggle bit"},
      {"sdo-crc", "2.24 2.25", "a block with a wrong CRC"},
      {"sdo-sequence", "2.27", "the confirmation of a segment that was not sent"},
      {"sdo-gives-up", "9.4", "a request to a device in Stopped, which does not answer"},
      {"sdo-length", "2.105", "requests of less than 8 bytes"},
      {"sdo-unfinished", "2.106 2.107", "a new transfer before the end of the previous one"},
      {"pdo-length", "3.104 5.101 5.108 5.109", "an RPDO that is too short"},
      {"can-id-unknown", "3.106", "an RPDO that is disabled"},
      {"node-unknown", "5.102 5.108 5.109 7.105 7.106 7.107 7.108 9.101 11.12",
       "heartbeats of a node that the test simulates, and a new node-ID"},
      {"nmt-reset", "8.2 8.6 8.101 8.102 11.14", "a power cycle"},
      {"nmt-state", "9.101", "an error that may change the NMT state (1029h)"},
      {"pdo-event-timer", "5.108 5.109 9.101", "an error that may end Operational (1029h)"},
      {"nmt-command", "10.101 10.103", "NMT commands that are unknown or have another length"},
      {"lss-mode", "11.1 11.2 11.5", "commands to a slave that waits"},
      {"lss-refused", "11.9 11.10 11.11 11.13 11.15", "values that the slave must or may refuse"},
  };
  return rows;
}

std::vector<std::string_view> provoked_by(std::string_view case_id) {
  std::vector<std::string_view> rules;
  for (const Provocation& row : provocations()) {
    if (contains_id(row.cases, case_id)) rules.push_back(row.rule.text());
  }
  return rules;
}

}  // namespace edsc::conform

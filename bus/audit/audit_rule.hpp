/// The table of what an audit of a log finds, with severity and clause. A check names a row by its enumerator.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace edsc::audit {

enum class RuleId : std::uint8_t {
  pdo_event_timer,
  pdo_inhibit_time,
  pdo_sync_cycle,
  pdo_sync_window,
  pdo_not_requested,
  pdo_length,
  pdo_state,
  sync_period,
  sync_counter,
  sync_producers,
  heartbeat_late,
  heartbeat_early,
  heartbeat_consumer,
  guarding_toggle,
  guarding_response,
  nmt_command,
  nmt_state,
  nmt_boot_up,
  nmt_reset,
  stopped_service,
  emcy_length,
  emcy_cob_id,
  emcy_register,
  emcy_register_value,
  emcy_inhibit_time,
  emcy_not_reset,
  sdo_length,
  sdo_command,
  sdo_unrequested,
  sdo_unfinished,
  sdo_toggle,
  sdo_sequence,
  sdo_size,
  sdo_crc,
  sdo_timeout,
  sdo_abort,
  lss_response,
  lss_mode,
  lss_command,
  lss_refused,
  lss_timeout,
  bus_load,
  error_frame,
  frame_length,
  can_id_unknown,
  can_id_senders,
  node_unknown,
  node_silent,
  log_time,
  log_interface,
};

struct Rule {
  RuleId rule;
  std::string_view id;
  Severity severity;
  std::string_view meaning;
  std::string_view source;  ///< clause of a CiA document or standard, or "edsc"
  std::string_view advice;  ///< how it is judged, or what to look at
};

namespace rule_table {

inline constexpr auto note = Severity::note;
inline constexpr auto error = Severity::error;
inline constexpr auto warning = Severity::warning;

inline constexpr Rule rows[] = {
    {RuleId::pdo_event_timer, "pdo-event-timer", error, "a TPDO is sent later than its event timer allows",
     "CiA 301, 7.5.2.37", "sub-index 5 is a maximum distance for transmission types 254 and 255 in Operational"},
    {RuleId::pdo_inhibit_time, "pdo-inhibit-time", error, "a TPDO is sent again within its inhibit time",
     "CiA 301, 7.5.2.37", "sub-index 3 is a minimum distance for transmission types 254 and 255"},
    {RuleId::pdo_sync_cycle, "pdo-sync-cycle", error, "a synchronous TPDO is not sent after every n-th SYNC",
     "CiA 301, 7.5.2.37", "n is the transmission type, 1 to 240; the distance between two TPDOs is counted in SYNCs"},
    {RuleId::pdo_sync_window, "pdo-sync-window", error, "a synchronous TPDO is sent after the synchronous window",
     "CiA 301, 7.5.2.7", "for transmission types 0 to 240; the window 1007h of the node begins with SYNC"},
    {RuleId::pdo_not_requested, "pdo-not-requested", error, "an RTR-only TPDO is sent without a remote frame",
     "CiA 301, 7.5.2.37", "for transmission types 252 and 253"},
    {RuleId::pdo_length, "pdo-length", error, "a PDO does not have the length of its mapping", "CiA 301, 7.5.2.36",
     "a TPDO must have this length; an RPDO must not be shorter. Give the DCF, or log the configuration, too"},
    {RuleId::pdo_state, "pdo-state", error, "a node sends a PDO outside of Operational", "CiA 301, 7.3.2.2",
     "the state follows from commands, boot-up and heartbeats; 100 ms after a command both states are accepted"},
    {RuleId::sync_period, "sync-period", error, "SYNC does not have the period of its producer", "CiA 301, 7.5.2.6",
     "1006h of the node whose 1005h has bit 30; the first SYNC within a period, in Pre-operational and Operational"},
    {RuleId::sync_counter, "sync-counter", error, "wrong counter of SYNC", "CiA 301, 7.5.2.22",
     "1019h: without it SYNC has no data; with it a byte that counts from 1 to the overflow value"},
    {RuleId::sync_producers, "sync-producers", error, "two nodes are configured as producer of one SYNC",
     "CiA 301, 7.2.5", "bit 30 of 1005h of both"},
    {RuleId::heartbeat_late, "heartbeat-late", error, "a heartbeat is later than 1017h", "CiA 301, 7.5.2.20",
     "also a node that becomes silent before the end of the log"},
    {RuleId::heartbeat_early, "heartbeat-early", warning, "two heartbeats are closer than 1017h", "CiA 301, 7.5.2.20",
     "two nodes may have one node-ID; a heartbeat after an NMT command is not judged"},
    {RuleId::heartbeat_consumer, "heartbeat-consumer", warning,
     "a heartbeat consumer does not report a missing heartbeat with EMCY 8130h", "CiA 301, 7.5.2.19",
     "1016h of the consumer; it has 100 ms and its EMCY inhibit time to report"},
    {RuleId::guarding_toggle, "guarding-toggle", error, "wrong toggle bit in a response to node guarding",
     "CiA 301, 7.2.8.3.2.1", "it is 0 in the first response after a boot-up message, and alternates"},
    {RuleId::guarding_response, "guarding-response", error, "a node does not respond to node guarding",
     "CiA 301, 7.2.8.3.2.1", "within 100 ms; also a node that is not on the bus any more"},
    {RuleId::nmt_command, "nmt-command", error, "an unknown NMT command, or one of another length",
     "CiA 301, 7.2.8.3.1", "the master is at fault"},
    {RuleId::nmt_state, "nmt-state", error,
     "a node reports an unknown state, or one that does not follow from the NMT commands", "CiA 301, 7.3.2.2",
     "leaving Operational after an EMCY is accepted: 1029h; so is a self-starting node: 1F80h; the NMT "
     "master, 1F80h or --master, need not obey"},
    {RuleId::nmt_boot_up, "nmt-boot-up", error, "a node does not send a boot-up message after a reset command",
     "CiA 301, 7.3.2.2.1", "within 5 s; not of the NMT master: 1F80h or --master"},
    {RuleId::nmt_reset, "nmt-reset", error, "a node sends a boot-up message without a reset command",
     "CiA 301, 7.3.2.2.1", "it was on the bus before: a reset by its watchdog or its supply, or a second node"},
    {RuleId::stopped_service, "stopped-service", error, "a stopped node sends an EMCY or answers an SDO",
     "CiA 301, 7.3.2.2.4", "in Stopped only NMT and error control are active"},
    {RuleId::emcy_length, "emcy-length", error, "an EMCY does not have 8 bytes", "CiA 301, 7.2.7.3", ""},
    {RuleId::emcy_cob_id, "emcy-cob-id", error, "an EMCY of a node whose 1014h is missing, invalid or another CAN-ID",
     "CiA 301, 7.5.2.17", ""},
    {RuleId::emcy_register, "emcy-register", error, "an EMCY with an error, but bit 0 of the error register is 0",
     "CiA 301, 7.5.2.2", "the generic bit is mandatory: it is set while any error is present"},
    {RuleId::emcy_register_value, "emcy-register-value", error,
     "the value read from 1001h differs from the error register of the last EMCY", "CiA 301, 7.5.2.2", ""},
    {RuleId::emcy_inhibit_time, "emcy-inhibit-time", error, "an EMCY within the inhibit time 1015h",
     "CiA 301, 7.5.2.18", ""},
    {RuleId::emcy_not_reset, "emcy-not-reset", note, "an error that is not reset before the end of the log",
     "CiA 301, 7.2.7.1", "EMCY 00xxh or a boot-up message ends it"},
    {RuleId::sdo_length, "sdo-length", error, "an SDO frame does not have 8 bytes", "CiA 301, 7.2.4.3", ""},
    {RuleId::sdo_command, "sdo-command", error, "an SDO command that is unknown or does not fit the transfer",
     "CiA 301, 7.2.4.3", "also a response for another object"},
    {RuleId::sdo_unrequested, "sdo-unrequested", error, "an SDO response without a request", "CiA 301, 7.2.4.3",
     "two servers may have one node-ID, or the client gave up too early"},
    {RuleId::sdo_unfinished, "sdo-unfinished", error, "a new SDO transfer before the end of the previous one",
     "CiA 301, 7.2.4.3", "two clients may use one server"},
    {RuleId::sdo_toggle, "sdo-toggle", error, "wrong toggle bit in a segmented SDO transfer", "CiA 301, 7.2.4.3.4", ""},
    {RuleId::sdo_sequence, "sdo-sequence", error, "wrong sequence number in an SDO block transfer",
     "CiA 301, 7.2.4.3.10", "a frame that the log lost looks the same"},
    {RuleId::sdo_size, "sdo-size", error, "an SDO transfer of another length than announced", "CiA 301, 7.2.4.3.3", ""},
    {RuleId::sdo_crc, "sdo-crc", error, "wrong CRC of an SDO block transfer", "CiA 301, 7.2.4.3.16", ""},
    {RuleId::sdo_timeout, "sdo-timeout", error, "an SDO server does not answer in time", "CiA 301, 7.2.4.1",
     "--sdo-timeout; CiA 301 does not define it"},
    {RuleId::sdo_abort, "sdo-abort", note, "an aborted SDO transfer", "CiA 301, 7.2.4.3.17",
     "each abort code of an object is a finding"},
    {RuleId::lss_response, "lss-response", error, "an LSS response that does not fit the last request", "CiA 305, 3",
     ""},
    {RuleId::lss_mode, "lss-mode", error, "an LSS configuration or inquiry command outside of LSS configuration",
     "CiA 305, 3", "the state follows from the last switch state command in the log"},
    {RuleId::lss_command, "lss-command", error, "an unknown LSS command, or one without those that belong before it",
     "CiA 305, 3", "the parts of an LSS address are sent in their order"},
    {RuleId::lss_refused, "lss-refused", note, "an LSS slave rejects a command", "CiA 305, 3",
     "each command is a finding"},
    {RuleId::lss_timeout, "lss-timeout", error, "the LSS slave in the configuration state does not respond",
     "CiA 305, 3", "before the next request and within 100 ms; of a slave that has responded in this state"},
    {RuleId::bus_load, "bus-load", warning, "the bus load is above the limit", "edsc",
     "maximum over 100 ms at --bit-rate, with stuff bits; --max-load is the limit"},
    {RuleId::error_frame, "error-frame", error, "an error frame of the CAN controller", "ISO 11898-1, 10.4.4", ""},
    {RuleId::frame_length, "frame-length", error, "a SYNC, TIME, error control or LSS frame of another length",
     "CiA 301, 7.2", "nodes ignore it"},
    {RuleId::can_id_unknown, "can-id-unknown", note, "a CAN-ID that no known node uses", "CiA 301, 7.3.5", ""},
    {RuleId::can_id_senders, "can-id-senders", error, "two nodes send PDOs with one CAN-ID", "CiA 301, 7.2.2",
     "by the COB-IDs in force of both"},
    {RuleId::node_unknown, "node-unknown", note, "a node whose EDS is not given", "edsc", "--node"},
    {RuleId::node_silent, "node-silent", note, "a node of --node that does not send anything", "edsc", ""},
    {RuleId::log_time, "log-time", note, "the times of the log go back", "edsc",
     "by more than 100 ms: the clock was set, or two logs were joined; times before and after it are not compared"},
    {RuleId::log_interface, "log-interface", note, "frames of more than one interface", "edsc",
     "they are judged as those of one bus; --interface selects one"},
};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    if (static_cast<std::size_t>(rows[i].rule) != i) return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace rule_table

[[nodiscard]] constexpr const Rule& row_of(RuleId rule) { return rule_table::rows[static_cast<std::size_t>(rule)]; }

/// Returns the row with this id, or null.
[[nodiscard]] constexpr const Rule* find_rule(std::string_view id) {
  const auto* const at = std::ranges::find(rule_table::rows, id, &Rule::id);
  return at == std::end(rule_table::rows) ? nullptr : at;
}

}  // namespace edsc::audit

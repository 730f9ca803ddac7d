/// The rules of `edsc audit`: what an audit of a log finds, with severity and clause. A check names a row by its id.
#pragma once

#include "rules/rule.hpp"

namespace edsc::audit {
namespace rule_table {

using edsc::rule_table::error;
using edsc::rule_table::note;
using edsc::rule_table::warning;

/// `explanation`: how a log is checked, or what to look at.
constexpr Rule row(std::string_view id, Severity severity, std::string_view title, std::string_view source,
                   std::string_view explanation) {
  return {id, severity, title, source, severity, explanation};
}

inline constexpr Rule audit[] = {
    row("pdo-event-timer", error, "a TPDO is sent later than its event timer allows", "CiA 301, 7.5.2.37",
        "sub-index 5 is a maximum distance for transmission types 254 and 255 in Operational"),
    row("pdo-inhibit-time", error, "a TPDO is sent again within its inhibit time", "CiA 301, 7.5.2.37",
        "sub-index 3 is a minimum distance for transmission types 254 and 255"),
    row("pdo-sync-cycle", error, "a synchronous TPDO is not sent after every n-th SYNC", "CiA 301, 7.5.2.37",
        "n is the transmission type, 1 to 240; the distance between two TPDOs is counted in SYNCs"),
    row("pdo-sync-window", error, "a synchronous TPDO is sent after the synchronous window", "CiA 301, 7.5.2.7",
        "for transmission types 0 to 240; the window 1007h of the node begins with SYNC"),
    row("pdo-not-requested", error, "an RTR-only TPDO is sent without a remote frame", "CiA 301, 7.5.2.37",
        "for transmission types 252 and 253"),
    row("pdo-length", error, "a PDO does not have the length of its mapping", "CiA 301, 7.5.2.36",
        "a TPDO must have this length; an RPDO must not be shorter. Give the DCF, or log the configuration, too"),
    row("pdo-state", error, "a node sends a PDO outside of Operational", "CiA 301, 7.3.2.2",
        "the state follows from commands, boot-up and heartbeats; 100 ms after a command both states are accepted"),
    row("sync-period", error, "SYNC does not have the period of its producer", "CiA 301, 7.5.2.6",
        "1006h of the node whose 1005h has bit 30; the first SYNC within a period, in Pre-operational and Operational"),
    row("sync-counter", error, "wrong counter of SYNC", "CiA 301, 7.5.2.22",
        "1019h: without it SYNC has no data; with it a byte that counts from 1 to the overflow value"),
    row("sync-producers", error, "two nodes are configured as producer of one SYNC", "CiA 301, 7.2.5",
        "bit 30 of 1005h of both"),
    row("heartbeat-late", error, "a heartbeat is later than 1017h", "CiA 301, 7.5.2.20",
        "also a node that becomes silent before the end of the log"),
    row("heartbeat-early", warning, "two heartbeats are closer than 1017h", "CiA 301, 7.5.2.20",
        "two nodes may have one node-ID; a heartbeat after an NMT command is not checked"),
    row("heartbeat-consumer", warning, "a heartbeat consumer does not report a missing heartbeat with EMCY 8130h",
        "CiA 301, 7.5.2.19", "1016h of the consumer; it has 100 ms and its EMCY inhibit time to report"),
    row("guarding-toggle", error, "wrong toggle bit in a response to node guarding", "CiA 301, 7.2.8.3.2.1",
        "it is 0 in the first response after a boot-up message, and alternates"),
    row("guarding-response", error, "a node does not respond to node guarding", "CiA 301, 7.2.8.3.2.1",
        "within 100 ms; also a node that is not on the bus any more"),
    row("nmt-command", error, "an unknown NMT command, or one of another length", "CiA 301, 7.2.8.3.1",
        "the NMT master sent it"),
    row("nmt-state", error, "a node reports an unknown state, or one that does not follow from the NMT commands",
        "CiA 301, 7.3.2.2",
        "leaving Operational after an EMCY is accepted: 1029h; so is a self-starting node: 1F80h; the NMT "
        "master, 1F80h or --master, is exempt"),
    row("nmt-boot-up", error, "a node does not send a boot-up message after a reset command", "CiA 301, 7.3.2.2.1",
        "within 5 s; not of the NMT master: 1F80h or --master"),
    row("nmt-reset", error, "a node sends a boot-up message without a reset command", "CiA 301, 7.3.2.2.1",
        "it was on the bus before: a reset by its watchdog or its supply, or a second node"),
    row("stopped-service", error, "a stopped node sends an EMCY or answers an SDO", "CiA 301, 7.3.2.2.4",
        "in Stopped only NMT and error control are active"),
    row("emcy-length", error, "an EMCY does not have 8 bytes", "CiA 301, 7.2.7.3", ""),
    row("emcy-cob-id", error, "an EMCY of a node whose 1014h is missing, invalid or another CAN-ID",
        "CiA 301, 7.5.2.17", ""),
    row("emcy-register", error, "an EMCY with an error, but bit 0 of the error register is 0", "CiA 301, 7.5.2.2",
        "the generic bit is mandatory: it is set while any error is present"),
    row("emcy-register-value", error, "the value read from 1001h differs from the error register of the last EMCY",
        "CiA 301, 7.5.2.2", ""),
    row("emcy-inhibit-time", error, "an EMCY within the inhibit time 1015h", "CiA 301, 7.5.2.18", ""),
    row("emcy-not-reset", note, "an error that is not reset before the end of the log", "CiA 301, 7.2.7.1",
        "EMCY 00xxh or a boot-up message ends it"),
    row("sdo-length", error, "an SDO frame does not have 8 bytes", "CiA 301, 7.2.4.3", ""),
    row("sdo-command", error, "an SDO command that is unknown or does not fit the transfer", "CiA 301, 7.2.4.3",
        "also a response for another object"),
    row("sdo-unrequested", error, "an SDO response without a request", "CiA 301, 7.2.4.3",
        "two servers may have one node-ID, or the client gave up too early"),
    row("sdo-unfinished", error, "a new SDO transfer before the end of the previous one", "CiA 301, 7.2.4.3",
        "two clients may use one server"),
    row("sdo-toggle", error, "wrong toggle bit in a segmented SDO transfer", "CiA 301, 7.2.4.3.4", ""),
    row("sdo-sequence", error, "wrong sequence number in an SDO block transfer", "CiA 301, 7.2.4.3.10",
        "a frame that the log lost looks the same"),
    row("sdo-size", error, "an SDO transfer of another length than announced", "CiA 301, 7.2.4.3.3", ""),
    row("sdo-crc", error, "wrong CRC of an SDO block transfer", "CiA 301, 7.2.4.3.16", ""),
    row("sdo-timeout", error, "an SDO server does not answer in time", "CiA 301, 7.2.4.1",
        "--timeout; CiA 301 does not define it"),
    row("sdo-abort", note, "an aborted SDO transfer", "CiA 301, 7.2.4.3.17",
        "each abort code of an object is a finding"),
    row("lss-response", error, "an LSS response that does not fit the last request", "CiA 305, 3", ""),
    row("lss-mode", error, "an LSS configuration or inquiry command outside of LSS configuration", "CiA 305, 3",
        "the state follows from the last switch state command in the log"),
    row("lss-command", error, "unknown LSS command, or the preceding parts of an LSS address are missing", "CiA 305, 3",
        "the parts of an LSS address are sent in their order"),
    row("lss-refused", note, "an LSS slave rejects a command", "CiA 305, 3", "each command is a finding"),
    row("lss-timeout", error, "the LSS slave in the configuration state does not respond", "CiA 305, 3",
        "before the next request and within 100 ms; of a slave that has responded in this state"),
    row("bus-load", warning, "the bus load is above the limit", "edsc",
        "maximum over 100 ms at --bit-rate, with stuff bits; --max-load is the limit"),
    row("error-frame", error, "an error frame of the CAN controller", "ISO 11898-1, 10.4.4", ""),
    row("frame-length", error, "a SYNC, TIME, error control or LSS frame of another length", "CiA 301, 7.2",
        "nodes ignore it"),
    row("can-id-unknown", note, "a CAN-ID that no known node uses", "CiA 301, 7.3.5", ""),
    row("can-id-senders", error, "two nodes send PDOs with one CAN-ID", "CiA 301, 7.2.2",
        "by the COB-IDs in force of both"),
    row("node-unknown", note, "a node whose EDS is not given", "edsc", "--node"),
    row("node-silent", note, "a node that was given does not send anything", "edsc", ""),
    row("node-lost", error, "a node sends nothing any more", "CiA 301, 7.2.8.3.2.2",
        "for more than two and a half heartbeats; without an EDS by the distance of its last two heartbeats"),
    row("sdo-gives-up", warning, "an SDO client aborts a transfer because its time has passed", "CiA 301, 7.2.4.1",
        "abort code 0504 0000h of the client; give it more time if the response follows"),
    row("log-gap", warning, "a gap in the log: no node sends", "edsc",
        "all nodes with a heartbeat, two at least, miss two or more: frames were not recorded, or the bus was off"),
    row("log-time", note, "the times of the log go back", "edsc",
        "by more than 100 ms: the clock was set, or two logs were joined; times before and after it are not compared"),
    row("log-interface", note, "frames of more than one interface", "edsc",
        "they are checked as frames of one bus; --interface selects one"),
};

}  // namespace rule_table

inline constexpr std::span<const Rule> audit_rules{rule_table::audit};

using AuditRule = RuleOf<rule_table::audit>;

}  // namespace edsc::audit

/// The alarms of `edsc watch`: what a network file does not allow on its bus. The guard names a row by its id.
#pragma once

#include <array>

#include "rules/rule.hpp"

namespace edsc::watch {
namespace rule_table {

using edsc::rule_table::error;
using edsc::rule_table::warning;

/// `explanation`: how it is detected, and what to look at.
constexpr Rule row(std::string_view id, Severity severity, std::string_view title, std::string_view explanation) {
  return {id, severity, title, "edsc", severity, explanation};
}

inline constexpr Rule alarms[] = {
    row("can-id-unknown", error, "a frame with a CAN-ID that no node of the network sends",
        "also an RPDO, SYNC or TIME that nodes receive, if no node of the network sends it"),
    row("node-unknown", error, "a frame of, or for, a node-ID that the network file does not have",
        "EMCY, SDO and error control by the pre-defined connection set"),
    row("nmt-command", error, "an NMT command that the master of the network does not send in this state",
        "CAN frames do not state their sender. The master resets and starts nodes that boot, restart or are missing; it "
        "does not command a node that is Operational and sends its heartbeats"),
    row("lss-command", error, "an LSS frame", "the master of a network file does not use LSS"),
    row("sdo-write", error, "an SDO write that the network file does not state",
        "an object that is not in the configuration of the node, or any object while the node is Operational; --allow "
        "names objects that the application writes"),
    row("sdo-value", error, "an SDO write of a value other than the network file states",
        "an object of the configuration; invalid COB-IDs and empty mappings are allowed while PDOs are configured"),
    row("pdo-length", error, "a PDO of another length than its mapping", "by the configuration of the sender"),
    row("pdo-rate", error, "a PDO is sent more often than the network allows",
        "within half of the inhibit time, twice in a SYNC cycle, or for a longer time at more than 125 % of the rate of "
        "inhibit time or event timer, or of assume.event_ms: a second sender, or a value that changes too often"),
    row("pdo-missing", error, "a cyclic PDO is missing",
        "two in a row are not sent, with 50 ms for other frames; one that is lost is allowed"),
    row("pdo-state", error, "a PDO of a node that is not Operational",
        "200 ms after the boot-up message, command or heartbeat that ended Operational"),
    row("frame-length", error, "a SYNC, TIME, EMCY, SDO or heartbeat of another length", "nodes ignore it"),
    row("remote-frame", error, "a remote frame that no node of the network sends",
        "allowed for guarded nodes and for TPDOs of transmission types 252 and 253"),
    row("sync-rate", error, "SYNC is sent too early", "within half of the period: a second SYNC producer"),
    row("sync-missing", error, "SYNC is missing", "two in a row are not sent, with 50 ms for other frames"),
    row("node-missing", error, "a node is missing",
        "no heartbeat for the shortest consumer time of the network, or twice the producer time, and 10 %; no response "
        "to guarding for its life time; no heartbeat 30 s after a boot-up message or after the start"),
    row("node-restarted", error, "a node restarts without a command",
        "a boot-up message without a reset command in the last 10 s: supply, watchdog, or a second node with the node-ID"),
    row("node-state", error, "a node changes its NMT state without a command",
        "by its heartbeat: it leaves or enters Operational"),
    row("node-replaced", error, "a node is another device than the network file states",
        "a value of 1000h or 1018h that any client reads; the master reads them at each boot-up"),
    row("node-configuration", error, "a node has another configuration than the network file states",
        "a date or time of 1020h, or a value of the configuration while 1020h is right or the node is Operational, as "
        "any client reads them"),
    row("node-duplicate", error, "heartbeats of a node are too frequent",
        "more than 125 % of their rate: a second node with the node-ID, or another producer time"),
    row("bus-silent", error, "no node sends", "two nodes or more are missing, and no frame was received since"),
    row("bus-load", warning, "the bus load is above the limit of the network",
        "in a second, with stuff bits; max_load of the network file, or 80 %"),
};

}  // namespace rule_table

inline constexpr std::span<const Rule> alarm_rows{rule_table::alarms};

using AlarmId = RuleOf<rule_table::alarms>;

}  // namespace edsc::watch

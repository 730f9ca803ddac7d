#!/usr/bin/env python3
"""edsc network check: hostile network files, and settings and signals that meet each other; the examples have no findings, and
their load and response times are printed.

    network_check_test.py SOURCE_DIR EDSC

The expected findings are the rule and, where a position matters, its line and column, counted by hand.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import jsonschema

TEXTS = {  # name: (text, exit code, findings as (severity, rule, line, column))
    "null": ("null", 1, [("error", "network-file", 1, 1)]),
    "number_too_large": ('{"bit_rate": 1e999}', 1, [("error", "network-syntax", 1, 1)]),
    "value_out_of_range": ('{"bit_rate": -5, "nodes": {"m": {"node_id": 1, "master": true}}}', 1,
                           [("error", "network-file", 1, 14)]),
    "comment_with_slash": ('/*/ " */ { // "\n "x": 1, "bit_rate": 500,\n /**/ "nodes": {"m": {"node_id": 1, "master": true}}}', 1,
                           [("error", "network-file", 2, 2)]),
    "escape_in_a_name": ('{"bit_rate": 500, "a\\"b": 1, "nodes": {"m": {"node_id": 1, "master": true}}}', 1,
                         [("error", "network-file", 1, 19)]),
    "duplicate_member": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 2},\n "m": {"node_id": 1, "master": true}}}', 1,
                         [("error", "network-syntax", 2, 2)]),
    "duplicate_member_of_set": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true}, "a": {"node_id": 2, "eds": "node.eds", '
                                '"set": {"2006h": 1,\r\r "2006h": 1}}}}', 1, [("error", "network-syntax", 3, 2)]),
    "more_than_127_nodes": ('{"bit_rate": 500, "nodes": {' + ", ".join(f'"m{i}": {{"node_id": {i}, "master": true}}'
                                                                       for i in range(1, 128)) + ',\n "x": {}, "y": {}}}', 1,
                            [("error", "network-file", 2, 2)]),
    "name_with_line_end": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true},\n "a/b": {"node_id": 2, '
                           '"master": true}}}', 1, [("error", "network-file", 2, 2)]),
    "names_that_differ_in_case": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true}, "Axis": {"node_id": 2, "eds": "node.eds"},\n'
                                  ' "aXIS": {"node_id": 3, "eds": "node.eds"}}}', 1, [("error", "network-file", 2, 2)]),
    "name_that_changes_the_text_direction": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true},\n "a\\u202Eb": {"node_id": 2, '
                                             '"eds": "node.eds"}}}', 1, [("error", "network-file", 2, 2)]),
    "name_with_a_control_character": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true},\n "a\\u0085b": {"node_id": 2, '
                                      '"eds": "node.eds"}}}', 1, [("error", "network-file", 2, 2)]),
    "name_with_letters_of_another_script": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true}, "Ось": {"node_id": 2, '
                                            '"eds": "node.eds"}}}', 0, []),
    "node_id_of_an_eds": ('{"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true}, "a": {"node_id": 128, "eds": "node.eds"}}}',
                          1, [("error", "network-file", 1, 83)]),
    "reserved_overflow": ('{"bit_rate": 500, "sync": {"overflow": 1}, "nodes": {"m": {"node_id": 1, "master": true}}}', 1,
                          [("error", "network-file", 1, 40)]),
}


def signal(source: str, entry: str, *receivers: str, **timing: object) -> dict:
    return {"from": source, "object": entry, "to": list(receivers), **(timing or {"every_ms": 10})}


def network(*signals: dict, **nodes: dict) -> dict:
    slave = {"eds": "node.eds", "heartbeat_ms": 100}
    return {"bit_rate": 500, "sync": {"producer": "m", "period_us": 10000},
            "nodes": {"m": {"node_id": 127, "master": True}, "a": {"node_id": 1, **slave}, "b": {"node_id": 2, **slave},
                      "c": {"node_id": 3, **slave}, **nodes},
            "signals": list(signals)}


def sheet_with(section: str, default: str, text: str = "") -> str:
    """node.eds, or this text, with another DefaultValue of an entry."""
    text = text or (Path(__file__).parent / "node.eds").read_text(encoding="utf-8")
    return re.sub(rf"(\[{section}\][^\[]*DefaultValue=)\S*", rf"\g<1>{default}", text)


def wide_sheet(tpdos: int = 33) -> str:
    """A sheet with 255 bytes that can be mapped: 2000h:01 to 2000h:FE and 2001h."""
    text = (Path(__file__).parent / "node.eds").read_text(encoding="utf-8")
    start = "[DeviceInfo]" + text.split("[DeviceInfo]")[1].split("\n[")[0].replace("NrOfTXPDO", ";NrOfTXPDO")
    objects = ["2000", "2001"] + [f"{base + i:04X}" for base in (0x1800, 0x1A00) for i in range(tpdos)]
    lists = {"MandatoryObjects": ["1000", "1001", "1018"], "OptionalObjects": ["1017"] + objects[2:],
             "ManufacturerObjects": objects[:2]}
    parts = [start, f"NrOfTXPDO={tpdos}"]
    for name, members in lists.items():
        parts += [f"[{name}]", f"SupportedObjects={len(members)}"] + [f"{i}=0x{one}" for i, one in enumerate(members, 1)]

    def entry(section: str, name: str, kind: int, access: str, value: str, mapped: int = 0) -> None:
        parts.extend([f"[{section}]", f"ParameterName={name}", "ObjectType=0x7", f"DataType=0x{kind:04X}",
                      f"AccessType={access}", f"DefaultValue={value}", f"PDOMapping={mapped}"])

    def record(index: str, name: str, kind: int, count: int) -> None:
        parts.extend([f"[{index}]", f"ParameterName={name}", f"ObjectType=0x{kind}", f"SubNumber={count}"])

    entry("1000", "Device type", 7, "ro", "0")
    entry("1001", "Error register", 5, "ro", "0")
    entry("1017", "Producer heartbeat time", 6, "rw", "0")
    record("1018", "Identity object", 9, 2)
    entry("1018sub0", "Highest sub-index supported", 5, "const", "1")
    entry("1018sub1", "Vendor-ID", 7, "ro", "0x1")
    record("2000", "Bytes", 8, 255)
    entry("2000sub0", "Highest sub-index supported", 5, "const", "254")
    for sub in range(1, 255):
        entry(f"2000sub{sub:X}", f"Byte {sub}", 5, "ro", "0", 1)
    entry("2001", "Last byte", 5, "ro", "0", 1)
    for i in range(tpdos):
        communication, mapping = f"{0x1800 + i:04X}", f"{0x1A00 + i:04X}"
        record(communication, f"TPDO {i + 1} communication", 9, 4)
        entry(f"{communication}sub0", "Highest sub-index supported", 5, "const", "5")
        entry(f"{communication}sub1", "COB-ID", 7, "rw", "0x80000000")
        entry(f"{communication}sub2", "Transmission type", 5, "rw", "254")
        entry(f"{communication}sub5", "Event timer", 6, "rw", "0")
        record(mapping, f"TPDO {i + 1} mapping", 9, 9)
        entry(f"{mapping}sub0", "Highest sub-index supported", 5, "rw", "0")
        for sub in range(1, 9):
            entry(f"{mapping}sub{sub}", f"Entry {sub}", 7, "rw", "0")
    return "\n".join(parts) + "\n"


def wide(node_id: int) -> dict:
    return {"node_id": node_id, "eds": "wide.eds", "heartbeat_ms": 100}


def bytes_of_wide(count: int) -> list[str]:
    return [f"2000h:{sub:02X}" for sub in range(1, min(count, 254) + 1)] + ["2001h"] * (count > 254)


UNITS = {  # name of the node: the keys of 2000h and 2002h
    "v": ("Unit=V\nFactor=0.001", "Unit=V"), "mv": ("Unit=V", "Unit=mV"), "tenths": ("Unit=V", "Unit=V\nFactor=0.1"),
    "amps": ("Unit=A", "Unit=A\nFactor=0.001"), "plain": ("Unit=V", ""),
}
IN_UNITS = {name: {"node_id": 10 + i, "eds": f"{name}.eds", "heartbeat_ms": 100} for i, name in enumerate(UNITS)}


def sheet_in_units(sent: str, taken: str) -> str:
    """node.eds with other units of 2000h and 2002h."""
    text = (Path(__file__).parent / "node.eds").read_text(encoding="utf-8")
    for section, keys in (("2000", sent), ("2002", taken)):
        text = re.sub(rf"(\[{section}\][^\[]*)Unit=rpm", lambda found, keys=keys: found[1] + keys, text)
    return text


SPEED = ("a", "2000h", "b.2002h", "m")
NODE_A = {"node_id": 1, "eds": "node.eds", "heartbeat_ms": 100}
MASTER = {"node_id": 127, "master": True, "heartbeat_ms": 100}


def without_sync(value: dict) -> dict:
    return {name: member for name, member in value.items() if name != "sync"}


NETWORKS = {  # name: (network, errors and warnings as severity and rule)
    "one_sender_for_several_nodes": (network(signal("a", "2001h", "b.2003h", "c.2003h", "m")), []),
    "two_signals_set_one_entry": (network(signal("a", "2001h", "b.2003h"), signal("c", "2001h", "b.2003h")),
                                  [("warning", "network-signal")]),
    "granularity_that_the_mappings_of_the_sheet_contradict": (
        network(signal(*SPEED), signal("m", "b.2003h"), b={"node_id": 2, "eds": "coarse.eds", "heartbeat_ms": 100}),
        [("warning", "network-pdo-mapping")]),
    "bit_rate_that_no_sheet_has": ({**network(), "bit_rate": 100}, [("error", "network-bit-rate")]),
    "bit_rate_of_a_sheet": (
        {**network(**{one: {**NODE_A, "node_id": i, "eds": "rate_100.eds"} for i, one in enumerate("abc", 1)}), "bit_rate": 100},
        [("warning", "network-bit-rate")]),
    "event_false": (network(signal(*SPEED, event=False)), [("error", "network-file")]),
    "heartbeat_by_set": (network(a={"node_id": 1, "eds": "node.eds", "set": {"1017h": 200}}), []),
    "longest_heartbeat": (network(a={"node_id": 1, "eds": "node.eds", "heartbeat_ms": 65535}),
                          [("warning", "network-unmonitored")]),
    "timeout_too_short": (network(a={**NODE_A, "heartbeat_timeout_ms": 50}), [("error", "network-heartbeat")]),
    "timeout_of_a_master_with_a_file": (
        network(m={"node_id": 127, "master": True, "eds": "node.eds"}, a={**NODE_A, "heartbeat_timeout_ms": 500}),
        [("error", "network-value")] + [("warning", "network-unmonitored")]),
    "configured_pdo_is_not_changed": (
        network(signal(*SPEED),
                a={**NODE_A, "set": {"1A00h:00": 1, "1A00h:01": "0x20010020", "1800h:01": "0x1A5", "1800h:05": 10}}), []),
    "configured_pdo_is_used": (
        network(signal(*SPEED),
                a={**NODE_A, "set": {"1A00h:00": 1, "1A00h:01": "0x20000010", "1800h:01": "0x1A5"}}), []),
    "configured_link_of_another_node": (
        network(signal("m", "b.2003h"),
                b={"node_id": 2, "eds": "node.eds", "heartbeat_ms": 100,
                   "set": {"1400h:01": "0x1A5", "1600h:00": 1, "1600h:01": "0x20030020"}},
                c={"node_id": 3, "eds": "node.eds", "heartbeat_ms": 100,
                   "set": {"1800h:01": "0x1A5", "1800h:05": 10, "1A00h:00": 1, "1A00h:01": "0x20010020"}}), []),
    "default_can_id_of_another_node": (
        network(signal("m", "d.2002h"), signal("m", "d.2003h"),
                c={"node_id": 3, "eds": "node.eds", "heartbeat_ms": 100, "set": {"1800h:01": "0x204", "1800h:05": 10}},
                d={"node_id": 4, "eds": "valid.eds", "heartbeat_ms": 100}), []),
    "value_and_signal_disagree": (network(signal(*SPEED), a={**NODE_A, "set": {"1800h:05": 20}}), [("error", "network-signal")]),
    "two_values_of_an_entry": (network(a={**NODE_A, "set": {"2006h": 20, "ramp": 30}}), [("error", "network-value")]),
    "two_heartbeat_times": (network(a={**NODE_A, "set": {"1017h": 200}}), [("error", "network-value")]),
    "receiver_with_a_can_id": (network(signal(*SPEED), b={**NODE_A, "node_id": 2, "set": {
        "1400h:01": "0x181", "1600h:00": 1, "1600h:01": "0x20020010"}}), []),
    "receiver_with_a_can_id_of_29_bits": (network(signal(*SPEED), b={**NODE_A, "node_id": 2, "set": {
        "1400h:01": "0x20012345", "1600h:00": 1, "1600h:01": "0x20020010"}}), []),
    "two_can_ids_of_time": (network(a={**NODE_A, "set": {"1012h": "0x400001F0"}},
                                    b={**NODE_A, "node_id": 2, "set": {"1012h": "0x800001F1"}}), [("warning", "network-time")]),
    "window_of_all_nodes": ({**network(), "sync": {"producer": "m", "period_us": 10000, "window_us": 10001}},
                            [("error", "network-sync-window")]),
    "inhibit_time_longer_than_the_event_timer": (network(signal(*SPEED), a={**NODE_A, "set": {"1800h:03": 101}}),
                                                 [("warning", "pdo-inhibit-time")]),
    "inhibit_time_of_the_sheet_longer_than_the_event_timer": (
        network(signal("d", "2000h", "m"), d={"node_id": 4, "eds": "slow.eds", "heartbeat_ms": 100}),
        [("warning", "pdo-inhibit-time")]),
    "inhibit_time_of_a_signal": (network(signal(*SPEED, every_ms=10, inhibit_time_us=2500)), []),
    "inhibit_time_of_a_signal_of_the_master": (network(signal("m", "a.2002h", event=True, inhibit_time_us=10000)), []),
    "inhibit_time_of_a_signal_in_no_step": (network(signal(*SPEED, every_ms=10, inhibit_time_us=2550)), [("error", "network-signal")]),
    "inhibit_time_of_a_signal_longer_than_its_interval": (network(signal(*SPEED, every_ms=10, inhibit_time_us=10100)),
                                                          [("warning", "pdo-inhibit-time")]),
    "inhibit_time_of_a_synchronous_signal": (network(signal(*SPEED, every_sync=1, inhibit_time_us=100)), [("error", "network-file")]),
    "inhibit_time_and_value_disagree": (
        network(signal(*SPEED, every_ms=10, inhibit_time_us=2500), a={**NODE_A, "set": {"1800h:03": 24}}),
        [("error", "network-signal")]),
    **{f"event_timer_of_{ms}_ms_for_a_signal_{name}": (network(signal(*SPEED, **timing), b={**NODE_A, "node_id": 2, "set": {"1400h:05": ms}}),
                                                      [(severity, "network-pdo-timer")] if severity else [])
       for name, timing, ms, severity in (
           ("every_10_ms", {"every_ms": 10}, 10, "error"), ("every_10_ms", {"every_ms": 10}, 11, ""),
           ("of_3_cycles_of_10_ms", {"every_sync": 3}, 30, "error"), ("of_3_cycles_of_10_ms", {"every_sync": 3}, 31, ""),
           ("at_events", {"event": True}, 1000, "warning"), ("every_10_ms", {"every_ms": 10}, 0, ""))},
    "name_of_a_signal": (network(signal(*SPEED, every_ms=10, name="motor_speed")), []),
    "name_of_a_signal_in_camel_case": (network(signal(*SPEED, every_ms=10, name="MotorSpeed")), [("error", "network-signal")]),
    "two_signals_with_one_name": (
        network(signal(*SPEED, every_ms=10, name="speed"), signal("c", "2000h", "m", every_ms=10, name="speed")),
        [("error", "network-signal")]),
    "unit_of_a_signal_as_in_the_sheets": (network(signal("v", "2000h", "plain.2002h", "m", every_ms=10, unit="mV"), **IN_UNITS), []),
    "unit_of_a_signal_that_differs_from_the_sender": (
        network(signal("v", "2000h", "plain.2002h", every_ms=10, unit="0.01 V"), **IN_UNITS), [("error", "network-signal")]),
    "unit_of_a_signal_that_differs_from_a_receiver": (
        network(signal("v", "2000h", "plain.2002h", "tenths.2002h", every_ms=10, unit="mV"), **IN_UNITS),
        [("error", "network-signal")]),
    "unit_of_a_signal_that_is_unknown": (network(signal(*SPEED, every_ms=10, unit="0.1 knots")), [("error", "network-signal")]),
    "unit_of_a_signal_with_a_scale_of_0": (network(signal(*SPEED, every_ms=10, unit="0 V")), [("error", "network-signal")]),
    "dbc_file": ({**network(signal(*SPEED)), "dbc": "speed.dbc"}, []),
    "dbc_file_with_another_can_id": ({**network(signal(*SPEED)), "dbc": "other.dbc"}, [("warning", "network-signal")]),
    "dbc_file_without_messages": ({**network(signal(*SPEED)), "dbc": "node.eds"}, [("error", "network-file")]),
    "dbc_file_that_does_not_exist": ({**network(signal(*SPEED)), "dbc": "missing.dbc"}, [("error", "network-file")]),
    "unused_pdo_that_is_disabled": (
        {**without_sync(network(a={**NODE_A, "eds": "synchronous.eds"})), "disable_unused_pdos": True}, []),
    "pdo_by_set_is_not_disabled": (
        {**without_sync(network(a={**NODE_A, "set": {"1800h:01": "0x40000181", "1800h:02": 1}})), "disable_unused_pdos": True},
        [("error", "network-sync")]),
    "pdo_of_a_signal_is_not_disabled": (
        {**without_sync(network(signal(*SPEED, every_sync=1))), "disable_unused_pdos": True}, [("error", "network-sync")]),
    "reserved_transmission_type": (network(signal(*SPEED), a={**NODE_A, "set": {"1801h:02": 241}}),
                                   [("error", "network-value")]),
    "reserved_transmission_type_of_an_rpdo": (network(signal(*SPEED), a={**NODE_A, "set": {"1401h:02": 252}}),
                                              [("error", "network-value")]),
    "value_in_the_unit": (network(a={**NODE_A, "set": {"2007h": "-100 rpm"}}), []),
    "value_in_another_unit_of_the_dimension": (network(a={"node_id": 1, "eds": "node.eds", "set": {"1017h": "0.1 s"}}), []),
    "value_in_a_unit_of_another_dimension": (network(a={**NODE_A, "set": {"2007h": "5 mA"}}), [("error", "network-value")]),
    "value_with_a_unit_of_an_entry_without_one": (network(a={**NODE_A, "set": {"2006h": "5 mA"}}), [("error", "network-value")]),
    "value_in_an_unknown_unit": (network(a={**NODE_A, "set": {"2007h": "5 knots"}}), [("error", "network-value")]),
    "value_between_two_numbers": (network(a={**NODE_A, "set": {"2007h": "0.5 rpm"}}), [("error", "network-value")]),
    "synchronous_pdo_that_the_network_does_not_use": (without_sync(network(a={**NODE_A, "eds": "synchronous.eds"})),
                                                      [("warning", "network-sync")]),
    "synchronous_pdo_that_is_disabled": (
        without_sync(network(a={**NODE_A, "eds": "synchronous.eds", "set": {"1800h:01": "0xC0000181"}})), []),
    "synchronous_pdo_of_a_signal": (without_sync(network(signal(*SPEED, every_sync=1))), [("error", "network-sync")]),
    "synchronous_pdo_by_set": (without_sync(network(a={**NODE_A, "set": {"1800h:01": "0x40000181", "1800h:02": 1}})),
                               [("error", "network-sync")]),
    "time_for_the_master": (network(m=MASTER, a={**NODE_A, "master_timeout_ms": 300}), []),
    "time_for_the_master_in_a_second_entry": (
        network(m=MASTER, a={**NODE_A, "master_timeout_ms": 300, "set": {"1016h:01": "0x200C8"}}), []),
    "time_for_the_master_without_a_free_entry": (
        network(m=MASTER, a={**NODE_A, "master_timeout_ms": 300, "set": {"1016h:01": "0x200C8", "1016h:02": "0x300C8"}}),
        [("error", "network-value")]),
    "time_for_a_master_without_a_heartbeat": (network(a={**NODE_A, "master_timeout_ms": 300}), [("error", "network-heartbeat")]),
    "time_for_the_master_shorter_than_its_heartbeat": (network(m=MASTER, a={**NODE_A, "master_timeout_ms": 100}),
                                                       [("error", "network-heartbeat")]),
    "time_for_the_master_of_a_node_without_1016h": (network(m=MASTER, w={**wide(9), "master_timeout_ms": 300}),
                                                    [("error", "network-value")]),
    "time_of_the_master_for_itself": (network(m={**MASTER, "master_timeout_ms": 300}), [("error", "network-value")]),
    "a_consumer_for_each_node": (network(a={**NODE_A, "set": {"1016h:01": "0x200C8", "1016h:02": "0x300C8"}}), []),
    "number_of_an_integer16_that_fits": (network(a={**NODE_A, "set": {"2007h": "-0x8000"}}), []),
    "hexadecimal_number_of_an_integer16": (network(a={**NODE_A, "set": {"2007h": "0xFFFF"}}), []),
    "decimal_number_of_an_integer16_that_does_not_fit": (network(a={**NODE_A, "set": {"2007h": "40000"}}), [("error", "network-value")]),
    "negative_number_of_an_unsigned16": (network(a={**NODE_A, "set": {"2006h": "-1"}}), [("error", "network-value")]),
    "dcf_without_a_bit_rate": (network(a={"dcf": "no_rate.dcf", "heartbeat_ms": 100}), []),
    "dcf_for_another_bit_rate": (network(a={"dcf": "rate_125.dcf", "heartbeat_ms": 100}), [("warning", "network-bit-rate")]),
    "formula_that_fits": (network(a={**NODE_A, "set": {"2006h": "$NODEID+0xFFFE"}}), []),
    "formula_that_does_not_fit": (network(a={**NODE_A, "set": {"2006h": "$NODEID+0xFFFF"}}), [("error", "network-value")]),
    "formula_of_more_than_64_bits": (network(a={**NODE_A, "set": {"2006h": "$NODEID+0xFFFFFFFFFFFFFFFF"}}),
                                     [("error", "network-value")]),
    "number_of_more_than_64_bits": (network(a={**NODE_A, "set": {"2006h": 18446744073709551716}}), [("error", "network-value")]),
    "heartbeat_that_does_not_fit": (network(a={"node_id": 1, "eds": "short.eds", "heartbeat_ms": 300}),
                                    [("error", "network-value"), ("warning", "network-unmonitored")]),
    "two_consumers_for_a_node": (network(a={**NODE_A, "set": {"1016h:01": "0x200C8", "1016h:02": "0x200FA"}}),
                                 [("warning", "heartbeat-consumer")]),
    "more_objects_than_a_mapping_has": (network(a={**NODE_A, "set": {"1A00h:00": 5}}), [("warning", "pdo-mapping-count")]),
    "synchronous_without_1005h": (network(signal("w", "2001h", "m", every_sync=1), w=wide(9)), [("warning", "pdo-sync")]),
    "254_entries_of_a_node": (network(*[signal("w", one, "m", every_ms=100) for one in bytes_of_wide(254)], w=wide(9)), []),
    "255_entries_of_a_node": (network(*[signal("w", one, "m", every_ms=100) for one in bytes_of_wide(255)], w=wide(9)),
                              [("error", "network-signal")]),
    "512_pdos_of_the_master": (
        network(*[signal(f"w{node}", one, "m", every_ms=1000 + i) for node in range(10, 26)
                  for i, one in enumerate(bytes_of_wide(32))], **{f"w{node}": wide(node) for node in range(10, 26)}), []),
    "513_pdos_of_the_master": (
        network(*[signal(f"w{node}", one, "m", every_ms=1000 + i) for node in range(10, 26)
                  for i, one in enumerate(bytes_of_wide(32))], signal("a", "2000h", "m"),
                **{f"w{node}": wide(node) for node in range(10, 26)}), [("error", "network-signal")]),
    "second_master_without_a_file": (network(m2={"node_id": 126, "master": True}), [("warning", "network-nmt-master")]),
    "node_without_a_file": (network(x={"node_id": 4}), [("error", "network-file")]),
    "units_of_a_signal_with_the_same_raw_numbers": (network(signal("v", "2000h", "mv.2002h"), **IN_UNITS), []),
    "units_of_a_signal_with_another_scale": (network(signal("v", "2000h", "tenths.2002h"), **IN_UNITS),
                                             [("warning", "network-pdo-unit")]),
    "units_of_a_signal_of_another_dimension": (network(signal("v", "2000h", "amps.2002h"), **IN_UNITS),
                                               [("warning", "network-pdo-unit")]),
    "unit_of_a_signal_on_one_side": (network(signal("v", "2000h", "plain.2002h"), **IN_UNITS), []),
    "unit_of_a_signal_to_a_master_that_copies_it": (network(signal("v", "2000h", "m"), **IN_UNITS), []),
    "signals_of_an_unreadable_node": (
        network(signal("x", "2000h", "m"), signal("a", "2000h", "x.2002h"), x={"node_id": 4, "eds": "missing.eds"}),
        [("error", "network-file")]),
}


MESSAGES = {  # name of a network: what its first finding says
    "value_with_a_unit_of_an_entry_without_one": 'node a: 2006h:00 "Ramp" does not have a unit; write the raw number without "mA"',
    "value_in_a_unit_of_another_dimension": "mA cannot be converted to rpm",
    "value_in_an_unknown_unit": '"knots" is not a unit that edsc knows',
    "value_between_two_numbers": "0.5 rpm is between 0 rpm and 1 rpm",
    "decimal_number_of_an_integer16_that_does_not_fit": "40000",
    "synchronous_pdo_that_the_network_does_not_use":
        'a TPDO 1 is synchronous, but no node produces SYNC; state a "producer" in "sync", or disable the PDO by '
        '"set": {"1800h:01": "0xC0000181"}',
    "name_of_a_signal_in_camel_case": '"MotorSpeed" is not a name in snake_case',
    "unit_of_a_signal_that_is_unknown": 'unknown unit "knots"',
    "unit_of_a_signal_that_differs_from_the_sender": 'unit "0.01 V", but 2000h:00 "Speed" of node v is in 0.001 V',
    "dbc_file_with_another_can_id": "message drive has 182h, the CAN-ID of no PDO of the network",
    "time_for_the_master_without_a_free_entry": "node a does not have a free entry in 1016h",
}


def notes_of_the_master(edsc: Path, folder: Path, *watching: str) -> int:
    """The notes that a node does not detect the loss of the master; those of several nodes are one."""
    slaves = {name: {**NODE_A, "node_id": i, **({"master_timeout_ms": 300} if name in watching else {})}
              for i, name in enumerate("abc", 1)}
    _, found = check(edsc, folder, "master_" + "".join(watching), json.dumps(network(m=MASTER, **slaves)))
    return sum((one["severity"], one["rule"]) == ("note", "network-unmonitored") for one in found)


def check(edsc: Path, folder: Path, name: str, text: str) -> tuple[int, list[dict]]:
    path = folder / f"{name}.json"
    path.write_text(text, encoding="utf-8")
    ran = subprocess.run([edsc, "network", "check", path, "--format", "json"], capture_output=True, text=True)
    return ran.returncode, json.loads(ran.stdout)["diagnostics"] if ran.stdout else []


def problems_of_example(edsc: Path, source: Path, example: Path) -> list[str]:
    """Notes of all nodes are merged, with paths without `..`."""
    ran = subprocess.run([edsc, "network", "check", example.relative_to(source), "--strict"], cwd=source, capture_output=True,
                         text=True)
    rules = re.findall(r"^eds/\S+: note: .*\[([a-z-]+)\]$", ran.stdout, flags=re.MULTILINE)
    sums = re.findall(r"^(\S+): 0 errors, 0 warnings", ran.stdout, flags=re.MULTILINE)
    load = re.search(rf"^{example.relative_to(source)}: load of \d+ nodes at \d+ kbit/s: ", ran.stdout, flags=re.MULTILINE)
    if ran.returncode == 0 and len(rules) == len(set(rules)) and len(sums) == len(set(sums)) and load:
        return []
    return [f"{example.name}: exit code {ran.returncode}\n{ran.stdout}{ran.stderr}"]


# shows 001.40
def problems_of_times(edsc: Path, source: Path) -> list[str]:
    """The table has the same messages as JSON, each at most as long as its bound; the cycle is that of the manual's example.

    Manual 001 calculates 24 / 9 / 40 % + 2 ms = 8.67 ms for twelve axes with two PDOs each.
    """
    command = [edsc, "network", "check", source / "examples/networks/twelve_axes.json"]
    shown = subprocess.run([*command, "--times"], capture_output=True, text=True, check=True).stdout
    report = json.loads(subprocess.run([*command, "--format", "json"], capture_output=True, text=True, check=True).stdout)
    jsonschema.validate(report, json.loads((source / "docs/schema/check.schema.json").read_text(encoding="utf-8")))
    network = report["networks"][0]
    problems = []
    if (network["sync"]["pdos"], network["sync"]["rule_of_thumb_us"]) != (24, 8666.666) or "a cycle of 8.667 ms" not in shown:
        problems.append(f"twelve_axes: SYNC cycle {network['sync']}\n{shown}")
    for one in network["messages"]:
        row = (rf"^{one['can_id']:03X}h +{one['name']} +(remote|{one['bytes']}) .* {one['worst_us'] / 1000:.3f} +"
               rf"{one['deadline_us'] / 1000:.3f}$")
        if not re.search(row, shown, flags=re.MULTILINE) or not one["transmission_us"] <= one["worst_us"] <= one["deadline_us"]:
            problems.append(f"twelve_axes: {one} is not in the table")
    synchronous = [one["worst_us"] for one in network["messages"] if one["synchronous"]]
    if (len(synchronous), max(synchronous)) != (24, network["sync"]["worst_us"]):
        problems.append(f"twelve_axes: {len(synchronous)} synchronous PDOs")
    return problems


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    problems = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "node.eds").write_bytes((Path(__file__).parent / "node.eds").read_bytes())
        (folder / "valid.eds").write_text(sheet_with("1400sub1", "$NODEID+0x200"))
        (folder / "synchronous.eds").write_text(sheet_with("1800sub2", "1", sheet_with("1800sub1", "$NODEID+0x40000180")))
        (folder / "slow.eds").write_text(sheet_with("1800sub3", "200"))
        (folder / "wide.eds").write_text(wide_sheet())
        for name, can_id in (("speed", 0x181), ("other", 0x182)):
            (folder / f"{name}.dbc").write_text(f"BO_ {can_id} drive: 2 Vector__XXX\n SG_ motor_speed : 0|16@1+ (1,0) [0|0] \"rpm\" m\n")
        (folder / "short.eds").write_text(re.sub(r"(\[1017\][^\[]*DataType=0x0006\n)", r"\g<1>HighLimit=255\n", sheet_with("1017", "0")))
        (folder / "coarse.eds").write_text(sheet_with("1017", "0").replace("Granularity=8", "Granularity=64"))
        (folder / "rate_100.eds").write_text(sheet_with("1017", "0").replace("BaudRate_125=1", "BaudRate_100=1"))
        for name, rate in (("no_rate", 0), ("rate_125", 125)):
            (folder / f"{name}.dcf").write_text(f"{sheet_with('1017', '0')}\n[DeviceComissioning]\nNodeID=1\nBaudrate={rate}\n")
        for name, units in UNITS.items():
            (folder / f"{name}.eds").write_text(sheet_in_units(*units))
        for name, (text, code, expected) in TEXTS.items():
            got_code, found = check(edsc, folder, name, text)
            places = [(one["severity"], one["rule"], one["line"], one["column"]) for one in found
                      if one["severity"] == "error"]
            if (got_code, places) != (code, expected):
                problems.append(f"{name}: expected {code} {expected}, got {got_code} {places}")
        for name, (value, expected) in NETWORKS.items():
            _, found = check(edsc, folder, name, json.dumps(value))
            rules = [(one["severity"], one["rule"]) for one in found if one["severity"] != "note"]
            if rules != expected:
                problems.append(f"{name}: expected {expected}, got {[one['message'] for one in found]} {rules}")
            if name in MESSAGES and MESSAGES[name] not in next(iter(one["message"] for one in found if one["severity"] != "note")):
                problems.append(f"{name}: expected {MESSAGES[name]}, got {[one['message'] for one in found]}")
        notes = [notes_of_the_master(edsc, folder, *watching) for watching in ("", "ab", "abc")]
        if notes != [1, 1, 0]:
            problems.append(f"notes about the master: {notes}")
    examples = sorted((source / "examples/networks").glob("*.json"))
    for example in examples:
        problems += problems_of_example(edsc, source, example)
    problems += problems_of_times(edsc, source)
    print("\n".join(problems))
    print(f"{len(TEXTS) + len(NETWORKS)} networks, {len(examples)} examples, {len(problems)} problems")
    return 1 if problems or not examples else 0


if __name__ == "__main__":
    sys.exit(main())

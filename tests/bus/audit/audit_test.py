#!/usr/bin/env python3
"""edsc audit: each rule has a log that breaks just it, made from a log that is silent; reports, options and documents.

    audit_test.py SOURCE_DIR EDSC [--write]

--write writes the table of rules in docs/how-to/audit.md.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from dataclasses import replace
from html.parser import HTMLParser

from audits import EDSC, SOURCE_DIR, Audits, Broken, add, data, guarded, lss, replaced
from plant import (END_MS, PRE_OPERATIONAL, STOP_MS, Frame, axis, block_upload, changed, clean, eds_of, in_order, log_of, repeated_block_upload, sdo, segmented_upload,
                   supply, without)

PAGE = SOURCE_DIR / "docs/how-to/audit.md"
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2
ERROR_FRAME = "(1700000002.950000) can0 20000004#0004000000000000\n"


def silent_supply(log: list[Frame]) -> list[Frame]:
    return without(log, 0x706, 1550, 2100)


def lost(log: list[Frame], node: int, until_ms: float = END_MS) -> list[Frame]:
    """Without the frames that the node sends, from 1200 ms on."""
    sent = {function + node for function in (0x080, 0x180, 0x280, 0x380, 0x580, 0x700)}
    return [one for one in log if one.can_id not in sent or one.remote or not 1200 < one.ms < until_ms]


def given_up(ms: float, index: int) -> list[Frame]:
    """A client that aborts a read of node 5 after 20 ms; the response follows after 30 ms."""
    entry = index.to_bytes(2, "little").hex() + "00"
    return [Frame(ms, 0x605, data(f"40{entry}00000000")), Frame(ms + 20, 0x605, data(f"80{entry}00000405")),
            Frame(ms + 30, 0x585, data(f"43{entry}00000000"))]


# Others follow from them.
INCIDENTS = {"node-lost", "sdo-gives-up", "log-gap"}


BROKEN = {
    "pdo-event-timer": Broken(lambda log: without(log, 0x185, 1200), node_id=5),
    "pdo-inhibit-time": Broken(add(Frame(1207, 0x185, bytes(2))), node_id=5),
    "pdo-sync-cycle": Broken(lambda log: without(log, 0x285, 1200), node_id=5),
    "pdo-sync-window": Broken(lambda log: changed(log, 0x285, 1220, ms=1250), node_id=5),
    "pdo-not-requested": Broken(lambda log: without(log, 0x385, 1000), node_id=5),
    "pdo-length": Broken(lambda log: changed(log, 0x185, 1200, data=bytes(3)), node_id=5),
    "pdo-state": Broken(add(Frame(350, 0x185, bytes(2))), node_id=5),
    "sync-period": Broken(lambda log: changed(log, 0x080, 220, ms=235), node_id=6),
    "sync-counter": Broken(lambda log: changed(log, 0x080, 220, data=b"\x09"), node_id=6),
    "sync-producers": Broken(axis=axis(i1005="0x40000080")),
    "heartbeat-late": Broken(lambda log: without(log, 0x705, 1200), node_id=5),
    "heartbeat-early": Broken(add(Frame(1240, 0x705, b"\x05")), node_id=5),
    "heartbeat-consumer": Broken(silent_supply, supply=supply(i1017="0"), node_id=5),
    "guarding-toggle": Broken(lambda log: guarded(log, (0x05, 0x05, 0x85)), node_id=5),
    "guarding-response": Broken(lambda log: guarded(log, (0x05, None, 0x85)), node_id=5),
    "nmt-command": Broken(add(Frame(1200, 0x000, b"\x03\x05"))),
    "nmt-state": Broken(lambda log: changed(log, 0x705, 1200, data=b"\x7F"), node_id=5),
    "nmt-boot-up": Broken(lambda log: [*without(log, 0x705, 2900), Frame(2900, 0x000, b"\x81\x05"),
                                       *(Frame(ms, 0x706, b"\x04") for ms in range(END_MS, 9000, 100))], node_id=5),
    "nmt-reset": Broken(add(Frame(250, 0x705, b"\0")), node_id=5),
    "stopped-service": Broken(add(Frame(STOP_MS + 300, 0x085, bytes(8))), node_id=5),
    "emcy-length": Broken(add(Frame(2000, 0x085, bytes(7))), node_id=5),
    "emcy-cob-id": Broken(axis=axis(i1014="0x80000085"), node_id=5),
    "emcy-register": Broken(lambda log: changed(log, 0x085, 1500, data=data("1081100000000000")), node_id=5),
    "emcy-register-value": Broken(add(*sdo(2000, 5, "4001100000000000", "4F01100010000000")), node_id=5),
    "emcy-inhibit-time": Broken(add(Frame(1503, 0x085, data("2081110000000000"))), node_id=5),
    "emcy-not-reset": Broken(lambda log: without(log, 0x085, 1700), node_id=5),
    "sdo-length": Broken(add(Frame(1200, 0x605, data("40001000"))), node_id=5),
    "sdo-command": Broken(add(Frame(1200, 0x605, data("E000100000000000"))), node_id=5),
    "sdo-unrequested": Broken(add(Frame(603, 0x585, data("4300100000000000"))), node_id=5),
    "sdo-unfinished": Broken(add(Frame(599, 0x605, data("4018100100000000"))), node_id=5),
    "sdo-toggle": Broken(replaced(segmented_upload(640), 4, "6000000000000000"), node_id=5),
    "sdo-sequence": Broken(lambda log: [one for one in log if one not in block_upload(680)] + repeated_block_upload(680), node_id=5),
    "sdo-size": Broken(replaced(segmented_upload(640), 1, "4108100011000000"), node_id=5),
    "sdo-crc": Broken(replaced(block_upload(680), 6, "C100000000000000"), node_id=5),
    "sdo-timeout": Broken(add(Frame(1200, 0x605, data("4000100000000000"))), node_id=5),
    "sdo-abort": Broken(add(*sdo(1200, 5, "4000300000000000", "8000300000000206")), node_id=5),
    "lss-response": Broken(add(Frame(304, 0x7E4, data("1100000000000000")))),
    "lss-mode": Broken(add(Frame(350, 0x7E5, data("1120000000000000")))),
    "lss-command": Broken(add(*lss(320, "4001000000", ""), *lss(322, "4203000000", ""))),
    "lss-refused": Broken(add(*lss(320, "0401", ""), *lss(322, "11FE", "1101"), *lss(324, "0400", ""))),
    "lss-timeout": Broken(add(*lss(320, "0401", ""), *lss(322, "5A", "5A01"), *lss(324, "5B", ""), *lss(470, "0400", ""))),
    "bus-load": Broken(arguments=("--bit-rate", "10", "--max-load", "25")),
    "error-frame": Broken(line=ERROR_FRAME),
    "frame-length": Broken(add(Frame(1200, 0x100, bytes(5)))),
    "can-id-unknown": Broken(add(Frame(1200, 0x2FF, b"\0"))),
    "can-id-senders": Broken(supply=supply(i1800s01="0x185", i1800s05="0")),
    "node-unknown": Broken(add(Frame(1200, 0x709, b"\x05")), node_id=9),
    "node-silent": Broken(arguments=("--node", "7=axis.eds"), node_id=7),
    "node-lost": Broken(lambda log: lost(log, 5), node_id=5),
    "sdo-gives-up": Broken(add(*given_up(1200, 0x1000)), node_id=5),
    "log-gap": Broken(lambda log: [one for one in log if not 1200 < one.ms < 1900]),
    "log-time": Broken(lambda log: [replace(one, ms=one.ms - 86_400_000) if one.ms > 1299 else one for one in log], sort=False),
    "log-interface": Broken(line="(1700000002.950000) can1 000#0107\n"),
}


class Rules(Audits):
    def test_a_clean_log_has_no_findings(self) -> None:
        report = self.report(Broken(arguments=("--bit-rate", "125")))
        self.assertEqual(report["findings"], [])
        self.assertEqual((report["clean"], report["nodes"], report["frames"]), (True, 2, len(clean())))

    def test_each_broken_log_has_just_its_finding(self) -> None:
        for rule, case in BROKEN.items():
            with self.subTest(rule):
                report = self.report(case)
                findings = [one for one in report["findings"] if rule not in INCIDENTS or one["follows_from"] is None]
                self.assertEqual({one["rule"] for one in findings}, {rule}, json.dumps(report["findings"], indent=1))
                if case.node_id is not None:
                    self.assertEqual({one["node_id"] for one in findings}, {case.node_id})

    def test_each_rule_has_a_broken_log(self) -> None:
        rules = json.loads(self.run_edsc("--list-rules", "--format", "json").stdout)["rules"]
        self.assertEqual([rule["id"] for rule in rules], list(BROKEN))

    def test_numbers(self) -> None:
        one = self.report(BROKEN["pdo-event-timer"])["findings"][0]
        self.assertEqual((one["index"], one["count"], one["expected"], one["seen"]), ("1800h:00", 1, "at most 100 ms", "none for 200 ms"))
        self.assertEqual(one["first"]["at_us"], 1_305_000)
        mean = self.report(BROKEN["bus-load"])["mean_load_percent"]
        self.assertGreater(mean, 0)


class Options(Audits):
    def test_tolerance(self) -> None:
        case = Broken(lambda log: changed(log, 0x185, 1205, ms=1230))
        self.assertEqual([one["rule"] for one in self.report(case)["findings"]], ["pdo-event-timer"])
        self.assertEqual(self.report(case, "--tolerance", "30")["findings"], [])

    def test_sdo_timeout(self) -> None:
        case = Broken(add(*sdo(1200, 5, "4000100000000000", "4300100000000000", 300)))
        self.assertEqual(self.report(case)["findings"], [])
        self.assertEqual([one["rule"] for one in self.report(case, "--timeout", "200ms")["findings"]], ["sdo-timeout"])

    def test_the_options_file_states_the_unit_of_inhibit_times(self) -> None:
        """100 units are 10 ms, with units of 1 ms 100 ms, with units of 50 us 5 ms."""
        for unit, after_ms, rules in ((100, 6, ["pdo-inhibit-time"]), (100, 45, []), (1000, 45, ["pdo-inhibit-time"]), (50, 6, [])):
            with self.subTest(unit=unit, after_ms=after_ms):
                (self.folder / "axis.options.json").write_text(json.dumps({"pdo": {"inhibit_time_unit": unit}}))
                case = Broken(add(Frame(1205 + after_ms, 0x185, bytes(2))))
                self.assertEqual([one["rule"] for one in self.report(case)["findings"]], rules)

    def test_silence(self) -> None:
        self.assertEqual(self.report(BROKEN["nmt-reset"], "--silence", "nmt-reset")["findings"], [])
        unknown = self.audit(Broken(), "--silence", "nmt-rest")
        self.assertEqual(unknown.returncode, WRONG_USAGE)
        self.assertIn('did you mean "nmt-reset"?', unknown.stderr)

    def test_exit_codes(self) -> None:
        self.assertEqual(self.audit(Broken()).returncode, FINE)
        self.assertEqual(self.audit(BROKEN["sdo-abort"]).returncode, FINE)  # a note
        self.assertEqual(self.audit(BROKEN["nmt-reset"]).returncode, INPUT_HAS_ERRORS)
        self.assertEqual(self.audit(Broken(line="no frame\n")).returncode, INPUT_HAS_ERRORS)
        self.assertEqual(self.run_edsc(log="").returncode, INPUT_HAS_ERRORS)
        self.assertEqual(self.run_edsc("missing.log", "--node", "5=axis.eds").returncode, WRONG_USAGE)

    def test_the_times_are_those_of_a_network_file(self) -> None:
        result = self.audit(Broken(), "--times")
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
        self.assertIn("edsc: --times requires --network\n", result.stderr)


class Behaviour(Audits):
    def test_values_written_in_the_log_are_in_force(self) -> None:
        """1017h of node 5 becomes 200 ms: every second heartbeat is enough."""
        def slower(log: list[Frame]) -> list[Frame]:
            log = [*log, *sdo(1100, 5, "2B171000C8000000", "6017100000000000")]
            for ms in range(1200, STOP_MS + 400, 200):
                log = without(log, 0x705, ms)
            return log
        self.assertEqual(self.report(Broken(slower))["findings"], [])
        rules = {one["rule"] for one in self.report(Broken(lambda log: [one for one in slower(log) if one.ms < 1100 or one.can_id != 0x605]))["findings"]}
        self.assertIn("heartbeat-late", rules)

    def test_a_log_without_times_is_checked_by_its_sequence(self) -> None:
        (self.folder / "axis.eds").write_text(eds_of(axis()))
        lines = re.sub(r"(?m)^\(\S+\) can0 ", "", log_of(in_order(clean())))
        arguments = ("--node", "5=axis.eds", "--silence", "node-unknown", "--format", "json")
        self.assertEqual(json.loads(self.run_edsc(*arguments, log=lines).stdout)["findings"], [])
        report = json.loads(self.run_edsc(*arguments, log=lines.replace("385#R\n", "")).stdout)
        self.assertEqual([one["rule"] for one in report["findings"]], ["pdo-not-requested"])
        self.assertIsNone(report["duration_us"])

    def test_many_occurrences_are_one_finding(self) -> None:
        def noisy(log: list[Frame]) -> list[Frame]:
            return [*log, *(Frame(1000 + at, 0x2FF, b"\0") for at in range(400))]
        findings = self.report(Broken(noisy))["findings"]
        self.assertEqual([(one["rule"], one["count"], one["first"]["at_us"]) for one in findings], [("can-id-unknown", 400, 1_000_000)])

    def test_a_silent_tpdo_is_found_without_a_frame(self) -> None:
        report = self.report(Broken(lambda log: without(log, 0x185, 1200, END_MS)))
        self.assertEqual([(one["rule"], one["index"]) for one in report["findings"]], [("pdo-event-timer", "1800h:00")])

    def test_a_producer_without_sync_is_found(self) -> None:
        def silent(log: list[Frame], from_ms: int) -> list[Frame]:
            return [one for one in log if one.can_id not in (0x080, 0x285) or one.ms < from_ms]
        for name, from_ms, frames in (("never", 0, ()), ("not any more", 1200, ()),
                                      ("until it is stopped", 2400, (Frame(2480, 0x000, b"\x02\x06"),))):
            with self.subTest(name):
                findings = self.report(Broken(lambda log: [*silent(log, from_ms), *frames]))["findings"]
                self.assertEqual([(one["rule"], one["node_id"]) for one in findings], [("sync-period", 6)])

    def test_lss_of_one_slave_and_of_all(self) -> None:
        begin, end = lss(320, "0401", ""), lss(340, "0400", "")
        again = [Frame(324, 0x7E4, data("1300000000000000"))]
        self.assertEqual(self.report(Broken(add(*begin, *lss(322, "130003", "1300"), *again, *end)))["findings"], [])
        again = [Frame(324, 0x7E4, data("5A02000000000000"))]
        findings = self.report(Broken(add(*begin, *lss(322, "5A", "5A01"), *again, *end)))["findings"]
        self.assertEqual([one["rule"] for one in findings], ["lss-response"])

    def test_frames_of_another_length(self) -> None:
        for frame, node_id, can_id in ((Frame(1202, 0x080, b"\1\2"), None, 0x080), (Frame(1240, 0x705, b"\5\5"), 5, 0x705),
                                       (Frame(350, 0x7E5, bytes(4)), None, 0x7E5)):
            with self.subTest(can_id):
                findings = self.report(Broken(add(frame)))["findings"]
                self.assertEqual([(one["rule"], one["node_id"], one["can_id"]) for one in findings], [("frame-length", node_id, can_id)])

    def test_an_error_code_has_the_name_of_the_device_or_of_its_class(self) -> None:
        """8110h is of CiA 301, until the options of the device name it; 000Ah is an error only of a device that names it."""
        for names, code, texts in (({}, "1081", ["00h with 8110h CAN overrun, objects lost"]),
                                   ({"8110h": "receive buffer full"}, "1081", ["00h with 8110h receive buffer full"]),
                                   ({"000Ah": "motor overcurrent"}, "0A00", ["00h with 000Ah motor overcurrent"]), ({}, "0A00", [])):
            with self.subTest(names=names, code=code):
                (self.folder / "axis.options.json").write_text(json.dumps({"meaning": {"emcy": names}}))
                case = Broken(lambda log, code=code: changed(log, 0x085, 1500, data=data(f"{code}000000000000")))
                findings = self.report(case)["findings"]
                self.assertEqual([one["seen"] for one in findings if one["rule"] == "emcy-register"], texts)

    def test_an_unknown_state(self) -> None:
        findings = self.report(Broken(add(Frame(1240, 0x705, b"\x06"))))["findings"]
        self.assertEqual([(one["rule"], one["seen"]) for one in findings], [("nmt-state", "unknown state 6")])

    def test_each_frame_of_a_segmented_transfer_counts(self) -> None:
        begun = sdo(630, 5, "4000100000000000", "4300100000000000")  # the transfer is not cut off by the beginning of the log
        for at, frame in enumerate(segmented_upload(640)):
            once = [one for one in [*clean(), *begun] if one != frame]
            twice = [*clean(), *begun, replace(frame, ms=frame.ms + 0.1)]
            for name, log in (("lost", once), ("twice", twice)):
                with self.subTest(name, at=at):
                    rules = {one["rule"] for one in self.report(Broken(lambda _, log=log: log))["findings"]}
                    self.assertTrue(rules)
                    self.assertLessEqual(rules, {"sdo-command", "sdo-toggle", "sdo-unrequested", "sdo-unfinished", "sdo-size"})

    def test_a_scan_of_absent_nodes_is_clean(self) -> None:
        requests = [Frame(1100 + node, 0x600 + node, data("4000100000000000")) for node in range(20, 100)]
        self.assertEqual(self.report(Broken(add(*requests)))["findings"], [])

    def test_a_request_without_a_response_is_not_an_unfinished_transfer(self) -> None:
        """Node 9 appears between two requests; node 5 boots between them, or is silent."""
        boot_up, heartbeat = b"\0", bytes([PRE_OPERATIONAL])
        rows = ((9, 1250, [Frame(1500, 0x709, boot_up)], 1650, []),
                (9, 1250, [Frame(1500, 0x709, heartbeat)], 1650, []),
                (5, 200, [Frame(250, 0x705, boot_up)], 270, ["nmt-reset"]),
                (5, 1250, [Frame(1500, 0x705, boot_up)], 2100, ["nmt-reset", "sdo-timeout"]),
                (5, 1250, [], 2100, ["sdo-timeout"]))
        for node, first, between, second, expected in rows:
            with self.subTest(node=node, first=first, between=between):
                log = [Frame(first, 0x600 + node, data("4000100000000000")), *between,
                       *sdo(second, node, "4000100000000000", "4300100092010200")]
                findings = self.report(Broken(add(*log)), "--timeout", "200ms")["findings"]
                counts = {one["rule"]: one["count"] for one in findings if one["rule"] == "nmt-reset" or one["rule"].startswith("sdo")}
                self.assertEqual(counts, dict.fromkeys(expected, 1))


class Incidents(Audits):
    """One incident is one finding; the others follow from it."""

    def grouped(self, case: Broken) -> tuple[list[str], list[str]]:
        """The rules of the findings that do not follow from others, and of those that do."""
        findings = self.report(case)["findings"]
        for one in findings:
            if one["follows_from"] is not None:
                self.assertIsNone(findings[one["follows_from"]]["follows_from"])
        return ([one["rule"] for one in findings if one["follows_from"] is None],
                [one["rule"] for one in findings if one["follows_from"] is not None])

    def test_a_client_that_gives_up(self) -> None:
        """29 objects, each with an abort; the late responses are one finding."""
        frames = [frame for at in range(29) for frame in given_up(1200 + 40 * at, 0x2100 + at)]
        causes, following = self.grouped(Broken(add(*frames)))
        self.assertEqual(causes, ["sdo-gives-up"])
        self.assertEqual((following.count("sdo-abort"), following.count("sdo-unrequested")), (29, 1))

    def test_a_gap_in_the_recording(self) -> None:
        causes, following = self.grouped(BROKEN["log-gap"])
        self.assertEqual(causes, ["log-gap"])
        self.assertGreaterEqual(following.count("heartbeat-late"), 2)  # of both nodes
        self.assertIn("pdo-event-timer", following)

    def test_a_lost_node_that_returns(self) -> None:
        returned = Broken(lambda log: [*lost(log, 5, 1900), Frame(1895, 0x705, b"\0")])
        causes, following = self.grouped(returned)
        self.assertEqual(causes[0], "node-lost")
        self.assertNotIn("heartbeat-late", causes)
        self.assertIn("nmt-reset", following)

    def test_what_does_not_belong_to_an_incident_is_listed(self) -> None:
        causes, _ = self.grouped(Broken(lambda log: [one for one in [*log, Frame(700, 0x705, b"\0")] if not 1200 < one.ms < 1900]))
        self.assertIn("nmt-reset", causes)
        self.assertIn("log-gap", causes)

    def test_the_text_lists_causes_and_all_findings_on_demand(self) -> None:
        text = self.audit(BROKEN["sdo-gives-up"]).stdout
        self.assertIn("    2 findings follow from this: sdo-abort, sdo-unrequested; --all-findings lists them\n", text)
        self.assertNotIn("[sdo-unrequested]", text)
        self.assertTrue(text.endswith("0 errors, 1 warning, 0 notes; 2 findings follow from these\n"), text)
        self.assertIn("[sdo-unrequested]", self.audit(BROKEN["sdo-gives-up"], "--all-findings").stdout)

    def test_without_an_eds(self) -> None:
        """SDO, NMT, heartbeats and LSS are checked; nothing is unknown."""
        def findings(log: list[Frame]) -> set[tuple[str, int | None]]:
            report = json.loads(self.run_edsc("--format", "json", log=log_of(in_order(log))).stdout)
            return {(one["rule"], one["node_id"]) for one in report["findings"] if one["follows_from"] is None}
        self.assertEqual(findings(clean()), set())
        for rule in ("sdo-toggle", "sdo-gives-up", "nmt-reset", "nmt-state", "nmt-command", "node-lost", "lss-command", "log-gap"):
            with self.subTest(rule):
                self.assertIn(rule, {found for found, _ in findings(BROKEN[rule].change(clean()))})


class Page(HTMLParser):
    """The cells of the table, and everything that refers to another file."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.references: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.references += [value or "" for name, value in attributes if name in ("src", "href") and tag != "a"]

    def handle_data(self, text: str) -> None:
        self.texts.append(text)


class Reports(Audits):
    def test_text(self) -> None:
        result = self.audit(BROKEN["heartbeat-late"])
        self.assertRegex(result.stdout, r"(?m)^can0\.log:\d+: error: node 5, 1017h(:00)? \S.*: a heartbeat is later than 1017h \[heartbeat-late\]$")
        self.assertIn("    expected every 100 ms; seen: none for 200 ms; at 1.310000 s\n", result.stdout)
        self.assertTrue(result.stdout.endswith("1 error, 0 warnings, 0 notes\n"))
        self.assertNotIn("\033", result.stdout)
        self.assertIn("\033[", self.audit(BROKEN["heartbeat-late"], "--color", "always").stdout)

    def test_html(self) -> None:
        self.assertEqual(self.audit(BROKEN["nmt-reset"], "--format", "html", "-o", "audit.html").returncode, INPUT_HAS_ERRORS)
        page = Page()
        page.feed((self.folder / "audit.html").read_text())
        self.assertIn("nmt-reset", page.texts)
        self.assertEqual(page.references, ["data:,"])

    def test_hostile_texts_do_not_reach_the_terminal_or_the_page(self) -> None:
        (self.folder / "<b>\033[2J.log").write_text(log_of(in_order(BROKEN["nmt-reset"].change(clean()))))
        (self.folder / "axis.eds").write_text(eds_of(axis()))
        for form in ("text", "json", "html"):
            result = self.run_edsc("<b>\033[2J.log", "--node", "5=axis.eds", "--format", form)
            self.assertNotIn("\033", result.stdout)
            if form == "html":
                self.assertNotIn("<b>", result.stdout)


def table(rules: list[dict]) -> str:
    rows = ["| rule | | meaning | source | how it is checked |", "|---|---|---|---|---|"]
    rows += [f"| {rule['id']} | {rule['severity']} | {rule['meaning']} | {rule['source']} | {rule['advice']} |" for rule in rules]
    return "\n".join(rows) + "\n"


def page_with(rules: list[dict], page: str) -> str:
    begin, end = page.index("| rule |"), page.rindex("|\n") + 2
    return page[:begin] + table(rules) + page[end:]


def listed_rules() -> list[dict]:
    return json.loads(subprocess.run([EDSC, "audit", "--list-rules", "--format", "json"], check=True, capture_output=True).stdout)["rules"]


class Documents(unittest.TestCase):
    def test_the_page_has_the_table(self) -> None:
        page = PAGE.read_text()
        self.assertEqual(page, page_with(listed_rules(), page), "run this test with --write")


if __name__ == "__main__":
    if "--write" in sys.argv:
        PAGE.write_text(page_with(listed_rules(), PAGE.read_text()))
        sys.exit()
    unittest.main(argv=sys.argv[:1])

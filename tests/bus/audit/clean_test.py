#!/usr/bin/env python3
"""edsc audit does not report traffic that is correct, and logs whose times are not in order.

    clean_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import sys
import unittest

from audits import Audits, Broken, add, data, guarded, lss
from plant import (END_MS, EVENT_MS, HEARTBEAT_MS, PRE_OPERATIONAL, START_MS, STOP_MS, SYNC_PERIOD_MS, UNSIGNED32, Frame, axis, block_upload,
                   clean, eds_of, in_order, log_of, sdo, supply, without)


def screen_of(frames: list[Frame], differences: bool = False) -> str:
    """As candump -t z, or -t d, shows them."""
    lines, before = [], 0.0
    for frame in sorted(frames, key=lambda frame: frame.ms):
        content = "remote request" if frame.remote else frame.data.hex(" ").upper()
        lines.append(f" ({(frame.ms - before) / 1000:010.6f})  can0  {frame.can_id:03X}   [{len(frame.data)}]  {content}\n")
        before = frame.ms if differences else 0.0
    return "".join(lines)


def asc_of(frames: list[Frame]) -> str:
    lines = ["date Wed Nov 25 10:00:00.000 am 2026\nbase hex  timestamps absolute\n"]
    for frame in sorted(frames, key=lambda frame: frame.ms):
        content = "r" if frame.remote else f"d {len(frame.data)} {frame.data.hex(' ')}"
        lines.append(f"   {frame.ms / 1000:.6f} 1  {frame.can_id:X}             Rx   {content}\n")
    return "".join(lines)


def swapped(log: str, can_id: str, time: str, other: str) -> str:
    """With another time of a line, so that it is before that of the previous line."""
    (line,) = (line for line in log.splitlines() if time in line and f" {can_id} " in line)
    return log.replace(line, line.replace(time, other))


class Times(Audits):
    def rules(self, log: str) -> set[str]:
        (self.folder / "axis.eds").write_text(eds_of(axis()))
        (self.folder / "supply.eds").write_text(eds_of(supply()))
        lines = self.run_edsc("--node", "5=axis.eds", "--node", "6=supply.eds", log=log).stdout.splitlines()
        self.assertRegex(lines[-1], r"^<stdin>: \d+ frames of 2 nodes in 2.910 s: ")
        return {line.rpartition("[")[2].rstrip("]") for line in lines if line.endswith("]")}

    def test_differences_of_candump(self) -> None:
        self.assertEqual(self.rules(screen_of(clean())), set())
        self.assertEqual(self.rules(screen_of(clean(), differences=True)), set())

    def test_frames_slightly_out_of_order_are_not_differences(self) -> None:
        self.assertEqual(self.rules(swapped(screen_of(clean()), "285", "001.021000", "001.019900")), set())
        self.assertEqual(self.rules(swapped(asc_of(clean()), "285", "1.021000", "1.019900")), set())


    def test_two_logs_in_one(self) -> None:
        (self.folder / "axis.eds").write_text(eds_of(axis()))
        (self.folder / "supply.eds").write_text(eds_of(supply()))
        log = log_of(in_order(clean()))
        joined = self.run_edsc("--node", "5=axis.eds", "--node", "6=supply.eds", log=log + log.replace("(17", "(16"))
        self.assertEqual((joined.stdout.count("["), joined.stdout.count("[log-time]"), joined.returncode), (1, 1, 0), joined.stdout)


class Traffic(Audits):
    def test_a_log_may_begin_in_any_frame(self) -> None:
        log = in_order(block_upload(150) + clean())
        for at in range(0, len(log) // 2, 3):
            with self.subTest(at=at):
                self.assert_clean(Broken(lambda _, at=at: log[at:]))

    def assert_clean(self, case: Broken, *arguments: str) -> None:
        self.assertEqual(self.report(case, *arguments)["findings"], [])

    def test_the_response_to_a_remote_frame_may_restart_the_event_timer(self) -> None:
        def restarted(log: list[Frame]) -> list[Frame]:
            log = [frame for frame in log if frame.can_id != 0x185 or frame.ms < 1200]
            log += [Frame(1160, 0x185, remote=True), Frame(1161, 0x185, bytes(2))]
            return log + [Frame(ms, 0x185, bytes(2)) for ms in range(1161 + EVENT_MS, STOP_MS, EVENT_MS)]
        self.assert_clean(Broken(restarted))

    def test_each_of_two_remote_frames_has_a_response(self) -> None:
        self.assert_clean(Broken(add(Frame(1100, 0x385, remote=True), Frame(1100.3, 0x385, remote=True),
                                     Frame(1102, 0x385, bytes(2)), Frame(1103, 0x385, bytes(2)))))

    def test_a_remote_frame_without_a_response_does_not_move_the_cycle(self) -> None:
        self.assert_clean(Broken(add(Frame(1200, 0x285, remote=True))))
        self.assert_clean(Broken(add(Frame(1200, 0x285, remote=True), Frame(1202, 0x285, bytes(2)))))

    def test_a_tpdo_after_two_commands(self) -> None:
        self.assert_clean(Broken(add(Frame(STOP_MS + 2, 0x000, b"\x80\x05"), Frame(STOP_MS + 4, 0x185, bytes(2)))))
        late = self.report(Broken(add(Frame(STOP_MS + 150, 0x185, bytes(2)))))
        self.assertEqual([one["rule"] for one in late["findings"]], ["pdo-state"])

    def test_a_node_that_starts_itself_sends_pdos_before_its_first_heartbeat(self) -> None:
        starts_itself = axis() | {(0x1F80, 0): (UNSIGNED32, "8")}

        def started(log: list[Frame]) -> list[Frame]:
            log = [Frame(one.ms, one.can_id, b"\x05") if one.can_id == 0x705 and one.data == bytes([PRE_OPERATIONAL]) else one for one in log]
            log += [Frame(ms, 0x285, bytes(2)) for ms in range(21, START_MS, 50)]
            return log + [Frame(ms, 0x185, bytes(2)) for ms in range(15, START_MS + 5, EVENT_MS)]
        self.assert_clean(Broken(started, axis=starts_itself))
        rules = {one["rule"] for one in self.report(Broken(started))["findings"]}
        self.assertEqual(rules, {"pdo-state", "nmt-state"})

    def test_the_master_need_not_obey_its_own_commands(self) -> None:
        """Node 6, and node 9 without an EDS, remain Operational while the master resets all nodes."""
        def reset(log: list[Frame]) -> list[Frame]:
            log = [one for one in log if one.ms < STOP_MS]
            log += [Frame(ms, can_id, b"\x05") for can_id in (0x706, 0x709) for ms in range(STOP_MS, STOP_MS + 500, HEARTBEAT_MS)]
            log += [Frame(ms, 0x705, bytes([PRE_OPERATIONAL])) for ms in range(STOP_MS + 120, STOP_MS + 500, HEARTBEAT_MS)]
            log += [Frame(ms, 0x080, bytes([at % 10 + 1])) for at, ms in enumerate(range(STOP_MS + 20, STOP_MS + 500, SYNC_PERIOD_MS))]
            return [*log, Frame(STOP_MS + 3, 0x000, b"\x81\0"), Frame(STOP_MS + 50, 0x705, b"\0")]
        arguments = ("--silence", "node-unknown")
        self.assert_clean(Broken(reset), "--master", "6", *arguments)
        self.assert_clean(Broken(reset, supply=supply() | {(0x1F80, 0): (UNSIGNED32, "1")}), *arguments)
        rules = {(one["rule"], one["node_id"]) for one in self.report(Broken(reset), *arguments)["findings"]}
        self.assertEqual(rules, {("nmt-state", 6)})

    def test_node_guarding(self) -> None:
        for name, requests in (("with", True), ("without", False)):
            with self.subTest(f"{name} the remote frames in the log"):
                log = guarded(clean(), (0x05, 0x85, 0x05, 0x85, 0x05))
                self.assert_clean(Broken(lambda _, log=log, requests=requests: [one for one in log if requests or one.can_id != 0x705 or not one.remote]))

    def test_a_heartbeat_is_not_a_response_to_node_guarding(self) -> None:
        """CiA 301, 7.2.8.3.2: a node with a producer heartbeat time uses the heartbeat protocol and does not respond."""
        requests = [Frame(ms, 0x705, remote=True) for ms in range(1130, 2300, 70)]
        self.assert_clean(Broken(add(*requests)))
        with_toggle = self.report(Broken(add(*requests, Frame(1131, 0x705, b"\x85"), Frame(1133, 0x705, b"\x85"))))
        self.assertIn("guarding-toggle", {one["rule"] for one in with_toggle["findings"]})

    def test_a_write_to_1017h_restarts_the_heartbeat(self) -> None:
        """CiA 301, 7.5.2.20; also with the present value."""
        heartbeats = [Frame(ms, 0x705, bytes([PRE_OPERATIONAL])) for ms in range(352, 500, HEARTBEAT_MS)]

        def restarted(log: list[Frame]) -> list[Frame]:
            return without(log, 0x705, 350, START_MS) + [*sdo(350, 5, "2B17100064000000", "6017100000000000"), *heartbeats]
        self.assert_clean(Broken(restarted))
        early = self.report(Broken(lambda log: without(log, 0x705, 350, START_MS) + heartbeats))
        self.assertIn("heartbeat-early", [one["rule"] for one in early["findings"]])

    def test_a_node_does_not_respond_during_the_switch_delay_of_lss(self) -> None:
        """CiA 305, activate bit timing: the slave does not send before the end of the second delay."""
        def activated(ms: int) -> Broken:
            return Broken(add(*lss(320, "0401", ""), *lss(322, "5A", "5A01"), *lss(324, "153200", ""), *lss(ms, "5E", ""),
                              *lss(ms + 150, "0400", "")))
        self.assert_clean(activated(420))
        self.assertEqual([one["rule"] for one in self.report(activated(430))["findings"]], ["lss-timeout"])

    def test_a_node_boots_with_the_node_id_that_another_had(self) -> None:
        """Node 7 was on the bus; then LSS gives its node-ID to node 5."""
        def moved(log: list[Frame]) -> list[Frame]:
            log = [one for one in log if one.ms < 2600 or one.can_id != 0x705]
            log += [Frame(ms, 0x707, b"\x7F") for ms in range(100, 2600, HEARTBEAT_MS)]
            log += [*lss(2600, "0401", ""), *lss(2602, "1107", "1100"), *lss(2605, "0400", ""), Frame(2610, 0x000, b"\x82\x05")]
            return log + [Frame(2650, 0x707, b"\0"), *(Frame(ms, 0x707, b"\x7F") for ms in range(2750, END_MS, HEARTBEAT_MS))]
        self.assert_clean(Broken(moved), "--silence", "node-unknown")
        again = self.report(Broken(lambda log: [*moved(log), Frame(2990, 0x707, b"\0")]), "--silence", "node-unknown")
        self.assertEqual([one["rule"] for one in again["findings"]], ["nmt-reset"])

    def test_a_node_boots_with_the_node_id_of_lss(self) -> None:
        """Node 5 becomes node 7."""
        def moved(log: list[Frame]) -> list[Frame]:
            log = [one for one in log if one.ms < 2600 or one.can_id != 0x705]
            for ms, can_id, content in ((2600, 0x7E5, "0401"), (2602, 0x7E5, "1107"), (2603, 0x7E4, "1100"), (2605, 0x7E5, "0400")):
                log.append(Frame(ms, can_id, data(content.ljust(16, "0"))))
            log += [Frame(2610, 0x000, b"\x82\x05"), Frame(2700, 0x707, b"\0")]
            log += [Frame(ms, 0x707, bytes([PRE_OPERATIONAL])) for ms in range(2800, 9000, HEARTBEAT_MS)]
            return log + [Frame(ms, 0x706, b"\x04") for ms in range(END_MS, 9000, HEARTBEAT_MS)]
        arguments = ("--node", "7=axis.eds")
        self.assert_clean(Broken(moved), *arguments)
        lost = self.report(Broken(lambda log: without(moved(log), 0x707, 2600, 9000)), *arguments, "--silence", "node-silent")
        self.assertEqual([one["rule"] for one in lost["findings"]], ["nmt-boot-up"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

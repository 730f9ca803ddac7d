#!/usr/bin/env python3
"""edsc nmt with live nodes on the virtual bus of `edsc bus`.

    nmt_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

from live import FAILED, FINE, WRONG_USAGE, LiveTest, run


class Nmt(LiveTest):
    nodes = (5, 6)

    def test_commands(self) -> None:
        for command, node in (("start", "all"), ("stop", 5), ("pre-operational", 5), ("reset-communication", 6)):
            self.expect(self.edsc("nmt", command, node), FINE)
        self.assertEqual(self.network.frames("000"), ["000 01 00", "000 02 05", "000 80 05", "000 82 06"])

    def test_it_waits_for_the_boot_up_message(self) -> None:
        self.expect(self.edsc("nmt", "reset-node", 5, "--wait", "60000ms"), FINE)
        self.expect(self.edsc("nmt", "reset-node", 9, "--wait", "50ms"), FAILED,
                    stderr="edsc: node 9 did not report boot-up within 50ms: it has not sent a boot-up message\n")

    def test_it_says_why_no_heartbeat_may_come(self) -> None:
        self.expect(self.edsc("nmt", "start", 5, "--wait", "50ms"), FAILED,
                    stderr="edsc: node 5 did not report operational within 50ms: it has not sent a heartbeat; "
                           f"1017h may be 0 (edsc read {self.network.address} 5 1017h --type u16)\n")
        self.edsc("write", 6, "1017h", 10, "--type", "u16")
        self.expect(self.edsc("nmt", "stop", 6, "--wait", "60000ms"), FINE)
        self.network.device(lambda frame: ["707 7F"] if frame == "000 01 07" else [])
        self.expect(self.edsc("nmt", "start", 7, "--wait", "10000ms"), FAILED,
                    stderr="edsc: node 7 did not report operational within 10s: the last state that it reported is "
                           "pre-operational\n")

    def test_wrong_usage(self) -> None:
        for arguments in (("start",), ("go", 5), ("start", 128), ("start", "all", "--wait", "10ms")):
            self.assertEqual(self.edsc("nmt", *arguments).returncode, WRONG_USAGE)


if __name__ == "__main__":
    run()

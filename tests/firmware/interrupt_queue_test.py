#!/usr/bin/env python3
"""tests/firmware/interrupt_queue.cpp on QEMU: no frame is lost, torn or out of order between an interrupt and the loop,
whichever instruction is interrupted, and the same program finds the fault of each faulty queue.

    interrupt_queue_test.py BOARD IMAGE FRAMES

QEMU counts instructions (-icount), so that each run is the same and does not depend on the load of the host.
"""

from __future__ import annotations

import re
import subprocess
import sys
import unittest

BOARD, IMAGE, FRAMES = sys.argv[1], sys.argv[2], int(sys.argv[3])
LONGEST = 900  # s, on a loaded host
POP = "pop<canopen::ReceiveQueue<16u> >"
FAULTY = {"frees_first", "publishes_first", "shares_count"}


def output(*command: str) -> str:
    return subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=LONGEST).stdout


def instructions_of(function: str) -> list[int]:
    """Returns the offsets of its instructions in an image; what follows the last branch is padding."""
    listing = output("arm-none-eabi-objdump", "-d", "-C", "--no-show-raw-insn", IMAGE)
    body = re.search(rf"(?m)^[0-9a-f]+ <[^\n]*{re.escape(function)}\([^\n]*>:\n((?: +[0-9a-f]+:.*\n)+)", listing)[1]
    lines = [(int(line.split(":")[0], 16), line.split(":")[1].strip()) for line in body.splitlines()]
    while not re.match(r"b|pop|ldmia.*pc", lines[-1][1]):
        lines.pop()
    return [address - lines[0][0] for address, text in lines if not text.startswith(".")]


class InterruptQueue(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        printed = output("qemu-system-arm", "-M", BOARD, "-icount", "shift=5", "-semihosting", "-nographic", "-kernel", IMAGE)
        print(re.sub(r"(?m)^interrupted.*\n", "", printed))
        line = r"(?m)^(\w+) sent (\d+) received (\d+) overruns (\d+) refused (\d+) empty (\d+) fault (\w+)$"
        cls.runs = {name: [*map(int, numbers), fault] for name, *numbers, fault in re.findall(line, printed)}
        cls.interrupted = {int(place) for place in re.findall(r"(?m)^interrupted (\d+)$", printed)}

    def test_each_frame_arrives_or_is_counted(self) -> None:
        for name in ("receive_queue", "receive_queue_to_interrupt"):
            sent, received, overruns, refused, empty, fault = self.runs[name]
            with self.subTest(name):
                self.assertEqual(fault, "none")
                self.assertEqual(sent, FRAMES)
                self.assertEqual(received + overruns, sent)
                self.assertEqual(overruns, refused)
                self.assertGreater(received, FRAMES // 4)
                self.assertGreater(overruns, FRAMES // 1000)  # the queue was full, and empty, many times
                self.assertGreater(empty, FRAMES // 1000)

    def test_each_instruction_of_pop_was_interrupted(self) -> None:
        self.assertEqual([f"{place:#x}" for place in instructions_of(POP) if place not in self.interrupted], [])

    def test_finds_the_fault_of_each_faulty_queue(self) -> None:
        self.assertEqual({name for name, numbers in self.runs.items() if numbers[-1] != "none"}, FAULTY)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

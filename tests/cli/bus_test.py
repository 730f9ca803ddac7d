#!/usr/bin/env python3
"""The program edsc bus: its ports, its output, its end, and the socketcand interface of python-can with it.

    bus_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import contextlib
import logging
import re
import resource
import signal
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

EDSC = Path(sys.argv[2]).resolve()
ADDRESS = re.compile(r"socketcand:127\.0\.0\.1:(\d+)/(\w+)\n")
FINE, WRONG_USAGE = 0, 2


class Bus:
    """A running `edsc bus` on a free port."""

    def __init__(self, *arguments: str, buses: int = 1, open_files: int = 0) -> None:
        def limit() -> None:
            resource.setrlimit(resource.RLIMIT_NOFILE, (open_files, open_files))

        self.process = subprocess.Popen([EDSC, "bus", "--listen", "127.0.0.1:0", *arguments], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit if open_files else None)
        stream = self.process.stderr if "--log" in arguments else self.process.stdout
        self.addresses = [ADDRESS.fullmatch(stream.readline()) for _ in range(buses)]
        self.port = int(self.addresses[0][1])

    def __enter__(self) -> Bus:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()

    def end(self, with_signal: int = signal.SIGTERM) -> tuple[int, str, str]:
        """Ends it and returns the exit code, and what it printed after the addresses, on both streams."""
        self.process.send_signal(with_signal)
        return self.process.wait(timeout=600), self.process.stdout.read(), self.process.stderr.read()


class Client:
    def __init__(self, port: int, bus: str = "vcan0") -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=600)
        self.expect("< hi >")
        for command in (f"< open {bus} >", "< rawmode >"):
            self.say(command)
            self.expect("< ok >")

    def say(self, text: str) -> None:
        self.socket.sendall(text.encode())

    def hear(self, size: int) -> str:
        heard = b""
        while len(heard) < size and (more := self.socket.recv(size - len(heard))):
            heard += more
        return heard.decode()

    def expect(self, text: str) -> None:
        heard = self.hear(len(text))
        if heard != text:
            raise AssertionError(f"{heard!r}, wanted {text!r}")


class BusCommand(unittest.TestCase):
    def client(self, bus: Bus, *name: str) -> Client:
        client = Client(bus.port, *name)
        self.addCleanup(client.socket.close)
        return client

    def test_it_prints_its_addresses_and_ends_with_a_signal(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number), Bus("vcan0", "plant", buses=2) as bus:
                self.assertEqual([address[2] for address in bus.addresses], ["vcan0", "plant"])
                client = self.client(bus, "plant")
                self.assertEqual(bus.end(number), (FINE, "", ""))
                self.assertEqual(client.hear(1), "")

    def test_its_log_is_that_of_candump(self) -> None:
        with Bus("--log", "-") as bus:
            sender, other = self.client(bus), self.client(bus)
            before = time.time()
            sender.say("< send 605 2 40 0 >< sendrtr 705 1 >< send 00000123 0 >")
            heard = other.hear(len("< frame 605 1700000000.000000 4000 >< rtr 705 1700000000.000000 1 >"
                                   "< frame 00000123 1700000000.000000  >"))
            line = bus.process.stdout.readline()
            self.assertEqual(line.split(" ", 1)[1], "vcan0 605#4000\n")
            stamp = re.fullmatch(r"\((\d+\.\d{6})\)", line.split(" ")[0])[1]
            self.assertIn(f"< frame 605 {stamp} 4000 >", heard)
            self.assertLess(abs(float(stamp) - before), 5)
            code, printed, _ = bus.end()
            self.assertEqual(code, FINE)
            self.assertEqual([line.split(" ", 1)[1] for line in printed.splitlines()],
                             ["vcan0 705#R1", "vcan0 00000123#"])

    def test_its_log_is_one_for_decode_and_can_utils(self) -> None:
        with Bus("--log", "-") as bus:
            sender = self.client(bus)
            sender.say("< send 705 1 5 >< sendrtr 705 1 >< send 00000123 0 >< echo >")
            sender.expect("< echo >")
            code, log, _ = bus.end()
        self.assertEqual(code, FINE)
        decoded = subprocess.run([EDSC, "decode", "-"], input=log, capture_output=True, text=True, timeout=60)
        self.assertEqual((decoded.returncode, decoded.stderr), (FINE, ""))
        self.assertEqual(len(decoded.stdout.splitlines()), 3)

    def test_silent_connections_do_not_keep_others_out(self) -> None:
        with Bus() as bus, contextlib.ExitStack() as silent:
            for _ in range(64):
                silent.enter_context(socket.create_connection(("127.0.0.1", bus.port), timeout=60)).recv(6)
            while True:
                with socket.create_connection(("127.0.0.1", bus.port), timeout=60) as late:
                    if late.recv(6) == b"< hi >":
                        late.sendall(b"< open vcan0 >")
                        self.assertEqual(late.recv(6), b"< ok >")
                        break
                time.sleep(0.1)
            _, _, complained = bus.end()
        self.assertIn("is disconnected: it did not open a bus within 5000 ms", complained)

    def test_it_complains_about_bad_clients(self) -> None:
        with Bus("--clients", "1") as bus:
            with socket.create_connection(("127.0.0.1", bus.port), timeout=600) as bad:
                bad.sendall(b"\0\xff" * 1000 + b"<" * 10 + b"x" * 1000)
                while bad.recv(1000):
                    pass
            first = self.client(bus)
            with socket.create_connection(("127.0.0.1", bus.port), timeout=600) as second:
                self.assertEqual(second.recv(1000), b"< error too many clients >")
            first.say("< echo >")
            first.expect("< echo >")
            code, _, complained = bus.end()
            self.assertEqual(code, FINE)
            self.assertRegex(complained, r"\Aedsc: client 127\.0\.0\.1:\d+ is disconnected: element too long\n"
                                         r"edsc: client 127\.0\.0\.1:\d+ is disconnected: too many clients\n\Z")

    def test_more_clients_than_it_can_have_files(self) -> None:
        with Bus(open_files=24) as bus, contextlib.ExitStack() as stack:
            first = self.client(bus)
            refused = 0
            for _ in range(30):
                other = stack.enter_context(socket.create_connection(("127.0.0.1", bus.port), timeout=600))
                answer = other.recv(1000)
                refused += answer == b"< error too many open files >"
                self.assertIn(answer, (b"< hi >", b"< error too many open files >"))
            self.assertGreater(refused, 5)
            first.say("< echo >")
            first.expect("< echo >")
            stack.close()
            first.say("< echo >")  # after the ends of the others
            first.expect("< echo >")
            self.client(bus)
            code, _, complained = bus.end()
            self.assertEqual(code, FINE)
            self.assertEqual(complained.count("is disconnected: too many open files\n"), refused)

    def test_what_it_refuses(self) -> None:
        with Bus() as bus:
            for arguments, words in ((("--listen", f"127.0.0.1:{bus.port}"), "Address already in use"),
                                     (("--listen", "127.0.0.1"), "expected HOST:PORT"),
                                     (("--listen", "192.0.2.1:0"), "Cannot assign requested address"),
                                     (("a/b",), "not a bus name"),
                                     (("--clients", "0"), "--clients")):
                with self.subTest(arguments=arguments):
                    result = subprocess.run([EDSC, "bus", *arguments], capture_output=True, text=True, timeout=600)
                    self.assertEqual(result.returncode, WRONG_USAGE)
                    self.assertIn(words, result.stderr + result.stdout)


class PythonCan(unittest.TestCase):
    """The socketcand interface of python-can as packaged in Debian."""

    def test_frames_go_both_ways(self) -> None:
        try:
            import can
        except ImportError:
            self.skipTest("python3-can is not installed")
        with Bus() as bus:
            options = {"interface": "socketcand", "host": "127.0.0.1", "port": bus.port, "channel": "vcan0"}
            first, second = can.Bus(**options), can.Bus(**options)
            other = Client(bus.port)
            for can_id, data in ((0x000, b"\x01\x05"), (0x605, bytes(range(8))), (0x80, b""), (0x1FFFFFFF, b"\xff")):
                first.send(can.Message(arbitration_id=can_id, data=data, is_extended_id=can_id > 0x7FF))
                message = second.recv(timeout=600)
                self.assertEqual((message.arbitration_id, bytes(message.data)), (can_id, data))
            other.say("< sendrtr 705 1 >< send 701 1 5 >")
            logging.disable()  # it ignores the remote frame, and logs that
            self.assertEqual(second.recv(timeout=600).arbitration_id, 0x701)
            logging.disable(logging.NOTSET)
            first.shutdown()
            second.shutdown()
            other.socket.close()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

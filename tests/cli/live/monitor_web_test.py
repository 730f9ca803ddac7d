#!/usr/bin/env python3
"""edsc monitor --web and clients that are not its page: without the token, of other sites, slow, many, garbage.

    monitor_web_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import random
import re
import signal
import socket
import time
from pathlib import Path

from live import FINE, WRONG_USAGE, LiveTest, run

PATIENCE = 300.0  # seconds for an answer, even on a busy machine
STREAMS = 16


class MonitorWeb(LiveTest):
    nodes = (5,)

    def setUp(self) -> None:
        super().setUp()
        self.monitor = self.start("monitor", "--node", "5=device.eds", "--web", "127.0.0.1:0")
        self.url = self.monitor.stdout.readline().strip()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{64})", self.url)
        self.assertIsNotNone(found, self.url)
        self.port, self.token = int(found[1]), found[2]
        self.host = f"127.0.0.1:{self.port}"

    # Clients

    def connect(self, receive_buffer: int = 0) -> socket.socket:
        client = socket.socket()
        self.addCleanup(client.close)
        if receive_buffer:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        client.settimeout(PATIENCE)
        client.connect(("127.0.0.1", self.port))
        return client

    def request(self, target: str = "", method: str = "GET", host: str = "", **headers: str) -> bytes:
        target = target or f"/?token={self.token}"
        lines = [f"{method} {target} HTTP/1.1", f"Host: {host or self.host}",
                 *(f"{name.replace('_', '-')}: {value}" for name, value in headers.items())]
        return "\r\n".join([*lines, "", ""]).encode()

    def answer(self, request: bytes) -> tuple[int, str, str]:
        """Status, headers and body; status 0: closed without an answer."""
        client = self.connect()
        heard = b""
        try:
            client.sendall(request)
            while more := client.recv(65536):
                heard += more
        except ConnectionError:
            pass
        head, _, body = heard.decode("utf-8", "replace").partition("\r\n\r\n")
        return (int(head.split()[1]) if head else 0), head, body

    def open_stream(self, receive_buffer: int = 0) -> socket.socket:
        client = self.connect(receive_buffer)
        client.sendall(self.request(f"/events?token={self.token}"))
        return client

    def status_of(self, client: socket.socket) -> int:
        heard = b""
        while b"\r\n" not in heard:
            heard += client.recv(1)
        return int(heard.split()[1])

    @staticmethod
    def rows_of(client: socket.socket, wanted: str) -> dict:
        """The next row of this kind."""
        heard = b""
        while True:
            heard += client.recv(65536)
            for event in re.findall(rb"^data: (.*)\n\n", heard, re.MULTILINE):
                for row in json.loads(event)["rows"]:
                    if row["kind"] == wanted:
                        return row

    def expect_alive(self) -> None:
        """The page is there, and its events are those of the bus now."""
        self.assertEqual(self.answer(self.request())[0], 200)
        first, second = (self.rows_of(self.open_stream(), "bus")["at_us"] for _ in range(2))
        self.assertGreaterEqual(second, first)
        self.assertIsNone(self.monitor.poll())

    def memory_kb(self) -> int:
        return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{self.monitor.pid}/status").read_text())[1])

    # What is answered

    def test_the_page_and_its_headers(self) -> None:
        status, head, body = self.answer(self.request())
        self.assertEqual(status, 200)
        self.assertIn(self.network.address, body)
        nonce = re.search(r"script-src 'nonce-([0-9a-f]{64})'", head)[1]
        self.assertEqual(len(re.findall(rf'<(?:script|style) nonce="{nonce}">', body)),
                         len(re.findall(r"<(?:script|style)\b", body)))
        self.assertIn("default-src 'none'", head)
        self.assertNotIn("unsafe", head)
        for header in ("Cache-Control: no-store", "Referrer-Policy: no-referrer", "X-Content-Type-Options: nosniff"):
            self.assertIn(header, head)
        self.assertNotIn(nonce, self.answer(self.request())[2], "a nonce is used once")

    def test_refused_requests(self) -> None:
        wrong = self.token[:-1] + ("0" if self.token[-1] != "0" else "1")
        rows = {
            "no token": (403, self.request("/")),
            "no token for the events": (403, self.request("/events")),
            "a wrong token": (403, self.request(f"/?token={wrong}")),
            "a beginning of the token": (403, self.request(f"/?token={self.token[:-1]}")),
            "a longer token": (403, self.request(f"/?token={self.token}0")),
            "another site's name": (421, self.request(host=f"rebound.example:{self.port}")),
            "another port": (421, self.request(host="127.0.0.1:1")),
            "an address that is not this computer's": (421, self.request(host=f"192.0.2.1:{self.port}")),
            "no Host": (421, f"GET /?token={self.token} HTTP/1.1\r\n\r\n".encode()),
            "another site's page": (403, self.request(Origin="http://evil.example")),
            "a page without an origin": (403, self.request(Origin="null")),
            "another method": (405, self.request(method="POST", Content_Length="0")),
            "another path": (404, self.request(f"/etc/passwd?token={self.token}")),
            "a part": (416, self.request(Range="bytes=0-1")),
        }
        for name, (expected, request) in rows.items():
            with self.subTest(name):
                status, head, body = self.answer(request)
                self.assertEqual(status, expected)
                self.assertNotIn(self.token, head + body)
                self.assertNotIn("socketcand", head + body)
        self.assertIn("Open the URL that edsc monitor prints", self.answer(self.request("/"))[2])
        for host in (f"localhost:{self.port}", f"[::1]:{self.port}"):
            self.assertEqual(self.answer(self.request(host=host))[0], 200)
        self.assertEqual(self.answer(self.request(Origin=f"http://{self.host}"))[0], 200)
        self.expect_alive()

    def test_garbage(self) -> None:
        noise = random.Random(1)
        valid = self.request()
        requests = [b"", b"\0" * 100, b"\r\n" * 100, b"GET", b"GET / HTTP/9.9\r\n\r\n", b"\x16\x03\x01\x02\x00\x01",
                    *(noise.randbytes(noise.randrange(1, 400)) + b"\r\n\r\n" for _ in range(40)),
                    *(valid[:at] + noise.randbytes(3) + valid[at + 3:] for at in range(0, len(valid), 5)),
                    self.request(f"/?token={'%' * 50}"), self.request("/?" + "a=b&" * 500), self.request("/" + "../" * 200)]
        for request in requests:
            client = self.connect()
            client.sendall(request)
            client.shutdown(socket.SHUT_WR)
            try:
                while client.recv(65536):
                    pass
            except ConnectionError:
                pass
        self.expect_alive()

    def test_requests_without_an_end(self) -> None:
        """One header of any length, and any number of headers: the server stops reading, and its memory does not grow."""
        before = self.memory_kb()
        for part in (b"x" * 65536, b"Name: value\r\n" * 5000):
            client = self.connect()
            client.sendall(f"GET /?token={self.token} HTTP/1.1\r\nHost: {self.host}\r\n".encode())
            with self.assertRaises(ConnectionError):
                for _ in range(2000):
                    client.sendall(part)
        self.assertLess(self.memory_kb(), before + 20_000)
        self.expect_alive()

    def test_silent_and_slow_clients(self) -> None:
        """More connections than threads, which send nothing or a byte now and then: each gets five seconds."""
        clients = [self.connect() for _ in range(50)]
        for client in clients[:25]:
            client.sendall(b"G")
        self.expect_alive()

    def test_connections_wait_in_a_long_queue(self) -> None:
        """While the server does not accept any, such as on a busy computer, the system keeps more than the five of httplib."""
        self.monitor.send_signal(signal.SIGSTOP)
        try:
            clients = [self.connect() for _ in range(60)]
        finally:
            self.monitor.send_signal(signal.SIGCONT)
        self.assertEqual(len(clients), 60)
        self.expect_alive()

    def test_many_silent_clients(self) -> None:
        """The five seconds of all pass at the same time, and none delays the end. One after another they take 50 seconds."""
        clients = [self.connect() for _ in range(320)]
        for client in clients:
            client.sendall(b"G")
        begin = time.monotonic()
        self.assertEqual(self.answer(self.request())[0], 200)
        self.assertLess(time.monotonic() - begin, 30)
        clients = [self.connect() for _ in range(320)]
        begin = time.monotonic()
        self.monitor.send_signal(signal.SIGINT)
        self.assertEqual((self.monitor.wait(timeout=PATIENCE), self.monitor.stderr.read()), (FINE, ""))
        self.assertLess(time.monotonic() - begin, 30)

    def test_a_client_that_does_not_read(self) -> None:
        sleeper = self.open_stream(receive_buffer=4096)
        self.assertEqual(self.status_of(sleeper), 200)
        before = self.memory_kb()
        bus = self.network.client()
        heard, begin = 0, time.monotonic()
        watcher = self.open_stream()
        while time.monotonic() < begin + 12 or (heard <= 500 and time.monotonic() < begin + PATIENCE):
            for data in range(50):
                bus.send(f"205 {data:02X} 00 00 00")
            heard = self.rows_of(watcher, "bus")["frames"]
        self.assertGreater(heard, 500)
        self.assertLess(self.memory_kb(), before + 20_000)
        self.expect_alive()

    def test_many_streams(self) -> None:
        streams = [self.open_stream() for _ in range(STREAMS)]
        for stream in streams:
            self.assertEqual(self.status_of(stream), 200)
        status, head, _ = self.answer(self.request(f"/events?token={self.token}"))
        self.assertEqual(status, 503)
        self.assertIn("Retry-After: 5", head)
        self.assertEqual(self.answer(self.request())[0], 200)
        for stream in streams:
            stream.close()
        end = time.monotonic() + PATIENCE
        while (status := self.status_of(self.open_stream())) != 200 and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(status, 200)

    def test_it_ends_with_open_streams_and_sends_nothing(self) -> None:
        stream, silent = self.open_stream(), self.connect()
        self.assertEqual(self.rows_of(stream, "node")["node_id"], 5)
        client = self.network.client()
        client.send("085 30 81 11 00 00 00 00 00")
        emcy = self.rows_of(stream, "emcy")
        self.assertEqual((emcy["number"], emcy["node_id"], emcy["code"]), (0, 5, 0x8130))
        self.monitor.send_signal(signal.SIGINT)
        self.assertEqual((self.monitor.wait(timeout=PATIENCE), self.monitor.stderr.read()), (FINE, ""))
        silent.close()
        self.assertEqual([frame for frame in self.network.frames() if not frame.startswith(("705", "085"))], [])

    def test_wrong_usage(self) -> None:
        used = self.edsc("monitor", "--web", self.host)
        self.expect(used, WRONG_USAGE, stderr=f"edsc: cannot listen at {self.host}\n")
        for arguments in (("--web", "nowhere"), ("--web", "127.0.0.1:70000"), ("--web", "127.0.0.1:0", "--once", "1s")):
            self.assertEqual(self.edsc("monitor", *arguments).returncode, WRONG_USAGE, arguments)

    def test_other_computers_are_warned_of(self) -> None:
        monitor = self.start("monitor", "--web", "0.0.0.0:0")
        self.assertIn("the connection is not encrypted", monitor.stderr.readline())
        monitor.send_signal(signal.SIGINT)
        self.assertEqual(monitor.wait(timeout=PATIENCE), FINE)


if __name__ == "__main__":
    run()

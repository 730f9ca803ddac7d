#!/usr/bin/env python3
"""The server of edsc edit: what it answers, what it refuses, and what it writes.

    edit_test.py SOURCE_DIR EDSC

The oracle of a change is `edsc dump` of the written file, of which one value must differ from the dump of the file before.
"""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import jsonschema

SOURCE_DIR, EDSC = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
SHEET = SOURCE_DIR / "eds/cpc-tc1.eds"
INTERRUPTED, WRONG_USAGE = 130, 2
BODY_LIMIT, IMPORT_LIMIT = 65_536, 4 << 20


class Server:
    """edsc edit with a page that has a session."""

    def __init__(self, folder: Path, name: str = "drive.eds") -> None:
        environment = {**os.environ, "XDG_STATE_HOME": str(folder / "state"), "GIT_CEILING_DIRECTORIES": str(folder)}
        self.process = subprocess.Popen([EDSC, "edit", name, "--no-browser"], cwd=folder, env=environment, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.token = self.read_token()
        self.session = ""
        self.version = 0

    def read_token(self) -> str:
        url = urlsplit(self.process.stdout.readline())
        self.port = url.port
        self.host = f"127.0.0.1:{url.port}"
        return parse_qs(url.query)["token"][0].strip()

    def raw(self, method: str, path: str, body: bytes | None = None, headers: dict[str, str] | None = None) -> tuple[int, bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        with contextlib.closing(connection):
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            for name, value in (headers or {}).items():
                connection.putheader(name, value)
            connection.endheaders(body)
            answer = connection.getresponse()
            self.headers = answer.headers
            return answer.status, answer.read()

    def good_headers(self, body: bytes | None) -> dict[str, str]:
        headers = {"Host": self.host, "X-Edsc-Session": self.session}
        if body is not None:
            headers |= {"Origin": f"http://{self.host}", "Content-Type": "application/json", "Content-Length": str(len(body))}
        return headers

    def get(self, path: str) -> tuple[int, bytes]:
        return self.raw("GET", path, None, self.good_headers(None))

    def post(self, action: str, request: object) -> dict:
        body = json.dumps(request).encode()
        status, answer = self.raw("POST", f"/{action}", body, self.good_headers(body))
        if status != 200:
            raise AssertionError((action, status, answer))
        return json.loads(answer)

    def begin(self) -> None:
        self.session = self.post("session", {"token": self.token})["session"]

    def change(self, *changes: dict) -> dict:
        return self.post("change", {"since": 0, "changes": changes})

    def state(self) -> dict:
        return json.loads(self.get("/state?since=0")[1])["parts"]

    def end(self, number: int = signal.SIGINT) -> int:
        if self.process.poll() is None:
            self.process.send_signal(number)
        status = self.process.wait(60)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            stream.close()
        return status


def change_of(section: str, key: str, value: str) -> dict:
    return {"do": "set", "section": section, "key": key, "value": value}


def dump(path: Path) -> dict:
    return json.loads(subprocess.run([EDSC, "dump", path], capture_output=True, text=True, check=True, timeout=60).stdout)


def differences(one: object, other: object, place: str = "") -> list[str]:
    if isinstance(one, dict) and isinstance(other, dict):
        return [line for key in {**one, **other} for line in differences(one.get(key), other.get(key), f"{place}/{key}")]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [line for i, pair in enumerate(zip(one, other)) for line in differences(*pair, f"{place}/{i}")]
    return [] if one == other else [place]


class Edit(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.file = self.folder / "drive.eds"
        shutil.copy(SHEET, self.file)
        self.original = self.file.read_bytes()

    def start(self, name: str = "drive.eds") -> Server:
        server = Server(self.folder, name)
        self.addCleanup(server.end, signal.SIGKILL)
        server.begin()
        return server


class Saved(Edit):
    def test_value_of_one_entry(self) -> None:
        before = dump(self.file)
        server = self.start()
        answer = server.change(change_of("1017", "DefaultValue", "1234"))
        self.assertNotIn("rejected", answer)
        self.assertEqual(self.file.read_bytes(), self.original)
        self.assertIn("1234", json.loads(server.get("/diff")[1])["diff"])
        self.assertTrue(server.state()["status"]["dirty"])
        review = server.post("review", {})
        self.assertIn("+", review["diff"])
        server.post("save", {"since": 0})
        changed = differences(before, dump(self.file))
        self.assertTrue(changed)
        self.assertTrue(all("default" in place or "value" in place for place in changed), changed)
        lines = [(a, b) for a, b in zip(self.original.splitlines(), self.file.read_bytes().splitlines()) if a != b]
        self.assertEqual(len(lines), 1, lines)
        server.post("undo", {"since": 0})
        server.post("save", {"since": 0})
        self.assertEqual(self.file.read_bytes(), self.original)
        self.assertEqual(server.end(), INTERRUPTED)
        self.assertEqual(list((self.folder / "state/edsc").iterdir()), [])

    def test_schema_of_the_state(self) -> None:
        schema = json.loads((SOURCE_DIR / "docs/schema/edit.schema.json").read_text(encoding="utf-8"))
        validator = jsonschema.Draft202012Validator(schema)
        for sheet in sorted((SOURCE_DIR / "eds").glob("*.eds")):
            with self.subTest(sheet.name):
                shutil.copy(sheet, self.folder)
                server = self.start(sheet.name)
                server.change({"do": "remove", "section": "1017"})
                for since in (0, 1):
                    answer = json.loads(server.get(f"/state?since={since}")[1])
                    self.assertEqual([error.message for error in validator.iter_errors(answer)], [])
                server.end(signal.SIGKILL)

    def test_only_what_changed_is_answered(self) -> None:
        server = self.start()
        version = json.loads(server.get("/state?since=0")[1])["version"]
        answer = server.post("change", {"since": version, "changes": [change_of("1017", "DefaultValue", "1234")]})
        self.assertEqual([name for name in answer["parts"] if name.startswith("object/")], ["object/1017"])

    def test_section(self) -> None:
        server = self.start()
        section = json.loads(server.get("/section?title=1017")[1])
        lines = self.original.decode().splitlines()
        self.assertEqual(section["lines"], lines[section["line"] - 1:section["line"] - 1 + len(section["lines"])])
        self.assertEqual(server.get("/section?title=nothing")[0], 404)

    def test_import(self) -> None:
        server = self.start()
        other = (SOURCE_DIR / "eds/cpd.eds").read_text(encoding="utf-8")
        self.assertGreater(len(other), BODY_LIMIT // 2)
        objects = server.post("import", {"text": other})["objects"]
        known = set(server.state()["tree"]["areas"][0]["objects"])
        new = next(one["index"] for one in objects if one["index"] >= "2000" and one["index"] not in known)
        answer = server.change({"do": "new", "kind": "import", "objects": [new]})
        if "rejected" not in answer:
            self.assertIn(f"object/{new}", answer["parts"])

    def test_hostile_names(self) -> None:
        name = "</script><img src=x onerror=alert(1)>\u202e"
        server = self.start()
        answer = server.change(change_of("1017", "ParameterName", name))
        if "rejected" in answer:
            answer = server.post("change", {"changes": [change_of("1017", "ParameterName", name)], "force": True})
        self.assertNotIn("rejected", answer)
        self.assertEqual(server.state()["object/1017"]["name"], name)
        page = server.raw("GET", "/", None, {"Host": server.host})[1].decode()
        self.assertNotIn("onerror", page)


class Journal(Edit):
    def test_unsaved_edits_after_kill(self) -> None:
        server = self.start()
        server.change(change_of("1017", "DefaultValue", "1234"))
        server.change(change_of("1017", "ParameterName", "Heartbeat"))
        self.assertEqual(server.end(signal.SIGKILL), -signal.SIGKILL)
        self.assertEqual(self.file.read_bytes(), self.original)
        server = self.start()
        journal = server.state()["status"]["journal"]
        self.assertEqual(journal["edits"], 2)
        self.assertIn("rejected", server.change(change_of("1017", "DefaultValue", "1")))
        server.post("journal", {"since": 0, "use": True})
        self.assertEqual(server.state()["object/1017"]["name"], "Heartbeat")
        server.post("undo", {"since": 0})
        server.post("save", {"since": 0})
        self.assertIn(b"1234", self.file.read_bytes())
        self.assertNotIn(b"ParameterName=Heartbeat\n", self.file.read_bytes().replace(b"\r", b""))

    def test_second_session_is_refused(self) -> None:
        self.start()
        environment = {**os.environ, "XDG_STATE_HOME": str(self.folder / "state")}
        second = subprocess.run([EDSC, "edit", "drive.eds", "--no-browser"], cwd=self.folder, env=environment, text=True,
                                capture_output=True, timeout=60, stdin=subprocess.DEVNULL)
        self.assertEqual(second.returncode, WRONG_USAGE)
        self.assertIn("another edsc edit", second.stderr)

    def test_interrupt_keeps_unsaved_edits(self) -> None:
        server = self.start()
        server.change(change_of("1017", "DefaultValue", "1234"))
        self.assertEqual(server.end(), INTERRUPTED)
        self.assertEqual(self.start().state()["status"]["journal"]["edits"], 1)


class OtherProgram(Edit):
    def test_file_changed_on_disk(self) -> None:
        server = self.start()
        server.change(change_of("1017", "DefaultValue", "1234"))
        theirs = self.original.replace(b"ParameterName=", b"ParameterName=X", 1)
        self.file.write_bytes(theirs)
        waited = json.loads(server.get(f"/state?since={server.post('review', {}) and 0}")[1])["parts"]["status"]
        self.assertIn("changed", waited["message"])
        self.assertEqual(waited["conflicts"], [])
        self.assertEqual(self.file.read_bytes(), theirs)
        server.post("save", {"since": 0})
        self.assertIn(b"1234", self.file.read_bytes())
        self.assertIn(b"ParameterName=X", self.file.read_bytes())

    def test_waiting_page_learns_of_it(self) -> None:
        server = self.start()
        version = json.loads(server.get("/state?since=0")[1])["version"]
        self.file.write_bytes(self.original + b"; by another program\r\n")
        start = time.monotonic()
        answer = json.loads(server.get(f"/state?since={version}&wait=1")[1])
        self.assertIn("status", answer["parts"])
        self.assertLess(time.monotonic() - start, 4)


class Refused(Edit):
    def test_hostile_requests(self) -> None:
        server = self.start()
        body = json.dumps({"changes": [change_of("1017", "DefaultValue", "1")]}).encode()
        good = server.good_headers(body)
        cases = [
            ("other origin", "POST", "/change", {"Origin": "http://evil.example"}, 403),
            ("no origin", "POST", "/change", {"Origin": None}, 403),
            ("null origin", "POST", "/change", {"Origin": "null"}, 403),
            ("other port", "POST", "/change", {"Origin": f"http://127.0.0.1:{server.port + 1}"}, 403),
            ("rebound name", "POST", "/change", {"Host": f"evil.example:{server.port}", "Origin": f"http://evil.example:{server.port}"}, 421),
            ("other port in Host", "POST", "/change", {"Host": "127.0.0.1:1"}, 421),
            ("no Host", "POST", "/change", {"Host": None}, 421),
            ("no session", "POST", "/change", {"X-Edsc-Session": None}, 403),
            ("wrong session", "POST", "/change", {"X-Edsc-Session": "0" * 64}, 403),
            ("token as session", "POST", "/change", {"X-Edsc-Session": server.token}, 403),
            ("type of a form", "POST", "/change", {"Content-Type": "application/x-www-form-urlencoded"}, 415),
            ("plain text", "POST", "/change", {"Content-Type": "text/plain"}, 415),
            ("no type", "POST", "/change", {"Content-Type": None}, 415),
            ("PUT", "PUT", "/change", {}, 405),
            ("DELETE", "DELETE", "/", {}, 405),
            ("GET of a POST", "GET", "/change", {}, 405),
            ("POST of a GET", "POST", "/state", {}, 405),
            ("OPTIONS", "OPTIONS", "/change", {}, 405),
            ("unknown path", "GET", "/etc/passwd", {}, 404),
            ("path outside", "GET", "/../drive.eds", {}, 404),
            ("range", "GET", "/state?since=0", {"Range": "bytes=0-1"}, 416),
        ]
        for name, method, path, other, expected in cases:
            with self.subTest(name):
                headers = {key: value for key, value in {**good, **other}.items() if value is not None}
                self.assertEqual(server.raw(method, path, body, headers)[0], expected)
        self.assertFalse(server.state()["status"]["dirty"])

    def test_state_needs_a_session(self) -> None:
        server = self.start()
        for path in ("/state?since=0", "/section?title=1017", "/diff"):
            with self.subTest(path):
                status, answer = server.raw("GET", path, None, {"Host": server.host})
                self.assertEqual(status, 403)
                self.assertNotIn(b"1017", answer)

    def test_token_works_once(self) -> None:
        server = self.start()
        body = json.dumps({"token": server.token}).encode()
        self.assertEqual(server.raw("POST", "/session", body, server.good_headers(body))[0], 403)
        server.process.stdin.write("u\n")
        server.process.stdin.flush()
        second = server.read_token()
        self.assertNotEqual(second, server.token)
        self.assertIn("session", server.post("session", {"token": second}))

    def test_sizes(self) -> None:
        server = self.start()
        headers = server.good_headers(b"")
        for action, size, expected in (("change", BODY_LIMIT + 1, 413), ("import", IMPORT_LIMIT + 1, 413), ("change", 1 << 60, 413)):
            with self.subTest(action=action, size=size):
                self.assertEqual(server.raw("POST", f"/{action}", None, {**headers, "Content-Length": str(size)})[0], expected)
        without = {key: value for key, value in headers.items() if key != "Content-Length"}
        self.assertEqual(server.raw("POST", "/change", None, without)[0], 411)
        self.assertEqual(server.raw("POST", "/change", None, {**without, "Transfer-Encoding": "chunked"})[0], 411)
        limit = json.dumps({"changes": [], "x": "y" * (BODY_LIMIT - 30)}).encode()
        self.assertLessEqual(len(limit), BODY_LIMIT)
        self.assertEqual(server.raw("POST", "/change", limit, server.good_headers(limit))[0], 200)

    def test_malformed_bodies(self) -> None:
        server = self.start()
        for body in (b"{", b"[]", b"\xff\xfe", b'{"changes":1}', b'{"since":-1,"changes":[]}', b"[" * 60_000):
            with self.subTest(body[:20]):
                self.assertEqual(server.raw("POST", "/change", body, server.good_headers(body))[0], 400)
        self.assertFalse(server.state()["status"]["dirty"])

    def test_only_this_computer(self) -> None:
        server = self.start()
        with open("/proc/net/tcp", encoding="ascii") as table:
            rows = [line.split()[1] for line in table.readlines()[1:] if line.split()[1].endswith(f":{server.port:04X}")]
        self.assertTrue(rows)
        self.assertTrue(all(row.startswith("0100007F") for row in rows), rows)

    def test_headers_of_the_page(self) -> None:
        server = self.start()
        status, page = server.raw("GET", "/", None, {"Host": server.host})
        self.assertEqual(status, 200)
        policy = server.headers["Content-Security-Policy"]
        nonce = policy.split("'nonce-")[1].split("'")[0]
        self.assertIn(nonce.encode(), page)
        self.assertNotIn("unsafe", policy)
        self.assertIn("default-src 'none'", policy)
        self.assertEqual(server.headers["X-Content-Type-Options"], "nosniff")
        self.assertIsNone(server.headers["Set-Cookie"])
        server.raw("GET", "/", None, {"Host": server.host})
        self.assertNotIn(nonce, server.headers["Content-Security-Policy"])

    def test_files_that_cannot_be_edited(self) -> None:
        (self.folder / "a.xdd").write_text("<?xml version='1.0'?><ISO15745ProfileContainer/>", encoding="ascii")
        environment = {**os.environ, "XDG_STATE_HOME": str(self.folder / "state")}
        for name in ("missing.eds", "a.xdd", ".", "-"):
            with self.subTest(name):
                result = subprocess.run([EDSC, "edit", name, "--no-browser"], cwd=self.folder, env=environment, text=True,
                                        capture_output=True, timeout=60, stdin=subprocess.DEVNULL)
                self.assertEqual(result.returncode, WRONG_USAGE, result)
                self.assertEqual(result.stdout, "")

    def test_slow_client_does_not_stop_others(self) -> None:
        server = self.start()
        with socket.create_connection(("127.0.0.1", server.port)) as slow:
            slow.sendall(b"POST /change HTTP/1.1\r\n")
            start = time.monotonic()
            server.state()
            self.assertLess(time.monotonic() - start, 3)


class End(Edit):
    def test_ends_after_the_last_page(self) -> None:
        server = self.start()
        server.get("/state?since=0")
        start = time.monotonic()
        server.post("close", {})
        self.assertEqual(server.process.wait(60), 0)
        self.assertGreater(time.monotonic() - start, 9)
        self.assertLess(time.monotonic() - start, 25)

    def test_does_not_end_with_unsaved_edits(self) -> None:
        server = self.start()
        server.change(change_of("1017", "DefaultValue", "1234"))
        server.post("close", {})
        time.sleep(12)
        self.assertIsNone(server.process.poll())
        server.post("save", {"since": 0})
        server.post("close", {})
        self.assertEqual(server.process.wait(60), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/env python3
"""The server of edsc edit: what it answers, what it refuses, and what it writes.

    edit_test.py SOURCE_DIR EDSC

The oracle of a change is `edsc dump` of the written file, of which one value must differ from the dump of the file before; of a network
file it is the JSON of Python, and `edsc network check`.
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


class NetworkFile(Edit):
    """A plant of the examples, with a comment in it, and the EDS files that it names."""

    def setUp(self) -> None:
        super().setUp()
        for sheet in (SOURCE_DIR / "eds").glob("can-20*.*"):
            shutil.copy(sheet, self.folder)
        text = (SOURCE_DIR / "examples/networks/four_modules.json").read_text(encoding="utf-8").replace("../../eds/", "")
        self.plant = self.folder / "plant.json"
        self.plant.write_text(text.replace('"length_m": 100,', '"length_m": 100, // measured'), encoding="utf-8")
        self.original = self.plant.read_bytes()

    def edit(self) -> Server:
        return self.start("plant.json")

    def contents(self) -> dict:
        return json.loads(self.plant.read_text(encoding="utf-8").replace(" // measured", ""))

    def findings(self) -> list[dict]:
        result = subprocess.run([EDSC, "network", "check", self.plant, "--format", "json"], capture_output=True, text=True, check=False)
        return json.loads(result.stdout)["diagnostics"]

    def assert_findings_are_of_check(self, server: Server) -> None:
        server.post("save", {"since": 0})
        shown = [(one["severity"], one["rule"], one["line"]) for one in server.state()["findings"]["list"]]
        # A finding of another file does not have a line of the network file.
        checked = [(one["severity"], one["rule"], one["line"] if one["file"].endswith("plant.json") else 0) for one in self.findings()]
        self.assertEqual(sorted(shown), sorted(checked))

    def test_changes_are_those_of_the_json(self) -> None:
        expected = self.contents()
        server = self.edit()
        self.assertEqual(server.state()["file"]["kind"], "network")
        members = {"from": "buttons", "object": "6000h:01", "to": ["controller", "digital_outputs.6200h:02"], "every_ms": "20"}
        steps = (
            [{"do": "set", "pointer": "/bit_rate", "value": "250"}],
            [{"do": "set", "pointer": "/sync/period_us", "value": "0x2710"}],
            [{"do": "set", "pointer": "/nodes/analog_inputs/set/1404h:02", "value": "254"}],
            [{"do": "rename", "pointer": "/nodes/digital_inputs", "name": "buttons"}, {"do": "remove", "pointer": "/signals/11"},
             {"do": "move", "pointer": "/signals/10", "to": 0}],
            [{"do": "add", "pointer": "/signals/-", "members": members},
             {"do": "add", "pointer": "/nodes/more", "members": {"node_id": "9", "eds": "can-2053c.eds"}}],
        )
        for step in steps:
            self.assertNotIn("rejected", server.change(*step))
        self.assertEqual(self.plant.read_bytes(), self.original)
        answer = server.change({"do": "remove", "pointer": "/signals/1"}, {"do": "remove", "pointer": "/signals/1"})
        self.assertNotIn("rejected", answer)
        server.post("undo", {"since": 0})
        server.post("save", {"since": 0})

        expected["bit_rate"] = 250
        expected["sync"] = {"period_us": 10000}
        nodes = expected["nodes"]
        nodes["analog_inputs"]["set"] = {"1404h:02": 254}
        expected["nodes"] = {{"digital_inputs": "buttons"}.get(name, name): node for name, node in nodes.items()}
        expected["nodes"]["more"] = {"node_id": 9, "eds": "can-2053c.eds"}
        signals = expected["signals"]
        for signal_ in signals:
            if signal_["from"] == "digital_inputs":
                signal_["from"] = "buttons"
        del signals[11]
        signals.insert(0, signals.pop(10))
        signals.append({**members, "every_ms": 20})
        self.assertEqual(json.dumps(self.contents()), json.dumps(expected), "in the order of the file")
        self.assertIn(b'"length_m": 100, // measured\n', self.plant.read_bytes())
        self.assert_findings_are_of_check(server)

    def test_rejected_and_forced(self) -> None:
        server = self.edit()
        for value in ("128", "x", "-1", "1.5"):
            rejected = server.change({"do": "set", "pointer": "/nodes/analog_inputs/node_id", "value": value})["rejected"]
            self.assertIn("from 1 to 127", rejected["message"])
            self.assertFalse(rejected["can_force"])
        same = [{"do": "set", "pointer": "/length_m", "value": "50"}, {"do": "set", "pointer": "/nodes/analog_inputs/node_id", "value": "1"}]
        rejected = server.change(*same)["rejected"]
        self.assertEqual((rejected["index"], rejected["can_force"]), (1, True))
        self.assertIn("/nodes/analog_inputs", [one["section"][:20] for one in rejected["findings"]])
        self.assertFalse(server.state()["status"]["dirty"])
        server.post("change", {"changes": same, "force": True})
        self.assertGreater(server.state()["findings"]["errors"], 0)
        self.assert_findings_are_of_check(server)
        server.post("undo", {"since": 0})
        server.post("save", {"since": 0})
        self.assertEqual(self.plant.read_bytes(), self.original)

    def test_bus_load_that_remains_too_high(self) -> None:
        self.plant.write_bytes(self.original.replace(b'"bit_rate": 125', b'"bit_rate": 10'))
        server = self.edit()
        load = [one["message"] for one in server.state()["findings"]["list"] if one["rule"] == "network-load"]
        self.assertNotIn("rejected", server.change({"do": "set", "pointer": "/nodes/controller/heartbeat_ms", "value": "1000"}))
        less = [one["message"] for one in server.state()["findings"]["list"] if one["rule"] == "network-load"]
        self.assertEqual((len(load), len(less)), (1, 1))
        self.assertNotEqual(load, less)

    def test_one_of_three_equal_node_ids_is_corrected(self) -> None:
        self.plant.write_bytes(self.original.replace(b'"node_id": 2', b'"node_id": 1').replace(b'"node_id": 3', b'"node_id": 1'))
        server = self.edit()
        before = server.state()["findings"]["errors"]
        self.assertIn("rejected", server.change({"do": "set", "pointer": "/nodes/analog_inputs/node_id", "value": "1"}))
        self.assertNotIn("rejected", server.change({"do": "set", "pointer": "/nodes/digital_outputs/node_id", "value": "9"}))
        self.assertLess(server.state()["findings"]["errors"], before)

    def test_parts_of_another_type(self) -> None:
        self.plant.write_text('{"bit_rate": 125, "nodes": null, "signals": {}}', encoding="utf-8")
        server = self.edit()
        for pointer, message in (("/nodes/a", "nodes is not an object"), ("/signals/-", "signals is not an array")):
            rejected = server.change({"do": "add", "pointer": pointer, "members": {}})["rejected"]
            self.assertEqual((rejected["message"], rejected["can_force"]), (message, False))

    def test_finding_of_an_eds(self) -> None:
        sheet = self.folder / "can-2053c.eds"
        sheet.write_bytes(sheet.read_bytes().replace(b"DataType=0x0005", b"DataType=0x00ZZ", 1))
        server = self.edit()
        self.assertIn("can-2053c.eds:", server.state()["findings"]["list"][0]["message"])
        self.assert_findings_are_of_check(server)

    def test_journal_and_other_program(self) -> None:
        server = self.edit()
        server.change({"do": "set", "pointer": "/bit_rate", "value": "250"})
        server.end(signal.SIGKILL)
        theirs = self.original.replace(b'"node_id": 4', b'"node_id": 14')
        self.plant.write_bytes(theirs)
        server = self.edit()
        self.assertEqual(server.state()["status"]["journal"]["names"], ["set bit_rate of the network to 250"])
        server.post("journal", {"since": 0, "use": True})
        self.assertEqual(server.state()["status"]["conflicts"], [])
        self.plant.write_bytes(theirs.replace(b'"bit_rate": 125', b'"bit_rate": 500'))
        server.post("review", {})
        conflict = server.state()["status"]["conflicts"][0]
        self.assertIn("250", conflict["mine"][0])
        server.post("resolve", {"since": 0, "id": conflict["id"], "keep": "mine"})
        server.post("save", {"since": 0})
        self.assertEqual(self.plant.read_bytes(), theirs.replace(b'"bit_rate": 125', b'"bit_rate": 250'))

    def test_text_that_is_not_json(self) -> None:
        server = self.edit()
        self.plant.write_bytes(self.original + b"}")
        server.post("review", {})
        state = server.state()
        self.assertIsNone(state["network"])
        self.assertEqual(state["findings"]["list"][0]["rule"], "network-syntax")
        self.assertIn("rejected", server.change({"do": "set", "pointer": "/bit_rate", "value": "250"}))
        self.plant.write_bytes(self.original)
        server.post("review", {})
        self.assertIsNotNone(server.state()["network"])

    def test_schema_of_the_state(self) -> None:
        validator = jsonschema.Draft202012Validator(json.loads((SOURCE_DIR / "docs/schema/edit.schema.json").read_text(encoding="utf-8")))
        shutil.copytree(SOURCE_DIR / "eds", self.folder / "eds")
        for example in sorted((SOURCE_DIR / "examples/networks").glob("*.json")):
            with self.subTest(example.name):
                text = example.read_text(encoding="utf-8").replace("../../eds/", "eds/")
                (self.folder / example.name).write_text(text, encoding="utf-8")
                server = self.start(example.name)
                answer = json.loads(server.get("/state?since=0")[1])
                self.assertEqual([error.message for error in validator.iter_errors(answer)], [])
                self.assertEqual(answer["parts"]["findings"]["errors"], 0)
                self.assertIn("<svg", answer["parts"]["network"]["drawing"])
                server.end(signal.SIGKILL)

    def test_hostile_names(self) -> None:
        server = self.edit()
        name = "</script><img src=x onerror=alert(1)>\u202e"
        rename = {"do": "rename", "pointer": "/nodes/digital_inputs", "name": name}
        self.assertIn("rejected", server.change(rename))
        server.post("change", {"changes": [rename, {"do": "set", "pointer": "/nodes/controller/options", "value": name}], "force": True})
        network = server.state()["network"]
        self.assertIn(name, [one["name"] for one in network["nodes"]])
        self.assertNotIn("<img", network["drawing"])
        section = server.get("/section?title=/nodes/controller")
        self.assertEqual(section[0], 200)
        self.assertEqual(server.get("/section?title=nodes/controller")[0], 404)


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

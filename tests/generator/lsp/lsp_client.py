"""A client of `edsc lsp` for tests: it sends messages and keeps the diagnostics."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import threading
from pathlib import Path
from typing import Any

TIMEOUT = 60


class Client:
    def __init__(self, edsc: Path, *, encoding: str = "utf-16", folder: Path | None = None, initialize: bool = True,
                 more: dict[str, Any] | None = None) -> None:
        self.process = subprocess.Popen([edsc, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder)
        self.output: queue.Queue[bytes] = queue.Queue()
        self.log: list[bytes] = []
        self.threads = [threading.Thread(target=self.pump, args=(self.process.stdout, self.output.put), daemon=True),
                        threading.Thread(target=self.pump, args=(self.process.stderr, self.log.append), daemon=True)]
        for thread in self.threads:
            thread.start()
        self.pending = b""
        self.last_id = 0
        self.diagnostics: dict[str, list[dict[str, Any]]] = {}
        self.messages: list[dict[str, Any]] = []
        self.versions: dict[str, int] = {}
        if initialize:
            self.capabilities = self.request("initialize", {
                "processId": os.getpid(), "rootUri": None,
                "capabilities": {"general": {"positionEncodings": [encoding]}, **(more or {})}})["capabilities"]
            self.notify("initialized", {})

    def send_bytes(self, data: bytes) -> None:
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message: Any) -> None:
        body = json.dumps(message).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def notify(self, method: str, params: Any) -> None:
        self.send({"jsonrpc": "2.0", "method": method, "params": params})

    def read(self) -> dict[str, Any]:
        """The next message, which must come in time and be framed exactly."""
        while True:
            head, separator, rest = self.pending.partition(b"\r\n\r\n")
            if separator:
                name, _, length = head.partition(b": ")
                assert name == b"Content-Length", head
                if len(rest) >= int(length):
                    self.pending = rest[int(length):]
                    message = json.loads(rest[:int(length)])
                    self.keep(message)
                    return message
            data = self.output.get(timeout=TIMEOUT)
            if not data:
                raise EOFError("the server has ended")
            self.pending += data

    def pump(self, stream: Any, take: Any) -> None:
        """Reads while the test sends, so that neither waits for the other."""
        while data := os.read(stream.fileno(), 1 << 16):
            take(data)
        take(b"")

    def keep(self, message: dict[str, Any]) -> None:
        assert message["jsonrpc"] == "2.0", message
        self.messages.append(message)
        if message.get("method") == "textDocument/publishDiagnostics":
            self.diagnostics[message["params"]["uri"]] = message["params"]["diagnostics"]

    def exchange(self, method: str, params: Any) -> dict[str, Any]:
        self.last_id += 1
        self.send({"jsonrpc": "2.0", "id": self.last_id, "method": method, "params": params})
        while True:
            message = self.read()
            if message.get("id") == self.last_id and "method" not in message:
                return message

    def request(self, method: str, params: Any) -> Any:
        answer = self.exchange(method, params)
        assert "error" not in answer, answer
        return answer["result"]

    def error(self, method: str, params: Any) -> dict[str, Any]:
        return self.exchange(method, params)["error"]

    def open(self, path: Path, text: str | None = None) -> str:
        uri = path.resolve().as_uri()
        self.versions[uri] = 1
        content = path.read_bytes().decode() if text is None else text
        self.notify("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "eds", "version": 1, "text": content}})
        return uri

    def replace(self, uri: str, text: str) -> None:
        self.change(uri, [{"text": text}])

    def change(self, uri: str, changes: list[dict[str, Any]]) -> None:
        self.versions[uri] += 1
        self.notify("textDocument/didChange", {"textDocument": {"uri": uri, "version": self.versions[uri]}, "contentChanges": changes})

    def published(self, uri: str) -> list[dict[str, Any]]:
        """The diagnostics of the present version."""
        while not any(one.get("method") == "textDocument/publishDiagnostics" and one["params"]["uri"] == uri and
                      one["params"].get("version") == self.versions[uri] for one in self.messages):
            self.read()
        return self.diagnostics[uri]

    def at(self, method: str, uri: str, line: int, character: int, **more: Any) -> Any:
        return self.request(f"textDocument/{method}", {"textDocument": {"uri": uri}, "position": {"line": line, "character": character}, **more})

    def end(self) -> tuple[int, str]:
        """The exit code and the log."""
        self.request("shutdown", None)
        self.notify("exit", None)
        return self.wait()

    def wait(self) -> tuple[int, str]:
        self.process.stdin.close()
        for thread in self.threads:
            thread.join(TIMEOUT)
        self.process.stdout.close()
        self.process.stderr.close()
        return self.process.wait(TIMEOUT), b"".join(self.log).decode(errors="replace")


def offset_of(text: str, position: dict[str, int], encoding: str = "utf-16") -> int:
    """Of a position in a text with LF line ends."""
    lines = text.split("\n")
    start = sum(len(one) + 1 for one in lines[:position["line"]])
    if position["line"] >= len(lines):
        return len(text)
    line = lines[position["line"]]
    if encoding == "utf-16":
        before = line.encode("utf-16-le")[:2 * position["character"]].decode("utf-16-le")
    else:
        before = line.encode()[:position["character"]].decode()
    return start + len(before)


def applied(text: str, edits: list[dict[str, Any]]) -> str:
    """The text with the edits, as an editor applies them: all ranges are of the old text."""
    places = [(offset_of(text, one["range"]["start"]), offset_of(text, one["range"]["end"]), one["newText"]) for one in edits]
    for start, end, new in sorted(places, key=lambda place: place[:2], reverse=True):
        text = text[:start] + new + text[end:]
    return text

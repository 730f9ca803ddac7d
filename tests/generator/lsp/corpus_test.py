#!/usr/bin/env python3
"""Files of vendors and their prefixes in `edsc lsp`: the findings are those of `edsc check`. Exit code 77: EDSC_CORPUS names no folder.

    corpus_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
import unittest
from pathlib import Path

from lsp_client import Client
from lsp_test import EDSC, check, published_form, server_form

CORPUS = Path(os.environ.get("EDSC_CORPUS", ""))
PREFIXES = 2  # of each file


class Corpus(unittest.TestCase):
    def test_prefixes(self) -> None:
        source = random.Random(3)
        files = sorted(path for path in CORPUS.rglob("*") if path.suffix.lower() in (".eds", ".dcf"))
        self.assertTrue(files)
        client = Client(EDSC)
        compared = 0
        with tempfile.TemporaryDirectory() as folder:
            for file in files:
                try:
                    text = file.read_bytes().decode("ascii")
                except UnicodeDecodeError:
                    continue  # the editor sends other bytes
                path = Path(folder) / f"{compared}.eds"
                for length in [len(text), *(source.randrange(len(text)) for _ in range(PREFIXES))]:
                    path.write_bytes(text[:length].encode())
                    uri = client.open(path)
                    with self.subTest(file=file.name, length=length):
                        self.assertEqual(server_form(client.published(uri)), published_form(check(path), path))
                    place = {"textDocument": {"uri": uri}, "position": {"line": text[:length].count("\n"), "character": 1}}
                    for method in ("hover", "completion", "definition"):
                        client.request(f"textDocument/{method}", place)
                    client.notify("textDocument/didClose", {"textDocument": {"uri": uri}})
                    client.messages.clear()
                compared += 1
        self.assertEqual(client.end()[0], 0)
        self.assertGreater(compared, 50)


if __name__ == "__main__":
    if not os.environ.get("EDSC_CORPUS") or not CORPUS.is_dir():
        print("skipped: EDSC_CORPUS does not name a folder")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

#!/usr/bin/env python3
"""Files of vendors and their prefixes in `edsc lsp`: the findings are those of `edsc check`.
Without a corpus (see tests/corpus/corpus_test.py) the test is skipped.

    lsp_corpus_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import random
import sys
import tempfile
import unittest
from pathlib import Path

from lsp_client import Client
from lsp_test import EDSC, check, published_form, server_form

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parents[2] / "corpus")]
from corpus_test import find_corpus  # noqa: E402
from support.compilers import SKIPPED  # noqa: E402

CORPUS = find_corpus(Path(sys.argv[1]).resolve())
PREFIXES = 2  # of each file


class Corpus(unittest.TestCase):
    def test_prefixes(self) -> None:
        assert CORPUS is not None
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
    if CORPUS is None:
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
        sys.exit(SKIPPED)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

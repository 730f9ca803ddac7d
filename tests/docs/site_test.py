#!/usr/bin/env python3
"""The site of the documents: MkDocs builds it without a warning, each page is in its navigation, each link and anchor has a target,
it loads nothing from other servers, its search finds words of the field, and axe-core finds no violation.

    site_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

The browser is skipped if npm or Chromium is missing. Exit code 77: MkDocs or Doxygen is missing.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse
from html.parser import HTMLParser
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/document"))
from document_case import CHROMIUM, WORK, install_browser  # noqa: E402

SKIPPED = 77
TERMS = ("heartbeat", "COB-ID", "socketcan", "pdo-length", "EMCY", "LSS", "1010h", "overlay", "edsc_add_dictionary",
         "constexpr")
LOADED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "object": "data", "source": "src"}


class Page(HTMLParser):
    """The anchors of a page, its links, and what a browser loads for it."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        self.anchors |= {values[name] for name in ("id", "name") if values.get(name)}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        if values.get(LOADED.get(tag, "")):
            self.loaded.append(values[LOADED[tag]])


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory(prefix="edsc-site-")
        cls.addClassCleanup(temporary.cleanup)
        output = Path(temporary.name)
        (output / "0.0.9").mkdir()  # an older version
        built = subprocess.run([SOURCE_DIR / "docs/site/build.py", output, "--edsc", sys.argv[2]], capture_output=True, text=True)
        cls.printed = built.stdout + built.stderr
        assert built.returncode == 0, cls.printed
        cls.output = output
        (cls.site,) = [path for path in output.iterdir() if path.is_dir() and path.name != "0.0.9"]
        cls.pages = {path: Page(path) for path in sorted(cls.site.rglob("*.html"))}
        made = {cls.site / "api", cls.site / "pages"}  # by Doxygen and by edsc document
        cls.documents = {path: page for path, page in cls.pages.items() if not made & set(path.parents)}

    def test_is_built_without_a_warning(self) -> None:
        self.assertEqual(self.printed, "")

    def test_has_each_document_in_its_navigation(self) -> None:
        linked = {urllib.parse.urldefrag(link)[0] for link in self.documents[self.site / "index.html"].links}
        for source in sorted((SOURCE_DIR / "docs").rglob("*.md")):
            self.assertIn(source.relative_to(SOURCE_DIR / "docs").with_suffix(".html").as_posix(), linked)
        self.assertLessEqual({"changelog.html", "api/index.html", "pages/device.html", "pages/network.html"}, linked)

    def test_has_a_target_for_each_link(self) -> None:
        count, dead = 0, []
        for path, page in self.documents.items():
            for link in page.links:
                address, anchor = urllib.parse.urldefrag(link)
                if re.match(r"[a-z]+:", address):
                    continue
                count += 1
                target = (path.parent / urllib.parse.unquote(address)).resolve() if address else path
                if not target.is_file() or (anchor and target in self.pages
                                            and urllib.parse.unquote(anchor) not in self.pages[target].anchors):
                    dead.append(f"{path.relative_to(self.site)}: {link}")
        self.assertEqual(dead, [])
        self.assertGreater(count, 2000)

    def test_renders_lists_and_tables(self) -> None:
        """Markdown that GitHub accepts and Python-Markdown does not would be text."""
        for path in self.documents:
            text = re.sub(r"<pre>.*?</pre>|<code>.*?</code>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
            self.assertNotRegex(text, r"(?m)^(?:\||```|\d+\. |- )", str(path))

    def test_loads_nothing_from_other_servers(self) -> None:
        for path, page in self.pages.items():
            self.assertEqual([one for one in page.loaded if re.match(r"(?!data:|javascript:)(?:[a-z]+:|//)", one)], [], str(path))
        for path in self.site.rglob("*.css"):
            self.assertNotRegex(path.read_text(encoding="utf-8"), r"(?:@import|url\()\s*['\"]?(?:https?:)?//", str(path))

    def test_has_the_words_of_the_field_in_its_search(self) -> None:
        index = json.loads((self.site / "search/search_index.json").read_text(encoding="utf-8"))
        text = "\n".join(f"{page['title']} {page['text']}" for page in index["docs"])
        self.assertEqual([term for term in TERMS if term not in text], [])
        script = (self.site / "assets/search_index.js").read_text(encoding="utf-8")
        self.assertEqual(json.loads(script.removeprefix("const searchIndex = ").removesuffix(";\n")), index)

    def test_lists_its_versions(self) -> None:
        names = re.findall(r'href="([\d.]+)/index.html"', (self.output / "index.html").read_text(encoding="utf-8"))
        self.assertEqual(names, [self.site.name, "0.0.9"])

    def test_in_a_browser(self) -> None:
        install_browser(SOURCE_DIR, WORK)
        files = [self.site / name for name in ("index.html", "tutorial.html", "how-to/storage.html", "application.html",
                                                 "command-line.html", "changelog.html", "stability.html", "how-to/audit.html")]
        result = subprocess.run(["node", "pages.mjs", CHROMIUM, "site", *files], cwd=WORK, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        for file, found in json.loads(result.stdout).items():
            self.assertEqual(found["violations"], [], file)
            outside = [one for one in found["requests"] if not one.startswith(self.site.as_uri())]
            self.assertEqual((outside, found["errors"]), ([], []), file)
            self.assertIn("rules.html#pdo-length", found["results"], file)
            self.assertEqual(found["overflow"], 0, file)


if __name__ == "__main__":
    if shutil.which("mkdocs") is None or shutil.which("doxygen") is None:
        print("SKIPPED: mkdocs or doxygen is not installed")
        sys.exit(SKIPPED)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)

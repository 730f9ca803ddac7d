#!/usr/bin/env python3
"""Builds the site of the documents with MkDocs and Doxygen, the packages of Debian.

    build.py OUTPUT [--edsc EDSC]

Writes OUTPUT/VERSION, and OUTPUT/index.html with all versions that are in OUTPUT. The site does not load anything from other
servers. Links to files outside of docs/ lead to copies of them, as text.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SITE_DIR = Path(__file__).resolve().parent
SOURCE_DIR = SITE_DIR.parent.parent
FENCED = re.compile(r"(^```.*?^```$)", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\((?!\w+:|#)(?P<path>[^)#\s]+)(?P<anchor>#[^)\s]*)?\)")
PAGES = {"README.md": "index.md", "docs/index.md": "index.md", "CHANGELOG.md": "changelog.md",
         "CONTRIBUTING.md": "developers/contributing.md"}
NOT_PAGES = ("api.doxygen", "site", "make.py", "__pycache__")


def version() -> str:
    found = re.search(r"^project\(edsc VERSION ([\d.]+)", (SOURCE_DIR / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None
    return found[1]


class Site:
    """The pages of the site in a folder, as MkDocs reads them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.copied: set[str] = set()

    def write(self) -> None:
        shutil.copytree(SOURCE_DIR / "docs", self.folder, ignore=shutil.ignore_patterns(*NOT_PAGES, "*.md"))
        pages = [path.relative_to(SOURCE_DIR).as_posix() for path in sorted((SOURCE_DIR / "docs").rglob("*.md"))]
        for page in [*pages, "CHANGELOG.md", "CONTRIBUTING.md"]:
            self.write_page(page, (SOURCE_DIR / page).read_text(encoding="utf-8"), self.place_of(page))

    def place_of(self, path: str) -> str:
        """The place on the site of a file of the repository, which is copied if it is not a document."""
        if path in PAGES:
            return PAGES[path]
        file = SOURCE_DIR / path
        if path.startswith("docs/") and file.is_file():
            return path.removeprefix("docs/")
        place = f"files/{path}.md" if file.is_dir() else f"files/{path}.txt"
        if path not in self.copied:
            self.copied.add(path)
            (self.folder / place).parent.mkdir(parents=True, exist_ok=True)
            if file.is_dir():
                self.write_list(path, place)
            else:
                shutil.copyfile(file, self.folder / place)
        return place

    def write_list(self, path: str, place: str) -> None:
        """A page with the files of a folder, after its README.md."""
        folder = SOURCE_DIR / path
        introduction = folder / "README.md"
        text = introduction.read_text(encoding="utf-8") if introduction.exists() else f"# {path}\n"
        names = sorted(one.name for one in folder.iterdir() if one != introduction and one.name != "package")
        rows = "".join(f"- [{name}]({name})\n" for name in names)
        self.write_page(f"{path}/README.md", f"{text}\n## Files of {path}\n\n{rows}", place)

    def write_page(self, page: str, text: str, place: str) -> None:
        def moved(link: re.Match[str]) -> str:
            target = os.path.normpath(os.path.join(os.path.dirname(page), link["path"]))
            if target.endswith("/README.md"):
                target = os.path.dirname(target)
            relative = os.path.relpath(self.place_of(target), os.path.dirname(place) or ".")
            return f"]({relative}{link['anchor'] or ''})"

        parts = FENCED.split(text)
        parts[::2] = [LINK.sub(moved, part) for part in parts[::2]]
        file = self.folder / place
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("".join(parts), encoding="utf-8")


def write_examples(folder: Path, edsc: str) -> None:
    """Writes the pages of a device and of a network as `edsc document` makes them."""
    folder.mkdir()
    for file, page in (("eds/cpc-tc1.eds", "device.html"), ("examples/networks/twelve_axes.json", "network.html")):
        subprocess.run([edsc, "document", SOURCE_DIR / file, "-o", folder / page], stdout=subprocess.DEVNULL, check=True)


def write_api(folder: Path) -> None:
    """Writes the reference of the runtime to `folder`/api."""
    settings = (SOURCE_DIR / "docs/api.doxygen").read_text(encoding="utf-8")
    settings += f"OUTPUT_DIRECTORY = {folder}\nHTML_OUTPUT = api\nPROJECT_NUMBER = {version()}\n"
    subprocess.run(["doxygen", "-"], input=settings, cwd=SOURCE_DIR, text=True, check=True)


def write_search_index(site: Path) -> None:
    """Writes the index as a script, which a browser also loads from a folder."""
    index = (site / "search/search_index.json").read_text(encoding="utf-8")
    (site / "assets/search_index.js").write_text(f"const searchIndex = {index};\n", encoding="utf-8")


def write_versions(output: Path) -> None:
    """A page with the versions in `output`, newest first."""
    def numbers(name: str) -> list[int]:
        return [int(number) for number in name.split(".")]

    names = sorted((path.name for path in output.iterdir() if re.fullmatch(r"[\d.]+", path.name)), key=numbers, reverse=True)
    rows = "".join(f'<li><a href="{name}/index.html">edsc {name}</a></li>' for name in names)
    (output / "index.html").write_text(
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>edsc: versions</title></head>\n'
        f"<body><main><h1>Documents of edsc</h1><ul>{rows}</ul></main></body></html>\n", encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description="Builds the site of the documents.")
    parser.add_argument("output", type=Path)
    parser.add_argument("--edsc", default="edsc", help="program that writes the example pages (default: in the PATH)")
    arguments = parser.parse_args()
    output = arguments.output.resolve()
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="edsc-site-") as temporary:
        pages = Path(temporary) / "pages"
        Site(pages).write()
        write_api(pages)
        write_examples(pages / "pages", arguments.edsc)
        settings = (SITE_DIR / "mkdocs.yml").read_text(encoding="utf-8").replace("site_name: edsc\n", f"site_name: edsc {version()}\n")
        settings = settings.replace("custom_dir: theme\n", f"custom_dir: {SITE_DIR}/theme\n")
        (Path(temporary) / "mkdocs.yml").write_text(f"{settings}docs_dir: pages\n", encoding="utf-8")
        result = subprocess.run(["mkdocs", "build", "--strict", "--site-dir", output / version()], cwd=temporary,
                                capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(SITE_DIR), "PYTHONDONTWRITEBYTECODE": "1"})
    print("".join(line for line in result.stderr.splitlines(keepends=True) if line.startswith(("WARNING", "ERROR"))), end="")
    if result.returncode == 0:
        write_search_index(output / version())
        write_versions(output)
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())

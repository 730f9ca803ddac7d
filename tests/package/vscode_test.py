#!/usr/bin/env python3
"""The extension for VS Code: vsce packages it with a program, which runs; the order of the programs that it tries; its grammar.

    vscode_test.py SOURCE_DIR EDSC [unittest arguments]

npm installs vsce and the client. Exit code 77: npm is missing, or does not reach its registry.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
EXTENSION = SOURCE_DIR / "editors/vscode"
PROGRAMS = """
const { candidates } = require(process.argv[1]);
const all = () => true;
console.log(JSON.stringify([
  candidates("/own/edsc", { PATH: "/usr/bin" }, "linux", "/ext", all),
  candidates("", { PATH: "/usr/bin:bin:/opt/bin" }, "linux", "/ext", all),
  candidates("", { Path: "C:\\\\tools;." }, "win32", "C:\\\\ext", all),
  candidates("", {}, "linux", "/ext", (path) => path.startsWith("/ext")),
]));
"""


def make_archive(folder: Path) -> Path:
    """An archive as that of a static program, with the program of this build."""
    top = folder / "edsc-1.2.3"
    (top / "bin").mkdir(parents=True)
    (top / "share/doc/edsc").mkdir(parents=True)
    shutil.copy(EDSC, top / "bin/edsc")
    for name in ("THIRD-PARTY-NOTICES", "copyright"):
        (top / "share/doc/edsc" / name).write_text("text\n")
    archive = folder / "edsc-1.2.3-linux-x86_64.tar.gz"
    with tarfile.open(archive, "w:gz") as file:
        file.add(top, top.name)
    return archive


class Extension(unittest.TestCase):
    def test_package_has_the_program_and_the_client(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            made = subprocess.run([EXTENSION / "make_extension.py", folder / "out", make_archive(folder)], capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
            with zipfile.ZipFile(folder / "out/edsc-1.2.3-linux-x64.vsix") as package:
                package.extractall(folder / "installed")
                manifest = package.read("extension.vsixmanifest").decode()
            extension = folder / "installed/extension"
            self.assertIn('TargetPlatform="linux-x64"', manifest)
            self.assertEqual(json.loads((extension / "package.json").read_text())["version"], "1.2.3")
            program = extension / "bin/edsc"
            program.chmod(0o755)  # zipfile drops the mode, which VS Code keeps
            version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
            self.assertEqual(version, subprocess.run([EDSC, "--version"], capture_output=True, text=True, check=True).stdout)
            self.assertTrue((extension / "node_modules/vscode-languageclient/node.js").exists())
            self.assertFalse(list(extension.glob("**/*.py")))
            self.assertFalse((extension / "node_modules/@vscode/vsce").exists())

    def test_programs_in_their_order(self) -> None:
        result = subprocess.run(["node", "-e", PROGRAMS, EXTENSION / "programs.js"], capture_output=True, text=True, check=True)
        self.assertEqual(json.loads(result.stdout), [
            ["/own/edsc"], ["/usr/bin/edsc", "/opt/bin/edsc", "/ext/bin/edsc"],
            ["C:\\tools\\edsc.exe", "C:\\ext\\bin\\edsc.exe"], ["/ext/bin/edsc"]])

    def test_scripts_are_javascript(self) -> None:
        for script in EXTENSION.glob("*.js"):
            subprocess.run(["node", "--check", script], check=True)

    def test_grammar(self) -> None:
        """The patterns are as those of Python where they are used here."""
        grammar = json.loads((EXTENSION / "syntaxes/canopen-eds.tmLanguage.json").read_text())
        comment, section, entry = grammar["patterns"]
        self.assertRegex("; edsc: allow x - y", comment["match"])
        self.assertEqual(re.match(section["match"], "[1018sub1] ; x")[2], "1018sub1")
        self.assertEqual(re.match(entry["begin"], "DefaultValue = 1")[1], "DefaultValue")
        self.assertIsNone(re.match(entry["begin"], "; a=b"))


def has_registry() -> bool:
    if not shutil.which("npm") or not shutil.which("node"):
        return False
    return subprocess.run(["npm", "view", "vscode-languageclient@9.0.1", "version"], capture_output=True, check=False).returncode == 0


if __name__ == "__main__":
    if not has_registry():
        print("skipped: npm is missing, or does not reach its registry")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

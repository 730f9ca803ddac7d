#!/usr/bin/env python3
"""The extension for VS Code: vsce packages it with the program of each platform; which program it starts; its grammar.

    vscode_test.py SOURCE_DIR EDSC [unittest arguments]

npm installs vsce and the client, and the command is that of docs/editors.md with other archives. Exit code 77: npm is missing, or
does not reach its registry.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path
from xml.etree import ElementTree

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

# Starts the extension; `vscode` and the client's class are replaced, since the editor provides what they need.
ACTIVATE = """
const Module = require("module");
const shown = [];
const commands = {};
let options;
const vscode = {
  workspace: { getConfiguration: () => ({ get: (key, value) => value }), createFileSystemWatcher: () => ({}) },
  window: { showErrorMessage: (text) => shown.push(text), showInformationMessage: (text) => shown.push(text) },
  languages: { createLanguageStatusItem: () => ({ dispose() {} }) },
  commands: { registerCommand: (name, run) => { commands[name] = run; return { dispose() {} }; } },
};
class LanguageClient {
  constructor(id, name, server) { options = server; }
  async start() {}
  async stop() {}
}
const load = Module._load;
Module._load = (name, ...rest) => name === "vscode" ? vscode : name === "vscode-languageclient/node" ? { LanguageClient } : load(name, ...rest);
const extension = require(process.argv[1]);
extension.activate({ extensionPath: process.argv[1], subscriptions: [] }).then(async () => {
  await commands["edsc.showVersion"]();
  console.log(JSON.stringify([...shown, ...options.run.args]));
}).catch((problem) => { console.error(problem); process.exit(1); });
"""


def make_archives(folder: Path) -> list[Path]:
    """Archives with the files of the static programs that the extension uses; the program of this build stands for each of them."""
    archives = []
    for platform, program, form in (("linux-x86_64", "edsc", "gztar"), ("windows-x86_64", "edsc.exe", "zip")):
        name = f"edsc-1.2.3-{platform}"
        top = folder / platform / name
        (top / "bin").mkdir(parents=True)
        (top / "share/doc/edsc").mkdir(parents=True)
        shutil.copy(EDSC, top / "bin" / program)
        for text in ("THIRD-PARTY-NOTICES", "copyright"):
            (top / "share/doc/edsc" / text).write_text("text\n")
        archives.append(Path(shutil.make_archive(str(folder / name), form, folder / platform, name)))
    return archives


def make(output: Path, archives: list[Path], **variables: str) -> None:
    """Runs the command of the document with another folder and other archives."""
    document = (SOURCE_DIR / "docs/editors.md").read_text(encoding="utf-8")
    (command,) = re.findall(r"<!-- run by: tests/package/vscode_test.py -->\n```sh\n(.*?)\n```", document)
    made = subprocess.run([SOURCE_DIR / command.split()[0], output, *archives], capture_output=True, text=True,
                          env=os.environ | variables)
    if made.returncode != 0:
        raise AssertionError(made.stdout + made.stderr)


class Extension(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-vscode-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.archives = make_archives(cls.folder)
        make(cls.folder / "out", cls.archives)

    def extension_for(self, target: str) -> Path:
        """The unpacked extension for a platform of VS Code."""
        place = self.folder / "installed" / target
        with zipfile.ZipFile(self.folder / f"out/edsc-1.2.3-{target}.vsix") as package:
            package.extractall(place)
        manifest = ElementTree.parse(place / "extension.vsixmanifest").getroot()
        (identity,) = manifest.iter("{http://schemas.microsoft.com/developer/vsx-schema/2011}Identity")
        self.assertEqual((identity.get("TargetPlatform"), identity.get("Version")), (target, "1.2.3"))
        return place / "extension"

    def test_has_the_program_of_its_platform(self) -> None:
        for target, program in (("linux-x64", "edsc"), ("win32-x64", "edsc.exe")):
            extension = self.extension_for(target)
            self.assertEqual({path.name for path in (extension / "bin").iterdir()}, {program, "THIRD-PARTY-NOTICES"})
            self.assertEqual((extension / "bin" / program).read_bytes(), EDSC.read_bytes())
            self.assertEqual(json.loads((extension / "package.json").read_text())["version"], "1.2.3")

    def test_the_program_is_executable(self) -> None:
        with zipfile.ZipFile(self.folder / "out/edsc-1.2.3-linux-x64.vsix") as package:
            mode = package.getinfo("extension/bin/edsc").external_attr >> 16
        self.assertEqual(mode & 0o111, 0o111)

    def test_has_the_client_and_no_tools(self) -> None:
        extension = self.extension_for("linux-x64")
        self.assertEqual(json.loads((extension / "node_modules/vscode-languageclient/package.json").read_text())["version"],
                         json.loads((EXTENSION / "package.json").read_text())["dependencies"]["vscode-languageclient"])
        self.assertFalse(list(extension.glob("**/*.py")))
        self.assertFalse((extension / "node_modules/@vscode/vsce").exists())

    def test_activates_and_shows_the_version_of_the_program(self) -> None:
        """A module `vscode` of a few lines takes the place of the editor; the client is that of the package."""
        extension = self.extension_for("linux-x64")
        program = extension / "bin/edsc"
        program.chmod(0o755)  # zipfile drops the mode, which VS Code keeps
        version = subprocess.run([EDSC, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        other = self.folder / "path"
        other.mkdir()
        shutil.copy(EDSC, other / "edsc")
        node = Path(shutil.which("node")).resolve()
        for folders, expected in (("", program), (str(other), other / "edsc")):
            result = subprocess.run([node, "-e", ACTIVATE, extension], capture_output=True, text=True, timeout=60,
                                    env=os.environ | {"PATH": folders})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(json.loads(result.stdout), [f"{version} ({expected})", "lsp"])

    def test_is_made_again_without_a_network(self) -> None:
        make(self.folder / "again", self.archives[:1], npm_config_offline="true")
        self.assertTrue((self.folder / "again/edsc-1.2.3-linux-x64.vsix").exists())

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


def has_packages() -> bool:
    """Whether npm can install the packages of the lock file."""
    if not shutil.which("npm") or not shutil.which("node"):
        return False
    with tempfile.TemporaryDirectory() as folder:
        for name in ("package.json", "package-lock.json"):
            shutil.copy(EXTENSION / name, folder)
        npm = subprocess.run(["npm", "ci", "--ignore-scripts", "--prefer-offline", "--no-audit", "--no-fund", "--fetch-retries=1"],
                             cwd=folder, capture_output=True, check=False)
        return npm.returncode == 0


if __name__ == "__main__":
    if not has_packages():
        print("skipped: npm is missing, or does not reach its registry")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

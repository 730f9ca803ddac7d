#!/usr/bin/env python3
"""edsc.exe writes under wine, byte for byte, what edsc writes on Linux.

    windows_test.py SOURCE_DIR BUILD_DIR EDSC [--all] [unittest arguments]

The program is built in the folder windows beside BUILD_DIR, by the preset `windows`. Both programs get the same arguments in two
folders with the same files; exit code, standard output, standard error and each file that they write are compared. With --all
these files are all of eds/, examples/ and the corpus (EDSC_CORPUS, or ../shared/eds-corpus beside the repository).
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
import zipfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.wine import WINE_FOLDER, Wine, has_wine  # noqa: E402

SOURCE_DIR, BUILD_DIR, EDSC = (Path(argument).resolve() for argument in sys.argv[1:4])
WANTS_ALL = "--all" in sys.argv[4:]
WINDOWS_BUILD = BUILD_DIR.parent / "windows"
EXE = WINDOWS_BUILD / "generator/edsc.exe"
OFFLINE = BUILD_DIR.parent / "offline/generator/edsc"  # built by offline_test.py; EDSC has more commands
SECONDS = 600
LOG = "(1.000000) can0 705#00\n(1.050000) can0 000#0105\n(1.100000) can0 605#4064600000000000\n" \
      "(1.200000) can0 585#4364600001000000\n(1.300000) can0 185#3706\n(1.400000) can0 185#3702\n"

# Of each EDS. {eds} is its path, {name} its name without extension.
SHEET_COMMANDS = ("check {eds}", "check {eds} --format json", "check {eds} --format sarif", "dump {eds}", "dump {eds} --cpp",
                  "format {eds} -o out/{name}.eds", "format {eds} --check",
                  "generate {eds} -o out/cpp --depfile out/{name}.d", "generate {eds} -o out/c --target c",
                  "document {eds} -o out/{name}.html", "document {eds} --format markdown",
                  "diff eds/cpd.eds {eds} --format json", "decode a.log --node 5={eds}")
SWEEP_COMMANDS = ("check {eds}", "check {eds} --format sarif", "dump {eds}", "format {eds}",
                  "generate {eds} -o out/cpp --keep-going --depfile out/{name}.d", "document {eds} -o out/{name}.html --keep-going")
LISTING_COMMANDS = ("help", "--help", "chekc", "completion bash", "completion zsh", "completion man", "completion json")
OTHER_COMMANDS = (
    "version", "--version", "help network generate", "help decode", "help check", "check", "check missing.eds", "check eds", "check eds/cpd.eds --explain pdo-mapping", "generate eds/cpd.eds -o out --templates missing", "generate eds/cpd.eds -o out --templates eds/cpd.eds",
    "decode a.log", "decode a.log --node 5=eds/cpc-tc1.eds --format json", "decode a.log --node 5=eds/cpc-tc1.eds --summary",
    "audit a.log --node 5=eds/cpc-tc1.eds", "audit a.log --node 5=eds/cpc-tc1.eds -o out/audit.html",
    "plot a.log 6041h --node 5=eds/cpc-tc1.eds -o out/plot.svg", "plot a.log 6041h --node 5=eds/cpc-tc1.eds",
    "overlay from eds/cpd.eds edited.eds -o out/cpd.overlay", "check out/cpd.overlay", "overlay apply out/cpd.overlay",
    "document examples/networks/four_modules.json -o out/net.html --node-pages", "diff eds/cpd.eds edited.eds",
    "format edited.eds", "overlay from eds/cpd.eds edited.eds -o edited.eds")


@dataclass(frozen=True)
class Outcome:
    exit_code: int
    stdout: bytes
    stderr: bytes


def run(*command: object) -> None:
    result = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=3600)
    if result.returncode != 0:
        raise AssertionError(f"{command}: exit code {result.returncode}\n{result.stdout}{result.stderr}")


def tree(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


class Pair:
    """Two folders with the same files, one for each program."""

    def __init__(self, wine: Wine) -> None:
        self.wine = wine
        self.folder = tempfile.TemporaryDirectory(prefix="edsc-pair-")
        self.linux, self.windows = (Path(self.folder.name) / name for name in ("linux", "windows"))
        for place in (self.linux, self.windows):
            place.mkdir()

    def __enter__(self) -> Pair:
        return self

    def __exit__(self, *_: object) -> None:
        self.folder.cleanup()

    def write(self, name: str, content: bytes) -> None:
        for place in (self.linux, self.windows):
            path = place / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def copy(self, name: str, source: Path) -> None:
        for place in (self.linux, self.windows):
            shutil.copytree(source, place / name)

    def on_linux(self, *arguments: str, stdin: bytes | int = subprocess.DEVNULL) -> Outcome:
        given = {"input": stdin} if isinstance(stdin, bytes) else {"stdin": stdin}
        program = OFFLINE if " ".join(arguments) in LISTING_COMMANDS else EDSC
        result = subprocess.run([program, *arguments], cwd=self.linux, env=self.wine.environment, capture_output=True,
                                timeout=SECONDS, **given)
        return Outcome(result.returncode, result.stdout, result.stderr)

    def on_windows(self, *arguments: str, stdin: bytes | int = subprocess.DEVNULL) -> Outcome:
        result = self.wine.run(EXE, *arguments, cwd=self.windows, stdin=stdin)
        # The documents beside the program have a URL with the drive, which is the root folder of Linux.
        return Outcome(result.returncode, result.stdout.replace(b"file:///Z:/", b"file:///"), result.stderr)

    def differences(self, *arguments: str, windows: tuple[str, ...] = (), stdin: bytes | int = subprocess.DEVNULL) -> list[str]:
        """Runs both programs, that on Windows with other arguments if they are given, and returns what is not the same."""
        expected, got = self.on_linux(*arguments, stdin=stdin), self.on_windows(*(windows or arguments), stdin=stdin)
        found = [f"{' '.join(arguments)}: {part}: expected {getattr(expected, part)!r:.1500}, got {getattr(got, part)!r:.1500}"
                 for part in ("exit_code", "stdout", "stderr") if getattr(expected, part) != getattr(got, part)]
        files, others = tree(self.linux), tree(self.windows)
        return found + [f"{' '.join(arguments)}: {name}: expected {files.get(name)!r:.300}, got {others.get(name)!r:.300}"
                        for name in sorted(files.keys() | others.keys()) if files.get(name) != others.get(name)]


def build() -> None:
    """As docs/install.md says. The commit would differ from that of EDSC, which has none."""
    run("cmake", "--preset", "windows", "-S", SOURCE_DIR, "-B", WINDOWS_BUILD, "-DEDSC_COMMIT_IN_VERSION=OFF")
    run("cmake", "--build", WINDOWS_BUILD, "--target", "edsc")


def package(folder: Path) -> Path:
    """Writes the archive into a folder, and returns its path."""
    run("cpack", "--config", WINDOWS_BUILD / "CPackConfig.cmake", "-G", "ZIP", "-B", folder)
    (archive,) = folder.glob("*.zip")
    return archive


def corpus_files() -> list[Path]:
    corpus = Path(os.environ.get("EDSC_CORPUS", SOURCE_DIR.parent / "shared/eds-corpus"))
    manifest = corpus / "manifest.tsv"
    if not manifest.is_file():
        print(f"SKIPPED: no corpus in {corpus}")
        return []
    with manifest.open(encoding="utf-8", newline="") as rows:
        return [corpus / row["path"] for row in csv.DictReader(rows, delimiter="\t")]


class Windows(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls) -> None:
        if not has_wine():
            raise unittest.SkipTest("SKIPPED: wine64 is not installed")
        build()
        cls.wine = Wine()
        cls.addClassCleanup(cls.wine.end)

    def pair(self) -> Pair:
        pair = Pair(self.wine)
        self.addCleanup(pair.folder.cleanup)
        pair.copy("eds", SOURCE_DIR / "eds")
        pair.write("a.log", LOG.encode())
        return pair

    def same(self, pair: Pair, *arguments: str, **options: object) -> None:
        self.assertEqual(pair.differences(*arguments, **options), [])


class Sample(Windows):
    def of_sheet(self, name: str) -> list[str]:
        pair = self.pair()
        commands = [command.format(eds=f"eds/{name}.eds", name=name).split() for command in SHEET_COMMANDS]
        return [found for arguments in commands for found in pair.differences(*arguments)]

    def test_reference_devices(self) -> None:
        names = sorted(path.stem for path in (SOURCE_DIR / "eds").glob("*.eds"))
        self.assertEqual(len(names), 8)
        with ThreadPoolExecutor(2) as pool:
            self.assertEqual([found for part in pool.map(self.of_sheet, names) for found in part], [])

    def test_other_commands(self) -> None:
        pair = self.pair()
        pair.copy("examples", SOURCE_DIR / "examples")
        edited = (SOURCE_DIR / "eds/cpd.eds").read_bytes()
        pair.write("edited.eds", re.sub(rb"(?m)^ProductNumber=.*$", b"ProductNumber=99\r", edited))
        differences = [found for command in OTHER_COMMANDS for found in pair.differences(*command.split())]
        for network in ("four_modules", "eight_devices"):
            path = f"examples/networks/{network}.json"
            differences += pair.differences("network", "check", path) + pair.differences("network", "check", path, "--times")
            differences += pair.differences("network", "generate", path, "-o", f"out/{network}", "--depfile", f"out/{network}.d")
        self.assertEqual(differences, [])
        self.assertTrue((pair.windows / "out/four_modules.d").is_file())
        self.assertTrue((pair.windows / "out/plot.svg").is_file())

    @unittest.skipUnless(OFFLINE.is_file(), f"SKIPPED: {OFFLINE} is missing; offline_test.py builds it")
    def test_lists_of_commands(self) -> None:
        pair = self.pair()
        self.assertEqual([found for command in LISTING_COMMANDS for found in pair.differences(*command.split())], [])

    def test_standard_input(self) -> None:
        pair = self.pair()
        text = (SOURCE_DIR / "eds/cpd.eds").read_bytes()
        self.same(pair, "check", "-", stdin=text)
        self.same(pair, "format", "-", stdin=text)
        self.same(pair, "decode", "-", "--node", "5=eds/cpd.eds", stdin=LOG.encode())

    def test_backslashes_in_arguments(self) -> None:
        pair = self.pair()
        pair.write("eds/leer.eds", b"")
        self.same(pair, "check", "eds/leer.eds", "--format", "sarif", windows=("check", r"eds\leer.eds", "--format", "sarif"))
        self.same(pair, "generate", "eds/cpd.eds", "-o", "out/a", "--depfile", "out/a.d",
                  windows=("generate", r"eds\cpd.eds", "-o", r"out\a", "--depfile", r"out\a.d"))
        self.same(pair, "check", "eds/missing.eds", windows=("check", r"eds\missing.eds"))
        self.same(pair, "decode", "a.log", "--node", "5=eds/cpd.eds", windows=("decode", r".\a.log", "--node", r"5=eds\cpd.eds"))
        self.assertIn(b"out/a/cpd/dictionary.hpp", (pair.windows / "out/a.d").read_bytes())

    def test_blanks_and_other_alphabets_in_paths(self) -> None:
        pair = self.pair()
        for folder in ("mit blank", "gerät-ω", "表"):
            pair.copy(folder, SOURCE_DIR / "eds")
            pair.write(f"{folder}/leer.eds", b"")
            self.same(pair, "check", f"{folder}/leer.eds", "--format", "sarif")
            self.same(pair, "generate", f"{folder}/cpd.eds", "-o", f"{folder}/aus gabe", "--depfile", f"{folder}/x.d")
            self.same(pair, "document", f"{folder}/cpd.eds", "-o", f"{folder}/seite-ω.html")
            self.assertTrue((pair.windows / folder / "seite-ω.html").is_file())
        self.same(pair, "check", "nicht-dä.eds")

    def test_paths_with_a_drive(self) -> None:
        pair = self.pair()
        folder = self.wine.drive_c / "Geräte an Bord"
        shutil.copytree(SOURCE_DIR / "eds", folder)
        (folder / "leer.eds").write_bytes(b"")
        got = pair.on_windows("check", r"C:\Geräte an Bord\leer.eds", "--format", "sarif")
        self.assertIn(b'"file:///C:/Ger%C3%A4te%20an%20Bord/leer.eds"', got.stdout)
        path = r"C:\Geräte an Bord\cpd.eds"
        expected = pair.on_linux("check", str(folder / "cpd.eds"))
        got = pair.on_windows("check", path)
        self.assertEqual([part.decode() for part in (got.stdout, got.stderr)],
                         [part.decode().replace(str(self.wine.drive_c), "C:") for part in (expected.stdout, expected.stderr)])
        self.assertEqual(pair.on_windows("generate", path, "-o", r"C:\Ausgabe\ä").exit_code, 0)
        pair.on_linux("generate", str(folder / "cpd.eds"), "-o", "out")
        self.assertEqual(tree(self.wine.drive_c / "Ausgabe/ä"), tree(pair.linux / "out"))

    def test_variables_of_the_environment(self) -> None:
        pair = self.pair()
        pair.copy("examples", SOURCE_DIR / "examples")
        network = self.wine.drive_c / "Ü.json"
        text = (SOURCE_DIR / "examples/networks/four_modules.json").read_text(encoding="utf-8")
        network.write_text(text.replace("../../eds/", "eds/"), encoding="utf-8")
        shutil.copytree(SOURCE_DIR / "eds", self.wine.drive_c / "eds", dirs_exist_ok=True)
        result = self.wine.run(EXE, "decode", "a.log", "--node", "digital_outputs", cwd=pair.windows,
                               variables={"EDSC_NETWORK": r"C:\Ü.json"})
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_file_is_replaced_by_any_of_its_names(self) -> None:
        pair = self.pair()
        edited = pair.windows / "eds/cpd.eds"
        before = edited.read_bytes()
        edited.write_bytes(before.replace(b"ParameterName=", b"parametername="))
        self.assertEqual(pair.on_windows("format", "eds/cpd.eds", "-o", "EDS/CPD.EDS").exit_code, 0)
        self.assertIn(b"ParameterName=", edited.read_bytes())
        self.assertEqual([path.name for path in edited.parent.glob("*[Cc][Pp][Dd].[Ee]*")], ["cpd.eds"])
        self.assertEqual(list(edited.parent.glob(".edsc-*")), [])
        refused = pair.on_windows("overlay", "from", "eds/cpd.eds", "eds/rk5c.eds", "-o", r"Eds\CPD.eds")
        self.assertNotEqual(refused.exit_code, 0)
        self.assertIn(b"is the same file as the input", refused.stderr)

    def test_an_unchanged_file_keeps_its_time(self) -> None:
        pair = self.pair()
        arguments = ("generate", "eds/cpd.eds", "-o", "out")
        self.assertEqual(pair.on_windows(*arguments).exit_code, 0)
        written = sorted((pair.windows / "out").rglob("*.hpp"))
        self.assertGreater(len(written), 3)
        for path in written:
            os.utime(path, (1_000_000_000, 1_000_000_000))
        written[0].write_bytes(b"// Generated by edsc\n")
        self.assertEqual(pair.on_windows(*arguments).exit_code, 0)
        self.assertEqual([path for path in written if path.stat().st_mtime != 1_000_000_000], [written[0]])
        self.assertGreater(written[0].stat().st_size, 100)

    def test_a_read_only_file_is_not_replaced(self) -> None:
        pair = self.pair()
        (pair.windows / "out").mkdir()
        target = pair.windows / "out/cpd.eds"
        target.write_bytes(b"old")
        target.chmod(stat.S_IRUSR)
        got = pair.on_windows("format", "eds/cpd.eds", "-o", "out/cpd.eds")
        self.assertEqual((got.exit_code, got.stderr), (2, b"edsc: out/cpd.eds: Permission denied\n"))
        self.assertEqual(tree(pair.windows / "out"), {"cpd.eds": b"old"})

    def test_a_device_is_written_and_not_read(self) -> None:
        pair = self.pair()
        before = tree(pair.windows)
        for name in ("NUL", "nul", r"out\..\NUL"):
            self.assertEqual(pair.on_windows("format", "eds/cpd.eds", "-o", name), Outcome(0, b"", b""), name)
        self.assertEqual(tree(pair.windows), before)
        self.assertIn(b"is a device; expected a file", pair.on_windows("check", "NUL").stdout)

    def test_two_outputs_with_one_name(self) -> None:
        pair = self.pair()
        before = tree(pair.windows)
        got = pair.on_windows("generate", "eds/cpd.eds", "-o", "out", "--depfile", "OUT/Cpd/DICTIONARY.hpp")
        self.assertEqual(got.exit_code, 2)
        self.assertRegex(got.stderr, rb"is the same file as the output (?i:out/cpd/dictionary\.hpp)\n")
        self.assertEqual(tree(pair.windows), before)

    def test_archive(self) -> None:
        version = self.wine.run(EXE, "--version").stdout.decode().split()[1]
        with tempfile.TemporaryDirectory() as folder:
            archive = package(Path(folder))
            self.assertEqual(archive.stem, f"edsc-{version}-windows-x86_64")
            with zipfile.ZipFile(archive) as files:
                files.extractall(self.wine.drive_c / "Eigene Programme")
        top = self.wine.drive_c / "Eigene Programme" / archive.stem
        self.assertEqual({path.name for path in top.iterdir()},
                         {"edsc.exe", "LICENSE", "README.md", "CHANGELOG.md", "docs", "eds", "examples", "include"})
        pair = self.pair()
        result = self.wine.run(top / "edsc.exe", "check", "eds/cpd.eds", "--format", "sarif", cwd=pair.windows)
        self.assertIn(f"file:///C:/Eigene%20Programme/{archive.stem}/docs/rules.md#".encode(), result.stdout)

    def test_output_that_nobody_reads(self) -> None:
        pair = self.pair()
        pair.write("long.log", LOG.encode() * 20000)
        process = subprocess.Popen([WINE_FOLDER / "wine64", EXE, "decode", "long.log"], cwd=pair.windows,
                                   env=self.wine.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        with process:
            self.assertIn(b"boot-up", process.stdout.readline())
            process.stdout.close()
            self.assertEqual((process.stderr.read(), process.wait(timeout=SECONDS)), (b"", 0), "as on Linux")


class Sweep(Windows):
    def of_file(self, path: Path) -> list[str]:
        with Pair(self.wine) as pair:
            pair.copy("in", path.parent) if path.is_relative_to(SOURCE_DIR) else pair.write(f"in/{path.name}", path.read_bytes())
            commands = [[word.format(eds=f"in/{path.name}", name=path.stem) for word in command.split()] for command in SWEEP_COMMANDS]
            return [f"{path}: {found}" for arguments in commands for found in pair.differences(*arguments)]

    def test_all_files(self) -> None:
        own = [path for folder in ("eds", "examples") for path in sorted((SOURCE_DIR / folder).rglob("*"))
               if path.suffix in (".eds", ".dcf", ".xdd", ".xdc")]
        self.assertGreater(len(own), 10)
        files = own + corpus_files()
        with ThreadPoolExecutor(2) as pool:
            differences = [found for part in pool.map(self.of_file, files) for found in part]
        print(f"{len(files)} files with {len(SWEEP_COMMANDS)} commands each")
        self.assertEqual(differences, [])


if __name__ == "__main__":
    given = [argument for argument in sys.argv[4:] if argument != "--all"]
    chosen = [] if any(not argument.startswith("-") for argument in given) else ["Sweep" if WANTS_ALL else "Sample"]
    unittest.main(argv=[sys.argv[0], *given, *chosen])

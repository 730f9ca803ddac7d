#!/usr/bin/env python3
"""Output of edsc: to files, devices, FIFOs, symlinks and standard output, also if they cannot be written.

    output_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import os
import resource
import shutil
import stat
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/every_type.eds"
OTHER_SHEET = SOURCE_DIR / "tests/fixtures/pdo_device.eds"
NAME = "device"
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2
NOBODY = 65534
MEMORY_DEVICES, NULL_DEVICE, FULL_DEVICE = 1, 3, 7


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class Output(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-output-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def edsc(self, *arguments: object, **more: object) -> subprocess.CompletedProcess[str]:
        more = {"capture_output": True, **more}
        return subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, text=True, errors="replace", timeout=600,
                              **more)

    def expect(self, exit_code: int, result: subprocess.CompletedProcess[str], *words: str) -> None:
        said = (result.stdout or "") + (result.stderr or "")
        self.assertEqual(result.returncode, exit_code, said[:2000])
        for word in words:
            self.assertIn(word, said)

    def canonical(self) -> str:
        return self.edsc("format", SHEET).stdout

    def device(self, name: str, minor: int) -> Path:
        """A character device of the test itself, so that an error does no harm."""
        path = self.folder / name
        try:
            os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(MEMORY_DEVICES, minor))
            path.open("wb").close()
        except PermissionError:
            print("SKIPPED: this user may not make or open devices here")
            self.skipTest("SKIPPED: no devices")
        return path


class NotRegularFiles(Output):
    def test_a_device_is_written_into(self) -> None:
        null = self.device("null", NULL_DEVICE)
        self.expect(FINE, self.edsc("format", SHEET, "-o", null))
        self.expect(FINE, self.edsc("generate", SHEET, "-o", "out", "--depfile", null))
        self.assertTrue(null.is_char_device())
        self.assertEqual(len(contents(self.folder / "out")), 6)

    def test_a_device_that_takes_nothing_is_an_error_and_no_file_is_written(self) -> None:
        full = self.device("full", FULL_DEVICE)
        (self.folder / "link").symlink_to("full")
        for path in (full, "link"):
            self.expect(WRONG_USAGE, self.edsc("format", SHEET, "-o", path), "No space left")
            self.expect(WRONG_USAGE, self.edsc("generate", SHEET, "-o", "out", "--depfile", path), "No space left")
        self.assertTrue(full.is_char_device())
        self.assertEqual(contents(self.folder / "out"), {})

    def test_a_fifo_is_written_into(self) -> None:
        fifo = self.folder / "fifo"
        os.mkfifo(fifo)
        read: list[str] = []
        reader = threading.Thread(target=lambda: read.append(fifo.read_text()), daemon=True)
        reader.start()
        self.expect(FINE, self.edsc("format", SHEET, "-o", fifo))
        reader.join(600)
        self.assertEqual(read, [self.canonical()])
        self.assertTrue(fifo.is_fifo())

    def test_standard_output_by_its_path(self) -> None:
        for path in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            with self.subTest(path=path):
                self.assertEqual(self.edsc("format", SHEET, "-o", path).stdout, self.canonical())
        with (self.folder / "log").open("w") as log:
            log.write("before\n")
            log.flush()
            self.expect(FINE, self.edsc("format", SHEET, "-o", "/dev/stdout", stdout=log, capture_output=False))
            log.write("after\n")
        self.assertEqual((self.folder / "log").read_text(), f"before\n{self.canonical()}after\n")


class Symlinks(Output):
    def test_are_followed_and_stay(self) -> None:
        (self.folder / "real").mkdir()
        real = self.folder / "real/device.eds"
        real.write_text("old")
        (self.folder / "near").symlink_to("real/device.eds")
        (self.folder / "far").symlink_to(self.folder / "near")
        self.expect(FINE, self.edsc("format", SHEET, "-o", "far"))
        self.assertTrue((self.folder / "far").is_symlink() and (self.folder / "near").is_symlink())
        self.assertEqual(real.read_text(), self.canonical())
        self.assertEqual(os.listdir(self.folder / "real"), ["device.eds"])

    def test_one_for_a_header_stays_too(self) -> None:
        (self.folder / f"out/{NAME}").mkdir(parents=True)
        (self.folder / f"out/{NAME}/pdo.hpp").symlink_to("../pdo.hpp")
        self.expect(FINE, self.edsc("generate", SHEET, "-o", "out", "--name", NAME))
        self.assertTrue((self.folder / f"out/{NAME}/pdo.hpp").is_symlink())
        self.assertIn(f"namespace {NAME}", (self.folder / "out/pdo.hpp").read_text())

    def test_planted_at_names_of_temporary_files_are_not_followed(self) -> None:
        victim = self.folder / "victim"
        victim.write_text("mine")
        out = self.folder / "out" / NAME
        out.mkdir(parents=True)
        for header in ("dictionary.hpp", "pdo.hpp", "device.hpp", "description.hpp"):
            (out / f"{header}.edsc-tmp").symlink_to(victim)
        self.expect(FINE, self.edsc("generate", SHEET, "-o", "out", "--name", NAME))
        self.assertEqual(victim.read_text(), "mine")
        self.assertFalse((out / "pdo.hpp").is_symlink())


class InPlace(Output):
    def test_format_keeps_the_mode(self) -> None:
        sheet = self.folder / "device.eds"
        for mode in (0o600, 0o664, 0o755):
            shutil.copy(SHEET, sheet)
            sheet.chmod(mode)
            self.expect(FINE, self.edsc("format", sheet, "-o", sheet))
            self.assertEqual(sheet.read_text(), self.canonical())
            self.assertEqual(stat.S_IMODE(sheet.stat().st_mode), mode)

    def test_format_keeps_the_owner(self) -> None:
        if os.geteuid() != 0:
            print("SKIPPED: only root gives files away")
            self.skipTest("SKIPPED: not root")
        sheet = self.folder / "device.eds"
        shutil.copy(SHEET, sheet)
        os.chown(sheet, NOBODY, NOBODY)
        self.expect(FINE, self.edsc("format", sheet, "-o", sheet))
        self.assertEqual((sheet.stat().st_uid, sheet.stat().st_gid), (NOBODY, NOBODY))


class SameFile(Output):
    def test_generate_does_not_replace_its_input(self) -> None:
        sheet = self.folder / "device.eds"
        shutil.copy(SHEET, sheet)
        (self.folder / "device.options.json").write_text("{}")
        os.link(sheet, self.folder / "hard.d")
        (self.folder / "soft.d").symlink_to("device.options.json")
        for depfile, named in (("device.eds", "device.eds"), ("hard.d", "device.eds"), ("soft.d", "device.options.json")):
            result = self.edsc("generate", "device.eds", "-o", "out", "--depfile", depfile)
            self.expect(WRONG_USAGE, result, f"{depfile}: is the same file as the input {named}")
        self.assertEqual(sheet.read_bytes(), SHEET.read_bytes())
        self.assertFalse((self.folder / "out").exists())

    def test_generate_does_not_write_two_outputs_to_one_file(self) -> None:
        result = self.edsc("generate", SHEET, "-o", "out", "--name", NAME, "--depfile", f"out/{NAME}/pdo.hpp")
        self.expect(WRONG_USAGE, result, f"out/{NAME}/pdo.hpp: is the same file as the output")
        self.assertEqual(contents(self.folder), {})


class SeveralAtOnce(Output):
    def headers(self, *arguments: object) -> dict[str, bytes]:
        folder = self.folder / f"alone{len(os.listdir(self.folder))}"
        self.expect(FINE, self.edsc("generate", *arguments, "-o", folder, "--name", NAME))
        return contents(folder)

    def test_leave_the_headers_of_one_of_them(self) -> None:
        """No run fails, and the result is the complete set of one of them."""
        ways = [(SHEET,), (SHEET, "--static-mapping"), (OTHER_SHEET,), (OTHER_SHEET, "--node-id", 5)]
        sets = [self.headers(*way) for way in ways]
        self.assertEqual(len({tuple(sorted(one.items())) for one in sets}), len(sets))
        out = self.folder / "out"
        with ThreadPoolExecutor(8) as pool:
            for _ in range(6):
                runs = list(pool.map(lambda way: self.edsc("generate", *way, "-o", out, "--name", NAME), ways * 2))
                for run in runs:
                    self.expect(FINE, run)
                self.assertIn(contents(out), sets)


class FilesOfOthers(Output):
    def test_a_header_without_the_mark_is_replaced_by_force_only(self) -> None:
        for target, name in (("cpp", "device.hpp"), ("c", "objects.h")):
            with self.subTest(target=target):
                arguments = ("generate", SHEET, "-o", "out", "--name", NAME, "--target", target)
                header = self.folder / "out" / NAME / name
                self.expect(FINE, self.edsc(*arguments))
                made = header.read_text()
                header.write_text("// written by hand\n")
                self.expect(WRONG_USAGE, self.edsc(*arguments), f"{name}: edsc has not written this file")
                self.assertEqual(header.read_text(), "// written by hand\n")
                self.expect(FINE, self.edsc(*arguments, "--force"))
                self.assertEqual(header.read_text(), made)
                header.write_text(made + "// an older one\n")
                self.expect(FINE, self.edsc(*arguments))
                header.write_text("")
                self.expect(FINE, self.edsc(*arguments))
                self.assertEqual(header.read_text(), made)


class FullDisk(Output):
    def test_changes_nothing(self) -> None:
        """A limit on the file size fails like a full disk."""
        arguments = ("generate", SHEET, "-o", "out", "--name", NAME)
        self.expect(FINE, self.edsc(*arguments))
        sizes = sorted(map(len, contents(self.folder).values()))
        for path in (self.folder / "out" / NAME).iterdir():
            path.write_text("// Generated by edsc before.\n")
        before = contents(self.folder)
        for size in (sizes[0] - 1, sizes[-1] - 1):
            result = self.edsc(*arguments, restore_signals=False,  # SIGXFSZ remains ignored
                               preexec_fn=lambda size=size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
            self.expect(WRONG_USAGE, result, "File too large")
            self.assertEqual(contents(self.folder), before)

    def test_of_its_own_changes_nothing(self) -> None:
        small = self.folder / "small"
        small.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", small], capture_output=True)
        if mounted.returncode != 0:
            print("SKIPPED: this user may not mount a file system")
            self.skipTest("SKIPPED: no mount")
        try:
            self.expect(FINE, self.edsc("generate", SHEET, "-o", small, "--name", NAME))
            before = contents(small)
            (small / "filler").write_bytes(b"x" * 4096)
            with self.assertRaises(OSError):
                while True:
                    with (small / "filler").open("ab", buffering=0) as filler:
                        filler.write(b"x" * 4096)
            result = self.edsc("generate", SHEET, "-o", small, "--name", NAME, "--node-id", 5)
            self.expect(WRONG_USAGE, result, "No space left")
            (small / "filler").unlink()
            self.assertEqual(contents(small), before)
        finally:
            subprocess.run(["umount", small], check=True)


class PackedInput(Output):
    """A gzip file that would fill the memory."""

    def pack(self, piece: bytes, count: int) -> Path:
        packer = zlib.compressobj(1, wbits=31)
        path = self.folder / "bomb.eds"
        with path.open("wb") as file:
            for _ in range(count):
                file.write(packer.compress(piece))
            file.write(packer.flush())
        return path

    def refuse(self, path: Path, *words: str) -> None:
        size = 400 << 20
        for command in (("check", path), ("dump", path), ("generate", path, "-o", "out"), ("format", path)):
            result = self.edsc(*command, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
            self.expect(WRONG_USAGE, result, *words, "stopped at byte", f"of {path.stat().st_size}")

    def test_of_one_character(self) -> None:
        self.refuse(self.pack(b"\n" * (1 << 20), 300), "unpacks to more than 200 times its size")

    def test_of_more_than_64_mebibytes(self) -> None:
        self.refuse(self.pack(b"\n" * (1 << 16) + os.urandom(800), 1200), f"unpacks to more than {64 << 20} bytes")


class StandardOutput(Output):
    """A command fails if its output is lost."""

    COMMANDS = (
        ("--help",), ("--version",), ("check", "--help"), ("generate", "--help"),
        ("check", SHEET), ("check", SHEET, "--format", "json"), ("check", SHEET, "--format", "sarif"),
        ("check", "--list-rules"), ("dump", SHEET), ("format", SHEET), ("diff", SHEET, OTHER_SHEET),
        ("diff", SHEET, SHEET, "--format", "json"), ("generate", SHEET, "-o", "out", "--verbose"),
        ("completion", "bash"), ("completion", "zsh"), ("completion", "man"), ("bus", "--listen", "127.0.0.1:0"),
        ("decode", "one.log"),
    )

    def setUp(self) -> None:
        super().setUp()
        (self.folder / "one.log").write_text("(1.000000) can0 000#0105\n")

    def expect_of_each(self, word: str, **more: object) -> None:
        for command in self.COMMANDS:
            with self.subTest(command=" ".join(map(str, command))):
                self.expect(WRONG_USAGE, self.edsc(*command, stderr=subprocess.PIPE, capture_output=False, **more),
                            f"cannot write to standard output: {word}")

    def test_that_takes_nothing_is_exit_code_2(self) -> None:
        if not os.path.exists("/dev/full"):
            print("SKIPPED: no /dev/full")
            self.skipTest("SKIPPED: no /dev/full")
        with open("/dev/full", "w") as full:
            self.expect_of_each("No space left on device", stdout=full)

    def test_that_is_closed_is_exit_code_2(self) -> None:
        self.expect_of_each("Bad file descriptor", preexec_fn=lambda: os.close(1))

    def test_that_is_closed_does_not_matter_to_a_command_without_output(self) -> None:
        result = self.edsc("generate", SHEET, "-o", "out", preexec_fn=lambda: os.close(1), stdout=None,
                           stderr=subprocess.PIPE, capture_output=False)
        self.expect(FINE, result)
        self.assertEqual(len(contents(self.folder / "out")), 6)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)

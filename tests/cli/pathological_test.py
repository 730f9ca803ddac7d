#!/usr/bin/env python3
"""Unusual, possibly malicious files: edsc ends within a bounded time for each.

    pathological_test.py SOURCE_DIR EDSC [--times] [--large]

Creates files of 0.4 to 1.6 MB in a temporary folder, 2.5 times as much with --large, and runs `edsc check`, `generate`, `dump`
and `format` on each. The limit of 10 s of CPU time per MB detects hangs and steps of quadratic cost, and is sufficient for a slow
machine and sanitizers; bench/ measures the time of edsc.
"""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Callable

_, EDSC = sys.argv.pop(1), sys.argv.pop(1)
MB = 1_000_000
LARGE = "--large" in sys.argv
if LARGE:
    sys.argv.remove("--large")
SIZE = MB if LARGE else 400_000  # bytes for 1 in the table of files
SECONDS_PER_MB = 10


def repeated(text: str, size: float) -> str:
    return text * int(size * SIZE / len(text))


def counted(template: str, size: float) -> str:
    """The template repeated, with `{i}` = 0, 1, 2, ...; `{i:...}` formats the number."""
    length = len(template.format(i=123456))
    return "".join(template.format(i=i) for i in range(int(size * SIZE / length)))


def var(index: str, name: str, more: str = "") -> str:
    return f"[{index}]\nParameterName={name}\nObjectType=7\nDataType=5\nAccessType=rw\n{more}"


def record(index: int, subs: int, name: str) -> str:
    text = f"[{index:04X}]\nParameterName={name}\nObjectType=9\nSubNumber={subs}\n"
    for sub in range(subs):
        text += f"[{index:04X}sub{sub:X}]\nParameterName={name}\nDataType=5\nAccessType=rw\n"
    return text


def objects(make: Callable[[int], str], size: float, first: int = 0x1000) -> str:
    text, characters = [], 0
    for index in range(first, 0x10000):
        text.append(make(index))
        characters += len(text[-1])
        if characters >= size * SIZE:
            break
    return "".join(text)


def mapping(index: int) -> str:
    """A mapping parameter of 254 entries, each of which maps a missing object."""
    text = f"[{index:04X}]\nParameterName=Mapping\nObjectType=9\nSubNumber=255\n"
    for sub in range(255):
        value = "254" if sub == 0 else "0x20000108"
        text += f"[{index:04X}sub{sub:X}]\nParameterName=Entry\nDataType={5 if sub == 0 else 7}\nAccessType=rw\nDefaultValue={value}\n"
    return text


def pdos() -> str:
    def communication(index: int) -> str:
        return (f"[{index:04X}]\nParameterName=PDO\nObjectType=9\nSubNumber=2\n"
                f"[{index:04X}sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=2\n"
                f"[{index:04X}sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\nDefaultValue=0x181\n")

    return "".join(communication(0x1400 + i) + communication(0x1800 + i) for i in range(512)) + objects(mapping, 2, 0x1600)


# The content of each file by its name. The numbers in the calls are multiples of SIZE; also indices with `objects`.
FILES: dict[str, Callable[[], str]] = {
    "one_long_line": lambda: repeated("x", 4),
    "one_long_key": lambda: "[1000]\n" + repeated("x", 2) + "=1\n",
    "one_long_value": lambda: var("2000", repeated("x ", 2)),
    "one_long_section_name": lambda: "[" + repeated("x", 2) + "]\na=1\n",
    "one_long_default": lambda: var("2000", "a", "DefaultValue=" + repeated("9", 2) + "\n"),
    "one_long_string": lambda: "[2000]\nParameterName=a\nDataType=9\nAccessType=const\nDefaultValue=" + repeated("?\\", 1) + "\n",
    "one_long_octet_string": lambda: "[2000]\nParameterName=a\nDataType=10\nAccessType=const\nDefaultValue=" + repeated("0A ", 1),
    "long_names": lambda: objects(lambda i: var(f"{i:04X}", "Name " * 400), 2),
    "open_brackets": lambda: repeated("[", 2),
    "lines_of_open_brackets": lambda: repeated("[\n", 1),
    "closing_brackets": lambda: "[" + repeated("]", 2),
    "empty_sections": lambda: repeated("[]\n", 2),
    "empty_lines": lambda: repeated("\n", 4),
    "carriage_returns": lambda: repeated("\r", 2),
    "stray_lines": lambda: repeated("x\n", 2),
    "lines_without_key": lambda: "[1000]\n" + repeated("=\n", 2),
    "comments": lambda: repeated(";\n", 2) + var("2000", "a"),
    "comments_in_a_section": lambda: "[2000]\n" + repeated("; comment\n", 2) + "ParameterName=a\n",
    "many_unknown_sections": lambda: counted("[s{i}]\na=1\n", 4),
    "many_keys_in_one_section": lambda: "[1000]\n" + counted("k{i}=1\n", 4),
    "one_key_many_times": lambda: "[1000]\n" + repeated("ParameterName=a\n", 3),
    "one_section_many_times": lambda: repeated(var("2000", "a"), 3),
    "one_sub_object_many_times": lambda: "[2000]\nParameterName=a\nObjectType=9\n" + repeated(var("2000sub1", "a"), 3),
    "sub_indices_beyond_255": lambda: "[2000]\nParameterName=a\nObjectType=9\n" + counted("[2000sub{i:X}]\nDataType=5\n", 3),
    "sub_objects_without_object": lambda: objects(lambda i: var(f"{i:04X}sub1", "a"), 4),
    "descending_objects": lambda: "".join(var(f"{i:04X}", "a") for i in range(0xFFFF, 0x5000, -1)),
    "all_indices": lambda: objects(lambda i: f"[{i:X}]\nParameterName=a\nDataType=5\nAccessType=ro\n", 4, 0),
    "one_name_for_all_objects": lambda: objects(lambda i: var(f"{i:04X}", "Speed"), 4),
    "names_that_look_like_suffixes": lambda: objects(lambda i: var(f"{i:04X}", f"Speed {0x10000 + 0x1000 - i:04x}"), 4),
    "names_without_letters": lambda: objects(lambda i: var(f"{i:04X}", "-"), 4),
    "one_name_for_all_entries": lambda: objects(lambda i: record(i, 255, "Speed"), 4),
    "names_of_hidden_characters": lambda: var("2000", repeated("\u202A", 1)),
    "names_of_question_marks": lambda: var("2000", repeated("?", 1)),
    "names_of_trigraphs": lambda: var("2000", repeated("?", 0.5) + repeated("?/", 0.5) + repeated("/", 0.5)),
    "wide_names": lambda: objects(lambda i: var(f"{i:04X}", "速度" * 50), 2),
    "records_of_many_shapes": lambda: objects(
        lambda i: f"[{i:04X}]\nParameterName=R{i}\nObjectType=9\n" + var(f"{i:04X}sub1", f"a{i}") + var(f"{i:04X}sub2", f"b{i}"), 4),
    "arrays_of_254": lambda: objects(
        lambda i: f"[{i:04X}]\nParameterName=A\nObjectType=8\nDataType=7\nAccessType=rw\nCompactSubObj=254\n", 1),
    "compact_names": lambda: "[2000]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=254\n"
                             "[2000Name]\nNrOfEntries=1\n" + counted("{i}=n\n", 2),
    "object_list": lambda: "[OptionalObjects]\nSupportedObjects=9\n" + counted("{i}=0x2000\n", 2) + var("2000", "a"),
    "object_list_of_nonsense": lambda: "[OptionalObjects]\nSupportedObjects=9\n" + counted("{i}=x\n", 2) + var("2000", "a"),
    "types_that_refer_to_types": lambda: "".join(
        f"[{i:04X}]\nParameterName=t\nObjectType=5\nDataType=0x{i + 1:04X}\n" for i in range(0x40, 0x1000)) + objects(
        lambda i: f"[{i:04X}]\nParameterName=a\nDataType=0x40\nAccessType=rw\n", 2),
    "types_that_are_missing": lambda: objects(lambda i: f"[{i:04X}]\nParameterName=a\nDataType=0x800\nAccessType=rw\n", 3),
    "objects_with_limits": lambda: objects(lambda i: var(f"{i:04X}", "a", "LowLimit=1\nHighLimit=9\nDefaultValue=5\n"), 4),
    "formulas": lambda: objects(lambda i: f"[{i:04X}]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+1\n", 3),
    "all_pdos": pdos,
    "baud_rates": lambda: "[DeviceInfo]\n" + counted("BaudRate_{i}=1\n", 2) + var("2000", "a"),
    "dummies": lambda: "[DummyUsage]\n" + counted("Dummy{i:04X}=1\n", 1) + var("2000", "a"),
    "modules": lambda: counted("[M{i}ModuleInfo]\nProductName=a\n", 2) + var("2000", "a"),
    "supported_modules": lambda: "[SupportedModules]\nNrOfEntries=60000\n[ConnectedModules]\nNrOfEntries=60000\n"
                                 + counted("{i}=1\n", 1) + "[M1ModuleInfo]\nProductName=a\n" + var("2000", "a"),
    "extended_module": lambda: "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=a\n[M1SubExtends]\n"
                               "NrOfEntries=1\n1=0x6000\n[M1SubExt6000]\nParameterName=a\nDataType=5\nAccessType=ro\nCount=255\n"
                               "ObjExtend=0\n[ConnectedModules]\n" + counted("{i}=1\n", 1) + var("6000", "a"),
    "links": lambda: "[2000]\nParameterName=a\nDataType=5\nAccessType=ro\n[2000ObjectLinks]\nObjectLinks=9\n"
                     + counted("{i}=0x2000\n", 2),
    "tools": lambda: "[Tools]\nItems=9\n" + counted("[Tool{i}]\nName=a\nCommand=b\n", 2) + var("2000", "a"),
    "comment_lines": lambda: "[Comments]\nLines=9\n" + counted("Line{i}=a\n", 2) + var("2000", "a"),
    "dynamic_channels": lambda: "[DynamicChannels]\nNrOfSeg=255\n"
                                + counted("Type{i}=7\nDir{i}=ro\nRange{i}=0xA080-0xA0BF\nPPOffset{i}=0\n", 2) + var("2000", "a"),
    "code_page": lambda: var("2000", repeated("\u00e4", 1)),
    "nested_xml": lambda: repeated("<a>", 2),
    "wide_xml": lambda: "<ISO15745ProfileContainer>" + counted('<CANopenObject index="{i:04X}" name="a" objectType="7"/>', 2)
                        + "</ISO15745ProfileContainer>",
    "xml_attributes": lambda: "<ISO15745ProfileContainer " + counted('a{i}="1" ', 2) + "/>",
}

COMMANDS = {
    "check": ["--format", "json"],
    "generate": ["--keep-going", "-o", "{out}"],
    "dump": ["--keep-going", "--cpp"],
    "format": [],
}


def cpu_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def limit_cpu_seconds(seconds: int) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))


class Pathological(unittest.TestCase):
    def run_commands(self, path: Path) -> None:
        limit = int(SECONDS_PER_MB * max(path.stat().st_size / MB, 1))
        for command, arguments in COMMANDS.items():
            with self.subTest(file=path.stem, command=command):
                filled_in = [argument.format(out=path.parent / "out") for argument in arguments]
                before = cpu_seconds()
                done = subprocess.run([EDSC, command, str(path), *filled_in], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                      preexec_fn=lambda: limit_cpu_seconds(limit), check=False)
                if done.returncode == -signal.SIGXCPU:
                    self.fail(f"edsc {command} has not ended after {limit} s of CPU time")
                self.assertIn(done.returncode, (0, 1), done.stderr[-2000:].decode(errors="replace"))
                if VERBOSE:
                    seconds = cpu_seconds() - before
                    size = path.stat().st_size / MB
                    print(f"{path.stem:32} {command:9} {size:5.1f} MB {seconds:6.2f} s {seconds / size:6.2f} s/MB", flush=True)


def add_test(name: str, make: Callable[[], str]) -> None:
    def test(self: Pathological) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"{name}.eds"
            encoding = "cp1252" if name == "code_page" else "utf-8"
            path.write_text(make(), encoding=encoding, newline="")
            self.run_commands(path)

    setattr(Pathological, f"test_{name}", test)


for file_name, maker in FILES.items():
    add_test(file_name, maker)

VERBOSE = "--times" in sys.argv
if VERBOSE:
    sys.argv.remove("--times")

if __name__ == "__main__":
    unittest.main()

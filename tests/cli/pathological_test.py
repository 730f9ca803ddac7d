#!/usr/bin/env python3
"""Unusual, possibly malicious files: edsc ends within a bounded time for each, and takes twice the time for twice the size.
Also pages, comparisons, overlays and logs.

    pathological_test.py SOURCE_DIR EDSC [--times] [--large]

Creates files of 0.2 to 0.8 MB in a temporary folder, five times as much with --large, and runs `edsc check`, `generate`, `dump`
and `format` on each. The limit of 10 s of CPU time per MB detects hangs and steps of quadratic cost, and is sufficient for a slow
machine and sanitizers; bench/ measures the time of edsc. For files that grow in one part, the CPU time of two sizes is compared:
for each third of them, for all with --large.
"""

from __future__ import annotations

import json
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
SIZE = MB if LARGE else 200_000  # bytes for 1 in the table of files
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


def numbered(template: str, count: int) -> str:
    return "".join(template.format(i=i, number=i + 1, rest=count - i) for i in range(count))


def vars_from(count: int, first: int = 0x2000, more: str = "") -> str:
    return "".join(var(f"{first + i:04X}", f"a{i}", more) for i in range(count))


MODULE = "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=a\n"
EXTENSION = "[M1SubExtends]\nNrOfEntries=1\n1=0x2000\n[M1SubExt2000]\nParameterName=a\nDataType=5\nAccessType=ro\n"
EMPTY_EXTENSION = "[M1SubExt{0}]\nParameterName=a\nDataType=5\nAccessType=ro\nCount=0\n"


def connected(places: int, kinds: int = 1) -> str:
    return f"[ConnectedModules]\nNrOfEntries={places}\n" + "".join(f"{i + 1}={i % kinds + 1}\n" for i in range(places))


def fixed_objects(count: int, listed_from: int) -> str:
    return (f"{MODULE}[M1FixedObjects]\nNrOfEntries={count}\n" + "".join(f"{i + 1}=0x{listed_from + i:04X}\n" for i in range(count))
            + "".join(f"[M1Fixed{0xFFFF - i:04X}]\nParameterName=a\nDataType=5\nAccessType=ro\n" for i in range(count))
            + connected(1) + var("1F00", "a"))


def with_options(options: object, count: int = 1, indent: int | None = 1) -> dict[str, str]:
    return {"device.eds": vars_from(count), "device.options.json": json.dumps(options, indent=indent)}


def network(more: dict[str, object], **members: object) -> dict[str, str]:
    device = {"node_id": 2, "eds": "device.eds", **more}
    return {"device.eds": "[DeviceInfo]\nVendorName=a\n" + vars_from(4000),
            "network.json": json.dumps({"bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": True}, "a": device}, **members})}


def keys(count: int) -> list[str]:
    return [f"{0x2000 + i:04X}h" for i in range(count)]


CHECK, GENERATE, NETWORK = ["check", "device.eds"], ["generate", "--keep-going", "device.eds", "-o", "out"], [
    "network", "check", "network.json"]

# By name: the smaller of two sizes, the files of a size, and the command. The larger size is twice the smaller one.
GROWING: dict[str, tuple[int, Callable[[int], dict[str, str]], list[str]]] = {
    "modules_that_extend_objects": (100, lambda n: {
        "device.eds": MODULE + EXTENSION + "Count=254\nObjExtend=1\n" + connected(n) + var("1F00", "a")}, CHECK),
    "modules_with_empty_extensions": (2000, lambda n: {
        "device.eds": MODULE + "".join(EMPTY_EXTENSION.format(f"{0x2000 + i:04X}") for i in range(n)) + connected(n)
                      + var("1F00", "a")}, CHECK),
    "kinds_of_modules": (20000, lambda n: {
        "device.eds": numbered("[M{number}ModuleInfo]\nProductName=a\n", n) + connected(n, n) + var("1F00", "a")}, CHECK),
    "fixed_objects_descending": (24000, lambda n: {"device.eds": fixed_objects(n, 0x10000 - n)}, CHECK),
    "fixed_objects_that_are_missing": (20000, lambda n: {"device.eds": fixed_objects(n, 0x1000)}, CHECK),
    "dynamic_channels_descending": (20000, lambda n: {
        "device.eds": f"[DynamicChannels]\nNrOfSeg={n}\n"
                      + numbered("Type{rest}=7\nDir{rest}=ro\nRange{rest}=0xA080\nPPOffset{rest}=0\n", n) + var("2000", "a")}, CHECK),
    "comments_descending": (100000, lambda n: {
        "device.eds": f"[Comments]\nLines={n}\n" + numbered("Line{rest}=a\n", n) + var("2000", "a")}, CHECK),
    "allow_rows": (10000, lambda n: with_options(
        {"allow": [{"rule": "pdo-empty", "object": f"{i % 0x8000 + 0x2000:04X}h", "reason": f"r{i}"} for i in range(n)]}), CHECK),
    "silence_rows": (20000, lambda n: with_options({"silence": [f"rule{i}" for i in range(n)]}, 8000), CHECK),
    "settable_entries": (20000, lambda n: with_options({"settable": keys(n)}, n), GENERATE),
    "wrong_names": (20000, lambda n: with_options({"names": dict.fromkeys(keys(n), 1)}), CHECK),
    "unknown_options": (20000, lambda n: with_options({f"x{i}": 1 for i in range(n)}), CHECK),
    "long_name_of_an_option": (100000, lambda n: with_options({"x" * n: [1] * (n // 4)}), CHECK),
    "deep_options": (500000, lambda n: {"device.eds": var("2000", "a"), "device.options.json": "[" * n + "]" * n}, CHECK),
    "deep_members_of_options": (100000, lambda n: {
        "device.eds": var("2000", "a"), "device.options.json": '{"a": ' * n + "1" + "}" * n}, CHECK),
    "deep_storage_group": (100000, lambda n: {"device.eds": var("2000", "a"), "device.options.json":
                                              '{"storage": {"sub_indices": {"05h": ' + "[" * n + "]" * n + "}}}"}, CHECK),
    "deep_bit_rates": (100000, lambda n: {"device.eds": var("2000", "a"), "device.options.json":
                                          '{"lss": {"bit_rates": ' + "[" * n + "]" * n + "}}"}, CHECK),
    "unknown_members_of_a_network": (20000, lambda n: network({}, **{f"x{i}": 1 for i in range(n)}), NETWORK),
    "long_name_of_a_network_member": (100000, lambda n: network({}, **{"x" * n: [1] * (n // 4)}), NETWORK),
    "unknown_entries_in_set": (4000, lambda n: network({"set": {f"speed {i}": 1 for i in range(n)}}), NETWORK),
    "entries_in_set": (20000, lambda n: {**network({"set": {f"a{i}": 1 for i in range(n)}}),
                                         "device.eds": "[DeviceInfo]\nVendorName=a\n" + vars_from(n)}, NETWORK),
    "one_name_in_set": (10000, lambda n: {
        **network({"set": {f"a.{i}": 1 for i in range(n)}}),
        "device.eds": "[DeviceInfo]\nVendorName=a\n" + "".join(var(f"{0x2000 + i:04X}", "a") for i in range(n))}, NETWORK),
    "long_name_in_set": (20000, lambda n: network({"set": {"a." * n: 1}}), NETWORK),
    "objects_of_a_page": (12000, lambda n: {"device.eds": vars_from(n)}, ["document", "device.eds", "-o", "device.html"]),
    "one_name_of_a_page": (12000, lambda n: {"device.eds": "".join(var(f"{0x2000 + i:04X}", "a") for i in range(n))},
                           ["document", "device.eds", "-o", "device.html"]),
    "differences": (24000, lambda n: {"device.eds": vars_from(n), "old.eds": vars_from(n).replace("DataType=5", "DataType=6")},
                    ["diff", "old.eds", "device.eds"]),
    "moved_objects": (12000, lambda n: {"device.eds": vars_from(n), "old.eds": "".join(
        var(f"{0xA000 + i:04X}", f"a{i}") for i in range(n))}, ["diff", "old.eds", "device.eds"]),
    "lines_of_an_overlay": (28000, lambda n: {"device.eds": vars_from(n), "device.overlay":
                            "[Overlay]\nBase=device.eds\n" + "".join(f"[{0x2000 + i:04X}]\nDataType=5 => 6\n" for i in range(n))},
                            ["overlay", "apply", "device.overlay", "-o", "out.eds"]),
    "nodes_of_a_log": (400000, lambda n: {"device.eds": var("2000", "a"), "a.log": "".join(
        f"({i}.0) can0 {0x580 + i % 128:03X}#4300200001000000\n" for i in range(n))}, ["audit", "a.log", "--node", "5=device.eds"]),
    "transfers_of_a_log": (400000, lambda n: {"device.eds": var("2000", "a"), "a.log": "".join(
        f"({i}.0) can0 605#2100200001000000\n" for i in range(n))}, ["decode", "a.log", "--node", "5=device.eds", "--summary"]),
    "interfaces_of_a_log": (100000, lambda n: {"device.eds": var("2000", "a"), "a.log": "".join(
        f"({i}.0) can{i} 705#05\n" for i in range(n))}, ["audit", "a.log", "--node", "5=device.eds"]),
    "nodes_of_a_network": (500, lambda n: {
        **network({}, nodes={f"n{i}": {"node_id": 1, "eds": "device.eds"} for i in range(n)}), "device.eds": var("2000", "a")}, NETWORK),
}
LARGEST_RATIO = 3.2
NEGLIGIBLE_SECONDS = 0.4  # of the larger size: the time of other work
LIMIT_SECONDS = 20


class Growing(unittest.TestCase):
    def seconds(self, files: dict[str, str], command: list[str]) -> float:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                (Path(folder) / name).write_text(text, encoding="utf-8", newline="")
            before = cpu_seconds()
            done = subprocess.run([EDSC, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  preexec_fn=lambda: limit_cpu_seconds(LIMIT_SECONDS), check=False)
            self.assertIn(done.returncode, (0, 1, 2, -signal.SIGXCPU), done.stderr[-2000:].decode(errors="replace"))
            return cpu_seconds() - before if done.returncode != -signal.SIGXCPU else float("inf")


def add_growing_test(name: str, size: int, make: Callable[[int], dict[str, str]], command: list[str]) -> None:
    def test(self: Growing) -> None:
        smaller = larger = float("inf")
        for _ in range(3):
            smaller, larger = min(smaller, self.seconds(make(size), command)), min(larger, self.seconds(make(2 * size), command))
            if larger < NEGLIGIBLE_SECONDS or larger < LARGEST_RATIO * smaller < float("inf"):
                break
        if VERBOSE:
            print(f"{name:32} {smaller:6.2f} s {larger:6.2f} s", flush=True)
        if larger >= NEGLIGIBLE_SECONDS:
            self.assertLess(larger, LARGEST_RATIO * smaller, f"{name}: the time grows faster than the size")
            self.assertLess(larger, float("inf"), f"{name}: edsc has not ended after {LIMIT_SECONDS} s of CPU time")

    setattr(Growing, f"test_{name}", test)


for growing_name, growing in list(GROWING.items())[::1 if LARGE else 3]:
    add_growing_test(growing_name, *growing)


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

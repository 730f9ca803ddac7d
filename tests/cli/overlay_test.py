#!/usr/bin/env python3
"""Overlays in the commands: findings, depfiles, options, network files, git, EDSC_OVERLAYS, and the commands of `edsc overlay`.

    overlay_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import gzip
import json
import os
import subprocess
import sys
import unittest

from cli_test import EDSC, FINE, INPUT_HAS_ERRORS, SMALL, SOURCE_DIR, WRONG_USAGE, CommandLine

HEADER = "[Overlay]\nVersion=1\nBase=small.eds\n"
RENAMED = HEADER + "; the manual\n[1017]\nParameterName=Producer heartbeat time => Heartbeat\n"
XDD = SOURCE_DIR / "examples/xdd/drive.xdd"


class Overlay(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.write("small.eds", SMALL)

    def run_edsc(self, *words: object, folders: str | None = None) -> subprocess.CompletedProcess[str]:
        environment = {name: value for name, value in os.environ.items() if name != "EDSC_OVERLAYS"}
        if folders is not None:
            environment["EDSC_OVERLAYS"] = folders
        return subprocess.run([EDSC, *map(str, words)], cwd=self.folder, env=environment, capture_output=True, text=True,
                              timeout=600)

    def dump(self, path: str, **options: str) -> dict:
        result = self.run_edsc("dump", path, **options)
        self.assertEqual(result.returncode, FINE, result.stderr)
        return json.loads(result.stdout)

    def assert_same_device(self, one: str, other: str) -> None:
        devices = [without_places(self.dump(path)) for path in (one, other)]
        for device in devices:
            del device["name"]  # of the file
        self.assertEqual(*devices)

    def heartbeat(self, path: str, **options: str) -> dict:
        return next(one for one in self.dump(path, **options)["objects"] if one["index"] == 0x1017)


class Commands(Overlay):
    def test_read_an_overlay(self) -> None:
        self.write("x.overlay", RENAMED)
        heartbeat = self.heartbeat("x.overlay")
        self.assertEqual(heartbeat["name"], "Heartbeat")
        self.assertEqual((heartbeat["file"], heartbeat["line"]), ("small.eds", SMALL.split("\n").index("[1017]") + 1))

    def test_read_a_base_as_its_options_say(self) -> None:
        """The encoding is that of the base, not of the overlay. The options are found beside the base, or the overlay has the key."""
        base = SMALL.replace("[1017]\nParameterName=", "[1017]\nParameterName=ハートビート ")
        self.assertNotEqual(base, SMALL)
        (self.folder / "small.eds").write_bytes(base.encode("shift-jis"))
        wrong = "; für\n[1017]\nDataType=9 => 7\n"
        for options, key in (("small.options.json", ""), ("x.options.json", ""), (None, "Encoding=Shift-JIS\n")):
            with self.subTest(options=options):
                for name in ("small.options.json", "x.options.json"):
                    (self.folder / name).unlink(missing_ok=True)
                if options:
                    self.write(options, '{"encoding": "Shift-JIS"}')
                self.write("x.overlay", HEADER + key + "[1018sub1]\nAccessType=ro => const\n")
                self.assertTrue(self.heartbeat("x.overlay")["name"].startswith("ハートビート "))
                self.write("x.overlay", HEADER + key + wrong)
                found = self.run_edsc("check", "x.overlay").stdout
                self.assertEqual((found.count("[overlay-stale]"), found.count("für [overlay-stale]")), (1, 1), found)

    def test_findings_point_to_the_file_of_the_value(self) -> None:
        self.write("x.overlay", HEADER + "[1017]\nDataType=6 => 99\n[1018sub1]\nDataType=7 =>\n")
        found = json.loads(self.run_edsc("check", "x.overlay", "--format", "json").stdout)["diagnostics"]
        places = [(one["rule"], one["file"], one["line"], one["column"]) for one in found]
        self.assertIn(("data-type", "x.overlay", 5, 15), places)
        text = self.run_edsc("check", "x.overlay").stdout
        self.assertIn("    5 | DataType=6 => 99\n", text)
        self.assertIn(f"small.eds:{SMALL.split(chr(10)).index('[1018sub1]') + 1}:", text)

    def test_depfile_has_all_files(self) -> None:
        self.write("x.overlay", RENAMED)
        self.write("y.overlay", HEADER.replace("small.eds", "x.overlay"))
        self.write("small.options.json", '{"names": {"1017h": "beat"}}')
        result = self.run_edsc("generate", "y.overlay", "-o", "out", "--depfile", "d")
        self.assertEqual(result.returncode, FINE, result.stderr)
        depfile = (self.folder / "d").read_text()
        for name in ("y.overlay", "x.overlay", "small.eds", "small.options.json"):
            self.assertIn(name, depfile)
        self.assertIn("struct beat ", (self.folder / "out/y/dictionary.hpp").read_text())

    def test_options_of_the_overlay_precede_those_of_the_base(self) -> None:
        self.write("x.overlay", RENAMED)
        self.write("small.options.json", '{"names": {"1017h": "of_base"}}')
        self.write("x.options.json", '{"names": {"1017h": "of_overlay"}}')
        self.assertEqual(self.heartbeat("x.overlay")["identifier"], "of_overlay")
        self.assertEqual(self.heartbeat("small.eds")["identifier"], "of_base")

    def test_strict_requires_reasons(self) -> None:
        self.write("x.overlay", RENAMED.replace("; the manual\n", ""))
        self.assertNotIn("overlay-reason", self.run_edsc("check", "x.overlay").stdout)
        self.assertIn("overlay-reason", self.run_edsc("check", "x.overlay", "--strict").stdout)

    def test_stale_lines_and_broken_bases_stop_generate(self) -> None:
        self.write("x.overlay", HEADER + "[1017]\nDataType=5 => 7\n")
        self.assertEqual(self.run_edsc("generate", "x.overlay", "-o", "out", "--keep-going").returncode, INPUT_HAS_ERRORS)
        self.write("x.overlay", HEADER.replace("small.eds", "missing.eds"))
        result = self.run_edsc("generate", "x.overlay", "-o", "out")
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertIn("x.overlay:3:6: error: cannot read missing.eds", result.stderr)

    def test_network_files_name_overlays(self) -> None:
        self.write("x.overlay", HEADER + "[1017]\nDataType=5 => 7\n")
        self.write("plant.json", json.dumps({"bit_rate": 125, "nodes": {"a": {"node_id": 3, "eds": "x.overlay"}}}))
        result = self.run_edsc("network", "check", "plant.json")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertIn("x.overlay:5:10: error:", result.stdout + result.stderr)
        self.write("x.overlay", RENAMED)
        result = self.run_edsc("network", "generate", "plant.json", "-o", "out", "--depfile", "d")
        self.assertEqual(result.returncode, FINE, result.stdout + result.stderr)
        self.assertIn("small.eds", (self.folder / "d").read_text())

    def test_diff_and_git(self) -> None:
        self.write("x.overlay", RENAMED)
        result = self.run_edsc("diff", "small.eds", "x.overlay")
        self.assertIn("Heartbeat", result.stdout)
        git = ["git", "-c", "user.name=a", "-c", "user.email=a@b"]
        for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "a"]):
            subprocess.run([*git, *words], cwd=self.folder, check=True)
        self.write("x.overlay", HEADER)
        result = self.run_edsc("diff", "--against", "git:HEAD", "x.overlay")
        self.assertIn("identifier heartbeat becomes producer_heartbeat_time", result.stdout, result.stderr)

    def test_allow_comments_apply_to_the_line(self) -> None:
        self.write("x.overlay", HEADER + "[1017]\nLowLimit=abc\n")
        rule = json.loads(self.run_edsc("check", "x.overlay", "--format", "json").stdout)["diagnostics"][0]["rule"]
        self.write("x.overlay", HEADER + f"[1017]\n; edsc: allow {rule} - known\nLowLimit=abc\n")
        found = json.loads(self.run_edsc("check", "x.overlay", "--format", "json").stdout)
        self.assertEqual([one for one in found["diagnostics"] if one["rule"] == rule], [])
        self.assertEqual(found["allowed_diagnostics"][0]["allowance"]["reason"], "known")

    def test_allow_comments_before_the_first_section_apply_to_the_file(self) -> None:
        self.write("x.overlay", HEADER + "[1017]\nLowLimit=abc\n")
        rule = json.loads(self.run_edsc("check", "x.overlay", "--format", "json").stdout)["diagnostics"][0]["rule"]
        self.write("x.overlay", f"; edsc: allow {rule} - everywhere\n{HEADER}[1017]\nLowLimit=abc\n[1001]\nLowLimit=abc\n")
        found = json.loads(self.run_edsc("check", "x.overlay", "--format", "json").stdout)
        self.assertEqual([one for one in found["diagnostics"] if one["rule"] == rule], [])
        self.assertEqual([one["allowance"]["reason"] for one in found["allowed_diagnostics"]], ["everywhere"] * 2)

    def test_a_conformance_test_has_the_node_id_of_the_result(self) -> None:
        self.write("a.dcf", SMALL + "[DeviceComissioning]\nNodeID=7\n")
        self.write("removed.dcf", SMALL)
        header = HEADER.replace("small.eds", "a.dcf")
        change = "[DeviceComissioning]\nNodeID={}\n"
        rows = (("base", header, "7"), ("set", header + change.format("7 => 0x0B"), "0x0B"),
                ("new", HEADER + change.format("9 ; ours"), "9"), ("none", HEADER, ""),
                ("nested", header.replace("a.dcf", "base.overlay"), "7"))
        for name, overlay, node_id in rows:
            with self.subTest(name):
                self.write(f"{name}.overlay", overlay)
                self.write("ask.cmake", f'include("{SOURCE_DIR}/cmake/EdscAddConformanceTest.cmake")\n'
                                        f'edsc_node_id_of_file("{self.folder}/{name}.overlay" node_id)\n'
                                        'message("<${node_id}>")\n')
                result = subprocess.run(["cmake", "-P", "ask.cmake"], cwd=self.folder, capture_output=True, text=True,
                                        check=True)
                self.assertEqual(result.stderr.strip(), f"<{node_id}>")


class OverlayCommands(Overlay):
    def apply(self, *words: str) -> bytes:
        result = self.run_edsc("overlay", "apply", "x.overlay", "-o", "out.eds", *words)
        self.assertEqual(result.returncode, FINE, result.stderr)
        return (self.folder / "out.eds").read_bytes()

    def test_apply_keeps_the_bytes_of_the_base(self) -> None:
        base = SMALL.replace("\n", "\r\n").encode() + b"; Gr\xfc\xdfe"
        (self.folder / "small.eds").write_bytes(base)
        self.write("x.overlay", RENAMED)
        expected = base.replace(b"Producer heartbeat time", b"Heartbeat")
        self.assertEqual(self.apply(), expected)
        (self.folder / "small.eds").write_bytes(gzip.compress(base))
        self.assertEqual(self.apply(), expected)
        self.write("x.overlay", RENAMED.replace("Heartbeat", "Herzschl\u00e4ge"))
        self.assertEqual(self.apply(), base.replace(b"Producer heartbeat time", b"Herzschl\xe4ge"))

    def test_apply_reports_a_character_that_the_encoding_does_not_have(self) -> None:
        self.write("x.overlay", RENAMED.replace("Heartbeat", "\u00b5s"))
        result = self.run_edsc("overlay", "apply", "x.overlay", "-o", "out.eds")
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertIn("\u00b5", result.stderr)
        self.assertFalse((self.folder / "out.eds").exists())
        self.assertIn("\u00b5s".encode(), self.apply("--utf8"))

    def test_the_commands_read_the_base_as_its_options_say(self) -> None:
        """Sub-indices 10 to 12 are Ah to Ch."""
        subs = "".join(f"[2000sub{i}]\nParameterName=S{i}\nObjectType=7\nDataType=5\nAccessType=rw\n" for i in range(13))
        base = SMALL + "[2000]\nParameterName=A\nObjectType=9\nSubNumber=13\n" + subs
        self.write("small.eds", base)
        for options in ("x.options.json", "small.options.json", None):
            with self.subTest(options):
                for name in ("small.options.json", "x.options.json"):
                    (self.folder / name).unlink(missing_ok=True)
                if options:
                    self.write(options, '{"sub_indices": "decimal"}')
                self.write("x.overlay", HEADER + "[2000sub10]\nParameterName=S10 => Tenth\n")
                self.assertEqual(self.apply().decode(), base.replace("ParameterName=S10", "ParameterName=Tenth"))
                result = self.run_edsc("format", "x.overlay", "-o", "formatted.eds")
                text = (self.folder / "formatted.eds").read_text()
                self.assertEqual("[2000subA]" in text, options is not None, result.stderr)
                self.write("edited.eds", base.replace("ParameterName=S10", "ParameterName=Tenth"))
                self.assertIn("ParameterName=S10 => Tenth", self.run_edsc("overlay", "from", "small.eds", "edited.eds").stdout)
                result = self.run_edsc("overlay", "rebase", "x.overlay", "small.eds")
                self.assertEqual((result.returncode, ": kept: " in result.stdout), (FINE, True), result.stderr)

    def test_apply_writes_what_every_command_reads(self) -> None:
        self.write("x.overlay", RENAMED + "\n; not there\n[1018sub1]\nRemove=1\n")
        self.apply()
        self.assert_same_device("x.overlay", "out.eds")

    def test_an_xdd_is_converted_as_format_does(self) -> None:
        (self.folder / "a.xdd").write_bytes(XDD.read_bytes())
        self.write("x.overlay", "[Overlay]\nVersion=1\nBase=a.xdd\n")
        self.apply()
        self.assert_same_device("x.overlay", "out.eds")
        result = self.run_edsc("format", "out.eds", "-o", "a.eds")
        formatted = self.run_edsc("format", "a.xdd", "-o", "b.eds")
        self.assertEqual(formatted.returncode, FINE, formatted.stderr + result.stderr)
        names = ((self.folder / "a.eds").read_text().replace("FileName=b.eds", "FileName=a.eds"),
                 (self.folder / "b.eds").read_text().replace("FileName=b.eds", "FileName=a.eds"))
        self.assertEqual(*names)

    def test_format_does_not_overwrite_an_overlay(self) -> None:
        self.write("x.overlay", RENAMED)
        for option in ("--check", "--in-place"):
            self.assertEqual(self.run_edsc("format", option, "x.overlay").returncode, WRONG_USAGE)
        self.assertEqual((self.folder / "x.overlay").read_text(), RENAMED)
        result = self.run_edsc("format", "x.overlay", "-o", "out.eds")
        self.assertEqual(result.returncode, FINE, result.stderr)
        self.assertIn("ParameterName=Heartbeat\n", (self.folder / "out.eds").read_text())

    def test_from_derives_an_overlay_that_apply_reverts_to_the_copy(self) -> None:
        edited = SMALL.replace("AccessType=rw", "AccessType=ro")
        self.write("edited.eds", edited)
        (self.folder / "sub").mkdir()
        result = self.run_edsc("overlay", "from", "small.eds", "edited.eds", "-o", "sub/x.overlay")
        self.assertEqual(result.returncode, FINE, result.stderr)
        self.assertEqual((self.folder / "sub/x.overlay").read_text(),
                         "[Overlay]\nVersion=1\nBase=../small.eds\n\n[1017]\nAccessType=rw => ro\n")
        applied = self.run_edsc("overlay", "apply", "sub/x.overlay")
        self.assertEqual(applied.stdout, edited)

    def test_rebase_lists_lines_and_writes_the_overlay(self) -> None:
        self.write("x.overlay", HEADER + "; a\n[1017]\nDataType=5 => 6\n; b\n[1001]\nAccessType=ro => rw\nDataType=6 => 7\n")
        self.write("new.eds", SMALL)
        result = self.run_edsc("overlay", "rebase", "x.overlay", "new.eds", "-o", "x.overlay")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertEqual(result.stdout.splitlines(), ["x.overlay:6: obsolete: DataType=5 => 6",
                                                      "x.overlay:9: kept: AccessType=ro => rw",
                                                      "x.overlay:10: stale: DataType=6 => 7"])
        self.assertEqual((self.folder / "x.overlay").read_text(),
                         "[Overlay]\nVersion=1\nBase=new.eds\n; b\n[1001]\nAccessType=ro => rw\nDataType=6 => 7\n")


class Search(Overlay):
    IDENTITY = "[Overlay]\nVersion=1\nVendorNumber=0x17\nProductNumber=2\n"
    CHANGE = "[1017]\nParameterName=Producer heartbeat time => "

    def setUp(self) -> None:
        super().setUp()
        identity = "VendorNumber=23\nProductNumber=2\nRevisionNumber=5"
        self.write("known.eds", SMALL.replace("BaudRate_125=1", f"BaudRate_125=1\n{identity}"))
        for folder in ("one", "two"):
            (self.folder / folder).mkdir()
        (self.folder / "one/a.overlay").write_text(self.IDENTITY + self.CHANGE + "A\n")

    def name(self, path: str = "known.eds", folders: str = "one:two") -> str:
        return self.heartbeat(path, folders=folders)["name"]

    def test_applies_to_files_with_this_identity(self) -> None:
        self.assertEqual(self.name(), "A")
        self.assertEqual(self.name("small.eds"), "Producer heartbeat time")
        self.assertEqual(self.name(folders="two"), "Producer heartbeat time")
        self.assertEqual(self.name(folders=""), "Producer heartbeat time")

    def test_the_output_names_it(self) -> None:
        result = self.run_edsc("check", "known.eds", folders="one")
        self.assertIn("edsc: known.eds: changed by one/a.overlay of EDSC_OVERLAYS\n", result.stderr)

    def test_the_revision_is_more_specific(self) -> None:
        (self.folder / "two/b.overlay").write_text(self.IDENTITY + "RevisionNumber=5\n" + self.CHANGE + "B\n")
        (self.folder / "two/c.overlay").write_text(self.IDENTITY + "RevisionNumber=6\n" + self.CHANGE + "C\n")
        self.assertEqual(self.name(), "B")

    def test_two_equal_ones_are_an_error(self) -> None:
        (self.folder / "two/b.overlay").write_text(self.IDENTITY + self.CHANGE + "B\n")
        result = self.run_edsc("check", "known.eds", folders="one:two")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertIn("one/a.overlay and two/b.overlay", result.stdout)

    def test_depfile_has_both_files(self) -> None:
        result = self.run_edsc("generate", "known.eds", "-o", "out", "--depfile", "d", folders="one")
        self.assertEqual(result.returncode, FINE, result.stderr)
        depfile = (self.folder / "d").read_text()
        self.assertIn("one/a.overlay", depfile)
        self.assertIn("known.eds", depfile)


def without_places(value: object) -> object:
    if isinstance(value, dict):
        return {key: without_places(one) for key, one in value.items() if key not in ("line", "file", "source")}
    if isinstance(value, list):
        return [without_places(one) for one in value]
    return value


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)

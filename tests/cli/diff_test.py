#!/usr/bin/env python3
"""`edsc diff`: audiences, exit codes, Markdown, and files of git revisions.

    diff_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from cli_test import FINE, INPUT_HAS_ERRORS, SMALL, SOURCE_DIR, WRONG_USAGE, CommandLine

RENAMED = SMALL.replace("Producer heartbeat time", "Heartbeat")
REDUCED = SMALL.replace("DataType=6\nAccessType=rw", "DataType=6\nAccessType=ro")
ADDED = SMALL.replace("SupportedObjects=1\n1=0x1017", "SupportedObjects=2\n1=0x1017\n2=0x100D") + (
    "[100D]\nParameterName=Life time factor\nObjectType=7\nDataType=5\nAccessType=rw\n")


class ExitCodes(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.old = self.write("old.eds", SMALL)

    def code(self, text: str, *options: object) -> int:
        return self.edsc("diff", self.old, self.write("new.eds", text), *options).returncode

    def test_say_whether_a_change_breaks(self) -> None:
        for text, breaking, any_change in ((SMALL, 0, 0), (ADDED, 0, 1), (REDUCED, 1, 1)):
            self.assertEqual(self.code(text), breaking)
            self.assertEqual(self.code(text, "--fail-on", "breaking"), breaking)
            self.assertEqual(self.code(text, "--fail-on", "any"), any_change)
            self.assertEqual(self.code(text, "--fail-on", "never"), 0)

    def test_follow_the_audience(self) -> None:
        self.assertEqual(self.code(RENAMED), INPUT_HAS_ERRORS)
        self.assertEqual(self.code(RENAMED, "--audience", "source"), INPUT_HAS_ERRORS)
        self.assertEqual(self.code(RENAMED, "--audience", "wire"), FINE)

    def test_of_the_wrong_number_of_files(self) -> None:
        self.expect(WRONG_USAGE, self.edsc("diff", self.old), "expected two files")
        self.expect(WRONG_USAGE, self.edsc("diff", self.old, self.old, self.old), "expected two files")
        self.expect(WRONG_USAGE, self.edsc("diff", self.old, self.old, "--allow-new"), "--against")
        self.expect(WRONG_USAGE, self.edsc("diff", self.old, "--against", "HEAD"), "expected git:REF, got HEAD")


class Output(CommandLine):
    def test_does_not_have_the_warnings_of_the_files(self) -> None:
        text = SMALL + "[Strange]\na=1\n"
        result = self.edsc("diff", self.write("old.eds", text), self.write("new.eds", text))
        self.expect(FINE, result, "0 breaking, 0 compatible")
        self.assertEqual(result.stderr, "")
        broken = text.replace("DataType=6", "DataType=99")
        result = self.edsc("diff", self.write("old.eds", broken), self.write("new.eds", text))
        self.expect(WRONG_USAGE, result, "[data-type]")
        self.assertNotIn("unknown-section", result.stderr)

    def test_does_not_call_the_behaviour_the_same_beside_a_breaking_change(self) -> None:
        old = SMALL.replace("[DeviceInfo]\n", "[DeviceInfo]\nRevisionNumber=0x10001\n", 1)
        new = REDUCED.replace("[DeviceInfo]\n", "[DeviceInfo]\nRevisionNumber=0x10002\n", 1)
        result = self.edsc("diff", self.write("old.eds", old), self.write("new.eds", new))
        self.expect(INPUT_HAS_ERRORS, result, "[revision-minor]", "[revision-unchanged]")
        self.assertNotIn("behaviour is the same", result.stdout)


class DomainFiles(CommandLine):
    TEXT = SMALL.replace("SupportedObjects=1\n1=0x1017", "SupportedObjects=2\n1=0x1017\n2=0x1021") + (
        "[1021]\nParameterName=Store EDS\nObjectType=2\nDataType=0xF\nAccessType=rw\nUploadFile=NAME\n")

    def sheets(self, old: str, new: str) -> tuple[Path, Path]:
        return tuple(self.write(f"{name}.eds", self.TEXT.replace("NAME", file)) for name, file in (("old", old), ("new", new)))

    def test_are_compared_by_content(self) -> None:
        (self.folder / "a.bin").write_bytes(b"\0\1\2")
        (self.folder / "b.bin").write_bytes(b"\0\1\2")
        (self.folder / "c.bin").write_bytes(b"\0\1\3\4")
        self.expect(FINE, self.edsc("diff", *self.sheets("a.bin", "b.bin")), "0 breaking, 0 compatible")
        self.expect(FINE, self.edsc("diff", *self.sheets("a.bin", "c.bin")),
                    "file of a DOMAIN UploadFile a.bin (3 bytes) becomes c.bin (4 bytes)", "[domain-file]")
        self.expect(FINE, self.edsc("diff", *self.sheets("a.bin", "none.bin")), "a.bin (3 bytes) becomes none.bin: ")
        self.expect(FINE, self.edsc("diff", *self.sheets("none.bin", "none.bin")), "0 breaking, 0 compatible")


class KeepGoing(CommandLine):
    BROKEN = SMALL.replace("DataType=6", "DataType=99")

    def test_compares_the_rest_of_files_with_errors(self) -> None:
        old, new = self.write("old.eds", self.BROKEN), self.write("new.eds", self.BROKEN)
        self.expect(WRONG_USAGE, self.edsc("diff", old, new), "error: ", "[data-type]")
        self.expect(FINE, self.edsc("diff", old, new, "--keep-going"), "warning: ", "[data-type]", "0 breaking")

    def test_stops_at_errors_in_the_options_file(self) -> None:
        old, new = self.write("old.eds", SMALL), self.write("new.eds", SMALL)
        self.write("new.options.json", '{"nonsense": 1}')
        result = self.edsc("diff", old, new, "--keep-going")
        self.expect(WRONG_USAGE, result, "new.options.json:1:", "error: ")
        self.assertEqual(result.stdout, "")


class Markdown(CommandLine):
    def test_is_a_table_with_compatible_changes_folded(self) -> None:
        old = self.write("old.eds", SMALL)
        new = self.write("new.eds", ADDED.replace("DataType=6\nAccessType=rw", "DataType=6\nAccessType=ro"))
        result = self.edsc("diff", old, new, "--format", "markdown")
        self.expect(INPUT_HAS_ERRORS, result)
        self.assertEqual(result.stdout, f"""### {self.shown(new)} against {self.shown(old)}

**1 breaking**, 1 compatible

| Entry | Change | Breaks | Line | Kind |
| --- | --- | --- | ---: | --- |
| 1017h:00 Producer heartbeat time | access rw becomes ro: an access that was allowed is aborted | master, source code | 29 | `access-reduced` |

<details>
<summary>1 compatible</summary>

| Entry | Change | Breaks | Line | Kind |
| --- | --- | --- | ---: | --- |
| 100Dh Life time factor | object added: not used yet | - | 45 | `object-added` |

</details>
""")

    @staticmethod
    def shown(path: Path) -> str:
        return str(path).replace("_", "\\_")

    def test_holds_no_markup_of_the_file(self) -> None:
        old = self.write("old.eds", SMALL)
        new = self.write("new.eds", SMALL.replace("Error register", "a|b <b>`c`*d*$x$ [e](f)"))
        table = self.edsc("diff", old, new, "--format", "markdown").stdout
        self.assertIn("a\\|b &lt;b\\>\\`c\\`\\*d\\*\\$x\\$ \\[e\\](f)", table)

    def test_of_two_equal_files_says_so(self) -> None:
        old = self.write("old.eds", SMALL)
        self.assertEqual(self.edsc("diff", old, old, "--format", "markdown").stdout,
                         f"### {self.shown(old)} against {self.shown(old)}\n\n**0 breaking**, 0 compatible\n")


class Git(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.environment = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull, "GIT_AUTHOR_NAME": "a",
                            "GIT_AUTHOR_EMAIL": "a@example.org", "GIT_COMMITTER_NAME": "a",
                            "GIT_COMMITTER_EMAIL": "a@example.org", "GIT_CEILING_DIRECTORIES": str(self.folder.parent)}
        for name in ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX"):  # set by a hook that runs the tests
            os.environ.pop(name, None)
        self.git("init", "-q", "-b", "main")
        (self.folder / "eds").mkdir()
        self.sheet = self.write("eds/device.eds", SMALL)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "one")

    def git(self, *arguments: str) -> None:
        subprocess.run(["git", *arguments], cwd=self.folder, check=True, env={**os.environ, **self.environment})

    def against(self, revision: str, *arguments: object, **more: object) -> subprocess.CompletedProcess[str]:
        return self.edsc("diff", "--against", f"git:{revision}", *arguments, environment=self.environment, **more)

    def test_gives_the_file_of_a_revision(self) -> None:
        self.expect(FINE, self.against("HEAD", "eds/device.eds"), "0 breaking, 0 compatible")
        self.sheet.write_text(REDUCED)
        self.expect(INPUT_HAS_ERRORS, self.against("HEAD", "eds/device.eds"),
                    "eds/device.eds:28: breaks master and source code: 1017h:00", "(was HEAD:eds/device.eds:28)")
        self.expect(INPUT_HAS_ERRORS, self.against("main", self.sheet), "access-reduced")
        self.git("commit", "-q", "-a", "-m", "two")
        self.expect(FINE, self.against("HEAD", self.sheet))
        self.expect(INPUT_HAS_ERRORS, self.against("HEAD~1", self.sheet), "access-reduced")

    def test_compares_the_file_of_a_domain_with_the_one_of_the_revision(self) -> None:
        self.sheet.write_text(DomainFiles.TEXT.replace("NAME", "a.bin"))
        content = self.folder / "eds/a.bin"
        content.write_bytes(b"\x80\0\1")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "domain")
        self.expect(FINE, self.against("HEAD", self.sheet), "0 breaking, 0 compatible")
        content.write_bytes(b"\x80\0\2")
        self.expect(FINE, self.against("HEAD", self.sheet), "a.bin (3 bytes) becomes a.bin (3 bytes)", "[domain-file]")

    def test_works_in_a_subfolder_and_from_elsewhere(self) -> None:
        self.sheet.write_text(ADDED)
        for folder, path in ((self.folder / "eds", "device.eds"), (Path("/"), self.sheet)):
            result = subprocess.run([sys.argv[2], "diff", "--against", "git:HEAD", path], cwd=folder, text=True,
                                    capture_output=True, timeout=600, env={**os.environ, **self.environment})
            self.expect(FINE, result, "object-added", "0 breaking, 1 compatible")

    def test_works_in_a_hook(self) -> None:
        """In a hook git sets GIT_DIR, relative to the top of the working tree."""
        self.environment["GIT_DIR"] = ".git"
        self.expect(FINE, self.against("HEAD", "eds/device.eds"), "0 breaking, 0 compatible")

    def test_takes_the_options_of_the_revision(self) -> None:
        options = self.write("eds/device.options.json", '{"names": {"1017": "beat"}}')
        self.git("add", ".")
        self.git("commit", "-q", "-m", "named")
        self.expect(FINE, self.against("HEAD", self.sheet), "0 breaking, 0 compatible")
        options.unlink()
        self.expect(INPUT_HAS_ERRORS, self.against("HEAD", self.sheet), "[identifier]")

    def test_reports_an_unknown_rule_in_the_options_of_the_revision(self) -> None:
        options = self.write("eds/device.options.json", '{"silence": ["no-such-rule"]}')
        self.git("add", ".")
        self.git("commit", "-q", "-m", "wrong")
        options.write_text("{}")
        self.expect(WRONG_USAGE, self.against("HEAD", self.sheet), 'silence: unknown rule "no-such-rule"',
                    f"HEAD:{options}:1:")
        for name in ("silence", "allow"):
            options.write_text(json.dumps({name: [{"rule": "no-such-rule", "reason": "x"} if name == "allow" else "no-such-rule"]}))
            self.git("commit", "-q", "-a", "--allow-empty", "-m", name)
            here = self.edsc("diff", self.sheet, self.sheet)
            self.expect(WRONG_USAGE, here, f'{name}: unknown rule "no-such-rule"')
            options.write_text("{}")
            self.expect(WRONG_USAGE, self.against("HEAD", self.sheet), f'{name}: unknown rule "no-such-rule"')

    def test_takes_many_files(self) -> None:
        other = self.write("eds/other.eds", SMALL)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "two files")
        self.sheet.write_text(ADDED)
        other.write_text(REDUCED)
        self.expect(INPUT_HAS_ERRORS, self.against("HEAD", self.sheet, other), "device.eds:45: compatible",
                    "other.eds:28: breaks", "1 breaking, 1 compatible")
        found = json.loads(self.against("HEAD", self.sheet, other, "--format", "json").stdout)
        self.assertEqual([change["kind"] for change in found["changes"]], ["object-added", "access-reduced"])
        self.assertEqual(self.against("HEAD", self.sheet, other, "--format", "markdown").stdout.count("### "), 2)

    def test_says_what_is_missing(self) -> None:
        new = self.write("eds/new.eds", SMALL)
        self.expect(WRONG_USAGE, self.against("HEAD", new), "new.eds is not in the git revision HEAD")
        self.expect(FINE, self.against("HEAD", new, "--allow-new"), "0 breaking, 0 compatible")
        self.expect(FINE, self.against("HEAD", new, "--allow-new", "--format", "markdown"), "is new")
        self.expect(WRONG_USAGE, self.against("nowhere", self.sheet), '"nowhere" is not a git revision')
        self.expect(WRONG_USAGE, self.against("nowhere", self.sheet, "--allow-new"), '"nowhere" is not a git revision')
        self.expect(WRONG_USAGE, self.against("--output=x", self.sheet), "is not a git revision")
        self.expect(WRONG_USAGE, self.against("HEAD", "eds/none.eds"), "none.eds is not in the git revision HEAD")
        self.sheet.unlink()
        self.expect(WRONG_USAGE, self.against("HEAD", self.sheet), "No such file")

    def test_shows_no_markup_of_the_name_of_a_new_file(self) -> None:
        self.write("eds/a`b<i>.eds", SMALL)
        result = self.against("HEAD", "eds/a`b<i>.eds", "--allow-new", "--format", "markdown")
        self.expect(FINE, result)
        self.assertEqual(result.stdout, "### eds/a\\`b&lt;i\\>.eds is new\n")

    def test_takes_no_name_for_a_pattern(self) -> None:
        committed = self.write("eds/[1].eds", SMALL)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "brackets")
        committed.write_text(REDUCED)
        self.expect(INPUT_HAS_ERRORS, self.against("HEAD", committed), "1 breaking")
        new = self.write("eds/new[2].eds", SMALL)
        self.expect(WRONG_USAGE, self.against("HEAD", new), "new[2].eds is not in the git revision HEAD")

    def test_takes_neither_a_range_nor_an_exclusion_for_a_revision(self) -> None:
        for revision in ("^HEAD", "HEAD..HEAD", "HEAD^!", "HEAD^@", "HEAD...HEAD"):
            for more in ((), ("--allow-new",)):
                with self.subTest(revision=revision, more=more):
                    self.expect(WRONG_USAGE, self.against(revision, self.sheet, *more),
                                f'"{revision}" is not a git revision')

    def test_reads_a_file_whose_folder_the_working_tree_no_longer_has(self) -> None:
        self.sheet.unlink()
        (self.folder / "eds").rmdir()
        self.expect(WRONG_USAGE, self.against("HEAD", "eds/device.eds"), "cannot read eds/device.eds: No such file")
        self.expect(WRONG_USAGE, self.against("HEAD", "eds/none.eds"), "none.eds is not in the git revision HEAD")

    def object_file(self, name: str) -> Path:
        found = subprocess.run(["git", "rev-parse", name], cwd=self.folder, capture_output=True, text=True, check=True)
        number = found.stdout.strip()
        return self.folder / ".git/objects" / number[:2] / number[2:]

    def test_an_object_that_git_cannot_read_is_not_a_missing_file(self) -> None:
        """A device that breaks masters is not accepted as a new one, whatever of the old one is damaged or missing."""
        self.write("eds/device.options.json", '{"names": {"1017": "beat"}}')
        self.write("eds/a.bin", b"\x80\0\1")
        self.sheet.write_text(DomainFiles.TEXT.replace("NAME", "a.bin"))
        self.git("add", ".")
        self.git("commit", "-q", "-m", "complete")
        self.expect(FINE, self.against("HEAD", self.sheet, "--allow-new"), "0 breaking, 0 compatible")
        for name, message in (("HEAD:eds/device.eds", "its blob is damaged, or missing"),
                              ("HEAD:eds/device.options.json", "its blob is damaged, or missing"),
                              ("HEAD:eds/a.bin", "its blob is damaged, or missing"),
                              ("HEAD:eds", "cannot read the tree of the git revision HEAD"),
                              ("HEAD^{tree}", "cannot read the tree of the git revision HEAD"),
                              ("HEAD", "cannot read the tree of the git revision HEAD")):
            file = self.object_file(name)
            content = file.read_bytes()
            for state in ("damaged", "missing"):
                with self.subTest(object=name, state=state):
                    file.unlink()
                    if state == "damaged":
                        file.write_bytes(b"no object")
                    self.expect(WRONG_USAGE, self.against("HEAD", self.sheet, "--allow-new"), message)
                    file.unlink(missing_ok=True)
                    file.write_bytes(content)
        self.expect(FINE, self.against("HEAD", self.sheet, "--allow-new"), "0 breaking, 0 compatible")

    def test_what_is_not_a_file_in_the_revision_is_named(self) -> None:
        (self.folder / "eds/link.eds").symlink_to("device.eds")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "link")
        self.expect(WRONG_USAGE, self.against("HEAD", "eds/link.eds", "--allow-new"),
                    "eds/link.eds is a symbolic link in the git revision HEAD")
        (self.folder / "eds.eds").mkdir()
        (self.folder / "eds.eds/a.eds").write_text("")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "folder")
        shutil.rmtree(self.folder / "eds.eds")
        (self.folder / "eds.eds").write_bytes((self.folder / "eds/device.eds").read_bytes())
        self.expect(WRONG_USAGE, self.against("HEAD", "eds.eds", "--allow-new"),
                    "eds.eds is a folder in the git revision HEAD")

    def test_a_repository_of_someone_else_runs_nothing(self) -> None:
        """A missing blob would be fetched from the promisor remote, whose address here is a command."""
        ran = self.folder / "ran"
        self.git("config", "core.repositoryFormatVersion", "1")
        self.git("config", "extensions.partialClone", "origin")
        self.git("config", "remote.origin.promisor", "true")
        self.git("config", "remote.origin.url", f"ext::touch {ran}")
        self.git("config", "protocol.ext.allow", "always")
        self.object_file("HEAD:eds/device.eds").unlink()
        self.expect(WRONG_USAGE, self.against("HEAD", self.sheet, "--allow-new"), "missing as in a partial clone")
        self.assertFalse(ran.exists())
        subprocess.run(["git", "show", "HEAD:eds/device.eds"], cwd=self.folder, capture_output=True, check=False,
                       env={**os.environ, **self.environment})
        self.assertTrue(ran.exists(), "git alone does not fetch: the repository of this test is wrong")

    def test_says_that_a_folder_is_not_in_a_repository(self) -> None:
        shutil_free = self.folder / ".git"
        shutil_free.rename(self.folder / "no-git")
        self.expect(WRONG_USAGE, self.against("HEAD", self.sheet), "not a git repository")

    def test_says_that_git_is_missing(self) -> None:
        self.environment["PATH"] = str(self.folder)
        self.expect(WRONG_USAGE, self.against("HEAD", self.sheet), "git cannot be started; is it installed and in PATH?")


if __name__ == "__main__":
    assert SOURCE_DIR
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)

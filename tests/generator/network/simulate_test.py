#!/usr/bin/env python3
"""edsc network simulate: the example networks, faults, and errors of use.

    simulate_test.py SOURCE_DIR EDSC [--sample] COMPILER...

--sample: of the example networks only the one of twelve equal axes, whose program takes least to compile.

The expected counts follow from the times in the network files. The bounds are those of the analysis, which other tests verify
against the published table; here, generated devices must not exceed them.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
SAMPLE = sys.argv[3] == "--sample"
COMPILER = " ".join(sys.argv[4 if SAMPLE else 3:])
SCHEMA = json.loads((SOURCE_DIR / "docs/schema/network_simulate.schema.json").read_text())
EXAMPLES = SOURCE_DIR / "examples/networks"
FINE, FAILED, WRONG_USAGE = 0, 1, 2

# A sensor that sends on change, at most every 20 ms, and one that is polled by SYNC.
PLANT = {
    "bit_rate": 125,
    "sync": {"producer": "control", "period_us": 50_000},
    "nodes": {
        "control": {"node_id": 127, "master": True, "heartbeat_ms": 100},
        "inputs": {"node_id": 2, "eds": "inputs.eds", "heartbeat_ms": 200},
        "others": {"node_id": 3, "eds": "inputs.eds", "heartbeat_ms": 200},
    },
    "signals": [
        {"from": "inputs", "object": "6000h:01", "to": "control", "every_ms": 20},
        {"from": "others", "object": "6000h:01", "to": "control", "every_sync": 1},
    ],
}


PROGRAMS = Path(tempfile.mkdtemp(prefix="edsc-simulate-"))
unittest.addModuleCleanup(shutil.rmtree, PROGRAMS)


class Simulation(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-simulate-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, plant: dict) -> Path:
        shutil.copy(SOURCE_DIR / "eds/can-2053c.eds", self.folder / "inputs.eds")
        path = self.folder / "plant.json"
        path.write_text(json.dumps(plant))
        return path

    def run_edsc(self, path: Path, *arguments: str, compiler: str = COMPILER) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, "network", "simulate", path, *arguments], capture_output=True, text=True, timeout=1500,
                              cwd=self.folder, env={**os.environ, "CXX": compiler})

    def program_of(self, path: Path) -> Path:
        """The folder for the program of this network: tests that simulate the same one compile it once."""
        return PROGRAMS / hashlib.sha256(path.read_bytes()).hexdigest()

    def simulate(self, path: Path, *arguments: str, exit_code: int = FINE) -> dict:
        result = self.run_edsc(path, *arguments, "--format", "json", "-o", str(self.program_of(path)))
        self.assertEqual(result.returncode, exit_code, result.stderr)
        found = json.loads(result.stdout)
        jsonschema.validate(found, SCHEMA)
        return found

    def message(self, found: dict, name: str) -> dict:
        return next(one for one in found["messages"] if one["name"] == name)

    def events(self, found: dict, kind: str) -> list[dict]:
        return [one for one in found["events"] if one["kind"] == kind]


class Examples(Simulation):
    """No response is later than its bound, and no value is lost."""

    def check(self, name: str, **counts: int) -> dict:
        found = self.simulate(EXAMPLES / f"{name}.json", "--for", "10s")
        self.assertEqual(found["problems"], [])
        seen = [one for one in found["messages"] if one["count"] != 0]
        self.assertGreater(len(seen), 10)
        for one in seen:
            self.assertLessEqual(one["worst_us"], one["bound_us"], one["name"])
        self.assertLessEqual(found["load"]["seen"], found["load"]["computed_max"])
        self.assertEqual({one["state"] for one in found["nodes"]}, {"operational"})
        for message, count in counts.items():
            name = message.replace("__", " ")
            self.assertAlmostEqual(self.message(found, name)["count"], count, delta=1, msg=name)
        return found

    @unittest.skipIf(SAMPLE, "a sample")
    def test_four_modules(self) -> None:
        found = self.check("four_modules", digital_inputs__heartbeat=20, controller__heartbeat=20)
        # "every_ms": 50 and 100
        self.assertAlmostEqual(self.message(found, "digital_inputs TPDO 1")["count"], 200, delta=2)
        self.assertAlmostEqual(self.message(found, "controller TPDO 2")["count"], 100, delta=2)

    def test_twelve_axes(self) -> None:
        found = self.check("twelve_axes", axis7__heartbeat=100)
        syncs = 10_000_000 / 9000
        self.assertAlmostEqual(self.message(found, "controller SYNC")["count"], syncs, delta=2)
        for axis in range(1, 13):
            self.assertAlmostEqual(self.message(found, f"axis{axis} TPDO 2")["count"], syncs, delta=2)
            self.assertAlmostEqual(self.message(found, f"controller TPDO {axis}")["count"], syncs, delta=2)

    @unittest.skipIf(SAMPLE, "a sample")
    def test_eight_devices(self) -> None:
        self.check("eight_devices")


class Faults(Simulation):
    def test_a_lost_node_is_noticed_after_its_heartbeat_time(self) -> None:
        path = self.write(PLANT)
        found = self.simulate(path, "--for", "5s", "--fault", "lost:inputs@2s")
        (lost,) = self.events(found, "heartbeat_lost")
        self.assertEqual((lost["node"], lost["other"]), ("control", "inputs"))
        # The last heartbeat was sent up to 200 ms before 2 s; the time in the consumer is longer than that of the producer.
        self.assertGreater(lost["time_us"], 2_000_000)
        self.assertLess(lost["time_us"], 3_000_000)
        self.assertEqual([one["state"] for one in found["nodes"]], ["operational", "lost", "operational"])
        self.assertAlmostEqual(self.message(found, "inputs heartbeat")["count"], 10, delta=1)
        self.assertEqual(found["faults"], ["lost:inputs@2s"])

    def test_a_loss_that_no_node_detects_is_a_problem(self) -> None:
        """"others" has no heartbeat; the nodes do not monitor the master."""
        plant = json.loads(json.dumps(PLANT))
        plant["nodes"]["others"]["heartbeat_ms"] = 0
        path = self.write(plant)
        for lost, others in (("others", "inputs"), ("control", "others")):
            found = self.simulate(path, "--for", "3s", "--fault", f"lost:{lost}@1s", "--fault", f"lost:{others}@1s", exit_code=FAILED)
            self.assertIn(f"no node detects that {lost} is lost", found["problems"])
            self.assertEqual(len(found["problems"]), 2 if others == "others" else 1)

    def test_errors_destroy_frames_which_are_sent_again(self) -> None:
        path = self.write(PLANT)
        quiet = self.simulate(path, "--for", "5s")
        found = self.simulate(path, "--for", "5s", "--fault", "errors:1/10ms")
        self.assertEqual(quiet["errors"], 0)
        # Of 500 errors, those that meet a frame; the master's SDO requests have the same phase.
        self.assertGreater(found["errors"], 500 * quiet["load"]["seen"] / 100)
        self.assertLessEqual(found["errors"], 500)
        self.assertEqual(found["problems"], [])
        for before, after in zip(quiet["messages"], found["messages"], strict=True):
            self.assertAlmostEqual(before["count"], after["count"], delta=2, msg=before["name"])
            if after["count"] != 0:
                self.assertLessEqual(after["worst_us"], after["bound_us"])
                self.assertGreater(after["bound_us"], before["bound_us"])

    def test_a_babbling_node_takes_the_bus(self) -> None:
        path = self.write(PLANT)
        found = self.simulate(path, "--for", "5s", "--fault", "babbling:inputs@1s")
        self.assertGreater(found["load"]["busiest_second"], 99.5)
        self.assertEqual(found["nodes"][1], {"name": "inputs", "node_id": 2, "state": "babbling"})
        self.assertIn("others", {one["other"] for one in self.events(found, "heartbeat_lost")})

    def test_the_same_seed_has_the_same_result(self) -> None:
        path = self.write(PLANT)
        first = self.simulate(path, "--for", "2s", "--seed", "7")
        self.assertEqual(first, self.simulate(path, "--for", "2s", "--seed", "7"))
        self.assertNotEqual(first["messages"], self.simulate(path, "--for", "2s", "--seed", "8")["messages"])

    def test_text(self) -> None:
        path = self.write(PLANT)
        result = self.run_edsc(path, "--for", "2s", "--fault", "lost:others@1s", "-o", str(self.program_of(path)))
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))
        self.assertRegex(result.stdout, r"^3 nodes for 2\.000 s at 125 kbit/s: \d+ frames\nload \d+\.\d %")
        self.assertRegex(result.stdout, r"\n182h +inputs TPDO 1 +\d+ ")
        self.assertIn("\nfault lost:others@1s\n", result.stdout)
        self.assertRegex(result.stdout, r"\n1\.\d{3} s: control misses others\n")
        self.assertTrue(result.stdout.endswith("\nothers is lost at the end\n2 of 3 nodes Operational at the end\n"), result.stdout)


class Usage(Simulation):
    def expect_refusal(self, path: Path, *arguments: str, error: str, exit_code: int = WRONG_USAGE, **more: str) -> None:
        result = self.run_edsc(path, *arguments, **more)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, error)

    def test_faults_that_do_not_exist(self) -> None:
        path = self.write(PLANT)
        for fault, error in (("lost:inputs", "expected lost:NODE@TIME"), ("lost:input@1s", 'did you mean "?inputs'),
                             ("melted:inputs@1s", "lost.*babbling.*errors"), ("errors:0/1s", "expected errors:COUNT/TIME"),
                             ("errors:9/1ms", "at least 1000 us apart"), ("lost:inputs@2h", "later than the end of the run")):
            with self.subTest(fault):
                self.expect_refusal(path, "--fault", fault, error=error)
        self.expect_refusal(path, "--for", "soon", error="such as 10ms, 3s, 1m or 1h")

    def test_a_network_with_errors_is_not_simulated(self) -> None:
        plant = json.loads(json.dumps(PLANT))
        plant["nodes"]["others"]["node_id"] = 2
        self.expect_refusal(self.write(plant), error=r"plant\.json:1:\d+: error: .*node-ID 2", exit_code=1)
        del plant["bit_rate"]
        plant["nodes"]["others"]["node_id"] = 3
        self.assertNotEqual(self.run_edsc(self.write(plant)).returncode, FINE)

    def test_a_compiler_that_fails(self) -> None:
        path = self.write(PLANT)
        self.expect_refusal(path, error="cannot start the C\\+\\+ compiler no-such-compiler; install one, or set CXX",
                            compiler="no-such-compiler")
        self.expect_refusal(path, error="false has failed", compiler="false")
        self.assertEqual(list(self.folder.glob("edsc-simulation-*")), [])

    def test_objects_are_used_again(self) -> None:
        """The folder of `-o` has one object for each source; only those of the file that has changed are compiled again."""
        path = self.write(PLANT)
        arguments = ("--for", "100ms", "-o", "program")
        self.assertEqual(self.run_edsc(path, *arguments).returncode, FINE)
        objects = {one.name: one.stat().st_mtime_ns for one in (self.folder / "program").rglob("*.o")}
        self.assertGreater(len(objects), 2)

        def changed() -> set[str]:
            result = self.run_edsc(path, *arguments)
            self.assertEqual(result.returncode, FINE, result.stderr)
            return {one.name for one in (self.folder / "program").rglob("*.o") if one.stat().st_mtime_ns != objects[one.name]}

        self.assertEqual(changed(), set())
        source = next((self.folder / "program").rglob("simulate.cpp"))
        source.write_text(source.read_text() + "// changed\n")
        self.assertEqual(changed(), {"simulate.o"})
        objects = {one.name: one.stat().st_mtime_ns for one in (self.folder / "program").rglob("*.o")}
        next((self.folder / "program").rglob("simulate.o.command")).unlink()  # as after an interrupted compiler
        self.assertEqual(changed(), {"simulate.o"})

    def test_the_program_remains_in_the_named_folder(self) -> None:
        path = self.write(PLANT)
        self.simulate(path, "--for", "1s")
        program = self.program_of(path) / "simulate"
        lines = subprocess.run([program, "1000000", "1"], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertEqual(lines[-1], "end")
        self.assertTrue(any(re.match(r"message \d+ 50 ", line) for line in lines), lines)  # every 20 ms for 1 s


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])

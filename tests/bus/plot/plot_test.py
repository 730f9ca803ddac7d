#!/usr/bin/env python3
"""edsc plot: values are at the positions that the ticks of the axes state, in logs of several formats.

    plot_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
AXIS = SOURCE_DIR / "tests/bus/decode/axis.dcf"
SVG = "{http://www.w3.org/2000/svg}"
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2
PATH = re.compile(r"([MLHVh])(-?[\d.]+)(?: (-?[\d.]+))?")
PIXEL = 0.02  # coordinates have two decimals


def edsc(*arguments: str, log: str = "", node: tuple[str, ...] = ("--node", str(AXIS))) -> subprocess.CompletedProcess[str]:
    return subprocess.run([EDSC, "plot", "-", *arguments, *node], input=log, capture_output=True, text=True, timeout=600, check=False)


def points(path: str) -> list[tuple[float, float]]:
    """The corners of a path of absolute commands."""
    x = y = 0.0
    result = []
    for command, first, second in PATH.findall(path):
        if command in "ML":
            x, y = float(first), float(second)
        elif command == "H":
            x = float(first)
        elif command == "V":
            y = float(first)
        else:
            continue  # h0
        result.append((x, y))
    return result


class Axis:
    """A linear scale, by two of its ticks: pixel and label."""

    def __init__(self, ticks: list[tuple[float, str]]) -> None:
        (self.pixel, first), (last_pixel, last) = ticks[0], ticks[-1]
        self.value = float(first)
        self.scale = (last_pixel - self.pixel) / (float(last) - self.value)
        for pixel, label in ticks:
            assert abs(self.at(float(label)) - pixel) < PIXEL, ticks

    def at(self, value: float) -> float:
        return self.pixel + (value - self.value) * self.scale


class Picture:
    def __init__(self, text: str) -> None:
        self.root = ET.fromstring(text)
        axis = self.root.find(f"{SVG}g[@class='time-axis']")
        self.time = Axis([(float(text.get("x")), text.text) for text in axis.iter(f"{SVG}text")])
        self.panels = self.root.findall(f"{SVG}g[@class='panel']")

    def values(self, panel: int) -> Axis:
        grid = [float(line.get("y1")) for line in self.panels[panel].iter(f"{SVG}line") if line.get("class") == "grid value"]
        labels = [text.text for text in self.panels[panel].iter(f"{SVG}text") if text.get("text-anchor") == "end"]
        return Axis(list(zip(grid, labels, strict=True)))

    def paths(self, panel: int) -> list[list[tuple[float, float]]]:
        return [points(path.get("d")) for path in self.panels[panel].iter(f"{SVG}path")]

    def legend(self, panel: int) -> list[str]:
        return [text.text for text in self.panels[panel].iter(f"{SVG}text") if text.get("text-anchor") == "start"]


def position(value: int) -> str:
    """TPDO 1: statusword and position."""
    return "186#3702" + value.to_bytes(4, "little", signed=True).hex()


DRIVE = SOURCE_DIR / "eds/ezd-1136.eds"
WRITE_HEARTBEAT, WRITTEN_HEARTBEAT = "601#2B17100064000000", "581#6017100000000000"


def heartbeats(*ends: int) -> list[tuple[float, str]]:
    """Every 100 ms to the first end; then from each second number to the next, in tenths of a second."""
    spans = [(1, ends[0]), *zip(ends[1::2], ends[2::2], strict=True)]
    return [(i / 10, "701#05") for first, last in spans for i in range(first, last + 1)]


def values(time: float, position: int) -> list[tuple[float, str]]:
    """The position, read by SDO, and the mode in TPDO 1."""
    return [(time, "601#4064600000000000"), (time, f"581#43646000{position.to_bytes(4, 'little').hex()}"), (time, "181#0000000001")]


def text_of(log: list[tuple[float, str]]) -> str:
    return "".join(f"({time}) can0 {frame}\n" for time, frame in sorted(log, key=lambda one: one[0]))


class Plot(unittest.TestCase):
    def assert_points(self, picture: Picture, panel: int, found: list[tuple[float, float]], wanted: list[tuple[float, float]]) -> None:
        values = picture.values(panel)
        self.assertEqual(len(found), len(wanted), found)
        for (x, y), (time, value) in zip(found, wanted, strict=True):
            self.assertAlmostEqual(x, picture.time.at(time), delta=PIXEL)
            self.assertAlmostEqual(y, values.at(value), delta=PIXEL)

    def test_values_with_a_unit_are_connected(self) -> None:
        log = "".join(f"({time}) can0 {position(value)}\n" for time, value in ((1.0, 0), (2.5, 1000), (4.0, -500), (11.0, 200)))
        result = edsc("6064h", log=log)
        self.assertEqual(result.returncode, FINE, result.stderr)
        picture = Picture(result.stdout)
        self.assertEqual(picture.legend(0), ["node 6 axis-y Position actual value 6064h:00 in inc"])
        self.assert_points(picture, 0, picture.paths(0)[0], [(1.0, 0), (2.5, 1000), (4.0, -500), (11.0, 200)])

    def test_times_that_go_back(self) -> None:
        """After a step of more than 100 ms the plot continues; a shorter one counts as the same time."""
        log = "".join(f"({time}) can0 {position(value)}\n"
                      for time, value in ((100.0, 0), (102.0, 1000), (101.95, 900), (103.0, 500), (50.0, -500), (57.0, 200)))
        result = edsc("6064h", log=log)
        self.assertEqual(result.returncode, FINE)
        self.assertEqual(result.stderr, "<stdin>:5: the times go back by 53.000 s; the plot continues without a gap\n")
        picture = Picture(result.stdout)
        self.assert_points(picture, 0, picture.paths(0)[0], [(100, 0), (102, 1000), (102, 900), (103, 500), (103, -500), (110, 200)])

    def test_values_without_a_unit_are_steps(self) -> None:
        """TPDO 2 has the BOOLEAN Ready in bit 0, and the INTEGER8 Step in bits 4..7: Ah is -6."""
        log = "".join(f"({time}) can0 286#{bits:02X}FFFFFF00002040\n" for time, bits in ((0.0, 0xA3), (3.0, 0x02), (10.0, 0x43)))
        picture = Picture(edsc("2003h", "2005h", "2007h", log=log).stdout)
        self.assertEqual(len(picture.panels), 3)
        self.assert_points(picture, 0, picture.paths(0)[0], [(0, 1), (3, 1), (3, 0), (10, 0), (10, 1)])
        self.assert_points(picture, 1, picture.paths(1)[0], [(0, -6), (3, -6), (3, 0), (10, 0), (10, 4)])
        self.assert_points(picture, 2, picture.paths(2)[0], [(0, 2.5), (3, 2.5), (10, 2.5)])  # REAL32

    def test_masked_values_are_bands_of_states(self) -> None:
        """0627h operation_enabled from 0 to 6 s, 0008h fault to 8 s, 004Fh none, then 0040h switch_on_disabled."""
        words = ((0.0, 0x0627), (3.0, 0x0227), (6.0, 0x0008), (8.0, 0x004F), (9.0, 0x0040))
        log = "".join(f"({time}) can0 186#{word.to_bytes(2, 'little').hex()}00000000\n" for time, word in words)
        log += "(10.0) can0 705#05\n"  # the last state remains to the end of the log
        result = edsc("6041h", log=log)
        self.assertEqual(result.returncode, FINE, result.stderr)
        picture = Picture(result.stdout)
        (band,) = picture.root.findall(f"{SVG}g[@class='band']")
        self.assertEqual(band.find(f"{SVG}text").text, "node 6 axis-y Statusword 6041h:00 state")
        states = [(rect.find(f"{SVG}title").text, float(rect.get("x")), float(rect.get("x")) + float(rect.get("width")))
                  for rect in band.iter(f"{SVG}rect")]
        self.assertEqual([name for name, *_ in states], ["operation_enabled", "fault", "none", "switch_on_disabled"])
        for (_, left, right), (begin, end) in zip(states, ((0, 6), (6, 8), (8, 9), (9, 10)), strict=True):
            self.assertAlmostEqual(left, picture.time.at(begin), delta=PIXEL)
            self.assertAlmostEqual(right, picture.time.at(end), delta=PIXEL)
        self.assertEqual(len({rect.get("class") for rect in band.iter(f"{SVG}rect")}), 4)
        self.assertIn("operation_enabled", [text.text for text in band.iter(f"{SVG}text")])

    def test_states_without_room_for_their_names_are_in_a_legend(self) -> None:
        """operation_enabled to 9 s, then three states of 0.1 s; the last one occurs again for 0.9 s, which has room for 8 letters."""
        words = ((0.0, 0x0627), (9.0, 0x000F), (9.1, 0x0040), (9.2, 0x0008), (9.3, 0x0040), (9.4, 0x0008))
        log = "".join(f"({time}) can0 186#{word.to_bytes(2, 'little').hex()}00000000\n" for time, word in words)
        log += "(10.3) can0 705#05\n"
        picture = Picture(edsc("6041h", "6064h", log=log).stdout)
        (band,) = picture.root.findall(f"{SVG}g[@class='band']")
        styles = {rect.find(f"{SVG}title").text: rect.get("class") for rect in band.iter(f"{SVG}rect")}
        self.assertEqual(len(set(styles.values())), 4)
        marks = list(band.iter(f"{SVG}circle"))
        below = [text for text in band.iter(f"{SVG}text") if float(text.get("y")) > max(
            float(rect.get("y")) + float(rect.get("height")) for rect in band.iter(f"{SVG}rect"))]
        self.assertEqual([text.text for text in below], ["fault_reaction_active", "switch_on_disabled"])
        self.assertEqual([mark.get("class") for mark in marks], [styles[text.text] for text in below])
        self.assertEqual([text.text for text in band.iter(f"{SVG}text")][1:3], ["operation_enabled", "fault"])
        frame = next(rect for rect in picture.panels[0].iter(f"{SVG}rect") if rect.get("class") == "frame")
        self.assertGreater(float(frame.get("y")), max(float(text.get("y")) for text in below))

    def test_a_lost_node_has_a_gap(self) -> None:
        """Heartbeats every 100 ms, as 1017h was written, and nothing from 1 s to the boot-up message at 3 s: twice the heartbeat
        time after the last frame, or the time of 1016h of the master, the values are not known."""
        log = heartbeats(10, 31, 50) + [(3.0, "701#00")] + values(0.5, 100) + values(0.9, 200) + values(4.0, 300)
        drive = {"node_id": 1, "eds": str(DRIVE), "heartbeat_ms": 100}
        master = {"node_id": 127, "master": True}
        with tempfile.TemporaryDirectory() as folder:
            plant, slow = Path(folder) / "plant.json", Path(folder) / "slow.json"
            plant.write_text(json.dumps({"bit_rate": 500, "nodes": {"plc": master, "drive": drive}}))
            slow.write_text(json.dumps({"bit_rate": 500, "nodes": {"plc": master, "drive": {**drive, "heartbeat_timeout_ms": 700}}}))
            for node, objects, lost in ((("--node", f"1={DRIVE}"), ("1/6064h", "6061h"), 1.2),
                                        (("--network", str(plant)), ("drive/6064h", "drive/6061h"), 1.2),
                                        (("--network", str(slow)), ("drive/position_actual_value", "6061h"), 1.7)):
                result = edsc(*objects, log=text_of([(0.0, WRITE_HEARTBEAT), (0.01, WRITTEN_HEARTBEAT), *log]), node=node)
                self.assertEqual(result.returncode, FINE, result.stderr)
                picture = Picture(result.stdout)
                self.assert_points(picture, 0, picture.paths(0)[0],
                                   [(0.5, 100), (0.9, 200), (lost, 200), (4.0, 300), (5.0, 300)])
                self.assertEqual(next(picture.panels[0].iter(f"{SVG}path")).get("d").count("M"), 2)
                self.assert_band(picture, [(0.5, lost), (4.0, 5.0)])

    def test_a_node_that_is_lost_at_the_end(self) -> None:
        log = [(0.0, WRITE_HEARTBEAT), (0.01, WRITTEN_HEARTBEAT), *heartbeats(10), *values(0.5, 100), (5.0, "702#05")]
        picture = Picture(edsc("6061h", log=text_of(log), node=("--node", f"1={DRIVE}")).stdout)
        self.assert_band(picture, [(0.5, 1.2)])

    def test_a_node_without_a_known_time_has_no_gap(self) -> None:
        log = [*heartbeats(10), *values(0.5, 100), *values(4.0, 300), (5.0, "702#05")]
        picture = Picture(edsc("6061h", log=text_of(log), node=("--node", f"1={DRIVE}")).stdout)
        self.assert_band(picture, [(0.5, 5.0)])

    def test_an_event_timer_of_a_node_without_a_heartbeat(self) -> None:
        """1800h:05 is written as 100 ms. A node that is set to Pre-operational sends no PDOs, and is not lost."""
        log = [(0.0, "601#2B00180564000000"), (0.01, "581#6000180500000000"),
               *((i / 10, "181#0000000001") for i in range(1, 11)), (4.0, "181#0000000001"), (5.0, "702#05")]
        picture = Picture(edsc("6061h", log=text_of(log), node=("--node", f"1={DRIVE}")).stdout)
        self.assert_band(picture, [(0.1, 1.2), (4.0, 4.2)])
        for command, stops in (("80", True), ("01", False)):
            sent = [*log, (1.05, f"000#{command}01"), (4.01, f"000#{command}00")]
            picture = Picture(edsc("6061h", log=text_of(sent), node=("--node", f"1={DRIVE}")).stdout)
            self.assert_band(picture, [(0.1, 5.0)] if stops else [(0.1, 1.2), (4.0, 4.2)])

    def assert_band(self, picture: Picture, wanted: list[tuple[float, float]]) -> None:
        (band,) = picture.root.findall(f"{SVG}g[@class='band']")
        found = [(float(rect.get("x")), float(rect.get("x")) + float(rect.get("width"))) for rect in band.iter(f"{SVG}rect")]
        self.assertEqual(len(found), len(wanted), found)
        for (left, right), (begin, end) in zip(found, wanted, strict=True):
            self.assertAlmostEqual(left, picture.time.at(begin), delta=PIXEL)
            self.assertAlmostEqual(right, picture.time.at(end), delta=PIXEL)

    def test_named_values_are_bands_of_two_nodes(self) -> None:
        """The mode of two drives, 1 profile_position and 3 profile_velocity; 9 has no name in the manual."""
        drive = SOURCE_DIR / "eds/ezd-1136.eds"
        log = "(0.0) can0 181#0000000001\n(0.0) can0 182#0000000003\n(5.0) can0 181#0000000003\n(9.0) can0 181#0000000009\n"
        picture = Picture(edsc("6061h", log=log, node=("--node", f"1={drive}", "--node", f"2={drive}")).stdout)
        bands = [[title.text for title in band.iter(f"{SVG}title")] for band in picture.root.findall(f"{SVG}g[@class='band']")]
        self.assertEqual(bands, [["profile_position", "profile_velocity", "9"], ["profile_velocity"]])

    def test_physical_values(self) -> None:
        """3011h:05 of 002 is in 0.01 A."""
        drive = SOURCE_DIR / "eds/cpd.eds"
        log = "".join(f"({time}.0) can0 602#4011300500000000\n({time}.5) can0 582#4B113005{raw.to_bytes(2, 'little').hex()}0000\n"
                      for time, raw in ((1, 0), (5, 150)))
        result = edsc("3011h:05", log=log, node=("--node", f"2={drive}"))
        self.assertEqual(result.returncode, FINE, result.stderr)
        picture = Picture(result.stdout)
        self.assertTrue(picture.legend(0)[0].endswith(" in A"), picture.legend(0))
        self.assert_points(picture, 0, picture.paths(0)[0], [(1.5, 0), (5.5, 1.5)])

    def test_sdo_values_count_when_the_transfer_has_ended(self) -> None:
        log = ("(1.0) can0 606#4064600000000000\n(1.5) can0 586#4364600010270000\n"  # 10,000 at 1.5 s
               "(2.0) can0 606#2364600020000000\n(2.5) can0 586#8064600000000106\n"  # aborted
               "(9.0) can0 606#4064600000000000\n(9.5) can0 586#4364600000000000\n")
        picture = Picture(edsc("position_actual_value", log=log).stdout)
        self.assert_points(picture, 0, picture.paths(0)[0], [(1.5, 10_000), (9.5, 0)])

    def test_two_nodes_and_times_of_day(self) -> None:
        """The same unit: one panel; the last value remains to the end of the log. The axis begins at the first frame: 2015-07-10
        08:17:32.25 UTC is 1436516252.25."""
        log = (f"(1436516252.250000) can0 {position(5)}\n(1436516253.250000) can0 {position(7).replace('186', '187')}\n"
               f"(1436516262.250000) can0 {position(6)}\n")
        node = ("--node", str(AXIS), "--node", f"7={AXIS}")
        picture = Picture(edsc("axis-y/6064h", "7/6064h", "--title", "Two <axes> & more", log=log, node=node).stdout)
        self.assertEqual(picture.root.find(f"{SVG}title").text, "Two <axes> & more")
        self.assertEqual(len(picture.panels), 1)
        self.assertEqual(len(picture.legend(0)), 2)
        self.assert_points(picture, 0, picture.paths(0)[0], [(0, 5), (10, 6)])
        self.assert_points(picture, 0, picture.paths(0)[1], [(1, 7), (10, 7)])
        texts = [text.text for text in picture.root.iter(f"{SVG}text")]
        self.assertIn("time in s since 2015-07-10 08:17:32.250000 UTC", texts)

    def test_a_light_and_a_dark_background(self) -> None:
        style = Picture(edsc("6064h", log=f"(1.0) can0 {position(5)}\n").stdout).root.find(f"{SVG}style").text
        light, dark = style.split("@media (prefers-color-scheme: dark)")
        for rule in (".background", "text", ".grid", ".c0"):
            self.assertIn(f"{rule} {{", light)
            self.assertIn(f"{rule} {{", dark)

    def test_a_single_value_is_a_dot(self) -> None:
        picture = Picture(edsc("6064h", log=f"(1.0) can0 {position(5)}\n").stdout)
        self.assertTrue(next(picture.panels[0].iter(f"{SVG}path")).get("d").endswith("h0"))

    def test_a_peak_of_many_values_remains(self) -> None:
        """400,000 values of 0, two peaks: a small picture, with the peaks at their place, in little memory."""
        count, peaks = 400_000, {123_456: 5000, 300_001: -3000}
        with tempfile.TemporaryDirectory() as folder:
            log, output = Path(folder) / "log", Path(folder) / "plot.svg"
            with log.open("w") as file:
                for i in range(count):
                    file.write(f"({i // 1000}.{i % 1000:03}) can0 {position(peaks.get(i, 0))}\n")
            subprocess.run([EDSC, "plot", log, "6064h", "--node", AXIS, "-o", output], check=True, timeout=600)
            self.assertLess(output.stat().st_size, 100_000)
            picture = Picture(output.read_text())
        values, path = picture.values(0), picture.paths(0)[0]
        for place, value in peaks.items():
            extreme = min(path, key=lambda point, value=value: abs(point[1] - values.at(value)))
            self.assertAlmostEqual(extreme[1], values.at(value), delta=PIXEL)
            self.assertAlmostEqual(extreme[0], picture.time.at(place / 1000), delta=1.1)
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, 200 * 1024)  # KiB

    def test_other_formats(self) -> None:
        asc = "base hex  timestamps absolute\n0.0 1 186 Rx d 6 37 02 05 00 00 00\n8.0 1 186 Rx d 6 37 02 07 00 00 00\n"
        trc = ";$FILEVERSION=1.1\n 1) 0.0 Rx 0186 6 37 02 05 00 00 00\n 2) 8000.0 Rx 0186 6 37 02 07 00 00 00\n"
        for log in (asc, trc):
            picture = Picture(edsc("6064h", log=log).stdout)
            self.assert_points(picture, 0, picture.paths(0)[0], [(0, 5), (8, 7)])

    def test_what_cannot_be_plotted(self) -> None:
        log = f"(1.0) can0 {position(5)}\n"
        for arguments, code, words in (
                (("6064h",), WRONG_USAGE, "--node ID=FILE or --network FILE is missing"),
                (("1008h", "--node", str(AXIS)), WRONG_USAGE, "the values are not numbers"),
                (("5/6064h", "--node", str(AXIS)), WRONG_USAGE, "node 5 is not one of --node"),
                (("axis-x/6064h", "--node", str(AXIS)), WRONG_USAGE,
                 '"axis-x" is not the name of a node; did you mean "axis-y"?'),
                (("6064h", "6064h", "--node", str(AXIS)), WRONG_USAGE, "given twice"),
                (("no_such_object", "--node", str(AXIS)), WRONG_USAGE, "no_such_object"),
                (("2003h", "--node", str(AXIS)), INPUT_HAS_ERRORS, "has no values")):
            with self.subTest(arguments=arguments):
                result = edsc(*arguments, log=log, node=())
                self.assertEqual(result.returncode, code, result.stderr)
                self.assertIn(words, result.stderr)
                self.assertEqual(result.stdout, "")
        self.assertIn("the frames have no times", edsc("6064h", log=f"{position(5)}\n").stderr)
        self.assertIn("the log has no frames", edsc("6064h").stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])

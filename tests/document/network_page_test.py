#!/usr/bin/env python3
"""The page of a network in headless Chromium, compared with links and times worked out by hand.

    network_page_test.py SOURCE_DIR EDSC WORK_DIR [--sample] [unittest arguments]

npm installs puppeteer-core and axe-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import shutil
import subprocess

from document_case import SOURCE_DIR, DocumentCase, main, sampled

NETWORKS = sorted((SOURCE_DIR / "examples/networks").glob("*.json"))
PLANT = """{
  "bit_rate": 500, "length_m": 40,
  "sync": {"producer": "master", "period_us": 10000},
  "nodes": {
    "master": {"node_id": 127, "master": true, "heartbeat_ms": 100},
    "a": {"node_id": 1, "eds": "node.eds", "heartbeat_ms": 50},
    "b": {"node_id": 2, "eds": "node.eds", "heartbeat_ms": 50}
  },
  "signals": [
    {"from": "a", "object": "position", "to": ["b.target_position", "master"], "every_ms": 10},
    {"from": "a", "object": "speed", "to": ["b.target_speed", "master"], "every_ms": 10},
    {"from": "master", "object": "a.target_position", "every_sync": 1}
  ]
}
"""


class NetworkPage(DocumentCase):
    def plant(self) -> object:
        shutil.copy(SOURCE_DIR / "tests/generator/network/node.eds", self.folder)
        return self.document(self.write("plant.json", PLANT))

    def test_the_pages_are_clean_in_light_and_dark(self) -> None:
        self.assert_clean(self.browse("audit-expanded", *(self.document(path) for path in sampled(NETWORKS))))

    def test_tidy_reads_the_html_without_errors(self) -> None:
        if shutil.which("tidy") is None:
            self.skipTest("tidy is not installed")
        for path in NETWORKS:
            tidy = subprocess.run(["tidy", "-q", "-e", "--drop-empty-elements", "no", self.document(path)],
                                  capture_output=True, text=True)
            self.assertEqual((tidy.stderr, tidy.returncode), ("", 0), path.name)

    def test_who_sends_what_to_whom(self) -> None:
        found = self.browse("texts", self.plant(), "#links tbody td:nth-child(1)", "#links tbody td:nth-child(2)",
                            "#links tbody td:nth-child(3)", "#links tbody td:nth-child(4)", "#links svg g polygon",
                            "#links svg g circle", "#nodes tbody td:nth-child(2)")
        self.assertEqual(found["#nodes tbody td:nth-child(2)"], ["master", "a", "b"])
        # SYNC to both nodes, a's TPDO 1 to b and the master, the master's TPDO 1 to a; an arrow for each receiver.
        self.assertEqual(found["#links tbody td:nth-child(1)"], ["080h", "181h", "201h"])
        self.assertEqual(found["#links tbody td:nth-child(2)"], ["master SYNC", "a TPDO 1", "master TPDO 1"])
        self.assertEqual(found["#links tbody td:nth-child(3)"], ["a, b", "master RPDO 1, b RPDO 1", "a RPDO 1"])
        self.assertEqual(found["#links tbody td:nth-child(4)"], ["", "event-driven (device profile)", "every SYNC"])
        self.assertEqual((len(found["#links svg g circle"]), len(found["#links svg g polygon"])), (3, 5))

    def test_messages_without_a_receiver_are_folded(self) -> None:
        page = self.document(SOURCE_DIR / "examples/networks/eight_devices.json")
        found = self.browse("texts", page, "#links > .scroll tbody td:first-child", "#unreceived summary",
                            "#unreceived tbody td:first-child", "#links > .scroll tbody td:last-child")
        self.assertEqual(found["#links > .scroll tbody td:first-child"], ["182h", "188h", "201h", "284h", "287h", "303h"])
        self.assertEqual(found["#unreceived summary"], ["22 messages without a receiver"])
        self.assertEqual(len(found["#unreceived tbody td:first-child"]), 22)
        self.assertEqual(found["#links > .scroll tbody td:last-child"][0],
                         "Read input 8-bit: Digital inputs 0 to 7, Digital inputs 8 to 15")

    def test_missed_deadlines_are_counted_and_coloured(self) -> None:
        page = self.document(SOURCE_DIR / "examples/networks/eight_devices.json")
        found = self.browse("texts", page, "#messages-title .missed", "#messages tr.missed td:nth-child(2)",
                            "#messages tr.missed td:last-child")
        self.assertEqual(found["#messages-title .missed"], ["2 deadlines not met"])
        self.assertEqual(found["#messages tr.missed td:nth-child(2)"], ["SDO responses", "SDO requests"])
        self.assertEqual(found["#messages tr.missed td:last-child"], ["no", "no"])

    def test_times_of_the_frames(self) -> None:
        found = self.browse("texts", self.plant(), "#messages tbody td:nth-child(2)", "#messages tbody td:nth-child(3)",
                            "#messages tbody td:nth-child(5)", "#messages-title", "#sync svg g title", "#sync-title")
        frames = dict(zip(found["#messages tbody td:nth-child(2)"],
                          zip(found["#messages tbody td:nth-child(3)"], found["#messages tbody td:nth-child(5)"])))
        # Davis et al. 2007: 55 + 10 s bits with all stuff bits, 2 us each: s = 0, 6 (32 + 16 bits), 4 (32 bits), 1.
        self.assertEqual(frames["master SYNC"], ("0", "0.110 ms"))
        self.assertEqual(frames["a TPDO 1"], ("6", "0.230 ms"))
        self.assertEqual(frames["master TPDO 1"], ("4", "0.190 ms"))
        self.assertEqual(frames["a heartbeat"], ("1", "0.130 ms"))
        self.assertEqual([title.split(":")[0] for title in found["#sync svg g title"]], ["master SYNC", "master TPDO 1"])
        self.assertIn("10.000 ms", found["#sync-title"][0])

    def test_a_page_for_each_node(self) -> None:
        self.write("plant #1.json", PLANT.replace('"a"', '"\u00e4xis 1"').replace('"a.', '"\u00e4xis 1.'))
        self.plant()
        network = self.document(self.folder / "plant #1.json", "--node-pages")
        pages = [self.folder / f"plant #1-{name}.html" for name in ("master", "\u00e4xis 1", "b")]
        self.assert_clean(self.browse("audit-expanded", network, *pages))
        reached = self.browse("follow", network, "#nodes tbody a")
        self.assertEqual(reached, ["master", "\u00e4xis 1", "b"])
        self.assertEqual(self.browse("follow", pages[1], ".lead a"), ["plant #1.json"])
        # heartbeat_ms; RPDO 1 carries the signal of the master, every SYNC; TPDO 1 those of the node, every 10 ms.
        self.assertEqual(self.browse("check", pages[1], "#changed")["objects"], ["1017h", "1400h", "1600h", "1800h", "1A00h"])

    def test_markdown_of_each_node(self) -> None:
        self.plant()
        self.edsc("document", "plant.json", "--node-pages", "-o", "plant.md")
        self.assertIn("(plant-a.md)", (self.folder / "plant.md").read_text().replace("\\", ""))
        self.assertIn("[plant.json](plant.md)", (self.folder / "plant-a.md").read_text().replace("\\", ""))

    def test_pages_of_nodes_are_for_networks_in_files(self) -> None:
        self.plant()
        self.assertIn("is for networks", self.edsc("document", "node.eds", "--node-pages", "-o", "a.html", exit_code=2).stderr)
        self.assertIn("--output", self.edsc("document", "plant.json", "--node-pages", exit_code=2).stderr)

    def test_options_for_devices_are_errors(self) -> None:
        self.plant()
        for option in (("--against", "old.json"), ("--node-id", "5")):
            result = self.edsc("document", "plant.json", *option, exit_code=2)
            self.assertIn("is for devices, not for networks", result.stderr)

    def test_rows_are_low_on_a_phone(self) -> None:
        """A table is wider than the screen and scrolls, rather than having a word in each line."""
        for path in NETWORKS:
            self.assertLess(max(self.browse("lines", self.document(path))), 6, path.name)

    def test_title_author_date_and_logo(self) -> None:
        self.plant()
        logo = '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="40" height="20" fill="#08c"/></svg>'
        self.write("logo.svg", logo)
        head = ("--title", "Line <3> & more", "--author", "A. Mason", "--date", "2026-11-28", "--logo", "logo.svg", "--without-findings")
        for name, source in (("plant.html", "plant.json"), ("device.html", "node.eds")):
            self.edsc("document", source, *head, "-o", name)
            page = self.folder / name
            self.assert_clean(self.browse("audit-expanded", page))
            found = self.browse("texts", page, "h1", ".lead", "#findings", "title")
            self.assertEqual(found["h1"], ["Line <3> & more"])
            self.assertEqual(found[".lead"][-1], "A. Mason, 2026-11-28")
            self.assertEqual(found["#findings"], [])
            self.assertTrue(found["title"][0].startswith("Line <3> & more, CANopen "))
            shown = self.browse("pictures", page)
            self.assertEqual(shown, [{"class": "logo", "width": 40, "height": 20}])
        self.edsc("document", "plant.json", *head, "-o", "plant.md")
        text = (self.folder / "plant.md").read_text()
        self.assertIn("A. Mason, 2026-11-28\n", text)
        self.assertNotIn("Findings", text)
        self.assertIn("Findings", self.edsc("document", "plant.json", "--format", "markdown").stdout)

    def test_other_documents_are_refused(self) -> None:
        self.plant()
        self.assertIn("--print-to-pdf", self.edsc("document", "node.eds", "-o", "node.pdf", exit_code=2).stderr)
        self.assertFalse((self.folder / "node.pdf").exists())
        self.assertIn("*.svg, *.png or *.jpg", self.edsc("document", "node.eds", "--logo", "node.eds", exit_code=2).stderr)
        self.assertIn("missing.svg: No such file", self.edsc("document", "node.eds", "--logo", "missing.svg", exit_code=2).stderr)

    def test_a_network_with_errors_is_not_written(self) -> None:
        node = '{"node_id": 1, "eds": "node.eds"}'
        self.write("broken.json", f'{{"nodes": {{"a": {node}, "b": {node}}}}}')
        shutil.copy(SOURCE_DIR / "tests/generator/network/node.eds", self.folder)
        self.edsc("document", "broken.json", "-o", "page.html", exit_code=1)
        self.assertFalse((self.folder / "page.html").exists())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The object dictionaries that bench/footprint/peers.py writes for other stacks have all objects of bench/ref.eds.

    peer_dictionaries_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE_DIR, EDSC = (Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(SOURCE_DIR / "bench/footprint"))
from peer_nodes.canopen_stack import dictionary as canopen_stack  # noqa: E402
from peer_nodes.canopennode import dictionary as canopennode  # noqa: E402

OBJECTS, ENTRIES = 76, 212


def ref() -> dict[str, object]:
    return json.loads(subprocess.run([EDSC, "dump", SOURCE_DIR / "bench/ref.eds"], check=True, capture_output=True, text=True).stdout)


class CanopenNode(unittest.TestCase):
    header, source = canopennode.header(ref()), canopennode.source(ref())

    def test_has_all_objects(self) -> None:
        self.assertEqual(len(re.findall(r"(?m)^  \{0x[0-9A-F]{4}, \d+, ODT_\w+, &o[0-9A-F]{4}, NULL\},$", self.source)), OBJECTS)

    def test_counts_services(self) -> None:
        self.assertIn("#define OD_CNT_RPDO 4\n#define OD_CNT_TPDO 4\n#define OD_CNT_ARR_1003 8\n", self.header)

    def test_a_can_id_has_no_node_id(self) -> None:
        self.assertIn(f".x1802 = {{.sub0 = 5, .sub1 = {0x4000_0380}, .sub2 = 1, .sub3 = 0, .sub5 = 0}},", self.source)

    def test_a_mapped_object_has_the_direction_of_its_access(self) -> None:
        self.assertIn("o6040 = {.dataOrig = &OD_RAM.x6040, .attribute = ODA_SDO_R | ODA_SDO_W | ODA_TPDO | ODA_RPDO | ODA_MB, "
                      ".dataLength = 2};", self.source)
        self.assertIn("o6041 = {.dataOrig = &OD_RAM.x6041, .attribute = ODA_SDO_R | ODA_TPDO | ODA_MB, .dataLength = 2};", self.source)


class CanopenStack(unittest.TestCase):
    header, source = canopen_stack.header(ref()), canopen_stack.source(ref())

    def test_has_all_entries(self) -> None:
        self.assertEqual(len(re.findall(r"(?m)^  \{CO_KEY\(", self.source)), ENTRIES)
        self.assertIn(f"#define OD_ENTRIES {ENTRIES}\n", self.header)

    def test_a_constant_is_in_the_list(self) -> None:
        self.assertIn("{CO_KEY(0x1000, 0, CO_OBJ_____R_ | CO_OBJ_D_____), CO_TUNSIGNED32, (CO_DATA)131474},", self.source)

    def test_a_can_id_adds_the_node_id(self) -> None:
        self.assertIn(f"uint32_t x1802_1 = (uint32_t){0x4000_0380};", self.source)
        self.assertIn("{CO_KEY(0x1802, 1, CO_OBJ_____R_ | CO_OBJ______W | CO_OBJ__N____), CO_TPDO_ID, (CO_DATA)&x1802_1},", self.source)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])

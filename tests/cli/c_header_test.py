#!/usr/bin/env python3
"""edsc generate --target c: the header compiles as C99, and packs and unpacks PDOs.

    c_header_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from made_fixtures import names_eds  # noqa: E402

SOURCE_DIR, EDSC = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
COMPILER = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Werror")


def entry(section: str, name: str, data_type: int, access: str, value: str, *more: str) -> str:
    return "\n".join((f"[{section}]", f"ParameterName={name}", "ObjectType=0x7", f"DataType=0x{data_type:04X}",
                      f"AccessType={access}", f"DefaultValue={value}", *more, ""))


def record(index: int, name: str, *entries: tuple[str, int, str]) -> str:
    """The entries from sub-index 0 on: name, data type, value."""
    rows = (entry(f"{index:04X}sub{sub}", row, data_type, "rw", value) for sub, (row, data_type, value) in enumerate(entries))
    return f"[{index:04X}]\nParameterName={name}\nObjectType=0x9\nSubNumber={len(entries)}\n" + "".join(rows)


def device() -> str:
    """A TPDO with values of 1, 24 and 32 bits, and an RPDO with a dummy entry of 8 bits before one of 16 bits."""
    objects = (0x1000, 0x1001, 0x1400, 0x1600, 0x1800, 0x1A00, 0x2000, 0x2001, 0x2002, 0x2003, 0x2004)
    listed = "".join(f"{place}=0x{index:04X}\n" for place, index in enumerate(objects, 1))
    return (f"[DummyUsage]\nDummy0005=1\n[OptionalObjects]\nSupportedObjects={len(objects)}\n{listed}"
            + entry("1000", "Device type", 7, "ro", "0") + entry("1001", "Error register", 5, "ro", "0")
            + record(0x1400, "RPDO 1", ("Count", 5, "2"), ("COB-ID", 7, "$NODEID+0x200"), ("Type", 5, "255"))
            + record(0x1600, "Mapping R1", ("Count", 5, "2"), ("Dummy", 7, "0x00050008"), ("Level", 7, "0x20030010"))
            + record(0x1800, "TPDO 1", ("Count", 5, "2"), ("COB-ID", 7, "0x181"), ("Type", 5, "255"))
            + record(0x1A00, "Mapping T1", ("Count", 5, "3"), ("Switch", 7, "0x20000001"), ("Position", 7, "0x20010018"),
                     ("Torque", 7, "0x20020020"))
            + entry("2000", "Switch", 1, "rw", "1", "PDOMapping=1") + entry("2001", "Position", 0x10, "rw", "-5", "PDOMapping=1")
            + entry("2002", "Torque", 8, "rw", "0.5", "PDOMapping=1")
            + entry("2003", "restrict", 6, "rw", "0x1234", "PDOMapping=1", "LowLimit=1", "HighLimit=0x2000")
            + entry("2004", "Name", 9, "rw", 'a "text"'))


class CHeader(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def generate(self, sheet: Path, *arguments: str) -> None:
        subprocess.run([EDSC, "generate", sheet, "-o", self.folder, "--name", "dev", "--target", "c", *arguments], check=True,
                       capture_output=True, timeout=600)

    def run_program(self, statements: str) -> list[str]:
        (self.folder / "device.eds").write_text(device())
        self.generate(self.folder / "device.eds")
        (self.folder / "main.c").write_text('#include <dev/objects.h>\n#include <inttypes.h>\n#include <stdio.h>\n\n'
                                            f"int main(void) {{\n{statements}\n  return 0;\n}}\n")
        subprocess.run([*COMPILER, "-I", self.folder, "-o", self.folder / "main", self.folder / "main.c"], check=True, timeout=600)
        return subprocess.run([self.folder / "main"], check=True, capture_output=True, text=True, timeout=60).stdout.split()

    def test_the_headers_of_all_devices_compile(self) -> None:
        sheets = [*(SOURCE_DIR / "eds").glob("*.eds"), *(SOURCE_DIR / "tests/fixtures").glob("*.eds"), names_eds(self.folder)]
        compiled = 0
        for sheet in sheets:
            with self.subTest(sheet=sheet.name):
                result = subprocess.run([EDSC, "generate", sheet, "-o", self.folder, "--name", "dev", "--target", "c",
                                         "--keep-going"], capture_output=True, timeout=600)
                if result.returncode != 0:
                    continue  # no data sheet, by design
                subprocess.run([*COMPILER, "-fsyntax-only", "-x", "c", self.folder / "dev/objects.h"], check=True, timeout=600)
                compiled += 1
        self.assertGreater(compiled, 20)

    def test_a_tpdo_is_packed(self) -> None:
        for switch, position, torque in ((True, -5, 1.5), (False, 0x7FFFFF, -0.25), (True, -0x800000, 3e38)):
            bits, = struct.unpack("<I", struct.pack("<f", torque))
            expected = (int(switch) | (position & 0xFFFFFF) << 1 | bits << 25).to_bytes(8, "little")
            printed = self.run_program(f"""\
  const struct dev_tpdo_1 pdo = {{{str(switch).lower()}, {position}, {torque}f}};
  uint8_t data[DEV_TPDO_1_LENGTH];
  struct dev_tpdo_1 read;
  dev_tpdo_1_pack(&pdo, data);
  for (unsigned i = 0; i < sizeof data; ++i) printf("%02X", data[i]);
  dev_tpdo_1_unpack(data, &read);
  printf(" %d %" PRId32 " %g", read.switch_, read.position, (double)read.torque);""")
            self.assertEqual(printed, [expected.hex().upper(), str(int(switch)), str(position), f"{torque:g}"])

    def test_a_dummy_entry_has_no_member(self) -> None:
        self.assertEqual(self.run_program("""\
  const uint8_t data[DEV_RPDO_1_LENGTH] = {0xAA, 0x34, 0x12};
  struct dev_rpdo_1 pdo;
  dev_rpdo_1_unpack(data, &pdo);
  printf("%X %u ", pdo.restrict_, (unsigned)sizeof pdo);
  printf("%X %X", DEV_RPDO_1_COB_ID(5u), DEV_TPDO_1_COB_ID);"""), ["1234", "2", "205", "181"])

    def test_constants_of_entries(self) -> None:
        self.assertEqual(self.run_program("""\
  const dev_restrict_t value = DEV_RESTRICT_DEFAULT;
  printf("%X %X %X %X ", DEV_RESTRICT_INDEX, value, DEV_RESTRICT_LOW, DEV_RESTRICT_HIGH);
  printf("%X %X %d %g ", DEV_RPDO_1_COB_ID_INDEX, DEV_RPDO_1_COB_ID_SUBINDEX, DEV_POSITION_DEFAULT, (double)DEV_TORQUE_DEFAULT);
  printf("%s", DEV_NAME_DEFAULT);"""), ["2003", "1234", "1", "2000", "1400", "1", "-5", "0.5", "a", '"text"'])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
